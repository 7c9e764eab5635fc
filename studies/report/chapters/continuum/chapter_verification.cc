/// The continuum's code against solutions from elsewhere.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "studies/report/chapters/continuum/continuum_chapters.h"
#include "studies/report/page/words.h"

namespace fingertip::studies::report::inline chapters::inline continuum {
namespace {

/// So far below the theory's order an observed one still counts as it, and as near to it.
constexpr double order_slack = 0.2, order_near = 0.5;
/// Below so much [%] it does not matter how far an element is off.
constexpr double min_shown = 1e-3;

using fem_reference::Check;
using fem_reference::ConvergenceStudy;
using fem_reference::LockingPoint;

std::string element_of(const ConvergenceStudy& study) {
  return fmt::format("Q{} {}", study.degree, fem_reference::name(study.volumetric));
}

/// Colour by degree; dashed and hollow for the plain displacement element.
Style element_style(const std::string& element) {
  static const std::map<char, Style> by_degree{{'1', {"#D55E00", "", 1.8, 7, true, 0.55}},
                                               {'2', {"#0072B2", "", 1.8, 5, true, 0.55}},
                                               {'3', {"#009E73", "", 1.8, 9, true, 0.65}}};
  const auto found = by_degree.find(element.size() > 1 ? element[1] : ' ');
  Style style = found == by_degree.end() ? Style{"#CC79A7", "", 1.8, 13} : found->second;
  if (element.find("pointwise") != std::string::npos) style.dash = "(5,3)", --style.point;
  return style;
}

const Style guide_style{"#777777", "(2,3)", 1.5};

/// An entry per element, right of the panels.
void add_legend(Figure& figure, const std::set<std::string>& elements) {
  Panel& first = figure.panels.front();
  first.key = figure.beside_panels();
  for (const std::string& element : elements)
    first.series.push_back(legend_entry(element, element_style(element)));
}

/// The entries with those of one problem side by side.
template <typename Entry>
std::vector<Entry> by_problem(const std::vector<Entry>& entries) {
  std::vector<Entry> sorted;
  for (const std::string& problem : distinct(entries, &Entry::problem))
    for (const Entry& entry : entries)
      if (entry.problem == problem) sorted.push_back(entry);
  return sorted;
}

/// An error norm of the convergence studies.
struct Norm {
  const char* label;
  double ConvergenceStudy::Mesh::*error;
  double ConvergenceStudy::*order;
  double ConvergenceStudy::*expected;
};
constexpr Norm norms[] = {
    {"error of u", &ConvergenceStudy::Mesh::error_l2, &ConvergenceStudy::order_l2,
     &ConvergenceStudy::expected_l2},
    {"error of grad u", &ConvergenceStudy::Mesh::error_h1, &ConvergenceStudy::order_h1,
     &ConvergenceStudy::expected_h1},
};

bool order_holds(const ConvergenceStudy& study) {
  return std::all_of(std::begin(norms), std::end(norms), [&](const Norm& norm) {
    return study.*norm.order >= study.*norm.expected - order_slack;
  });
}

Cell order_cell(const ConvergenceStudy& study, const Norm& norm) {
  const double order = study.*norm.order, expected = study.*norm.expected;
  const double missing = expected - order;
  return {number(order, 3), "theory " + number(expected, 1),
          !std::isfinite(missing)  ? Grade::none
          : missing <= order_slack ? Grade::close
          : missing <= order_near  ? Grade::fair
                                   : Grade::wrong};
}

Table order_table(const std::vector<ConvergenceStudy>& studies) {
  Table table{heads({"Problem", "Element", "ν", "Meshes\nunknowns", "Error of u\nL2", "Order",
                     "Error of grad u\nL2", "Order"})};
  for (const ConvergenceStudy& study : studies) {
    const std::vector<ConvergenceStudy::Mesh>& meshes = study.meshes;
    const ConvergenceStudy::Mesh finest = meshes.empty() ? ConvergenceStudy::Mesh{} : meshes.back();
    std::vector<Cell> row{study.problem,
                          element_of(study),
                          number(study.poissons_ratio, 4),
                          {std::to_string(meshes.size()), "to " + count(finest.unknowns)}};
    for (const Norm& norm : norms)
      row.insert(row.end(), {number(finest.*norm.error, 2), order_cell(study, norm)});
    table.rows.push_back(std::move(row));
  }
  return table;
}

/// The slope h^order below the best curve of that order, so that it can be compared by eye.
Series slope_guide(const std::vector<Series>& curves, double order) {
  const Series& best =
      *std::ranges::min_element(curves, {}, [](const Series& series) { return series.y.back(); });
  Series guide{"", fmt::format("h^{:g}", order), guide_style};
  const double h = best.x.back(), e = 0.6 * best.y.back();
  for (const double x : {best.x.front(), h}) guide.add(x, e * std::pow(x / h, order));
  return guide;
}

Panel study_panel(const std::vector<ConvergenceStudy>& studies, const std::string& problem,
                  const Norm& norm) {
  Panel panel{.title = problem,
              .x_label = shown_units().length.label("element size h"),
              .y_label = std::string("relative ") + norm.label,
              .log_x = 10,
              .log_y = 10,
              .key = ""};
  std::map<double, std::vector<Series>> by_order;
  for (const ConvergenceStudy& study : studies) {
    if (study.problem != problem) continue;
    Series series{"", element_of(study), element_style(element_of(study))};
    for (const ConvergenceStudy::Mesh& mesh : study.meshes)
      if (mesh.h > 0.0 && mesh.*norm.error > 0.0)
        series.add(shown_units().length(mesh.h), mesh.*norm.error);
    if (series.x.empty()) continue;
    const double order = study.*norm.expected;
    if (std::isfinite(order)) by_order[order].push_back(series);
    panel.series.push_back(std::move(series));
  }
  for (const auto& [order, curves] : by_order) panel.series.push_back(slope_guide(curves, order));
  return panel;
}

Figure orders_figure(const std::vector<ConvergenceStudy>& studies) {
  Figure figure{"verification_orders", 960, 0, 2, {}, 150};
  const std::vector<std::string> problems = distinct(studies, &ConvergenceStudy::problem);
  figure.height = 90 + 290 * int(problems.size());
  std::set<std::string> elements;
  for (const ConvergenceStudy& study : studies) elements.insert(element_of(study));
  for (const std::string& problem : problems)
    for (const Norm& norm : norms) figure.panels.push_back(study_panel(studies, problem, norm));
  add_legend(figure, elements);
  figure.panels.front().series.push_back(legend_entry("theory's slope", guide_style));
  return figure;
}

/// A value with the unit that its quantity names in brackets, e.g. "deflection [m]", for people.
Cell value_cell(double value, const std::string& quantity) {
  for (const ShownUnit* unit : shown_units().all()) {
    if (!quantity.ends_with(fmt::format("[{}]", unit->si)) || !std::isfinite(value)) continue;
    return Cell(with_unit(value, *unit, 5), si_note(value, std::string(unit->si)));
  }
  return Cell(number(value, std::abs(value) < 1e-3 ? 2 : 5));
}

/// The quantity without its unit, which the value carries.
std::string without_unit(const std::string& quantity) {
  const std::size_t bracket = quantity.rfind(" [");
  return bracket != std::string::npos && quantity.ends_with("]") ? quantity.substr(0, bracket)
                                                                 : quantity;
}

/// How much of its tolerance a check uses; beyond 1 it fails.
double share_of_tolerance(const Check& check) {
  const double deviation = check.relative_error;
  return deviation == 0.0 ? 0.0 : deviation / check.tolerance;
}

/// Passed checks of one kind: of the same quantity and source, their names alike up to a comma.
struct CheckGroup {
  std::string kind, quantity, source;
  Check worst;  ///< the check nearest to its tolerance
  int count = 0;
};

/// The failed checks each by itself, then the passed ones by kind.
std::vector<CheckGroup> check_groups(const std::vector<Check>& checks) {
  std::vector<CheckGroup> failed, groups;
  for (const Check& check : checks) {
    const std::string name = check.name;
    CheckGroup group{name.substr(0, name.find(',')), check.quantity, check.source, check, 1};
    if (!check.passed) {
      failed.push_back(std::move(group));
      continue;
    }
    const auto same = std::find_if(groups.begin(), groups.end(), [&](const CheckGroup& other) {
      return other.kind == group.kind && other.quantity == group.quantity &&
             other.source == group.source;
    });
    if (same == groups.end()) {
      groups.push_back(std::move(group));
      continue;
    }
    ++same->count;
    if (share_of_tolerance(check) > share_of_tolerance(same->worst)) same->worst = check;
  }
  failed.insert(failed.end(), groups.begin(), groups.end());
  return failed;
}

Table check_table(const std::vector<Check>& checks) {
  Table table{heads({"Check", "Passed", "Value", "Expected", "Deviation", "Tolerance", "Source"})};
  for (const CheckGroup& group : check_groups(checks)) {
    const Check& worst = group.worst;
    const bool good = worst.passed;
    table.rows.push_back({{worst.name, without_unit(group.quantity)},
                          !good              ? "failed"
                          : group.count == 1 ? "passed"
                                             : fmt::format("all {}", group.count),
                          value_cell(worst.value, group.quantity),
                          value_cell(worst.expected, group.quantity),
                          {number(worst.relative_error, 2), "", good ? Grade::close : Grade::wrong},
                          number(worst.tolerance, 2),
                          prose(group.source)});
  }
  return table;
}

/// |relative error| against 0.5 - nu for one problem; NaN where the error is exactly zero.
Panel locking_panel(const std::vector<LockingPoint>& locking, const std::string& problem) {
  Panel panel{.x_label = "0.5 − ν   (incompressible to the right)",
              .y_label = problem + ": off by [%]",
              .log_x = 10,
              .log_y = 10,
              .key = ""};
  std::map<std::string, Series> curves;
  for (const LockingPoint& point : locking) {
    const double compressible = 0.5 - point.poissons_ratio;
    const double error = 100.0 * std::abs(point.relative_error);
    if (point.problem != problem || !(compressible > 0.0)) continue;
    curves.try_emplace(point.element, Series{"", point.element, element_style(point.element)})
        .first->second.add(compressible, error > 0.0 ? error : meshes::unknown);
  }
  for (auto& [element, series] : curves) panel.series.push_back(std::move(series));
  if (curves.empty()) return panel;
  Range x = extent_of(panel.series, &Series::x), y = extent_of(panel.series, &Series::y);
  panel.x_range = Range{1.4 * x.to, x.from / 1.4};
  panel.y_range = Range{std::fmax(y.from / 2.0, min_shown), 2.0 * std::fmax(y.to, min_shown)};
  return panel;
}

Figure locking_figure(const std::vector<LockingPoint>& locking) {
  Figure figure{"locking", 860, 0, 1, {}, 150};
  const std::vector<std::string> problems = distinct(locking, &LockingPoint::problem);
  figure.height = 80 + 230 * int(problems.size());
  for (const std::string& problem : problems)
    figure.panels.push_back(locking_panel(locking, problem));
  const std::vector<std::string> elements = distinct(locking, &LockingPoint::element);
  add_legend(figure, {elements.begin(), elements.end()});
  return figure;
}

Table locking_table(const std::vector<LockingPoint>& locking) {
  std::set<double> ratios;
  for (const LockingPoint& point : locking)
    if (std::isfinite(point.poissons_ratio)) ratios.insert(point.poissons_ratio);
  Table table{{"Problem, element"}, true};
  for (const double nu : ratios) table.header.emplace_back(number(nu, 4));
  std::vector<std::pair<std::string, std::string>> names;
  for (const LockingPoint& point : locking)
    if (const std::pair name{point.problem, point.element};
        std::ranges::find(names, name) == names.end())
      names.push_back(name);
  for (const auto& [problem, element] : names) {
    std::vector<Cell> row{{problem, element}};
    for (const double nu : ratios) {
      double error = meshes::unknown;
      for (const LockingPoint& point : locking)
        if (point.problem == problem && point.element == element && point.poissons_ratio == nu)
          error = point.relative_error;
      row.push_back(error_cell(error));
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

/// The problems where some element falls short of its order, and those elements.
WordList slow_elements(const std::vector<ConvergenceStudy>& studies) {
  WordList problems;
  for (const std::string& problem : distinct(studies, &ConvergenceStudy::problem)) {
    std::set<std::string> slow;
    for (const ConvergenceStudy& study : studies)
      if (study.problem == problem && !order_holds(study)) slow.insert(element_of(study));
    if (slow.empty()) continue;
    problems.emplace_back()["problem"] = problem;
    problems.back()["elements"] = enumerate(slow);
  }
  return problems;
}

/// "" of none.
std::string unless_none(std::size_t number) {
  return number > 0 ? std::to_string(number) : "";
}

/// How the checks, all studies, and those of the element of this run's press did.
void add_results(ChapterData& chapter, const RunData& run,
                 const std::vector<ConvergenceStudy>& studies) {
  const std::vector<Check>& checks = run.verification.checks;
  std::vector<std::string> failed;
  for (const Check& check : checks)
    if (!check.passed) failed.push_back(check.name);
  chapter["checks"] = unless_none(checks.size());
  chapter["passed"] = std::to_string(checks.size() - failed.size());
  chapter["studies"] = unless_none(studies.size());
  chapter["kept"] = std::to_string(std::ranges::count_if(studies, order_holds));
  chapter["slow"] = slow_elements(studies);
  chapter["failed"] = enumerate(failed);
  const std::string used =
      run.continuum.empty() ? ""
                            : fmt::format("Q{} {}", run.continuum.degree, run.continuum.volumetric);
  std::vector<ConvergenceStudy> own;
  std::ranges::copy_if(studies, std::back_inserter(own),
                       [&](const ConvergenceStudy& study) { return element_of(study) == used; });
  chapter["used"] = used;
  chapter["used_studies"] = unless_none(own.size());
  chapter["used_kept"] = std::to_string(std::ranges::count_if(own, order_holds));
}

}  // namespace

Chapter verification_chapter(const RunData& run) {
  const std::vector<ConvergenceStudy> studies = by_problem(run.verification.studies);
  const std::vector<LockingPoint> locking = by_problem(run.verification.locking);
  if (studies.empty() && run.verification.checks.empty() && locking.empty()) return {};
  ChapterData chapter("verification");
  add_results(chapter, run, studies);
  chapter["slack"] = fmt::format("{:g}", order_slack);
  chapter["near"] = fmt::format("{:g}", order_near);
  if (!studies.empty()) chapter.figures.push_back(orders_figure(studies));
  chapter.tables["orders"] = order_table(studies);
  chapter.tables["checks"] = check_table(run.verification.checks);
  if (!locking.empty()) chapter.figures.push_back(locking_figure(locking));
  chapter.tables["locking"] = locking_table(locking);
  return written(std::move(chapter));
}

}  // namespace fingertip::studies::report::inline chapters::inline continuum
