#include "studies/fits/setup/fit_parameters.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>

#include "calibration/press_fit/lattice_forward_model.h"
#include "meshes/base/files.h"
#include "studies/fits/models/fit_relaxation.h"
#include "studies/fits/setup/fit_curves.h"

namespace fingertip::studies::inline fits::inline setup {

using calibration::FreeParameter;
using calibration::MaterialParameter;
using lattice::ModelKind;

namespace {

/// Ties are known less well than constants by so much.
constexpr double ties_prior = 10.0;

/// Poisson's ratios scanned for starts: denser where rubbers are.
constexpr double scanned_ratios[] = {0.1, 0.3, 0.42, 0.48};

std::string words_of(const std::vector<MaterialParameter>& parameters) {
  std::string text;
  for (const MaterialParameter parameter : parameters)
    text += (text.empty() ? "" : ", ") + std::string(calibration::name(parameter));
  return text;
}

using enum MaterialParameter;

/// What may be free in a problem, the usual ones first.
std::vector<MaterialParameter> known_parameters(const CalibrationSettings& settings) {
  switch (settings.problem) {
    case CalibrationProblem::damping: return {retardation_time};
    default:
      return {youngs_modulus, shear_modulus, modulus, k1,   k2,     k3,
              kappa,          lame_shear,    lambda,  bond, contact};
  }
}

std::vector<MaterialParameter> usual_parameters(const CalibrationSettings& settings,
                                                ModelKind model) {
  switch (settings.problem) {
    case CalibrationProblem::damping: return {retardation_time};
    case CalibrationProblem::curve:
      if (model == ModelKind::network) return {lame_shear, lambda, bond, contact};
      // Forces see k1, k2, k3 through two combinations alone: k3 stays what the moduli made it.
      if (model == ModelKind::central) return {k1, k2, bond, contact};
      return {k1, k2, kappa, bond, contact};
    default: return {youngs_modulus, shear_modulus};
  }
}

/// E or G alone is meant at the rubber's Poisson's ratio: were the other modulus held, a rubber
/// twice as stiff would have another ratio, soon one that no rubber has.
void hold_the_ratio(std::vector<MaterialParameter>& chosen) {
  if (std::ranges::count_if(chosen, calibration::is_modulus) == 1)
    std::ranges::replace_if(chosen, calibration::is_modulus, modulus);
}

std::vector<MaterialParameter> free_parameters(const LoadedConfig& loaded) {
  const CalibrationSettings& settings = loaded.config.calibration;
  if (settings.parameters.empty())
    return usual_parameters(settings, loaded.config.press.lattice.model);
  std::vector<MaterialParameter> known = known_parameters(settings);
  if (knows_relaxation(settings))
    known.insert(known.end(), calibration::relaxation_parameters.begin(),
                 calibration::relaxation_parameters.end());
  std::vector<MaterialParameter> chosen;
  for (const std::string& word : settings.parameters) {
    if (word == relaxation_word && knows_relaxation(settings)) {
      std::ranges::copy(relaxation_sought(loaded), std::back_inserter(chosen));
      continue;
    }
    const auto found = std::ranges::find_if(
        known, [&](MaterialParameter each) { return calibration::name(each) == word; });
    if (found == known.end())
      throw refused(loaded, "calibration.parameters", word,
                    "the problem " + std::string(name(settings.problem)) + " can free " +
                        words_of(known) +
                        (knows_relaxation(settings) ? "; relaxation: all of its branches" : ""),
                    "name some of them, or none for the usual ones");
    chosen.push_back(*found);
  }
  hold_the_ratio(chosen);
  std::ranges::stable_partition(chosen, std::not_fn(calibration::is_of_the_relaxation));
  if (!chosen.empty() && calibration::is_of_the_relaxation(chosen.front()))
    chosen.insert(chosen.begin(), modulus);
  return chosen;
}

double scale_of(MaterialParameter parameter, const lattice::PressSetup& base) {
  const double g = base.rubber.shear_modulus;
  switch (parameter) {
    case k1:
    case k2:
    case k3: return base.lattice.spacing * g;
    case kappa:
    case lambda: return std::max(std::abs(calibration::value_of(parameter, base)), g);
    default: return 0.0;  // its start
  }
}

}  // namespace

std::vector<FreeParameter> free_list(const LoadedConfig& loaded, const lattice::PressSetup& base) {
  const CalibrationSettings& settings = loaded.config.calibration;
  // A measurement speaks for itself unless its owner says what is known besides.
  const bool with_priors = settings.prior > 0.0 && (settings.problem == CalibrationProblem::curve ||
                                                    loaded.entries.at("calibration.prior").given);
  std::vector<FreeParameter> list;
  for (const MaterialParameter parameter : free_parameters(loaded)) {
    FreeParameter free;
    free.parameter = parameter;
    if (calibration::is_of_the_relaxation(parameter)) {
      free.start = 1.0;  // until the curves are there, start_branches
      list.push_back(free);
      continue;
    }
    free.start = calibration::value_of(parameter, base);
    free.scale = scale_of(parameter, base);
    const double size = free.scale > 0.0 ? free.scale : std::abs(free.start);
    const double weight = parameter == bond || parameter == contact ? ties_prior : 1.0;
    // The energy of law A falls without bound for lambda < 0.
    if (parameter == lambda && base.lattice.kinematics == lattice::Kinematics::finite)
      free.lower = 0.0;
    if (with_priors) free.prior = calibration::Prior{free.start, weight * settings.prior * size};
    if (parameter == retardation_time) free.start = 0.7 * std::max(free.start, 1e-4);
    list.push_back(free);
  }
  return list;
}

std::optional<std::string> held_ratio_note(const LoadedConfig& loaded, const FitInput& input) {
  const std::vector<std::string>& asked = loaded.config.calibration.parameters;
  if (!frees(input, modulus) || std::ranges::find(asked, "modulus") != asked.end())
    return std::nullopt;
  for (const MaterialParameter one : {youngs_modulus, shear_modulus})
    if (std::ranges::find(asked, calibration::name(one)) != asked.end())
      return fmt::format(
          "calibration.parameters frees {} alone: Poisson's ratio is held at the rubber's, {:.4g}, "
          "and E, with it G, is fitted as modulus; to seek the ratio, too, name youngs_modulus and "
          "shear_modulus",
          calibration::name(one), input.base.rubber.poissons_ratio());
  return std::nullopt;
}

void bound_poissons_ratio(const LoadedConfig& loaded, FitInput& input) {
  const CalibrationSettings& wanted = loaded.config.calibration;
  calibration::CurveFitOptions& options = input.options;
  // Law A knows no nu < 0.
  if (input.base.lattice.kinematics == lattice::Kinematics::finite)
    options.lowest_poissons_ratio = 0.0;
  if (wanted.problem != CalibrationProblem::experiment) return;
  const std::vector<double>& range = wanted.poisson_range;
  const double lowest = options.lowest_poissons_ratio =
                   std::max(range[0], options.lowest_poissons_ratio),
               highest = options.highest_poissons_ratio = range[1];
  const meshes::Rubber& rubber = input.base.rubber;
  if (loaded.entries.at("calibration.poisson_range").given && frees(input, modulus) &&
      (rubber.poissons_ratio() < lowest || rubber.poissons_ratio() > highest))
    throw refused(loaded, "calibration.poisson_range", "",
                  "the rubber's Poisson's ratio, which is held, is " +
                      meshes::to_text(rubber.poissons_ratio()) + ", outside of the range",
                  "widen the range, or give another rubber");
}

std::vector<double> start_ratios(const FitInput& input) {
  std::vector<double> ratios;
  const calibration::CurveFitOptions& options = input.options;
  if (!input.scale_to_data || !frees(input, youngs_modulus) || !frees(input, shear_modulus))
    return ratios;
  for (const double ratio : scanned_ratios)
    if (ratio >= options.lowest_poissons_ratio && ratio <= options.highest_poissons_ratio)
      ratios.push_back(ratio);
  if (ratios.empty())
    ratios.push_back(0.5 * (options.lowest_poissons_ratio + options.highest_poissons_ratio));
  return ratios;
}

}  // namespace fingertip::studies::inline fits::inline setup
