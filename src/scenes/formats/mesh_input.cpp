#include "formats/mesh_input.h"

#include <bit>
#include <charconv>
#include <limits>
#include <utility>

#include "text/number_text.h"
#include "text/phrases.h"

namespace exactff::formats {
namespace {

constexpr std::size_t kMostIndices = std::numeric_limits<std::uint32_t>::max();

}  // namespace

std::optional<std::int64_t> whole_number(std::string_view word) {
  if (word.starts_with('+') && !word.starts_with("+-")) word.remove_prefix(1);
  return text::whole_number<std::int64_t>(word);
}

MeshInput::MeshInput(const std::filesystem::path& path, const SceneOptions& options, std::string kind,
                     Materials materials)
    : file_(path.string()), options_(options), kind_(std::move(kind)), builder_(file_, options) {
  if (materials == Materials::kNoneFirst) builder_.add_material({std::string(kNoMaterial)});
}

Problem MeshInput::problem(const FilePlace& place, std::string what, std::string why, std::string suggestion) const {
  if (place.byte) what.insert(0, "byte " + std::to_string(*place.byte) + ": ");
  return {file_, place.line, std::move(what), std::move(why), std::move(suggestion)};
}

void MeshInput::fail(const FilePlace& place, std::string what, std::string why, std::string suggestion) {
  problems_.add(problem(place, std::move(what), std::move(why), std::move(suggestion)));
}

void MeshInput::warn(const FilePlace& place, std::string what, std::string why, std::string suggestion) {
  builder_.warn(problem(place, std::move(what), std::move(why), std::move(suggestion)));
}

void MeshInput::give_up(const FilePlace& place, std::string what, std::string why, std::string suggestion) {
  fail(place, what, why, suggestion);
  problems_.throw_if_any();
  throw InputError(problem(place, std::move(what), std::move(why), std::move(suggestion)));
}

Vec3 MeshInput::take_point(std::string_view& words, std::size_t line, const char* usage) {
  Vec3 point{};
  for (double* const coordinate : {&point.x, &point.y, &point.z}) {
    const std::string_view word = text::take_word(words);
    if (word.empty()) {
      fail(at_line(line), "a vertex has fewer than three coordinates", "a point needs all three", usage);
      break;
    }
    const text::ParsedNumber number = text::parse_number(word);
    if (number.fault != text::NumberFault::kNone)
      fail(at_line(line), describe(number.fault, word), "a coordinate is one exact number", advice(number.fault));
    *coordinate = number.value;
  }
  return point;
}

std::uint32_t MeshInput::add_vertex(const Vec3& position, const FilePlace& place) {
  if (builder_.vertex_count() == kMostIndices)
    give_up(place, "more than 4294967295 vertices", "indices have 32 bits", "split the scene");
  return builder_.add_vertex(position);
}

PatchId MeshInput::default_patch() {
  if (!default_patch_) default_patch_ = builder_.patch(kDefaultPatch);
  return *default_patch_;
}

bool MeshInput::is_polygon(std::size_t corners, const FilePlace& place) {
  if (corners >= 3 || options_.bad_faces != BadFaces::kReject) return true;
  fail(place, "a face has " + text::counted(corners, "vertex", "vertices"), "a polygon has at least three",
       "remove it, or skip bad faces with --skip-bad-faces");
  return false;
}

void MeshInput::add_face(PatchId patch, MaterialId material, std::vector<std::uint32_t> ring, const FilePlace& place,
                         std::vector<std::vector<std::uint32_t>> holes) {
  if (face_count_++ == kMostIndices)
    give_up(place, "more than 4294967295 faces", "indices have 32 bits", "split the scene");
  if (!is_polygon(ring.size(), place)) return;  // there will be no scene, and a face takes more memory than in the file
  holes.insert(holes.begin(), std::move(ring));
  builder_.add_face(patch, material, std::move(holes), place.line);
}

Scene MeshInput::build() {
  problems_.throw_if_any();
  if (face_count_ == 0) give_up({}, "has no faces", "there is nothing to compute with", "is it " + kind_ + "?");
  return builder_.build();
}

// --- Shared vertices ---

std::uint32_t SharedVertices::vertex(const Vec3& position, const FilePlace& place) {
  const auto [found, is_new] = numbers_.try_emplace(position);
  if (is_new) found->second = input_.add_vertex(position, place);
  return found->second;
}

std::size_t HashOfPosition::operator()(const Vec3& position) const {
  std::uint64_t state = seed;
  for (const double coordinate : {position.x, position.y, position.z}) {
    state = (state ^ std::bit_cast<std::uint64_t>(coordinate + 0.0)) * 0x9E3779B97F4A7C15U;
    state ^= state >> 32U;
  }
  return state;
}

}  // namespace exactff::formats
