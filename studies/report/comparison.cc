/// CurveForce curves of several runs against the first one.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ostream>

#include "meshes/tables/table_rows.h"
#include "studies/report/chapters/continuum/continuum_chapters.h"
#include "studies/report/chapters/models/model_chapters.h"
#include "studies/report/chapters/press/press_chapters.h"
#include "studies/report/page/words.h"
#include "studies/report/report.h"
#include "studies/report/report_parts.h"
#include "studies/report/results/comparison_data.h"
#include "studies/report/results/moving_press.h"

namespace fingertip::studies::report {
namespace {

namespace fs = std::filesystem;

void write_csv(const Comparison& comparison, const fs::path& file) {
  const std::vector<ComparedCurve>& curves = comparison.curves;
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
        const ComparedForce& cell = comparison.rows[d][i];
        out << ',' << meshes::to_text(cell.force.value);
        if (i > 0) out << ',' << meshes::to_text(cell.difference) << ',';
        if (i > 0 && std::isfinite(cell.force.value)) out << (cell.force.interpolated ? 1 : 0);
      }
      out << '\n';
    }
  });
}

/// What followed the first loading.
void write_following(const Comparison& comparison, const fs::path& file) {
  if (comparison.following.empty()) return;
  const std::vector<ComparedCurve>& curves = comparison.curves;
  meshes::write_atomically(file, [&](std::ostream& out) {
    out << "stage,time [s],indentation [m]";
    for (std::size_t i = 0; i < curves.size(); ++i) {
      out << ',' << meshes::csv_cell(curves[i].label + " normal_force [N]");
      if (i > 0) out << ',' << meshes::csv_cell(curves[i].label + " relative_difference");
    }
    out << '\n';
    for (const FollowingRow& row : comparison.following) {
      out << meshes::to_text(row.stage) << ',' << meshes::to_text(row.time) << ','
          << meshes::to_text(row.indentation);
      for (std::size_t i = 0; i < curves.size(); ++i) {
        out << ',' << meshes::to_text(row.forces[i].force.value);
        if (i > 0) out << ',' << meshes::to_text(row.forces[i].difference);
      }
      out << '\n';
    }
  });
}

/// Forces in time of those that have both, from the end of the first loading on.
Panel following_panel(const Comparison& comparison) {
  Panel panel;
  panel.x_label = "time since the end of the first loading [s]";
  panel.y_label = shown_units().force.label("normal force");
  panel.key = "outside top center horizontal";
  for (const ComparedCurve& curve : comparison.curves) {
    const auto following = curve.response.following();
    if (following.empty() || std::isnan(following.front().time)) continue;
    const meshes::PressSample& begin = curve.response.pressing().back();
    Series series{curve.label, "",         {0.0}, {shown_units().force(begin.normal_force)},
                  {},          curve.style};
    for (const meshes::PressSample& sample : following) {
      series.x.push_back(sample.time - begin.time);
      series.y.push_back(shown_units().force(sample.normal_force));
    }
    panel.series.push_back(std::move(series));
  }
  return panel;
}

/// What lies between the samples is what forces are compared by there; chords would lie above it.
void draw_monotone(Series& series, const meshes::PressResponse& response) {
  constexpr int steps = 200;
  const double first = std::max(0.0, response.pressing().front().indentation),
               last = response.depth();
  for (int i = 0; i <= steps; ++i) {
    const double depth = std::min(last, first + (last - first) * i / steps);
    series.line_x.push_back(shown_units().length(depth));
    series.line_y.push_back(shown_units().force(response.normal_force_at(depth)));
  }
}

Panel force_panel(const std::vector<ComparedCurve>& curves) {
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
    draw_monotone(series, curves[i].response);
    panel.series.push_back(std::move(series));
  }
  return panel;
}

/// The lateral motions that followed presses; without series when none did.
Panel lateral_panel(const std::vector<ComparedCurve>& curves) {
  Panel panel;
  panel.x_label = shown_units().length.label("lateral displacement");
  panel.y_label = shown_units().force.label("lateral force");
  panel.key = "outside top center horizontal";
  for (const ComparedCurve& curve : curves) {
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
  const std::vector<ComparedCurve>& curves = comparison.curves;
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

Table difference_table(const Comparison& comparison) {
  const std::vector<ComparedCurve>& curves = comparison.curves;
  Table table;
  table.graded = std::ranges::none_of(comparison.remarks, &ComparisonRemark::meaningless);
  table.header = {plain("Indentation", unit_name(shown_units().length))};
  for (const ComparedCurve& curve : curves) table.header.push_back({curve.label, "", Grade::none});
  for (std::size_t d = 0; d < comparison.depths.size(); ++d) {
    std::vector<Cell> row{
        {fmt::format("{:.4g}", shown_units().length(comparison.depths[d])), "", Grade::none}};
    for (std::size_t i = 0; i < curves.size(); ++i) {
      const ComparedForce& cell = comparison.rows[d][i];
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
  const std::vector<ComparedCurve>& curves = comparison.curves;
  WordList others;
  for (std::size_t i = 1; i < curves.size(); ++i) {
    Words& words = others.emplace_back();
    words["next"] = i > 1;
    words["label"] = curves[i].label;
    words["difference"] = words["depth"] = words["l2"] = words["from"] = "";
    std::size_t last = comparison.depths.size();
    while (last > 0 && std::isnan(comparison.rows[last - 1][i].difference)) --last;
    if (last == 0) continue;
    words["difference"] = percent(comparison.rows[last - 1][i].difference);
    words["depth"] = length(comparison.depths[last - 1]);
    const OverallDifference all = overall(curves[i], curves.front());
    words["l2"] = if_known(all.l2, percent_magnitude(all.l2));
    words["from"] = length(all.from);
  }
  Words words;
  words["meaningless"] = std::ranges::any_of(comparison.remarks, &ComparisonRemark::meaningless);
  words["first"] = curves.front().label;
  words["curves"] = std::move(others);
  return sentences("answer_comparison", words);
}

/// The columns of a terminal's table.
std::string table_text(const Comparison& comparison) {
  constexpr std::size_t shown = 20;
  const std::vector<ComparedCurve>& curves = comparison.curves;
  std::string text = fmt::format("{:>12}{:>26}", shown_units().length.label("depth"),
                                 shown_units().force.label(curves.front().label.substr(0, shown)));
  for (std::size_t i = 1; i < curves.size(); ++i)
    text += fmt::format("{:>24}", curves[i].label.substr(0, shown));
  text += "\n";
  for (std::size_t d = 0; d < comparison.depths.size(); ++d) {
    text += fmt::format("{:>12}{:>26}", shown_units().length.decimals(comparison.depths[d]),
                        shown_units().force.decimals(comparison.rows[d].front().force.value));
    for (std::size_t i = 1; i < curves.size(); ++i) {
      const ComparedForce& cell = comparison.rows[d][i];
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
std::string lateral_text(const std::vector<ComparedCurve>& curves) {
  std::vector<const ComparedCurve*> sliding;
  for (const ComparedCurve& curve : curves)
    if (!curve.response.sliding().empty()) sliding.push_back(&curve);
  if (sliding.size() < 2) return {};
  std::string text = shown_units().force.label("lateral force at full depth") + "\n" +
                     fmt::format("{:>12}", shown_units().length.label("lateral"));
  for (const ComparedCurve* curve : sliding)
    text += fmt::format("{:>24}", curve->label.substr(0, 23));
  text += "\n";
  for (const meshes::PressSample& wanted : sliding.front()->response.sliding()) {
    const double place = wanted.lateral_displacement;
    std::string row = fmt::format("{:>12}", shown_units().length.decimals(place));
    std::size_t found = 0;
    for (const ComparedCurve* curve : sliding)
      for (const meshes::PressSample& sample : curve->response.sliding())
        if (std::abs(sample.lateral_displacement - place) <= rounding_of_depths * std::abs(place)) {
          row += fmt::format("{:>24}", shown_units().force.decimals(sample.lateral_force_x));
          ++found;
        }
    if (found == sliding.size()) text += row + "\n";
  }
  return text;
}

/// What followed the first loading, moment by moment.
std::string following_text(const Comparison& comparison) {
  const std::vector<ComparedCurve>& curves = comparison.curves;
  if (comparison.following.empty()) return {};
  std::string text = fmt::format("after the first loading\n{:>6}{:>12}{:>14}{:>24}", "stage",
                                 "time [s]", shown_units().length.label("depth"),
                                 shown_units().force.label(curves.front().label.substr(0, 18)));
  for (std::size_t i = 1; i < curves.size(); ++i)
    text += fmt::format("{:>24}", curves[i].label.substr(0, 20));
  text += "\n";
  for (const FollowingRow& row : comparison.following) {
    text += fmt::format("{:>6}{:>12}{:>14}{:>24}", row.stage,
                        std::isnan(row.time) ? "" : fmt::format("{:.4f}", row.time),
                        shown_units().length.decimals(row.indentation),
                        shown_units().force.decimals(row.forces.front().force.value));
    for (std::size_t i = 1; i < curves.size(); ++i) {
      const double difference = row.forces[i].difference;
      text += fmt::format("{:>24}", std::isnan(difference)
                                        ? std::string()
                                        : fmt::format("{:+.2f} %", 100.0 * difference));
    }
    text += "\n";
  }
  return text;
}

/// "press: the fit failed its own tests: ..."
std::vector<std::string> rejected_curves(const Comparison& comparison) {
  std::vector<std::string> found;
  for (const ComparedCurve& curve : comparison.curves)
    for (const std::string& reason : curve.rejected) found.push_back(curve.label + ": " + reason);
  return found;
}

std::string screen_text(const Comparison& comparison) {
  const std::vector<ComparedCurve>& curves = comparison.curves;
  std::string text;
  for (const std::string& reason : rejected_curves(comparison))
    text += "NOT ACCEPTED: " + in_shown_units(reason, Spelling::terminal) + "\n";
  text += table_text(comparison);
  text += fmt::format("{:>38}", "relative L2 difference");
  for (std::size_t i = 1; i < curves.size(); ++i) {
    const double l2 = overall(curves[i], curves.front()).l2;
    text += fmt::format("{:>24}", std::isnan(l2) ? "-" : fmt::format("{:.2f} %", 100.0 * l2));
  }
  text += "\n";
  if (const std::string names = interpolated_curves(comparison); !names.empty())
    text += "~: interpolated between samples of " + names + "\n";
  text += lateral_text(curves);
  text += following_text(comparison);
  for (const ComparisonRemark& remark : comparison.remarks)
    text += (remark.meaningless ? "WARNING: " : "note: ") + remark.text + "\n";
  return text;
}

Page comparison_page(const Comparison& comparison, FolderReader& reader) {
  const std::vector<ComparedCurve>& curves = comparison.curves;
  WordList remarks;
  for (const ComparisonRemark& remark : comparison.remarks) {
    remarks.emplace_back()["meaningless"] = remark.meaningless;
    remarks.back()["text"] = remark.text;
  }
  ChapterData chapter("comparison");
  chapter["remarks"] = std::move(remarks);
  chapter["first"] = curves.front().label;
  chapter["interpolated"] = interpolated_curves(comparison);
  chapter.figures = {{"comparison_force", 760, 460, 1, {force_panel(curves)}}};
  if (!comparison.depths.empty())
    chapter.figures.push_back(
        {"comparison_difference", 760, 360, 1, {difference_panel(comparison)}});
  chapter.tables["differences"] = difference_table(comparison);
  if (const Panel lateral = lateral_panel(curves); !lateral.series.empty())
    chapter.figures.push_back({"comparison_lateral", 760, 420, 1, {lateral}});
  if (const Panel following = following_panel(comparison); following.series.size() > 1)
    chapter.figures.push_back({"comparison_time", 760, 420, 1, {following}});
  Page page;
  page.title = fmt::format("Comparison of {} force curves", curves.size());
  page.subtitle = "Relative differences are against " + curves.front().label;
  for (const std::string& reason : rejected_curves(comparison))
    page.rejected.push_back(as_shown(reason));
  page.answer = summary_sentence(comparison);
  page.chapters.push_back(written(std::move(chapter)));
  std::vector<fs::path> folders;
  for (const ComparedCurve& curve : curves) folders.push_back(curve.folder);
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
  write_following(comparison, out_folder / "comparison_following.csv");
  return {screen_text(comparison), reader.damage()};
}

}  // namespace fingertip::studies::report
