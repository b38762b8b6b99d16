// The competing method under its best conditions: 10^4 shadow rays to jittered points of the source, in prepared
// packets of 16, against exactly the occluders that the exact method has. The rays of a packet end in a square of 4 x 4
// neighbouring cells of the source. Embree is told that they are coherent, or not, because sometimes the one is faster
// and sometimes the other.
#include <benchmark/benchmark.h>

#include <array>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "adaptive/embree.h"
#include "adaptive/sub_patch.h"
#include "bench/scenes.h"
#include "generate/random.h"

namespace exactff::bench {

using adaptive::operator+;
using adaptive::operator-;
using adaptive::operator*;
namespace embree = adaptive::embree;

namespace {

constexpr int kCells = 100;  // a side of the source; one ray each
constexpr int kTile = 4;     // cells per side of a packet
constexpr int kPacket = kTile * kTile;

template <class Handle, void (*release)(Handle)>
struct Release {
  void operator()(Handle handle) const { release(handle); }
};
using Device = std::unique_ptr<RTCDeviceTy, Release<RTCDevice, rtcReleaseDevice>>;
using RayStructure = std::unique_ptr<RTCSceneTy, Release<RTCScene, rtcReleaseScene>>;

RTCDevice device() {
  static const Device the_device(rtcNewDevice("threads=1,set_affinity=0"));
  if (!the_device) throw std::runtime_error("Embree gives no device");
  return the_device.get();
}

struct Occluders {
  std::vector<std::array<float, 3>> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

// All faces except the source's, as fans.
Occluders occluders_of(const BenchScene& s) {
  Occluders result;
  const auto number = [](double value) { return static_cast<float>(value); };
  for (const Vec3& v : s.scene.vertices()) result.vertices.push_back({number(v.x), number(v.y), number(v.z)});
  result.vertices.push_back({});  // Embree reads 16 bytes for each of them
  for (const Piece& piece : s.scene.pieces()) {
    if (s.scene.face(piece.face).patch == s.source.selection().patch) continue;
    const auto corners = s.scene.corners(piece);
    for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
      result.triangles.push_back({corners[0], corners[i], corners[i + 1]});
    }
  }
  return result;
}

template <class Element>
void share(RTCGeometry geometry, RTCBufferType type, RTCFormat format, const std::vector<Element>& elements,
           std::size_t count) {
  rtcSetSharedGeometryBuffer(geometry, type, 0, format, elements.data(), 0, sizeof(Element), count);
}

RayStructure build_structure(const Occluders& occluders) {
  RayStructure structure(rtcNewScene(device()));
  RTCGeometry mesh = rtcNewGeometry(device(), RTC_GEOMETRY_TYPE_TRIANGLE);
  share(mesh, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3, occluders.vertices, occluders.vertices.size() - 1);
  share(mesh, RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT3, occluders.triangles, occluders.triangles.size());
  rtcCommitGeometry(mesh);
  rtcAttachGeometry(structure.get(), mesh);
  rtcReleaseGeometry(mesh);
  rtcCommitScene(structure.get());
  if (rtcGetDeviceError(device()) != RTC_ERROR_NONE) throw std::runtime_error("Embree cannot build its structure");
  return structure;
}

// From just off x to just short of the source, whose own plane hides nothing.
void set_ray(RTCRay16& rays, int lane, const Vec3& x, const Vec3& end) {
  constexpr float kMargin = 0x1p-20F;
  const Vec3 direction = end - x;
  rays.org_x[lane] = static_cast<float>(x.x);
  rays.org_y[lane] = static_cast<float>(x.y);
  rays.org_z[lane] = static_cast<float>(x.z);
  rays.dir_x[lane] = static_cast<float>(direction.x);
  rays.dir_y[lane] = static_cast<float>(direction.y);
  rays.dir_z[lane] = static_cast<float>(direction.z);
  rays.tnear[lane] = kMargin;
  rays.tfar[lane] = 1.0F - kMargin;
  rays.time[lane] = 0.0F;
  rays.mask[lane] = ~0U;
  rays.id[lane] = 0;
  rays.flags[lane] = 0;
}

// Cell by cell within a tile, tile by tile.
std::vector<int> cells_in_order() {
  std::vector<int> cells;
  for (int tile = 0; tile < kCells * kCells / kPacket; ++tile) {
    const int row = tile / (kCells / kTile) * kTile, column = tile % (kCells / kTile) * kTile;
    for (int k = 0; k < kPacket; ++k) cells.push_back((row + k / kTile) * kCells + column + k % kTile);
  }
  return cells;
}

// Requires a source that is one parallelogram.
std::vector<RTCRay16> make_rays(const BenchScene& s) {
  const Piece& source = s.scene.pieces_of(s.scene.faces_of(s.source.selection()).front()).front();
  const auto corners = s.scene.corners(source);
  const Vec3 origin = s.scene.vertices()[corners[0]];
  const Vec3 along_u = s.scene.vertices()[corners[1]] - origin, along_v = s.scene.vertices()[corners[3]] - origin;
  generate::Random random(1);
  const auto jittered = [&](int cell) { return (cell + random.unit()) / kCells; };
  const std::vector<int> cells = cells_in_order();
  std::vector<RTCRay16> packets(cells.size() / kPacket);
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const double u = jittered(cells[i] % kCells), v = jittered(cells[i] / kCells);
    set_ray(packets[i / kPacket], static_cast<int>(i % kPacket), s.receiver.point, origin + along_u * u + along_v * v);
  }
  return packets;
}

// The number of rays that reach the source.
int cast_rays(RTCScene structure, const std::vector<RTCRay16>& packets, embree::Order order) {
  alignas(64) static const std::array<int, kPacket> kAll = [] {
    std::array<int, kPacket> all{};
    all.fill(-1);
    return all;
  }();
  int arrived = 0;
  for (const RTCRay16& packet : packets) {
    RTCRay16 rays = packet;
    embree::QueryContext context;
    embree::find_occluded(kAll.data(), structure, rays, order, context, nullptr);
    for (const float far : rays.tfar) arrived += far >= 0.0F;
  }
  return arrived;
}

void cast(benchmark::State& state, const BenchScene& s, embree::Order told) {
  const Occluders occluders = occluders_of(s);
  const RayStructure structure = build_structure(occluders);
  const std::vector<RTCRay16> packets = make_rays(s);
  double visible = 0.0;
  for (auto _ : state) visible = static_cast<double>(cast_rays(structure.get(), packets, told)) / (kCells * kCells);
  state.counters["visible"] = visible;
  if (s.scene.pieces().size() > 2000) return;
  // The error of jittered rays is below 1/200 (one standard deviation); a larger one would mean a different scene.
  if (std::abs(visible - s.visible_fraction()) > 0.025)
    state.SkipWithError("the rays do not see what the exact method sees");
}

}  // namespace

void add_rays() {
  for (const auto& [name, told] :
       {std::pair{"coherent", embree::Order::kCoherent}, std::pair{"incoherent", embree::Order::kIncoherent}}) {
    add_for_every_scene(std::string("rays/") + name,
                        [told = told](benchmark::State& state, const BenchScene& s) { cast(state, s, told); });
  }
}

}  // namespace exactff::bench
