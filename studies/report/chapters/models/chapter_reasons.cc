/// Why the models differ: words that only claim what the run's numbers show.
#include <cmath>

#include "studies/report/chapters/models/model_chapters.h"
#include "studies/report/page/words.h"

namespace fingertip::studies::report::inline chapters::inline models {
namespace {

std::string factor(double value) {
  return number(value, 3);
}

/// Modulus of compression along a cube axis without lateral motion, C11 = E (1 - nu) /
/// ((1 + nu)(1 - 2 nu)) with E and nu of that axis: what a thin bonded layer mostly feels.
double confined_modulus(double E, double nu) {
  return E * (1.0 - nu) / ((1.0 + nu) * (1.0 - 2.0 * nu));
}

double confined_ratio(const RunData& run, const ModelData& model) {
  return confined_modulus(model.moduli.E_100, model.moduli.nu_100) /
         confined_modulus(run.target.youngs_modulus, run.target.poissons_ratio);
}

TemplateData published_reason(const RunData& run, const ModelData& model) {
  const ModuliEntry& m = model.moduli;
  const double along = m.E_100 / run.target.youngs_modulus;
  const double across = m.E_111 / run.target.youngs_modulus;
  const double shear = m.G / run.target.shear_modulus, confined = confined_ratio(run, model);
  const double ratio = 1.0 + model.last_force_error();
  const bool below = ratio < std::fmin(along, confined);
  const bool above = !below && ratio > std::fmax(across, shear);
  TemplateData words;
  words["along"] = factor(along);
  words["across"] = factor(across);
  words["shear"] = factor(shear);
  words["confined"] = factor(confined);
  words["ratio"] = if_known(ratio, factor(ratio));
  words["below"] = below;
  words["above"] = above;
  words["between"] = !below && !above;
  return words;
}

TemplateData central_reason(const RunData& run, const ModelData& model) {
  const double bulk = model.moduli.K / run.target.bulk_modulus - 1.0;
  const double error = model.last_force_error();
  const bool quarter = std::abs(bulk) < 1e-3, soft = !quarter && bulk < 0.0 && error < 0.0;
  TemplateData words;
  words["young"] = percent(model.moduli.E_100 / run.target.youngs_modulus - 1.0);
  words["shear"] = percent(model.moduli.G / run.target.shear_modulus - 1.0);
  words["nu"] = number(model.moduli.nu_100, 3);
  words["target_nu"] = number(run.target.poissons_ratio, 3);
  words["bulk"] = percent(bulk);
  words["confined"] = percent_magnitude(confined_ratio(run, model));
  words["error"] = percent(error);
  words["quarter"] = std::isfinite(error) && quarter;
  words["soft"] = std::isfinite(error) && soft;
  words["other"] = std::isfinite(error) && !quarter && !soft;
  words["easy"] = bulk < 0.0;
  return words;
}

TemplateData hookean_reason(const RunData& run, const ModelData& model) {
  const ModuliEntry& m = model.moduli;
  const TargetEntry& t = run.target;
  const double worst = std::fmax(
      std::abs(m.E_100 / t.youngs_modulus - 1.0),
      std::fmax(std::abs(m.G / t.shear_modulus - 1.0), std::abs(m.K / t.bulk_modulus - 1.0)));
  const double spacing = model.summary.spacing;
  TemplateData words;
  words["worst"] = worst < 1e-6 ? "" : percent_magnitude(worst);
  words["spacing"] = if_known(spacing, with_unit(spacing, shown_units().length, 3));
  words["error"] = words["depth"] = "";
  if (!std::isfinite(model.last_force_error())) return words;
  std::size_t worst_depth = model.force_error.size() - 1;
  for (std::size_t i = 0; i < model.force_error.size(); ++i) {
    const double error = std::abs(model.force_error[i]);
    const double worst_so_far = std::abs(model.force_error[worst_depth]);
    if (std::isfinite(error) && !(error <= worst_so_far)) worst_depth = i;
  }
  words["error"] = percent(model.force_error[worst_depth]);
  words["depth"] = length(run.depths[worst_depth]);
  return words;
}

constexpr std::pair<const char*, TemplateData (*)(const RunData&, const ModelData&)>
    reasons_of_models[] = {
        {"published", published_reason}, {"central", central_reason}, {"hookean", hookean_reason}};

/// The speed at which the lattices were pressed; "" when none was.
std::string speed_of_presses(const RunData& run) {
  for (const ModelData& model : run.models)
    if (const auto* row = largest_in(model.trace, &lattice::TraceRow::commanded_speed))
      return with_unit(row->commanded_speed, shown_units().speed, 3);
  return "";
}

}  // namespace

Chapter reasons_chapter(const RunData& run) {
  if (std::isnan(run.target.bulk_modulus)) return {};
  WordList models;
  for (const ModelData& model : run.models) {
    if (std::isnan(model.moduli.E_100)) continue;
    TemplateData words;
    words["label"] = model_label(model.name);
    for (const auto& [name, reason] : reasons_of_models)
      words[name] = model.name == name ? WordList{reason(run, model)} : WordList();
    words["finite"] = model.summary.kinematics == "finite";
    models.push_back(std::move(words));
  }
  if (models.empty()) return {};
  ChapterData chapter("reasons");
  chapter["models"] = std::move(models);
  chapter["speed"] = speed_of_presses(run);
  return written(std::move(chapter));
}

}  // namespace fingertip::studies::report::inline chapters::inline models
