#include "formats/writers.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <string_view>
#include <unordered_set>

#include "formats/mesh_input.h"
#include "scene/triangulation.h"
#include "text/phrases.h"
#include "text/text_lines.h"

namespace exactff::formats {
namespace {

using Corners = std::vector<std::uint32_t>;

class FaceCollector {
 public:
  FaceCollector(const Scene& scene, Polygons polygons) : scene_(scene), polygons_(polygons) {}

  std::vector<OutputFace> run() {
    for (std::size_t i = 0; i < scene_.faces().size(); ++i) add(FaceId(static_cast<std::uint32_t>(i)));
    return std::move(faces_);
  }

  void tell(const std::string& format, Losses& losses) const {
    const auto lost = [&](std::size_t count, const std::string& with, const std::string& what, std::string why,
                          const char* suggestion) {
      if (count > 0)
        losses.add(text::counted(count, "face") + with + (count == 1 ? " is " : " are ") + what, std::move(why),
                   suggestion);
    };
    lost(with_holes_, " with holes", "cut into polygons without holes", format + " has no holes",
         "form factors do not change, numbers of faces do");
    lost(cut_, "", "cut into smaller polygons",
         format + (polygons_ == Polygons::kTriangles ? " has only triangles"
                                                     : " has only convex polygons of three or four corners"),
         "form factors do not change, numbers of faces do");
    lost(transparent_, "", "no longer transparent", "no format says so", "name them again with --transparent");
    lost(unusable_, "", "left out", "nothing can be computed with them", "see the warnings of the scene");
    lost(without_area_, "", "left out", "they have no area", "numbers of faces change");
  }

 private:
  void add(FaceId id) {
    const Face& face = scene_.face(id);
    if (face.transparent) ++transparent_;
    if (face.shape == FaceShape::kSkipped) {
      ++unusable_;
    } else if (face.shape == FaceShape::kZeroArea) {
      add_without_area(id);
    } else if (fits(face)) {
      faces_.push_back({id, face.rings.front()});
    } else {
      ++(face.rings.size() > 1 ? with_holes_ : cut_);
      add_pieces(id);
    }
  }

  // It is kept because the numbers of the faces after it depend on it. Where repeated vertices were dropped, the last
  // one is repeated again.
  void add_without_area(FaceId id) {
    const Face& face = scene_.face(id);
    if (face.rings.size() != 1 || face.rings.front().empty() || face.rings.front().size() > most_ ||
        polygons_ == Polygons::kFourCorners) {
      ++without_area_;
      return;
    }
    Corners corners = face.rings.front();
    while (corners.size() < 3) corners.push_back(corners.back());
    faces_.push_back({id, std::move(corners)});
  }

  void add_pieces(FaceId id) {
    for (const Piece& piece : scene_.pieces_of(id)) {
      const auto corners = scene_.corners(piece);
      if (corners.size() <= most_) {
        faces_.push_back({id, Corners(corners.begin(), corners.end())});
        continue;
      }
      for (Corners& triangle : triangles_of(scene_, piece)) faces_.push_back({id, std::move(triangle)});
    }
  }

  bool fits(const Face& face) const {
    return face.rings.size() == 1 && face.rings.front().size() <= most_ &&
           (polygons_ != Polygons::kFourCorners || (face.shape == FaceShape::kPlanar && face.piece_count == 1));
  }

  const Scene& scene_;
  const Polygons polygons_;
  const std::size_t most_ = polygons_ == Polygons::kAny           ? static_cast<std::size_t>(-1)  // corners
                            : polygons_ == Polygons::kFourCorners ? 4
                                                                  : 3;
  std::vector<OutputFace> faces_;
  std::size_t with_holes_ = 0;
  std::size_t cut_ = 0;
  std::size_t unusable_ = 0;
  std::size_t without_area_ = 0;
  std::size_t transparent_ = 0;
};

}  // namespace

std::vector<OutputFace> output_faces(const Scene& scene, Polygons polygons, const std::string& format, Losses& losses) {
  FaceCollector collector(scene, polygons);
  std::vector<OutputFace> faces = collector.run();
  collector.tell(format, losses);
  return faces;
}

// --- Numbers and losses ---

void append_point(std::string& out, std::string_view start, const Vec3& point) {
  std::array<char, 96> text{};  // at most 24 characters for each number
  char* at = text.data();
  for (const double coordinate : {point.x, point.y, point.z}) {
    if (at != text.data()) *at++ = ' ';
    at = std::to_chars(at, text.data() + text.size(), coordinate).ptr;
  }
  (out += start).append(text.data(), at) += '\n';
}

std::string unit_line(const Scene& scene, const std::string& comment) {
  return scene.unit() == Unit::kNone ? "" : comment + " unit " + std::string(name_of(scene.unit())) + '\n';
}

std::string corner_words(const OutputFace& face) {
  std::string words = std::to_string(face.corners.size());
  for (const std::uint32_t corner : face.corners) (words += ' ') += std::to_string(corner);
  return words;
}

void Losses::add_materials(const Scene& scene, const std::string& format) {
  const auto is_lost = [](const Material& m) { return m.emits() || m.reflectance != Rgb{1.0, 1.0, 1.0}; };
  const auto lost = std::count_if(scene.materials().begin(), scene.materials().end(), is_lost);
  if (lost == 0) return;
  add("Kd and Ke of " + text::counted(static_cast<std::uint64_t>(lost), "material") + " are lost",
      format + " has no materials", "write OBJ to keep them");
}

// --- Output names ---

std::string fit_name(std::string name, const NameRules& rules) {
  constexpr std::string_view kNever("\0\r\n", 3);
  const auto is_blank = [](char c) { return c == ' ' || c == '\t' || c == '\v' || c == '\f'; };
  if (name.empty()) return "_";
  for (std::size_t i = 0; i < name.size(); ++i) {
    char& c = name[i];
    const bool at_end = i == 0 || i + 1 == name.size();
    const bool begins_word = i == 0 || is_blank(name[i - 1]);
    if (kNever.find(c) != std::string_view::npos || (is_blank(c) && (rules.one_word || at_end)) ||
        (rules.comment != '\0' && c == rules.comment && (begins_word || !rules.only_before_word)) ||
        (rules.joins_lines && c == '\\' && i + 1 == name.size())) {
      c = '_';
    }
  }
  return name;
}

// Names that need no change go first, so that they keep theirs.
std::vector<std::string> output_names(std::vector<std::string> names, const NameRules& rules, const std::string& noun,
                                      Losses& losses) {
  std::unordered_set<std::string> taken;
  std::vector<std::size_t> changed;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (fit_name(names[i], rules) != names[i] || !taken.insert(names[i]).second) changed.push_back(i);
  }
  if (changed.empty()) return names;
  const std::string before = names[changed.front()];
  for (const std::size_t i : changed) {
    names[i] = fit_name(names[i], rules);
    while (!taken.insert(names[i]).second) names[i] += "_" + std::to_string(i + 1);
  }
  losses.add("the " + noun + " " + text::in_quotes(before) + " is called " + text::in_quotes(names[changed.front()]) +
                 (changed.size() > 1 ? ", and " + text::counted(changed.size() - 1, "other") + " change as well" : ""),
             "the format cannot hold the name", "rename it if this matters");
  return names;
}

std::vector<std::string> patch_names(const Scene& scene) {
  std::vector<std::string> names;
  for (const Patch& patch : scene.patches()) names.push_back(patch.name);
  return names;
}

bool has_only_default_patch(const Scene& scene) {
  const auto patches = scene.patches();
  return patches.empty() || (patches.size() == 1 && patches.front().name == kDefaultPatch);
}

}  // namespace exactff::formats
