#include "studies/exchange/transfer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace fingertip::studies::inline exchange {

namespace {

/// Which of the twelve samples are told.
constexpr std::size_t told[] = {1, 3, 5, 7, 11};
/// Of the force.
constexpr double good_enough = 0.05;

TransferModelEntry judged(const ContactCurve& curve, const ForetoldModel& model) {
  TransferModelEntry entry{model.name, {}, {}};
  const std::vector<double> forces = model.forces(curve);
  std::vector<double> errors;
  for (std::size_t i = 0; i < curve.forces.force.size(); ++i) {
    errors.push_back(forces[i] / curve.forces.force[i] - 1.0);
    if (std::ranges::find(told, i) == std::end(told)) continue;
    entry.force.push_back(forces[i]);
    entry.error.push_back(errors.back());
  }
  std::size_t longest = 0, length = 0;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    length = std::abs(errors[i]) <= good_enough ? length + 1 : 0;  // false of NaN
    if (length <= longest) continue;
    longest = length;
    entry.carries_from = curve.forces.indentation[i + 1 - length];
    entry.carries_to = curve.forces.indentation[i];
  }
  return entry;
}

std::string percent(double share) {
  return std::isnan(share) ? "–" : fmt::format("{:+.1f} %", 100.0 * share);
}

/// "from 0.25 to 3 mm", "at 0.25 mm alone"
std::string stretch(const TransferModelEntry& model) {
  if (std::ranges::all_of(model.error, [](double error) { return std::isnan(error); })) return "–";
  if (model.carries_from == model.carries_to)
    return fmt::format("at {:.3g} mm alone", 1e3 * model.carries_to);
  return std::isnan(model.carries_to)
             ? "nowhere"
             : fmt::format("from {:.3g} to {:.3g} mm", 1e3 * model.carries_from,
                           1e3 * model.carries_to);
}

/// Largest magnitude over the depths; NaN where none is known.
double worst(const TransferModelEntry& model, double so_far) {
  for (const double error : model.error)
    if (!std::isnan(error))
      so_far = std::isnan(so_far) ? std::abs(error) : std::max(so_far, std::abs(error));
  return so_far;
}

std::string share(double value) {
  return std::isnan(value) ? "?" : fmt::format("{:.2g} %", 100.0 * value);
}

}  // namespace

ForetoldModel by_law(const std::string& name,
                     const std::function<double(const ContactCurve&, double)>& force) {
  return {name, [force](const ContactCurve& curve) {
            std::vector<double> forces;
            for (const double at : curve.forces.indentation) forces.push_back(force(curve, at));
            return forces;
          }};
}

ForetoldModel lattice_at_rest() {
  return {"lattice at rest", [](const ContactCurve& curve) {
            std::vector<double> forces = curve.lattice;
            forces.resize(curve.forces.force.size(), meshes::unknown);
            return forces;
          }};
}

TransferFile transfer_of(const std::string& format, const std::string& how,
                         const std::vector<meshes::Violation>& lost,
                         const std::vector<ContactCurve>& curves,
                         const std::vector<ForetoldModel>& models) {
  TransferFile file{format, how, {}, {}};
  for (const meshes::Violation& problem : lost)
    file.lost.push_back(problem.key + " = " + problem.value + ": " + problem.rule);
  for (const ContactCurve& curve : curves) {
    TransferObstacleEntry& entry = file.obstacles.emplace_back();
    entry.obstacle = curve.name;
    entry.fitted = curve.fitted;
    if (curve.empty()) continue;
    for (const std::size_t i : told) {
      entry.indentation.push_back(curve.forces.indentation[i]);
      entry.force.push_back(curve.forces.force[i]);
      entry.force_error.push_back(curve.force_error[i]);
    }
    for (const ForetoldModel& model : models) entry.models.push_back(judged(curve, model));
  }
  return file;
}

void add_torsion(TransferFile& file, const std::vector<ContactCurve>& curves,
                 const ForetoldTorsion& model) {
  for (std::size_t c = 0; c < curves.size(); ++c) {
    if (curves[c].empty()) continue;
    TransferTorsionEntry& entry = file.obstacles[c].torsion.emplace_back();
    entry.model = model.name;
    const std::vector<double> moments = model.moments(curves[c]);
    for (const std::size_t i : told) {
      entry.moment.push_back(model.friction * curves[c].greatest_moment[i]);
      entry.model_moment.push_back(moments[i]);
      entry.error.push_back(moments[i] / entry.moment.back() - 1.0);
    }
  }
}

std::string transfer_chapters(const TransferFile& transfer) {
  if (transfer.obstacles.empty()) return "";
  std::string text = "## Force error to expect\n" + transfer.how + ".\n";
  for (const TransferObstacleEntry& obstacle : transfer.obstacles) {
    if (obstacle.models.empty()) continue;
    text += fmt::format("\n{}{}:\n\n| indentation |", obstacle.obstacle,
                        obstacle.fitted ? ", fitted" : ", predicted");
    for (const double at : obstacle.indentation) text += fmt::format(" {:.3g} mm |", 1e3 * at);
    text += " within 5 % |\n|---|";
    for (std::size_t i = 0; i <= obstacle.indentation.size(); ++i) text += "---|";
    text += "\n| continuum [N] |";
    for (std::size_t i = 0; i < obstacle.force.size(); ++i)
      text += fmt::format(" {:.4g} ± {:.1g} |", obstacle.force[i], obstacle.force_error[i]);
    text += " |";
    for (const TransferModelEntry& model : obstacle.models) {
      text += "\n| " + model.model + " |";
      for (const double error : model.error) text += " " + percent(error) + " |";
      text += " " + stretch(model) + " |";
    }
    text += "\n";
  }
  if (transfer.lost.empty()) return text;
  text += "\n## What is lost\n";
  for (const std::string& lost : transfer.lost) text += "- " + lost + "\n";
  return text;
}

std::string transfer_lines(const TransferFile& transfer) {
  std::string text = fmt::format("{:<24}{:>12}{:>12}   within 5 % there\n", "largest force error",
                                 transfer.obstacles.front().obstacle, "others");
  const std::vector<TransferModelEntry>& fitted = transfer.obstacles.front().models;
  for (std::size_t k = 0; k < fitted.size(); ++k) {
    double others = meshes::unknown;
    for (std::size_t i = 1; i < transfer.obstacles.size(); ++i)
      if (!transfer.obstacles[i].models.empty())
        others = worst(transfer.obstacles[i].models[k], others);
    text +=
        fmt::format("{:<24}{:>12}{:>12}   {}\n", fitted[k].model,
                    share(worst(fitted[k], meshes::unknown)), share(others), stretch(fitted[k]));
  }
  return text;
}

}  // namespace fingertip::studies::inline exchange
