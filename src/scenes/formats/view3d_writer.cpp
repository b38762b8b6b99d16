// View3D (.vs3). Faces after the first one of a patch are combined with it.
#include <algorithm>
#include <optional>

#include "formats/decimal_complement.h"
#include "formats/mesh_input.h"
#include "formats/output_faces.h"
#include "formats/output_names.h"
#include "text/number_text.h"
#include "text/phrases.h"

namespace exactff::formats {

namespace {

constexpr NameRules kView3dNames = {.one_word = true, .comment = '!'};

bool is_grey(const Rgb& kd) { return kd.r == kd.g && kd.g == kd.b && kd.r <= 1.0; }

// 1 - Kd as a decimal; the mean of three different values.
std::string emittance(const Rgb& kd) {
  const double mean = kd.r == kd.g && kd.g == kd.b ? kd.r : kd.r / 3.0 + kd.g / 3.0 + kd.b / 3.0;
  return decimal_complement(fixed_decimal(std::clamp(mean, 0.0, 1.0))).value_or("1");
}

void tell_losses(const Scene& scene, Losses& losses) {
  const auto count = [&](const auto& is_lost) {
    return static_cast<std::size_t>(std::count_if(scene.materials().begin(), scene.materials().end(), is_lost));
  };
  const std::size_t emitting = count([](const Material& m) { return m.emits(); });
  const std::size_t coloured = count([](const Material& m) { return !is_grey(m.reflectance); });
  if (emitting > 0) {
    losses.add("Ke of " + text::counted(emitting, "material") + " is lost", "View3D surfaces have no radiosity",
               "write OBJ to keep it");
  }
  if (coloured > 0) {
    losses.add("Kd of " + text::counted(coloured, "material") + " becomes one number within 0 and 1",
               "View3D surfaces have one emittance, 1 - Kd", "write OBJ to keep the colours");
  }
}

class View3dWriter {
 public:
  View3dWriter(const Scene& scene, Losses& losses)
      : scene_(scene),
        faces_(output_faces(scene, Polygons::kFourCorners, "View3D", losses)),
        names_(output_names(patch_names(scene), kView3dNames, "patch", losses)),
        first_(names_.size()) {}

  std::string run() {
    out_ = "T written by " + text::program_version() + "\nC\nF 3\n";
    for (std::size_t i = 0; i < scene_.vertices().size(); ++i) {
      out_ += "V " + std::to_string(i + 1);
      append_point(out_, scene_.vertices()[i]);
      out_ += '\n';
    }
    for (const OutputFace& face : faces_) {
      if (!obstructs_only(face)) append_surface(face);
    }
    for (const OutputFace& face : faces_) {  // View3D wants them last
      if (obstructs_only(face)) append_obstruction(face);
    }
    return out_ + "End of data\n";
  }

 private:
  // The way in which such surfaces are read.
  bool obstructs_only(const OutputFace& output) const {
    return scene_.material(scene_.face(output.face).material).name == kObstruction;
  }
  void append_corners(const OutputFace& face) {
    for (std::size_t i = 0; i < 4; ++i)
      out_ += ' ' + (i < face.corners.size() ? std::to_string(face.corners[i] + 1ULL) : "0");
  }
  void append_obstruction(const OutputFace& face) {
    out_ += "O " + std::to_string(++count_);
    append_corners(face);
    const std::string& name = names_[index_of(scene_.face(face.face).patch)];
    const bool is_number = text::parse_number(name).fault == text::NumberFault::kNone;
    out_ += (is_number ? " 0 0 0 " : " ") + name + '\n';  // after base, combination and emittance, a number is a name
  }
  void append_surface(const OutputFace& output) {
    const Face& face = scene_.face(output.face);
    std::optional<std::size_t>& first = first_[index_of(face.patch)];
    out_ += "S " + std::to_string(++count_);
    append_corners(output);
    out_ += " 0 " + std::to_string(first.value_or(0)) + ' ' + emittance(scene_.material(face.material).reflectance) +
            ' ' + names_[index_of(face.patch)] + '\n';
    if (!first) first = count_;
  }

  const Scene& scene_;
  const std::vector<OutputFace> faces_;
  const std::vector<std::string> names_;
  std::vector<std::optional<std::size_t>> first_;  // surface of each patch
  std::size_t count_ = 0;
  std::string out_;
};

}  // namespace

std::string write_view3d(const Scene& scene, Losses& losses) {
  tell_losses(scene, losses);
  return View3dWriter(scene, losses).run();
}

}  // namespace exactff::formats
