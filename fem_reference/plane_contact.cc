#include "fem_reference/plane_contact.h"

#include <algorithm>
#include <limits>
#include <string>
#include <utility>

#include "meshes/errors.h"

namespace fingertip::fem_reference {
namespace {

constexpr int max_rounds = 400;
/// Rounds without progress after which offenders are changed one at a time.
constexpr int patience = 8;
/// Penetration below this fraction of the tip's radius is round-off.
constexpr double gap_noise = 1e-12;

}  // namespace

ContactUnknowns contact_unknowns(const ElasticTip& tip, meshes::ContactMode mode, double lowest) {
  ContactUnknowns result;
  for (const SurfaceNode& node : tip.outer_nodes()) {
    if (node.position.z() < lowest) continue;
    std::array<int, 3> positions{-1, -1, -1};
    for (std::size_t c = mode == meshes::ContactMode::stick ? 0 : 2; c < 3; ++c) {
      if (tip.fixed()[std::size_t(node.dof[c])]) continue;
      positions[c] = int(result.unknowns.size());
      result.unknowns.push_back(node.dof[c]);
    }
    if (positions[2] < 0) continue;  // bonded as well: it cannot move toward the plane
    result.nodes.push_back(node);
    result.of_node.push_back(positions);
  }
  return result;
}

PlaneContact::PlaneContact(ContactUnknowns unknowns, double tip_radius, ContactSolver& solver)
    : unknowns_(std::move(unknowns)),
      tip_radius_(tip_radius),
      solver_(solver),
      active_(unknowns_.nodes.size(), 0),
      anchors_(unknowns_.nodes.size(), {0.0, 0.0}),
      displacement_(Eigen::VectorXd::Zero(Eigen::Index(unknowns_.unknowns.size()))),
      reaction_(displacement_) {}

int PlaneContact::active_nodes() const {
  return int(std::ranges::count(active_, 1));
}

meshes::Vector3 PlaneContact::reaction(std::size_t node) const {
  meshes::Vector3 force = meshes::Vector3::Zero();
  for (int c = 0; c < 3; ++c) {
    const int position = unknowns_.of_node[node][std::size_t(c)];
    if (position >= 0) force[c] = reaction_[position];
  }
  return force;
}

double PlaneContact::gap(std::size_t node) const {
  return gap(node, displacement_, indentation_);
}

double PlaneContact::gap(std::size_t node, const Eigen::VectorXd& displacement,
                         double indentation) const {
  return tip_radius_ - indentation - unknowns_.nodes[node].position.z() -
         displacement[unknowns_.of_node[node][2]];
}

HeldSolution PlaneContact::solve(const std::vector<char>& active, double indentation) const {
  std::vector<char> held(unknowns_.unknowns.size(), 0);
  Eigen::VectorXd values = Eigen::VectorXd::Zero(displacement_.size());
  for (std::size_t node = 0; node < active.size(); ++node) {
    if (!active[node]) continue;
    const double height = tip_radius_ - indentation - unknowns_.nodes[node].position.z();
    const std::array<double, 3> wanted{anchors_[node][0], anchors_[node][1], height};
    for (std::size_t c = 0; c < 3; ++c) {
      const int position = unknowns_.of_node[node][c];
      if (position < 0) continue;
      held[std::size_t(position)] = 1;
      values[position] = wanted[c];
    }
  }
  return solver_.hold(held, values);
}

std::vector<std::size_t> PlaneContact::offenders(const std::vector<char>& active,
                                                 const HeldSolution& trial,
                                                 double indentation) const {
  // Both thresholds sit above the solver's noise, or nodes that barely touch would flicker.
  const double largest = trial.reaction.size() ? trial.reaction.cwiseAbs().maxCoeff() : 0.0;
  const double pull = solver_.noise() * largest;
  const double depth = std::max(gap_noise * tip_radius_, solver_.noise() * indentation);
  std::vector<std::size_t> result;
  for (std::size_t node = 0; node < active.size(); ++node) {
    const bool wrong = active[node] ? trial.reaction[unknowns_.of_node[node][2]] > pull
                                    : gap(node, trial.displacement, indentation) < -depth;
    if (wrong) result.push_back(node);
  }
  return result;
}

double PlaneContact::touch_time(std::size_t node, const Eigen::VectorXd& trial,
                                double indentation) const {
  const double before = std::max(0.0, gap(node));
  return before / (before - gap(node, trial, indentation));
}

void PlaneContact::anchor(std::size_t node, const Eigen::VectorXd& trial, double time) {
  for (std::size_t c = 0; c < 2; ++c) {
    const int position = unknowns_.of_node[node][c];
    if (position >= 0)
      anchors_[node][c] =
          displacement_[position] + time * (trial[position] - displacement_[position]);
  }
}

ContactStep PlaneContact::advance(double indentation) {
  ContactStep step;
  std::vector<char> active = active_;
  const auto anchors = anchors_;
  std::size_t fewest = std::numeric_limits<std::size_t>::max();
  int stalled = 0;
  // A node that already touches when the step begins belongs to its very first trial state.
  for (std::size_t node = 0; node < active.size(); ++node)
    if (!active[node] && gap(node) <= gap_noise * tip_radius_) {
      active[node] = 1;
      anchor(node, displacement_, 0.0);
    }
  try {
    while (step.active_set_iterations < max_rounds) {
      HeldSolution trial = solve(active, indentation);
      ++step.active_set_iterations;
      step.cg_iterations += trial.cg_iterations;
      std::vector<std::size_t> wrong = offenders(active, trial, indentation);
      if (wrong.empty()) {
        active_ = std::move(active);
        displacement_ = std::move(trial.displacement);
        reaction_ = std::move(trial.reaction);
        indentation_ = indentation;
        return step;
      }
      stalled = wrong.size() < fewest ? 0 : stalled + 1;
      fewest = std::min(fewest, wrong.size());
      if (stalled > patience) wrong.resize(1);
      for (const std::size_t node : wrong) {
        active[node] = !active[node];
        if (active[node])
          anchor(node, trial.displacement, touch_time(node, trial.displacement, indentation));
      }
    }
    throw meshes::NotConverged("the active set did not settle within " +
                               std::to_string(max_rounds) + " rounds at an indentation of " +
                               std::to_string(indentation) + " m");
  } catch (...) {
    anchors_ = anchors;
    throw;
  }
}

}  // namespace fingertip::fem_reference
