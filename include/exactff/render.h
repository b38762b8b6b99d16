// Images of a scene under direct light, in which every pixel is exact: the light's soft shadows without noise. Or under
// the light of all bounces, if the radiosities of all patches are given.
//
// A pixel has one ray. The first face that the ray meets is decided exactly, the point where it meets the face is
// rounded once to doubles, and the light that this point receives from all sources is the correctly rounded value of
//
//   B_c = Ke_c + rho_c * sum over sources of B_s,c F_s          (for each colour channel c)
//
// or of a quantity derived from it. rho is Kd of the face, Ke its emission, B_s the radiosity of a source, F_s the
// exact form factor from the point to the source (exact.h). The front of a face is visible; its back is black, unless
// faces are two-sided. A transparent face is passed.
//
// Five lines lead from a scene to an image:
//
//   const render::Camera camera = {.eye = {278, 273, -800}, .look = {278, 273, 0}, .fov = 39.3};
//   const render::View view(camera, {512, 512});
//   const render::Picture picture = render::render({.scene = &scene, .view = view});
//   render::write_image("image.png", picture, {});
//   // picture.values: 3 doubles a pixel, row by row from the top; NaN where no face is met
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "exactff/exact.h"
#include "exactff/jobs.h"
#include "exactff/methods.h"
#include "exactff/radiosity.h"
#include "exactff/receiver.h"
#include "exactff/scene.h"
#include "exactff/view.h"

namespace exactff::jobs {
class Journal;  // jobs.h
}

namespace exactff::render {

// ------------------------------------------------------------------------------------------------------------ camera

// A pinhole camera, or parallel rays if `ortho` is given. `eye`, `look` (a point) and `up` are in the scene's
// coordinates, which are right-handed: if the camera looks along +z and y is up, x grows to the left.
struct Camera {
  Vec3 eye = {};
  Vec3 look = {};
  Vec3 up{0.0, 1.0, 0.0};
  double fov = 40.0;                 // vertical angle of view in degrees, above 0 and below 180
  std::optional<double> ortho = {};  // height of the picture in the scene's unit
};

struct Size {
  int width = 512;
  int height = 512;
};
inline constexpr int kLongestSide = 65536;

// The points origin + t direction, t > 0. Both vectors mean exactly the values of their doubles.
struct Ray {
  Vec3 origin;
  Vec3 direction;
};

// The rays of a camera. In IEEE double arithmetic, rounded after each operation, in this order:
//
//   w = unit(look - eye),  a = unit(w x up) (to the right),  b = a x w (upwards)
//   unit(v): v / m with m the largest component in magnitude, then divided by sqrt((x x + y y) + z z)
//   T = tan(fov / 2), correctly rounded; with ortho: T = ortho / 2
//   s = (2 column - width) / height * T,  r = (height - 2 row) / height * T
//   perspective: origin = eye, direction = (w + s a) + r b
//   parallel:    origin = (eye + s a) + r b, direction = w
//
// so the rays are the same on every machine. Column and row are counted in pixels from the upper left corner of the
// picture; the centre of the pixel in column i and row j, from 0, is (i + 1/2, j + 1/2).
class View {
 public:
  View() : View(Camera{{}, {0.0, 0.0, -1.0}}, Size{}) {}
  // Throws InputError that lists every problem: a size or an angle out of range, numbers that are not finite, eye and
  // look in one place, up along the line of sight.
  View(const Camera& camera, const Size& size);

  [[nodiscard]] const Camera& camera() const { return camera_; }
  [[nodiscard]] const Size& size() const { return size_; }
  [[nodiscard]] Ray ray(double column, double row) const;

 private:
  Camera camera_;
  Size size_;
  Vec3 forward_, right_, up_;
  double tangent_ = 1.0;
};

// The camera and size as flags of exactff render.
[[nodiscard]] std::string flags_of(const View& view);

// The axis that probably points upwards: z if more area of fronts looks along +z, as floors do, than along +y; else y.
// A front looks along an axis within two degrees. An estimate.
[[nodiscard]] Vec3 upwards(const Scene& scene);

// What a default camera is to have.
struct CameraWishes {
  Vec3 up{};                       // zero: upwards()
  std::optional<double> fov = {};  // empty: that of Camera, and a wide angle inside a closed room
  std::optional<double> ortho = {};
};
inline constexpr double kWideFov = 70.0;

// A camera that shows the whole scene from its most open side: of the directions along the axes and between them, the
// one from which the largest share of a test picture shows fronts. If hardly any fronts are seen from outside, as of a
// closed room, the camera stands near a corner of the scene's box, below the ceiling: where it sees a lamp, and then
// where it sees most patches from far.
[[nodiscard]] Camera default_camera(const Scene& scene, const CameraWishes& wishes, const Size& size);

// ---------------------------------------------------------------------------------------- first face and receiver

// Where a ray meets a face first.
struct Hit {
  FaceId face{};
  bool back = false;  // the ray meets the face's back
  Vec3 point;         // the exact point, each coordinate rounded to the nearest double

  friend bool operator==(const Hit&, const Hit&) = default;
};

// The first face that the ray meets, decided exactly; of several at the same distance, one that shows its front, and
// then the one of lowest index, as in a view (view.h). Transparent faces are passed, and so is a face that the ray
// meets edge-on (in whose plane it runs). A face has its boundary. A face on which the ray begins is not met. Safe to
// call from several threads.
[[nodiscard]] std::optional<Hit> first_hit(const Scene& scene, const Ray& ray);

// The receiver at the point of a hit, as receivers made on a face are (grid_receivers): with the face's Newell vector
// as its normal, turned if the back was met, and with the face and its neighbours in the same surface as its own faces.
[[nodiscard]] Receiver receiver_at(const Scene& scene, const Hit& hit);

// ---------------------------------------------------------------------------------------------------------- lightmap

// A picture in texture space: each texel has the light of the point of a face that its centre stands for.
//
// u grows with the columns, v against the rows: the centre of the texel in column i and row j, from 0, is u = (i + 1/2)
// / width, v = 1 - (j + 1/2) / height, so row 0 is at v = 1. A face has its triangles in the texture: itself, or those
// of triangulated() (scene.h). A centre lies in a triangle exactly, boundary included. Of several triangles that hold
// it, the one of the lowest face counts, then the first of that face; so on an edge that two faces share, one of them.
// The affine map of the triangle gives the point, each coordinate the nearest double to the exact one. A centre on the
// boundary of its triangle stands for the point 2^-30 of the way from there to the triangle's centre: beside an edge
// that faces form, roundings would else put it behind one of them. Coordinates outside of 0 to 1 lie outside of the
// picture.
struct Lightmap {
  Size size;
  int set = 0;                     // Scene::texture
  std::vector<Selection> on = {};  // empty: all faces
  int margin = 0;                  // so many texels around those of faces are copies of the nearest ones
};

// What texture coordinates are like, of the faces with area that a lightmap is of.
struct Charts {
  std::uint64_t faces = 0;        // with texture coordinates
  std::uint64_t without = 0;      // without
  std::uint64_t flat = 0;         // of `faces`: all triangles have no area in the texture
  std::uint64_t outside = 0;      // of `faces`: with a corner outside of 0 to 1
  std::uint64_t missed = 0;       // of `faces`: neither of these, and no texel shows them
  std::uint64_t texels = 0;       // that show a face
  std::uint64_t overlapping = 0;  // of `texels`: the centre is strictly inside of several triangles
  std::optional<std::pair<FaceId, FaceId>> first_overlap =
      {};  // at the first such texel found: which it shows, another

  friend bool operator==(const Charts&, const Charts&) = default;
};

// The faces of texels. Refers to the scene.
class Atlas {
 public:
  // Throws InputError for a size that is not from 1 to kLongestSide, a margin below 0, if none of the faces has
  // texture coordinates, or if the picture would need too much memory; std::invalid_argument for a selection of another
  // scene, and for another set.
  Atlas(const Scene& scene, const Lightmap& lightmap);

  [[nodiscard]] const Lightmap& lightmap() const { return lightmap_; }
  [[nodiscard]] const Charts& charts() const { return charts_; }
  // Counted from 0. Nothing for a texel that shows no face. receiver_at() makes it a receiver. Safe to call from
  // several threads.
  [[nodiscard]] std::optional<Hit> hit(int column, int row) const;

 private:
  struct Triangle {
    FaceId face{};
    std::array<std::uint32_t, 3> vertices{};
    std::array<TexturePoint, 3> at{};
  };
  void take(FaceId face);
  [[nodiscard]] bool fill(std::uint32_t triangle, std::vector<bool>& inside, std::vector<bool>& overlaps);

  const Scene* scene_;
  Lightmap lightmap_;
  Charts charts_;
  std::vector<Triangle> triangles_;
  std::vector<std::uint32_t> shown_;  // triangle of every texel, or kNone
};

// ----------------------------------------------------------------------------------------------------------- picture

enum class Sides { kFront, kBoth };  // kBoth: the back of a face is lit as its front, but emits nothing
// kAll, as channels of an EXR file: for each source `F.NAME`, its form factor, `visible.NAME` (0: nothing of it is
// visible, 1: a part, 2: all) and `fraction.NAME`, its visible fraction; `position.X` to `.Z`; the unit normal
// `normal.X` to `.Z`; `distance` from the start of the ray, not of a lightmap; `id.face` and `id.patch`, counted from 1
// in the order of the file. 0 where nothing is met.
enum class Layers { kNone, kAll };
enum class Bounds { kNone, kAll };
// kSlope: in every channel the length of the gradient of the sum of form factors along the surface, per unit of length;
// its components are layers. 0 at kinks, where there is none (exact.h). Computed from correctly rounded derivatives,
// and accurate to a few units in the last place of the largest. Not for methods, the sky, layers and bounds.
enum class Shown { kLight, kSlope };

// What to compute. Keeps a reference to the scene.
struct Request {
  const Scene* scene = nullptr;
  std::string scene_name = {};  // for metadata
  View view = {};
  // Instead of the view. The layer A is 1 for texels that show a face and 0 for all others; `margin` counts the texels
  // from there to one that is copied. Not for backs (Sides) and several points.
  std::optional<Lightmap> lightmap = {};
  std::vector<Selection> sources = {};  // empty: every patch that emits, unless there is `sky`
  bool sky =
      false;  // one more source, with a radiosity of 1: all directions that meet nothing; not for methods, layers
  // If given, the sources are all patches with these radiosities: B_c = Ke_c + rho_c * sum over patches j of B_j,c F_j.
  // Picture::lower and upper then bound this sum, with B_j anywhere within its bounds. They do not bound the light of
  // the integral equation, in which radiosity varies over a patch. Not together with `sources`, `sky`, form factors.
  std::optional<radiosity::Radiosities> radiosities = {};
  std::optional<methods::Choice> method = {};  // empty: the exact values
  Quantity quantity = Quantity::kRadiance;
  // Another one than the form factor requires that quantity, which then is the sum of this measure over the sources (a
  // sphere at the point, on both sides of the face, if it is one); not with a method, radiosities, the slope.
  Measure measure = {};
  KeMeans ke = KeMeans::kRadiosity;
  Sides sides = Sides::kFront;
  int spp = 1;  // a pixel is the mean of the values at the centres of spp x spp parts of it
  Bounds bounds = Bounds::kNone;
  Layers layers = Layers::kNone;  // requires spp 1 and no method
  Shown shown = Shown::kLight;
  Engine engine = Engine::kEdges;
  int threads = 0;  // 0: as many as this process may use; no byte depends on it
};

// A named number for each pixel.
struct Layer {
  std::string name = {};  // of the channel in an EXR file
  bool whole = false;     // a whole number from 0 to 2^32 - 1
  std::vector<double> values = {};
};

// What a pixel shows.
enum class Shows : std::uint8_t { kNothing, kBack, kFace, kEmitter };

struct Picture {
  Size size;
  // 3 per pixel, row by row from the top. NaN if no point of the pixel meets a face; of several points, those that meet
  // none count as 0. Exact values are correctly rounded; a mean of several points is that of these doubles, rounded
  // once.
  std::vector<double> values;
  std::vector<double> lower, upper;  // on request: bounds, proved but for those of radiosities (their claim)
  std::vector<Shows> shows;          // of several points: the greatest
  // If a pixel has several points, 4 for each: the share of them that shows emitters, and the part of `values` that
  // comes from these. Estimates, for develop().
  std::vector<double> lamps;
  std::vector<Layer> layers;          // on request
  std::uint64_t not_certified = 0;    // points at which a channel reached the precision cap; their bounds are valid
  double seconds = 0.0;               // processor time of all threads
  std::optional<Charts> charts = {};  // of a lightmap
  std::vector<std::pair<std::string, std::string>> metadata;  // name and text, for image files

  [[nodiscard]] std::size_t pixels() const { return shows.size(); }
};

// Computes the picture in tiles. Finished tiles are kept in `journal`, if given, and taken from it. Throws InputError
// if there is no source, if the sources' radiosities are too large to be added (beyond 1e290), if the picture would
// need too much memory, or if the method does not accept the scene; throws Cancelled if the hooks cancel.
[[nodiscard]] Picture render(const Request& request, const Hooks& hooks = {}, jobs::Journal* journal = nullptr);

// -------------------------------------------------------------------------------------------------------- comparison

// The errors of one picture against another of the same size. The error of a pixel is the difference of the channel in
// which it is largest in magnitude. Pixels that show nothing do not count.
struct Errors {
  std::uint64_t pixels = 0;
  double rms = 0.0, p99 = 0.0, worst = 0.0;          // of the magnitudes
  double relative_median = 0.0, relative_p99 = 0.0;  // of magnitude / true value; infinite where only the latter is 0
  std::uint64_t wrong = 0;                           // pixels with a relative error above kWrong
  std::vector<double> signed_errors;                 // of every pixel; NaN where it shows nothing
  std::vector<bool> is_wrong;                        // of every pixel
};
inline constexpr double kWrong = 0.1;
[[nodiscard]] Errors errors_of(const Picture& judged, const Picture& truth);
// The picture of another program, an OpenEXR file or a NumPy array of shape (height, width, 3), its rows from the top.
// It does not say what its pixels show: `shows` is kFace for all. Throws InputError.
[[nodiscard]] Picture read_picture(const std::filesystem::path& file);
// judged - truth, channel by channel.
[[nodiscard]] Picture difference(const Picture& judged, const Picture& truth);

// ------------------------------------------------------------------------------------------------------- image files

// 8-bit colours, 3 bytes a pixel, row by row from the top.
struct Colours {
  Size size;
  std::vector<std::uint8_t> bytes;
};

// The factor that brings the 99th percentile of the largest channel, over all pixels that reflect light, to 0.8.
[[nodiscard]] double automatic_exposure(const Picture& picture);
// In sRGB. Of a pixel with several points, what shows emitters and the rest are limited to white apart, each by its
// share of the points: otherwise a lamp, far brighter than white, would fill every pixel that it touches.
[[nodiscard]] Colours develop(const Picture& picture, double exposure);
// Errors in colours: white is none, red too bright, blue too dark; full colour from `scale` on. Regions in which
// most pixels are wrong are outlined.
[[nodiscard]] Colours coloured(const Errors& errors, const Size& size, double scale);
// The 99th percentile of the errors, or the worst one if that is 0; 1 if there is none.
[[nodiscard]] double colour_scale(const Errors& errors);
// Pictures side by side, with white between them. At least one.
[[nodiscard]] Colours strip(std::span<const Colours> pictures);

enum class ImageKind { kExr, kPng };
// By the extension. Throws InputError for any other.
[[nodiscard]] ImageKind image_kind(const std::filesystem::path& file);

using Metadata = std::vector<std::pair<std::string, std::string>>;

// The content of an OpenEXR file: channels R, G, B and those of the layers, in 32 bits. What shows nothing is 0.
[[nodiscard]] std::string exr_of(const Picture& picture);
// Of a PNG file.
[[nodiscard]] std::string png_of(const Colours& colours, const Metadata& metadata);

// Writes the picture as EXR or PNG; the file appears complete or not at all. `exposure` is for PNG; automatic if empty.
void write_image(const std::filesystem::path& file, const Picture& picture, std::optional<double> exposure);

}  // namespace exactff::render
