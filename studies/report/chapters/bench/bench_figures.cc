#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "studies/report/chapters/bench/bench_figures.h"
#include "studies/report/figure/format.h"
#include "studies/report/results/run_data.h"

namespace fingertip::studies::reporting {
namespace {

/// Worst error that counts as accurate [%], and the factor from which on a press is in real time.
constexpr double accurate = 2.0, real_time = 1.0;

constexpr const char* usual_integrator = "symplectic-euler";

/// What one core of its own would give, where that was measured.
double pace_of(const JsonEntry& press) {
  const double processor = number_if_any(press, "real_time_factor_processor");
  return std::isfinite(processor) ? processor : number_if_any(press, "real_time_factor");
}

/// Whether the whole tip was asked for where a part would have done.
bool is_whole(const JsonEntry& press) {
  return press.contains("whole") && press.at("whole").flag();
}

/// Colour tells the model, the marker the integrator: circles for plain steps, triangles for scaled
/// masses, upside down of the whole tip; hollow where something else than one core against law A is
/// meant.
struct Family {
  std::string label, model, integrator, error_key;
  double threads = 1.0;
  bool hollow = false;
  double label_height = 0.84;  ///< where "R/n" is written, over the point's error; 0: nowhere
  bool whole = false;
};

std::string integrator_of(const JsonEntry& press) {
  const std::string integrator = text_if_any(press, "integrator");
  return integrator.empty() ? usual_integrator : integrator;
}

Style family_style(const std::string& model, bool usual_steps) {
  Style style = model_style(model);
  style.point = usual_steps ? 7 : 9;
  style.point_size = usual_steps ? 0.9 : 1.2;
  style.dash = usual_steps ? "" : "(8,4)";
  style.width = 2.2;
  return style;
}

/// The presses of a family, each point with its R/n.
void add_family(Panel& panel, const JsonEntry& bench, const Family& family) {
  Series series;
  series.label = family.label;
  series.style = family_style(family.model, family.integrator == usual_integrator);
  if (family.whole) series.style.point = 11;
  if (family.hollow) {
    series.style.point -= 1;
    series.style.dash = "(2,4)";
    series.style.width = 1.4;
  }
  for (const JsonEntry& press : array_if_any(bench, "press")) {
    if (text_if_any(press, "model") != family.model || integrator_of(press) != family.integrator ||
        number_if_any(press, "threads") != family.threads || is_whole(press) != family.whole)
      continue;
    const double error = 100.0 * number_if_any(press, family.error_key), pace = pace_of(press);
    if (!std::isfinite(error) || !std::isfinite(pace)) continue;
    series.x.push_back(pace);
    series.y.push_back(error);
    if (family.label_height > 0.0)
      panel.texts.push_back(
          {pace, family.label_height * error,
           fmt::format("R/{:.0f}", 1.0 / number_if_any(press, "spacing_over_R"))});
  }
  if (!series.x.empty()) panel.series.push_back(std::move(series));
}

void add_lattices(Panel& panel, const JsonEntry& bench) {
  const char *usual = usual_integrator, *scaled = "mass-scaled";
  constexpr double above = 1.22;
  const char *law_a = "worst_force_error", *small = "worst_force_error_small_strain";
  add_family(panel, bench, {"network", "network", usual, law_a});
  add_family(panel, bench, {"network, scaled masses", "network", scaled, law_a, 1.0, false, above});
  add_family(panel, bench,
             {"… on two cores (wall clock)", "network", scaled, law_a, 2.0, true, 0.0});
  add_family(panel, bench,
             {"… the whole tip (one core)", "network", scaled, law_a, 1.0, true, 0.0, true});
  add_family(panel, bench, {"hookean", "hookean", usual, law_a, 1.0, false, above});
  add_family(panel, bench, {"… against small strain", "hookean", usual, small, 1.0, true, 0.0});
  add_family(panel, bench,
             {"… against it, scaled masses", "hookean", scaled, small, 1.0, true, 0.0});
  add_family(panel, bench, {"published (1996)", "published", usual, law_a});
}

/// Each point with its number of unknowns.
void add_continua(Panel& panel, const JsonEntry& bench) {
  std::map<int, Series> by_degree;
  for (const JsonEntry& entry : array_if_any(bench, "continua")) {
    const double error = 100.0 * number_if_any(entry, "worst_force_error");
    const double pace = number_if_any(entry, "real_time_factor");
    if (!std::isfinite(error) || !std::isfinite(pace)) continue;
    const int degree = int(number_if_any(entry, "degree"));
    Series& series = by_degree[degree];
    series.label = fmt::format("quasi-static FEM, Q{}, unknowns", degree);
    series.style = model_style("reference");
    series.style.point = degree == 1 ? 4 : 5;
    series.style.point_size = 0.9;
    if (degree == 1) series.style.dash = "(6,3)";
    series.x.push_back(pace);
    series.y.push_back(error);
    panel.texts.push_back({pace, 1.22 * error, count(number_if_any(entry, "unknowns"))});
  }
  for (auto& [degree, series] : by_degree) panel.series.push_back(std::move(series));
}

/// The corner that every press should be in, behind everything else.
void add_target(Panel& panel) {
  const Range x = {real_time, panel.x_range->to}, y = {panel.y_range->from, accurate};
  Series corner;
  corner.key = "target";
  corner.filled = true;
  corner.style.colour = "#E69F00";
  corner.x = {x.from, x.to, x.to, x.from, x.from};
  corner.y = {y.from, y.from, y.to, y.to, y.from};
  panel.series.insert(panel.series.begin(), corner);
  panel.texts.push_back({std::sqrt(x.from * x.to), 1.25 * y.from, "2 %, real time"});
}

/// The range of logarithmic data with room at both ends, and `include` in it.
Range roomy(const std::vector<Series>& all, bool vertical, double include) {
  double low = include, high = include;
  for (const Series& series : all)
    for (const double value : vertical ? series.y : series.x) {
      low = std::fmin(low, value);
      high = std::fmax(high, value);
    }
  return {low / 1.6, high * 1.6};
}

}  // namespace

double parts_of(const JsonEntry& press) {
  const double parts = number_if_any(press, "parts");
  return std::isfinite(parts) ? parts : 1.0;
}

Figure pace_figure(const JsonEntry& bench) {
  Panel panel;
  panel.x_label = "real-time factor in the slowest 10 ms [1]";
  panel.y_label = fmt::format("largest force error, {} to {} [%]", shown_units().length.text(1e-3),
                              shown_units().length.text(3e-3));
  panel.log_x = panel.log_y = 10;
  panel.key = "outside right top";
  add_lattices(panel, bench);
  add_continua(panel, bench);
  if (panel.series.empty()) return {"pace", 0, 0, 1, {}};
  panel.x_range = roomy(panel.series, false, real_time);
  panel.x_range->to = std::fmax(panel.x_range->to, 10.0 * real_time);
  panel.y_range = roomy(panel.series, true, accurate);
  panel.y_range->from = std::fmin(panel.y_range->from, 0.25 * accurate);
  panel.markers = {{real_time, "#444444"}};
  add_target(panel);
  return {"pace", 940, 540, 1, {panel}};
}

double dram_cost(const JsonEntry& bench) {
  // Position and velocity of a mass read and written, shared by its 12.4 springs at 48³.
  constexpr double bytes = 7.7;
  return 1e9 * bytes / number_if_any(object_if_any(bench, "probes"), "bandwidth_DRAM");
}

Figure growth_figure(const JsonEntry& bench) {
  Panel panel;
  panel.x_label = "masses";
  panel.y_label = "ns per spring and step";
  panel.log_x = panel.log_y = 10;
  panel.key = "outside right top";
  const auto curve = [&](const std::string& label, const std::string& name, double threads,
                         std::size_t style) {
    std::map<double, double> points;
    for (const JsonEntry& kernel : array_if_any(bench, "kernels")) {
      if (text_if_any(kernel, "name") != name || text_if_any(kernel, "precision") != "float64" ||
          number_if_any(kernel, "threads") != threads)
        continue;
      const double cost = number_if_any(kernel, "ns_per_spring_step");
      const auto [at, fresh] = points.try_emplace(number_if_any(kernel, "masses"), cost);
      if (!fresh) at->second = std::fmin(at->second, cost);  // the widest registers
    }
    Series series;
    series.label = label;
    series.style = numbered_style(style);
    for (const auto& [masses, cost] : points) {
      series.x.push_back(masses);
      series.y.push_back(cost);
    }
    if (!series.x.empty()) panel.series.push_back(std::move(series));
  };
  curve("edge list, 1 thread", "edge_list", 1, 0);
  curve("spring engine, 1 thread", "springs", 1, 1);
  curve("spring engine, 2 threads", "springs", 2, 2);
  if (panel.series.empty()) return {"growth", 0, 0, 1, {}};
  const Range span = roomy(panel.series, false, panel.series.front().x.front());
  const auto bound = [&](const std::string& label, double cost, const char* dash) {
    if (!std::isfinite(cost)) return;
    Series series;
    series.label = label;
    series.x = {span.from, span.to};
    series.y = {cost, cost};
    series.style = {"#777777", dash, 1.4, 0, true};
    panel.series.push_back(std::move(series));
  };
  const JsonEntry probes = object_if_any(bench, "probes");
  double rate = 0.0;
  const JsonEntry rates = object_if_any(probes, "multiply_adds_per_second");
  for (const auto& [isa, value] : rates.members()) rate = std::fmax(rate, value.number());
  bound("17 multiply-adds, 1 core", 1e9 * 17.0 / rate, "(6,3)");
  bound("DRAM, 7.7 bytes", dram_cost(bench), "(2,3)");
  panel.x_range = span;
  panel.y_range = roomy(panel.series, true, panel.series.front().y.front());
  for (const char* cache : {"cache_L2", "cache_L3"})
    if (const double masses = number_if_any(probes, cache) / 48.0;
        masses > span.from && masses < span.to)
      panel.markers.push_back({masses, "#777777"});
  return {"growth", 860, 430, 1, {panel}};
}

Figure press_growth_figure(const JsonEntry& bench) {
  Panel panel;
  panel.x_label = "masses";
  panel.y_label = "ns per mass and step";
  panel.log_x = panel.log_y = 10;
  panel.key = "outside right top";
  for (const char* model : {"network", "hookean", "published"}) {
    for (const char* integrator : {usual_integrator, "mass-scaled"}) {
      const bool usual = integrator == usual_integrator;
      Series series;
      series.label = std::string(model) + (usual ? "" : ", scaled masses");
      series.style = family_style(model, usual);
      for (const JsonEntry& press : array_if_any(bench, "press")) {
        if (text_if_any(press, "model") != model || integrator_of(press) != integrator ||
            number_if_any(press, "threads") != 1.0 || is_whole(press))
          continue;
        series.x.push_back(number_if_any(press, "particles") / parts_of(press));
        series.y.push_back(number_if_any(press, "ns_per_mass_step"));
      }
      if (!series.x.empty()) panel.series.push_back(std::move(series));
    }
  }
  if (panel.series.empty()) return {"press_growth", 0, 0, 1, {}};
  panel.x_range = roomy(panel.series, false, panel.series.front().x.front());
  panel.y_range = roomy(panel.series, true, panel.series.front().y.front());
  return {"press_growth", 860, 430, 1, {panel}};
}

Figure history_figure(const JsonList& history) {
  Panel panel;
  panel.x_label = "run";
  panel.y_label = "ratio";
  panel.log_y = 10;
  panel.key = "outside right top";
  std::size_t style = 0;
  for (const char* name : {"edge_list_48_1t", "edge_list_20_1t", "lammps_48_1t", "lammps_20_1t",
                           "threads_48", "roofline_48_1t"}) {
    Series series;
    series.label = name;
    series.style = numbered_style(style++);
    for (std::size_t i = 0; i < history.size(); ++i) {
      const double value = number_if_any(object_if_any(history[i], "ratios"), name);
      if (!(value > 0.0)) continue;
      series.x.push_back(double(i + 1));
      series.y.push_back(value);
    }
    if (!series.x.empty()) panel.series.push_back(std::move(series));
  }
  if (history.size() < 2 || panel.series.empty()) return {"history", 0, 0, 1, {}};
  panel.x_range = Range{0.5, double(history.size()) + 0.5};
  return {"history", 860, 400, 1, {panel}};
}

}  // namespace fingertip::studies::reporting
