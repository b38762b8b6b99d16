// A study as arrays for ParaView.
#include "vtk/vtk.h"

#include "report/plan.h"
#include "report/tables.h"
#include "text/phrases.h"

namespace exactff::report {
namespace {

using study::ExactRow;
using study::ExactTerm;

std::vector<vtk::SourceValues> exact_values(const Study& study) {
  const Scene& scene = *study.request.scene;
  std::vector<vtk::SourceValues> list;
  for (std::size_t s = 0; s < study.request.sources.size(); ++s) {
    const Rgb b = scene.source_radiosity(study.request.sources[s]);
    vtk::SourceValues& values = list.emplace_back();
    values.source = scene.name_of(study.request.sources[s]);
    for (std::size_t i = 0; i < study.exact.size(); ++i) {
      const ExactTerm& term = study.exact[i].terms[s];
      const Rgb rho = scene.receiver_reflectance(study.request.receivers[i].on);
      values.exact.push_back(term.value);
      values.lower.push_back(term.lower);
      values.upper.push_back(term.upper);
      values.status.push_back(static_cast<std::uint8_t>(term.status));
      values.visible_fraction.push_back(term.visible_fraction);
      values.radiosity.push_back({rho.r * b.r * term.value, rho.g * b.g * term.value, rho.b * b.b * term.value});
    }
  }
  return list;
}

// In the words of the method `adaptive`; "sweep" keeps the name apart from the same setting of that method.
std::string setting_words(const AdaptiveOptions& setting) {
  return "sweep:eps_B=" + text::shortest(setting.eps_b) + ",eps_A=" + text::shortest(setting.eps_a) +
         ",rays=" + std::to_string(setting.rays) + ",pattern=" + std::string(to_string(setting.pattern)) +
         ",variant=" + std::string(to_string(setting.variant)) + ",seed=" + std::to_string(setting.seed);
}

void add_setting(std::vector<vtk::Field>& fields, const std::string& name, std::vector<double> values,
                 const Study& study) {
  std::vector<double> errors;
  for (std::size_t i = 0; i < values.size(); ++i) errors.push_back(values[i] - study.exact[i].form_factor);
  fields.push_back({"value " + name, 1, std::move(values)});
  fields.push_back({"error " + name, 1, std::move(errors)});
}

std::vector<vtk::Field> fields_of(const Study& study) {
  std::vector<vtk::Field> fields = vtk::fields_of(exact_values(study));
  if (study.request.sources.size() > 1) {
    std::vector<double> sums;
    for (const ExactRow& row : study.exact) sums.push_back(row.form_factor);
    fields.insert(fields.begin(), {"exact", 1, std::move(sums)});
  }
  for (const study::MethodField& field : study.methods.fields) {
    add_setting(fields, study.methods.ladders[field.ladder].rungs[field.rung].text(), field.form_factors, study);
  }
  for (std::size_t k = 0; k < study.settings.size(); ++k) {
    std::vector<double> values;
    for (const study::SampleRow& row : study.samples[k]) values.push_back(row.form_factor);
    add_setting(fields, setting_words(study.settings[k]), std::move(values), study);
  }
  return fields;
}

}  // namespace

void write_vtk(const Study& study, const std::filesystem::path& file, const Hooks& hooks) {
  const study::Request& request = study.request;
  std::vector<std::string> about = {text::program_version() + " compare",
                                    "scene: " + request.scene_name + ", hash " + request.scene->hash(),
                                    "receivers: " + request.receivers_name, "sources: " + source_names(study)};
  vtk::write({request.scene, request.receivers, fields_of(study), std::move(about)}, file, hooks);
}

}  // namespace exactff::report
