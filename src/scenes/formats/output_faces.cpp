#include "formats/output_faces.h"

#include "scene/triangles.h"
#include "text/phrases.h"

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
  void tell(const std::string& format, Losses& losses) const;

 private:
  void add(FaceId id);
  void add_without_area(FaceId id);
  void add_pieces(FaceId id);
  bool fits(const Face& face) const;

  const Scene& scene_;
  const Polygons polygons_;
  std::vector<OutputFace> faces_;
  std::size_t with_holes_ = 0;
  std::size_t cut_ = 0;
  std::size_t unusable_ = 0;
  std::size_t without_area_ = 0;
  std::size_t transparent_ = 0;
};

bool FaceCollector::fits(const Face& face) const {
  if (face.rings.size() != 1) return false;
  const std::size_t corners = face.rings.front().size();
  switch (polygons_) {
    case Polygons::kAny:
      return true;
    case Polygons::kFourCorners:
      return corners <= 4 && face.shape == FaceShape::kPlanar && face.piece_count == 1;
    case Polygons::kTriangles:
      return corners == 3;
  }
  return false;
}

void FaceCollector::add(FaceId id) {
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

// It is kept because the numbers of the faces after it depend on it. Where repeated vertices were dropped, the last one
// is repeated again.
void FaceCollector::add_without_area(FaceId id) {
  const Face& face = scene_.face(id);
  const std::size_t most = polygons_ == Polygons::kAny ? static_cast<std::size_t>(-1) : 3;
  if (face.rings.size() != 1 || face.rings.front().empty() || face.rings.front().size() > most ||
      polygons_ == Polygons::kFourCorners) {
    ++without_area_;
    return;
  }
  Corners corners = face.rings.front();
  while (corners.size() < 3) corners.push_back(corners.back());
  faces_.push_back({id, std::move(corners)});
}

void FaceCollector::add_pieces(FaceId id) {
  const std::size_t most = polygons_ == Polygons::kAny           ? static_cast<std::size_t>(-1)
                           : polygons_ == Polygons::kFourCorners ? 4
                                                                 : 3;
  for (const Piece& piece : scene_.pieces_of(id)) {
    const auto corners = scene_.corners(piece);
    if (corners.size() <= most) {
      faces_.push_back({id, Corners(corners.begin(), corners.end())});
      continue;
    }
    for (Corners& triangle : triangles_of(scene_, piece)) faces_.push_back({id, std::move(triangle)});
  }
}

void FaceCollector::tell(const std::string& format, Losses& losses) const {
  const auto faces = [](std::size_t count) { return text::counted(count, "face") + (count == 1 ? " is " : " are "); };
  if (with_holes_ > 0) {
    losses.add(text::counted(with_holes_, "face") + " with holes " + (with_holes_ == 1 ? "is" : "are") +
                   " cut into polygons without holes",
               format + " has no holes", "form factors do not change, numbers of faces do");
  }
  if (cut_ > 0) {
    losses.add(faces(cut_) + "cut into smaller polygons",
               polygons_ == Polygons::kTriangles ? format + " has only triangles"
                                                 : format + " has only convex polygons of three or four corners",
               "form factors do not change, numbers of faces do");
  }
  if (transparent_ > 0)
    losses.add(faces(transparent_) + "no longer transparent", "no format says so",
               "name them again with --transparent");
  if (unusable_ > 0)
    losses.add(faces(unusable_) + "left out", "nothing can be computed with them", "see the warnings of the scene");
  if (without_area_ > 0) losses.add(faces(without_area_) + "left out", "they have no area", "numbers of faces change");
}

}  // namespace

std::vector<OutputFace> output_faces(const Scene& scene, Polygons polygons, const std::string& format, Losses& losses) {
  FaceCollector collector(scene, polygons);
  std::vector<OutputFace> faces = collector.run();
  collector.tell(format, losses);
  return faces;
}

}  // namespace exactff::formats
