#include "formats/ply_header.h"

#include <algorithm>
#include <array>
#include <utility>

namespace exactff::formats {

namespace {

constexpr std::size_t kMost = 1000;  // elements, and properties of one

constexpr std::array<std::pair<std::string_view, PlyType>, 16> kTypes = {{
    {"char", PlyType::kInt8},
    {"int8", PlyType::kInt8},
    {"uchar", PlyType::kUint8},
    {"uint8", PlyType::kUint8},
    {"short", PlyType::kInt16},
    {"int16", PlyType::kInt16},
    {"ushort", PlyType::kUint16},
    {"uint16", PlyType::kUint16},
    {"int", PlyType::kInt32},
    {"int32", PlyType::kInt32},
    {"uint", PlyType::kUint32},
    {"uint32", PlyType::kUint32},
    {"float", PlyType::kFloat32},
    {"float32", PlyType::kFloat32},
    {"double", PlyType::kFloat64},
    {"float64", PlyType::kFloat64},
}};

// Lines end in LF or CRLF. If the first one ends in CR alone, all of them do: binary data may begin with LF.
class HeaderLines {
 public:
  explicit HeaderLines(std::string_view bytes) : bytes_(bytes) {
    constexpr std::string_view kMark = "\xEF\xBB\xBF";  // of the byte order
    if (bytes_.starts_with(kMark)) at_ = kMark.size();
    const std::size_t first = bytes_.find_first_of("\r\n", at_);
    if (first == std::string_view::npos) return;
    end_ = bytes_[first] == '\r' && !bytes_.substr(first).starts_with("\r\n") ? '\r' : '\n';
  }

  bool next(std::string_view& line) {
    constexpr std::size_t kLongest = std::size_t{1} << 20;
    const std::size_t end = bytes_.substr(0, at_ + kLongest).find(end_, at_);
    if (end == std::string_view::npos) return false;
    line = bytes_.substr(at_, end - at_);
    at_ = end + 1;
    ++number_;
    return true;
  }
  std::size_t number() const { return number_; }
  std::size_t bytes() const { return at_; }

 private:
  std::string_view bytes_;
  char end_ = '\n';
  std::size_t at_ = 0;
  std::size_t number_ = 0;
};

class HeaderReader {
 public:
  HeaderReader(std::string_view bytes, MeshInput& input) : lines_(bytes), input_(input) {}

  PlyHeader run() {
    std::string_view line;
    if (!lines_.next(line) || text::trimmed(line) != "ply") {
      input_.give_up(at_line(1), "the first line is not 'ply'", "a PLY file begins with it", "is it a PLY file?");
    }
    while (lines_.next(line)) {
      if (read_line(line)) return finished();
    }
    fail("the header has no end", "the data begin after the line end_header", "is the file complete?");
  }

 private:
  // True at the end of the header.
  bool read_line(std::string_view line) {
    if (line.find('\n') != std::string_view::npos)
      fail("the lines of the header end differently", "it is not clear where the data begin",
           "use one kind of line end");
    std::string_view rest = line;
    const std::string_view keyword = text::take_word(rest);
    if (keyword == "end_header") return true;
    if (keyword.empty() || keyword == "obj_info") return false;
    if (keyword == "format") {
      read_encoding(rest);
    } else if (keyword == "comment") {
      read_comment(rest);
    } else if (keyword == "element") {
      read_element(rest);
    } else if (keyword == "property") {
      read_property(rest);
    } else {
      fail("unknown keyword " + text::in_quotes(keyword) + " in the header",
           "the meaning of the data depends on every line of it", "correct the line");
    }
    return false;
  }

  void read_encoding(std::string_view words) {
    static constexpr std::array<std::string_view, 3> kNames = {"ascii", "binary_little_endian", "binary_big_endian"};
    const std::string_view name = text::take_word(words);
    const std::string_view version = text::take_word(words);
    const auto found = std::find(kNames.begin(), kNames.end(), name);
    if (found == kNames.end() || version != "1.0") {
      fail("unknown format " + text::in_quotes(std::string(name) + " " + std::string(version)),
           "exactff reads ascii, binary_little_endian and binary_big_endian, each of version 1.0", "convert the file");
    }
    header_.encoding = static_cast<PlyEncoding>(found - kNames.begin());
    has_encoding_ = true;
  }

  // exactff's own convention: other programs pass over comments.
  void read_comment(std::string_view words) {
    if (text::take_word(words) != "patch") return;
    const auto number = whole_number(text::take_word(words));
    const std::string_view name = text::trimmed(words);
    if (number && !name.empty()) header_.patch_names.try_emplace(*number, name);
  }

  void read_element(std::string_view words) {
    const std::string_view name = text::take_word(words);
    const std::string_view word = text::take_word(words);
    const auto count = whole_number(word);
    if (name.empty() || !count || *count < 0) {
      fail("an element needs a name and a count, and " + text::in_quotes(word) + " is no count",
           "the data are read by the counts of the header", "write element NAME COUNT");
    }
    const auto same = [&](const PlyElement& element) { return element.name == name; };
    if (std::any_of(header_.elements.begin(), header_.elements.end(), same))
      fail("element " + text::in_quotes(name) + " is declared twice", "it is not clear which one counts", "remove one");
    if (header_.elements.size() == kMost) fail("more than 1000 elements", "no program needs them", "is it a PLY file?");
    header_.elements.push_back({std::string(name), static_cast<std::uint64_t>(*count), lines_.number(), {}});
  }

  void read_property(std::string_view words) {
    if (header_.elements.empty())
      fail("a property before any element", "it does not belong to anything", "declare its element first");
    PlyProperty property;
    std::string_view type = text::take_word(words);
    if (type == "list") {
      property.count_type = type_named(text::take_word(words));
      type = text::take_word(words);
      if (!is_whole(*property.count_type))
        fail("the count of a list is not an integer", "it counts the items of the list", "use uchar or int");
    }
    property.type = type_named(type);
    property.name = text::take_word(words);
    if (property.name.empty()) fail("a property without a name", "its data have no meaning", "give it a name");
    PlyElement& element = header_.elements.back();
    if (element.find(property.name)) {
      fail("property " + text::in_quotes(property.name) + " is declared twice", "it is not clear which one counts",
           "remove one");
    }
    if (element.properties.size() == kMost)
      fail("more than 1000 properties", "no program needs them", "is it a PLY file?");
    element.properties.push_back(std::move(property));
  }

  PlyType type_named(std::string_view name) {
    const auto* const found =
        std::find_if(kTypes.begin(), kTypes.end(), [&](const auto& t) { return t.first == name; });
    if (found != kTypes.end()) return found->second;
    fail("unknown type " + text::in_quotes(name), "the size of the data depends on it",
         "use char, uchar, short, ushort, int, uint, float or double");
  }

  PlyHeader finished() {
    if (!has_encoding_) fail("the header has no format", "it says how to read the data", "add format ascii 1.0");
    header_.lines = lines_.number();
    header_.bytes = lines_.bytes();
    return std::move(header_);
  }

  [[noreturn]] void fail(std::string what, std::string why, std::string suggestion) {
    input_.give_up(at_line(lines_.number()), std::move(what), std::move(why), std::move(suggestion));
  }

  HeaderLines lines_;
  MeshInput& input_;
  PlyHeader header_;
  bool has_encoding_ = false;
};

}  // namespace

std::size_t size_of(PlyType type) {
  static constexpr std::array<std::size_t, 8> kSizes = {1, 1, 2, 2, 4, 4, 4, 8};
  return kSizes[static_cast<std::size_t>(type)];
}

std::optional<std::size_t> PlyElement::find(std::string_view property) const {
  const auto found =
      std::find_if(properties.begin(), properties.end(), [&](const PlyProperty& p) { return p.name == property; });
  if (found == properties.end()) return std::nullopt;
  return static_cast<std::size_t>(found - properties.begin());
}

PlyHeader read_ply_header(std::string_view bytes, MeshInput& input) { return HeaderReader(bytes, input).run(); }

}  // namespace exactff::formats
