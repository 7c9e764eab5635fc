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

calibration::ElasticModuli cubic(const ModuliEntry& moduli) {
  return cubic_material(moduli.E_100, moduli.nu_100, moduli.G);
}

/// E against direction in the plane of two unit vectors, as a closed curve around the origin.
template <class Modulus>
Series polar_series(const std::string& label, const std::string& key, const Style& style,
                    const Vector3d& right, const Vector3d& up, const Modulus& modulus) {
  Series series{label, key, style};
  for (int degree = 0; degree <= 360; degree += 2) {
    const double angle = degree * std::numbers::pi / 180.0;
    const double E = shown_units().stress(modulus(std::cos(angle) * right + std::sin(angle) * up));
    series.add(E * std::cos(angle), E * std::sin(angle));
  }
  return series;
}

/// A spoke of the polar plot with its crystal direction at the end.
void add_spoke(Panel& panel, double degree, double length, const std::string& text) {
  const double x = length * std::cos(degree * std::numbers::pi / 180.0);
  const double y = length * std::sin(degree * std::numbers::pi / 180.0);
  panel.series.push_back({"", "direction " + text, {"#999999", "(2,3)", 0.8}, {0.0, x}, {0.0, y}});
  panel.texts.push_back({1.12 * x, 1.12 * y, text});
}

Panel polar_panel(const RunData& run, const std::string& title, const Vector3d& right,
                  const Vector3d& up) {
  Panel panel{.title = title,
              .x_label = shown_units().stress.label("E · cos(angle)"),
              .y_label = shown_units().stress.label("E · sin(angle)"),
              .equal_scales = true};
  for (const ModelData& model : run.models) {
    if (!std::isfinite(model.moduli.E_100 + model.moduli.nu_100 + model.moduli.G)) continue;
    const calibration::ElasticModuli moduli = cubic(model.moduli);
    panel.series.push_back(polar_series(
        model_label(model.name), model.name, model_style(model.name), right, up,
        [&](const Vector3d& n) { return calibration::youngs_modulus_along(moduli, n); }));
  }
  // Last, to be seen on top of the models that reach it.
  panel.series.push_back(polar_series("target", "target", {"#000000", "(1,3)"}, right, up,
                                      [&](const Vector3d&) { return run.target.youngs_modulus; }));
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
  Table table{heads({"Constant", "Target"}), true};
  for (const ModelData& model : run.models) table.header.emplace_back(model_label(model.name));
  struct Row {
    const char* name;
    double ModuliEntry::*value;
    double TargetEntry::*target;
  };
  for (const Row& row :
       {Row{"E along [100]", &ModuliEntry::E_100, &TargetEntry::youngs_modulus},
        {"E along [110]", &ModuliEntry::E_110, &TargetEntry::youngs_modulus},
        {"E along [111]", &ModuliEntry::E_111, &TargetEntry::youngs_modulus},
        {"Shear modulus G", &ModuliEntry::G, &TargetEntry::shear_modulus},
        {"Poisson's ratio ν along [100]", &ModuliEntry::nu_100, &TargetEntry::poissons_ratio},
        {"Bulk modulus K", &ModuliEntry::K, &TargetEntry::bulk_modulus}}) {
    const bool ratio = row.value == &ModuliEntry::nu_100;
    const auto cell = [&](double value) {
      return ratio ? Cell(number(value)) : amount_cell(value, shown_units().stress);
    };
    const double target = run.target.*row.target;
    std::vector<Cell> cells{row.name, cell(target)};
    for (const ModelData& model : run.models) {
      const double value = model.moduli.*row.value, error = value / target - 1.0;
      Cell& own = cells.emplace_back(cell(value));
      own.note += (own.note.empty() ? "" : ", ") + percent(error);
      own.grade = grade(error);
    }
    table.rows.push_back(std::move(cells));
  }
  std::vector<Cell> anisotropy{"Anisotropy A", "1"};
  for (const ModelData& model : run.models) {
    const double A = cubic(model.moduli).anisotropy;
    anisotropy.emplace_back(number(A), percent(A - 1.0), grade(A - 1.0));
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
  const ShownUnits& units = shown_units();
  Table table{
      heads({"Model", "Spacing\n" + unit_name(units.length), "k1\naxis", "k2\nface diagonal",
             "k3\nbody diagonal", "κ\nvolume", "Null direction\n(k1, k2, k3, κ)"})};
  for (const ModelData& model : run.models) {
    const bool fitted = !model.calibration.empty();
    if (!fitted && model.summary.empty()) continue;
    const calibration::FitConstants& found = model.calibration.constants;
    const ConstantsEntry constants = fitted
                                         ? ConstantsEntry{found.k1, found.k2, found.k3, found.kappa}
                                         : model.summary.constants;
    const double spacing = fitted ? model.calibration.spacing : model.summary.spacing;
    table.rows.push_back({{model_label(model.name), fitted ? "fitted" : "rule k = E a²/l₀"},
                          number(units.length(spacing)),
                          with_unit(constants.k1, units.stiffness),
                          with_unit(constants.k2, units.stiffness),
                          with_unit(constants.k3, units.stiffness),
                          with_unit(constants.kappa, units.stress),
                          null_directions(model.calibration)});
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

Table cubes_table(const RunData& run) {
  Table table{heads({"Model", "Cells across", "E₁₀₀", "E₁₁₀", "E₁₁₁", "G", "ν₁₀₀", "K"})};
  for (const CubeRow& cube : run.cubes) {
    const ModelData* model = run.model(cube.model);
    const ModuliEntry known = model ? model->moduli : ModuliEntry();
    std::vector<Cell> row{cube.model, count(double(cube.cells_across))};
    const auto add = [&](double value, double infinite, double factor) {
      row.emplace_back(number(factor * value), percent(value / infinite - 1.0));
    };
    const double stress = shown_units().stress.factor;
    add(cube.youngs_modulus_100, known.E_100, stress);
    add(cube.youngs_modulus_110, known.E_110, stress);
    add(cube.youngs_modulus_111, known.E_111, stress);
    add(cube.shear_modulus, known.G, stress);
    add(cube.poissons_ratio_100, known.nu_100, 1.0);
    add(cube.bulk_modulus, known.K, stress);
    table.rows.push_back(std::move(row));
  }
  return table;
}

Figure cubes_figure(const RunData& run) {
  Range cells{1e9, 1.0};
  std::map<std::string, Series> curves;
  for (const CubeRow& cube : run.cubes) {
    const std::string& name = cube.model;
    auto [curve, fresh] =
        curves.try_emplace(name, Series{model_label(name), name, model_style(name)});
    curve->second.style.point = name == "published" ? 5 : name == "central" ? 9 : 7;
    curve->second.add(cube.cells_across, shown_units().stress(cube.youngs_modulus_100));
    cells.include(cube.cells_across);
  }
  Panel panel{.x_label = "cells across the cube",
              .y_label = shown_units().stress.label("E along [100]"),
              .x_range = Range{0.8 * cells.from, 1.25 * cells.to},
              .y_range = Range{0.0},
              .log_x = 2,
              .key = "top right"};
  for (auto& [name, curve] : curves) panel.series.push_back(std::move(curve));
  return {"cubes", 760, 340, 1, {panel}};
}

}  // namespace

Chapter elasticity_chapter(const RunData& run) {
  if (run.models.empty()) return {};
  ChapterData chapter("elasticity");
  const double nu = run.target.poissons_ratio;
  const ModelData* central = run.model("central");
  const ModuliEntry paid = central ? central->moduli : ModuliEntry();
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
