/// Force curves of several runs against the first one.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <ostream>
#include <utility>

#include "meshes/tables/table_rows.h"
#include "studies/report/chapters/press/press_chapters.h"
#include "studies/report/page/terminal.h"
#include "studies/report/page/words.h"
#include "studies/report/report.h"
#include "studies/report/report_parts.h"
#include "studies/report/results/comparison_data.h"
#include "studies/report/results/moving_press.h"

namespace fingertip::studies::report {
namespace {

namespace fs = std::filesystem;

using Cells = std::vector<std::string>;

/// Columns of each curve, of the first one's force alone: its name before each of `titles`; then
/// the errors of all.
Cells with_curves(Cells heads, const Comparison& comparison, const Cells& titles) {
  const auto add = [&heads](const ComparedCurve& curve, const std::string& title) {
    heads.push_back(meshes::csv_cell(curve.label + " " + title));
  };
  for (const ComparedCurve& curve : comparison.curves)
    for (const std::string& title : titles) {
      add(curve, title);
      if (&curve == &comparison.curves.front()) break;
    }
  for (const ComparedCurve& curve : comparison.curves) add(curve, "force_error [N]");
  return heads;
}

/// Force and difference of every curve, of the first one the force alone; then the errors of all.
Cells with_forces(Cells cells, const std::vector<ComparedForce>& forces, bool tell_interpolated) {
  for (const ComparedForce& force : forces) {
    cells.push_back(meshes::to_text(force.force.value));
    if (&force == &forces.front()) continue;
    cells.push_back(meshes::to_text(force.difference));
    if (tell_interpolated)
      cells.push_back(if_known(force.force.value, force.force.interpolated ? "1" : "0"));
  }
  for (const ComparedForce& force : forces)
    cells.push_back(if_known(force.force.error, meshes::to_text(force.force.error)));
  return cells;
}

/// No file without a row, nor an older one.
void write_lines(const std::vector<Cells>& lines, const fs::path& file) {
  if (lines.size() < 2) {
    fs::remove(file);
    return;
  }
  meshes::write_atomically(file, [&](std::ostream& out) {
    for (const Cells& cells : lines) out << fmt::format("{}\n", fmt::join(cells, ","));
  });
}

void write_csv(const Comparison& comparison, const fs::path& file) {
  std::vector<Cells> lines{
      with_curves({"indentation [m]"}, comparison,
                  {"normal_force [N]", "relative_difference", "interpolated"})};
  for (std::size_t d = 0; d < comparison.depths.size(); ++d)
    lines.push_back(with_forces({meshes::to_text(comparison.depths[d])}, comparison.rows[d], true));
  write_lines(lines, file);
}

/// What followed the first loading.
void write_following(const Comparison& comparison, const fs::path& file) {
  std::vector<Cells> lines{with_curves({"stage", "time [s]", "indentation [m]"}, comparison,
                                       {"normal_force [N]", "relative_difference"})};
  for (const FollowingRow& row : comparison.following)
    lines.push_back(with_forces(
        {meshes::to_text(row.stage), meshes::to_text(row.time), meshes::to_text(row.indentation)},
        row.forces, false));
  write_lines(lines, file);
}

/// Forces in time of those that have both, from the end of the first loading on.
Panel following_panel(const Comparison& comparison) {
  const ShownUnit& force = shown_units().force;
  Panel panel{.x_label = "time since the end of the first loading [s]",
              .y_label = force.label("normal force"),
              .key = above};
  for (const ComparedCurve& curve : comparison.curves) {
    const auto following = curve.response.following();
    if (following.empty() || std::isnan(following.front().time)) continue;
    const meshes::PressSample& begin = curve.response.pressing().back();
    Series series{curve.label, "", curve.style, {0.0}, {force(begin.normal_force)}};
    for (const meshes::PressSample& sample : following)
      series.add(sample.time - begin.time, force(sample.normal_force));
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
  Panel panel = over_indentation(shown_units().force.label("normal force"), above);
  for (const ComparedCurve& curve : curves) {
    panel.series.push_back(force_curve(curve.label, "", curve.style, curve.response.pressing()));
    draw_monotone(panel.series.back(), curve.response);
  }
  return panel;
}

std::vector<RunContact> runs_of(const Comparison& comparison) {
  std::vector<RunContact> runs;
  for (const ComparedCurve& curve : comparison.curves)
    runs.push_back(
        {curve.label, curve.style, &curve.response, &curve.contact, nullptr, &curve.markers});
  return runs;
}

/// What the errors of both leave open of a difference, of one of them where the other is unknown;
/// no bar where both are.
double error_of_difference(const std::vector<ComparedForce>& forces, std::size_t curve) {
  const CurveForce &own = forces[curve].force, &first = forces.front().force;
  const auto relative = [](const CurveForce& force) { return force.error / std::abs(force.value); };
  const double a = relative(own), b = relative(first);
  return std::abs(own.value / first.value) * (std::isnan(a) ? b : std::isnan(b) ? a : a + b);
}

Panel difference_panel(const Comparison& comparison) {
  Panel panel = over_indentation("relative difference [%]", above);
  for (std::size_t i = 1; i < comparison.curves.size(); ++i) {
    Series series{comparison.curves[i].label, "", comparison.curves[i].style};
    for (std::size_t d = 0; d < comparison.depths.size(); ++d)
      if (const double difference = comparison.rows[d][i].difference; !std::isnan(difference)) {
        series.add(shown_units().length(comparison.depths[d]), 100.0 * difference);
        series.error.push_back(100.0 * error_of_difference(comparison.rows[d], i));
      }
    panel.series.push_back(std::move(series));
  }
  return panel;
}

/// A force with its error, from the second on with its difference from the first.
void add_forces(std::vector<Cell>& row, const std::vector<ComparedForce>& forces, bool graded) {
  const ShownUnit& unit = shown_units().force;
  for (const ComparedForce& force : forces) {
    Cell& cell = row.emplace_back();
    if (std::isnan(force.force.value)) continue;
    cell = amount_cell(force.force.value, unit, force.force.error);
    if (&force == &forces.front()) continue;
    if (force.force.interpolated) cell.text.insert(0, "≈ ");
    cell.note = percent(force.difference);
    if (graded) cell.grade = grade(force.difference);
  }
}

Table difference_table(const Comparison& comparison) {
  Table table{heads({"Indentation\n" + unit_name(shown_units().length)}),
              std::ranges::none_of(comparison.remarks, &ComparisonRemark::meaningless)};
  for (const ComparedCurve& curve : comparison.curves) table.header.emplace_back(curve.label);
  for (std::size_t d = 0; d < comparison.depths.size(); ++d) {
    table.rows.push_back({fmt::format("{:.4g}", shown_units().length(comparison.depths[d]))});
    add_forces(table.rows.back(), comparison.rows[d], table.graded);
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
    TemplateData& words = others.emplace_back();
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
  TemplateData words;
  words["meaningless"] = std::ranges::any_of(comparison.remarks, &ComparisonRemark::meaningless);
  words["first"] = curves.front().label;
  words["curves"] = std::move(others);
  return sentences("answer_comparison", words);
}

/// Loads at poses that every run has whose plane moved on at one depth.
Table motion_table(const std::vector<RunContact>& runs, const PlaneMotion& motion) {
  Table table{heads({std::string(motion.way.title) + "\n" + unit_name(motion.way.unit)})};
  std::vector<std::pair<const RunContact*, SampleRange>> moved;
  for (const RunContact& run : runs)
    if (const auto samples = moved_along_plane(*run.response); makes(samples, motion))
      moved.emplace_back(&run, samples.subspan(1));
  if (moved.size() < 2) return table;
  for (const auto& [run, samples] : moved) table.header.emplace_back(run->label);
  for (const meshes::PressSample& wanted : moved.front().second) {
    std::vector<Cell> row{number(motion.way.unit(wanted.*motion.way.value))};
    for (const auto& [run, samples] : moved)
      if (const auto found = std::ranges::find_if(
              samples, [&](const meshes::PressSample& sample) { return wanted.is_beside(sample); });
          found != samples.end())
        row.emplace_back(number(motion.load.unit((*found).*motion.load.value)));
    if (row.size() == table.header.size()) table.rows.push_back(std::move(row));
  }
  return table;
}

/// What followed the first loading, moment by moment.
Table following_table(const Comparison& comparison) {
  const ShownUnit& length = shown_units().length;
  Table table{heads({"Stage", "Time\ns", "Indentation\n" + unit_name(length)})};
  for (const ComparedCurve& curve : comparison.curves)
    table.header.emplace_back(curve.label, unit_name(shown_units().force));
  for (const FollowingRow& row : comparison.following) {
    table.rows.push_back(
        {number(row.stage), number(row.time), fmt::format("{:.4g}", length(row.indentation))});
    add_forces(table.rows.back(), row.forces, false);
  }
  return table;
}

/// "press: the fit failed its own tests: ..."
std::vector<std::string> rejected_curves(const Comparison& comparison) {
  std::vector<std::string> found;
  for (const ComparedCurve& curve : comparison.curves)
    for (const std::string& reason : curve.rejected) found.push_back(curve.label + ": " + reason);
  return found;
}

std::string screen_text(const Comparison& comparison, const std::vector<Chapter>& chapters) {
  const std::vector<ComparedCurve>& curves = comparison.curves;
  std::string text;
  for (const std::string& reason : rejected_curves(comparison))
    text += "NOT ACCEPTED: " + in_shown_units(reason, Spelling::terminal) + "\n";
  text += tables_text(chapters.front(), {"differences"});
  for (std::size_t i = 1; i < curves.size(); ++i)
    if (const double l2 = overall(curves[i], curves.front()).l2; !std::isnan(l2))
      text += fmt::format("relative L2 difference of {}: {:.2f} %\n", curves[i].label, 100.0 * l2);
  for (const Chapter& chapter : chapters) text += tables_text(chapter, {"contact", "markers"});
  const std::vector<RunContact> runs = runs_of(comparison);
  for (const PlaneMotion& motion : motions_of(runs))
    if (const Table table = motion_table(runs, motion); !table.rows.empty())
      text += motion.load.label(" at full depth") + "\n" + table_text(table);
  const Table following = following_table(comparison);
  if (!following.rows.empty()) text += "after the first loading\n" + table_text(following);
  for (const ComparisonRemark& remark : comparison.remarks)
    text += (remark.meaningless ? "WARNING: " : "note: ") + remark.text + "\n";
  return text;
}

/// A row per depth, of each run but the first a column per difference.
void write_contacts(const ContactComparison& contacts, const fs::path& file) {
  if (contacts.runs.size() < 2) return write_lines({}, file);
  using meshes::ContactDifference;
  constexpr std::array<std::pair<const char*, double ContactDifference::*>, 6> columns{
      {{"pressure_l2", &ContactDifference::pressure_l2},
       {"shear_l2", &ContactDifference::shear_l2},
       {"largest_pressure", &ContactDifference::peak},
       {"radius", &ContactDifference::radius},
       {"spread", &ContactDifference::spread},
       {"centre [m]", &ContactDifference::centre}}};
  std::vector<Cells> lines{{"indentation [m]"}};
  for (std::size_t i = 1; i < contacts.runs.size(); ++i)
    for (const auto& [name, value] : columns)
      lines.front().push_back(meshes::csv_cell(contacts.runs[i].label + " " + name));
  for (const ContactsAtDepth& here : contacts.depths) {
    Cells& cells = lines.emplace_back(Cells{meshes::to_text(here.depth)});
    for (std::size_t i = 1; i < contacts.runs.size(); ++i) {
      const ContactDifference difference = here.difference(i);
      for (const auto& [name, value] : columns) cells.push_back(meshes::to_text(difference.*value));
    }
  }
  write_lines(lines, file);
}

/// A row per sample, of each run the displacements, from the second on their differences.
void write_markers(const MarkerComparison& markers, const fs::path& file) {
  if (markers.runs.size() < 2) return write_lines({}, file);
  std::vector<Cells> lines{{"indentation [m]", "sample"}};
  const auto head = [&](const RunContact& run, const char* what) {
    lines.front().push_back(meshes::csv_cell(run.label + " " + what));
  };
  for (const RunContact& run : markers.runs) {
    for (const char* what : {"rms [m]", "largest [m]", "error [m]"}) head(run, what);
    if (&run == &markers.runs.front()) continue;
    for (const char* what : {"difference [m]", "largest_difference [m]", "marker",
                             "difference_error [m]", "relative_difference", "relative_error"})
      head(run, what);
  }
  for (const MarkersAtSample& here : markers.samples) {
    Cells& cells =
        lines.emplace_back(Cells{meshes::to_text(here.indentation), std::to_string(here.sample)});
    const auto put = [&](std::initializer_list<double> values) {
      for (const double value : values) cells.push_back(if_known(value, meshes::to_text(value)));
    };
    for (std::size_t run = 0; run < markers.runs.size(); ++run) {
      const meshes::MarkerLengths own = meshes::marker_lengths(here.fields[run]);
      put({own.rms, own.largest, own.error});
      if (run == 0) continue;
      const meshes::MarkerLengths off = here.difference(run);
      put({off.rms, off.largest, here.differences[run].empty() ? meshes::unknown : off.marker,
           off.error, here.relative(run), here.relative_error(run)});
    }
  }
  write_lines(lines, file);
}

Page comparison_page(const Comparison& comparison, const ContactComparison& contacts,
                     const MarkerComparison& markers, FolderReader& reader) {
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
  append_motions(runs_of(comparison), "comparison_lateral", "comparison_twist", chapter.figures);
  if (const Panel following = following_panel(comparison); following.series.size() > 1)
    chapter.figures.push_back({"comparison_time", 760, 420, 1, {following}});
  Page page;
  page.title = fmt::format("Comparison of {} force curves", curves.size());
  page.subtitle = "Relative differences are against " + curves.front().label;
  for (const std::string& reason : rejected_curves(comparison))
    page.rejected.push_back(as_shown(reason));
  page.answer = summary_sentence(comparison);
  page.chapters.push_back(written(std::move(chapter)));
  page.chapters.push_back(reader.attempt([&] { return contact_chapter(contacts); }));
  if (markers.runs.size() > 1)
    page.chapters.push_back(reader.attempt([&] { return marker_chapter(markers); }));
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
  const ContactComparison contacts = compared_contacts(runs_of(comparison));
  const MarkerComparison markers = compared_markers(runs_of(comparison));
  const Page page = comparison_page(comparison, contacts, markers, reader);
  fs::create_directories(out_folder);
  publish(page, out_folder, "comparison.html");
  write_csv(comparison, out_folder / "comparison.csv");
  write_following(comparison, out_folder / "comparison_following.csv");
  write_contacts(contacts, out_folder / "comparison_contact.csv");
  write_markers(markers, out_folder / "comparison_markers.csv");
  return {screen_text(comparison, page.chapters), reader.damage()};
}

}  // namespace fingertip::studies::report
