#include "lattice/contact/bond.h"

namespace fingertip::lattice::inline contact {

using meshes::Vector3;

Wrench add_ligament_forces(const LatticeModel& model, const State& state, const RodState& rod,
                           VectorField& force) {
  const Pose pose = rod.pose();
  const Eigen::Matrix3d turn = pose.orientation.toRotationMatrix(), axes = model.grid.axes;
  const Vector3 endpoint = rod.endpoint(), spin = rod.angular_velocity();
  const Vector3 velocity = rod.velocity() - spin.cross(rod.centre());
  Wrench on_rod;
  for (const Ligament& ligament : model.ligaments) {
    const Vector3& rest = ligament.rest;
    const Vector3 at = rest + axes * state.displacement.at(ligament.particle);
    const Vector3 stretch = at - (pose.position + turn * rest);
    const Vector3 rate = axes * state.velocity.at(ligament.particle) - (velocity + spin.cross(at));
    const Vector3 on_particle = -ligament.stiffness * stretch - ligament.damping * rate;
    force.add(ligament.particle, axes.transpose() * on_particle);
    on_rod.force -= on_particle;
    on_rod.torque -= (at - endpoint).cross(on_particle);
  }
  return on_rod;
}

double ligament_energy(const LatticeModel& model, const State& state, const Pose& rod) {
  double sum = 0.0;
  for (const Ligament& ligament : model.ligaments) {
    const Vector3& rest = ligament.rest;
    const Vector3 moved = model.grid.axes * state.displacement.at(ligament.particle);
    const Vector3 stretch = rest + moved - rod * rest;
    sum += ligament.stiffness * stretch.squaredNorm();
  }
  return 0.5 * sum;
}

}  // namespace fingertip::lattice::inline contact
