// tinygltf passes over members of a wrong type, cuts long integers off, and recurses into what is nested. So a file is
// parsed twice: first for its form, here, then by tinygltf, which decodes the buffers.
#include "formats/gltf_model.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>

#include "files/numpy.h"
#include "text/text_lines.h"

namespace exactff::formats {
namespace {

using Json = nlohmann::json;

constexpr std::size_t kHead = 20;  // of a .glb file up to its JSON
constexpr const char *kPrescribed = "glTF 2.0 prescribes it", *kAdvice = "correct it, or export the file again";

struct Kind {
  std::string_view name;
  bool (Json::*holds)() const noexcept;
};
constexpr Kind kUnsigned{"a whole number", &Json::is_number_unsigned}, kNumber{"a number", &Json::is_number},
    kBool{"true or false", &Json::is_boolean}, kString{"a string", &Json::is_string},
    kObject{"an object", &Json::is_object}, kArray{"an array", &Json::is_array};

// Members of the objects in an array of the file, or of what they hold; "" for members of the file itself.
struct Members {
  std::string_view collection;
  const Kind* kind;
  bool in_array;  // each is an array of these
  std::string_view names;
};

constexpr std::array<Members, 19> kMembers = {{
    {"", &kObject, false, "asset"},
    {"", &kUnsigned, false, "scene"},
    {"", &kObject, true, "scenes nodes meshes accessors bufferViews buffers materials"},
    {"", &kString, true, "extensionsRequired"},
    {"asset", &kString, false, "version"},
    {"scenes", &kUnsigned, true, "nodes"},
    {"nodes", &kUnsigned, false, "mesh"},
    {"nodes", &kUnsigned, true, "children"},
    {"nodes", &kNumber, true, "matrix translation rotation scale"},
    {"meshes", &kObject, true, "primitives"},
    {"meshes", &kUnsigned, false, "POSITION TEXCOORD_0 TEXCOORD_1 material mode"},
    {"accessors", &kUnsigned, false, "bufferView byteOffset componentType count"},
    {"accessors", &kBool, false, "normalized"},
    {"accessors", &kObject, false, "sparse"},
    {"bufferViews", &kUnsigned, false, "buffer byteOffset byteLength byteStride"},
    {"buffers", &kUnsigned, false, "byteLength"},
    {"materials", &kBool, false, "doubleSided"},
    {"materials", &kObject, false, "pbrMetallicRoughness"},
    {"materials", &kNumber, true, "baseColorFactor emissiveFactor"},
}};

// A value in the file. In arrays, its name is theirs.
struct Place {
  std::string path;             // "meshes[0].primitives[2].indices"
  std::string_view root, name;  // the first and the last name in the path
  std::size_t depth = 1;        // of objects and arrays around it
  bool in_array = false;
};

void check_member(const Json& value, const Place& place, const Members& rule, MeshInput& input) {
  constexpr std::uint64_t kMost = 0x7FFFFFFF, kMostBytes = std::uint64_t{1} << 53U;
  const auto refuse = [&](const std::string& what) {
    input.give_up({}, text::in_quotes(place.path, text::kShownName) + " is " + what, kPrescribed, kAdvice);
  };
  const Kind& wanted = rule.in_array && !place.in_array ? kArray : *rule.kind;
  if (!(value.*wanted.holds)()) refuse("not " + std::string(wanted.name));
  if (!value.is_number_unsigned()) return;
  const auto number = value.get<std::uint64_t>();
  if (number > (place.name.starts_with("byte") && place.name != "byteStride" ? kMostBytes : kMost))
    refuse(std::to_string(number) + ", which is too large");
}

void check_form(const Json& value, const Place& place, MeshInput& input) {
  const bool of_file = place.depth == 1 || (place.depth == 2 && place.in_array);
  const auto* const rule = std::ranges::find_if(kMembers, [&](const Members& members) {
    return members.collection == (of_file ? "" : place.root) &&
           std::ranges::count(text::words(members.names), place.name) > 0;
  });
  if (rule != kMembers.end()) check_member(value, place, *rule, input);
  constexpr std::size_t kDeepest = 100;
  if (value.is_structured() && place.depth >= kDeepest)
    input.give_up({}, "is nested deeper than 100 objects and arrays", kPrescribed, kAdvice);
  const bool is_free = place.name == "extras" || place.name == "extensions";
  const std::string_view root = is_free ? place.name : place.root;
  if (value.is_array()) {
    for (std::size_t i = 0; i < value.size(); ++i)
      check_form(value[i], {place.path + '[' + std::to_string(i) + ']', root, place.name, place.depth + 1, true},
                 input);
  } else if (value.is_object()) {
    for (const auto& [key, member] : value.items())
      check_form(member, {place.path + '.' + key, root, key, place.depth + 1}, input);
  }
}

std::string_view json_of(std::string_view bytes, MeshInput& input) {
  if (!bytes.starts_with("glTF")) return bytes;
  const auto give_up = [&](const char* what, const char* why) {
    input.give_up(at_byte(bytes.size()), what, why, "is the file complete?");
  };
  std::array<std::uint32_t, kHead / 4> head{};
  if (bytes.size() >= kHead) files::read_little_endian(bytes, std::span<std::uint32_t>(head));
  if (bytes.size() < kHead || head[3] > bytes.size() - kHead) {
    give_up("the file ends within its JSON", "a .glb file begins with all of it");
  }
  if (head[2] > bytes.size()) give_up("the file ends before all that its head promises", "buffers are cut off");
  return bytes.substr(kHead, head[3]);
}

Json parse(std::string_view json, bool is_text, MeshInput& input) {
  try {
    return Json::parse(json);
  } catch (const Json::parse_error& error) {
    const std::string_view before = json.substr(0, error.byte);
    const auto lines = static_cast<std::size_t>(std::ranges::count(before, '\n'));
    input.give_up(
        is_text ? at_line(1 + lines) : at_byte(kHead + error.byte),
        "is no JSON at " + text::in_quotes(before.substr(before.size() - std::min<std::size_t>(before.size(), 20))),
        kPrescribed, kAdvice);
  } catch (const Json::out_of_range&) {
    input.give_up({}, "has a number beyond the range of doubles", kPrescribed, kAdvice);
  }
}

struct BufferForm {
  bool is_file = false;
  std::size_t length = 0;
};

// Of the buffers of a file whose form is right.
std::vector<BufferForm> checked_buffers(std::string_view bytes, MeshInput& input) {
  const std::string_view text = json_of(bytes, input);
  const Json file = parse(text, text.size() == bytes.size(), input);
  if (!file.is_object()) input.give_up({}, "is no JSON object", kPrescribed, kAdvice);
  for (const auto& [key, member] : file.items()) check_form(member, {key, key, key}, input);
  std::vector<BufferForm> buffers;
  const auto all = file.find("buffers");
  for (std::size_t b = 0; all != file.end() && b < all->size(); ++b) {
    const Json& buffer = (*all)[b];
    const auto uri = buffer.find("uri");
    const bool is_text = uri != buffer.end() && uri->is_string();
    buffers.push_back({is_text && !uri->get_ref<const std::string&>().starts_with("data:"),
                       buffer.value("byteLength", std::size_t{0})});
  }
  return buffers;
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
      input.builder().read_from(folder / name);
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
  BufferFiles files{path.parent_path(), checked_buffers(bytes, input), input};
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
