#include <algorithm>
#include <deque>
#include <mutex>
#include <stdexcept>

#include "exactff/exact.h"
#include "methods/adaptive.h"
#include "methods/method_files.h"
#include "text/settings.h"

namespace exactff::methods {
namespace {

bool is_name(std::string_view name) {
  const auto allowed_in_name = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-';
  };
  return !name.empty() && std::all_of(name.begin(), name.end(), allowed_in_name);
}

// What is buried (scene.h) neither sends nor receives, whatever the method.
class ExposedEvaluator : public Evaluator {
 public:
  ExposedEvaluator(const Scene& scene, std::unique_ptr<Evaluator> inner) : scene_(scene), inner_(std::move(inner)) {}

  void look_from(const Receiver& receiver) override {
    is_buried_ = buried_under(scene_, receiver).has_value();
    inner_->look_from(receiver);
  }
  [[nodiscard]] Estimate form_factor(const PreparedSource& source) override {
    return is_buried_ ? Estimate{} : inner_->form_factor(source);
  }
  void form_factors(std::span<const PreparedSource* const> sources, std::span<Estimate> estimates) override {
    if (!is_buried_) return inner_->form_factors(sources, estimates);
    std::ranges::fill(estimates, Estimate{});
  }

 private:
  const Scene& scene_;
  std::unique_ptr<Evaluator> inner_;
  bool is_buried_ = false;
};

class ExposedScene : public PreparedScene {
 public:
  ExposedScene(const Scene& scene, std::unique_ptr<PreparedScene> inner)
      : PreparedScene(scene), inner_(std::move(inner)) {}
  [[nodiscard]] std::unique_ptr<PreparedSource> prepare_source(const Selection& selection) const override {
    return inner_->prepare_source(selection);
  }
  [[nodiscard]] std::unique_ptr<Evaluator> configure(const Settings& settings) const override {
    std::unique_ptr<Evaluator> evaluator = inner_->configure(settings);
    if (dynamic_cast<const RecursionEvaluator*>(evaluator.get()) != nullptr) return evaluator;  // knows it itself
    return std::make_unique<ExposedEvaluator>(scene(), std::move(evaluator));
  }

 private:
  std::unique_ptr<PreparedScene> inner_;
};

Method with_buried_receivers(Method method) {
  method.prepare = [inner = std::move(method.prepare)](const Scene& scene) -> std::unique_ptr<PreparedScene> {
    if (!some_is_buried(scene)) return inner(scene);
    return std::make_unique<ExposedScene>(scene, inner(scene));
  };
  return method;
}

class Registry {
 public:
  static Registry& get() {
    static Registry registry;
    return registry;
  }

  const Method& add(Method method) {
    if (!is_name(method.name)) throw std::logic_error("'" + method.name + "' is not a valid name for a method");
    if (!method.prepare) throw std::logic_error("method '" + method.name + "' cannot be prepared");
    const std::scoped_lock lock(mutex_);
    if (find(method.name) != nullptr) throw std::logic_error("there is a method '" + method.name + "' already");
    return methods_.emplace_back(with_buried_receivers(std::move(method)));
  }

  std::vector<const Method*> all() {
    const std::scoped_lock lock(mutex_);
    std::vector<const Method*> list;
    for (const Method& method : methods_) list.push_back(&method);
    return list;
  }

  const Method* find_named(std::string_view name) {
    const std::scoped_lock lock(mutex_);
    return find(name);
  }

 private:
  Registry() {
    // In the order in which they are listed.
    for (const auto make : {exact_method, adaptive_method, adaptive_exact_visibility_method, hemicube_method,
                            nettle_method, wallace_method, area_sampling_method}) {
      methods_.push_back(with_buried_receivers(make()));
    }
  }

  const Method* find(std::string_view name) const {
    const auto found = std::find_if(methods_.begin(), methods_.end(), [&](const Method& m) { return m.name == name; });
    return found == methods_.end() ? nullptr : &*found;
  }

  std::mutex mutex_;
  std::deque<Method> methods_;  // a deque, so that elements are never moved
};

}  // namespace

bool Method::stochastic(const Settings& chosen) const { return chosen.has("seed") && (!uses || uses(chosen, "seed")); }

Settings Method::normalised(const Settings& chosen) const {
  Settings result = chosen;
  if (!uses) return result;
  for (const SettingSpec& spec : chosen.specs()) {
    if (!uses(chosen, spec.name)) result.set(spec.name, spec.fallback);
  }
  return result;
}

std::vector<const Method*> all_methods() { return Registry::get().all(); }

const Method& method_named(std::string_view name) {
  if (const Method* found = Registry::get().find_named(name)) return *found;
  std::vector<std::string_view> names;
  for (const Method* method : all_methods()) names.emplace_back(method->name);
  throw text::unknown_name("method", name, names);
}

const Method& add_method(Method method) { return Registry::get().add(std::move(method)); }

namespace {

std::string text_of(const Method* method, const std::string& values) {
  if (method == nullptr) throw std::logic_error("this choice names no method; parse() makes one that does");
  return values.empty() ? method->name : method->name + ":" + values;
}

}  // namespace

std::string Choice::text() const { return text_of(method, settings.text()); }
std::string Choice::short_text() const { return text_of(method, settings.short_text()); }

Choice parse(std::string_view text) {
  const kernel::StandardArithmetic arithmetic;
  const auto [name, assignments] = text::take_apart(text);
  const Method& method = method_named(name);
  Choice choice{&method, method.defaults()};
  text::read_assignments(assignments, "method '" + method.name + "'", choice.settings);
  if (method.check) method.check(choice.settings);
  return choice;
}

std::string description(const Method& method) {
  std::string text = method.name + ": " + method.summary + "\n";
  if (!method.source.empty()) text += "  " + method.source + "\n";
  return text + text::setting_lines(method.settings);
}

void Counters::add(std::string_view name, std::uint64_t count) {
  for (std::size_t i = 0; i < size_; ++i) {
    if (counters_[i].name != name) continue;
    counters_[i].count += count;
    return;
  }
  if (size_ == kMost) throw std::logic_error("too many counters");
  counters_[size_++] = {name, count};
}

std::uint64_t Counters::operator[](std::string_view name) const {
  const auto counters = list();
  const auto found = std::find_if(counters.begin(), counters.end(), [&](const Counter& c) { return c.name == name; });
  return found == counters.end() ? 0 : found->count;
}

void Evaluator::form_factors(std::span<const PreparedSource* const> sources, std::span<Estimate> estimates) {
  for (std::size_t i = 0; i < sources.size(); ++i) estimates[i] = form_factor(*sources[i]);
}

std::unique_ptr<PreparedSource> PreparedScene::prepare_source(const Selection& selection) const {
  return std::make_unique<PreparedSource>(selection);
}

// --- The exact method, as one of the methods: correctly rounded values ---

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
