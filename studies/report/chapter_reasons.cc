/// Why the models differ: sentences that only claim what the run's numbers show.
#include <fmt/format.h>

#include <cmath>

#include "studies/report/chapters.h"

namespace fingertip::studies::reporting {
namespace {

std::string factor(double value) {
  return number(value, 3);
}

/// Modulus of compression along a cube axis without lateral motion, C11 = E (1 - nu) /
/// ((1 + nu)(1 - 2 nu)) with E and nu of that axis: what a thin bonded layer mostly feels.
double confined_modulus(double E, double nu) {
  return E * (1.0 - nu) / ((1.0 + nu) * (1.0 - 2.0 * nu));
}

double confined_ratio(const RunData& run, const ModelData& model) {
  return confined_modulus(model.moduli.E_100, model.moduli.nu_100) /
         confined_modulus(run.target.youngs_modulus, run.target.poissons_ratio);
}

/// The caveat that a model of finite kinematics needs beside a linear continuum; else empty.
std::string kinematics_caveat(const ModelData& model) {
  if (model.summary.kinematics != "finite") return "";
  return " It measures finite deformation while the continuum here is linear, so part of the "
         "difference at large depth is geometry.";
}

std::string published_reason(const RunData& run, const ModelData& model) {
  const Moduli& m = model.moduli;
  const double along = m.E_100 / run.target.youngs_modulus;
  const double across = m.E_111 / run.target.youngs_modulus;
  const double shear = m.G / run.target.shear_modulus, confined = confined_ratio(run, model);
  std::string text = fmt::format(
      "Its spring rule comes from one chain of springs, but a mass has 26 of them: the lattice is "
      "{} times as stiff as the rubber along the cube axes, {} times along the body diagonals, {} "
      "times in shear, but only {} times in compression without room to give way sideways, which "
      "is much of what a layer bonded to the rod feels.",
      factor(along), factor(across), factor(shear), factor(confined));
  const double ratio = 1.0 + model.last_force_error();
  if (std::isfinite(ratio)) {
    const double least = std::fmin(along, confined), most = std::fmax(across, shear);
    text += fmt::format(" At full depth its force is {} times the continuum's, ", factor(ratio));
    if (ratio < least) {
      text +=
          "less than any of these: a few particles and ligaments carry the load, and their "
          "weakness hides the excess stiffness. Two errors of opposite sign are no agreement.";
    } else if (ratio > most) {
      text += "more than any of these: the grid at the contact and the ligaments add the rest.";
    } else {
      text +=
          "in the range of these. Its steps are the grid's: each comes with a new layer of "
          "particles.";
    }
  }
  return text;
}

std::string central_reason(const RunData& run, const ModelData& model) {
  const double bulk = model.moduli.K / run.target.bulk_modulus - 1.0;
  std::string text = fmt::format(
      "It has the rubber's E along the cube axes ({}) and its G ({}), but Cauchy's relation C12 = "
      "C44 leaves no third choice: ν₁₀₀ is {} "
      "instead of {}, K is off by {}, and confined compression takes {} of the rubber's stress.",
      percent(model.moduli.E_100 / run.target.youngs_modulus - 1.0),
      percent(model.moduli.G / run.target.shear_modulus - 1.0), number(model.moduli.nu_100, 3),
      number(run.target.poissons_ratio, 3), percent(bulk),
      percent_magnitude(confined_ratio(run, model)));
  const double error = model.last_force_error();
  if (!std::isfinite(error)) return text;
  if (std::abs(bulk) < 1e-3) {
    text += " For this rubber, ν = 1/4, Cauchy's relation costs nothing.";
  } else if (bulk < 0.0 && error < 0.0) {
    text += fmt::format(
        " Rubber squeezed between rod and plane can hardly escape sideways and resists by its "
        "volume; a material that is too easy to compress answers with too little force, here {} "
        "at full depth.",
        percent(error));
  } else {
    text += fmt::format(" At full depth its force is {} off; the material is too {} to compress.",
                        percent(error), bulk < 0.0 ? "easy" : "hard");
  }
  return text;
}

std::string hookean_reason(const RunData& run, const ModelData& model) {
  const Moduli& m = model.moduli;
  const Target& t = run.target;
  const double worst = std::fmax(
      std::abs(m.E_100 / t.youngs_modulus - 1.0),
      std::fmax(std::abs(m.G / t.shear_modulus - 1.0), std::abs(m.K / t.bulk_modulus - 1.0)));
  std::string text = worst < 1e-6
                         ? "Its infinite lattice is exactly the rubber in every direction, so "
                           "nothing of its error is material."
                         : fmt::format("Its elastic constants are within {} of the rubber.",
                                       percent_magnitude(worst));
  text +=
      " Surface, bond and contact are the tip's own: cells are cut by sphere and cylinder. What "
      "remains is the size of the cells";
  const double spacing = model.summary.spacing;
  if (std::isfinite(spacing))
    text += fmt::format(" ({})", with_unit(spacing, shown_units().length, 3));
  text +=
      ", which a small contact feels first, and what the press at speed adds by inertia and "
      "damping to the continuum's equilibrium.";
  std::size_t worst_depth = model.force_error.size() - 1;
  for (std::size_t i = 0; i < model.force_error.size(); ++i) {
    const double error = std::abs(model.force_error[i]);
    const double worst_so_far = std::abs(model.force_error[worst_depth]);
    if (std::isfinite(error) && !(error <= worst_so_far)) worst_depth = i;
  }
  if (std::isfinite(model.last_force_error())) {
    text += fmt::format(" At the depths of the verdict it amounts to {} at most, at {}.",
                        percent(model.force_error[worst_depth]), length(run.depths[worst_depth]));
  }
  return text;
}

std::string dynamics_reason(const RunData& run) {
  for (const ModelData& model : run.models) {
    if (model.trace.empty()) continue;
    double speed = meshes::unknown;
    for (const lattice::TraceRow& row : model.trace) speed = std::fmax(speed, row.commanded_speed);
    return fmt::format(
        "The continuum is static, the lattices move: at {} inertia and damping add their "
        "share to the force. It grows "
        "with speed, so it can be told from the lattice error by pressing more slowly.",
        with_unit(speed, shown_units().speed, 3));
  }
  return "";
}

}  // namespace

Chapter reasons_chapter(const RunData& run) {
  Chapter chapter{"reasons", "Why they differ", {}};
  if (std::isnan(run.target.bulk_modulus)) return chapter;
  for (const ModelData& model : run.models) {
    if (std::isnan(model.moduli.E_100)) continue;
    std::string text;
    if (model.name == "published") text = published_reason(run, model);
    if (model.name == "central") text = central_reason(run, model);
    if (model.name == "hookean") text = hookean_reason(run, model);
    text += kinematics_caveat(model);
    chapter.blocks.push_back(Paragraph{model_label(model.name) + ".", text});
  }
  const std::string dynamics = dynamics_reason(run);
  if (!dynamics.empty() && !chapter.blocks.empty())
    chapter.blocks.push_back(Paragraph{"statics and dynamics.", dynamics});
  return chapter;
}

}  // namespace fingertip::studies::reporting
