// The exact method, as one of the methods: correctly rounded values.
#include "exactff/exact.h"

#include "methods/method_files.h"

namespace exactff::methods {

namespace {

Engine engine_named(std::string_view name) {
  return name == "edges" ? Engine::kEdges : name == "boolean" ? Engine::kBoolean : Engine::kBoth;
}

// Nothing is prepared for the whole scene.
struct Nothing {
  explicit Nothing(const Scene& /*scene*/) {}
};

struct ExactSourcePrepared : PreparedSource {
  ExactSourcePrepared(const Nothing& /*data*/, const Scene& scene, const Selection& chosen)
      : PreparedSource(chosen), source(scene, chosen) {}
  ExactSource source;
};

class Exact : public Evaluator {
 public:
  Exact(const Nothing& /*data*/, const Scene& scene, const Settings& settings)
      : scene_(scene), options_{.engine = engine_named(settings.word("engine")), .from_scratch = true} {}

  void look_from(const Receiver& receiver) override { receiver_ = receiver; }

  using Evaluator::form_factor;
  Estimate form_factor(const PreparedSource& source) override {
    const auto& prepared = own<ExactSourcePrepared>(source);
    exact_form_factor(scene_, receiver_, prepared.source, options_, found_, workspace_);
    Estimate result;
    result.form_factor = found_.value;
    std::uint64_t occluders = 0, edges = 0;
    for (const PlaneRecord& plane : found_.planes) {
      occluders += plane.candidates;
      edges += plane.edges;
    }
    result.counters.add("occluders", occluders);
    result.counters.add("edges", edges);
    result.counters.add("bits", static_cast<std::uint64_t>(found_.precision_bits));
    result.counters.add("not certified", found_.status == Status::kNotCertified ? 1 : 0);
    return result;
  }

 private:
  const Scene& scene_;
  ExactOptions options_;
  Receiver receiver_;
  FormFactor found_;  // its memory is reused
  Workspace workspace_;
};

// All engines give the same bits.
bool exact_uses(const Settings&, std::string_view setting) { return setting != "engine"; }

}  // namespace

Method exact_method() {
  return {
      .name = "exact",
      .summary = "the exact visible region and Tampieri's Eq. (4) over its boundary, proved to be correctly rounded",
      .source = "",
      .settings = {word_setting("engine", {"edges", "boolean", "both"},
                                "how the visible region is found; it does not affect the values")},
      .prepare = prepare_as<OnScene<Nothing, ExactSourcePrepared, Exact>>,
      .uses = exact_uses};
}

}  // namespace exactff::methods
