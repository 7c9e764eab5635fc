#include "studies/cases/measures.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace fingertip::studies::inline cases {

namespace {

double spacing_of(const RunResult& result) {
  return result.setup.lattice.spacing;
}

/// Largest range, over the depths, of the errors of several presses.
double spread_of(const Members& series) {
  double widest = 0.0;
  for (std::size_t d = 0; d < series.front()->forces.error.size(); ++d) {
    std::vector<double> errors;
    for (const RunResult* press : series) {
      const std::vector<double>& error = press->forces.error;
      errors.push_back(d < error.size() ? error[d] : meshes::unknown);
    }
    if (std::isnan(largest(errors))) return meshes::unknown;
    const auto [least, most] = std::ranges::minmax(errors);
    widest = std::max(widest, most - least);
  }
  return widest;
}

double slope_of(const Members& series) {
  std::vector<double> x, y;
  for (const RunResult* press : series) {
    const double error = largest(press->forces.error);
    if (!(error > 0.0)) continue;
    const double spacing = std::log(spacing_of(*press));
    const bool seen =
        std::ranges::any_of(x, [&](double other) { return std::abs(other - spacing) < 1e-6; });
    if (seen) return meshes::unknown;  // something else than the spacing varies
    x.push_back(spacing);
    y.push_back(std::log(error));
  }
  if (x.size() < 3) return meshes::unknown;
  double mean_x = 0.0, mean_y = 0.0, above = 0.0, below = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    mean_x += x[i] / double(x.size());
    mean_y += y[i] / double(x.size());
  }
  for (std::size_t i = 0; i < x.size(); ++i) {
    above += (x[i] - mean_x) * (y[i] - mean_y);
    below += (x[i] - mean_x) * (x[i] - mean_x);
  }
  return above / below;
}

/// Errors at x = 0 of the polynomial through those at `x`, all different, by Lagrange.
double continued_to_zero(const std::vector<double>& x, const std::vector<double>& error) {
  double sum = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    double weight = 1.0;
    for (std::size_t j = 0; j < x.size(); ++j)
      if (j != i) weight *= x[j] / (x[j] - x[i]);
    sum += weight * error[i];
  }
  return sum;
}

}  // namespace

Members members(const RunResults& results, std::string_view kind) {
  Members found;
  for (const RunResult& result : results)
    if (result.run->is(kind)) found.push_back(&result);
  return found;
}

Members members(const RunResults& results, std::string_view kind, const std::string& series) {
  Members found = members(results, kind);
  std::erase_if(found, [&](const RunResult* result) { return result->run->series != series; });
  return found;
}

std::vector<std::string> series_names(const RunResults& results, std::string_view kind) {
  std::vector<std::string> names;
  for (const RunResult* result : members(results, kind)) {
    const std::string& series = result->run->series;
    const bool known = std::ranges::find(names, series) != names.end();
    if (!known && !series.empty()) names.push_back(series);
  }
  return names;
}

SeriesMeasures measure_series(const Members& series) {
  SeriesMeasures measures{0.0, meshes::unknown, spread_of(series), slope_of(series)};
  double finest = std::numeric_limits<double>::infinity();
  for (const RunResult* press : series) {
    const double worst = largest(press->forces.error);
    measures.worst_error = larger(measures.worst_error, worst);
    if (spacing_of(*press) > finest) continue;
    finest = spacing_of(*press);
    measures.finest_error = worst;
  }
  return measures;
}

std::vector<Displaced> displaced(const Members& variants) {
  std::vector<Displaced> presses, continua;
  for (const RunResult* result : variants) {
    const DisplacementComparison& found = result->displacements;
    if (found.empty()) continue;
    presses.push_back(
        {full_name(*result->run), result->folder, found.measured.get(), &found.press});
    const bool finite = result->setup.lattice.kinematics == lattice::Kinematics::finite;
    if (std::ranges::find(continua, result->against, &Displaced::folder) == continua.end())
      continua.push_back({finite ? "continuum, finite strain" : "continuum, small strain",
                          result->against, found.measured.get(), &found.reference});
  }
  std::ranges::move(presses, std::back_inserter(continua));
  return continua;
}

double limit_error(const Members& series) {
  double weakest_held = meshes::unknown, strongest_lost = meshes::unknown;
  for (const RunResult* grasp : series) {
    const Measures& measures = grasp->measures;
    if (!measures.contains("surplus")) return meshes::unknown;
    const double surplus = measures.at("surplus");
    if (measures.at("held") > 0.0)
      weakest_held = std::fmin(weakest_held, surplus);
    else
      strongest_lost = std::fmax(strongest_lost, surplus);
  }
  if (!(weakest_held > strongest_lost)) return meshes::unknown;
  return std::max(std::abs(weakest_held), std::abs(strongest_lost));
}

double end_ratio_span(const Members& series) {
  std::vector<double> ratios;
  for (const RunResult* fit : series) {
    const auto found = fit->measures.find("end_ratio");
    ratios.push_back(found == fit->measures.end() ? meshes::unknown : found->second);
  }
  if (ratios.empty() || std::isnan(largest(ratios))) return meshes::unknown;
  const auto [least, most] = std::ranges::minmax(ratios);
  return most / least;
}

Members soft_variants(const RunResults& results, const std::string& series) {
  Members found = members(results, "variant", series);
  std::erase_if(found, [](const RunResult* result) { return !(result->run->x >= 1.0); });
  std::ranges::sort(found, {}, [](const RunResult* result) { return result->run->x; });
  const bool whole = !found.empty() && found.front()->run->x == 1.0;
  return whole ? found : Members();
}

Budget take_budget(const CaseBudget& budget, const RunResults& results) {
  Budget taken;
  const ForceComparison& whole = soft_variants(results, budget.parts.front()).front()->forces;
  taken.depth = whole.depth;
  taken.total = taken.rest = whole.error;
  for (const std::string& part : budget.parts) {
    std::vector<double> share;
    for (std::size_t d = 0; d < taken.depth.size(); ++d) {
      std::vector<double> x, error;
      for (const RunResult* press : soft_variants(results, part)) {
        const std::vector<double>& errors = press->forces.error;
        x.push_back(press->run->x);
        error.push_back(d < errors.size() ? errors[d] : meshes::unknown);
      }
      share.push_back(error.front() - continued_to_zero(x, error));
      taken.rest[d] -= share.back();
    }
    taken.parts.push_back(std::move(share));
  }
  return taken;
}

}  // namespace fingertip::studies::inline cases
