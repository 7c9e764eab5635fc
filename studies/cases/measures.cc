#include "studies/cases/measures.h"

#include <algorithm>
#include <cmath>

namespace fingertip::studies {

namespace {

using nlohmann::ordered_json;

/// The largest magnitude in a list of numbers; NaN when the list is empty or has a gap.
double largest(const ordered_json& list) {
  double worst = list.empty() ? std::nan("") : 0.0;
  for (const ordered_json& value : list) {
    const double size = value.is_number() ? std::abs(value.get<double>()) : std::nan("");
    if (std::isnan(size)) return size;
    worst = std::max(worst, size);
  }
  return worst;
}

double number(const ordered_json& object, const char* key) {
  return object.contains(key) && object[key].is_number() ? object[key].get<double>() : std::nan("");
}

const std::vector<std::string>& model_measures() {
  static const std::vector<std::string> names = {
      "youngs_modulus_error", "shear_modulus_error", "poissons_ratio_error", "bulk_modulus_error",
      "max_force_error",      "l2_force_error",      "speed_deviation",      "tilt_deg",
      "momentum_defect"};
  return names;
}

}  // namespace

const std::vector<std::string>& validated_models() {
  static const std::vector<std::string> models = {"published", "central", "hookean"};
  return models;
}

std::vector<std::string> measure_names() {
  std::vector<std::string> names = {"reference.force_error", "verification.failed_checks",
                                    "cubes.hookean_error", "equilibrium.hookean_force_error"};
  for (const std::string& model : validated_models()) {
    for (const std::string& measure : model_measures()) names.push_back(model + "." + measure);
  }
  return names;
}

std::map<std::string, double> take_measures(const ordered_json& summary,
                                            const std::map<std::string, ordered_json>& press,
                                            double cubes) {
  std::map<std::string, double> taken;
  taken["cubes.hookean_error"] = cubes;
  taken["reference.force_error"] = largest(summary["reference"]["relative_force_error"]);
  if (summary.contains("verification"))
    taken["verification.failed_checks"] = number(summary["verification"], "failed_checks");
  if (summary.contains("equilibrium"))
    taken["equilibrium.hookean_force_error"] =
        largest(summary["equilibrium"]["hookean_force_error"]);
  const ordered_json& target = summary["target"];
  const double youngs = number(target, "youngs_modulus");
  const auto relative = [](double value, double wanted) { return std::abs(value / wanted - 1.0); };
  for (const std::string& model : validated_models()) {
    const ordered_json& entry = summary["models"][model];
    const std::string prefix = model + ".";
    taken[prefix + "youngs_modulus_error"] =
        largest({relative(number(entry, "E_100"), youngs), relative(number(entry, "E_110"), youngs),
                 relative(number(entry, "E_111"), youngs)});
    taken[prefix + "shear_modulus_error"] =
        relative(number(entry, "G"), number(target, "shear_modulus"));
    taken[prefix + "poissons_ratio_error"] =
        std::abs(number(entry, "nu_100") - number(target, "poissons_ratio"));
    taken[prefix + "bulk_modulus_error"] =
        relative(number(entry, "K"), number(target, "bulk_modulus"));
    taken[prefix + "max_force_error"] = largest(entry["force_error"]);
    taken[prefix + "l2_force_error"] = number(entry, "relative_l2_force_error");
    const ordered_json& measured = press.at(model);
    taken[prefix + "momentum_defect"] = number(measured, "momentum_defect");
    if (measured.contains("tracking")) {
      taken[prefix + "speed_deviation"] = number(measured["tracking"], "speed_deviation");
      taken[prefix + "tilt_deg"] = number(measured["tracking"], "tilt_deg");
    }
  }
  std::erase_if(taken, [](const auto& entry) { return std::isnan(entry.second); });
  return taken;
}

}  // namespace fingertip::studies
