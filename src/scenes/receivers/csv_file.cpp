// Receivers from a CSV file.
#include <algorithm>
#include <array>
#include <string_view>
#include <unordered_map>

#include "exactff/error.h"
#include "exactff/receiver.h"
#include "kernel/float_environment.h"
#include "scene/scene.h"
#include "text/csv_lines.h"
#include "text/number_text.h"
#include "text/text_lines.h"

namespace exactff {
namespace {

constexpr std::array<std::string_view, 8> kColumns = {"id", "x", "y", "z", "nx", "ny", "nz", "on"};
constexpr std::size_t kId = 0, kX = 1, kNx = 4, kOn = 7;

class ReceiverTable {
 public:
  ReceiverTable(const std::filesystem::path& path, const Scene& scene)
      : lines_(path, "a CSV file of receivers"), scene_(scene) {}
  ReceiverTable(std::istream& in, const std::string& name, const Scene& scene)
      : lines_(in, name, "a CSV file of receivers"), scene_(scene) {}

  std::vector<Receiver> read() {
    for (std::string_view line; lines_.next(line);) {
      if (!text::is_csv_comment(line)) take(line);
    }
    if (!header_read_) complain("the file has no header", "columns are identified by their names", kHeaderAdvice);
    problems_.throw_if_any();
    return std::move(receivers_);
  }

 private:
  static constexpr const char* kHeaderAdvice = "begin the file with the line id,x,y,z,nx,ny,nz,on";

  void complain(std::string what, std::string why, std::string suggestion = {}) {
    problems_.add({lines_.file(), lines_.number(), std::move(what), std::move(why), std::move(suggestion)});
    ++problem_count_;
  }

  void take(std::string_view line) {
    if (!header_read_) dialect_ = text::CsvDialect(line);
    if (!dialect_.split(line, fields_)) {
      complain("a quotation mark is not closed, or text follows it", "the fields cannot be separated",
               "write a quotation mark inside quotes twice");
    } else if (!header_read_) {
      take_header(fields_);
    } else if (usable_) {
      take_row(fields_);
    }
  }

  void take_header(const std::vector<std::string>& names) {
    header_read_ = true;
    column_.fill(names.size());
    field_count_ = names.size();
    const std::size_t before = problem_count_;
    const auto has = [&](std::string_view name) { return std::find(names.begin(), names.end(), name) != names.end(); };
    is_truth_ = has("receiver") && has("source") && has("exact");
    for (std::size_t i = 0; i < names.size(); ++i) {
      const auto known = find_column(names[i]);
      if (known == kColumns.end() && is_truth_) continue;  // a result
      if (known == kColumns.end()) {
        complain("unknown column " + text::in_quotes(names[i]), "a misspelt name would be ignored without any warning",
                 "the columns are id,x,y,z,nx,ny,nz,on");
        continue;
      }
      std::size_t& column = column_[static_cast<std::size_t>(known - kColumns.begin())];
      if (column < field_count_)
        complain("column " + text::in_quotes(names[i]) + " occurs twice", "only one can count", "remove one");
      column = i;
    }
    for (std::size_t c = kX; c < kOn; ++c) {
      if (column_[c] < field_count_) continue;
      complain("there is no column '" + std::string(kColumns[c]) + "'", "a receiver is a point with a normal",
               kHeaderAdvice);
    }
    usable_ = problem_count_ == before;
  }

  // In a truth file, the receiver's id is called `receiver`.
  [[nodiscard]] decltype(kColumns)::const_iterator find_column(std::string_view name) const {
    return std::find(kColumns.begin(), kColumns.end(), is_truth_ && name == "receiver" ? kColumns[kId] : name);
  }

  void take_row(const std::vector<std::string>& fields) {
    if (fields.size() != field_count_) {
      complain(std::to_string(fields.size()) + " fields where the header has " + std::to_string(field_count_),
               "values would be assigned to the wrong columns",
               "separate fields as the header does, and quote fields that contain the separator");
      return;
    }
    const std::size_t before = problem_count_;
    Receiver receiver;
    receiver.point = vector_at(fields, kX);
    receiver.normal = vector_at(fields, kNx);
    if (problem_count_ == before && receiver.normal == Vec3{}) {
      complain("the normal is zero", "it says which way the receiver faces", "give a normal of any other length");
    }
    if (column_[kOn] < field_count_ && !fields[column_[kOn]].empty()) receiver.on = faces_named(fields[column_[kOn]]);
    if (column_[kId] < field_count_) receiver.id = fields[column_[kId]];
    if (is_truth_ && repeats(receiver)) return;
    take_id(receiver.id);
    receivers_.push_back(std::move(receiver));
  }

  // Whether an earlier row has the same receiver, with another source.
  [[nodiscard]] bool repeats(const Receiver& receiver) const {
    const auto found = ids_.find(receiver.id);
    if (found == ids_.end()) return false;
    const Receiver& other = receivers_[found->second];
    return receiver.point == other.point && receiver.normal == other.normal && receiver.on == other.on;
  }

  // The id of a row without an id is its number.
  void take_id(std::string& id) {
    if (id.empty()) id = std::to_string(receivers_.size() + 1);
    if (!ids_.emplace(id, receivers_.size()).second) {
      complain("the id " + text::in_quotes(id) + " is used twice", "rows of the results could not be distinguished",
               "give every receiver a different id, or no id");
    }
  }

  Vec3 vector_at(const std::vector<std::string>& fields, std::size_t first) {
    return {number_at(fields, first), number_at(fields, first + 1), number_at(fields, first + 2)};
  }

  double number_at(const std::vector<std::string>& fields, std::size_t c) {
    const std::string& text = fields[column_[c]];
    const text::ParsedNumber number = dialect_.number(text);
    if (number.fault == text::NumberFault::kNone) return number.value;
    complain(describe(number.fault, text) + " in column " + std::string(kColumns[c]),
             "points and normals are made of finite doubles", advice(number.fault));
    return 0.0;
  }

  // Searching for similar names takes time; it is skipped if the message would not be shown.
  std::vector<FaceId> faces_named(const std::string& name) {
    constexpr std::size_t kExplained = 20;
    const auto& patches = SceneInside::data(scene_).patch_by_name;
    const bool known = patches.contains(name) || patches.contains(name.substr(0, name.rfind(':')));
    if (problem_count_ >= kExplained && !known) {
      complain("there is no face " + text::in_quotes(name), "the receiver must lie on a face of the scene",
               "see the message for the first such line");
      return {};
    }
    try {
      return own_faces_named(scene_, name);
    } catch (const InputError& error) {
      for (const Problem& p : error.problems()) complain(p.what, p.why, p.suggestion);
    }
    return {};
  }

  text::CsvLines lines_;
  text::CsvDialect dialect_;
  const Scene& scene_;
  std::vector<std::string> fields_;
  bool header_read_ = false;
  bool usable_ = false;
  bool is_truth_ = false;
  std::size_t field_count_ = 0;
  std::array<std::size_t, kColumns.size()> column_{};  // field_count_ where the column is absent
  std::unordered_map<std::string, std::size_t> ids_;   // places in receivers_
  std::vector<Receiver> receivers_;
  text::ProblemList problems_;
  std::size_t problem_count_ = 0;
};

}  // namespace

std::vector<Receiver> read_receivers(const std::filesystem::path& path, const Scene& scene) {
  const kernel::StandardArithmetic arithmetic;
  return ReceiverTable(path, scene).read();
}

std::vector<Receiver> read_receivers(std::istream& in, const std::string& name, const Scene& scene) {
  const kernel::StandardArithmetic arithmetic;
  return ReceiverTable(in, name, scene).read();
}

}  // namespace exactff
