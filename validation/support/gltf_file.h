// Writes glTF files for tests, one accessor after the other.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace exactff::validation {

class GltfFile {
 public:
  using Json = nlohmann::ordered_json;

  GltfFile() {
    json = {{"asset", {{"version", "2.0"}}},
            {"scene", 0},
            {"scenes", {{{"nodes", Json::array()}}}},
            {"nodes", Json::array()},
            {"meshes", Json::array()},
            {"accessors", Json::array()},
            {"bufferViews", Json::array()}};
  }

  template <class T>
  int view(const std::vector<T>& numbers) {
    bytes.resize((bytes.size() + 3) / 4 * 4);
    json["bufferViews"].push_back(
        {{"buffer", 0}, {"byteOffset", bytes.size()}, {"byteLength", numbers.size() * sizeof(T)}});
    for (const T number : numbers) {
      std::array<char, sizeof(T)> raw{};
      std::memcpy(raw.data(), &number, sizeof(T));
      bytes.append(raw.data(), raw.size());
    }
    return static_cast<int>(json["bufferViews"].size()) - 1;
  }
  template <class T>
  int accessor(const std::vector<T>& numbers, const std::string& type) {
    const std::size_t per = type == "SCALAR" ? 1 : type == "VEC2" ? 2 : 3;
    json["accessors"].push_back({{"bufferView", view(numbers)},
                                 {"componentType", component<T>()},
                                 {"count", numbers.size() / per},
                                 {"type", type}});
    return static_cast<int>(json["accessors"].size()) - 1;
  }
  // A mesh of one primitive.
  int mesh(Json primitive, const std::string& name = {}) {
    Json made = {{"primitives", Json::array({std::move(primitive)})}};
    if (!name.empty()) made["name"] = name;
    json["meshes"].push_back(std::move(made));
    return static_cast<int>(json["meshes"].size()) - 1;
  }
  // A root of the scene.
  int node(Json node) {
    json["nodes"].push_back(std::move(node));
    const int index = static_cast<int>(json["nodes"].size()) - 1;
    json["scenes"][0]["nodes"].push_back(index);
    return index;
  }

  // With the bytes of the buffer in the text, in the other file `uri`, or in a binary file.
  [[nodiscard]] std::string text() const { return text_with("data:application/octet-stream;base64," + base64()); }
  [[nodiscard]] std::string text_with(const std::string& uri) const {
    Json all = json;
    all["buffers"] = {{{"byteLength", bytes.size()}, {"uri", uri}}};
    return all.dump();
  }
  [[nodiscard]] std::string binary() const {
    Json all = json;
    all["buffers"] = {{{"byteLength", bytes.size()}}};
    std::string head = all.dump(), tail = bytes;
    head.resize((head.size() + 3) / 4 * 4, ' ');
    tail.resize((tail.size() + 3) / 4 * 4);
    return "glTF" + little(2) + little(28 + head.size() + tail.size()) + little(head.size()) + "JSON" + head +
           little(tail.size()) + std::string("BIN\0", 4) + tail;
  }

  Json json;
  std::string bytes;

 private:
  template <class T>
  static constexpr int component() {
    if constexpr (std::is_same_v<T, float>) return 5126;
    if constexpr (std::is_same_v<T, std::int8_t>) return 5120;
    if constexpr (std::is_same_v<T, std::uint8_t>) return 5121;
    if constexpr (std::is_same_v<T, std::int16_t>) return 5122;
    if constexpr (std::is_same_v<T, std::uint16_t>) return 5123;
    if constexpr (std::is_same_v<T, std::uint32_t>) return 5125;
  }
  static std::string little(std::size_t number) {
    std::string raw;
    for (int i = 0; i < 4; ++i) raw += static_cast<char>(number >> (8 * i));
    return raw;
  }
  [[nodiscard]] std::string base64() const {
    const std::string letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string out;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
      std::uint32_t three = 0;
      for (std::size_t k = 0; k < 3; ++k)
        three = three << 8U | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0U);
      for (std::size_t k = 0; k < 4; ++k) out += i + k > bytes.size() ? '=' : letters[three >> (18 - 6 * k) & 63U];
    }
    return out;
  }
};

}  // namespace exactff::validation
