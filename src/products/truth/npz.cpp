// The receivers and values of a finished truth file as NumPy arrays.
#include <array>
#include <cstdint>
#include <map>
#include <span>

#include "exactff/truth.h"
#include "files/numpy.h"
#include "jobs/journal.h"
#include "kernel/float_environment.h"
#include "text/refuse.h"
#include "truth/unit_normal.h"
#include "truth/value_reader.h"

namespace exactff::truth {
namespace {

class Arrays {
 public:
  void add_receiver(const ValueReader& reader) {
    add(points_, reader.point());
    add(normals_, unit_normal_.of(reader.normal()));
    on_.push_back(reader.on().empty() ? kNone : number_of(reader.on()));
    if (!reader.has_totals()) return;
    const Values values = reader.values();
    for (const double total : {values.total.r, values.total.g, values.total.b})
      totals_.push_back(values.certified(total));
  }
  void add_value(const ValueReader& reader) {
    const Values values = reader.values();
    factors_.push_back(values.certified(values.exact));
    if (reader.has_gradients()) add(gradients_, values.gradient);
    if (reader.has_fractions()) fractions_.push_back(values.certified(values.visible_fraction));
    if (reader.has_unoccluded()) unoccluded_.push_back(values.certified(values.unoccluded));
  }
  void write(files::NpzFile& file, const std::vector<std::string>& sources) const {
    add_table(file, "points", points_, 3);
    add_table(file, "normals", normals_, 3);
    file.add("on", on_);
    file.add_texts("faces", faces_);
    file.add_texts("sources", sources);
    add_table(file, "F", factors_, sources.size());
    if (!fractions_.empty()) add_table(file, "visible_fraction", fractions_, sources.size());
    if (!gradients_.empty()) {
      const std::array shape{gradients_.size() / (3 * sources.size()), sources.size(), std::size_t{3}};
      file.add("gradient", shape, std::span<const double>(gradients_));
    }
    if (!unoccluded_.empty()) add_table(file, "unoccluded", unoccluded_, sources.size());
    if (!totals_.empty()) add_table(file, "total", totals_, 3);
  }

 private:
  static constexpr std::int32_t kNone = -1;

  static void add(std::vector<double>& numbers, const Vec3& v) { numbers.insert(numbers.end(), {v.x, v.y, v.z}); }
  static void add_table(files::NpzFile& file, const char* name, const std::vector<double>& numbers,
                        std::size_t columns) {
    const std::array shape{numbers.size() / columns, columns};
    file.add(name, shape, std::span<const double>(numbers));
  }
  std::int32_t number_of(const std::string& face) {
    const auto [found, is_new] = numbers_.emplace(face, static_cast<std::int32_t>(faces_.size()));
    if (is_new) faces_.push_back(face);
    return found->second;
  }

  std::vector<double> points_, normals_, factors_, fractions_, gradients_, unoccluded_, totals_;
  std::vector<std::int32_t> on_;
  std::vector<std::string> faces_;
  std::map<std::string, std::int32_t> numbers_;
  UnitNormal unit_normal_;
};

}  // namespace

void write_npz(const std::filesystem::path& truth_file, const std::filesystem::path& file,
               const jobs::RowHooks& hooks) {
  const kernel::StandardArithmetic arithmetic;
  const Shape shape = shape_of(truth_file, hooks);
  ValueReader reader(truth_file);
  if (!reader.has_receivers()) {
    text::refuse(truth_file, "has no columns x,y,z, nx,ny,nz and on", "the arrays hold the receivers as well",
                 "name a file that exactff truth or merge has written, or use --npy");
  }
  Arrays arrays;
  jobs::Pace pace("reading rows", shape.rows, hooks);
  for (std::size_t row = 0; row < shape.rows && reader.next(); ++row) {
    if (row % shape.sources.size() == 0) arrays.add_receiver(reader);
    arrays.add_value(reader);
    if ((row + 1) % kRowsBetweenChecks == 0) pace.add(kRowsBetweenChecks);
  }
  pace.add(0);
  files::NpzFile archive(file);
  arrays.write(archive, shape.sources);
  archive.add_texts("about", head_lines(truth_file));
  archive.commit();
}

}  // namespace exactff::truth
