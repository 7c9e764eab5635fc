/// Elastic constants: against direction, from the calibrations, on finite cubes.
#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "calibration/material/moduli.h"
#include "studies/report/chapters/models/model_chapters.h"
#include "studies/report/figure/modulus_surfaces.h"
#include "studies/report/page/words.h"

namespace fingertip::studies::report::inline chapters::inline models {
namespace {

using Eigen::Vector3d;

calibration::ElasticModuli cubic(const Moduli& moduli) {
  return cubic_material(moduli.E_100, moduli.nu_100, moduli.G);
}

/// E against direction in the plane of two unit vectors, as a closed curve around the origin.
template <class Modulus>
Series polar_series(const std::string& name, const Vector3d& right, const Vector3d& up,
                    const Modulus& modulus) {
  Series series{model_label(name), name, {}, {}, {}, model_style(name)};
  for (int degree = 0; degree <= 360; degree += 2) {
    const double angle = degree * std::numbers::pi / 180.0;
    const double E = shown_units().stress(modulus(std::cos(angle) * right + std::sin(angle) * up));
    series.x.push_back(E * std::cos(angle));
    series.y.push_back(E * std::sin(angle));
  }
  return series;
}

/// A spoke of the polar plot with its crystal direction at the end.
void add_spoke(Panel& panel, double degree, double length, const std::string& text) {
  const double x = length * std::cos(degree * std::numbers::pi / 180.0);
  const double y = length * std::sin(degree * std::numbers::pi / 180.0);
  panel.series.push_back(
      {"", "direction " + text, {0.0, x}, {0.0, y}, {}, {"#999999", "(2,3)", 0.8, 0, true}});
  panel.texts.push_back({1.12 * x, 1.12 * y, text});
}

Panel polar_panel(const RunData& run, const std::string& title, const Vector3d& right,
                  const Vector3d& up) {
  Panel panel;
  panel.title = title;
  panel.x_label = shown_units().stress.label("E · cos(angle)");
  panel.y_label = shown_units().stress.label("E · sin(angle)");
  panel.equal_scales = true;
  for (const ModelData& model : run.models) {
    if (!std::isfinite(model.moduli.E_100 + model.moduli.nu_100 + model.moduli.G)) continue;
    const calibration::ElasticModuli moduli = cubic(model.moduli);
    panel.series.push_back(polar_series(model.name, right, up, [&](const Vector3d& direction) {
      return calibration::youngs_modulus_along(moduli, direction);
    }));
  }
  // Last, to be seen on top of the models that reach it.
  const double target = run.target.youngs_modulus;
  panel.series.push_back(
      polar_series("reference", right, up, [&](const Vector3d&) { return target; }));
  panel.series.back().label = panel.series.back().key = "target";
  panel.series.back().style = {"#000000", "(1,3)", 2.0, 0, true};
  return panel;
}

Figure polar_figure(const RunData& run) {
  const Vector3d x = Vector3d::UnitX(), y = Vector3d::UnitY(), z = Vector3d::UnitZ();
  Panel cube_face = polar_panel(run, "(001) plane", x, y);
  Panel diagonal = polar_panel(run, "(1-10) plane", (x + y).normalized(), z);
  double most = 0.0;
  for (const Panel* panel : {&cube_face, &diagonal}) {
    for (const Series& series : panel->series) {
      for (std::size_t i = 0; i < series.x.size(); ++i)
        most = std::fmax(most, std::hypot(series.x[i], series.y[i]));
    }
  }
  const double spoke = 1.16 * most;  // ends outside of every curve
  for (const auto& [degree, text] : {std::pair{0.0, "[100]"}, {45.0, "[110]"}, {90.0, "[010]"}}) {
    add_spoke(cube_face, degree, spoke, text);
  }
  for (const auto& [degree, text] :
       {std::pair{0.0, "[110]"}, {35.264389682754654, "[111]"}, {90.0, "[001]"}}) {
    add_spoke(diagonal, degree, spoke, text);
  }
  for (Panel* panel : {&cube_face, &diagonal})
    panel->x_range = panel->y_range = Range{-1.45 * most, 1.45 * most};
  // Curves of other models fill each corner of a panel.
  Figure figure{"elastic_directions", 985, 450, 2, {}, 185};
  cube_face.key = figure.beside_panels();
  diagonal.key = "";
  figure.panels = {std::move(cube_face), std::move(diagonal)};
  return figure;
}

/// All directions at once; empty without models whose constants are known.
Figure surface_figure(const RunData& run) {
  std::vector<std::pair<std::string, calibration::ElasticModuli>> materials;
  for (const ModelData& model : run.models)
    materials.emplace_back(model_label(model.name), cubic(model.moduli));
  return modulus_surface_figure("elastic_surfaces", materials);
}

Table achieved_table(const RunData& run) {
  Table table;
  table.graded = true;
  table.header = {{"Constant", "", Grade::none}, {"Target", "", Grade::none}};
  for (const ModelData& model : run.models)
    table.header.push_back({model_label(model.name), "", Grade::none});
  struct Row {
    const char* name;
    double Moduli::*value;
    double Target::*target;
  };
  for (const Row& row :
       {Row{"E along [100]", &Moduli::E_100, &Target::youngs_modulus},
        {"E along [110]", &Moduli::E_110, &Target::youngs_modulus},
        {"E along [111]", &Moduli::E_111, &Target::youngs_modulus},
        {"Shear modulus G", &Moduli::G, &Target::shear_modulus},
        {"Poisson's ratio ν along [100]", &Moduli::nu_100, &Target::poissons_ratio},
        {"Bulk modulus K", &Moduli::K, &Target::bulk_modulus}}) {
    const bool ratio = row.value == &Moduli::nu_100;
    const double target = run.target.*row.target;
    const auto shown = [&](double value) {
      return ratio ? number(value) : number(shown_units().stress(value));
    };
    std::vector<Cell> cells{{row.name, "", Grade::none},
                            {shown(target), ratio ? "" : si_note(target, "Pa"), Grade::none}};
    for (const ModelData& model : run.models) {
      const double value = model.moduli.*row.value;
      const double error = value / target - 1.0;
      std::string si = ratio ? "" : si_note(value, "Pa");
      if (!si.empty()) si += ", ";
      cells.push_back({shown(value), si + percent(error), grade(error)});
    }
    table.rows.push_back(std::move(cells));
  }
  std::vector<Cell> anisotropy{{"Anisotropy A", "", Grade::none}, {"1", "", Grade::none}};
  for (const ModelData& model : run.models) {
    const double A = cubic(model.moduli).anisotropy;
    anisotropy.push_back({number(A), percent(A - 1.0), grade(A - 1.0)});
  }
  table.rows.push_back(std::move(anisotropy));
  return table;
}

/// "(0.62, −0.62, 0.47, 0)" for each direction the tests leave open, "–" when there is none.
std::string null_directions(const calibration::ModuliFile& calibration) {
  std::vector<std::string> directions;
  for (const calibration::OpenConstants& open : calibration.unidentifiable) {
    std::vector<std::string> parts;
    for (const double value : {open.k1, open.k2, open.k3, open.kappa})
      parts.push_back(std::abs(value) < 5e-4 ? "0" : number(value, 2));
    directions.push_back(fmt::format("({})", fmt::join(parts, ", ")));
  }
  return directions.empty() ? "–" : enumerate(directions);
}

Table spring_table(const RunData& run) {
  Table table;
  table.header = {{"Model", "", Grade::none},
                  plain("Spacing", unit_name(shown_units().length)),
                  {"k1", "axis", Grade::none},
                  {"k2", "face diagonal", Grade::none},
                  {"k3", "body diagonal", Grade::none},
                  {"κ", "volume", Grade::none},
                  {"Null direction", "(k1, k2, k3, κ)", Grade::none}};
  for (const ModelData& model : run.models) {
    const bool fitted = !model.calibration.empty();
    if (!fitted && model.summary.empty()) continue;
    const calibration::FitConstants& found = model.calibration.constants;
    const ConstantsEntry constants = fitted
                                         ? ConstantsEntry{found.k1, found.k2, found.k3, found.kappa}
                                         : model.summary.constants;
    const double spacing = fitted ? model.calibration.spacing : model.summary.spacing;
    std::vector<Cell> row{
        {model_label(model.name), fitted ? "fitted" : "rule k = E a²/l₀", Grade::none},
        {number(shown_units().length(spacing)), "", Grade::none}};
    for (const double value : {constants.k1, constants.k2, constants.k3})
      row.push_back({with_unit(value, shown_units().stiffness), "", Grade::none});
    row.push_back({with_unit(constants.kappa, shown_units().stress), "", Grade::none});
    row.push_back({null_directions(model.calibration), "", Grade::none});
    table.rows.push_back(std::move(row));
  }
  return table;
}

/// What the calibrations say of themselves.
WordList calibrations(const RunData& run) {
  WordList words;
  for (const ModelData& model : run.models) {
    if (model.calibration.empty()) continue;
    words.emplace_back()["model"] = model.name;
    words.back()["statement"] = as_shown(model.calibration.statement);
  }
  return words;
}

struct CubeColumn {
  double CubeRow::*value;
  const char* label;
};
constexpr CubeColumn cube_columns[] = {
    {&CubeRow::youngs_modulus_100, "E₁₀₀"}, {&CubeRow::youngs_modulus_110, "E₁₁₀"},
    {&CubeRow::youngs_modulus_111, "E₁₁₁"}, {&CubeRow::shear_modulus, "G"},
    {&CubeRow::poissons_ratio_100, "ν₁₀₀"}, {&CubeRow::bulk_modulus, "K"}};

Table cubes_table(const RunData& run) {
  Table table;
  table.header = {{"Model", "", Grade::none}, {"Cells across", "", Grade::none}};
  for (const CubeColumn& column : cube_columns)
    table.header.push_back({column.label, "", Grade::none});
  for (const CubeRow& cube : run.cubes) {
    std::vector<Cell> row{{cube.model, "", Grade::none},
                          {count(double(cube.cells_across)), "", Grade::none}};
    const ModelData* model = run.model(cube.model);
    const Moduli known = model ? model->moduli : Moduli();
    const double infinite[] = {known.E_100, known.E_110,  known.E_111,
                               known.G,     known.nu_100, known.K};
    for (std::size_t c = 0; c < std::size(cube_columns); ++c) {
      const double value = cube.*cube_columns[c].value;
      const bool ratio = c == 4;
      row.push_back({number(ratio ? value : shown_units().stress(value)),
                     percent(value / infinite[c] - 1.0), Grade::none});
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

Figure cubes_figure(const RunData& run) {
  Panel panel;
  panel.x_label = "cells across the cube";
  panel.y_label = shown_units().stress.label("E along [100]");
  panel.log_x = 2;
  panel.key = "top right";
  double least = 1e9, most = 1.0;
  std::map<std::string, Series> curves;
  for (const CubeRow& cube : run.cubes) {
    const std::string& name = cube.model;
    auto [curve, fresh] =
        curves.try_emplace(name, Series{model_label(name), name, {}, {}, {}, model_style(name)});
    curve->second.style.point = name == "published" ? 5 : name == "central" ? 9 : 7;
    curve->second.x.push_back(cube.cells_across);
    curve->second.y.push_back(shown_units().stress(cube.youngs_modulus_100));
    least = std::fmin(least, cube.cells_across), most = std::fmax(most, cube.cells_across);
  }
  for (auto& [name, curve] : curves) panel.series.push_back(std::move(curve));
  panel.x_range = Range{0.8 * least, 1.25 * most};
  panel.y_range = Range{0.0, meshes::unknown};
  return {"cubes", 760, 340, 1, {panel}};
}

}  // namespace

Chapter elasticity_chapter(const RunData& run) {
  if (run.models.empty()) return {};
  ChapterData chapter("elasticity");
  const double nu = run.target.poissons_ratio;
  const ModelData* central = run.model("central");
  const Moduli paid = central ? central->moduli : Moduli();
  chapter["nu"] = if_known(nu, number(nu));
  chapter["central_nu"] = if_known(paid.K, number(paid.nu_100));
  chapter["central_bulk"] = stress(paid.K);
  chapter["bulk"] = stress(run.target.bulk_modulus);
  chapter["calibrations"] = calibrations(run);
  chapter.figures = {polar_figure(run), surface_figure(run)};
  chapter.tables["achieved"] = achieved_table(run);
  chapter.tables["constants"] = spring_table(run);
  if (!run.cubes.empty()) chapter.figures.push_back(cubes_figure(run));
  chapter.tables["cubes"] = cubes_table(run);
  return written(std::move(chapter));
}

}  // namespace fingertip::studies::report::inline chapters::inline models
