// View factors from patch to patch, and the whole view from one receiver.
#include "exactff/view_factors.h"

#include <pybind11/stl/filesystem.h>

#include <algorithm>

#include "exactff/matrix.h"
#include "exactff/radiosity.h"
#include "exactff/slips.h"
#include "exactff/view.h"
#include "matrix/balanced.h"
#include "matrix/rows.h"
#include "python/bindings.h"
#include "radiosity/narrowing.h"
#include "scene/selections.h"
#include "text/phrases.h"
#include "text/refuse.h"

namespace exactff::python {
namespace {

// Value, lower, upper, claim, way, accurate, area_from, area_to, cells, event_cells, limit.
py::tuple to_tuple(const ViewFactor& f) {
  return py::make_tuple(f.value, f.lower, f.upper, std::string(to_string(f.claim)), std::string(to_string(f.way)),
                        f.accurate, f.area_from, f.area_to, f.cells, f.event_cells, std::string(to_string(f.limit)));
}

py::tuple view_factor_of(const SharedScene& scene, const std::string& from, const std::string& to, double accuracy,
                         std::size_t budget, bool certify) {
  const Scene& in = scene.scene();
  const Selection i = in.select(from), j = in.select(to);
  Interrupt interrupt;
  const ViewFactorOptions options{.accuracy = accuracy, .budget = budget, .certify = certify};
  return to_tuple(interrupt.run([&] { return view_factor(in, i, j, options); }));
}

py::list to_list(const std::vector<ViewFactor>& factors) {
  py::list list;
  for (const ViewFactor& f : factors) list.append(to_tuple(f));
  return list;
}

py::tuple to_tuple(const matrix::Reciprocity::Pair& pair) {
  return py::make_tuple(pair.row, pair.column, pair.distance, pair.radius);
}

// The number of pairs, the worst of them or None, those whose intervals are apart.
py::tuple to_tuple(const matrix::Reciprocity& reciprocity) {
  py::list apart;
  for (const matrix::Reciprocity::Pair& pair : reciprocity.apart) apart.append(to_tuple(pair));
  const py::object worst = reciprocity.worst ? py::object(to_tuple(*reciprocity.worst)) : py::none();
  return py::make_tuple(reciprocity.pairs, worst, apart);
}

// A matrix with what its files need.
class MadeMatrix {
 public:
  MadeMatrix(std::shared_ptr<const SharedScene> scene, matrix::Matrix made, ViewFactorOptions options)
      : shared_(std::move(scene)), made_(std::move(made)), options_(options) {}

  // `format`: csv, npz, vtk (one row), or a name of matrix::program_formats().
  void write(const std::filesystem::path& path, const std::string& format, const std::string& zone) const {
    const py::gil_scoped_release released;
    const Scene& scene = shared_->scene();
    if (format == "npz") return matrix::write_npz(scene, computed(), path, balanced_.get());
    if (format == "vtk") return write_row(path);
    if (format == "csv") return write_whole_files({{path, csv_text()}});
    refuse_overlaps(path);
    const auto formats = matrix::program_formats();
    const matrix::ProgramFormat& one = *std::ranges::find(formats, format, &matrix::ProgramFormat::name);
    const matrix::Square square = one.of_conductors ? square_of(one, scene, radiosity::exchange(scene, made_))
                                                    : square_of(one, scene, made_, zone);
    write_whole_files(files_of(one, square, path));
  }

  // The same with balanced values; that of rows, and the largest distance of a row from 1.
  [[nodiscard]] py::tuple balanced() const {
    matrix::Balanced found;
    auto result = std::make_shared<MadeMatrix>(*this);
    {
      const py::gil_scoped_release released;
      found = matrix::balanced(shared_->scene(), made_);
      if (std::vector<Problem> problems = problems_of(shared_->scene(), made_, found); !problems.empty()) {
        throw InputError(std::move(problems));
      }
      result->unbalanced_ = std::make_shared<const matrix::Matrix>(made_);
      result->made_ = with_values(std::move(result->made_), found);
    }
    const py::tuple lists =
        py::make_tuple(to_array(found.entries), to_array(found.back), to_array(found.open), to_array(found.buried));
    const double furthest = found.furthest;
    result->balanced_ = std::make_shared<const matrix::Balanced>(std::move(found));
    return lists + py::make_tuple(furthest, result);
  }

  // For each channel: factors, back, open, conductors, those to back and to open, each (k, 3): value, lower, upper;
  // then emissivities and the reason for no bound. The claim; the CSV file, in `path` if it is not empty.
  [[nodiscard]] py::tuple exchange(int threads, const std::filesystem::path& path, const py::object& progress) const {
    const Scene& scene = shared_->scene();
    Interrupt interrupt(progress);
    const radiosity::Exchange found =
        interrupt.run([&] { return radiosity::exchange(scene, made_, threads, interrupt.hooks()); });
    if (!path.empty()) table::write(table_of(scene, found, options_), path);
    py::list channels;
    for (const radiosity::Exchange::Channel& c : found.channels) {
      channels.append(py::make_tuple(to_array(c.factors), to_array(c.back), to_array(c.open), to_array(c.conductors),
                                     to_array(c.conductors_to_back), to_array(c.conductors_to_open),
                                     to_array(c.emissivities), c.no_bound));
    }
    return py::make_tuple(channels, std::string(to_string(found.claim)), found.areas);
  }

  // Temperatures, heats (n, 3); areas, emissivities; heat to backs, to what is open, unaccounted for (3, 3); the claim.
  // The CSV file, in `path` if it is not empty.
  [[nodiscard]] py::tuple temperatures(const std::map<std::string, double>& known,
                                       const std::map<std::string, double>& heats,
                                       const std::filesystem::path& path) const {
    const Scene& scene = shared_->scene();
    std::vector<radiosity::Condition> all;
    for (const auto& [name, t] : known) all.push_back({name, {.temperature = t}});
    for (const auto& [name, q] : heats) all.push_back({name, {.heat = q}});
    const radiosity::Temperatures found = radiosity::temperatures(scene, made_, radiosity::conditions_of(scene, all));
    if (!found.is_bounded()) text::refuse("temperatures have no bound", found.no_bound, found.remedy);
    if (!path.empty()) table::write(table_of(scene, found, options_), path);
    return py::make_tuple(to_array(found.temperatures), to_array(found.heats), to_array(found.areas),
                          to_array(found.emissivities), to_array({found.to_back, found.to_open, found.unbalanced}),
                          std::string(to_string(found.claim)));
  }

 private:
  static Numbers to_array(const std::vector<radiosity::BoundedValue>& values) {
    Numbers array({values.size(), std::size_t{3}});
    auto entry = array.mutable_unchecked<2>();
    for (std::size_t i = 0; i < values.size(); ++i) {
      const auto row = static_cast<py::ssize_t>(i);
      entry(row, 0) = values[i].value, entry(row, 1) = values[i].lower, entry(row, 2) = values[i].upper;
    }
    return array;
  }
  static Numbers to_array(const std::vector<double>& values) {
    return Numbers(static_cast<py::ssize_t>(values.size()), values.data());
  }
  [[nodiscard]] const matrix::Matrix& computed() const { return unbalanced_ ? *unbalanced_ : made_; }
  [[nodiscard]] std::string csv_text() const {
    return table::csv_text(table_of(shared_->scene(), computed(), options_, balanced_.get()));
  }
  void write_row(const std::filesystem::path& path) const {
    if (made_.factors.from.size() != 1 || made_.factors.to.empty()) {
      text::refuse(path, "shows one row on the patches of the scene",
                   "the matrix has " + text::counted(made_.factors.from.size(), "row") + " and " +
                       text::counted(made_.factors.to.size(), "column"),
                   "name one patch in from_patches, and patches in to_patches");
    }
    write_vtk(shared_->scene(), made_, path);
  }
  void refuse_overlaps(const std::filesystem::path& path) const {
    std::vector<slips::Overlap> overlaps = slips::overlapping_fronts(shared_->scene(), made_.factors.to);
    std::erase_if(overlaps, [](const slips::Overlap& one) { return one.apart > 0.0; });
    if (overlaps.empty()) return;
    Problem problem = slips::warning_of_overlaps(shared_->scene(), overlaps);
    problem.file = path.string();
    problem.why = "a file for another program with such rows makes energy, and was not written";
    throw InputError(std::move(problem));
  }

  std::shared_ptr<const SharedScene> shared_;
  matrix::Matrix made_;
  ViewFactorOptions options_;
  std::shared_ptr<const matrix::Matrix> unbalanced_;  // null unless `made_` is balanced
  std::shared_ptr<const matrix::Balanced> balanced_;
};

// Entries row by row, backs, what is open, what is buried, sums of rows (lower, upper), reasons
// against 1, reciprocity, MadeMatrix.
py::tuple view_factor_matrix_of(const std::shared_ptr<SharedScene>& scene, const std::vector<std::string>& from,
                                const std::vector<std::string>& to, double accuracy, std::size_t budget, bool certify,
                                bool backs, bool open, bool both_directions, const std::vector<std::string>& groups,
                                int threads, const py::object& progress) {
  const Scene& in = scene->scene();
  std::vector<Selection> rows, columns;
  for (const std::string& name : from) rows.push_back(in.select(name));
  for (const std::string& name : to) columns.push_back(in.select(name));
  const matrix::Options options{
      .factors = {.accuracy = accuracy, .budget = budget, .both_directions = both_directions, .certify = certify},
      .backs = backs,
      .open = open,
      .threads = threads};
  matrix::Matrix empty{{rows, columns, std::vector<ViewFactor>(rows.size() * columns.size())}, {}, {}, {}};
  add_sums(in, groups, accuracy, empty);  // refuses before anything that takes time
  Interrupt interrupt(progress);
  std::vector<std::string> reasons;
  matrix::Reciprocity reciprocity;
  matrix::Matrix made = interrupt.run([&] {
    matrix::Matrix computed = matrix::compute(in, rows, columns, options, interrupt.hooks());
    add_sums(in, groups, accuracy, computed);
    reasons = reasons_against_one(in, computed);
    if (both_directions) reciprocity = matrix::reciprocity(computed);
    return computed;
  });
  py::list sums;
  for (const matrix::Sum& sum : row_sums(made)) sums.append(py::make_tuple(sum.lower, sum.upper));
  py::list of_groups;
  for (const matrix::GroupSum& sum : made.sums) of_groups.append(to_list(sum.factors));
  const py::tuple lists =
      py::make_tuple(to_list(made.factors.entries), to_list(made.back), to_list(made.open), to_list(made.buried));
  return lists + py::make_tuple(sums, reasons, to_tuple(reciprocity), of_groups,
                                std::make_shared<MadeMatrix>(scene, std::move(made), options.factors));
}

std::shared_ptr<SharedScene> with_two_sided_of(const SharedScene& scene, const std::vector<std::string>& names) {
  return std::make_shared<SharedScene>(matrix::with_two_sided(scene.scene(), scene.selections(names)));
}

// Value, lower, upper, status.
py::tuple to_tuple(const ViewShare& share) {
  return py::make_tuple(share.value, share.lower, share.upper, static_cast<int>(share.status));
}

// For each patch or face that is seen: name, form factor, share, stacked. Then back, open, and the name of the face
// that buries the receiver.
py::tuple view_of(const SharedScene& scene, const std::array<double, 3>& point, const std::array<double, 3>& normal,
                  const std::vector<std::uint32_t>& on, bool faces, int digits, int precision_cap,
                  const MeasureTuple& measure) {
  const Scene& in = scene.scene();
  Receiver receiver{{point[0], point[1], point[2]}, {normal[0], normal[1], normal[2]}, {}, {}};
  for (const std::uint32_t face : on) receiver.on.push_back(static_cast<FaceId>(face));
  Interrupt interrupt;
  const WholeView seen = interrupt.run([&] {
    return view(in, receiver,
                {.faces = faces, .measure = measure_of(measure), .digits = digits, .precision_cap = precision_cap});
  });
  py::list rows;
  for (const SeenPatch& patch : seen.patches) {
    rows.append(py::make_tuple(in.name_of(Selection{patch.patch, patch.face, in.id()}), to_tuple(patch.form_factor),
                               to_tuple(patch.share), patch.stacked));
  }
  const py::object buried =
      seen.buried_under ? py::object(py::str(in.name_of(*seen.buried_under))) : py::object(py::none());
  return py::make_tuple(rows, to_tuple(seen.back), to_tuple(seen.open), buried);
}

}  // namespace

void bind_view_factors(py::module_& module) {
  py::class_<MadeMatrix, std::shared_ptr<MadeMatrix>>(module, "MadeMatrix")
      .def("balanced", &MadeMatrix::balanced)
      .def("exchange", &MadeMatrix::exchange, "threads"_a, "path"_a, "progress"_a)
      .def("temperatures", &MadeMatrix::temperatures, "known"_a, "heats"_a, "path"_a)
      .def("write", &MadeMatrix::write, "path"_a, "format"_a, "zone"_a);
  py::list formats;
  for (const matrix::ProgramFormat& one : matrix::program_formats()) {
    formats.append(py::make_tuple(std::string(one.name), std::string(one.extension), std::string(one.lost)));
  }
  module.attr("matrix_formats") = py::tuple(formats);
  py::list beside;
  for (const std::string_view name : matrix::kOpenFoamFiles) beside.append(std::string(name));
  module.attr("openfoam_files") = py::tuple(beside);
  module.def("view_factor", &view_factor_of, "scene"_a, "from_patch"_a, "to_patch"_a, "accuracy"_a, "budget"_a,
             "certify"_a);
  module.def("view_factor_matrix", &view_factor_matrix_of, "scene"_a, "from_patches"_a, "to_patches"_a, "accuracy"_a,
             "budget"_a, "certify"_a, "backs"_a, "open"_a, "both_directions"_a, "sums"_a, "threads"_a, "progress"_a);
  module.def("with_two_sided", &with_two_sided_of, "scene"_a, "names"_a);
  module.def("view", &view_of, "scene"_a, "point"_a, "normal"_a, "on"_a, "faces"_a, "digits"_a, "precision_cap"_a,
             "measure"_a);
}

// --- radiosities after all bounces ---

namespace {

using radiosity::Channel;
using radiosity::Solution;

constexpr std::size_t kNumbers = 6;  // radiosity: value, lower, upper; irradiance likewise

// (patches, channels, kNumbers).
Numbers quantities_of(const Solution& solution) {
  const std::size_t channels = solution.channels.size();
  Numbers array({solution.patches.size(), channels, kNumbers});
  auto entry = array.mutable_unchecked<3>();
  for (std::size_t c = 0; c < channels; ++c) {
    for (std::size_t i = 0; i < solution.patches.size(); ++i) {
      const radiosity::BoundedValue &b = solution.channels[c].radiosity[i], &h = solution.channels[c].irradiance[i];
      std::size_t k = 0;
      for (const double number : {b.value, b.lower, b.upper, h.value, h.lower, h.upper}) {
        entry(static_cast<py::ssize_t>(i), static_cast<py::ssize_t>(c), static_cast<py::ssize_t>(k++)) = number;
      }
    }
  }
  return array;
}

// For each channel the bounds of what is emitted, absorbed, meets backs, leaves, and does either of these two.
py::list balance_of(const Solution& solution) {
  py::list list;
  for (const Channel& channel : solution.channels) {
    const radiosity::Balance& b = channel.balance;
    py::list parts;
    for (const matrix::Sum& sum : {b.emitted, b.absorbed, b.back, b.open, b.lost}) {
      parts.append(py::make_tuple(sum.lower, sum.upper));
    }
    list.append(parts);
  }
  return list;
}

// Between patches; others only serve the balance.
std::size_t wide_entries(const matrix::Matrix& matrix) {
  const auto is_wide = [](const ViewFactor& f) { return !f.accurate; };
  return static_cast<std::size_t>(std::ranges::count_if(matrix.factors.entries, is_wide));
}

// Names, areas, quantities, reasons for no bound, claim, balance, its claim, reasons against it, wide view factors, the
// widest bounds, view factors computed again.
py::tuple radiosity_of(const SharedScene& scene, std::optional<double> accuracy, std::size_t budget,
                       std::optional<double> width, bool backs, int threads, const py::object& progress) {
  const Scene& in = scene.scene();
  Interrupt interrupt(progress);
  std::size_t wide = 0;
  const Solution solution = interrupt.run([&] {
    const std::vector<Selection> patches = radiosity::patches_of(in);
    radiosity::Options options{.factors = {.budget = budget}, .width = width, .backs = backs, .threads = threads};
    if (width) options.factors.accuracy = radiosity::accuracy_for(*width);
    if (accuracy) options.factors.accuracy = *accuracy;
    matrix::Matrix matrix =
        matrix::compute(in, patches, patches, radiosity::matrix_options(options), interrupt.hooks());
    Solution solved = radiosity::solve_within(in, matrix, options, nullptr, interrupt.hooks());
    wide = wide_entries(matrix);
    return solved;
  });
  std::vector<std::string> no_bound;
  for (const Channel& channel : solution.channels) no_bound.push_back(channel.no_bound);
  return py::make_tuple(names_of(in, solution.patches), solution.areas, quantities_of(solution), no_bound,
                        std::string(to_string(solution.claim)), balance_of(solution),
                        std::string(to_string(solution.claim_of_balance)), solution.reasons_against_balance, wide,
                        widest_bounds(solution).share, solution.computed_again);
}

}  // namespace

void bind_radiosity(py::module_& module) {
  module.def("radiosity", &radiosity_of, "scene"_a, "accuracy"_a, "budget"_a, "width"_a, "backs"_a, "threads"_a,
             "progress"_a);
}

}  // namespace exactff::python
