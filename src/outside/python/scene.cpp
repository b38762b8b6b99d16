#include "exactff/scene.h"

#include <pybind11/stl/filesystem.h>

#include <functional>

#include "exactff/models.h"
#include "exactff/scene_files.h"
#include "exactff/slips.h"
#include "files/file.h"
#include "flags/values.h"
#include "kernel/vec.h"
#include "python/bindings.h"
#include "scene/selections.h"

namespace exactff::python {

std::shared_ptr<const ExactSource> SharedScene::source(const Selection& selection) const {
  constexpr std::size_t kMostKept = 256;
  const std::string name = scene_.name_of(selection);
  const std::lock_guard lock(mutex_);
  if (const auto found = sources_.find(name); found != sources_.end()) return found->second;
  if (sources_.size() >= kMostKept) sources_.clear();
  return sources_.emplace(name, std::make_shared<const ExactSource>(scene_, selection)).first->second;
}

std::vector<Selection> SharedScene::selections(const std::vector<std::string>& names) const {
  return names.empty() ? scene_.emitters() : flags::selections_named(scene_, names);
}

void write_whole_files(const std::vector<std::pair<std::filesystem::path, std::string>>& files) {
  std::vector<std::unique_ptr<files::WholeFile>> begun;
  for (const auto& [path, bytes] : files) {
    begun.push_back(
        std::make_unique<files::WholeFile>(path, files::FailureAdvice(), files::WholeFile::WhenBusy::kWait));
    begun.back()->append(bytes);
    begun.back()->sync();
  }
  for (const auto& file : begun) file->commit();
}

namespace {

using Shared = std::shared_ptr<SharedScene>;
using Names = std::vector<std::string>;

Shared shared(Scene scene) { return std::make_shared<SharedScene>(std::move(scene)); }

SceneOptions options_of(const std::string& patches, bool skip_bad_faces) {
  return scene_options(patches, skip_bad_faces ? BadFaces::kSkip : BadFaces::kReject);
}

Shared read_file(const std::filesystem::path& path, const std::string& patches, bool skip_bad_faces,
                 const std::string& unit) {
  const py::gil_scoped_release released;
  SceneOptions options = options_of(patches, skip_bad_faces);
  if (!unit.empty()) options.unit = unit_named(unit);
  return shared(read_scene(path, options));
}

Shared from_model(const std::string& text, const std::string& patches) {
  const py::gil_scoped_release released;
  return shared(models::make_scene(text, options_of(patches, false)));
}

using MaterialRow = std::tuple<std::string, std::array<double, 3>, std::array<double, 3>>;

// Faces are runs of `all_corners`, face f from starts[f] to starts[f + 1].
Shared build(const Numbers& vertices, const Integers& all_corners, const Integers& all_starts,
             const Integers& all_patches, const Integers& all_materials, const Names& patch_names,
             const std::vector<MaterialRow>& materials, bool skip_bad_faces) {
  SceneBuilder builder({}, options_of("groups", skip_bad_faces));
  std::vector<PatchId> patches;
  std::vector<MaterialId> material_ids;
  for (const std::string& name : patch_names) patches.push_back(builder.patch(name));
  for (const auto& [name, kd, ke] : materials) {
    material_ids.push_back(
        builder.add_material({.name = name, .reflectance = {kd[0], kd[1], kd[2]}, .radiosity = {ke[0], ke[1], ke[2]}}));
  }
  const auto points = vertices.unchecked<2>();
  const auto corners = all_corners.unchecked<1>(), starts = all_starts.unchecked<1>(),
             patch_of = all_patches.unchecked<1>(), material_of = all_materials.unchecked<1>();
  const py::gil_scoped_release released;
  for (py::ssize_t v = 0; v < points.shape(0); ++v) builder.add_vertex({points(v, 0), points(v, 1), points(v, 2)});
  for (py::ssize_t f = 0; f < patch_of.shape(0); ++f) {
    std::vector<std::uint32_t> ring;
    for (std::int64_t c = starts(f); c < starts(f + 1); ++c) ring.push_back(static_cast<std::uint32_t>(corners(c)));
    builder.add_face(patches[static_cast<std::size_t>(patch_of(f))],
                     material_ids[static_cast<std::size_t>(material_of(f))], {std::move(ring)});
  }
  return shared(builder.build());
}

// One number of every face.
template <class Value, class Get>
py::array_t<Value> of_faces(const SharedScene& self, const Get& get) {
  const std::span<const Face> faces = self.scene().faces();
  py::array_t<Value> result(static_cast<py::ssize_t>(faces.size()));
  Value* const out = result.mutable_data();
  for (std::size_t f = 0; f < faces.size(); ++f) out[f] = get(faces[f]);
  return result;
}

FaceId face_at(const Scene& scene, std::int64_t index) {
  if (index >= 0 && static_cast<std::size_t>(index) < scene.faces().size()) return static_cast<FaceId>(index);
  throw py::index_error("there is no face " + std::to_string(index));
}

py::list patches_of(const SharedScene& self) {
  const Scene& scene = self.scene();
  py::list rows;
  for (std::size_t i = 0; i < scene.patches().size(); ++i) {
    const auto id = static_cast<PatchId>(i);
    const PatchSummary row = summarise(scene, id);
    py::list faces, materials;
    for (const FaceId face : scene.patch(id).faces) faces.append(index_of(face));
    for (const MaterialId material : row.materials) {
      const Material& one = scene.material(material);
      materials.append(py::make_tuple(one.name, to_tuple(one.reflectance), to_tuple(one.radiosity)));
    }
    rows.append(py::make_tuple(row.name, faces, row.area,
                               row.front ? py::object(to_tuple(*row.front)) : py::object(py::none()), materials,
                               row.emits, to_tuple(row.centre), to_tuple(row.low), to_tuple(row.high)));
  }
  return rows;
}

// Patch, the one it is buried under, area, share.
py::list contacts_of(const SharedScene& self) {
  Interrupt interrupt;
  const auto contacts = interrupt.run([&] { return slips::buried_parts(self.scene()); });
  py::list result;
  for (const slips::Contact& one : contacts) {
    result.append(
        py::make_tuple(self.scene().name_of(one.patch), self.scene().name_of(one.under), one.area, one.share));
  }
  return result;
}

py::list findings_of(const SharedScene& self) {
  Interrupt interrupt;
  const auto findings = interrupt.run([&] { return slips::diagnose(self.scene()); });
  py::list rows;
  for (const slips::Finding& finding : findings) {
    rows.append(py::make_tuple(std::string(to_string(finding.kind)), shown(finding.words.message()),
                               names_of(self.scene(), finding.objects), finding.flag));
  }
  return rows;
}

py::list warnings_of(const SharedScene& self) {
  py::list rows;
  for (const Problem& warning : self.scene().warnings()) rows.append(shown(warning.message()));
  return rows;
}

Names faces_of_shape(const SharedScene& self, int shape) {
  Names names;
  const auto is_so = [&](const Face& face) { return face.shape == static_cast<FaceShape>(shape); };
  for (const FaceId id : faces_where(self.scene(), is_so))
    names.push_back(self.scene().name_of(selection_of(self.scene(), id)));
  return names;
}

std::vector<std::size_t> own_faces(const SharedScene& self, const std::string& name) {
  std::vector<std::size_t> indices;
  for (const FaceId face : own_faces_named(self.scene(), name)) indices.push_back(index_of(face));
  return indices;
}

// Tells the files that would be written to `check`, which may raise; then writes them. What the format does not hold.
std::vector<std::string> write_scene(const SharedScene& self, const std::filesystem::path& path,
                                     const std::string& encoding, const py::function& check) {
  SceneFiles made = scene_files(self.scene(), path,
                                encoding == "text"     ? Encoding::kText
                                : encoding == "binary" ? Encoding::kBinary
                                                       : Encoding::kDefault);
  std::vector<std::pair<std::filesystem::path, std::string>> files;
  std::vector<std::string> losses;
  for (SceneFiles::File& file : made.files) {
    check(file.path);
    files.emplace_back(std::move(file.path), std::move(file.bytes));
  }
  for (const Problem& loss : made.losses) losses.push_back(loss.message());
  const py::gil_scoped_release released;
  write_whole_files(files);
  return losses;
}

// The cells, and how far their corners are off.
py::tuple divided_of(const SharedScene& self, double length) {
  DividedScene made = [&] {
    const py::gil_scoped_release released;
    return divided(self.scene(), length);
  }();
  return py::make_tuple(shared(std::move(made.scene)), made.largest_deviation);
}

// The scene, what moved and by how much at most, junctions, names of faces that vanished, pairs of sheets.
py::tuple welded_of(const SharedScene& self, double length) {
  WeldedScene made = [&] {
    const py::gil_scoped_release released;
    return welded(self.scene(), length);
  }();
  py::list vanished, sheets;
  for (const FaceId face : made.vanished) vanished.append(self.scene().name_of(face));
  for (const WeldedScene::Sheets& one : made.sheets) {
    sheets.append(py::make_tuple(made.scene.name_of(one.one), made.scene.name_of(one.other), one.apart));
  }
  return py::make_tuple(shared(std::move(made.scene)), made.corners_before, made.corners, made.largest_move,
                        made.junctions, vanished, sheets);
}

// Length, open edges before and after; None for no gap.
py::object gap_of(const SharedScene& self) {
  Interrupt interrupt;
  const std::optional<Gap> found = interrupt.run([&] { return gap(self.scene()); });
  if (!found) return py::none();
  return py::make_tuple(found->length, found->open_edges_before, found->open_edges);
}

Shared with_face_names(const SharedScene& self, const std::vector<std::pair<std::string, std::string>>& names) {
  std::vector<FaceName> list;
  for (const auto& [name, selector] : names) list.push_back({name, selector});
  return shared(with_names(self.scene(), list));
}

}  // namespace

void bind_scene(py::module_& module) {
  py::class_<SharedScene, Shared>(module, "Scene")
      .def_static("read", &read_file, "path"_a, "patches"_a, "skip_bad_faces"_a, "unit"_a)
      .def_static("from_model", &from_model, "text"_a, "patches"_a)
      .def_static("build", &build, "vertices"_a, "corners"_a, "starts"_a, "patches"_a, "materials"_a, "patch_names"_a,
                  "material_rows"_a, "skip_bad_faces"_a)
      .def("vertices", [](const SharedScene& s) { return rows_of(s.scene().vertices(), std::identity()); })
      .def("areas", [](const SharedScene& s) { return of_faces<double>(s, [](const Face& f) { return f.area; }); })
      .def("fronts",
           [](const SharedScene& s) {
             return rows_of(s.scene().faces(), [](const Face& f) { return kernel::unit_by_inverse(f.newell); });
           })
      .def("patch_of_face",
           [](const SharedScene& s) {
             return of_faces<std::int64_t>(s,
                                           [](const Face& f) { return static_cast<std::int64_t>(index_of(f.patch)); });
           })
      .def(
          "rings",
          [](const SharedScene& s, std::int64_t face) { return s.scene().face(face_at(s.scene(), face)).rings; },
          "face"_a)
      .def(
          "texture",
          [](const SharedScene& s, std::int64_t face, int set) {
            const auto points = s.scene().texture(face_at(s.scene(), face), set);
            Numbers result({static_cast<py::ssize_t>(points.size()), py::ssize_t{2}});
            double* out = result.mutable_data();
            for (const TexturePoint& p : points) {
              *out++ = p.u;
              *out++ = p.v;
            }
            return result;
          },
          "face"_a, "set"_a)
      .def("face_count", [](const SharedScene& s) { return s.scene().faces().size(); })
      .def(
          "face_name",
          [](const SharedScene& s, std::int64_t face) { return s.scene().name_of(face_at(s.scene(), face)); }, "face"_a)
      .def("own_faces", &own_faces, "name"_a)
      .def(
          "faces_of",
          [](const SharedScene& s, const std::string& name) {
            std::vector<std::size_t> indices;
            for (const Selection& selection : s.selections({name})) {
              for (const FaceId face : s.scene().faces_of(selection)) indices.push_back(index_of(face));
            }
            return indices;
          },
          "name"_a)
      .def("patches", &patches_of)
      .def("emitters", [](const SharedScene& s) { return names_of(s.scene(), s.scene().emitters()); })
      .def(
          "with_flipped",
          [](const SharedScene& s, const Names& names) { return shared(s.scene().with_flipped(s.selections(names))); },
          "names"_a)
      .def(
          "with_unit",
          [](const SharedScene& s, const std::string& unit) { return shared(s.scene().with_unit(unit_named(unit))); },
          "unit"_a)
      .def(
          "with_transparent",
          [](const SharedScene& s, const Names& names) {
            return shared(s.scene().with_transparent(s.selections(names)));
          },
          "names"_a)
      .def(
          "with_patches",
          [](const SharedScene& s, const std::string& patches) {
            return shared(with_patches(s.scene(), scene_options(patches)));
          },
          "patches"_a)
      .def("with_names", &with_face_names, "names"_a)
      .def("welded", &welded_of, "length"_a)
      .def("gap", &gap_of)
      .def("divided", &divided_of, "length"_a)
      .def(
          "cells_of",
          [](const SharedScene& s, const std::string& name) { return names_of(s.scene(), s.scene().select_all(name)); },
          "name"_a)
      .def(
          "names_like",
          [](const SharedScene& s, const std::vector<std::string>& names) {
            return names.empty() ? names : names_of(s.scene(), s.selections(names));
          },
          "names"_a)
      .def("triangulated", [](const SharedScene& s) { return shared(triangulated(s.scene())); })
      .def("write", &write_scene, "path"_a, "encoding"_a, "check"_a)
      .def("flipped", [](const SharedScene& s) { return names_of(s.scene(), s.scene().flipped()); })
      .def("transparent", [](const SharedScene& s) { return names_of(s.scene(), s.scene().transparent()); })
      .def("warnings", &warnings_of)
      .def("findings", &findings_of)
      .def("contacts", &contacts_of)
      .def("faces_of_shape", &faces_of_shape, "shape"_a)
      .def("open_edges",
           [](const SharedScene& s) {
             const py::gil_scoped_release released;
             return s.scene().open_edge_count();
           })
      .def("unit", [](const SharedScene& s) { return std::string(name_of(s.scene().unit())); })
      .def("files",
           [](const SharedScene& s) {
             return std::vector<std::filesystem::path>(s.scene().files().begin(), s.scene().files().end());
           })
      .def("hash", [](const SharedScene& s) { return s.scene().hash(); });
}

}  // namespace exactff::python
