#include "adaptive/sampled_scene.h"

#include <array>
#include <bit>
#include <cstdio>
#include <new>
#include <stdexcept>
#include <string>

#include "adaptive/embree.h"
#include "kernel/numbers.h"
#include "kernel/vec.h"
#include "scene/scene.h"

namespace exactff::adaptive {
namespace {

using Float3 = std::array<float, 3>;

Float3 in_unit_box(const UnitBox& box, const Vec3& p) {
  const Vec3 q = (p - box.centre) * box.scale;
  const auto rounded = [&](double t) { return std::abs(t) < box.least ? 0.0F : static_cast<float>(t); };
  return {rounded(q.x), rounded(q.y), rounded(q.z)};
}

// The vertices that pieces use, ascending.
std::vector<std::uint32_t> used_vertices(const Scene& scene) {
  std::vector<std::uint32_t> used;
  for (const Piece& piece : scene.pieces()) {
    const auto corners = scene.corners(piece);
    used.insert(used.end(), corners.begin(), corners.end());
  }
  std::sort(used.begin(), used.end());
  used.erase(std::unique(used.begin(), used.end()), used.end());
  return used;
}

UnitBox unit_box(const Box& bounds, std::size_t pieces) {
  const double size = max_norm(bounds.high - bounds.low);
  const int exponent = size > 0.0 ? std::clamp(std::ilogb(size) + 1, -1000, 1000) : 0;
  const double least = pieces > kMostPiecesWithoutEmbree ? kLeastInEmbree : 0.0;
  return {(bounds.low + bounds.high) * 0.5, std::ldexp(1.0, -exponent), least};
}

Problem refusal(const Scene& scene, FaceId face, std::string what) {
  return {SceneInside::data(scene).file, scene.face(face).line, "face '" + scene.name_of(face) + "' " + std::move(what),
          "shadow rays work in single precision, so the sampled methods refuse this scene; the exact one does not",
          "leave out the sampled methods, or enlarge the detail or shrink the scene around it"};
}

std::string position(const Vec3& p) {
  std::array<char, 96> text{};
  std::snprintf(text.data(), text.size(), "(%.17g, %.17g, %.17g)", p.x, p.y, p.z);
  return text.data();
}

FaceId face_with_vertex(const Scene& scene, std::uint32_t vertex) {
  for (const Piece& piece : scene.pieces()) {
    const auto corners = scene.corners(piece);
    if (std::find(corners.begin(), corners.end(), vertex) != corners.end()) return piece.face;
  }
  throw std::logic_error("a used vertex has no piece");
}

void find_merged_vertices(const Scene& scene, const std::vector<Vec3>& points, const UnitBox& box,
                          std::vector<std::uint32_t> used, std::vector<Problem>& problems) {
  std::vector<Float3> rounded(points.size());
  for (const std::uint32_t v : used) rounded[v] = in_unit_box(box, points[v]);
  std::sort(used.begin(), used.end(), [&](std::uint32_t a, std::uint32_t b) {
    return rounded[a] < rounded[b] || (rounded[a] == rounded[b] && a < b);
  });
  for (std::size_t i = 1; i < used.size(); ++i) {
    const Vec3& p = scene.vertices()[used[i - 1]];
    const Vec3& q = scene.vertices()[used[i]];
    if (rounded[used[i - 1]] != rounded[used[i]] || p == q) continue;
    problems.push_back(
        refusal(scene, face_with_vertex(scene, used[i]),
                "has the vertex " + position(q) + ", which single precision merges with " + position(p)));
    return;  // report one only: there may be very many
  }
}

// An axis along which Embree would move a vertex by more than single precision moves the outermost ones; nullopt if
// none.
std::optional<int> axis_lost_to_embree(const UnitBox& box, const Vec3& half_extent, const Vec3& p) {
  constexpr double kRoundingOfFloats = 0x1p-24;
  const Vec3 q = (p - box.centre) * box.scale;
  const std::array<double, 3> coordinates = {std::abs(q.x), std::abs(q.y), std::abs(q.z)};
  const std::array<double, 3> extents = {half_extent.x, half_extent.y, half_extent.z};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double t = coordinates[axis];
    if (t < box.least && t > kRoundingOfFloats * extents[axis]) return static_cast<int>(axis);
  }
  return std::nullopt;
}

void find_lost_vertices(const Scene& scene, const std::vector<Vec3>& points, const Box& bounds, const UnitBox& box,
                        const std::vector<std::uint32_t>& used, std::vector<Problem>& problems) {
  const Vec3 half_extent = (bounds.high - bounds.low) * (0.5 * box.scale);
  for (const std::uint32_t v : used) {
    const std::optional<int> axis = axis_lost_to_embree(box, half_extent, points[v]);
    if (!axis) continue;
    problems.push_back(refusal(scene, face_with_vertex(scene, v),
                               "has the vertex " + position(scene.vertices()[v]) + ", whose distance from the middle " +
                                   "of the scene along " + "xyz"[*axis] + " is below 2^-100 (7.9e-31) of the " +
                                   "scene's size, which Embree takes for 0"));
    return;
  }
}

// Newell's vector of a polygon given by its corners.
template <class Corner>
Vec3 area_vector(std::size_t count, const Corner& corner) {
  Vec3 sum;
  for (std::size_t i = 1; i + 1 < count; ++i) sum = sum + cross(corner(i) - corner(0), corner(i + 1) - corner(0));
  return sum;
}

void find_spoiled_pieces(const Scene& scene, const std::vector<Vec3>& points, const UnitBox& box,
                         std::vector<Problem>& problems) {
  for (const Piece& piece : scene.pieces()) {
    const auto corners = scene.corners(piece);
    const Vec3 exact = area_vector(corners.size(), [&](std::size_t i) { return points[corners[i]]; });
    const Vec3 rounded = area_vector(corners.size(), [&](std::size_t i) {
      const Float3 p = in_unit_box(box, points[corners[i]]);
      return Vec3{p[0], p[1], p[2]};
    });
    const bool collapsed = rounded == Vec3{};
    if (!collapsed && dot(exact, rounded) > 0.0) continue;
    const char* what = collapsed ? "collapses to a line in single precision" : "is flipped by single precision";
    problems.push_back(refusal(scene, piece.face, what));
    return;
  }
}

using Triangle = std::array<std::uint32_t, 3>;

// The buffer belongs to Embree.
template <class Element>
Element* new_buffer(RTCGeometry geometry, RTCBufferType type, RTCFormat format, std::size_t count) {
  void* buffer = rtcSetNewGeometryBuffer(geometry, type, 0, format, sizeof(Element), std::max<std::size_t>(1, count));
  if (buffer == nullptr) throw std::bad_alloc();
  return static_cast<Element*>(buffer);
}

// The data that the filter needs in one query. The context must come first.
struct FilterContext {
  embree::QueryContext context;
  const Blockers* blockers;
  const std::uint32_t* piece_of_triangle;
};

void pass_through_others(const RTCFilterFunctionNArguments* args) {
  const auto& c = *reinterpret_cast<const FilterContext*>(args->context);
  for (unsigned i = 0; i < args->N; ++i) {
    if (args->valid[i] == 0) continue;
    const std::uint32_t triangle = RTCHitN_primID(args->hit, args->N, i);
    if (!c.blockers->contains(c.piece_of_triangle[triangle])) args->valid[i] = 0;
  }
}

// The scene lies in the unit box, so a ray can hit nothing further than 1 (max norm) from its end. A ray from far away
// therefore need not start at its origin, where it would lose digits.
constexpr double kLongestRay = 2.0;

// Every ray ends in the unit box. Ends outside it are rounding errors of a very distant receiver. Embree asserts that
// coordinates are below 2^60.
Vec3 brought_into_box(const Vec3& end) {
  const auto within = [](double t) { return t >= -1.0 ? std::min(t, 1.0) : -1.0; };  // also for NaN
  return {within(end.x), within(end.y), within(end.z)};
}

// `from_x` is not yet multiplied by `scale`, which might overflow.
void set_ray(RTCRay16& rays, int lane, const Vec3& end, const Vec3& from_x, double scale) {
  const double distance = max_norm(from_x);
  const bool is_long = distance * scale > kLongestRay;
  const Vec3 direction = from_x * (is_long ? kLongestRay / distance : scale);
  const Vec3 start = end - direction;
  rays.org_x[lane] = static_cast<float>(start.x);
  rays.org_y[lane] = static_cast<float>(start.y);
  rays.org_z[lane] = static_cast<float>(start.z);
  rays.dir_x[lane] = static_cast<float>(direction.x);
  rays.dir_y[lane] = static_cast<float>(direction.y);
  rays.dir_z[lane] = static_cast<float>(direction.z);
  rays.tnear[lane] = 0.0F;
  rays.tfar[lane] = 1.0F;
  rays.time[lane] = 0.0F;
  rays.mask[lane] = ~0U;
  rays.id[lane] = 0;
  rays.flags[lane] = 0;
}

[[noreturn]] void fail(RTCError error, const char* what) {
  if (error == RTC_ERROR_OUT_OF_MEMORY) throw std::bad_alloc();
  throw std::runtime_error(what);
}

}  // namespace

UnitBox checked_unit_box(const Scene& scene, const std::vector<Vec3>& points) {
  const std::vector<std::uint32_t> used = used_vertices(scene);
  if (used.empty()) return {};
  const Box bounds = bounds_of(points, used);
  const UnitBox box = unit_box(bounds, scene.pieces().size());
  std::vector<Problem> problems;
  find_lost_vertices(scene, points, bounds, box, used, problems);
  if (problems.empty()) {  // lost vertices would also be found merged or collapsed
    find_merged_vertices(scene, points, box, used, problems);
    find_spoiled_pieces(scene, points, box, problems);
  }
  if (!problems.empty()) throw InputError(std::move(problems));
  return box;
}

void Blockers::name(std::size_t piece_count, std::span<const std::uint32_t> pieces) {
  for (const std::uint32_t piece : pieces_) named_[piece] = 0;
  named_.resize(piece_count);
  pieces_.assign(pieces.begin(), pieces.end());
  for (const std::uint32_t piece : pieces_) named_[piece] = 1;
}

void Blockers::assign(std::size_t piece_count, std::span<const std::uint32_t> pieces) {
  name(piece_count, pieces);
  all_but_ = false;
}

void Blockers::assign_all_but(std::size_t piece_count, std::span<const std::uint32_t> pieces) {
  name(piece_count, pieces);
  all_but_ = true;
}

void RayScene::DeviceRelease::operator()(RTCDeviceTy* device) const { rtcReleaseDevice(device); }
void RayScene::SceneRelease::operator()(RTCSceneTy* scene) const { rtcReleaseScene(scene); }

RayScene::RayScene(const Scene& scene, const std::vector<Vec3>& points, const UnitBox& box)
    : box_(box), device_(rtcNewDevice("threads=1,set_affinity=0")) {
  if (!device_) fail(rtcGetDeviceError(nullptr), "Embree gives no device");
  scene_.reset(rtcNewScene(device_.get()));
  add_mesh(scene, points);
  rtcSetSceneFlags(scene_.get(), embree::kFilterOfQuery);
  // Not RTC_BUILD_QUALITY_HIGH, which splits triangles in space: about once in 10^5 scenes with coordinates of very
  // different magnitudes it leaves one side of a split empty, and asserts. In scenes of 400 to 20,000 triangles its
  // rays were not faster (and saw the same), and it took four times as long to build.
  rtcSetSceneBuildQuality(scene_.get(), RTC_BUILD_QUALITY_MEDIUM);
  rtcCommitScene(scene_.get());
  const RTCError error = rtcGetDeviceError(device_.get());
  if (error != RTC_ERROR_NONE) fail(error, "Embree cannot build its structure");
}

// All pieces that occlude as one mesh, each a fan of triangles.
void RayScene::add_mesh(const Scene& scene, const std::vector<Vec3>& points) {
  std::vector<Triangle> triangles;
  for (std::uint32_t k = 0; k < scene.pieces().size(); ++k) {
    if (scene.pieces()[k].transparent) continue;
    const auto corners = scene.corners(scene.pieces()[k]);
    for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
      triangles.push_back({corners[0], corners[i], corners[i + 1]});
      piece_of_triangle_.push_back(k);
    }
  }
  RTCGeometry mesh = rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
  Float3* vertices = new_buffer<Float3>(mesh, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3, points.size());
  std::transform(points.begin(), points.end(), vertices, [this](const Vec3& p) { return in_unit_box(box_, p); });
  Triangle* indices = new_buffer<Triangle>(mesh, RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT3, triangles.size());
  std::copy(triangles.begin(), triangles.end(), indices);
  rtcCommitGeometry(mesh);
  rtcAttachGeometry(scene_.get(), mesh);
  rtcReleaseGeometry(mesh);
}

unsigned RayScene::hidden_lanes(const Vec3& origin, const RayEnds& ends, int first, const Blockers& blockers,
                                unsigned hidden) const {
  FilterContext filter{{}, &blockers, piece_of_triangle_.data()};
  const Vec3 start = (origin - box_.centre) * box_.scale;
  const int lanes = std::min(kPacket, ends.count - first);
  RTCRay16 rays;
  alignas(64) int valid[kPacket];
  for (int lane = 0; lane < kPacket; ++lane) {
    const auto i = static_cast<std::size_t>(first + std::min(lane, lanes - 1));
    const Vec3 from_x = ends[i];
    valid[lane] = lane < lanes && (hidden >> lane & 1U) == 0 ? -1 : 0;
    set_ray(rays, lane, brought_into_box(start + from_x * box_.scale), from_x, box_.scale);
  }
  embree::find_occluded(valid, scene_.get(), rays, embree::Order::kCoherent, filter.context, pass_through_others);
  for (int lane = 0; lane < lanes; ++lane) hidden |= (rays.tfar[lane] < 0.0F ? 1U : 0U) << lane;
  return hidden;
}

// --- Receiver view ---

namespace {

// The power of two that brings the largest of the values into [1/2, 1).
double normalising_scale(double largest) {
  return largest > 0.0 ? std::ldexp(1.0, -std::clamp(std::ilogb(largest) + 1, -1022, 1022)) : 1.0;
}

// The shaft of one polygon: half-spaces for the query of the tree, then the same tests for each piece.
class Gatherer {
 public:
  Gatherer(const ScaledScene& scene, const ReceiverView& view, const SourcePlane& plane, Horizon horizon,
           Gathered& scratch)
      : scene_(scene),
        view_(view),
        plane_(plane),
        horizon_(horizon),
        front_(plane_normal(plane.frame[0], plane.frame[1], plane.frame[2])),
        above_(exact_normal(view.normal)),
        extent_(2.0 + max_norm(view.point)),
        half_spaces_(scratch.half_spaces),
        seen_(scratch.seen) {}

  // The polygon's sides, the plane of the source, the plane through x parallel to it, and the horizon.
  std::span<const HalfSpace> shaft(std::span<const Vec3> polygon) {
    half_spaces_.clear();
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const Vec3 edge = polygon[i + 1 < polygon.size() ? i + 1 : 0] - polygon[i];
      add(cross(edge, polygon[i]), 2.0 * max_norm(edge) * max_norm(polygon[i]), 0.0);
    }
    const Vec3 to_plane = plane_.frame[0] - view_.point;
    const double magnitude = max_norm(front_.magnitude);
    add(front_.value, magnitude * (1.0 + max_norm(to_plane)), dot(front_.value, to_plane));
    add(-front_.value, magnitude, 0.0);
    if (horizon_ == Horizon::kClips) half_spaces_.push_back({view_.normal, 0.0});
    return half_spaces_;
  }

  // True if the plane of the last seen piece is too near x, or that piece too near the source's plane, for single
  // precision.
  [[nodiscard]] bool is_blurred(double blur) const {
    const Vec3& normal = seen_.normal.value;
    if (std::abs(dot(normal, seen_.corners[0])) <= blur * length(normal)) return true;
    const Vec3 to_plane = plane_.frame[0] - view_.point;
    return std::all_of(seen_.corners.begin(), seen_.corners.end(), [&](const Vec3& t) {
      return std::abs(dot(front_.value, t - to_plane)) <= blur * length(front_.value);
    });
  }

  // The piece as x sees it, or null if it certainly hides nothing.
  const SeenPolygon* see(std::uint32_t index) {
    const Piece& piece = scene_.scene->pieces()[index];
    if (piece.transparent || view_.is_own(index)) return nullptr;
    if (std::binary_search(plane_.coplanar.begin(), plane_.coplanar.end(), index)) return nullptr;
    corners_ = scene_.scene->corners(piece);
    if (outside_slab()) return nullptr;
    const std::vector<Vec3>& p = scene_.points;
    const Normal front = plane_normal(p[piece.frame[0]], p[piece.frame[1]], p[piece.frame[2]]);
    const int side = side_of_x(view_, scene_, piece, front);
    if (side == 0) return nullptr;
    copy_corners();
    seen_.normal = {-front.value, front.magnitude};
    if (side < 0) seen_.reverse();
    return &seen_;
  }

 private:
  // A rounded normal n' represents an n within 2^-50 of its magnitude, so n . d >= 0 implies only
  // n' . d >= -3 * 2^-50 * magnitude * |d|: the offset is relaxed by more than that.
  void add(const Vec3& normal, double magnitude, double offset) {
    half_spaces_.push_back({normal, offset - 0x1p-47 * magnitude * extent_});
  }

  template <class Height>
  [[nodiscard]] bool no_corner_above(const Height& height) const {
    return std::none_of(corners_.begin(), corners_.end(),
                        [&](std::uint32_t v) { return !height(scene_.points[v]).certainly_not_positive(); });
  }

  // The whole piece lies on or behind the source's plane, on or behind the plane through x, or on or below the horizon.
  [[nodiscard]] bool outside_slab() const {
    return no_corner_above([&](const Vec3& p) { return bounded_dot(front_, p - plane_.frame[0]); }) ||
           no_corner_above([&](const Vec3& p) { return bounded_dot(front_, view_.point - p); }) ||
           (horizon_ == Horizon::kClips &&
            no_corner_above([&](const Vec3& p) { return bounded_dot(above_, p - view_.point); }));
  }

  void copy_corners() {
    seen_.corners.clear();
    seen_.edges.clear();
    for (std::size_t i = 0; i < corners_.size(); ++i) {
      const Vec3& p = scene_.points[corners_[i]];
      seen_.corners.push_back(p - view_.point);
      seen_.edges.push_back(scene_.points[corners_[i + 1 < corners_.size() ? i + 1 : 0]] - p);
    }
  }

  const ScaledScene& scene_;
  const ReceiverView& view_;
  const SourcePlane& plane_;
  Horizon horizon_;
  Normal front_;
  Normal above_;
  double extent_;  // bounds the max norm of any scene point's distance from x, and 1
  std::vector<HalfSpace>& half_spaces_;
  SeenPolygon& seen_;
  std::span<const std::uint32_t> corners_;
};

}  // namespace

ScaledScene::ScaledScene(const Scene& scene_given) : scene(&scene_given) {
  const auto vertices = scene->vertices();
  double largest = 0.0;
  for (const Vec3& v : vertices) largest = std::max(largest, max_norm(v));
  scale = normalising_scale(largest);
  points.reserve(vertices.size());
  for (const Vec3& v : vertices) points.push_back(v * scale);
  std::vector<Box> boxes;
  for (const Piece& piece : scene->pieces()) boxes.push_back(bounds_of(points, scene->corners(piece)));
  tree = ShaftTree(boxes);
}

Box bounds_of(const std::vector<Vec3>& points, std::span<const std::uint32_t> indices) {
  Box box{points[indices[0]], points[indices[0]]};
  for (const std::uint32_t i : indices) box.include(points[i]);
  return box;
}

ReceiverView view_from(const Receiver& receiver, const ScaledScene& scene) {
  for (const FaceId face : receiver.on) require_face(*scene.scene, face);
  if (!kernel::is_finite(receiver.point) || !kernel::is_finite(receiver.normal)) {
    throw InputError(Problem{{},
                             0,
                             "receiver '" + receiver.id + "' has a coordinate that is not finite",
                             "no form factor is defined there",
                             {}});
  }
  if (receiver.normal == Vec3{}) {
    throw InputError(Problem{{},
                             0,
                             "receiver '" + receiver.id + "' has a normal of length 0",
                             "it has no horizon",
                             "give a normal of any other length"});
  }
  ReceiverView view{receiver.point, receiver.point * scene.scale, {}, {}, {*scene.scene, receiver}};
  view.normal = receiver.normal * normalising_scale(max_norm(receiver.normal));
  view.unit_normal = view.normal * (1.0 / length(view.normal));
  return view;
}

std::uint64_t stream_key(const ReceiverView& view, const Selection& source, std::uint64_t seed) {
  const auto bits_of = [](double value) { return std::bit_cast<std::uint64_t>(value + 0.0); };  // -0 is 0
  std::uint64_t key = kernel::split_mix(seed, 0);
  for (const Vec3& v : {view.exact_point, view.normal}) {
    for (const double value : {v.x, v.y, v.z}) key = kernel::split_mix(key, bits_of(value));
  }
  key = kernel::split_mix(key, index_of(source.patch));
  return kernel::split_mix(key, source.face ? index_of(*source.face) + 1 : 0);
}

bool in_front(const ReceiverView& view, const SourcePlane& plane) {
  const Normal normal = plane_normal(plane.frame[0], plane.frame[1], plane.frame[2]);
  const Bounded height = bounded_dot(normal, view.point - plane.frame[0]);
  if (height.certainly_positive()) return true;
  if (height.certainly_not_positive()) return false;
  const std::array<Vec3, 3>& f = plane.exact_frame;
  return kernel::orientation(f[0], f[1], f[2], view.exact_point) > 0;
}

int side_of_x(const ReceiverView& view, const ScaledScene& scene, const Piece& piece, const Normal& front) {
  const Bounded height = bounded_dot(front, view.point - scene.points[piece.frame[0]]);
  if (height.certainly_positive()) return 1;
  if (height.certainly_negative()) return -1;
  if (height.certainly_zero()) return 0;
  const auto vertices = scene.scene->vertices();
  return kernel::orientation(vertices[piece.frame[0]], vertices[piece.frame[1]], vertices[piece.frame[2]],
                             view.exact_point);
}

namespace {

void start(Gathered& gathered) {
  gathered.occluders.clear();
  gathered.sharp_pieces.clear();
  gathered.blurred.clear();
  gathered.looked_at = 0;
}

double reach_of(std::span<const Vec3> polygon) {
  double reach = 0.0;
  for (const Vec3& p : polygon) reach = std::max(reach, max_norm(p));
  return reach;
}

void add_blurred(const SeenPolygon& seen, double reach, Gathered& gathered) {
  gathered.blurred.push_back(static_cast<std::uint32_t>(gathered.occluders.size()));
  gathered.occluders.add(seen, reach);
}

}  // namespace

bool gather_occluders(const ScaledScene& scene, const ReceiverView& view, const SourcePlane& plane,
                      std::span<const Vec3> polygon, Horizon horizon, double blur, Gathered& gathered,
                      std::size_t most) {
  start(gathered);
  Gatherer gatherer(scene, view, plane, horizon, gathered);
  const double reach = reach_of(polygon);
  scene.tree.query(view.point, gatherer.shaft(polygon), [&](std::uint32_t piece) {
    if (scene.scene->pieces()[piece].transparent) return true;
    ++gathered.looked_at;
    if (gathered.looked_at > most) return false;
    const SeenPolygon* seen = gatherer.see(piece);
    if (seen == nullptr) return true;
    if (gatherer.is_blurred(blur)) {
      add_blurred(*seen, reach, gathered);
    } else {
      gathered.sharp_pieces.push_back(piece);
      gathered.occluders.add(*seen, reach);
    }
    return true;
  });
  return gathered.looked_at <= most;
}

void gather_blurred(const ScaledScene& scene, const ReceiverView& view, const SourcePlane& plane,
                    std::span<const Vec3> polygon, Horizon horizon, std::span<const std::uint32_t> pieces,
                    Gathered& gathered) {
  start(gathered);
  Gatherer gatherer(scene, view, plane, horizon, gathered);
  const double reach = reach_of(polygon);
  for (const std::uint32_t piece : pieces) {
    ++gathered.looked_at;
    if (const SeenPolygon* seen = gatherer.see(piece)) add_blurred(*seen, reach, gathered);
  }
}

}  // namespace exactff::adaptive
