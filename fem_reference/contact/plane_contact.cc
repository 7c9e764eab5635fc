#include "fem_reference/contact/plane_contact.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "fem_reference/contact/anderson_mixing.h"
#include "meshes/base/errors.h"

namespace fingertip::fem_reference::inline contact {
namespace {

using meshes::ContactMode;

constexpr int max_rounds = 400;
/// Feet stay where they are when their heights change by less than this share of how deep the
/// deepest node is, or after some moves: what is left is made up for when the step is committed.
constexpr double feet_settled = 1e-5;
constexpr int max_foot_moves = 8;
/// Rounds without progress after which offenders are changed one at a time.
constexpr int patience = 8;
/// Penetration below this length [m] is round-off: a picometre.
constexpr double gap_noise = 1e-12;
/// A node that comes as near as this share of its width is expected to touch: what is foreknown is
/// a solution on another mesh.
constexpr double foreseen_touch = 1e-2;
/// Rounds after which what slides does not stick again: it may turn back and forth.
constexpr int friction_patience = 20;
/// rho in G times a node's area over the root of the contact's: with that of a disc on a half
/// space, 4.5, all nodes together turn at once; with more, neighbours go by themselves sooner.
constexpr double slip_stiffness = 8.0;
/// Friction forces have converged when a round changes none by more than this, over the largest
/// push.
constexpr double friction_converged = 1e-11;

/// Itself for a node with area, the nearest of those for one without; itself where there is none.
std::vector<std::size_t> leaders_of(const std::vector<SurfaceNode>& nodes) {
  std::vector<std::size_t> leaders(nodes.size());
  for (std::size_t node = 0; node < nodes.size(); ++node) {
    leaders[node] = node;
    if (nodes[node].area > 0.0) continue;
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t other = 0; other < nodes.size(); ++other) {
      const double distance = (nodes[other].position - nodes[node].position).norm();
      if (nodes[other].area > 0.0 && distance < nearest) {
        nearest = distance;
        leaders[node] = other;
      }
    }
  }
  return leaders;
}

}  // namespace

PlaneContact::PlaneContact(ContactUnknowns unknowns, ContactMode mode, const PlanePose& start,
                           double friction, double shear_modulus, const meshes::Obstacle& obstacle,
                           bool finite)
    : unknowns_(std::move(unknowns)),
      leaders_(leaders_of(unknowns_.nodes)),
      mode_(mode),
      friction_(friction),
      shear_modulus_(shear_modulus),
      obstacle_(obstacle),
      finite_(finite),
      frames_(finite && !obstacle.is_plane() ? unknowns_.nodes.size() : 0) {
  const std::size_t nodes = unknowns_.nodes.size();
  const auto zero = Eigen::VectorXd::Zero(Eigen::Index(unknowns_.unknowns.size()));
  committed_ = {start,
                std::vector<NodeStatus>(nodes, NodeStatus::open),
                std::vector<std::array<double, 3>>(nodes, {0.0, 0.0, 0.0}),
                zero,
                zero,
                {}};
  for (std::size_t node = 0; has_feet() && node < nodes; ++node) {
    const Eigen::Vector2d foot = over_obstacle(unknowns_.nodes[node].position, start);
    committed_.feet.push_back({foot.x(), foot.y()});
  }
  trial_ = committed_;
}

void PlaneContact::restore(State state) {
  committed_ = std::move(state);
  trial_ = committed_;
  if (curved()) linearise(committed_.displacement, committed_.pose);
}

void PlaneContact::commit() {
  for (std::size_t node = 0; node < trial_.status.size(); ++node)
    if (trial_.status[node] == NodeStatus::slide) {  // the next slip starts here
      anchor(node, trial_.displacement, 1.0);
    }
  committed_ = trial_;
  foreknown_ = {};
}

void PlaneContact::abandon() {
  trial_ = committed_;
  foreknown_ = {};
}

int PlaneContact::active_nodes() const {
  return int(trial_.status.size()) - int(std::ranges::count(trial_.status, NodeStatus::open));
}

meshes::Vector3 PlaneContact::of_node(std::size_t node, const Eigen::VectorXd& values) const {
  meshes::Vector3 result = meshes::Vector3::Zero();
  for (int c = 0; c < 3; ++c) {
    const int position = unknowns_.of_node[node][std::size_t(c)];
    if (position >= 0) result[c] = values[position];
  }
  return result;
}

void PlaneContact::set_node(std::size_t node, const meshes::Vector3& value,
                            Eigen::VectorXd& values) const {
  for (int c = 0; c < 3; ++c) {
    const int position = unknowns_.of_node[node][std::size_t(c)];
    if (position >= 0) values[position] = value[c];
  }
}

meshes::Vector3 PlaneContact::reaction(std::size_t node) const {
  return axes(node).transpose() * own_reaction(node);
}

Eigen::VectorXd PlaneContact::in_plane_axes(const Eigen::VectorXd& values) const {
  if (!curved()) return values;
  Eigen::VectorXd result = values;
  for (std::size_t node = 0; node < trial_.status.size(); ++node)
    set_node(node, axes(node).transpose() * of_node(node, values), result);
  return result;
}

Eigen::Vector2d PlaneContact::over_obstacle(const meshes::Vector3& place,
                                            const PlanePose& pose) const {
  const meshes::Vector3 from_top(place.x() - pose.shift, place.y(), 0.0);
  return (pose.turn().inverse() * from_top).head<2>();
}

Eigen::Vector2d PlaneContact::foot(std::size_t node, double time) const {
  if (!has_feet()) return Eigen::Vector2d::Zero();
  return (1.0 - time) * Eigen::Vector2d(committed_.feet[node].data()) +
         time * Eigen::Vector2d(trial_.feet[node].data());
}

double PlaneContact::move_feet(const Eigen::VectorXd& displacement) {
  const PlanePose &from = committed_.pose, &to = trial_.pose;
  double largest = 0.0;
  if (!has_feet() || (from.shift == to.shift && from.twist == to.twist)) return largest;
  for (std::size_t node = 0; node < trial_.feet.size(); ++node) {
    const meshes::Vector3 rest = unknowns_.nodes[node].position, none = meshes::Vector3::Zero();
    // The plane's motion counts as small as displacements, its turn too.
    const meshes::Vector3 way = carried(node, none, from) - carried(node, none, to),
                          own = of_node(node, displacement) -
                                of_node(node, committed_.displacement) + way;
    const bool follows = mode_ != ContactMode::frictionless;
    const double share = follows ? meshes::share_passed(own.x(), own.y(), way.x(), way.y()) : 1.0;
    const double before = reach(node);
    Eigen::Vector2d::Map(trial_.feet[node].data()) =
        foot(node, 0.0) + share * (over_obstacle(rest, to) - over_obstacle(rest, from));
    largest = std::max(largest, std::abs(reach(node) - before));
  }
  return largest;
}

PlaneContact::GapAndNormal PlaneContact::gap_and_normal(const meshes::Vector3& rest,
                                                        const meshes::Vector3& displacement,
                                                        const PlanePose& pose,
                                                        const Eigen::Vector2d& foot) const {
  const meshes::Vector3 out(0.0, 0.0, -1.0);
  const double over = pose.height - rest.z() - displacement.z();
  if (obstacle_.is_plane()) return {over, out};
  if (has_feet()) return {over - height(obstacle_, {foot.x(), foot.y(), 0.0}), out};
  meshes::Vector3 at;
  at << over_obstacle(rest + displacement, pose), over;
  const auto found = hit(obstacle_, at);
  return {found.gap,
          pose.turn() * meshes::Vector3(found.normal[0], found.normal[1], -found.normal[2])};
}

double PlaneContact::reach(std::size_t node) const {
  if (curved()) return frames_[node].reach;
  return gap_and_normal(node, meshes::Vector3::Zero(), trial_.pose, 1.0).gap;
}

double PlaneContact::linearise(const Eigen::VectorXd& displacement, const PlanePose& pose) {
  double largest = 0.0;
  for (std::size_t node = 0; node < frames_.size(); ++node) {
    const meshes::Vector3 at = of_node(node, displacement);
    const GapAndNormal now = gap_and_normal(node, at, pose, 1.0);
    // The shortest turn: in a plane of symmetry, which holds the normal, it is about the axis
    // across.
    Frame& frame = frames_[node];
    frame.axes = Eigen::Quaterniond::FromTwoVectors(-now.normal, meshes::Vector3::UnitZ())
                     .toRotationMatrix();
    frame.reach = now.gap + (frame.axes * at).z();
    if (!is_open(node)) largest = std::max(largest, std::abs(now.gap));
  }
  return largest;
}

std::vector<NodeAxes> PlaneContact::axes() const {
  std::vector<NodeAxes> result(frames_.size());
  for (std::size_t node = 0; node < result.size(); ++node) {
    for (std::size_t c = 0; c < 3; ++c) {
      const int position = unknowns_.of_node[node][c];
      if (position >= 0) result[node].unknown[c] = unknowns_.unknowns[std::size_t(position)];
    }
    result[node].axes = frames_[node].axes;
  }
  return result;
}

Eigen::VectorXd PlaneContact::out_of_balance(const Eigen::VectorXd& force) const {
  Eigen::VectorXd result = force;
  for (std::size_t node = 0; curved() && node < frames_.size(); ++node)
    set_node(node, axes(node) * of_node(node, force), result);
  result -= trial_.reaction;
  const std::vector<char> fixed = held();
  for (std::size_t i = 0; i < fixed.size(); ++i)
    if (fixed[i]) result[Eigen::Index(i)] = 0.0;
  return result;
}

std::vector<char> PlaneContact::held() const {
  std::vector<char> result(unknowns_.unknowns.size(), 0);
  for (std::size_t node = 0; node < trial_.status.size(); ++node) {
    if (trial_.status[node] == NodeStatus::open) continue;
    for (std::size_t c = trial_.status[node] == NodeStatus::stick ? 0 : 2; c < 3; ++c) {
      const int position = unknowns_.of_node[node][c];
      if (position >= 0) result[std::size_t(position)] = 1;
    }
  }
  return result;
}

meshes::Vector3 PlaneContact::carried(std::size_t node, const meshes::Vector3& anchor,
                                      const PlanePose& pose) const {
  const meshes::Vector3 rest = unknowns_.nodes[node].position, way(pose.shift, 0.0, pose.height);
  if (finite_) return pose.turn() * meshes::Vector3(rest + anchor) + way - rest;
  return anchor + way - pose.twist * meshes::Vector3::UnitZ().cross(rest);
}

meshes::Vector3 PlaneContact::carried_back(std::size_t node, const meshes::Vector3& displacement,
                                           const PlanePose& pose) const {
  const meshes::Vector3 rest = unknowns_.nodes[node].position, way(pose.shift, 0.0, pose.height);
  if (finite_) return pose.turn().inverse() * meshes::Vector3(rest + displacement - way) - rest;
  return displacement - way + pose.twist * meshes::Vector3::UnitZ().cross(rest);
}

meshes::Vector3 PlaneContact::held_at(std::size_t node) const {
  const meshes::Vector3 anchor(trial_.anchors[node].data());
  meshes::Vector3 place = axes(node) * carried(node, anchor, trial_.pose);
  if (!curved()) place.z() = reach(node);
  return place;
}

ConstrainedSolution PlaneContact::solve(ContactSolver& solver) const {
  Eigen::VectorXd values = Eigen::VectorXd::Zero(trial_.displacement.size());
  Eigen::VectorXd loads = values;
  for (std::size_t node = 0; node < trial_.status.size(); ++node) {
    if (trial_.status[node] == NodeStatus::open) continue;
    const bool slides = trial_.status[node] == NodeStatus::slide;
    meshes::Vector3 place = held_at(node);
    if (slides) place.z() = reach(node);
    set_node(node, place, values);
    if (slides) {
      meshes::Vector3 friction = own_reaction(node);
      friction.z() = 0.0;
      set_node(node, friction, loads);
    }
  }
  return solver.solve_constrained(held(), values, loads);
}

std::vector<double> PlaneContact::pulls_of(const ConstrainedSolution& solution) const {
  std::vector<double> pulls(trial_.status.size(), 0.0);
  for (std::size_t node = 0; node < pulls.size(); ++node) {
    const double own = solution.reaction[unknowns_.of_node[node][2]];
    pulls[node] += own;
    if (follows(node)) pulls[leader(node)] += own;
  }
  return pulls;
}

std::vector<std::size_t> PlaneContact::offenders(const ConstrainedSolution& solution,
                                                 double noise) const {
  // Both thresholds sit above the solver's noise, or nodes that barely touch would flicker.
  const double pull =
      solution.reaction.size() ? noise * solution.reaction.cwiseAbs().maxCoeff() : 0.0;
  const double depth = std::max(gap_noise, solution.displacement.size()
                                               ? noise * solution.displacement.cwiseAbs().maxCoeff()
                                               : 0.0);
  const std::vector<double> pulls = pulls_of(solution);
  std::vector<std::size_t> result;
  for (std::size_t node = 0; node < trial_.status.size(); ++node) {
    const bool penetrates = gap_of_solution(node, solution.displacement) < -depth;
    bool wrong = is_open(node) ? penetrates : pulls[node] > pull;
    if (follows(node)) {
      const bool led = !is_open(leader(node));
      wrong = is_open(node) ? led || (wrong && releases_[node] == 0) : wrong && !led;
    }
    if (wrong) result.push_back(node);
  }
  return result;
}

PlanePose PlaneContact::pose_on_the_way(double time) const {
  const auto between = [time](double start, double end) {
    return (1.0 - time) * start + time * end;
  };
  return {between(committed_.pose.height, trial_.pose.height),
          between(committed_.pose.shift, trial_.pose.shift),
          between(committed_.pose.twist, trial_.pose.twist)};
}

meshes::Vector3 PlaneContact::on_the_way(std::size_t node, const Eigen::VectorXd& end,
                                         double time) const {
  const meshes::Vector3 start = of_node(node, committed_.displacement);
  meshes::Vector3 place = start + time * (of_node(node, end) - start);
  // The bend is linear between the times, and none at the ends of the step.
  const std::vector<double>& times = foreknown_.times;
  const auto after = std::size_t(std::ranges::lower_bound(times, time) - times.begin());
  const double from = after == 0 ? 0.0 : times[after - 1],
               to = after == times.size() ? 1.0 : times[after];
  const double share = to > from ? (time - from) / (to - from) : 0.0;
  if (after > 0) place += (1.0 - share) * of_node(node, foreknown_.bends[after - 1]);
  if (after < times.size()) place += share * of_node(node, foreknown_.bends[after]);
  return place;
}

double PlaneContact::first_touch(std::size_t node, const Eigen::VectorXd& end,
                                 double gap_at_end) const {
  double from = 0.0,
         before = std::max(
             0.0, gap_and_normal(node, of_node(node, committed_.displacement), committed_.pose, 0.0)
                      .gap);
  const auto touch = [&](double to, double after) {
    return before > after ? from + (to - from) * before / (before - after) : to;
  };
  for (const double time : foreknown_.times) {
    const double after =
        gap_and_normal(node, on_the_way(node, end, time), pose_on_the_way(time), time).gap;
    if (after < 0.0) return touch(time, after);
    from = time, before = after;
  }
  return gap_at_end < 0.0 ? touch(1.0, gap_at_end) : 1.0;
}

void PlaneContact::anchor(std::size_t node, const Eigen::VectorXd& end, double time) {
  const PlanePose pose = pose_on_the_way(time);
  meshes::Vector3 place = on_the_way(node, end, time);
  // On the obstacle: of what is curved, the way there is not quite straight.
  const GapAndNormal left = gap_and_normal(node, place, pose, time);
  place -= left.gap * left.normal;
  meshes::Vector3::Map(trial_.anchors[node].data()) = carried_back(node, place, pose);
}

void PlaneContact::change(std::size_t node, const ConstrainedSolution& solution,
                          const Eigen::VectorXd& end) {
  const auto& of_node = unknowns_.of_node[node];
  NodeStatus& status = trial_.status[node];
  for (std::size_t c = 0; c < 2; ++c)
    if (of_node[c] >= 0) trial_.reaction[of_node[c]] = 0.0;
  if (status != NodeStatus::open) {
    status = NodeStatus::open;
    ++releases_[node];
    return;
  }
  const bool twice = mode_ == ContactMode::stick && releases_[node] > 1;
  anchor(node, end,
         twice ? 1.0 : first_touch(node, end, gap_of_solution(node, solution.displacement)));
  status = touching();
}

void PlaneContact::foresee(ForeknownStep step, const PlanePose& pose) {
  foreknown_ = std::move(step);
  trial_.pose = pose;
  for (std::size_t node = 0; node < trial_.status.size(); ++node) {
    const SurfaceNode& at = unknowns_.nodes[node];
    const double left = gap_and_normal(node, of_node(node, foreknown_.end), pose, 1.0).gap,
                 width = at.area > 0.0 ? at.area / at.extent : 0.0;
    if (!is_open(node) || left > foreseen_touch * width) continue;
    trial_.status[node] = touching();
    anchor(node, foreknown_.end, first_touch(node, foreknown_.end, left));
  }
}

void PlaneContact::touch_at_start() {
  for (std::size_t node = 0; node < trial_.status.size(); ++node)
    if (trial_.status[node] == NodeStatus::open &&
        gap_and_normal(node, of_node(node, committed_.displacement), committed_.pose, 0.0).gap <=
            gap_noise) {
      trial_.status[node] = touching();
      anchor(node, committed_.displacement, 0.0);
    }
}

std::vector<int> PlaneContact::sliding_unknowns() const {
  std::vector<int> result;
  for (std::size_t node = 0; node < trial_.status.size(); ++node)
    for (std::size_t c = 0; c < 2 && trial_.status[node] == NodeStatus::slide; ++c)
      if (const int i = unknowns_.of_node[node][c]; i >= 0) result.push_back(i);
  return result;
}

double PlaneContact::update_friction(const ConstrainedSolution& solution, bool may_stick,
                                     double noise) {
  double largest_push = 0.0, largest_change = 0.0;
  const std::vector<double> pulls = pulls_of(solution);
  // A node that the solver's noise alone puts beyond Coulomb's limit, or below, stays what it is.
  double slack = 0.0, area = 0.0;
  for (std::size_t node = 0; node < trial_.status.size(); ++node) {
    if (is_open(node)) continue;
    area += unknowns_.nodes[node].area;
    slack = std::max(slack, -noise * friction_ * pulls[node]);
  }
  const double stiffness = slip_stiffness * shear_modulus_ / std::sqrt(area);
  for (std::size_t node = 0; node < trial_.status.size(); ++node) {
    if (trial_.status[node] == NodeStatus::open) continue;
    const auto& of_node = unknowns_.of_node[node];
    const double push = std::max(0.0, -pulls[node]);
    largest_push = std::max(largest_push, push);
    const bool sliding = trial_.status[node] == NodeStatus::slide;
    const double rho = stiffness * unknowns_.nodes[node].area;
    Eigen::Vector2d force = Eigen::Vector2d::Zero(), wanted = force;
    const meshes::Vector3 start = held_at(node);
    for (std::size_t c = 0; c < 2; ++c) {
      if (of_node[c] < 0) continue;
      force[Eigen::Index(c)] = wanted[Eigen::Index(c)] = solution.reaction[of_node[c]];
      const double slip = solution.displacement[of_node[c]] - start[Eigen::Index(c)];
      if (sliding) wanted[Eigen::Index(c)] -= rho * slip;
    }
    const double margin = std::max(slack, friction_converged * friction_ * push);
    const bool holds = wanted.norm() <= friction_ * push + (sliding ? -margin : margin);
    if (holds && (!sliding || may_stick)) {
      if (sliding) largest_change = std::numeric_limits<double>::infinity();
      trial_.status[node] = NodeStatus::stick;
      continue;
    }
    if (!sliding) largest_change = std::numeric_limits<double>::infinity();
    trial_.status[node] = NodeStatus::slide;
    const Eigen::Vector2d next =
        holds ? wanted : Eigen::Vector2d(friction_ * push * wanted.normalized());
    largest_change = std::max(largest_change, (next - force).norm());
    for (std::size_t c = 0; c < 2; ++c)
      if (of_node[c] >= 0) trial_.reaction[of_node[c]] = next[Eigen::Index(c)];
  }
  return largest_push > 0.0 ? largest_change / largest_push : 0.0;
}

void PlaneContact::stick_where_friction_holds(const ConstrainedSolution& solution) {
  constexpr double almost = 1.0 - 1e-6;
  const std::vector<double> pulls = pulls_of(solution);
  for (std::size_t node = 0; node < trial_.status.size(); ++node)
    if (trial_.status[node] == NodeStatus::slide && shear(node) < almost * friction_ * -pulls[node])
      trial_.status[node] = NodeStatus::stick;
}

ContactEffort PlaneContact::solve(ContactSolver& solver, const PlanePose& pose) {
  ContactEffort effort;
  trial_.pose = pose;
  releases_.assign(trial_.status.size(), 0);
  move_feet(expected());
  touch_at_start();
  for (int move = 0; move < max_foot_moves; ++move) {
    settle(solver, effort);
    if (move_feet(trial_.displacement) <= feet_settled * deepest()) break;
  }
  return effort;
}

Eigen::VectorXd PlaneContact::expected() const {
  Eigen::VectorXd result = committed_.displacement;
  const meshes::Vector3 none = meshes::Vector3::Zero();
  for (std::size_t node = 0; node < trial_.status.size(); ++node)
    if (trial_.status[node] == NodeStatus::stick)
      set_node(node,
               of_node(node, result) + carried(node, none, trial_.pose) -
                   carried(node, none, committed_.pose),
               result);
  return result;
}

double PlaneContact::deepest() const {
  double depth = gap_noise / feet_settled;
  for (std::size_t node = 0; node < trial_.status.size(); ++node)
    depth = std::max(depth, -reach(node));
  return depth;
}

void PlaneContact::settle(ContactSolver& solver, ContactEffort& effort) {
  const int first = effort.rounds;
  std::size_t fewest = std::numeric_limits<std::size_t>::max();
  int stalled = 0;
  AndersonMixing mixing;
  while (effort.rounds - first < max_rounds) {
    const ConstrainedSolution solution = solve(solver);
    ++effort.rounds;
    effort.cg_iterations += solution.cg_iterations;
    std::vector<std::size_t> wrong = offenders(solution, solver.noise());
    double change = 0.0;
    if (mode_ == ContactMode::coulomb) {
      const std::vector<int> sliding = sliding_unknowns();
      const Eigen::VectorXd before = trial_.reaction(sliding);
      change =
          update_friction(solution, effort.rounds - first <= friction_patience, solver.noise());
      if (wrong.empty() && std::isfinite(change))
        trial_.reaction(sliding) = mixing.next(before, trial_.reaction(sliding));
      else
        mixing.forget();
    }
    if (wrong.empty() && change <= std::max(friction_converged, solver.noise())) {
      trial_.displacement = in_plane_axes(solution.displacement);
      trial_.reaction = solution.reaction;
      if (mode_ == ContactMode::coulomb) stick_where_friction_holds(solution);
      return;
    }
    stalled = wrong.size() < fewest ? 0 : stalled + 1;
    fewest = std::min(fewest, wrong.size());
    if (stalled > patience && wrong.size() > 1) wrong.erase(wrong.begin() + 1, wrong.end());
    const Eigen::VectorXd end = in_plane_axes(solution.displacement);
    for (const std::size_t node : wrong) this->change(node, solution, end);
  }
  throw meshes::NotConverged("the contact state did not converge within " +
                             std::to_string(max_rounds) + " rounds");
}

}  // namespace fingertip::fem_reference::inline contact
