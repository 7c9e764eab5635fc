#include "studies/cases/variant_measures.h"

#include <algorithm>
#include <cmath>

namespace fingertip::studies {

namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

/// The larger one; NaN when either is.
double larger(double a, double b) {
  return std::isnan(a) || std::isnan(b) ? unknown : std::max(a, b);
}

/// Largest range, over the depths, of the errors of several presses.
double spread_of(const std::vector<std::size_t>& places, const VariantResults& results) {
  double widest = 0.0;
  const std::size_t depths = results[places.front()].error.size();
  for (std::size_t d = 0; d < depths; ++d) {
    double least = unknown, most = unknown;
    for (const std::size_t place : places) {
      if (results[place].error.size() != depths) return unknown;
      const double error = results[place].error[d];
      if (std::isnan(error)) return unknown;
      least = std::fmin(least, error);
      most = std::fmax(most, error);
    }
    widest = std::max(widest, most - least);
  }
  return widest;
}

double slope_of(const std::vector<std::size_t>& places, const VariantResults& results) {
  std::vector<double> x, y;
  for (const std::size_t place : places) {
    const double error = results[place].worst();
    if (!(error > 0.0)) continue;
    const double spacing = std::log(results[place].spacing);
    const bool seen =
        std::ranges::any_of(x, [&](double other) { return std::abs(other - spacing) < 1e-6; });
    if (seen) return unknown;  // something else than the spacing varies
    x.push_back(spacing);
    y.push_back(std::log(error));
  }
  if (x.size() < 3) return unknown;
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

const std::vector<std::string>& measures_of_series() {
  static const std::vector<std::string> names = {"worst_error", "finest_error", "spread"};
  return names;
}

}  // namespace

double VariantResult::worst() const {
  double result = error.empty() ? unknown : 0.0;
  for (const double one : error) result = larger(result, std::abs(one));
  return result;
}

std::vector<std::string> series_names(const Case& one) {
  std::vector<std::string> names;
  for (const CaseVariant& variant : one.variants) {
    const bool known = std::ranges::find(names, variant.series) != names.end();
    if (!known && !variant.series.empty()) names.push_back(variant.series);
  }
  return names;
}

std::vector<std::size_t> variants_of(const Case& one, const std::string& series) {
  std::vector<std::size_t> places;
  for (std::size_t i = 0; i < one.variants.size(); ++i)
    if (one.variants[i].series == series) places.push_back(i);
  return places;
}

std::vector<std::size_t> soft_variants(const Case& one, const std::string& series) {
  std::vector<std::size_t> places = variants_of(one, series);
  std::erase_if(places, [&](std::size_t i) { return !(one.variants[i].x >= 1.0); });
  std::ranges::sort(places, {}, [&](std::size_t i) { return one.variants[i].x; });
  const bool whole = !places.empty() && one.variants[places.front()].x == 1.0;
  return whole ? places : std::vector<std::size_t>();
}

SeriesMeasures measure_series(const Case& one, const std::string& series,
                              const VariantResults& results) {
  const std::vector<std::size_t> places = variants_of(one, series);
  SeriesMeasures measures{0.0, unknown, spread_of(places, results), slope_of(places, results)};
  double finest = std::numeric_limits<double>::infinity();
  for (const std::size_t place : places) {
    measures.worst_error = larger(measures.worst_error, results[place].worst());
    if (results[place].spacing > finest) continue;
    finest = results[place].spacing;
    measures.finest_error = results[place].worst();
  }
  return measures;
}

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

Budget take_budget(const Case& one, const CaseBudget& budget, const VariantResults& results) {
  Budget taken;
  const VariantResult& whole = results[soft_variants(one, budget.parts.front()).front()];
  taken.depth = whole.depth;
  taken.total = taken.rest = whole.error;
  for (const std::string& part : budget.parts) {
    const std::vector<std::size_t> places = soft_variants(one, part);
    std::vector<double> share;
    for (std::size_t d = 0; d < taken.depth.size(); ++d) {
      std::vector<double> x, error;
      for (const std::size_t place : places) {
        const VariantResult& result = results[place];
        x.push_back(one.variants[place].x);
        error.push_back(d < result.error.size() ? result.error[d] : unknown);
      }
      share.push_back(error.front() - continued_to_zero(x, error));
      taken.rest[d] -= share.back();
    }
    taken.parts.push_back(std::move(share));
  }
  return taken;
}

std::vector<std::string> variant_measure_names(const Case& one) {
  std::vector<std::string> names = {"variants.worst_error", "variants.not_converged",
                                    "reference.force_error"};
  for (const std::string& series : series_names(one))
    for (const std::string& measure : measures_of_series()) names.push_back(series + "." + measure);
  for (const CaseBudget& budget : one.budgets) names.push_back(budget.name + ".rest");
  return names;
}

std::map<std::string, double> take_variant_measures(const Case& one, const VariantResults& results,
                                                    std::size_t not_converged) {
  std::map<std::string, double> taken;
  double worst = 0.0, reference = 0.0;
  for (const VariantResult& result : results) {
    worst = larger(worst, result.worst());
    for (const double error : result.reference_error) reference = larger(reference, error);
  }
  taken["variants.worst_error"] = worst;
  taken["variants.not_converged"] = double(not_converged);
  taken["reference.force_error"] = reference;
  for (const std::string& series : series_names(one)) {
    const SeriesMeasures measures = measure_series(one, series, results);
    taken[series + ".worst_error"] = measures.worst_error;
    taken[series + ".finest_error"] = measures.finest_error;
    taken[series + ".spread"] = measures.spread;
  }
  for (const CaseBudget& budget : one.budgets) {
    double rest = 0.0;
    for (const double error : take_budget(one, budget, results).rest)
      rest = larger(rest, std::abs(error));
    taken[budget.name + ".rest"] = rest;
  }
  std::erase_if(taken, [](const auto& entry) { return std::isnan(entry.second); });
  return taken;
}

}  // namespace fingertip::studies
