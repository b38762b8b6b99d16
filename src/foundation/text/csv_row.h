// One row of a CSV file.
#pragma once

#include <cstdint>
#include <optional>
#include <ostream>
#include <string>
#include <string_view>

#include "exactff/geometry.h"
#include "text/escape.h"
#include "text/phrases.h"

namespace exactff::text {

// A comma-separated row, appended to a text or a stream. Fields are appended from left to right.
class CsvRow {
 public:
  explicit CsvRow(std::string& text) : text_(text) {}
  explicit CsvRow(std::ostream& out) : out_(&out), text_(own_) {}
  ~CsvRow() {
    text_ += '\n';
    if (out_ != nullptr) *out_ << own_;
  }
  CsvRow(const CsvRow&) = delete;
  CsvRow& operator=(const CsvRow&) = delete;

  CsvRow& operator<<(std::string_view text) { return put(csv_field(text)); }
  CsvRow& operator<<(double value) { return put(shortest(value)); }
  CsvRow& operator<<(const Vec3& v) { return *this << v.x << v.y << v.z; }
  CsvRow& operator<<(std::uint64_t count) { return put(std::to_string(count)); }
  CsvRow& operator<<(int count) { return put(std::to_string(count)); }
  // Nothing becomes an empty field.
  template <class Value>
  CsvRow& operator<<(const std::optional<Value>& value) {
    return value ? *this << *value : put({});
  }

 private:
  CsvRow& put(std::string_view field) {
    if (!first_) text_ += ',';
    first_ = false;
    text_ += field;
    return *this;
  }
  std::ostream* out_ = nullptr;
  std::string own_;
  std::string& text_;
  bool first_ = true;
};

}  // namespace exactff::text
