#include "flags/vector.h"

#include "text/number_text.h"
#include "text/refuse.h"

namespace exactff::flags {
namespace {

// If numbers are missing, the flag that follows would be read as one of them.
std::string is_no_flag(const std::string& text) {
  return text.starts_with("--") ? "needs three numbers; found '" + text + "' among them" : "";
}

double finite_number(const std::string& text, const std::string& flag) {
  const text::ParsedNumber number = text::parse_number(text);
  if (number.fault == text::NumberFault::kNone) return number.value;
  text::refuse(flag + ": " + describe(number.fault, text), "a coordinate is a finite decimal number",
               "give three numbers, for example " + flag + " 0 0.5 -1e-3");
}

}  // namespace

CLI::Option* add_vector_option(CLI::App& app, const std::string& flag, ThreeNumbers& numbers,
                               const std::string& meaning, const std::string& type) {
  return app.add_option(flag, numbers, meaning)->type_name(type)->check(is_no_flag);
}

Vec3 vector_of(const ThreeNumbers& numbers, const std::string& flag) {
  return {finite_number(numbers[0], flag), finite_number(numbers[1], flag), finite_number(numbers[2], flag)};
}

}  // namespace exactff::flags
