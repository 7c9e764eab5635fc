#include "studies/report/chapters/fit/calibration_figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <ranges>

#include "calibration/material/moduli.h"
#include "lattice/model/constants.h"
#include "studies/report/figure/format.h"
#include "studies/report/figure/modulus_surfaces.h"

namespace fingertip::studies::report::inline chapters::inline fit {
namespace {

using calibration::FitDataRow;
using calibration::SurrogateRow;

constexpr int legend_room = 205;
/// More curves than this are told apart by their shade alone.
constexpr std::size_t max_labels = 14;
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

Style curve_style(std::size_t i, std::size_t count) {
  Style style = numbered_style(i);
  if (count > max_labels) style.colour = depth_shade(i, count);
  style.dash.clear();
  style.width = 1.6;
  return style;
}

Series of_rows(const FitCurve& own, const std::string& label, const std::string& key,
               const Style& style, double FitDataRow::*value) {
  return curve(label, own.name + " " + key, style, own.rows, in(own.x_quantity, &FitDataRow::x),
               in(own.y_quantity, value));
}

Series points(const FitCurve& curve, const Style& style, bool labelled) {
  Series series = of_rows(curve, labelled ? shortened(curve.name) : "", "measured",
                          style.as_points(), &FitDataRow::measured);
  const auto sigma =
      curve.knows(&FitDataRow::total_sigma) ? &FitDataRow::total_sigma : &FitDataRow::sigma;
  if (curve.has_sigma())
    for (const FitDataRow& row : curve.rows) series.error.push_back(curve.y_quantity(row.*sigma));
  if (curve.rows.size() > many_points) series.style.opacity = 0.3, series.style.point_size = 0.5;
  return series;
}

Series line(const FitCurve& curve, double FitDataRow::*value, const std::string& key, Style style,
            const std::string& dash) {
  style.dash = dash;
  return of_rows(curve, "", key, style.as_line(), value);
}

constexpr const char* left_out_dash = "(2,3)";

/// Entries of the legend that say what a line is.
void add_line_kinds(Panel& panel, bool left_out) {
  panel.series.push_back(legend_entry("fitted", {"#555555", "", 1.6}));
  if (left_out)
    panel.series.push_back(legend_entry("fitted to the others", {"#555555", left_out_dash, 1.6}));
}

using Curves = std::vector<const FitCurve*>;

/// Measurements that span more than a decade are spread in decades, too.
bool spans_decades(const Curves& curves) {
  Range x;
  for (const FitCurve* curve : curves)
    for (const FitDataRow& row : curve->rows) x.include(row.x);
  return x.from > 0.0 && x.to > 30.0 * x.from;
}

/// Residuals of presses over travel are shown as forces: in percent they grow without bound at
/// touch.
bool as_forces(const Curves& curves) {
  return std::ranges::all_of(curves, [](const FitCurve* curve) {
    return curve->entry.course && curve->entry.course->noise > 0.0;
  });
}

/// What a residual is divided by; `sigma` as chi-square counts it, where the file tells.
enum class ResidualUnit { sigma, percent, own };

Series way_back(const FitCurve& curve, const Style& style) {
  const calibration::LoadingHistory& course = *curve.entry.course;
  Series series{"", curve.name + " way back", style.as_line()};
  for (std::size_t i = 0; i < course.back_x.size(); ++i)
    series.add(curve.x_quantity(course.back_x[i]), curve.y_quantity(course.back_y[i]));
  series.style.width = 1.0;
  series.style.dash = "(6,4)";
  return series;
}

Series residuals(const FitCurve& own, ResidualUnit shown, Style style) {
  style.width = 1.0;
  const bool whitened = shown == ResidualUnit::sigma && own.knows(&FitDataRow::whitened_residual);
  return curve("", own.name, style, own.rows, in(own.x_quantity, &FitDataRow::x),
               [&](const FitDataRow& row) {
                 if (whitened) return row.whitened_residual;
                 const double residual = row.measured - row.fitted;
                 const double unit = shown == ResidualUnit::sigma     ? row.sigma
                                     : shown == ResidualUnit::percent ? std::abs(row.measured) / 100
                                                                      : 1.0 / own.y_quantity.factor;
                 return unit > 0.0 ? residual / unit : meshes::unknown;
               });
}

Figure curve_figure(const Curves& curves, const std::string& name) {
  const Quantity &x = curves.front()->x_quantity, &y = curves.front()->y_quantity;
  Figure figure{name, 860, 560, 1, {}, legend_room};
  const auto any = [&](const auto& has) {
    return std::ranges::any_of(curves, [&](const FitCurve* curve) { return has(*curve); });
  };
  const bool over_sigma = std::ranges::all_of(curves, std::mem_fn(&FitCurve::has_sigma));
  const bool forces = !over_sigma && as_forces(curves);
  const ResidualUnit unit = over_sigma ? ResidualUnit::sigma
                            : forces   ? ResidualUnit::own
                                       : ResidualUnit::percent;
  const bool model_error = any(std::mem_fn(&FitCurve::has_model_error));
  Panel above{.x_label = x.label(), .y_label = y.label(), .key = figure.beside_panels()};
  Panel beneath{.x_label = x.label(),
                .y_label = over_sigma ? (model_error ? "whitened residual" : "residual / sigma")
                           : forces   ? "residual [" + y.unit + "]"
                                      : "residual [% of measured]",
                .key = ""};
  if (!forces && spans_decades(curves)) above.log_x = beneath.log_x = 10;
  for (std::size_t i = 0; i < curves.size(); ++i) {
    const FitCurve& curve = *curves[i];
    const Style style = curve_style(i, curves.size());
    above.series.push_back(points(curve, style, curves.size() <= max_labels));
    if (curve.entry.course && !curve.entry.course->back_x.empty())
      above.series.push_back(way_back(curve, style));
    if (curve.knows(&FitDataRow::left_out))
      above.series.push_back(line(curve, &FitDataRow::left_out, "left out", style, left_out_dash));
    above.series.push_back(line(curve, &FitDataRow::fitted, "fitted", style, ""));
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
    for (const FitCurve* curve : curves)
      noise = std::fmax(noise, curve->entry.course->noise_of_value());
    beneath.band = Band{-2.0 * noise * y.factor, 2.0 * noise * y.factor};
  }
  add_line_kinds(above, any([](const FitCurve& c) { return c.knows(&FitDataRow::left_out); }));
  figure.panels = {above, beneath};
  return figure;
}

Panel surrogate_panel(const Fit& fit, double SurrogateRow::*quantity, const std::string& name,
                      const std::string& label, const std::vector<double>& at_knots,
                      const std::string& y_label, const ShownUnit& unit) {
  const ShownUnit& length = shown_units().length;
  Panel panel = over_indentation(y_label);
  panel.series.push_back(curve(label, name, {"#0072B2"}, fit.surrogate,
                               in(length, &SurrogateRow::indentation), in(unit, quantity)));
  const std::vector<double>& places = fit.surrogate_notes.knots;
  if (places.size() != at_knots.size()) return panel;
  Series knots{"knots", name + " at knots", {"#D55E00", "", 1.0, 7, false}};
  for (std::size_t i = 0; i < places.size(); ++i) knots.add(length(places[i]), unit(at_knots[i]));
  panel.series.push_back(std::move(knots));
  return panel;
}

/// The area between the limits of the force; none where the file has no limits.
Series surrogate_band(const Fit& fit) {
  Series band{"band", "band", {"#0072B2", "", 1.0}};
  band.filled = true;
  const auto add = [&](const SurrogateRow& row, double force) {
    if (std::isfinite(row.force_lower + row.force_upper))
      band.add(shown_units().length(row.indentation), shown_units().force(force));
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
  std::vector<Curves> groups;
  for (const FitCurve& curve : fit.curves) {
    if (!curve.knows(&FitDataRow::measured)) continue;
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
  const double largest = largest_magnitude(values), limit = open_share * largest;
  if (values.size() < 2 || !(largest > 0.0)) return figure;
  double least = limit;
  for (const double value : values)
    if (value > 0.0) least = std::fmin(least, value);
  const Range x{0.4, double(values.size()) + 0.6}, y{least / 4.0, largest * 3.0};
  Panel panel{.x_label = "direction, the best determined first",
              .y_label = "singular value",
              .x_range = x,
              .y_range = y,
              .log_y = 10,
              .key = "outside right top"};
  Series bars{"", "bars", {"#0072B2", "", 5.0}};
  Series heads{"singular values", "", {"#0072B2", "", 1.0, 7, false, 1.2}};
  for (std::size_t i = 0; i < values.size(); ++i) {
    panel.x_names.push_back(std::to_string(i + 1));
    if (!(values[i] > 0.0)) continue;
    const double at = double(i + 1);
    bars.add(at, y.from);
    bars.add(at, values[i]);
    bars.add(meshes::unknown, meshes::unknown);
    heads.add(at, values[i]);
  }
  panel.series = {bars,
                  heads,
                  {fmt::format("{} of the largest", percent_magnitude(open_share)),
                   "limit",
                   {"#D55E00", "(6,4)", 1.4},
                   {x.from, x.to},
                   {limit, limit}}};
  figure.panels = {panel};
  return figure;
}

Figure surrogate_figure(const Fit& fit, const std::string& prefix) {
  Figure figure{prefix + "_surrogate", 760, 560, 1, {}};
  if (fit.surrogate.empty()) return figure;
  const ShownUnits& units = shown_units();
  Panel force =
      surrogate_panel(fit, &SurrogateRow::force, "force", "force", fit.surrogate_notes.force,
                      units.force.label("normal force F"), units.force);
  const Panel stiffness = surrogate_panel(fit, &SurrogateRow::stiffness, "stiffness",
                                          "stiffness dF/dδ", fit.surrogate_notes.stiffness,
                                          units.stiffness.label("dF/dδ"), units.stiffness);
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
    Panel panel = over_indentation("force error [%]", "");
    panel.title = shortened(prediction);
    double unsure = 0.0;
    bool any = false;
    for (std::size_t i = 0; i < data.fits.size(); ++i) {
      const std::string& fit = data.fits[i].name;
      Series& curve =
          panel.series.emplace_back(Series{shortened(fit), fit, curve_style(i, data.fits.size())});
      for (const TransferRow& row : data.transfer) {
        if (row.fit != fit || row.prediction != prediction) continue;
        curve.add(shown_units().length(row.indentation), 100.0 * row.relative_error);
        unsure = std::fmax(unsure, 100.0 * std::abs(row.reference_error));
        any = any || std::isfinite(row.relative_error);
      }
    }
    if (unsure > 0.0) panel.band = Band{-unsure, unsure};
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
