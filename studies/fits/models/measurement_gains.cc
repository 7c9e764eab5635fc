#include "studies/fits/models/measurement_gains.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "calibration/press_fit/model_error.h"
#include "meshes/tables/interpolation.h"
#include "studies/fits/models/fit_repeats.h"
#include "studies/fits/models/fit_rig.h"
#include "studies/fits/models/travel.h"

namespace fingertip::studies::inline fits::inline models {

using calibration::Curve;
using calibration::CurveSlopes;
using calibration::FreeParameter;
using calibration::MaterialParameter;
using calibration::MeasurementGain;
using calibration::Observations;
using calibration::Rig;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
namespace fs = std::filesystem;

namespace {

/// Nothing is known better than this share of the largest force.
constexpr double min_noise = 1e-6;

/// Whether it moves with a machine, not with one of its presses.
bool is_of_the_machine(MaterialParameter parameter) {
  return parameter == MaterialParameter::compliance;
}

VectorXd vector_of(const std::vector<double>& values) {
  return VectorXd::Map(values.data(), Index(values.size()));
}

Curve at_rest(Curve curve, std::vector<double> positions) {
  curve.x = std::move(positions);
  curve.is_travel = true;
  return curve;
}

}  // namespace

Noise::Noise(double relative, double absolute) : relative_(relative), absolute_(absolute) {}

Noise::Noise(const std::vector<Curve>& curves, double deviation) : absolute_(deviation) {
  std::vector<std::pair<double, double>> known;
  for (const Curve& curve : curves)
    for (std::size_t i = 0; i < curve.sigma.size(); ++i)
      known.emplace_back(std::abs(curve.y[i]), curve.sigma[i]);
  std::ranges::sort(known);
  for (const auto& [force, sigma] : known) {
    if (!force_.empty() && force <= force_.back()) continue;
    force_.push_back(force);
    sigma_.push_back(sigma);
  }
}

VectorXd Noise::of(const VectorXd& forces) const {
  VectorXd sigma(forces.size());
  for (Index i = 0; i < forces.size(); ++i) {
    const double force = std::abs(forces(i));
    if (force_.empty())
      sigma(i) = std::hypot(relative_ * force, absolute_);
    else
      sigma(i) = meshes::interpolated(force_, sigma_, std::min(force, force_.back())) *
                 std::max(1.0, force / force_.back());
  }
  return sigma.cwiseMax(min_noise * forces.cwiseAbs().maxCoeff());
}

namespace {

/// The press of curve `i` by its rubber alone.
VectorXd forces_at(const FitInput& input, const FitModels& models, std::size_t i,
                   const std::vector<double>& indentations, const VectorXd& parameters) {
  Curve curve = at_rest(input.curves[i], indentations);
  curve.time.clear();
  return models.behind_rig(input, i, {}, curve, parameters.size())->evaluate(parameters).value;
}

}  // namespace

Curve as_if_measured(const FitInput& input, const FitModels& models, std::size_t i,
                     const VectorXd& parameters, const Noise& noise) {
  Curve curve = input.curves[i];
  const VectorXd forces = forces_at(input, models, i, curve.x, parameters);
  VectorXd told = forces;
  if (input.curves[i].travel) {
    const Rig& rig = input.curves[i].travel->rig;
    for (std::size_t k = 0; k < curve.x.size(); ++k) {
      const double force = forces(Index(k));
      curve.x[k] += rig.touch_offset.in(parameters) + rig.compliance.in(parameters)*force;
      told(Index(k)) += rig.force_offset.in(parameters) +
                        (curve.time.empty() ? 0.0 : rig.drift.in(parameters)*curve.time[k]);
    }
  }
  const VectorXd sigma = noise.of(forces);
  curve.y.assign(told.begin(), told.end());
  curve.sigma.assign(sigma.begin(), sigma.end());
  return curve;
}

MatrixXd relative_model_error(const std::vector<lattice::PressSetup>& presses, bool lattice,
                              const MatrixXd& shared) {
  MatrixXd covariance;
  if (lattice) covariance = calibration::lattice_covariance(presses);
  if (shared.cols() == 0) return covariance;
  if (covariance.size() == 0) covariance = MatrixXd::Zero(shared.rows(), shared.rows());
  covariance += shared * shared.transpose();
  return covariance;
}

std::vector<lattice::PressSetup> presses_of_values(const FitInput& input) {
  std::vector<lattice::PressSetup> presses;
  for (const FitCurve& curve : input.curves) {
    lattice::PressSetup& press = presses.emplace_back(curve.press);
    if (curve.travel) press.protocol.samples = depths_of_values(curve, start_of(input.options));
  }
  return presses;
}

MatrixXd known_errors_at(const FitCurve& curve, const std::vector<std::vector<double>>& at_samples,
                         const std::vector<double>& depths) {
  MatrixXd columns = MatrixXd::Zero(Index(depths.size()), Index(at_samples.size()));
  for (std::size_t k = 0; k < at_samples.size(); ++k)
    for (std::size_t i = 0; i < depths.size() && !at_samples[k].empty(); ++i)
      columns(Index(i), Index(k)) =
          meshes::interpolated(curve.press.protocol.samples, at_samples[k], depths[i]);
  return columns;
}

MatrixXd known_errors_at_values(const FitInput& input) {
  MatrixXd all(0, Index(input.known_errors.size()));
  for (const FitCurve& curve : input.curves) {
    const MatrixXd rows = known_errors_at(curve, curve.known_errors,
                                          depths_of_values(curve, start_of(input.options)));
    all.conservativeResize(all.rows() + rows.rows(), Eigen::NoChange);
    all.bottomRows(rows.rows()) = rows;
  }
  return all;
}

namespace {

/// A joint linearisation of the fit's values and, perhaps, of a further measurement's.
struct Joint {
  std::vector<FreeParameter> free;
  MatrixXd jacobian;
  VectorXd deviation;
  VectorXd forces;
  std::vector<lattice::PressSetup> presses;
  MatrixXd known_errors;  ///< a column each
  bool lattice_error = false;
  /// Of the presses in order: what is theirs, and a number that presses alike share.
  struct Press {
    VectorXd force, depth;
    std::size_t kind = 0;
  };
  std::vector<Press> made;
  double misfit = 0.0, scatter = 0.0;

  MatrixXd covariance() const {
    Observations seen{jacobian, deviation, {}};
    const MatrixXd relative = relative_model_error(presses, lattice_error, known_errors);
    // A blank stands behind the presses and has no model.
    if (relative.size() > 0) {
      seen.model_covariance = MatrixXd::Zero(forces.size(), forces.size());
      const VectorXd own = forces.head(relative.rows());
      seen.model_covariance.topLeftCorner(relative.rows(), relative.cols()) =
          own.asDiagonal() * relative * own.asDiagonal();
    }
    if (misfit > 0.0 || scatter > 0.0) add_unknown_errors(seen.model_covariance);
    return predicted_covariance(seen, free);
  }
  void add_unknown_errors(MatrixXd& covariance) const {
    if (covariance.size() == 0) covariance = MatrixXd::Zero(forces.size(), forces.size());
    std::map<std::size_t, double> deepest;
    for (const Press& each : made)
      deepest[each.kind] = std::max(deepest[each.kind], each.depth.maxCoeff());
    std::map<std::size_t, MatrixXd> missed;
    Index row = 0;
    for (const Press& each : made) {
      const MatrixXd own = misfit * misfit_columns(each.force, each.depth, deepest[each.kind]);
      MatrixXd& all = missed[each.kind];
      if (all.size() == 0) all = MatrixXd::Zero(forces.size(), own.cols());
      all.middleRows(row, own.rows()) = own;
      covariance.block(row, row, own.rows(), own.rows()) +=
          scatter * scatter * each.force * each.force.transpose();
      row += own.rows();
    }
    for (const auto& [kind, columns] : missed) covariance += columns * columns.transpose();
  }
  void append(const MatrixXd& rows, const VectorXd& sigma, const VectorXd& values) {
    const Index before = jacobian.rows(), columns = rows.cols();
    jacobian.conservativeResize(before + rows.rows(), columns);
    jacobian.topRightCorner(before, columns - Index(free_before)).setZero();
    jacobian.bottomRows(rows.rows()) = rows;
    deviation.conservativeResize(before + rows.rows());
    deviation.tail(rows.rows()) = sigma;
    forces.conservativeResize(before + rows.rows());
    forces.tail(rows.rows()) = values;
    free_before = std::size_t(columns);
  }
  std::size_t free_before = 0;
};

Joint joint_of(const FitInput& input, const FitModels& models, const VectorXd& parameters,
               double deviation) {
  Joint joint;
  joint.free = input.options.free;
  joint.free_before = joint.free.size();
  joint.jacobian.resize(0, Index(joint.free.size()));
  const auto list = models.addresses();
  for (std::size_t i = 0; i < input.curves.size(); ++i) {
    const FitCurve& curve = input.curves[i];
    const CurveSlopes slopes = curve.travel ? models
                                                  .behind_rig(input, i, curve.travel->rig, curve,
                                                              parameters.size(), input.branches)
                                                  ->evaluate(parameters)
                                            : list[i]->evaluate(parameters);
    joint.append(slopes.jacobian,
                 curve.sigma.empty() ? VectorXd::Constant(slopes.value.size(), deviation)
                                     : vector_of(curve.sigma),
                 slopes.value);
  }
  joint.lattice_error = input.with_lattice_error;
  if (joint.lattice_error) joint.presses = presses_of_values(input);
  joint.known_errors = known_errors_at_values(input);
  const ForceAndDepth at = presses_at(input, parameters, joint.forces);
  const auto groups = sharing(input);
  for (std::size_t i = 0; i < input.curves.size(); ++i) {
    const auto rows =
        Eigen::seqN(calibration::first_value(input.curves, i), Index(input.curves[i].y.size()));
    const auto kind = std::ranges::find_if(
        groups, [&](const auto& group) { return std::ranges::find(group, i) != group.end(); });
    joint.made.push_back({at.force(rows), at.depth(rows), std::size_t(kind - groups.begin())});
  }
  return joint;
}

/// What is the same of a machine in the fit, if the fit seeks it.
std::optional<Index> shared_compliance(const FitInput& input, const std::string& machine) {
  for (const FitCurve& curve : input.curves)
    if (curve.travel && curve.travel->machine == machine) return curve.travel->rig.compliance.place;
  return std::nullopt;
}

/// The first press of the fit, at fewer indentations, as one that is made anew: with a touch and a
/// zero of its own.
FitInput made_anew(const FitInput& input, double depth) {
  FitInput again;
  again.problem = input.problem;
  again.base = input.base;
  const FitCurve& first = input.curves.front();
  FitCurve& curve = again.curves.emplace_back();
  curve.kind = first.kind;
  curve.press = first.press;
  curve.travel = first.travel;
  curve.is_travel = first.travel.has_value();
  curve.x = meshes::even_depths(depth, first.x.size());
  again.known_errors = input.known_errors;
  curve.known_errors = first.known_errors;
  if (first.time.size() == curve.x.size())
    for (const double time : first.time) curve.time.push_back(time - first.time.front());
  again.options.free.assign(
      input.options.free.begin(),
      input.options.free.begin() + std::ptrdiff_t(material_parameters(input)));
  if (curve.travel) {
    for (const auto member : calibration::rig_members) (curve.travel->rig.*member).place.reset();
    free_rigs(again);
  }
  return again;
}

/// Of a further press: its own parameters, those of its machine being the fit's.
struct Further {
  std::vector<Index> place;  ///< of its parameters among all
  std::vector<FreeParameter> free;
};

Further further_of(const FitInput& input, const FitInput& own,
                   const std::vector<FreeParameter>& known) {
  Further further{{}, known};
  const std::size_t rubber = material_parameters(own);
  const std::optional<Travel>& travel = own.curves.front().travel;
  const std::optional<Index> machine =
      travel ? shared_compliance(input, travel->machine) : std::nullopt;
  for (std::size_t k = 0; k < own.options.free.size(); ++k) {
    const FreeParameter& free = own.options.free[k];
    if (k < rubber) {
      further.place.push_back(Index(k));
    } else if (is_of_the_machine(free.parameter) && machine) {
      further.place.push_back(*machine);
    } else {
      further.place.push_back(Index(further.free.size()));
      further.free.push_back(free);
    }
  }
  return further;
}

/// The press of `own`, whose first curve `models` answers for, added to what is known; `kind`: that
/// of Joint::Press.
Joint with_press(Joint joint, const FitInput& input, const FitInput& own, const FitModels& models,
                 const VectorXd& parameters, const Noise& noise, std::size_t kind) {
  const Further further = further_of(input, own, joint.free);
  VectorXd at(Index(own.options.free.size()));
  for (Index k = 0; k < at.size(); ++k) {
    const Index place = further.place[std::size_t(k)];
    at(k) = place < parameters.size() ? parameters(place) : own.options.free[std::size_t(k)].start;
  }
  const Curve curve = as_if_measured(own, models, 0, at, noise);
  const std::optional<Travel>& travel = own.curves.front().travel;
  const Rig rig = travel ? travel->rig : Rig{};
  const CurveSlopes slopes =
      models.behind_rig(own, 0, rig, at_rest(curve, curve.x), at.size())->evaluate(at);
  MatrixXd rows = MatrixXd::Zero(slopes.value.size(), Index(further.free.size()));
  for (Index k = 0; k < at.size(); ++k)
    rows.col(further.place[std::size_t(k)]) += slopes.jacobian.col(k);
  joint.free = further.free;
  joint.append(rows, vector_of(curve.sigma), slopes.value);
  joint.made.push_back(
      {forces_at(own, models, 0, own.curves.front().x, at), vector_of(own.curves.front().x), kind});
  if (joint.lattice_error) {
    joint.presses.push_back(own.curves.front().press);
    joint.presses.back().protocol.samples = own.curves.front().x;
  }
  // Positions of a press that nobody made are its indentations.
  joint.known_errors.conservativeResize(joint.forces.size(), Eigen::NoChange);
  joint.known_errors.bottomRows(Index(curve.x.size())) =
      known_errors_at(own.curves.front(), own.curves.front().known_errors, own.curves.front().x);
  return joint;
}

/// f = (x - x0)/c of a rigid blank, pressed to the forces of the fit, with a touch of its own.
Joint with_blank(Joint joint, const VectorXd& parameters, const VectorXd& standard_errors,
                 const Noise& noise) {
  const auto compliance =
      std::ranges::find(joint.free, MaterialParameter::compliance, &FreeParameter::parameter);
  const Index place = compliance - joint.free.begin();
  // Of what may be zero as far as the presses tell its error is the size: a blank on a rigid
  // machine has no travel at all.
  const double soft = std::max(std::abs(parameters(place)), standard_errors(place));
  const VectorXd forces = joint.forces;
  joint.free.push_back({.parameter = MaterialParameter::touch_offset});
  MatrixXd rows = MatrixXd::Zero(forces.size(), Index(joint.free.size()));
  rows.col(place) = -forces / soft;
  rows.rightCols(1).setConstant(-1.0 / soft);
  joint.append(rows, noise.of(forces), forces);
  return joint;
}

}  // namespace

MeasurementGains measurement_gains(
    const FitInput& input, const FitModels& models, const VectorXd& parameters, double deviation,
    double misfit, double scatter, const fs::path& folder, const JobContext& context,
    const std::function<bool(double share, const std::string& name)>& go_on) {
  Joint known = joint_of(input, models, parameters, deviation);
  known.misfit = misfit, known.scatter = scatter;
  MeasurementGains result{known.covariance(), {}};
  const VectorXd before = result.covariance.diagonal().cwiseSqrt();
  const Noise noise(curves_of(input), deviation);
  for (const Candidate& candidate : input.candidates) {
    MeasurementGain& entry = result.gains.emplace_back();
    entry.name = candidate.name;
    entry.press = candidate.press;
    entry.failure = candidate.refused;
    const auto own_go_on = [&] {
      return go_on(double(&candidate - input.candidates.data()) / double(input.candidates.size()),
                   candidate.name);
    };
    if (!own_go_on()) throw meshes::Interrupted("further measurements not weighed");
    if (!entry.failure.empty()) continue;
    try {
      Joint joint;
      if (candidate.blank) {
        joint = with_blank(known, parameters, before, noise);
      } else if (candidate.input) {
        const FitModels own(*candidate.input, folder / "next" / candidate.name, context, own_go_on);
        joint =
            with_press(known, input, *candidate.input, own, parameters, noise, known.made.size());
      } else {
        joint = with_press(known, input, made_anew(input, candidate.depth), models, parameters,
                           noise, known.made.front().kind);
      }
      const VectorXd after = joint.covariance().diagonal().cwiseSqrt().head(before.size());
      entry.times = before.cwiseQuotient(after).cwiseMax(1.0);
    } catch (const meshes::NotConverged& error) {
      entry.failure = error.what();
    } catch (const meshes::InvalidInput& error) {
      entry.failure = error.what();
    }
  }
  calibration::sort_by_gain(result.gains, material_parameters(input));
  return result;
}

}  // namespace fingertip::studies::inline fits::inline models
