#include "lattice/grasp/hand.h"

#include <set>

#include "lattice/forces/energy.h"
#include "meshes/base/files.h"

namespace fingertip::lattice::inline grasp {

using meshes::Vector3;

namespace {

/// Share of the rubber's thickness that a tip is not pressed beyond.
constexpr double deepest = 0.7;

Pose finger_base(const HandSetup& setup, double side) {
  const double distance = 0.5 * setup.block.width + setup.clearance + setup.finger.geometry.pole();
  Eigen::Matrix3d axes;  // columns: the finger's x, y, z
  axes.col(2) = Vector3(-side, 0.0, 0.0);
  axes.col(0) = Vector3::UnitZ();
  axes.col(1) = axes.col(2).cross(axes.col(0));
  return {Vector3(side * distance, 0.0, 0.0), Eigen::Quaterniond(axes)};
}

Wrench in_world(const Wrench& wrench, const Pose& base) {
  const Vector3 force = base.orientation * wrench.force;
  return {force, base.orientation * wrench.torque + base.position.cross(force)};
}

}  // namespace

Hand::Hand(const HandSetup& setup, double period)
    : setup_(setup), block_(block_body(setup.block)), supported_(setup.supported) {
  for (std::size_t i = 0; i < 2; ++i) {
    bases_[i] = finger_base(setup, sides[i]);
    FingerSetup finger = setup.finger;
    finger.plane = face_plane(setup.block, block_, sides[i], bases_[i]);
    finger.gravity = bases_[i].orientation.conjugate() * Vector3(0.0, 0.0, -setup.gravity);
    fingers_[i] = std::make_unique<VirtualFinger>(finger);
  }
  step_ = fingers_[0]->step_report(period).step;
  coupling_ = find_coupling();
  if (!(coupling_ < max_coupling)) {
    const double least = setup.block.mass * coupling_ / max_coupling;
    throw meshes::InvalidInput(
        {"grasp.block_mass", meshes::to_text(setup.block.mass) + " kg",
         "the block must outweigh the rubber that touches it: at this spacing at least " +
             meshes::to_text(least) + " kg in a box of this size",
         "take a heavier block or a finer lattice"});
  }
}

double Hand::find_coupling() const {
  const meshes::Geometry& geometry = setup_.finger.geometry;
  const double lowest = geometry.pole() - deepest * geometry.thickness();
  const RodBody& body = block_.body();
  Matrix6 touching = Matrix6::Zero();
  for (std::size_t i = 0; i < 2; ++i) {
    const LatticeModel& model = fingers_[i]->model();
    std::set<std::uint32_t> corners;
    for (const EmbeddedPoint& tie : model.outer) {
      if (tie.rest.z() >= lowest) corners.insert(tie.corners.begin(), tie.corners.end());
    }
    for (const std::uint32_t corner : corners) {
      Vector3 place = bases_[i] * model.rest_position(corner);
      place.x() = 0.5 * sides[i] * setup_.block.width;  // on the face once it touches
      touching += rigid_inertia(model.mass[corner], place - body.centre);
    }
  }
  return largest_ratio(touching, rigid_inertia(body.mass, Vector3::Zero(), body.inertia));
}

Vector3 Hand::momentum() const {
  Vector3 sum = block_.momentum();
  for (std::size_t i = 0; i < 2; ++i) {
    const VirtualFinger& finger = *fingers_[i];
    sum += bases_[i].orientation * linear_momentum(finger.model(), finger.finger().state());
  }
  return sum;
}

void Hand::advance() {
  Wrench impulse;  // on the block, about the world's origin
  for (std::size_t i = 0; i < 2; ++i) {
    VirtualFinger& finger = *fingers_[i];
    finger.move_plane(face_plane(setup_.block, block_, sides[i], bases_[i]));
    Wrench on_tip;
    Vector3 from_rod = Vector3::Zero();
    finger.do_step(step_, [&] {
      from_rod -= finger.finger().step() * finger.finger().bond().force;
      on_tip.force += finger.finger().plane_impulse().force;
      on_tip.torque += finger.finger().plane_impulse().torque;
      return true;
    });
    const Wrench given = in_world(on_tip, bases_[i]);
    on_block_[i] = {-given.force / step_, -given.torque / step_};
    impulse.force -= given.force;
    impulse.torque -= given.torque;
    impulse_ += bases_[i].orientation * from_rod +
                step_ * finger.model().total_mass() * Vector3(0.0, 0.0, -setup_.gravity);
  }
  const Vector3 weight(0.0, 0.0, -setup_.block.mass * setup_.gravity);
  const double upward = impulse.force.z() + step_ * weight.z();
  if (supported_ && upward <= 0.0) {
    support_force_ = -upward / step_;
    impulse_ -= impulse.force;  // weight and support together
    return;
  }
  supported_ = false;
  support_force_ = 0.0;
  impulse_ += step_ * weight;
  block_.drift(step_);
  block_.kick(impulse, Vector3::Zero(), 1.0);
  block_.kick({weight, Vector3::Zero()}, block_.centre(), step_);
}

}  // namespace fingertip::lattice::inline grasp
