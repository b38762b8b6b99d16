#include "cli/known_words.h"

#include "exactff/methods.h"
#include "exactff/models.h"
#include "report/plan.h"
#include "stress/stress.h"

namespace exactff::cli {

std::vector<std::string> known_words(const std::string& kind) {
  std::vector<std::string> words;
  if (kind == "METHOD") {
    for (const methods::Method* method : methods::all_methods()) words.push_back(method->name);
  } else if (kind == "SCENE") {
    for (const models::Model* model : models::all_models()) words.push_back('@' + std::string(model->name));
  } else if (kind == "FAMILY") {
    for (const stress::FamilyInfo& family : stress::families()) words.emplace_back(family.name);
  } else if (kind == "EXPERIMENT") {
    words = report::experiment_names();
    words.emplace_back("all");
  }
  return words;
}

}  // namespace exactff::cli
