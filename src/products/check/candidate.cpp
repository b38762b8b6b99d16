// Reads the values of another program.
#include <initializer_list>
#include <limits>

#include "check/grid_ids.h"
#include "check/name_list.h"
#include "exactff/check.h"
#include "kernel/float_environment.h"
#include "table/csv.h"

namespace exactff::check {
namespace {

class CandidateReader {
 public:
  CandidateReader(const std::filesystem::path& path, const CandidateColumns& columns, MatchBy by)
      : table_(path, "a CSV file of values"), by_(by) {
    candidate_.file = table_.file();
    find_columns(columns);
  }

  Candidate read() {
    const bool has_columns = table_.is_sound();
    while (has_columns && table_.next()) take_row();
    table_.throw_if_any();
    candidate_.sources = sources_.take();
    return std::move(candidate_);
  }

 private:
  void find_columns(const CandidateColumns& columns) {
    value_ = find(columns.value, {"value", "approximate", "exact"}, "it contains the values to check",
                  "name it with --value-column");
    const bool by_position = by_ == MatchBy::kPosition;
    if (!by_position) {
      receiver_ = find(columns.receiver, {"receiver", "id"}, "it says which row of the truth a value belongs to",
                       "name it with --receiver-column, or use --match position");
    }
    find_source(columns.source);
    if (by_position) find_coordinates(columns);
  }

  std::size_t find(const std::string& given, std::initializer_list<std::string_view> defaults, const std::string& why,
                   const std::string& suggestion) {
    return given.empty() ? table_.needed_column(defaults, why, suggestion)
                         : table_.needed_column({given}, why, "check the spelling");
  }

  void find_source(const std::string& given) {
    const auto found = given.empty() ? table_.column("source") : find(given, {}, "it names the source", "");
    candidate_.has_sources = found.has_value();
    source_ = found.value_or(0);
  }

  void find_coordinates(const CandidateColumns& columns) {
    for (std::size_t i = 0; i < 3; ++i) {
      point_[i] = find(columns.position[i], {}, "rows are matched by position", "name it with --position-columns");
    }
    candidate_.has_normals = true;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto found = table_.column(columns.normal[i]);
      if (!found) candidate_.has_normals = false;
      normal_[i] = found.value_or(0);
    }
  }

  void take_row() {
    CandidateRow row;
    row.line = static_cast<std::uint32_t>(table_.line());
    if (by_ == MatchBy::kReceiver) take_receiver(row);
    row.source = sources_.number_of(candidate_.has_sources ? table_.field(source_) : std::string());
    if (by_ == MatchBy::kPosition) row.point = table_.vector(point_);
    if (candidate_.has_normals) row.normal = table_.vector(normal_);
    row.value = table_.number(value_, table::NotFinite::kAccept);
    candidate_.rows.push_back(std::move(row));
  }

  void take_receiver(CandidateRow& row) {
    row.receiver = current_id(table_.field(receiver_));
    if (row.receiver.empty()) {
      table_.complain("the receiver has no id", "its row in the truth cannot be found", "give it an id");
    }
  }

  table::CsvReader table_;
  MatchBy by_;
  Candidate candidate_;
  NameList sources_;
  std::size_t value_ = 0, receiver_ = 0, source_ = 0;
  std::array<std::size_t, 3> point_{}, normal_{};
};

}  // namespace

Candidate read_candidate(const std::filesystem::path& path, const CandidateColumns& columns, MatchBy by) {
  const kernel::StandardArithmetic arithmetic;
  return CandidateReader(path, columns, by).read();
}

}  // namespace exactff::check
