// Grids of receivers on a face, and receivers from a CSV file.
//
// Grid of u x v cells on a face, in exact arithmetic, each centre rounded once at the end. Corners are p_i
// relative to the first one, n is the Newell vector.
//   1. A convex quadrilateral (no holes; convex seen along n): the bilinear map at ((2i+1)/2u, (2j+1)/2v).
//   2. Any other face: its bounding rectangle along e, the first edge cleared of its component along n, and
//      f = n x e. Neither is normalised, since their lengths are irrational: a point is described by the
//      integers a = e.p and b = f.p and is found again as a/(e.e) e + b/(f.f) f.
//   3. Of these keep the centres strictly inside: not on an edge, and an odd number of edges on one side.
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <string_view>
#include <unordered_set>

#include "exactff/error.h"
#include "exactff/receiver.h"
#include "scene/face_points.h"
#include "scene/number_text.h"
#include "scene/scene_data.h"
#include "scene/text_file.h"
#include "scene/text_lines.h"

namespace exactff {
namespace {

using kernel::ExactVec3;
using kernel::Integer;
using kernel::Rational;
using kernel::sign;

Rational scaled(const Integer& numerator, const Integer& denominator, long exponent) {
  Rational value(numerator, denominator);
  value.canonicalize();
  if (exponent >= 0) {
    value <<= static_cast<mp_bitcnt_t>(exponent);
  } else {
    value >>= static_cast<mp_bitcnt_t>(-exponent);
  }
  return value;
}

// The receivers of one face.
class FaceGrid {
 public:
  FaceGrid(const Scene& scene, FaceId id, GridSize size)
      : scene_(scene), id_(id), size_(size), points_(face_points(scene.vertices(), scene.face(id).rings)) {
    normal_ = newell(points_, 0, points_.ring_start[1]);
    kernel::make_primitive(normal_);
  }

  void append_to(std::vector<Receiver>& receivers) {
    is_convex_quadrilateral() ? append_bilinear(receivers) : append_rectangle(receivers);
  }

 private:
  // A coordinate of a point relative to the first corner, in units of 2^exponent.
  struct Fraction {
    Integer numerator;
    Integer denominator;
  };

  [[nodiscard]] bool is_convex_quadrilateral() const {
    if (points_.size() != 4) return false;
    for (std::size_t i = 0; i < 4; ++i) {
      const ExactVec3 &p = points_.at[i], &q = points_.at[(i + 1) % 4], &r = points_.at[(i + 2) % 4];
      if (sign(dot(normal_, cross(q - p, r - q))) <= 0) return false;
    }
    return true;
  }

  void append_bilinear(std::vector<Receiver>& receivers) const {
    const Integer whole = Integer(4) * size_.u * size_.v;
    for (int row = 1; row <= size_.v; ++row) {
      for (int column = 1; column <= size_.u; ++column) {
        const Integer s = 2 * column - 1, t = 2 * row - 1;
        const Integer s_rest = 2 * size_.u - s, t_rest = 2 * size_.v - t;
        const ExactVec3 sum = points_.at[0] * Integer(s_rest * t_rest) + points_.at[1] * Integer(s * t_rest) +
                              points_.at[2] * Integer(s * t) + points_.at[3] * Integer(s_rest * t);
        append(receivers, {Fraction{sum.x, whole}, {sum.y, whole}, {sum.z, whole}}, column, row);
      }
    }
  }

  void append(std::vector<Receiver>& receivers, const std::array<Fraction, 3>& at, int column, int row) const {
    const Vec3& first = scene_.vertices()[points_.vertex[0]];
    const auto rounded = [&](double origin, const Fraction& offset) {
      return kernel::nearest_double(kernel::to_rational(origin) +
                                    scaled(offset.numerator, offset.denominator, points_.exponent));
    };
    Receiver receiver;
    receiver.point = {rounded(first.x, at[0]), rounded(first.y, at[1]), rounded(first.z, at[2])};
    receiver.normal = scene_.face(id_).newell;
    receiver.on = id_;
    receiver.id = std::to_string(column) + ',' + std::to_string(row);
    receivers.push_back(std::move(receiver));
  }

  // The edge directions e and f, every corner's (a, b), and their sums.
  void set_up_rectangle() {
    const ExactVec3 edge = first_edge();
    e_ = edge * dot(normal_, normal_) - normal_ * dot(normal_, edge);
    kernel::make_primitive(e_);
    f_ = cross(normal_, e_);
    kernel::make_primitive(f_);
    for (const ExactVec3& p : points_.at) {
      a_.push_back(dot(e_, p));
      b_.push_back(dot(f_, p));
      a_sum_ += a_.back();
      b_sum_ += b_.back();
      sum_ = sum_ + p;
    }
  }

  [[nodiscard]] ExactVec3 first_edge() const {
    for (std::size_t i = 1; i < points_.size(); ++i) {
      ExactVec3 edge = points_.at[i] - points_.at[i - 1];
      if (!kernel::is_zero(cross(edge, normal_))) return edge;
    }
    return points_.at[1] - points_.at[0];
  }

  void append_rectangle(std::vector<Receiver>& receivers) {
    set_up_rectangle();
    const auto [a_min, a_max] = std::minmax_element(a_.begin(), a_.end());
    const auto [b_min, b_max] = std::minmax_element(b_.begin(), b_.end());
    for (int row = 1; row <= size_.v; ++row) {
      // All of (a, b) times 2u and 2v: the centres are then integers.
      const Integer b = *b_min * (2 * size_.v) + (*b_max - *b_min) * (2 * row - 1);
      for (int column = 1; column <= size_.u; ++column) {
        const Integer a = *a_min * (2 * size_.u) + (*a_max - *a_min) * (2 * column - 1);
        if (strictly_inside(a, b)) append(receivers, point_at(a, b), column, row);
      }
    }
  }

  [[nodiscard]] bool strictly_inside(const Integer& a, const Integer& b) const {
    bool inside = false;
    for (std::size_t ring = 0; ring < points_.ring_count(); ++ring) {
      const std::size_t begin = points_.ring_start[ring], end = points_.ring_start[ring + 1];
      for (std::size_t i = begin; i < end; ++i) {
        const int crossing = crosses(i, i + 1 < end ? i + 1 : begin, a, b);
        if (crossing < 0) return false;
        if (crossing > 0) inside = !inside;
      }
    }
    return inside;
  }

  // 1 if the ray from (a, b) towards larger a crosses the edge, 0 if not, -1 if (a, b) lies on the edge. An
  // edge owns its lower end, so that a ray through a corner counts the two edges there as one passing does.
  [[nodiscard]] int crosses(std::size_t i, std::size_t j, const Integer& a, const Integer& b) const {
    const Integer ai = a_[i] * (2 * size_.u) - a, bi = b_[i] * (2 * size_.v) - b;
    const Integer aj = a_[j] * (2 * size_.u) - a, bj = b_[j] * (2 * size_.v) - b;
    const int side = sign(Integer(ai * bj - aj * bi));  // positive: the centre is left of the edge
    const int bi_sign = sign(bi), bj_sign = sign(bj);
    if (side == 0 && bi_sign * bj_sign <= 0 && sign(ai) * sign(aj) <= 0) return -1;
    if ((bi_sign > 0) == (bj_sign > 0)) return 0;
    return (bj_sign > 0) == (side > 0) ? 1 : 0;
  }

  // mean + (a - a_mean)/(e.e) e + (b - b_mean)/(f.f) f, where (a, b) come times (2u, 2v). In the plane of a
  // planar face the mean drops out.
  [[nodiscard]] std::array<Fraction, 3> point_at(const Integer& a, const Integer& b) const {
    const Integer count = static_cast<unsigned long>(points_.size());
    const Rational along_e(Integer(a * count - a_sum_ * (2 * size_.u)), Integer(dot(e_, e_) * count * (2 * size_.u)));
    const Rational along_f(Integer(b * count - b_sum_ * (2 * size_.v)), Integer(dot(f_, f_) * count * (2 * size_.v)));
    std::array<Fraction, 3> at;
    for (int axis = 0; axis < 3; ++axis) {
      Rational mean(sum_[axis], count);
      mean.canonicalize();
      const Rational value = mean + canonical(along_e) * e_[axis] + canonical(along_f) * f_[axis];
      at[static_cast<std::size_t>(axis)] = {value.get_num(), value.get_den()};
    }
    return at;
  }

  static Rational canonical(Rational value) {
    value.canonicalize();
    return value;
  }

  const Scene& scene_;
  FaceId id_;
  GridSize size_;
  FacePoints points_;
  ExactVec3 normal_;
  ExactVec3 e_;
  ExactVec3 f_;
  std::vector<Integer> a_;
  std::vector<Integer> b_;
  Integer a_sum_ = 0;
  Integer b_sum_ = 0;
  ExactVec3 sum_;
};

bool parse_count(std::string_view text, int& value) {
  const auto end = std::from_chars(text.data(), text.data() + text.size(), value);
  return end.ec == std::errc{} && end.ptr == text.data() + text.size();
}

// --- CSV ---------------------------------------------------------------------------------------------

constexpr std::array<std::string_view, 8> kColumns = {"id", "x", "y", "z", "nx", "ny", "nz", "on"};
constexpr std::size_t kId = 0, kX = 1, kNx = 4, kOn = 7;

// Lines that end in LF, CRLF or CR, without a byte order mark.
class TextRows {
 public:
  explicit TextRows(std::string_view text) : rest_(text) {
    if (rest_.starts_with("\xEF\xBB\xBF")) rest_.remove_prefix(3);
  }
  bool next(std::string_view& line) {
    if (rest_.empty()) return false;
    const std::size_t end = std::min(rest_.find_first_of("\r\n"), rest_.size());
    line = rest_.substr(0, end);
    rest_.remove_prefix(end);
    rest_.remove_prefix(rest_.starts_with("\r\n") ? 2 : std::min<std::size_t>(rest_.size(), 1));
    return true;
  }

 private:
  std::string_view rest_;
};

// The fields of one line, or nothing where a quote is not closed or text follows a closing one.
std::optional<std::vector<std::string>> split(std::string_view line) {
  std::vector<std::string> fields;
  std::size_t at = 0;
  while (true) {
    while (at < line.size() && (line[at] == ' ' || line[at] == '\t')) ++at;
    if (at < line.size() && line[at] == '"') {
      std::string field;
      for (++at;; ++at) {
        if (at >= line.size()) return std::nullopt;
        if (line[at] != '"') {
          field += line[at];
        } else if (at + 1 < line.size() && line[at + 1] == '"') {
          field += line[at++];
        } else {
          break;
        }
      }
      const std::size_t comma = std::min(line.find(',', at), line.size());
      if (!trimmed(line.substr(at + 1, comma - at - 1)).empty()) return std::nullopt;
      fields.push_back(std::move(field));
      at = comma;
    } else {
      const std::size_t comma = std::min(line.find(',', at), line.size());
      fields.emplace_back(trimmed(line.substr(at, comma - at)));
      at = comma;
    }
    if (at >= line.size()) return fields;
    ++at;
  }
}

class ReceiverTable {
 public:
  ReceiverTable(std::string file, const Scene& scene) : file_(std::move(file)), scene_(scene) {}

  std::vector<Receiver> read(std::string_view text) {
    TextRows rows(text);
    for (std::string_view line; rows.next(line);) {
      ++line_;
      const std::string_view content = trimmed(line);
      if (!content.empty() && content.front() != '#') take(line);
    }
    if (!header_read_) complain("the file has no header", "its columns are told apart by name", kHeaderAdvice);
    problems_.throw_if_any();
    return std::move(receivers_);
  }

 private:
  static constexpr const char* kHeaderAdvice = "begin it with id,x,y,z,nx,ny,nz,on";

  void complain(std::string what, std::string why, std::string suggestion = {}) {
    problems_.add({file_, line_, std::move(what), std::move(why), std::move(suggestion)});
    ++problem_count_;
  }

  void take(std::string_view line) {
    const auto fields = split(line);
    if (!fields) {
      complain("a quotation mark is not closed, or text follows it", "fields would be told apart wrongly",
               "write a quotation mark within quotes twice");
    } else if (!header_read_) {
      take_header(*fields);
    } else if (usable_) {
      take_row(*fields);
    }
  }

  void take_header(const std::vector<std::string>& names) {
    header_read_ = true;
    column_.fill(names.size());
    field_count_ = names.size();
    const std::size_t before = problem_count_;
    for (std::size_t i = 0; i < names.size(); ++i) {
      const auto known = std::find(kColumns.begin(), kColumns.end(), names[i]);
      if (known == kColumns.end()) {
        complain("unknown column " + in_quotes(names[i]), "a misspelt name would be silently ignored",
                 "the columns are id,x,y,z,nx,ny,nz,on");
        continue;
      }
      std::size_t& column = column_[static_cast<std::size_t>(known - kColumns.begin())];
      if (column < field_count_)
        complain("column " + in_quotes(names[i]) + " occurs twice", "only one can count", "remove one");
      column = i;
    }
    for (std::size_t c = kX; c < kOn; ++c) {
      if (column_[c] < field_count_) continue;
      complain("there is no column '" + std::string(kColumns[c]) + "'", "a receiver is a point with a normal",
               kHeaderAdvice);
    }
    usable_ = problem_count_ == before;
  }

  void take_row(const std::vector<std::string>& fields) {
    if (fields.size() != field_count_) {
      complain(std::to_string(fields.size()) + " fields where the header has " + std::to_string(field_count_),
               "columns would be mixed up", "separate fields by commas and quote those that hold one");
      return;
    }
    const std::size_t before = problem_count_;
    Receiver receiver;
    receiver.point = vector_at(fields, kX);
    receiver.normal = vector_at(fields, kNx);
    if (problem_count_ == before && receiver.normal == Vec3{}) {
      complain("the normal is zero", "it says which way the receiver faces", "give it any other length");
    }
    if (column_[kOn] < field_count_ && !fields[column_[kOn]].empty()) receiver.on = face_named(fields[column_[kOn]]);
    if (column_[kId] < field_count_) receiver.id = fields[column_[kId]];
    take_id(receiver.id);
    receivers_.push_back(std::move(receiver));
  }

  // A row without an id is called by its number.
  void take_id(std::string& id) {
    if (id.empty()) id = std::to_string(receivers_.size() + 1);
    if (!ids_.insert(id).second) {
      complain("the id " + in_quotes(id) + " is used twice", "rows of the results could not be told apart",
               "give every receiver an id of its own, or none");
    }
  }

  Vec3 vector_at(const std::vector<std::string>& fields, std::size_t first) {
    return {number_at(fields, first), number_at(fields, first + 1), number_at(fields, first + 2)};
  }

  double number_at(const std::vector<std::string>& fields, std::size_t c) {
    const std::string& text = fields[column_[c]];
    const ParsedNumber number = parse_number(text);
    if (number.fault == NumberFault::kNone) return number.value;
    complain(describe(number.fault, text) + " in column " + std::string(kColumns[c]),
             "points and normals are made of finite doubles", advice(number.fault));
    return 0.0;
  }

  // Looking for names like an unknown one takes time; where it would be told to nobody, it is not done.
  std::optional<FaceId> face_named(const std::string& name) {
    constexpr std::size_t kExplained = 20;
    const auto& patches = scene_.data().patch_by_name;
    const bool known = patches.contains(name) || patches.contains(name.substr(0, name.rfind(':')));
    if (problem_count_ >= kExplained && !known) {
      complain("there is no face " + in_quotes(name), "it lies on no face of the scene", "see the first such line");
      return std::nullopt;
    }
    try {
      const Selection selection = scene_.select(name);
      if (selection.face) return selection.face;
      const std::vector<FaceId>& faces = scene_.patch(selection.patch).faces;
      if (faces.size() == 1) return faces.front();
      complain(in_quotes(name, kShownName) + " has " + std::to_string(faces.size()) + " faces",
               "a receiver lies on one of them", "write " + in_quotes(name + ":k", kShownName) + " for its k-th face");
    } catch (const InputError& error) {
      for (const Problem& p : error.problems()) complain(p.what, p.why, p.suggestion);
    }
    return std::nullopt;
  }

  std::string file_;
  const Scene& scene_;
  std::size_t line_ = 0;
  bool header_read_ = false;
  bool usable_ = false;
  std::size_t field_count_ = 0;
  std::array<std::size_t, kColumns.size()> column_{};  // field_count_ where the column is absent
  std::unordered_set<std::string> ids_;
  std::vector<Receiver> receivers_;
  ProblemList problems_;
  std::size_t problem_count_ = 0;
};

// Every cell costs time and memory: what nobody can have meant is refused before it is begun.
void check_grid_size(GridSize size, std::size_t faces) {
  constexpr std::uint64_t kMostCells = std::uint64_t{1} << 22;
  const std::uint64_t cells = static_cast<std::uint64_t>(size.u) * static_cast<std::uint64_t>(size.v);
  if (cells * (faces > 0 ? 1 : 0) <= kMostCells / std::max<std::uint64_t>(faces, 1)) return;
  throw InputError(Problem{{},
                           0,
                           "a grid of " + std::to_string(size.u) + "x" + std::to_string(size.v) + " cells on " +
                               std::to_string(faces) + (faces == 1 ? " face" : " faces"),
                           "there may be " + std::to_string(kMostCells) + " cells in all",
                           "use fewer, or a smaller patch"});
}

}  // namespace

std::vector<Receiver> grid_receivers(const Scene& scene, const Selection& on, GridSize size) {
  if (size.u < 1 || size.v < 1) {
    throw InputError(Problem{{},
                             0,
                             "a grid of " + std::to_string(size.u) + "x" + std::to_string(size.v) + " cells",
                             "each count is at least 1",
                             "write it as 32x32"});
  }
  const std::vector<FaceId> faces = scene.faces_of(on);
  check_grid_size(size, faces.size());
  std::vector<Receiver> receivers;
  for (FaceId face : faces) FaceGrid(scene, face, size).append_to(receivers);
  return receivers;
}

std::optional<GridCell> grid_cell(const Receiver& receiver) {
  const std::string_view id = receiver.id;
  const std::size_t comma = id.find(',');
  GridCell cell;
  if (!receiver.on || comma == std::string_view::npos) return std::nullopt;
  if (!parse_count(id.substr(0, comma), cell.column) || !parse_count(id.substr(comma + 1), cell.row)) {
    return std::nullopt;
  }
  cell.face = *receiver.on;
  return cell.column >= 1 && cell.row >= 1 ? std::optional(cell) : std::nullopt;
}

std::vector<Receiver> read_receivers(const std::filesystem::path& path, const Scene& scene) {
  return ReceiverTable(path.string(), scene).read(read_text_file(path, "a CSV file of receivers"));
}

}  // namespace exactff
