/// Force curves of several runs against the first one.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ostream>
#include <set>

#include "meshes/errors.h"
#include "meshes/files.h"
#include "studies/report/document.h"
#include "studies/report/moving_press.h"
#include "studies/report/report.h"
#include "studies/report/run_data.h"

namespace fingertip::studies {
namespace {

using namespace reporting;
namespace fs = std::filesystem;

struct Curve {
  std::string label;
  std::string model;  ///< name of the folder, perhaps that of a model
  meshes::PressResponse response;
  Style style;

  double force_at(double depth) const { return reporting::force_at(response, depth); }
};

/// The folder's name, also when the path ends in a slash or is ".".
std::string folder_name(const fs::path& folder) {
  const fs::path full = fs::weakly_canonical(folder);
  return full.has_filename() ? full.filename().string() : full.parent_path().filename().string();
}

std::vector<Curve> read_curves(const fs::path& folder) {
  const std::string label = folder_name(folder);
  if (fs::exists(folder / "response.csv")) {
    return {{label, label, meshes::PressResponse::read_csv(folder / "response.csv"), {}}};
  }
  std::vector<Curve> curves;
  for (const std::string name : {"reference", "published", "central", "hookean"}) {
    const fs::path file = folder / name / "response.csv";
    if (fs::exists(file))
      curves.push_back({label + "/" + name, name, meshes::PressResponse::read_csv(file), {}});
  }
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

double difference(const Curve& curve, const Curve& first, double depth) {
  return curve.force_at(depth) / first.force_at(depth) - 1.0;
}

void write_csv(const std::vector<Curve>& curves, const fs::path& file) {
  meshes::write_atomically(file, [&](std::ostream& out) {
    out << "indentation [m]";
    for (std::size_t i = 0; i < curves.size(); ++i) {
      out << ',' << csv_cell(curves[i].label + " normal_force [N]");
      if (i > 0) out << ',' << csv_cell(curves[i].label + " relative_difference");
    }
    out << '\n';
    for (const meshes::PressSample& sample : curves.front().response.samples()) {
      out << meshes::to_text(sample.indentation);
      for (std::size_t i = 0; i < curves.size(); ++i) {
        out << ',' << meshes::to_text(curves[i].force_at(sample.indentation));
        if (i > 0)
          out << ',' << meshes::to_text(difference(curves[i], curves.front(), sample.indentation));
      }
      out << '\n';
    }
  });
}

Panel force_panel(const std::vector<Curve>& curves) {
  Panel panel;
  panel.x_label = "indentation [cm]";
  panel.y_label = "normal force [gf]";
  for (std::size_t i = 0; i < curves.size(); ++i) {
    Series series{curves[i].label, "", {0.0}, {0.0}, {}, curves[i].style};
    for (const meshes::PressSample& sample : curves[i].response.samples()) {
      series.x.push_back(to_cm(sample.indentation));
      series.y.push_back(to_gf(sample.normal_force));
    }
    panel.series.push_back(std::move(series));
  }
  return panel;
}

Panel difference_panel(const std::vector<Curve>& curves) {
  Panel panel;
  panel.x_label = "indentation [cm]";
  panel.y_label = "relative difference [%]";
  panel.key = "outside top center horizontal";
  for (std::size_t i = 1; i < curves.size(); ++i) {
    Series series{curves[i].label, "", {}, {}, {}, curves[i].style};
    for (const meshes::PressSample& sample : curves.front().response.samples()) {
      series.x.push_back(to_cm(sample.indentation));
      series.y.push_back(100.0 * difference(curves[i], curves.front(), sample.indentation));
    }
    panel.series.push_back(std::move(series));
  }
  return panel;
}

Table difference_table(const std::vector<Curve>& curves) {
  Table table;
  table.caption =
      fmt::format("Normal force in gf, and its difference from {} below, at the samples of {}.",
                  curves.front().label, curves.front().label);
  table.graded = true;
  table.header = {{"Indentation", "cm", Grade::none}};
  for (const Curve& curve : curves) table.header.push_back({curve.label, "", Grade::none});
  for (const meshes::PressSample& sample : curves.front().response.samples()) {
    const double depth = sample.indentation;
    std::vector<Cell> row{{fmt::format("{:.4g}", to_cm(depth)), "", Grade::none}};
    for (const Curve& curve : curves) {
      if (&curve == &curves.front()) {
        row.push_back({number(to_gf(sample.normal_force)), with_prefix(sample.normal_force, "N"),
                       Grade::none});
        continue;
      }
      const double d = difference(curve, curves.front(), depth);
      row.push_back({number(to_gf(curve.force_at(depth))), percent(d), grade(d)});
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

/// Those of the runs that are presses in time.
std::vector<MovingPress> moving_presses(const std::vector<fs::path>& runs) {
  std::vector<MovingPress> presses;
  for (const fs::path& run : runs) {
    if (!fs::exists(run / "trace.csv")) continue;
    MovingPress press = read_moving_press(run, folder_name(run));
    press.style = numbered_style(presses.size());
    press.style.point = 0;
    presses.push_back(std::move(press));
  }
  return presses;
}

/// The largest difference and the relative L² difference over the common depth.
std::string summary_sentence(const std::vector<Curve>& curves) {
  std::string text = fmt::format("Against {}: ", curves.front().label);
  for (std::size_t i = 1; i < curves.size(); ++i) {
    const double to = std::min(curves[i].response.depth(), curves.front().response.depth());
    const double l2 =
        meshes::relative_l2_force_error(curves[i].response, curves.front().response, 0.0, to);
    text += fmt::format("{}{} differs by {} in the relative L² norm and by {} at {}",
                        i > 1 ? "; " : "", curves[i].label, percent_magnitude(l2),
                        percent(difference(curves[i], curves.front(), to)), length(to));
  }
  return text + ".";
}

}  // namespace

void write_comparison(const std::vector<fs::path>& runs, const fs::path& out_folder) {
  std::vector<Curve> curves;
  for (const fs::path& run : runs) {
    for (Curve& curve : read_curves(run)) curves.push_back(std::move(curve));
  }
  std::erase_if(curves, [](const Curve& curve) { return curve.response.empty(); });
  if (curves.size() < 2) {
    throw meshes::InvalidInput(meshes::Violation{"runs",
                                                 std::to_string(curves.size()) + " force curves",
                                                 "a comparison needs at least two force curves",
                                                 "name another run folder with a response.csv"});
  }
  make_unique(curves);
  give_styles(curves);
  Chapter chapter{"comparison", "Force against indentation", {}};
  chapter.blocks.push_back(FigureBlock{{"comparison_force", 760, 460, 1, {force_panel(curves)}},
                                       "Normal force against indentation",
                                       "One curve per run."});
  chapter.blocks.push_back(
      FigureBlock{{"comparison_difference", 760, 360, 1, {difference_panel(curves)}},
                  "Difference relative to the first run",
                  "At the samples of the first run; other curves are interpolated monotonically."});
  chapter.blocks.push_back(difference_table(curves));
  Page page;
  page.title = fmt::format("Comparison of {} force curves", curves.size());
  page.subtitle = "Relative differences are against " + curves.front().label;
  page.answer = summary_sentence(curves);
  page.chapters.push_back(std::move(chapter));
  page.chapters.push_back(control_chapter(moving_presses(runs)));
  fs::create_directories(out_folder);
  publish(page, out_folder, "comparison.html");
  write_csv(curves, out_folder / "comparison.csv");
}

}  // namespace fingertip::studies
