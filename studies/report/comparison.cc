/// Force curves of several runs against the first one.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <ostream>
#include <set>

#include "meshes/errors.h"
#include "meshes/table_rows.h"
#include "studies/files/press_condition.h"
#include "studies/report/chapters.h"
#include "studies/report/document.h"
#include "studies/report/moving_press.h"
#include "studies/report/report.h"
#include "studies/report/run_data.h"

namespace fingertip::studies {
namespace {

using namespace reporting;
namespace fs = std::filesystem;

/// Samples of one depth: a controller may stop a rounding error beside it.
constexpr double same_depth = 1e-6;
/// Rows of a table where curves have no samples in common.
constexpr std::size_t most_rows = 20;

struct Curve {
  std::string label;
  std::string model;  ///< name of the folder, perhaps that of a model
  fs::path folder;
  std::optional<PressCondition> condition;
  meshes::PressResponse response;
  Style style;

  double first_depth() const { return response.samples().front().indentation; }
  double depth() const { return response.depth(); }
};

/// A force of a curve and where it comes from.
struct Force {
  double value = meshes::unknown;  ///< [N]; NaN outside the curve's samples
  bool interpolated = false;
};

/// The force of a sample at `depth`, else the one interpolated between samples around it.
Force force_at(const Curve& curve, double depth) {
  for (const meshes::PressSample& sample : curve.response.pressing())
    if (std::abs(sample.indentation - depth) <= same_depth * std::abs(depth))
      return {sample.normal_force, false};
  if (!(depth > std::max(0.0, curve.first_depth()) && depth < curve.depth())) return {};
  return {curve.response.normal_force_at(depth), true};
}

/// The folder's name, also when the path ends in a slash or is ".".
std::string folder_name(const fs::path& folder) {
  const fs::path full = fs::weakly_canonical(folder);
  return full.has_filename() ? full.filename().string() : full.parent_path().filename().string();
}

/// The curves of a run: its own, or those of the runs inside it, continuum first.
std::vector<Curve> read_curves(const fs::path& folder, FolderReader& reader) {
  const std::string label = folder_name(folder);
  const auto curve = [&](const fs::path& place, const std::string& name, const std::string& model) {
    return Curve{
        name, model, place, read_condition(place, reader), reader.response(place / "response.csv"),
        {}};
  };
  if (fs::exists(folder / "response.csv")) return {curve(folder, label, label)};
  std::vector<Curve> curves;
  for (const std::string name : {"reference", "published", "central", "hookean"})
    if (fs::exists(folder / name / "response.csv"))
      curves.push_back(curve(folder / name, label + "/" + name, name));
  if (curves.empty()) {
    throw meshes::InvalidInput(
        meshes::Violation{folder.string(), "", "a run to compare must hold response.csv",
                          "name the folder of a press, a reference or a validate run"});
  }
  return curves;
}

/// Equal names become "name (2)" and so on, so that every column and curve can be told apart.
void make_unique(std::vector<Curve>& curves) {
  for (std::size_t i = 0; i < curves.size(); ++i) {
    int copies = 1;
    for (std::size_t j = 0; j < i; ++j) copies += curves[j].label == curves[i].label ? 1 : 0;
    if (copies > 1) curves[i].label += fmt::format(" ({})", copies);
  }
}

/// Whether every curve is a model of its own, so that the models' usual styles tell them apart.
bool are_models(const std::vector<Curve>& curves) {
  std::set<std::string> left{"reference", "published", "central", "hookean"};
  return std::all_of(curves.begin(), curves.end(),
                     [&](const Curve& curve) { return left.erase(curve.model) == 1; });
}

/// Sets the curves' styles.
void give_styles(std::vector<Curve>& curves) {
  const bool models = are_models(curves);
  for (std::size_t i = 0; i < curves.size(); ++i) {
    curves[i].style = models ? model_style(curves[i].model) : numbered_style(i);
  }
}

/// A force beside the first curve's.
struct Compared {
  Force force;
  double difference = meshes::unknown;  ///< relative
};

/// Everything that is compared: forces at depths at which the first curve has samples.
struct Comparison {
  std::vector<Curve> curves;
  std::vector<double> depths;               ///< [m]
  std::vector<std::vector<Compared>> rows;  ///< per depth and curve
  std::vector<ComparisonRemark> remarks;

  bool interpolates(std::size_t curve) const {
    return std::ranges::any_of(rows,
                               [&](const auto& row) { return row[curve].force.interpolated; });
  }
};

/// At most so many of them, the first and the last among them.
std::vector<double> thinned(const std::vector<double>& depths) {
  if (depths.size() <= most_rows) return depths;
  std::vector<double> some;
  for (std::size_t i = 0; i < most_rows; ++i)
    some.push_back(depths[i * (depths.size() - 1) / (most_rows - 1)]);
  return some;
}

/// Samples of the first curve at which another has one, too; where there are fewer than two for a
/// curve, some of the first curve's samples between that curve's.
std::vector<double> compared_depths(const std::vector<Curve>& curves) {
  std::set<double> depths;
  for (std::size_t i = 1; i < curves.size(); ++i) {
    std::vector<double> common, inside;
    for (const meshes::PressSample& sample : curves.front().response.pressing()) {
      const Force force = force_at(curves[i], sample.indentation);
      if (std::isnan(force.value) || !(sample.indentation > 0.0)) continue;
      inside.push_back(sample.indentation);
      if (!force.interpolated) common.push_back(sample.indentation);
    }
    const std::vector<double> chosen = common.size() < 2 ? thinned(inside) : common;
    depths.insert(chosen.begin(), chosen.end());
  }
  return {depths.begin(), depths.end()};
}

Comparison compare(std::vector<Curve> curves) {
  Comparison comparison{std::move(curves), {}, {}, {}};
  const std::vector<Curve>& all = comparison.curves;
  comparison.depths = compared_depths(all);
  for (const double depth : comparison.depths) {
    std::vector<Compared> row;
    const double first = force_at(all.front(), depth).value;
    for (const Curve& curve : all) {
      const Force force = force_at(curve, depth);
      row.push_back({force, force.value / first - 1.0});
    }
    comparison.rows.push_back(std::move(row));
  }
  for (std::size_t i = 1; i < all.size(); ++i) {
    const auto remark =
        remark_on(all[i].label, all[i].condition, all.front().label, all.front().condition);
    if (remark) comparison.remarks.push_back(*remark);
  }
  return comparison;
}

/// The relative L² difference of a curve from the first one between the samples of both.
struct OverallDifference {
  double from = meshes::unknown, to = meshes::unknown;  ///< [m]
  double l2 = meshes::unknown;
};

OverallDifference overall(const Curve& curve, const Curve& first) {
  OverallDifference result;
  result.from = std::max({0.0, curve.first_depth(), first.first_depth()});
  result.to = std::min(curve.depth(), first.depth());
  if (result.from < result.to)
    result.l2 =
        meshes::relative_l2_force_error(curve.response, first.response, result.from, result.to);
  return result;
}

void write_csv(const Comparison& comparison, const fs::path& file) {
  const std::vector<Curve>& curves = comparison.curves;
  meshes::write_atomically(file, [&](std::ostream& out) {
    out << "indentation [m]";
    for (std::size_t i = 0; i < curves.size(); ++i) {
      out << ',' << meshes::csv_cell(curves[i].label + " normal_force [N]");
      if (i > 0)
        out << ',' << meshes::csv_cell(curves[i].label + " relative_difference") << ','
            << meshes::csv_cell(curves[i].label + " interpolated");
    }
    out << '\n';
    for (std::size_t d = 0; d < comparison.depths.size(); ++d) {
      out << meshes::to_text(comparison.depths[d]);
      for (std::size_t i = 0; i < curves.size(); ++i) {
        const Compared& cell = comparison.rows[d][i];
        out << ',' << meshes::to_text(cell.force.value);
        if (i > 0) out << ',' << meshes::to_text(cell.difference) << ',';
        if (i > 0 && std::isfinite(cell.force.value)) out << (cell.force.interpolated ? 1 : 0);
      }
      out << '\n';
    }
  });
}

Panel force_panel(const std::vector<Curve>& curves) {
  Panel panel;
  panel.x_label = shown_units().length.label("indentation");
  panel.y_label = shown_units().force.label("normal force");
  panel.key = "outside top center horizontal";
  for (std::size_t i = 0; i < curves.size(); ++i) {
    Series series{curves[i].label, "", {}, {}, {}, curves[i].style};
    for (const meshes::PressSample& sample : curves[i].response.pressing()) {
      series.x.push_back(shown_units().length(sample.indentation));
      series.y.push_back(shown_units().force(sample.normal_force));
    }
    panel.series.push_back(std::move(series));
  }
  return panel;
}

/// The lateral motions that followed presses; without series when none did.
Panel lateral_panel(const std::vector<Curve>& curves) {
  Panel panel;
  panel.x_label = shown_units().length.label("lateral displacement");
  panel.y_label = shown_units().force.label("lateral force");
  panel.key = "outside top center horizontal";
  for (const Curve& curve : curves) {
    Series series{curve.label, "", {}, {}, {}, curve.style};
    for (const meshes::PressSample& sample : curve.response.sliding()) {
      series.x.push_back(shown_units().length(sample.lateral_displacement));
      series.y.push_back(shown_units().force(sample.lateral_force_x));
    }
    if (!series.x.empty()) panel.series.push_back(std::move(series));
  }
  return panel;
}

Panel difference_panel(const Comparison& comparison) {
  const std::vector<Curve>& curves = comparison.curves;
  Panel panel;
  panel.x_label = shown_units().length.label("indentation");
  panel.y_label = "relative difference [%]";
  panel.key = "outside top center horizontal";
  for (std::size_t i = 1; i < curves.size(); ++i) {
    Series series{curves[i].label, "", {}, {}, {}, curves[i].style};
    for (std::size_t d = 0; d < comparison.depths.size(); ++d) {
      if (std::isnan(comparison.rows[d][i].difference)) continue;
      series.x.push_back(shown_units().length(comparison.depths[d]));
      series.y.push_back(100.0 * comparison.rows[d][i].difference);
    }
    panel.series.push_back(std::move(series));
  }
  return panel;
}

/// "of hookean and central", those whose forces are interpolated somewhere; empty without any.
std::string interpolated_curves(const Comparison& comparison) {
  std::vector<std::string> names;
  for (std::size_t i = 1; i < comparison.curves.size(); ++i)
    if (comparison.interpolates(i)) names.push_back(comparison.curves[i].label);
  return names.empty() ? "" : enumerate(names);
}

Table difference_table(const Comparison& comparison) {
  const std::vector<Curve>& curves = comparison.curves;
  Table table;
  table.caption = fmt::format(
      "Normal force in {1}, and its difference from {0} below, at samples of {0}. Nothing is told "
      "outside the samples of a run.",
      curves.front().label, shown_units().force.name);
  if (const std::string names = interpolated_curves(comparison); !names.empty())
    table.caption += " ≈: interpolated between samples of " + names + ".";
  table.graded = std::ranges::none_of(comparison.remarks, &ComparisonRemark::meaningless);
  table.header = {plain("Indentation", unit_name(shown_units().length))};
  for (const Curve& curve : curves) table.header.push_back({curve.label, "", Grade::none});
  for (std::size_t d = 0; d < comparison.depths.size(); ++d) {
    std::vector<Cell> row{
        {fmt::format("{:.4g}", shown_units().length(comparison.depths[d])), "", Grade::none}};
    for (std::size_t i = 0; i < curves.size(); ++i) {
      const Compared& cell = comparison.rows[d][i];
      const std::string about = cell.force.interpolated ? "≈ " : "";
      if (std::isnan(cell.force.value))
        row.push_back({"", "", Grade::none});
      else if (i == 0)
        row.push_back({number(shown_units().force(cell.force.value)),
                       si_note(cell.force.value, "N"), Grade::none});
      else
        row.push_back({about + number(shown_units().force(cell.force.value)),
                       percent(cell.difference),
                       table.graded ? grade(cell.difference) : Grade::none});
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

/// Those of the runs that are presses in time.
std::vector<MovingPress> moving_presses(const std::vector<fs::path>& runs, FolderReader& reader) {
  std::vector<MovingPress> presses;
  for (const fs::path& run : runs) {
    if (!fs::exists(run / "trace.csv")) continue;
    MovingPress press = read_moving_press(run, folder_name(run), reader);
    press.style = numbered_style(presses.size());
    press.style.point = 0;
    presses.push_back(std::move(press));
  }
  return presses;
}

/// The last difference and the relative L² difference between the samples of both.
std::string summary_sentence(const Comparison& comparison) {
  const std::vector<Curve>& curves = comparison.curves;
  std::string text;
  for (std::size_t i = 1; i < curves.size(); ++i) {
    std::size_t last = comparison.depths.size();
    while (last > 0 && std::isnan(comparison.rows[last - 1][i].difference)) --last;
    text += i > 1 ? "; " : "";
    if (last == 0) {
      text += curves[i].label + " has no sample within those of it";
      continue;
    }
    text += fmt::format("{} differs by {} at {}", curves[i].label,
                        percent(comparison.rows[last - 1][i].difference),
                        length(comparison.depths[last - 1]));
    const OverallDifference all = overall(curves[i], curves.front());
    if (std::isfinite(all.l2))
      text += fmt::format(" and by {} in the relative L² norm from {} on",
                          percent_magnitude(all.l2), length(all.from));
  }
  return fmt::format("Against {}: {}.", curves.front().label, text);
}

/// Reads the curves of `runs`, the continuum first: the others are measured against it, wherever it
/// was named.
Comparison read_comparison(const std::vector<fs::path>& runs, FolderReader& reader) {
  std::vector<Curve> curves;
  for (const fs::path& run : runs)
    for (Curve& curve : read_curves(run, reader)) curves.push_back(std::move(curve));
  std::erase_if(curves, [](const Curve& curve) { return curve.response.empty(); });
  if (curves.size() < 2) {
    reader.throw_if_damaged();
    throw meshes::InvalidInput(meshes::Violation{"runs",
                                                 std::to_string(curves.size()) + " force curves",
                                                 "a comparison needs at least two force curves",
                                                 "name another run folder with a response.csv"});
  }
  std::ranges::stable_partition(
      curves, [](const Curve& curve) { return fs::exists(curve.folder / "job.json"); });
  make_unique(curves);
  give_styles(curves);
  return compare(std::move(curves));
}

/// The columns of a terminal's table.
std::string table_text(const Comparison& comparison) {
  constexpr std::size_t shown = 20;
  const std::vector<Curve>& curves = comparison.curves;
  std::string text = fmt::format("{:>12}{:>26}", shown_units().length.label("depth"),
                                 shown_units().force.label(curves.front().label.substr(0, shown)));
  for (std::size_t i = 1; i < curves.size(); ++i)
    text += fmt::format("{:>24}", curves[i].label.substr(0, shown));
  text += "\n";
  for (std::size_t d = 0; d < comparison.depths.size(); ++d) {
    text += fmt::format("{:12.4f}{:26.4f}", shown_units().length(comparison.depths[d]),
                        shown_units().force(comparison.rows[d].front().force.value));
    for (std::size_t i = 1; i < curves.size(); ++i) {
      const Compared& cell = comparison.rows[d][i];
      text +=
          fmt::format("{:>24}", std::isnan(cell.difference)
                                    ? std::string()
                                    : fmt::format("{}{:+.2f} %", cell.force.interpolated ? "~" : "",
                                                  100.0 * cell.difference));
    }
    text += "\n";
  }
  return text;
}

/// Lateral forces at displacements that every run has that moved on at full depth.
std::string lateral_text(const std::vector<Curve>& curves) {
  std::vector<const Curve*> sliding;
  for (const Curve& curve : curves)
    if (!curve.response.sliding().empty()) sliding.push_back(&curve);
  if (sliding.size() < 2) return {};
  std::string text = shown_units().force.label("lateral force at full depth") + "\n" +
                     fmt::format("{:>12}", shown_units().length.label("aside"));
  for (const Curve* curve : sliding) text += fmt::format("{:>24}", curve->label.substr(0, 23));
  text += "\n";
  for (const meshes::PressSample& wanted : sliding.front()->response.sliding()) {
    const double place = wanted.lateral_displacement;
    std::string row = fmt::format("{:12.4f}", shown_units().length(place));
    std::size_t found = 0;
    for (const Curve* curve : sliding)
      for (const meshes::PressSample& sample : curve->response.sliding())
        if (std::abs(sample.lateral_displacement - place) <= same_depth * std::abs(place)) {
          row += fmt::format("{:24.4f}", shown_units().force(sample.lateral_force_x));
          ++found;
        }
    if (found == sliding.size()) text += row + "\n";
  }
  return text;
}

std::string screen_text(const Comparison& comparison) {
  const std::vector<Curve>& curves = comparison.curves;
  std::string text = table_text(comparison);
  text += fmt::format("{:>38}", "relative L2 difference");
  for (std::size_t i = 1; i < curves.size(); ++i) {
    const double l2 = overall(curves[i], curves.front()).l2;
    text += fmt::format("{:>24}", std::isnan(l2) ? "-" : fmt::format("{:.2f} %", 100.0 * l2));
  }
  text += "\n";
  if (const std::string names = interpolated_curves(comparison); !names.empty())
    text += "~: interpolated between samples of " + names + "\n";
  text += lateral_text(curves);
  for (const ComparisonRemark& remark : comparison.remarks)
    text += (remark.meaningless ? "WARNING: " : "note: ") + remark.text + "\n";
  return text;
}

Page comparison_page(const Comparison& comparison, FolderReader& reader) {
  const std::vector<Curve>& curves = comparison.curves;
  Chapter chapter{"comparison", "Force against indentation", {}};
  for (const ComparisonRemark& remark : comparison.remarks)
    chapter.blocks.push_back(Paragraph{remark.meaningless ? "Not the same problem." : "Note.",
                                       remark.text, remark.meaningless});
  chapter.blocks.push_back(FigureBlock{{"comparison_force", 760, 460, 1, {force_panel(curves)}},
                                       "Normal force against indentation",
                                       "One curve per run, from its first sample to its last."});
  if (!comparison.depths.empty()) {
    chapter.blocks.push_back(
        FigureBlock{{"comparison_difference", 760, 360, 1, {difference_panel(comparison)}},
                    "Difference relative to the first run",
                    "At the depths of the table below."});
    chapter.blocks.push_back(difference_table(comparison));
  }
  const Panel lateral = lateral_panel(curves);
  if (!lateral.series.empty())
    chapter.blocks.push_back(FigureBlock{{"comparison_lateral", 760, 420, 1, {lateral}},
                                         "Lateral force against lateral displacement",
                                         "Of the runs whose plane moved on at full depth. The "
                                         "figures and numbers above end with the press."});
  Page page;
  page.title = fmt::format("Comparison of {} force curves", curves.size());
  page.subtitle = "Relative differences are against " + curves.front().label;
  const bool meaningless = std::ranges::any_of(comparison.remarks, &ComparisonRemark::meaningless);
  page.answer =
      (meaningless ? "Not the same problem, see below. " : "") + summary_sentence(comparison);
  page.chapters.push_back(std::move(chapter));
  std::vector<fs::path> folders;
  for (const Curve& curve : curves) folders.push_back(curve.folder);
  const std::vector<MovingPress> presses = moving_presses(folders, reader);
  page.chapters.push_back(reader.attempt([&] { return control_chapter(presses); }));
  page.damaged = damaged_parts(reader);
  return page;
}

}  // namespace

ComparisonResult write_comparison(const std::vector<fs::path>& runs, const fs::path& out_folder) {
  FolderReader reader;
  const Comparison comparison = read_comparison(runs, reader);
  const Page page = comparison_page(comparison, reader);
  fs::create_directories(out_folder);
  publish(page, out_folder, "comparison.html");
  write_csv(comparison, out_folder / "comparison.csv");
  return {screen_text(comparison), reader.damage()};
}

}  // namespace fingertip::studies
