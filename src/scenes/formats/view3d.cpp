// View3D (.vs3): surfaces of three or four numbered vertices, with base, combination, emittance and name.
//
// 1. Each line is a record; its first letter says of which kind. All records are read before the references between
//    them are followed, but a surface may refer only to surfaces before it, as in View3D.
// 2. A surface makes a patch of its name, a combined surface a face of the patch of another. Obstruction surfaces of
//    one name form one patch, and so do those without a name. View3D itself does not read their names.
// 3. A subsurface is cut from its base: it becomes a hole of the base, and its edges remain exactly its own.
#include "formats/view3d.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cstdint>
#include <map>
#include <span>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <vector>

#include "exactff/scene.h"
#include "formats/mesh_input.h"
#include "formats/writers.h"
#include "kernel/numbers.h"
#include "text/names.h"
#include "text/number_text.h"
#include "text/phrases.h"

namespace exactff::formats {
namespace {

// --- Subsurfaces ---

// Subsurfaces of View3D: surfaces that lie in another one, their base, and take their area from it.

// Sums of twice the area vector of polygons (Newell's vector).
class AreaSum {
 public:
  explicit AreaSum(const Scene& scene) : scene_(scene) {}

  void add(std::span<const std::uint32_t> polygon) {
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const Vec3& a = scene_.vertices()[polygon[i]];
      const Vec3& b = scene_.vertices()[polygon[(i + 1) % polygon.size()]];
      x_ += product(a.y, b.z) - product(a.z, b.y);
      y_ += product(a.z, b.x) - product(a.x, b.z);
      z_ += product(a.x, b.y) - product(a.y, b.x);
    }
  }
  friend bool operator==(const AreaSum& a, const AreaSum& b) { return a.x_ == b.x_ && a.y_ == b.y_ && a.z_ == b.z_; }

 private:
  static kernel::Rational product(double a, double b) { return kernel::to_rational(a) * kernel::to_rational(b); }

  const Scene& scene_;
  kernel::Rational x_, y_, z_;
};

// True if all vertices are exactly in one plane.
bool in_one_plane(std::span<const Vec3> vertices) {
  for (std::size_t b = 1; b < vertices.size(); ++b) {
    for (std::size_t c = b + 1; c < vertices.size(); ++c) {
      for (std::size_t d = c + 1; d < vertices.size(); ++d) {
        if (kernel::orientation(vertices[0], vertices[b], vertices[c], vertices[d]) != 0) return false;
      }
    }
  }
  return true;
}

// A base has its subsurfaces as holes. By the even-odd rule, a part that two holes cover would belong to the base
// again. True if this is not so and every hole lies in the base, exactly: what is left of the base and its subsurfaces
// have the same total area as the whole base. `base` and `subsurfaces` are in one plane and in the scene.
// Let m be the number of subsurfaces over a point. The remainder has the points of the base with even m. So the areas
// of the remainder and of the subsurfaces exceed the area of the base by the integral of m, less 1 where m is odd, and
// of m outside the base. This is 0 only if m is at most 1, and 0 outside.
bool are_parts(const Scene& scene, FaceId base, std::span<const FaceId> subsurfaces) {
  AreaSum whole(scene), parts(scene);
  whole.add(scene.face(base).rings.front());
  for (const Piece& piece : scene.pieces_of(base)) parts.add(scene.corners(piece));
  for (const FaceId subsurface : subsurfaces) parts.add(scene.face(subsurface).rings.front());
  return parts == whole;
}

// True if the subsurface has the front of its base, or no area.
bool same_front(const Scene& scene, FaceId base, FaceId subsurface) {
  const Vec3& a = scene.face(base).newell;
  const Vec3& b = scene.face(subsurface).newell;
  if (scene.face(subsurface).shape != FaceShape::kPlanar) return true;
  return (a.x < 0.0) == (b.x < 0.0) && (a.y < 0.0) == (b.y < 0.0) && (a.z < 0.0) == (b.z < 0.0);  // they are parallel
}

// --- Reader ---

constexpr std::string_view kObstructions = "obstructions";

struct Surface {
  std::size_t line = 0;
  bool obstructs_only = false;
  std::vector<std::uint32_t> ring;  // vertices, counted from 0
  std::size_t base = 0;             // numbers of surfaces, counted from 1; 0: none
  std::size_t combined_with = 0;
  MaterialId material{};
  std::string name;
  std::vector<std::size_t> subsurfaces;  // places in the list of surfaces
};

class View3dReader {
 public:
  View3dReader(std::string_view text, MeshInput& input) : input_(input), lines_(text) {}

  Scene run() {
    while (lines_.next(line_)) {
      rest_ = line_.text.substr(0, line_.text.find('!'));
      if (!read_record()) break;
    }
    for (const Vec3& vertex : vertices_) input_.add_vertex(vertex, {});
    add_surfaces();
    Scene scene = input_.build();
    check_subsurfaces(scene);
    return scene;
  }

 private:
  // False at the end of the data. As in View3D, only the first letter counts.
  bool read_record() {
    const std::string_view word = text::take_word(rest_);
    if (word.empty()) return true;
    switch (std::toupper(static_cast<unsigned char>(word.front()))) {
      case 'V':
        read_vertex();
        return true;
      case 'S':
        read_surface(false);
        return true;
      case 'O':
        read_surface(true);
        return true;
      case 'F':
        check_geometry();
        return true;
      case 'T':  // title
      case 'C':  // settings of a run
      case '/':  // comment
        return true;
      case 'E':
      case '*':
        return false;
      case 'M':
      case 'N':
        fail("record " + text::in_quotes(word) + ": masking and null surfaces are not read",
             "they hide a part of a surface from some others only", "cut the surface, or remove the record");
        return true;
      default:
        fail("unknown record " + text::in_quotes(word), "View3D files have the records T, C, F, V, S, O and E",
             "remove it, or begin the line with !");
        return true;
    }
  }

  void check_number(std::string_view what, std::size_t expected) {
    const std::string_view word = text::take_word(rest_);
    const auto number = whole_number(word);
    if (number && *number >= 0 && static_cast<std::size_t>(*number) == expected) return;
    fail(std::string(what) + " " + text::in_quotes(word) + " is out of sequence",
         "View3D numbers them from 1 without gaps", "its number must be " + std::to_string(expected));
  }

  void check_geometry() {
    const std::string_view geometry = text::take_word(rest_);
    if (geometry == "3") return;
    if (text::in_lower_case(geometry) == "3a") {
      input_.give_up(
          at_line(line_.number), "geometry '3a' is not read",
          "it gives each surface by a point, an azimuth, a tilt and sizes, so corners would have to be rounded",
          "write the corners as vertices, F 3");
    }
    input_.give_up(at_line(line_.number), "geometry " + text::in_quotes(geometry) + " is not read",
                   "exactff reads vertices and surfaces in three dimensions, F 3", "convert the file");
  }

  void read_vertex() {
    check_number("vertex", vertices_.size() + 1);
    vertices_.push_back(input_.take_point(rest_, line_.number, "write V number x y z"));
  }

  void read_surface(bool obstructs_only) {
    check_number("surface", surfaces_.size() + 1);
    Surface surface;
    surface.line = line_.number;
    surface.obstructs_only = obstructs_only;
    read_ring(surface);
    if (obstructs_only) {
      read_obstruction(surface);
    } else {
      surface.base = take_reference("base");
      surface.combined_with = take_reference("combination");
      surface.material = take_emittance();
      surface.name = text::take_word(rest_);
    }
    if (surface.name.empty() && !obstructs_only) surface.name = "surface_" + std::to_string(surfaces_.size() + 1);
    surfaces_.push_back(std::move(surface));
  }

  // The fourth vertex of a triangle is 0.
  void read_ring(Surface& surface) {
    for (int i = 0; i < 4; ++i) {
      const std::string_view word = text::take_word(rest_);
      const auto index = whole_number(word);
      if (i == 3 && index == 0) return;
      if (!index || *index < 1 || *index > std::int64_t{0xFFFFFFFF}) {
        return fail(text::in_quotes(word) + " is not the number of a vertex",
                    "a surface has three or four vertices, counted from 1", "write the fourth one of a triangle as 0");
      }
      surface.ring.push_back(static_cast<std::uint32_t>(*index - 1));
    }
  }

  // View3D passes over all that follows the vertices: a name, or base, combination, emittance and name as of a surface.
  void read_obstruction(Surface& surface) {
    surface.material = obstruction_material();
    const std::vector<std::string_view> words = text::words(rest_);
    const auto is_name = [](std::string_view word) {
      return text::parse_number(word).fault != text::NumberFault::kNone;
    };
    const auto name = std::ranges::find_if(words, is_name);
    surface.name = words.size() > 3 ? words[3] : name == words.end() ? kObstructions : *name;
  }

  std::size_t take_reference(const char* what) {
    const std::string_view word = text::take_word(rest_);
    const auto number = whole_number(word);
    if (number && *number >= 0 && static_cast<std::uint64_t>(*number) <= surfaces_.size())
      return static_cast<std::size_t>(*number);
    fail(std::string(what) + " " + text::in_quotes(word) + " is not the number of a surface before this one",
         "surfaces are combined with, or lie in, surfaces that the file has already defined", "correct it, or write 0");
    return 0;
  }

  // Kd = 1 - emittance, as a decimal before it is rounded. Without a number, the surface has neither emittance nor
  // name.
  MaterialId take_emittance() {
    const std::string_view word = text::take_word(rest_);
    const text::ParsedNumber number = text::parse_number(word);
    if (number.fault != text::NumberFault::kNone || number.value < 0.0 || number.value > 1.0) {
      fail("emittance " + text::in_quotes(word) + " is not a number between 0 and 1",
           "the reflectance of the surface is 1 - emittance", "correct it");
      return input_.no_material();
    }
    const std::string emittance = fixed_decimal(number.value);
    const auto [place, is_new] = materials_.try_emplace(emittance);
    if (is_new) {
      const double kd = text::parse_number(decimal_complement(emittance).value_or("1")).value;
      place->second = input_.material({"emittance_" + emittance, {kd, kd, kd}, {}});
    }
    return place->second;
  }

  MaterialId obstruction_material() {
    const auto [place, is_new] = materials_.try_emplace(std::string(kObstruction));
    if (is_new) place->second = input_.material({std::string(kObstruction), {1.0, 1.0, 1.0}, {}});
    return place->second;
  }

  void add_surfaces() {
    for (std::size_t place = 0; place < surfaces_.size(); ++place) {
      line_.number = surfaces_[place].line;
      for (const std::uint32_t vertex : surfaces_[place].ring) {
        if (vertex >= vertices_.size())
          fail("vertex " + std::to_string(vertex + 1ULL) + " does not exist",
               "the file has " + text::counted(vertices_.size(), "vertex", "vertices"), "correct the number");
      }
      if (surfaces_[place].base > 0) cut_from_base(place);
    }
    for (std::size_t place = 0; place < surfaces_.size(); ++place) {
      const Surface& surface = surfaces_[place];
      line_.number = surface.line;
      std::vector<std::vector<std::uint32_t>> holes;
      for (const std::size_t subsurface : surface.subsurfaces) holes.push_back(surfaces_[subsurface].ring);
      input_.add_face(patch_of(place), surface.material, surface.ring, at_line(surface.line), std::move(holes));
    }
  }

  void cut_from_base(std::size_t place) {
    const std::size_t base = surfaces_[place].base - 1;
    std::vector<Vec3> corners;
    for (const std::size_t surface : {base, place}) {
      for (const std::uint32_t vertex : surfaces_[surface].ring) {
        if (vertex < vertices_.size()) corners.push_back(vertices_[vertex]);
      }
    }
    if (surfaces_[base].obstructs_only) {
      fail("the base of surface " + name_at(place) + " is an obstruction surface", "it has no area of its own to give",
           "correct the base, or write 0");
    } else if (!in_one_plane(corners)) {
      fail("surface " + name_at(place) + " is not exactly in the plane of its base " + name_at(base),
           "it cannot be cut out of it exactly", "move its vertices, or divide the base around it and write base 0");
    } else {
      surfaces_[base].subsurfaces.push_back(place);
    }
  }

  PatchId patch_of(std::size_t place) {
    const Surface& surface = surfaces_[place];
    if (surface.obstructs_only) {
      const auto known = obstructions_.find(surface.name);
      if (known != obstructions_.end()) return known->second;
      return obstructions_[surface.name] = input_.patch(distinct_name(place));
    }
    if (surface.combined_with == 0) return patches_[place] = input_.patch(distinct_name(place));
    const auto other = patches_.find(surface.combined_with - 1);
    if (other != patches_.end()) return other->second;
    fail("surface " + name_at(place) + " is combined with surface " + name_at(surface.combined_with - 1),
         "that one is itself combined, or an obstruction", "name the first surface of the combination");
    return input_.patch(surface.name);
  }

  // View3D tells surfaces apart by their numbers, so names may be repeated.
  std::string distinct_name(std::size_t place) {
    std::string name = surfaces_[place].name;
    if (names_.insert(name).second) return name;
    name += "#" + std::to_string(place + 1);
    while (!names_.insert(name).second) name += '_';
    input_.warn(at_line(surfaces_[place].line), "surface " + name_at(place) + " has the name of another",
                "names select patches", "it is called " + text::in_quotes(name));
    return name;
  }

  // Faces are in the order of surfaces. A base that --skip-bad-faces has left out has nothing to lose.
  void check_subsurfaces(const Scene& scene) const {
    text::ProblemList problems;
    for (std::size_t base = 0; base < surfaces_.size(); ++base) {
      const FaceId base_face{static_cast<std::uint32_t>(base)};
      if (surfaces_[base].subsurfaces.empty() || scene.face(base_face).shape == FaceShape::kSkipped) continue;
      std::vector<FaceId> faces;
      bool same_fronts = true;
      for (const std::size_t place : surfaces_[base].subsurfaces) {
        faces.push_back(FaceId{static_cast<std::uint32_t>(place)});
        if (same_front(scene, base_face, faces.back())) continue;
        same_fronts = false;
        problems.add({input_.file(), surfaces_[place].line,
                      "surface " + name_at(place) + " faces away from its base " + name_at(base),
                      "it would be a part of the other side", "reverse the order of its vertices"});
      }
      if (same_fronts && !are_parts(scene, base_face, faces)) {
        problems.add({input_.file(), surfaces_[base].line,
                      "subsurfaces of surface " + name_at(base) + " overlap, or reach beyond it",
                      "each point belongs to one surface", "correct them"});
      }
    }
    problems.throw_if_any();
  }

  void fail(std::string what, std::string why, std::string suggestion) {
    input_.fail(at_line(line_.number), std::move(what), std::move(why), std::move(suggestion));
  }
  std::string name_at(std::size_t place) const {
    return std::to_string(place + 1) + " (" + text::in_quotes(surfaces_[place].name) + ")";
  }

  MeshInput& input_;
  text::PlainLines lines_;
  text::TextLine line_;
  std::string_view rest_;
  std::vector<Vec3> vertices_;
  std::vector<Surface> surfaces_;
  std::unordered_map<std::string, MaterialId> materials_;  // by emittance, and of obstructions
  std::unordered_set<std::string> names_;
  std::map<std::size_t, PatchId> patches_;       // of surfaces that are not combined
  std::map<std::string, PatchId> obstructions_;  // by name
};

}  // namespace

Scene read_view3d(std::string_view text, const std::filesystem::path& path, const SceneOptions& options) {
  MeshInput input(path, options, "a View3D file");
  return View3dReader(text, input).run();
}

// --- Writer: faces after the first one of a patch are combined with it ---

namespace {

constexpr NameRules kView3dNames = {.one_word = true, .comment = '!'};

bool is_grey(const Rgb& kd) { return kd.r == kd.g && kd.g == kd.b && kd.r <= 1.0; }

// 1 - Kd as a decimal; the mean of three different values.
std::string emittance(const Rgb& kd) {
  const double mean = kd.r == kd.g && kd.g == kd.b ? kd.r : kd.r / 3.0 + kd.g / 3.0 + kd.b / 3.0;
  return decimal_complement(fixed_decimal(std::clamp(mean, 0.0, 1.0))).value_or("1");
}

void tell_losses(const Scene& scene, Losses& losses) {
  const auto tell = [&](const auto& is_lost, const char* colour, const char* what, const char* why,
                        const char* advice) {
    if (const auto count = std::ranges::count_if(scene.materials(), is_lost); count > 0)
      losses.add(colour + text::counted(static_cast<std::uint64_t>(count), "material") + what, why, advice);
  };
  tell([](const Material& m) { return m.emits(); }, "Ke of ", " is lost", "View3D surfaces have no radiosity",
       "write OBJ to keep it");
  tell([](const Material& m) { return !is_grey(m.reflectance); }, "Kd of ", " becomes one number within 0 and 1",
       "View3D surfaces have one emittance, 1 - Kd", "write OBJ to keep the colours");
}

class View3dWriter {
 public:
  View3dWriter(const Scene& scene, Losses& losses)
      : scene_(scene),
        faces_(output_faces(scene, Polygons::kFourCorners, "View3D", losses)),
        names_(output_names(patch_names(scene), kView3dNames, "patch", losses)),
        first_(names_.size()) {}

  std::string run() {
    out_ = "T written by " + text::program_version() + "\nC\nF 3\n";
    for (std::size_t i = 0; i < scene_.vertices().size(); ++i)
      append_point(out_, "V " + std::to_string(i + 1) + ' ', scene_.vertices()[i]);
    for (const OutputFace& face : faces_) {
      if (!obstructs_only(face)) append_surface(face);
    }
    for (const OutputFace& face : faces_) {  // View3D wants them last
      if (obstructs_only(face)) append_obstruction(face);
    }
    return out_ + "End of data\n";
  }

 private:
  // The way in which such surfaces are read.
  bool obstructs_only(const OutputFace& output) const {
    return scene_.material(scene_.face(output.face).material).name == kObstruction;
  }
  void append_corners(const OutputFace& face) {
    for (std::size_t i = 0; i < 4; ++i)
      out_ += ' ' + (i < face.corners.size() ? std::to_string(face.corners[i] + 1ULL) : "0");
  }
  void append_obstruction(const OutputFace& face) {
    out_ += "O " + std::to_string(++count_);
    append_corners(face);
    const std::string& name = names_[index_of(scene_.face(face.face).patch)];
    const bool is_number = text::parse_number(name).fault == text::NumberFault::kNone;
    out_ += (is_number ? " 0 0 0 " : " ") + name + '\n';  // after base, combination and emittance, a number is a name
  }
  void append_surface(const OutputFace& output) {
    const Face& face = scene_.face(output.face);
    std::optional<std::size_t>& first = first_[index_of(face.patch)];
    out_ += "S " + std::to_string(++count_);
    append_corners(output);
    out_ += " 0 " + std::to_string(first.value_or(0)) + ' ' + emittance(scene_.material(face.material).reflectance) +
            ' ' + names_[index_of(face.patch)] + '\n';
    if (!first) first = count_;
  }

  const Scene& scene_;
  const std::vector<OutputFace> faces_;
  const std::vector<std::string> names_;
  std::vector<std::optional<std::size_t>> first_;  // surface of each patch
  std::size_t count_ = 0;
  std::string out_;
};

}  // namespace

std::string write_view3d(const Scene& scene, Losses& losses) {
  tell_losses(scene, losses);
  return View3dWriter(scene, losses).run();
}

// --- Decimal complement ---

namespace {

bool all_digits(std::string_view text) {
  return std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
}

bool all_zeros(std::string_view text) { return text.find_first_not_of('0') == std::string_view::npos; }

}  // namespace

std::optional<std::string> decimal_complement(std::string_view x) {
  if (x.starts_with('+')) x.remove_prefix(1);
  const std::size_t point = std::min(x.find('.'), x.size());
  std::string_view whole = x.substr(0, point);
  const std::string_view fraction = x.substr(std::min(point + 1, x.size()));
  if (!all_digits(whole) || !all_digits(fraction) || (whole.empty() && fraction.empty())) return std::nullopt;
  whole.remove_prefix(std::min(whole.find_first_not_of('0'), whole.size()));
  if (all_zeros(fraction)) {
    if (whole.empty()) return "1";
    return whole == "1" ? std::optional<std::string>("0") : std::nullopt;
  }
  if (!whole.empty()) return std::nullopt;
  // Ten less the last digit that is not 0, nine less each digit before it.
  std::string result = "0." + std::string(fraction);
  const std::size_t last = result.find_last_not_of('0');
  for (std::size_t i = 2; i < last; ++i) result[i] = static_cast<char>('0' + ('9' - result[i]));
  result[last] = static_cast<char>('0' + (10 - (result[last] - '0')));
  return result;
}

std::string fixed_decimal(double value) {
  std::array<char, 400> text{};  // the smallest doubles have 324 zeros
  return {text.data(), std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::fixed).ptr};
}

}  // namespace exactff::formats
