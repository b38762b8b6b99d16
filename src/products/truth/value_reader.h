// Reads the rows of a finished truth file in order.
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "exactff/exact.h"
#include "exactff/geometry.h"
#include "exactff/jobs.h"
#include "text/csv_lines.h"

namespace exactff::truth {

inline constexpr std::size_t kRowsBetweenChecks = 256;  // whether the user has cancelled

struct Values {
  double exact = 0.0, lower = 0.0, upper = 0.0;
  Status status = Status::kCertified;
  double visible_fraction = 0.0, unoccluded = 0.0;
  Rgb radiosity, total;
  Vec3 gradient;  // NaN at a kink

  // The number, or NaN where it is only an estimate.
  [[nodiscard]] double certified(double number) const;
};

class ValueReader {
 public:
  explicit ValueReader(const std::filesystem::path& file);

  [[nodiscard]] bool has_fractions() const { return has(fraction_); }
  [[nodiscard]] bool has_unoccluded() const { return has(unoccluded_); }
  [[nodiscard]] bool has_totals() const { return has(totals_.back()); }
  [[nodiscard]] bool has_gradients() const { return has(gradient_.back()); }
  [[nodiscard]] bool has_receivers() const;

  bool next();

  // Of the row last read.
  [[nodiscard]] const std::string& source() const { return fields_[source_]; }
  [[nodiscard]] Values values() const;
  // If has_receivers(). `on`: the name of its own faces; empty if there is none.
  [[nodiscard]] Vec3 point() const { return vector(point_); }
  [[nodiscard]] Vec3 normal() const;
  [[nodiscard]] const std::string& on() const { return fields_[on_]; }

  [[noreturn]] void damaged() const;

 private:
  static constexpr std::size_t kNoColumn = static_cast<std::size_t>(-1);
  using Three = std::array<std::size_t, 3>;

  [[nodiscard]] std::size_t column(std::string_view name) const;
  // All three, or none.
  [[nodiscard]] Three columns(std::string_view x, std::string_view y, std::string_view z) const;
  [[nodiscard]] static bool has(std::size_t column) { return column != kNoColumn; }
  [[nodiscard]] double number(std::size_t column) const;
  [[nodiscard]] Vec3 vector(const Three& of) const { return {number(of[0]), number(of[1]), number(of[2])}; }
  [[nodiscard]] Vec3 gradient() const;
  [[nodiscard]] Status status() const;

  text::CsvLines lines_;
  std::vector<std::string> fields_;
  std::size_t count_ = 0;  // of the columns
  std::size_t source_ = 0, status_ = 0, fraction_ = 0, unoccluded_ = 0, on_ = 0;
  std::array<std::size_t, 6> numbers_{};
  Three totals_{}, gradient_{}, point_{}, normal_{};
};

// The sources of the first receiver: the rows before its first source returns.
struct Shape {
  std::size_t rows = 0;
  std::vector<std::string> sources;
};
// Throws InputError unless every receiver has them all, in this order; and Cancelled.
[[nodiscard]] Shape shape_of(const std::filesystem::path& file, const jobs::RowHooks& hooks);

// The comments at the head of the file, without their '#'.
[[nodiscard]] std::vector<std::string> head_lines(const std::filesystem::path& truth_file);

}  // namespace exactff::truth
