#include "calibration/press_fit/relaxing_force.h"

#include "calibration/material/relaxation_branches.h"
#include "meshes/base/errors.h"

namespace fingertip::calibration::inline press_fit {

using Eigen::Index;
using Eigen::RowVectorXd;
using Eigen::VectorXd;

meshes::Relaxation relaxation_in(const std::vector<FitBranch>& branches,
                                 const VectorXd& parameters) {
  meshes::Relaxation relaxation;
  double left = 1.0;
  for (const FitBranch& branch : branches) {
    relaxation.branches.push_back({branch.share.in(parameters), branch.time.in(parameters)});
    left -= relaxation.branches.back().share;
  }
  if (!(left > 0.0)) throw meshes::NotConverged("the shares of the branches sum to 1 or more");
  return relaxation;
}

std::vector<FitBranch> held_at(const std::vector<FitBranch>& branches, const VectorXd& parameters) {
  std::vector<FitBranch> held;
  for (const FitBranch& branch : branches)
    held.push_back({{branch.share.in(parameters)}, {branch.time.in(parameters)}});
  return held;
}

RelaxingForce::RelaxingForce(const std::vector<FitBranch>& branches, const VectorXd& parameters)
    : parameters_(parameters.size()) {
  const meshes::Relaxation relaxation = relaxation_in(branches, parameters);
  const double instant = relaxation.instantaneous_ratio();
  for (std::size_t i = 0; i < branches.size(); ++i) {
    Branch& own = own_.emplace_back();
    own.excess = relaxation.relative_modulus(i);
    own.time = relaxation.branches[i].time;
    own.time_place = branches[i].time.place;
    // b_i = g_i/(1 - sum g): db_i/dg_j = (delta_ij + b_i)/(1 - sum g)
    own.excess_slopes = RowVectorXd::Zero(parameters_);
    for (std::size_t j = 0; j < branches.size(); ++j)
      if (const auto place = branches[j].share.place)
        own.excess_slopes(*place) += instant * ((i == j ? 1.0 : 0.0) + own.excess);
  }
  reset();
}

void RelaxingForce::reset() {
  now_ = {0.0, RowVectorXd::Zero(parameters_)};
  for (Branch& branch : own_) branch.held = now_;
}

RelaxingForce::Step RelaxingForce::step(double duration) const {
  Step step{duration};
  for (const Branch& branch : own_) {
    const PronyMoments m(duration, branch.time);
    step.end += branch.excess * (m.gain + 4.0 * m.bend);
    step.middle -= 8.0 * branch.excess * m.bend;
    step.rest += m.decay * branch.held.force + branch.excess * (4.0 * m.bend - m.gain) * now_.force;
  }
  return step;
}

RelaxingForce::Value RelaxingForce::after(const Branch& branch, const Step& step,
                                          const Value& middle, const Value& end,
                                          const RowVectorXd& duration_slopes) const {
  const PronyMoments m(step.duration, branch.time);
  const double change = end.force - now_.force,
               bent = 4.0 * (end.force - 2.0 * middle.force + now_.force);
  const double gained = m.gain * change + m.bend * bent;
  Value held{m.decay * branch.held.force + branch.excess * gained,
             m.decay * branch.held.slopes + gained * branch.excess_slopes};
  held.slopes += branch.excess * (m.gain * (end.slopes - now_.slopes) +
                                  4.0 * m.bend * (end.slopes - 2.0 * middle.slopes + now_.slopes));
  const double faded = m.decay_slope * branch.held.force +
                       branch.excess * (m.gain_slope * change + m.bend_slope * bent);
  if (branch.time_place) held.slopes(*branch.time_place) += faded / branch.time;
  if (step.duration > 0.0) held.slopes -= faded / step.duration * duration_slopes;
  return held;
}

RowVectorXd RelaxingForce::slopes(const Step& step, const Value& middle, const Value& end,
                                  const RowVectorXd& duration_slopes) const {
  RowVectorXd sum = end.slopes;
  for (const Branch& branch : own_) sum += after(branch, step, middle, end, duration_slopes).slopes;
  return sum;
}

void RelaxingForce::go_on(const Step& step, const Value& middle, const Value& end,
                          const RowVectorXd& duration_slopes) {
  for (Branch& branch : own_) branch.held = after(branch, step, middle, end, duration_slopes);
  now_ = end;
}

}  // namespace fingertip::calibration::inline press_fit
