// Names for faces that selectors find.
#include <algorithm>
#include <array>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kernel/float_environment.h"
#include "kernel/vec.h"
#include "scene/geometry_patches.h"
#include "scene/scene.h"
#include "scene/scene_copy.h"
#include "scene/selections.h"
#include "text/number_text.h"
#include "text/phrases.h"
#include "text/refuse.h"
#include "text/text_lines.h"

namespace exactff {
namespace {

using text::in_quotes;

[[noreturn]] void refuse_selector(std::string_view selector, const std::string& why) {
  text::refuse(
      "the selector " + in_quotes(selector, text::kShownName) + " cannot be read", why,
      "write box:X0,Y0,Z0,X1,Y1,Z1, normal:X,Y,Z[:DEGREES], plane:A,B,C,D[:DISTANCE], NAME:1-20,25 or NAME, or "
      "several with ' & ' between them");
}

std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  for (;;) {
    const std::size_t end = text.find(separator);
    parts.push_back(text::trimmed(text.substr(0, end)));
    if (end == std::string_view::npos) return parts;
    text.remove_prefix(end + 1);
  }
}

// `count` numbers with commas, and perhaps another one after a colon.
struct Numbers {
  std::vector<double> list;
  std::optional<double> last;
};

Numbers numbers_of(std::string_view selector, std::size_t count, bool may_have_last) {
  const std::vector<std::string_view> parts = split(selector.substr(selector.find(':') + 1), ':');
  const auto number = [&](std::string_view text) {
    const text::ParsedNumber parsed = text::parse_number(text);
    if (parsed.fault != text::NumberFault::kNone) refuse_selector(selector, in_quotes(text) + " is not a number");
    return parsed.value;
  };
  Numbers numbers;
  for (const std::string_view text : split(parts[0], ',')) numbers.list.push_back(number(text));
  if (numbers.list.size() != count || parts.size() > (may_have_last ? 2U : 1U)) {
    refuse_selector(selector, "it has " + std::to_string(count) + " numbers with commas" +
                                  (may_have_last ? ", and perhaps one more after a colon" : ""));
  }
  if (parts.size() == 2) numbers.last = number(parts[1]);
  return numbers;
}

using IsWanted = std::function<bool(FaceId)>;

template <class Test>
IsWanted for_all_corners(const Scene& scene, Test test) {
  return [&scene, test](FaceId id) {
    return std::ranges::all_of(scene.face(id).rings, [&](const auto& ring) {
      return std::ranges::all_of(ring, [&](std::uint32_t v) { return test(scene.vertices()[v]); });
    });
  };
}

IsWanted in_box(const Scene& scene, std::string_view selector) {
  const std::vector<double> n = numbers_of(selector, 6, false).list;
  const auto within = [](double u, double a, double b) { return std::min(a, b) <= u && u <= std::max(a, b); };
  return for_all_corners(scene, [n, within](const Vec3& x) {
    return within(x.x, n[0], n[3]) && within(x.y, n[1], n[4]) && within(x.z, n[2], n[5]);
  });
}

IsWanted by_normal(const Scene& scene, std::string_view selector) {
  constexpr double kDegrees = 5.0;
  const Numbers numbers = numbers_of(selector, 3, true);
  const double degrees = numbers.last.value_or(kDegrees);
  const kernel::ExactVec3 direction = kernel::exact_vector({numbers.list[0], numbers.list[1], numbers.list[2]}).v;
  if (is_zero(direction)) refuse_selector(selector, "0,0,0 is no direction");
  if (!(degrees >= 0.0 && degrees <= 180.0)) refuse_selector(selector, "an angle is from 0 to 180 degrees");
  return [&scene, direction, degrees](FaceId id) {
    return std::ranges::all_of(scene.pieces_of(id), [&](const Piece& piece) {
      return compare_angle(degrees, exact_normal(scene, piece), direction) >= 0;
    });
  };
}

IsWanted in_plane(const Scene& scene, std::string_view selector) {
  const Numbers numbers = numbers_of(selector, 4, true);
  const kernel::RationalVec3 normal = kernel::to_rational(Vec3{numbers.list[0], numbers.list[1], numbers.list[2]});
  if (is_zero(normal)) refuse_selector(selector, "0,0,0 is no normal of a plane");
  const kernel::Rational at = kernel::to_rational(numbers.list[3]);
  if (numbers.last.value_or(0.0) < 0.0) refuse_selector(selector, "a distance is not negative");
  const kernel::Rational reach = kernel::to_rational(numbers.last.value_or(0.0));
  return for_all_corners(scene,
                         [normal, at, most = kernel::Rational(reach * reach * dot(normal, normal))](const Vec3& x) {
                           const kernel::Rational off = dot(normal, kernel::to_rational(x)) - at;
                           return off * off <= most;
                         });
}

std::optional<std::uint64_t> whole(std::string_view text) {
  const text::ParsedNumber number = text::parse_number(text);
  const bool is_one = !text.empty() && text.find_first_not_of("0123456789") == std::string_view::npos;
  if (!is_one || number.fault != text::NumberFault::kNone || !(number.value < 1e9)) return std::nullopt;
  return static_cast<std::uint64_t>(number.value);
}

// NAME:1-20,25, or NAME as Scene::select_all() reads it.
IsWanted by_name(const Scene& scene, std::string_view selector) {
  std::vector<bool> wanted(scene.faces().size(), false);
  const std::size_t colon = selector.rfind(':');
  const auto patch = std::ranges::find(scene.patches(),
                                       colon == std::string_view::npos ? "" : selector.substr(0, colon), &Patch::name);
  const bool is_list = patch != scene.patches().end() &&
                       selector.substr(colon + 1).find_first_not_of("0123456789-, ") == std::string_view::npos &&
                       !has_patch(scene, selector);
  if (!is_list) {
    for (const Selection& one : scene.select_all(selector)) {
      for (const FaceId face : scene.faces_of(one)) wanted[index_of(face)] = true;
    }
  } else {
    for (const std::string_view range : split(selector.substr(colon + 1), ',')) {
      const std::vector<std::string_view> ends = split(range, '-');
      const auto first = whole(ends.front()), last = whole(ends.back());
      if (ends.size() > 2 || !first || !last || *first < 1 || *last < *first || *last > patch->faces.size()) {
        refuse_selector(selector, in_quotes(range) + " is no range of the patch's faces 1 to " +
                                      std::to_string(patch->faces.size()));
      }
      for (std::uint64_t k = *first; k <= *last; ++k) wanted[index_of(patch->faces[k - 1])] = true;
    }
  }
  return [wanted = std::move(wanted)](FaceId id) { return wanted[index_of(id)]; };
}

IsWanted wanted_by(const Scene& scene, std::string_view selector) {
  // A patch may have a name that looks like a selector.
  const bool is_patch = has_patch(scene, selector);
  if (!is_patch && selector.starts_with("box:")) return in_box(scene, selector);
  if (!is_patch && selector.starts_with("normal:")) return by_normal(scene, selector);
  if (!is_patch && selector.starts_with("plane:")) return in_plane(scene, selector);
  return by_name(scene, selector);
}

std::vector<FaceId> found_by(const Scene& scene, const std::string& selector) {
  constexpr std::string_view kAnd = " & ";
  std::vector<IsWanted> tests;
  for (std::string_view rest = selector;;) {
    const std::size_t end = rest.find(kAnd);
    tests.push_back(wanted_by(scene, text::trimmed(rest.substr(0, end))));
    if (end == std::string_view::npos) break;
    rest.remove_prefix(end + kAnd.size());
  }
  std::vector<FaceId> found;
  for (std::size_t f = 0; f < scene.faces().size(); ++f) {
    const auto id = static_cast<FaceId>(f);
    const bool is_found = scene.faces()[f].piece_count > 0 &&
                          std::ranges::all_of(tests, [&](const IsWanted& is_wanted) { return is_wanted(id); });
    if (is_found) found.push_back(id);
  }
  if (!found.empty()) return found;
  text::refuse("the selector " + in_quotes(selector, text::kShownName) + " finds no face with area",
               "a name stands for at least one", "`exactff info` lists patches with their centres and extents");
}

// Words that stand for other things where patches are named.
void require_free_name(const std::string& name) {
  static constexpr std::array kTaken{"", "all", "auto", "sky", "(back)", "(open)", "(buried)"};
  if (std::ranges::find(kTaken, name) == kTaken.end()) return;
  text::refuse("patches cannot be called " + text::in_quotes(name), "the word stands for something else in other flags",
               "give another name");
}

// Where a name is that of a patch, some of whose faces stay.
std::vector<Problem> warnings_of_mergers(const Scene& scene, std::span<const FaceName> names,
                                         const std::vector<std::size_t>& patch_of_face) {
  std::vector<Problem> warnings;
  for (std::size_t p = 0; p < scene.patches().size(); ++p) {
    const std::string& name = scene.patches()[p].name;
    if (std::ranges::find(names, name, &FaceName::name) == names.end()) continue;
    std::size_t stay = 0, join = 0;
    for (std::size_t f = 0; f < patch_of_face.size(); ++f) {
      if (patch_of_face[f] == p) ++(index_of(scene.faces()[f].patch) == p ? stay : join);
    }
    if (stay == 0 || join == 0) continue;
    warnings.push_back({.what = "the name " + in_quotes(name, text::kShownName) + " is that of a patch of " +
                                text::counted(stay, "face") + ", and " + text::counted(join, "face") +
                                (join == 1 ? " was added to it" : " were added to it"),
                        .why = "faces of one name are one patch",
                        .suggestion = "give another name if that is not meant"});
  }
  return warnings;
}

}  // namespace

FaceName face_name(std::string_view text) {
  const std::size_t equals = text.find('=');
  FaceName name{std::string(text::trimmed(text.substr(0, equals))), {}};
  if (equals != std::string_view::npos) name.selector = text::trimmed(text.substr(equals + 1));
  if (!name.name.empty() && !name.selector.empty()) return name;
  text::refuse(in_quotes(text, text::kShownName) + " is not NAME=SELECTOR",
               "the name and the faces that get it are needed", "write, for example, 'left fin=box:0,0,0,1,20,30'");
}

Scene with_names(const Scene& scene, std::span<const FaceName> names) {
  const kernel::StandardArithmetic arithmetic;
  std::vector<std::string> all;
  std::map<std::string, std::size_t> index;
  const auto patch_named = [&](const std::string& name) {
    const auto [place, is_new] = index.try_emplace(name, all.size());
    if (is_new) all.push_back(name);
    return place->second;
  };
  for (const Patch& patch : scene.patches()) (void)patch_named(patch.name);
  std::vector<std::size_t> patch_of_face;
  for (const Face& face : scene.faces()) patch_of_face.push_back(index_of(face.patch));
  for (const FaceName& one : names) {
    require_free_name(one.name);
    const std::size_t patch = patch_named(one.name);
    for (const FaceId face : found_by(scene, one.selector)) patch_of_face[index_of(face)] = patch;
  }
  return regrouped(scene, all, patch_of_face, warnings_of_mergers(scene, names, patch_of_face));
}

}  // namespace exactff
