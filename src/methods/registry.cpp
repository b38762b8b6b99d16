#include <algorithm>
#include <deque>
#include <mutex>
#include <stdexcept>

#include "methods/method_files.h"
#include "scene/nearest_names.h"

namespace exactff::methods {

namespace {

bool is_name(std::string_view name) {
  const auto allowed_in_name = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-';
  };
  return !name.empty() && std::all_of(name.begin(), name.end(), allowed_in_name);
}

class Registry {
 public:
  static Registry& get() {
    static Registry registry;
    return registry;
  }

  const Method& add(Method method) {
    if (!is_name(method.name)) throw std::logic_error("'" + method.name + "' is no name for a method");
    if (!method.prepare) throw std::logic_error("method '" + method.name + "' cannot be prepared");
    const std::scoped_lock lock(mutex_);
    if (find(method.name) != nullptr) throw std::logic_error("there is a method '" + method.name + "' already");
    return methods_.emplace_back(std::move(method));
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
#define EXACTFF_METHOD(name) methods_.push_back(name##_method());
#include "methods/list.h"
#undef EXACTFF_METHOD
  }

  const Method* find(std::string_view name) const {
    const auto found = std::find_if(methods_.begin(), methods_.end(), [&](const Method& m) { return m.name == name; });
    return found == methods_.end() ? nullptr : &*found;
  }

  std::mutex mutex_;
  std::deque<Method> methods_;  // whose elements stay where they are
};

// Without the blanks at both ends.
std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kBlanks = " \t\r\n";
  const std::size_t first = text.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
}

// The part before `mark`, which is taken off `rest` with it; the whole rest where there is none.
std::string_view take_until(std::string_view& rest, char mark) {
  const std::size_t end = std::min(rest.find(mark), rest.size());
  const std::string_view part = rest.substr(0, end);
  rest.remove_prefix(std::min(end + 1, rest.size()));
  return trimmed(part);
}

// Takes up one SETTING=VALUE.
void read_assignment(std::string_view text, Settings& settings, std::vector<std::string>& seen) {
  std::string_view value = text;
  const std::string name(take_until(value, '='));
  if (text.find('=') == std::string_view::npos) {
    throw InputError(Problem{{}, 0, "'" + std::string(text) + "' gives no value", "settings read NAME=VALUE", {}});
  }
  if (std::find(seen.begin(), seen.end(), name) != seen.end()) {
    throw InputError(Problem{{}, 0, "setting '" + name + "' is given twice", "it has one value", "leave one out"});
  }
  seen.push_back(name);
  settings.set_text(name, trimmed(value));
}

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
  std::string suggestion;
  for (const std::string_view near : nearest_names(names, name, 3)) {
    suggestion += (suggestion.empty() ? "did you mean " : ", ") + std::string(near);
  }
  std::string list;
  for (const std::string_view known : names) list += (list.empty() ? "" : ", ") + std::string(known);
  throw InputError(
      Problem{{}, 0, "there is no method '" + std::string(name) + "'", "methods are " + list, suggestion + "?"});
}

const Method& add_method(Method method) { return Registry::get().add(std::move(method)); }

std::string Choice::text() const {
  const std::string values = settings.text();
  return values.empty() ? method->name : method->name + ":" + values;
}

std::string Choice::short_text() const {
  const std::string values = settings.short_text();
  return values.empty() ? method->name : method->name + ":" + values;
}

Choice parse(std::string_view text) {
  std::string_view rest = text;
  const Method& method = method_named(take_until(rest, ':'));
  Choice choice{&method, method.defaults()};
  std::vector<Problem> problems;
  std::vector<std::string> seen;
  while (!trimmed(rest).empty()) {
    try {
      read_assignment(take_until(rest, ','), choice.settings, seen);
    } catch (const InputError& error) {
      for (Problem problem : error.problems()) {
        problem.what = "method '" + method.name + "': " + problem.what;
        problems.push_back(std::move(problem));
      }
    }
  }
  if (!problems.empty()) throw InputError(std::move(problems));
  if (method.check) method.check(choice.settings);
  return choice;
}

std::string description(const Method& method) {
  std::string text = method.name + ": " + method.summary + "\n";
  if (!method.source.empty()) text += "  " + method.source + "\n";
  for (const SettingSpec& spec : method.settings) {
    text += "  " + spec.name + "=" + to_string(spec.fallback) + (spec.unit.empty() ? "" : " " + spec.unit) + ": " +
            spec.meaning + "; " + allowed(spec) + "\n";
  }
  return text;
}

}  // namespace exactff::methods
