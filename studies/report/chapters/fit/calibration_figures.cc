#include "studies/report/chapters/fit/calibration_figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ranges>

#include "calibration/material/moduli.h"
#include "lattice/model/constants.h"
#include "studies/report/figure/format.h"
#include "studies/report/figure/modulus_surfaces.h"

namespace fingertip::studies::report::inline chapters::inline fit {
namespace {

using calibration::SurrogateRow;

constexpr int legend_room = 205;
/// More curves than this are told apart by their shade alone.
constexpr std::size_t most_labels = 14;
/// More points than this merge into a band, which a line on it must be seen through.
constexpr std::size_t many_points = 40;

/// At most so many characters as the legend has room for.
std::string shortened(const std::string& text) {
  constexpr std::size_t most = 24;
  std::string cut;
  std::size_t characters = 0;
  for (const char c : text) {
    const bool begins = (static_cast<unsigned char>(c) & 0xC0) != 0x80;
    if (begins && ++characters > most) return cut + "…";
    cut += c;
  }
  return cut;
}

std::vector<double> scaled(std::vector<double> values, double factor) {
  for (double& value : values) value *= factor;
  return values;
}

bool any_finite(const std::vector<double>& values) {
  return std::ranges::any_of(values, [](double value) { return std::isfinite(value); });
}

Style curve_style(std::size_t i, std::size_t count) {
  Style style = numbered_style(i);
  if (count > most_labels) style.colour = depth_shade(i, count);
  style.dash.clear();
  style.width = 1.6;
  return style;
}

Series points(const FitCurve& curve, const Style& style, bool labelled) {
  Series series{labelled ? shortened(curve.name) : "", curve.name + " measured", {}, {}, {}, style};
  series.x = scaled(curve.x, curve.x_quantity.factor);
  series.y = scaled(curve.measured, curve.y_quantity.factor);
  if (curve.has_sigma())
    series.error = scaled(any_finite(curve.total_sigma) ? curve.total_sigma : curve.sigma,
                          curve.y_quantity.factor);
  series.style.line = false;
  if (curve.x.size() > many_points) series.style.opacity = 0.3, series.style.point_size = 0.5;
  return series;
}

Series line(const FitCurve& curve, const std::vector<double>& values, const std::string& key,
            const Style& style, const std::string& dash) {
  Series series{"", curve.name + " " + key, {}, {}, {}, style};
  series.x = scaled(curve.x, curve.x_quantity.factor);
  series.y = scaled(values, curve.y_quantity.factor);
  series.style.point = 0;
  series.style.dash = dash;
  return series;
}

constexpr const char* left_out_dash = "(2,3)";

/// Entries of the legend that say what a line is.
void add_line_kinds(Panel& panel, bool left_out) {
  const auto entry = [&](const char* label, const char* dash) {
    Series series{label, label, {}, {}, {}, {"#555555", dash, 1.6, 0, true}};
    series.legend_only = true;
    panel.series.push_back(std::move(series));
  };
  entry("fitted", "");
  if (left_out) entry("fitted to the others", left_out_dash);
}

/// Measurements that span more than a decade are spread in decades, too.
bool spans_decades(const std::vector<const FitCurve*>& curves) {
  double least = meshes::unknown, most = meshes::unknown;
  for (const FitCurve* curve : curves) {
    for (const double x : curve->x) least = std::fmin(least, x), most = std::fmax(most, x);
  }
  return least > 0.0 && most > 30.0 * least;
}

/// Residuals of presses over travel are shown as forces: in percent they grow without bound at
/// touch.
bool as_forces(const std::vector<const FitCurve*>& curves) {
  return std::ranges::all_of(
      curves, [](const FitCurve* curve) { return curve->course && curve->course->noise > 0.0; });
}

/// What a residual is divided by; `sigma` as chi-square counts it, where the file tells.
enum class ResidualUnit { sigma, percent, own };

Series way_back(const FitCurve& curve, const Style& style) {
  Series series{"", curve.name + " way back", {}, {}, {}, style};
  series.x = scaled(curve.course->back_x, curve.x_quantity.factor);
  series.y = scaled(curve.course->back_y, curve.y_quantity.factor);
  series.style.point = 0;
  series.style.width = 1.0;
  series.style.dash = "(6,4)";
  return series;
}

Series residuals(const FitCurve& curve, ResidualUnit shown, const Style& style) {
  Series series{"", curve.name, scaled(curve.x, curve.x_quantity.factor), {}, {}, style};
  series.style.width = 1.0;
  if (shown == ResidualUnit::sigma && any_finite(curve.whitened)) {
    series.y = curve.whitened;
    return series;
  }
  for (std::size_t i = 0; i < curve.x.size(); ++i) {
    const double residual = curve.measured[i] - curve.fitted[i];
    const double unit = shown == ResidualUnit::sigma     ? curve.sigma[i]
                        : shown == ResidualUnit::percent ? std::abs(curve.measured[i]) / 100.0
                                                         : 1.0 / curve.y_quantity.factor;
    series.y.push_back(unit > 0.0 ? residual / unit : meshes::unknown);
  }
  return series;
}

Figure curve_figure(const std::vector<const FitCurve*>& curves, const std::string& name) {
  const Quantity &x = curves.front()->x_quantity, &y = curves.front()->y_quantity;
  Figure figure{name, 860, 560, 1, {}};
  const bool over_sigma =
      std::ranges::all_of(curves, [](const FitCurve* curve) { return curve->has_sigma(); });
  const bool left_out = std::ranges::any_of(
      curves, [](const FitCurve* curve) { return any_finite(curve->left_out); });
  Panel above, beneath;
  above.x_label = beneath.x_label = x.label();
  above.y_label = y.label();
  const bool forces = !over_sigma && as_forces(curves);
  const ResidualUnit unit = over_sigma ? ResidualUnit::sigma
                            : forces   ? ResidualUnit::own
                                       : ResidualUnit::percent;
  const bool model_error =
      std::ranges::any_of(curves, [](const FitCurve* curve) { return curve->has_model_error(); });
  beneath.y_label = over_sigma ? (model_error ? "whitened residual" : "residual / sigma")
                    : forces   ? "residual [" + y.unit + "]"
                               : "residual [% of measured]";
  beneath.key.clear();
  if (!forces && spans_decades(curves)) above.log_x = beneath.log_x = 10;
  for (std::size_t i = 0; i < curves.size(); ++i) {
    const FitCurve& curve = *curves[i];
    const Style style = curve_style(i, curves.size());
    above.series.push_back(points(curve, style, curves.size() <= most_labels));
    if (curve.course && !curve.course->back_x.empty())
      above.series.push_back(way_back(curve, style));
    if (any_finite(curve.left_out))
      above.series.push_back(line(curve, curve.left_out, "left out", style, left_out_dash));
    above.series.push_back(line(curve, curve.fitted, "fitted", style, ""));
    beneath.series.push_back(residuals(curve, unit, style));
  }
  if (over_sigma) {
    double most = 3.0;
    for (const Series& series : beneath.series)
      most = std::fmax(most, 1.1 * largest_magnitude(series.y));
    beneath.y_range = Range{-most, most};
    beneath.band = Band{-2.0, 2.0};
  }
  if (forces) {
    double noise = 0.0;
    for (const FitCurve* curve : curves) noise = std::fmax(noise, curve->course->noise_of_value());
    beneath.band = Band{-2.0 * noise * y.factor, 2.0 * noise * y.factor};
  }
  add_line_kinds(above, left_out);
  figure.right_margin = legend_room;
  above.key = figure.beside_panels();
  figure.panels = {above, beneath};
  return figure;
}

Panel surrogate_panel(const Fit& fit, double SurrogateRow::*quantity, const std::string& name,
                      const std::vector<double>& at_knots, const std::string& y_label,
                      double factor) {
  Panel panel;
  panel.x_label = shown_units().length.label("indentation");
  panel.y_label = y_label;
  panel.series.push_back(
      {name,
       name,
       scaled(column(fit.surrogate, &SurrogateRow::indentation), shown_units().length.factor),
       scaled(column(fit.surrogate, quantity), factor),
       {},
       {"#0072B2", "", 2.0, 0, true}});
  Series knots{"knots",
               name + " at knots",
               scaled(fit.surrogate_notes.knots, shown_units().length.factor),
               scaled(at_knots, factor),
               {},
               {"#D55E00", "", 1.0, 7, false}};
  if (knots.x.size() == knots.y.size()) panel.series.push_back(std::move(knots));
  panel.series.front().label = name == "force" ? "force" : "stiffness dF/dδ";
  return panel;
}

/// The area between the limits of the force; none where the file has no limits.
Series surrogate_band(const Fit& fit) {
  Series band{"band", "band", {}, {}, {}, {"#0072B2", "", 1.0, 0, true}};
  band.filled = true;
  const auto add = [&](const SurrogateRow& row, double force) {
    if (!std::isfinite(row.force_lower + row.force_upper)) return;
    band.x.push_back(shown_units().length(row.indentation));
    band.y.push_back(shown_units().force(force));
  };
  for (const SurrogateRow& row : fit.surrogate) add(row, row.force_upper);
  for (const SurrogateRow& row : std::views::reverse(fit.surrogate)) add(row, row.force_lower);
  return band;
}

/// The homogenised constants that calibration.json gives: of the spring constants, else of what
/// was achieved.
calibration::ElasticModuli fitted_moduli(const Fit& fit) {
  if (const auto& achieved = fit.file.achieved;
      achieved && std::isfinite(achieved->youngs_modulus_100))
    return cubic_material(achieved->youngs_modulus_100, achieved->poissons_ratio_100,
                          achieved->shear_modulus);
  const calibration::FitConstants& found = fit.file.constants;
  return calibration::homogenised_moduli({found.k1, found.k2, found.k3, found.kappa},
                                         fit.file.spacing);
}

/// E of the rubber that the published rule would have been given.
double rule_modulus(const Fit& fit) {
  if (fit.file.target) return fit.file.target->youngs_modulus;
  const std::size_t fitted = fit.index("youngs_modulus");
  if (fitted < fit.parameters.size()) return fit.parameters[fitted].estimate;
  return fit.file.achieved ? fit.file.achieved->youngs_modulus_100 : meshes::unknown;
}

}  // namespace

std::vector<Figure> curve_figures(const Fit& fit, const std::string& prefix) {
  std::vector<std::vector<const FitCurve*>> groups;
  for (const FitCurve& curve : fit.curves) {
    if (!any_finite(curve.measured)) continue;
    const auto group = std::ranges::find_if(groups, [&](const auto& other) {
      return other.front()->x_quantity.label() == curve.x_quantity.label() &&
             other.front()->y_quantity.label() == curve.y_quantity.label();
    });
    if (group == groups.end())
      groups.push_back({&curve});
    else
      group->push_back(&curve);
  }
  std::vector<Figure> figures;
  for (const auto& group : groups)
    figures.push_back(curve_figure(
        group, prefix + "_curves" + (groups.size() > 1 ? std::to_string(figures.size() + 1) : "")));
  return figures;
}

Figure singular_value_figure(const Fit& fit, const std::string& prefix) {
  Figure figure{prefix + "_singular_values", 760, 330, 1, {}};
  const std::vector<double>& values = fit.file.singular_values;
  const double largest = largest_magnitude(values);
  if (values.size() < 2 || !(largest > 0.0)) return figure;
  double least = open_share * largest;
  for (const double value : values)
    if (value > 0.0) least = std::fmin(least, value);
  const Range range{least / 4.0, largest * 3.0};
  Panel panel;
  panel.x_label = "direction, the best determined first";
  panel.y_label = "singular value";
  panel.log_y = 10;
  panel.x_range = Range{0.4, double(values.size()) + 0.6};
  panel.y_range = range;
  panel.key = "outside right top";
  Series bars{"", "bars", {}, {}, {}, {"#0072B2", "", 5.0, 0, true}};
  Series heads{"singular values", "", {}, {}, {}, {"#0072B2", "", 1.0, 7, false, 1.2}};
  for (std::size_t i = 0; i < values.size(); ++i) {
    panel.x_names.push_back(std::to_string(i + 1));
    if (!(values[i] > 0.0)) continue;
    const double x = double(i + 1);
    bars.x.insert(bars.x.end(), {x, x, meshes::unknown});
    bars.y.insert(bars.y.end(), {range.from, values[i], meshes::unknown});
    heads.x.push_back(x), heads.y.push_back(values[i]);
  }
  const double limit = open_share * largest;
  panel.series = {bars,
                  heads,
                  {fmt::format("{} of the largest", percent_magnitude(open_share)),
                   "limit",
                   {panel.x_range->from, panel.x_range->to},
                   {limit, limit},
                   {},
                   {"#D55E00", "(6,4)", 1.4, 0, true}}};
  figure.panels = {panel};
  return figure;
}

Figure surrogate_figure(const Fit& fit, const std::string& prefix) {
  Figure figure{prefix + "_surrogate", 760, 560, 1, {}};
  if (fit.surrogate.empty()) return figure;
  Panel force =
      surrogate_panel(fit, &SurrogateRow::force, "force", fit.surrogate_notes.force,
                      shown_units().force.label("normal force F"), shown_units().force.factor);
  Panel stiffness =
      surrogate_panel(fit, &SurrogateRow::stiffness, "stiffness", fit.surrogate_notes.stiffness,
                      shown_units().stiffness.label("dF/dδ"), shown_units().stiffness.factor);
  if (Series band = surrogate_band(fit); !band.x.empty())
    force.series.insert(force.series.begin(), std::move(band));
  figure.panels = {force, stiffness};
  return figure;
}

bool finds_springs(const Fit& fit) {
  return fit.problem == "curve";
}

Figure fitted_moduli_figure(const Fit& fit, const std::string& prefix) {
  const calibration::ElasticModuli found = fitted_moduli(fit);
  const Figure fitted = modulus_surface_figure(prefix + "_moduli", {{"", found}});
  if (fitted.panels.empty()) return fitted;
  // What measurements tell of a rubber replaces no rule for springs, and a ball shows nothing.
  constexpr double isotropic = 1e-6;
  if (!finds_springs(fit)) return std::abs(found.anisotropy - 1.0) < isotropic ? Figure() : fitted;
  meshes::Rubber rubber;
  rubber.youngs_modulus = rule_modulus(fit);
  // The published rule's moduli do not depend on the spacing.
  return modulus_surface_figure(
      prefix + "_moduli",
      {{"before: the published rule",
        calibration::homogenised_moduli(lattice::published_constants(rubber, 1.0), 1.0)},
       {"after: fitted", found}});
}

Figure transfer_figure(const CalibrationData& data) {
  Figure figure{"transfer_error", 860, 430, 1, {}};
  for (const std::string& prediction : data.predictions) {
    Panel panel;
    panel.title = shortened(prediction);
    panel.x_label = shown_units().length.label("indentation");
    panel.y_label = "force error [%]";
    panel.key.clear();
    double unsure = 0.0;
    for (std::size_t i = 0; i < data.fits.size(); ++i) {
      Series curve{shortened(data.fits[i].name), data.fits[i].name, {}, {}, {}, {}};
      curve.style = curve_style(i, data.fits.size());
      for (const TransferRow& row : data.transfer) {
        if (row.fit != data.fits[i].name || row.prediction != prediction) continue;
        curve.x.push_back(shown_units().length(row.indentation));
        curve.y.push_back(100.0 * row.relative_error);
        unsure = std::fmax(unsure, 100.0 * std::abs(row.reference_error));
      }
      panel.series.push_back(std::move(curve));
    }
    if (unsure > 0.0) panel.band = Band{-unsure, unsure};
    const bool any = std::ranges::any_of(panel.series,
                                         [](const Series& series) { return any_finite(series.y); });
    if (any) figure.panels.push_back(std::move(panel));
  }
  if (figure.panels.empty()) return figure;
  const std::size_t count = figure.panels.size();
  figure.columns = count > 1 ? 2 : 1;
  figure.height = count > 1 ? 60 + 270 * int((count + 1) / 2) : 400;
  figure.right_margin = legend_room;
  figure.width += legend_room;
  figure.panels.front().key = figure.beside_panels();
  return figure;
}

}  // namespace fingertip::studies::report::inline chapters::inline fit
