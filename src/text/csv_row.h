// One row of a CSV file.
#pragma once

#include <cstdint>
#include <ostream>
#include <string>
#include <string_view>

#include "exactff/geometry.h"
#include "text/escape.h"
#include "text/phrases.h"

namespace exactff::text {

// A comma-separated row. Fields are appended from left to right.
class CsvRow {
 public:
  explicit CsvRow(std::ostream& out) : out_(out) {}
  ~CsvRow() { out_ << '\n'; }
  CsvRow(const CsvRow&) = delete;
  CsvRow& operator=(const CsvRow&) = delete;

  CsvRow& operator<<(std::string_view text) { return put(csv_field(text)); }
  CsvRow& operator<<(double value) { return put(shortest(value)); }
  CsvRow& operator<<(const Vec3& v) { return *this << v.x << v.y << v.z; }
  CsvRow& operator<<(std::uint64_t count) { return put(std::to_string(count)); }
  CsvRow& operator<<(int count) { return put(std::to_string(count)); }

 private:
  CsvRow& put(std::string_view field) {
    if (!first_) out_ << ',';
    first_ = false;
    out_ << field;
    return *this;
  }
  std::ostream& out_;
  bool first_ = true;
};

}  // namespace exactff::text
