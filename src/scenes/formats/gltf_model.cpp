// tinygltf passes over members of a wrong type, cuts long integers off, and recurses into what is nested. So a file is
// parsed twice: first for its form, here, then by tinygltf, which decodes the buffers.
#include "formats/gltf_model.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "text/text_lines.h"

namespace exactff::formats {
namespace {

enum class Kind { kUnsigned, kNumber, kBool, kString, kObject, kArray, kNull };

constexpr std::array<std::string_view, 7> kKindNames = {"a whole number", "a number", "true or false", "a string",
                                                        "an object",      "an array", "a value"};

// Members of the objects in an array of the file, or of what they hold; "" for members of the file itself.
struct Members {
  std::string_view collection;
  Kind kind;
  bool in_array;  // each is an array of these
  std::string_view names;
};

constexpr std::array<Members, 19> kMembers = {{
    {"", Kind::kObject, false, "asset"},
    {"", Kind::kUnsigned, false, "scene"},
    {"", Kind::kObject, true, "scenes nodes meshes accessors bufferViews buffers materials"},
    {"", Kind::kString, true, "extensionsRequired"},
    {"asset", Kind::kString, false, "version"},
    {"scenes", Kind::kUnsigned, true, "nodes"},
    {"nodes", Kind::kUnsigned, false, "mesh"},
    {"nodes", Kind::kUnsigned, true, "children"},
    {"nodes", Kind::kNumber, true, "matrix translation rotation scale"},
    {"meshes", Kind::kObject, true, "primitives"},
    {"meshes", Kind::kUnsigned, false, "POSITION TEXCOORD_0 TEXCOORD_1 material mode"},
    {"accessors", Kind::kUnsigned, false, "bufferView byteOffset componentType count"},
    {"accessors", Kind::kBool, false, "normalized"},
    {"accessors", Kind::kObject, false, "sparse"},
    {"bufferViews", Kind::kUnsigned, false, "buffer byteOffset byteLength byteStride"},
    {"buffers", Kind::kUnsigned, false, "byteLength"},
    {"materials", Kind::kBool, false, "doubleSided"},
    {"materials", Kind::kObject, false, "pbrMetallicRoughness"},
    {"materials", Kind::kNumber, true, "baseColorFactor emissiveFactor"},
}};

bool has_word(std::string_view words, std::string_view wanted) {
  for (std::string_view word = text::take_word(words); !word.empty(); word = text::take_word(words)) {
    if (word == wanted) return true;
  }
  return false;
}

struct BufferForm {
  bool is_file = false;
  std::size_t length = 0;
};

// Reads the JSON without keeping it.
class FormCheck : public nlohmann::json_sax<nlohmann::json> {
 public:
  bool null() override { return value(Kind::kNull); }
  bool boolean(bool) override { return value(Kind::kBool); }
  bool number_integer(std::int64_t) override { return value(Kind::kNumber); }
  bool number_unsigned(std::uint64_t number) override {
    if (in("buffers") && name() == "byteLength" && !buffers.empty()) buffers.back().length = number;
    return value(Kind::kUnsigned, number);
  }
  bool number_float(double, const std::string&) override { return value(Kind::kNumber); }
  bool string(std::string& text) override {
    if (in("buffers") && name() == "uri" && !buffers.empty()) buffers.back().is_file = !text.starts_with("data:");
    return value(Kind::kString);
  }
  bool binary(binary_t&) override { return value(Kind::kNull); }
  bool start_object(std::size_t) override {
    const bool good = value(Kind::kObject) && open(false);
    if (good && path_.size() == 3 && path_.front().key == "buffers") buffers.emplace_back();
    return good;
  }
  bool key(std::string& key) override {
    path_.back().key = key;
    return true;
  }
  bool end_object() override { return close(); }
  bool start_array(std::size_t) override { return value(Kind::kArray) && open(true); }
  bool end_array() override { return close(); }
  bool parse_error(std::size_t position, const std::string& token, const nlohmann::json::exception&) override {
    if (fault.empty()) fault = "is no JSON before " + text::in_quotes(token);
    fault_at = position;
    return false;
  }

  std::vector<BufferForm> buffers;
  std::string fault;
  std::size_t fault_at = 0;  // bytes before it; 0 if it is named by its path

 private:
  struct Level {
    bool is_array = false;
    std::size_t count = 0;  // of elements begun
    std::string key;
  };

  [[nodiscard]] bool in(std::string_view collection) const {
    return path_.size() > 1 && ignored_from_ == 0 && path_.front().key == collection;
  }
  [[nodiscard]] std::string_view name() const {
    for (std::size_t i = path_.size(); i-- > 0;) {
      if (!path_[i].is_array) return path_[i].key;
    }
    return {};
  }
  // "meshes[0].primitives[2].indices"
  [[nodiscard]] std::string place() const {
    std::string text;
    for (const Level& level : path_) {
      text += level.is_array ? '[' + std::to_string(level.count - 1) + ']' : text.empty() ? level.key : '.' + level.key;
    }
    return text;
  }

  bool refuse(const std::string& what) {
    fault = what;
    return false;
  }

  bool value(Kind kind, std::uint64_t number = 0) {
    if (path_.empty()) return kind == Kind::kObject || refuse("is no JSON object");
    const bool in_array = path_.back().is_array;
    if (in_array) ++path_.back().count;
    if (ignored_from_ > 0) return true;
    const bool of_file = path_.size() == 1 || (path_.size() == 2 && in_array);
    const std::string_view collection = of_file ? std::string_view() : path_.front().key, name = this->name();
    const auto* const rule = std::ranges::find_if(kMembers, [&](const Members& members) {
      return members.collection == collection && has_word(members.names, name);
    });
    if (rule == kMembers.end()) return true;
    const Kind wanted = rule->in_array && !in_array ? Kind::kArray : rule->kind;
    if (kind != wanted && !(wanted == Kind::kNumber && kind == Kind::kUnsigned))
      return refuse(text::in_quotes(place(), text::kShownName) + " is not " +
                    std::string(kKindNames[static_cast<std::size_t>(wanted)]));
    constexpr std::uint64_t kMost = 0x7FFFFFFF, kMostBytes = std::uint64_t{1} << 53U;
    if (kind == Kind::kUnsigned && number > (name.starts_with("byte") && name != "byteStride" ? kMostBytes : kMost))
      return refuse(text::in_quotes(place(), text::kShownName) + " is " + std::to_string(number) +
                    ", which is too large");
    return true;
  }

  bool open(bool is_array) {
    constexpr std::size_t kDeepest = 100;
    if (path_.size() == kDeepest) return refuse("is nested deeper than 100 objects and arrays");
    if (ignored_from_ == 0 && (name() == "extras" || name() == "extensions")) ignored_from_ = path_.size();
    path_.emplace_back().is_array = is_array;
    return true;
  }
  bool close() {
    path_.pop_back();
    if (path_.size() == ignored_from_) ignored_from_ = 0;
    return true;
  }

  std::vector<Level> path_;
  std::size_t ignored_from_ = 0;  // the level in which `extras` or `extensions` is a member, if we are inside
};

constexpr std::size_t kHead = 20;  // of a .glb file up to its JSON

std::string_view json_of(std::string_view bytes, MeshInput& input) {
  if (!bytes.starts_with("glTF")) return bytes;
  const auto length_at = [&](std::size_t place) {
    std::uint32_t length = 0;
    for (std::size_t i = place + 4; i-- > place;) length = length << 8U | static_cast<unsigned char>(bytes[i]);
    return length;
  };
  const auto give_up = [&](const char* what, const char* why) {
    input.give_up(at_byte(bytes.size()), what, why, "is the file complete?");
  };
  if (bytes.size() < kHead || length_at(12) > bytes.size() - kHead) {
    give_up("the file ends within its JSON", "a .glb file begins with all of it");
  }
  if (length_at(8) > bytes.size()) give_up("the file ends before all that its head promises", "buffers are cut off");
  return bytes.substr(kHead, length_at(12));
}

std::vector<BufferForm> check_form(std::string_view bytes, MeshInput& input) {
  const std::string_view json = json_of(bytes, input);
  FormCheck check;
  if (nlohmann::json::sax_parse(json.begin(), json.end(), &check)) return std::move(check.buffers);
  const bool is_text = json.size() == bytes.size();
  const auto line =
      1 + std::count(json.begin(), json.begin() + static_cast<long>(std::min(check.fault_at, json.size())), '\n');
  input.give_up(check.fault_at == 0 ? FilePlace{}
                : is_text           ? at_line(static_cast<std::size_t>(line))
                                    : at_byte(kHead + check.fault_at),
                check.fault, "glTF 2.0 prescribes it", "correct it, or export the file again");
}

// The files of buffers, one after the other; tinygltf reads them before all else. It asks for the path in the file,
// decoded, and then for the same in the present folder.
struct BufferFiles {
  std::filesystem::path folder;
  std::vector<BufferForm> buffers;
  MeshInput& input;
  std::size_t next = 0;
  std::string missing = {};

  bool has(const std::string& name) {
    while (next < buffers.size() && !buffers[next].is_file) ++next;
    std::error_code error;
    if (next == buffers.size()) return false;  // an image
    if (std::filesystem::is_regular_file(folder / name, error)) return true;
    if (missing.empty()) missing = (folder / name).string();
    return false;
  }
  bool read(std::vector<unsigned char>& bytes, const std::string& name) {
    try {
      const std::string all = text::read_file(folder / name, "the file of the buffer");
      bytes.assign(all.begin(), all.end());
      bytes.resize(std::min(bytes.size(), buffers[next++].length));  // the rest is padding
      input.read_from(folder / name);
      return true;
    } catch (const InputError&) {
      missing = (folder / name).string();
      return false;
    }
  }
};

tinygltf::FsCallbacks callbacks(BufferFiles& files) {
  tinygltf::FsCallbacks callbacks{};
  callbacks.FileExists = [](const std::string& name, void* data) { return static_cast<BufferFiles*>(data)->has(name); };
  callbacks.ExpandFilePath = [](const std::string& name, void*) { return name; };
  callbacks.ReadWholeFile = [](std::vector<unsigned char>* bytes, std::string*, const std::string& name, void* data) {
    return static_cast<BufferFiles*>(data)->read(*bytes, name);
  };
  callbacks.WriteWholeFile = [](std::string*, const std::string&, const std::vector<unsigned char>&, void*) {
    return false;
  };
  [](auto& newer) {  // from version 2.9 on
    if constexpr (requires { newer.GetFileSizeInBytes; }) {
      newer.GetFileSizeInBytes = [](std::size_t* size, std::string*, const std::string&, void*) {
        *size = 1;
        return true;
      };
    }
  }(callbacks);
  callbacks.user_data = &files;
  return callbacks;
}

bool no_image(tinygltf::Image*, const int, std::string*, std::string*, int, int, const unsigned char*, int, void*) {
  return true;
}

}  // namespace

tinygltf::Model load_gltf(std::string_view bytes, const std::filesystem::path& path, MeshInput& input) {
  constexpr std::size_t kMostBytes = 0xFFFFFFFF;
  if (bytes.size() > kMostBytes)
    input.give_up({}, "has more than 4 GiB", "tinygltf counts bytes in 32 bits",
                  "put the buffers into files of their own");
  BufferFiles files{path.parent_path(), check_form(bytes, input), input};
  tinygltf::TinyGLTF reader;
  reader.SetImageLoader(no_image, nullptr);
  reader.SetFsCallbacks(callbacks(files));
  tinygltf::Model model;
  std::string error, warnings;
  bool good = false;
  const auto size = static_cast<unsigned int>(bytes.size());
  try {
    good = bytes.starts_with("glTF")
               ? reader.LoadBinaryFromMemory(&model, &error, &warnings,
                                             reinterpret_cast<const unsigned char*>(bytes.data()), size)
               : reader.LoadASCIIFromString(&model, &error, &warnings, bytes.data(), size, "");
  } catch (const std::exception& thrown) {
    error = thrown.what();
  }
  if (!files.missing.empty()) {
    input.give_up({}, "its buffer " + text::in_quotes(files.missing, text::kShownName) + " cannot be read",
                  "it holds the geometry", "put it beside the file, or export a .glb file, which holds all");
  }
  if (!good || !error.empty()) {
    std::replace(error.begin(), error.end(), '\n', ' ');
    input.give_up({}, "is not read by tinygltf", std::string(text::trimmed(error.substr(0, 200))),
                  "correct it, or export the file again as glTF 2.0");
  }
  return model;
}

}  // namespace exactff::formats
