#include "support/oracle_check.h"

#include <algorithm>
#include <bit>
#include <cstdint>

#include "exactff/exact.h"
#include "support/decimal.h"

namespace exactff::validation {

using generate::PlainScene;
using generate::to_text;

namespace {

using Fractions = std::vector<std::pair<std::vector<FaceId>, mpq_class>>;

Fractions fractions(const FormFactor& result) {
  Fractions out;
  for (const PlaneRecord& plane : result.planes) {
    std::vector<FaceId> faces = plane.faces;
    std::ranges::sort(faces);
    faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
    out.emplace_back(faces, mpq_class(plane.exact_fraction.value()));
  }
  std::ranges::sort(out);
  return out;
}

Fractions fractions(const OracleResult& truth) {
  Fractions out;
  for (const OraclePlane& plane : truth.planes) out.emplace_back(plane.faces, plane.visible_fraction);
  std::ranges::sort(out);
  return out;
}

VisiblePart visible_part(const OracleResult& truth) {
  const auto all_are = [&](int part) {
    return std::ranges::all_of(truth.planes, [part](const OraclePlane& p) { return p.visible_fraction == part; });
  };
  return all_are(0) ? VisiblePart::kNothing : all_are(1) ? VisiblePart::kAll : VisiblePart::kSome;
}

bool same_bits(double a, double b) { return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b); }

// The solver's ball as it prints it.
bool overlap(const FormFactor& result, const OracleResult& truth) {
  const mpq_class middle = read_decimal(result.enclosure.midpoint()).value;
  const mpq_class radius = read_decimal(result.enclosure.radius()).value;
  return middle - radius <= truth.high && truth.low <= middle + radius;
}

bool encloses_its_value(const FormFactor& result) {
  return result.lower <= result.value && result.value <= result.upper &&
         (result.status == Status::kZero || result.enclosure.nearest() == result.value);
}

std::string instead(const std::string& what, double got, double wanted) {
  return what + ' ' + to_text(got) + " instead of " + to_text(wanted);
}

std::string disagreement(const FormFactor& result, const OracleResult& truth) {
  if (!same_bits(result.value, truth.value)) return instead("value", result.value, truth.value);
  if ((result.status == Status::kZero) != truth.zero) return "zero flag: " + std::string(to_string(result.status));
  if (fractions(result) != fractions(truth)) return "visible fractions differ";
  if (!same_bits(result.visible_fraction.value(), truth.visible_fraction)) {
    return instead("visible fraction", *result.visible_fraction, truth.visible_fraction);
  }
  if (result.visible_part != visible_part(truth)) {
    return "visible part: " + std::string(to_string(result.visible_part.value()));
  }
  if (!overlap(result, truth)) return "enclosures apart: " + result.enclosure.midpoint();
  if (!encloses_its_value(result)) return "the value is not what its enclosure rounds to";
  return {};
}

}  // namespace

Receiver receiver_in(const Scene& scene, const PlainScene& plain) {
  Receiver receiver = generate::receiver_of(plain);
  const auto on = std::ranges::find(scene.patches(), "on", &Patch::name);
  if (on != scene.patches().end()) receiver.on = {on->faces.front()};
  return receiver;
}

OracleResult ask_oracle(const PlainScene& plain) {
  const Scene scene = generate::build(plain);
  return oracle(scene, receiver_in(scene, plain), scene.select(plain.source));
}

// The oracle knows no solids, so it does not judge scenes in which something is buried (property/contacts_test.cpp
// does); there, the engines must agree.
std::string disagreement(const Scene& scene, const Receiver& receiver, const Selection& selection) {
  const ExactSource source(scene, selection);
  if (some_is_buried(scene)) {
    (void)exact_form_factor(scene, receiver, source, {.engine = Engine::kBoth, .exact_fraction = true});
    return {};
  }
  const OracleResult truth = oracle(scene, receiver, selection);
  for (const Engine engine : {Engine::kEdges, Engine::kBoolean}) {
    const FormFactor result = exact_form_factor(scene, receiver, source, {.engine = engine, .exact_fraction = true});
    const std::string wrong = disagreement(result, truth);
    if (!wrong.empty()) return std::string(to_string(engine)) + ": " + wrong;
  }
  return {};
}

std::string disagreement(const PlainScene& plain) {
  try {
    const Scene scene = generate::build(plain);
    return disagreement(scene, receiver_in(scene, plain), scene.select(plain.source));
  } catch (const std::exception& error) {
    return std::string("threw ") + error.what();
  }
}

}  // namespace exactff::validation
