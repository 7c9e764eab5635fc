#include "lattice/press/static_press.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <string>

#include "lattice/contact/contact_smoothing.h"
#include "lattice/model/model.h"
#include "lattice/press/marker_points.h"
#include "lattice/press/press_pictures.h"
#include "lattice/press/step_error.h"
#include "lattice/statics/cut_lattice.h"
#include "lattice/statics/elastic_system.h"
#include "lattice/statics/equilibrium.h"
#include "lattice/statics/static_contact.h"
#include "meshes/base/files.h"
#include "meshes/press/contact_patch.h"
#include "meshes/press/no_equilibrium.h"

namespace fingertip::lattice::inline press {

using Eigen::VectorXd;
using meshes::ContactMode;
using meshes::DriveMode;
using meshes::PressSample;
using meshes::Vector3;

namespace {

/// Longest step, as a share of the rubber's thickness, where a state owes something to those before
/// it or is not easily found.
constexpr double longest_share = 1.0 / 10.0;
/// The same of the published lattice, whose particles touch plane by plane, and where the plane
/// turns, of which no error is told.
constexpr double longest_share_untold = 1.0 / 40.0;
/// The same where points slide, each straight within a step: lateral forces of a partial slip are
/// then within 2 % of those of ever smaller steps, with 1/40 7 % too small.
constexpr double longest_share_of_slip = 1.0 / 100.0;
/// A step that fails is not made smaller than this share.
constexpr double smallest_share = 1.0 / 12800.0;
/// Steps are as long as leaves the force of what sticks in doubt by this share (StepError).
constexpr double step_tolerance = 2e-3;
/// Rounds of releasing and anchoring within a step.
constexpr int max_rounds = 60;
/// Unbalanced force that is small enough for anchors.
constexpr double search_tolerance = 1e-6;

/// What PressSetup::violations() demands of a static press, whatever mode it says.
std::vector<meshes::Violation> violations_of(const PressSetup& setup) {
  PressSetup relevant = setup;
  relevant.protocol.mode = DriveMode::equilibrium;
  relevant.rod = {};
  relevant.controller = {};
  return relevant.violations();
}

/// By Poisson's ratio, E held: G = E/(2 + 2 nu), and lambda by E and G.
PressDirections ratio_direction(const PressSetup& setup) {
  const meshes::Rubber& rubber = setup.rubber;
  const double by_ratio = -rubber.shear_modulus / (1.0 + rubber.poissons_ratio());
  const PressDirections lame = lame_directions(setup.lattice);
  return {lame.parameters,
          lame.rates * Eigen::Vector2d(by_ratio, by_ratio * rubber.lambda_slopes()(1))};
}

void check(const PressSetup& setup) {
  const auto found = violations_of(setup);
  if (!found.empty()) throw meshes::InvalidInput(found);
}

/// One path of equilibria.
class StaticPress {
 public:
  StaticPress(const PressSetup& setup, const LatticeBody& body, const StaticObserver& observer);
  /// Carries derivatives along; `system` must outlive the press. One by Poisson's ratio goes into
  /// the response.
  void differentiate(const SlopeSystem& system, bool by_ratio = false);
  /// Takes pictures along.
  void picture() {
    pictures_.emplace(setup_, body_.sectors, body_.rest, nullptr, Moment::first_touch, outcome_);
  }
  StaticOutcome run();
  /// Of the samples, a row each; as many as were finished.
  const PressSlopes& slopes() const { return slopes_; }

 private:
  /// All that a step changes.
  struct State {
    StaticContact contact;
    VectorXd displacement;
    StateSlopes slopes;  ///< empty unless differentiated
  };

  void take_census();
  void march_to(double target);
  bool step_to(double place, bool is_sample);
  /// That doubt alone asks for [m].
  double shortest_step() const { return longest_share_of_slip * setup_.geometry.thickness(); }
  double next_step() const;
  VectorXd extrapolated(double place) const;
  bool anchor(State& next);
  void take_over(State next, const VectorXd& predicted);
  Wrench on_rod(const VectorXd& displacement) const;
  PressSample sample() const;
  FingerPicture drawn();
  void note_slopes();
  void note_contact();
  void note_markers();
  void report();

  const PressSetup& setup_;
  const LatticeBody& body_;
  const StaticObserver& observer_;
  const meshes::PressPath path_;
  const ElasticSystem system_;
  EquilibriumSolver solver_;
  const SlopeSystem* slope_system_ = nullptr;
  bool by_ratio_ = false;
  double search_tolerance_ = search_tolerance, tolerance_ = force_tolerance;
  State now_;
  double previous_place_ = 0.0;
  VectorXd previous_displacement_;  ///< one step ago
  double longest_step_ = 0.0, step_ = 0.0;
  StepError step_error_;
  StaticOutcome outcome_;
  std::optional<PressPictures> pictures_;
  const MarkerPoints markers_;
  PressSlopes slopes_;
  std::chrono::steady_clock::time_point started_ = std::chrono::steady_clock::now();
};

StaticPress::StaticPress(const PressSetup& setup, const LatticeBody& body,
                         const StaticObserver& observer)
    : setup_(setup),
      body_(body),
      observer_(observer),
      path_(setup.protocol),
      system_(body),
      solver_(system_, Team(std::max(1, setup.threads))),
      now_{StaticContact(body, press_plane(setup.protocol, setup.geometry),
                         {setup.protocol.contact, setup.protocol.friction}),
           VectorXd::Zero(body.unknowns()),
           {}},
      previous_displacement_(now_.displacement),
      step_error_(body),
      markers_(setup, body.sectors, body.rest) {
  const bool direct = !body.finite && setup.protocol.contact == ContactMode::frictionless;
  const double share = now_.contact.rubs()                           ? longest_share_of_slip
                       : setup.lattice.model == ModelKind::published ? longest_share_untold
                                                                     : longest_share;
  longest_step_ = direct ? path_.length() : share * setup.geometry.thickness();
  step_ = longest_step_;
  if (now_.contact.holds()) step_ = std::min(step_, 2.0 * shortest_step());
  take_census();
}

void StaticPress::differentiate(const SlopeSystem& system, bool by_ratio) {
  slope_system_ = &system;
  by_ratio_ = by_ratio;
  search_tolerance_ = tolerance_ = slope_tolerance;
  now_.slopes = system.at_rest();
}

void StaticPress::take_census() {
  outcome_.particles = body_.rest.size();
  outcome_.cells = body_.cells.size();
  outcome_.springs = body_.fibres.size() + body_.springs.size();
  outcome_.unknowns =
      std::size_t(body_.unknowns()) - std::size_t(std::ranges::count(body_.fixed, std::uint8_t{1}));
  outcome_.sectors = body_.sectors;
  outcome_.volume = body_.sectors * std::accumulate(body_.mass.begin(), body_.mass.end(), 0.0) /
                    setup_.rubber.density;
  outcome_.exact_volume = setup_.geometry.tip_volume();
}

StaticOutcome StaticPress::run() {
  const std::size_t samples = path_.samples().size();
  // An equilibrium at indentation 0 touches, without force.
  if (pictures_) pictures_->keep(drawn());
  for (std::size_t i = 0; i < samples; ++i) {
    march_to(path_.samples()[i]);
    if (pictures_ && i + 1 < samples && pictures_->due(now_.contact.pose().indentation, true))
      pictures_->keep(drawn());
    outcome_.response.append(sample());
    outcome_.response.back().stage = path_.stage(i);
    if (slope_system_) note_slopes();
    note_contact();
    note_markers();
    report();
  }
  if (pictures_) pictures_->finish(drawn());
  return std::move(outcome_);
}

void StaticPress::march_to(double target) {
  // Steps of equal length, so that none is left over at the end.
  const bool turns =
      now_.contact.holds() && path_.at(now_.contact.place()).twist != path_.at(target).twist;
  const double most = turns ? longest_share_untold * setup_.geometry.thickness() : longest_step_;
  while (now_.contact.place() < target) {
    const double left = target - now_.contact.place();
    const double count = std::ceil(left / std::min(step_, most) - 1e-9);
    const bool last = count <= 1.0;
    if (step_to(last ? target : now_.contact.place() + left / count, last)) {
      step_ = next_step();
      if (!last) report();
      continue;
    }
    step_ = 0.5 * left / std::max(count, 1.0);
    if (step_ < smallest_share * setup_.geometry.thickness()) {
      throw meshes::NoEquilibrium("the static press", now_.contact.pose(), "",
                                  "take a finer lattice (lattice.spacing)");
    }
  }
}

/// The last step's motion continued, where that turns no cell inside out.
VectorXd StaticPress::extrapolated(double place) const {
  const double from = now_.contact.place(), before = from - previous_place_;
  if (!(before > 0.0) || path_.bends(previous_place_, place)) return now_.displacement;
  const VectorXd guess =
      now_.displacement + (place - from) / before * (now_.displacement - previous_displacement_);
  return std::isfinite(system_.energy(guess)) ? guess : now_.displacement;
}

/// The next step's length [m].
double StaticPress::next_step() const {
  const double suited = std::max(step_error_.length_for(step_tolerance), shortest_step());
  return std::min({2.0 * step_, longest_step_, suited});
}

/// On the way to a sample a state need be no better than what its anchors come from.
bool StaticPress::step_to(double place, bool is_sample) {
  const VectorXd predicted = extrapolated(place);
  State next{now_.contact, predicted, now_.slopes};
  next.contact.begin_step(place, now_.displacement);
  const double enough = is_sample ? tolerance_ : search_tolerance_;
  double tolerance = next.contact.holds() ? search_tolerance_ : enough;
  for (int round = 0;; ++round) {
    if (round == max_rounds) return false;
    next.contact.move_feet(next.displacement);
    if (!solver_.solve(next.contact, next.displacement, tolerance)) return false;
    if (next.contact.release_pulled(next.displacement) > 0) continue;
    if (tolerance != enough) {
      tolerance = enough;
    } else if (!anchor(next)) {
      break;
    }
  }
  if (next.contact.rubs()) next.contact.end_step(next.displacement);
  take_over(std::move(next), predicted);
  return true;
}

/// The next state becomes the present one.
void StaticPress::take_over(State next, const VectorXd& predicted) {
  if (next.contact.holds() && next.contact.pose().twist == now_.contact.pose().twist)
    step_error_.note(now_.contact, now_.displacement, next.contact, next.displacement, predicted,
                     on_rod(next.displacement).force.norm());
  previous_place_ = now_.contact.place();
  previous_displacement_.swap(now_.displacement);
  now_ = std::move(next);
  ++outcome_.steps;
  outcome_.smallest_jacobian =
      std::min(outcome_.smallest_jacobian, system_.smallest_jacobian(now_.displacement));
}

/// Anchors what has crossed the plane since the step's start; whether anything has.
bool StaticPress::anchor(State& next) {
  const double from = now_.contact.place();
  if (slope_system_ && next.contact.holds()) {
    const auto touches = next.contact.first_touches(now_.displacement, from, next.displacement);
    slope_system_->respond(solver_, next.contact, next.displacement, touches, now_.slopes,
                           next.slopes);
    slope_system_->anchor(touches, now_.slopes, next.slopes);
  }
  return next.contact.anchor_touching(now_.displacement, from, next.displacement) > 0;
}

/// Force and torque on the rod from the bond's ties. A tie's pull goes through its point on the
/// rod, at rest or not, and the body's forces balance: they are those of the plane, too.
Wrench StaticPress::on_rod(const VectorXd& displacement) const {
  const Vector3 endpoint = setup_.geometry.rod_endpoint();
  Vector3 force = Vector3::Zero(), torque = Vector3::Zero();
  for (const EmbeddedPoint& point : body_.bond) {
    const Vector3 pull = point.stiffness * shift(point, displacement);
    force += pull;
    torque += (point.rest - endpoint).cross(pull);
  }
  // Mirror images: y -> -y turns (f, t) into (fx, -fy, fz), (-tx, ty, -tz); x -> -x likewise.
  if (body_.sectors > 1) force.y() = torque.x() = torque.z() = 0.0;
  if (body_.sectors > 2) force.x() = torque.y() = 0.0;
  return {body_.sectors * force, body_.sectors * torque};
}

PressSample StaticPress::sample() const {
  const auto [force, torque] = on_rod(now_.displacement);
  const PressPlane& plane = now_.contact.plane();
  PressSample sample;
  const meshes::PressPose pose = now_.contact.pose();
  sample.indentation = pose.indentation;
  sample.lateral_displacement = pose.lateral;
  sample.twist = pose.twist;
  sample.normal_force = force.dot(plane.normal);
  sample.step_error = step_error_.relative() * std::abs(sample.normal_force);
  sample.lateral_force_x = force.dot(plane.t1);
  sample.lateral_force_y = force.dot(plane.t2);
  sample.torque_x = torque.x();
  sample.torque_y = torque.y();
  sample.torque_z = torque.z();
  return sample;
}

/// In world axes in which the plane stands still, but for a twist, and the rod, at its starting
/// place at first touch, comes nearer, as in a press in motion. What the contact holds of a surface
/// point's cell it holds of its particles.
FingerPicture StaticPress::drawn() {
  const PressPlane& plane = now_.contact.plane();
  const Vector3 travel = plane.point(0.0) - plane.point(now_.contact.place());
  ComputedParticles particles{{}, std::vector<std::uint8_t>(body_.rest.size(), 0)};
  for (std::size_t p = 0; p < body_.rest.size(); ++p)
    particles.moved.emplace_back(now_.displacement.segment<3>(3 * Eigen::Index(p)));
  for (std::size_t i = 0; i < body_.outer.size(); ++i) {
    if (!now_.contact.touches(i, now_.displacement)) continue;
    for (std::size_t c = 0; c < 8; ++c)
      if (body_.outer[i].weights[c] != 0.0) particles.held[body_.outer[i].corners[c]] = 1;
  }
  FingerPicture bare;
  bare.time = meshes::unknown;
  bare.indentation = now_.contact.pose().indentation;
  bare.rod.position = travel;
  bare.endpoint = setup_.geometry.rod_endpoint() + travel;
  bare.on_rod = on_rod(now_.displacement);
  bare.plane.point = plane.point(0.0);
  bare.plane.normal = plane.normal;
  bare.plane.obstacle = plane.obstacle;
  bare.plane.turned = Eigen::AngleAxisd(now_.contact.pose().twist, plane.normal);
  return pictures_->tip().draw(std::move(bare), particles, travel);
}

/// Frictionless, a state owes nothing to those before it: only samples need slopes.
void StaticPress::note_slopes() {
  slope_system_->respond(solver_, now_.contact, now_.displacement, {}, now_.slopes, now_.slopes);
  const Eigen::Matrix3Xd force = slope_system_->force(now_.displacement, now_.slopes);
  const PressPlane& plane = now_.contact.plane();
  const auto append = [](const Eigen::RowVectorXd& row, Eigen::MatrixXd& table) {
    table.conservativeResize(table.rows() + 1, row.size());
    table.bottomRows(1) = row;
  };
  append(plane.normal.transpose() * force, slopes_.normal_force);
  append(plane.t1.transpose() * force, slopes_.lateral_force_x);
  append(plane.t2.transpose() * force, slopes_.lateral_force_y);
  if (!by_ratio_) return;
  // Every energy, those of ties included, is proportional to E where nu is held; so are forces.
  PressSample& sample = outcome_.response.back();
  sample.slope_youngs_modulus = sample.normal_force / setup_.rubber.youngs_modulus;
  sample.slope_poissons_ratio = slopes_.normal_force.bottomRows(1).value();
}

void StaticPress::note_contact() {
  const auto field = contact_field(now_.contact.points(now_.displacement), body_.sectors,
                                   {setup_.protocol.contact, setup_.protocol.friction});
  PressSample& sample = outcome_.response.back();
  sample.set_contact(contact_radius(field), largest_pressure(field));
  sample.spin_torque = spin_torque(field);
  add_sample(field, int(outcome_.response.samples().size()), now_.contact.pose().indentation,
             outcome_.contact);
}

/// The rod stands still.
void StaticPress::note_markers() {
  if (markers_.empty()) return;
  const auto moved = [this](std::uint32_t particle) -> Vector3 {
    return now_.displacement.segment<3>(3 * Eigen::Index(particle));
  };
  add_sample(meshes::marker_rows(setup_.protocol.markers, markers_.displacements(moved)),
             int(outcome_.response.samples().size()), now_.contact.pose().indentation,
             outcome_.markers);
}

void StaticPress::report() {
  outcome_.newton_iterations = solver_.effort().newton_iterations;
  outcome_.factorisations = solver_.effort().factorisations;
  outcome_.gradients = solver_.effort().gradients;
  outcome_.wall_time =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - started_).count();
  if (observer_ && !observer_(outcome_, now_.contact.place() / path_.length()))
    throw meshes::Interrupted("the press was interrupted");
}

}  // namespace

LatticeBody static_body(const PressSetup& setup, int sectors) {
  if (setup.lattice.model != ModelKind::published)
    return build_cut_tip(setup.geometry, setup.rubber, setup.lattice, sectors);
  return body_of(build_published_tip(setup.geometry, setup.rubber, setup.lattice), setup.geometry,
                 setup.rubber);
}

StaticOutcome run_static_press(const PressSetup& setup, const StaticObserver& observer,
                               bool pictured) {
  check(setup);
  const LatticeBody body =
      static_body(setup, largest_symmetry(setup.geometry, setup.lattice, setup.protocol));
  StaticPress press(setup, body, observer);
  if (pictured) press.picture();
  std::optional<SlopeSystem> slopes;
  if (setup.slopes) press.differentiate(slopes.emplace(setup, body, ratio_direction(setup)), true);
  return press.run();
}

StaticOutcome run_static_press(const PressSetup& setup, const LatticeBody& body,
                               const StaticObserver& observer) {
  check(setup);
  return StaticPress(setup, body, observer).run();
}

StaticOutcomeWithSlopes run_static_press_with_slopes(const PressSetup& setup,
                                                     const PressDirections& directions,
                                                     const StaticObserver& observer) {
  check(setup);
  const LatticeBody body =
      static_body(setup, largest_symmetry(setup.geometry, setup.lattice, setup.protocol));
  const SlopeSystem system(setup, body, directions);
  StaticPress press(setup, body, observer);
  press.differentiate(system);
  StaticOutcome outcome = press.run();
  return {std::move(outcome), press.slopes()};
}

}  // namespace fingertip::lattice::inline press
