#include "lattice/model/rod.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <cmath>
#include <numbers>

namespace fingertip::lattice::inline model {

using Eigen::Matrix3d;
using meshes::Vector3;

namespace {

Matrix3d cross_matrix(const Vector3& v) {
  Matrix3d m;
  m << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return m;
}

/// Parallel axes: inertia about a point at `arm` from the centre of mass.
Matrix3d shifted(double mass, const Vector3& arm) {
  return mass * (arm.squaredNorm() * Matrix3d::Identity() - arm * arm.transpose());
}

/// What holds a profile: a cylinder as wide as the bond and as long, below the lowest rubber.
RodBody hand_body(const meshes::Geometry& geometry, const RodSettings& settings) {
  const double r = geometry.rod_radius, length = 2.0 * r;
  RodBody body;
  body.mass = settings.density * std::numbers::pi * r * r * length;
  body.centre = Vector3(0.0, 0.0, geometry.lowest() - 0.5 * length);
  body.endpoint = geometry.rod_endpoint();
  const double across = body.mass * (3.0 * r * r + length * length) / 12.0;
  body.inertia = Vector3(across, across, 0.5 * body.mass * r * r).asDiagonal();
  return body;
}

}  // namespace

double largest_ratio(const Matrix6& form, const Matrix6& inertia) {
  return Eigen::GeneralizedSelfAdjointEigenSolver<Matrix6>(form, inertia, Eigen::EigenvaluesOnly)
      .eigenvalues()
      .maxCoeff();
}

Matrix6 rigid_inertia(double mass, const Vector3& arm, const Matrix3d& inertia) {
  Matrix6 matrix;
  matrix.topLeftCorner<3, 3>() = mass * Matrix3d::Identity();
  matrix.topRightCorner<3, 3>() = -mass * cross_matrix(arm);
  matrix.bottomLeftCorner<3, 3>() = mass * cross_matrix(arm);
  matrix.bottomRightCorner<3, 3>() = inertia + shifted(mass, arm);
  return matrix;
}

Eigen::Matrix<double, 3, 6> rigid_motion(const Vector3& arm) {
  Eigen::Matrix<double, 3, 6> matrix;
  matrix << Matrix3d::Identity(), -cross_matrix(arm);
  return matrix;
}

RodBody rod_body(const meshes::Geometry& geometry, const RodSettings& settings) {
  if (!geometry.is_dome()) return hand_body(geometry, settings);
  const double r = geometry.rod_radius, l = geometry.rod_length;
  const double cylinder = settings.density * std::numbers::pi * r * r * l;
  const double dome = settings.density * 2.0 / 3.0 * std::numbers::pi * r * r * r;
  const Vector3 cylinder_centre(0.0, 0.0, -0.5 * l), dome_centre(0.0, 0.0, 0.375 * r);
  RodBody body;
  body.mass = cylinder + dome;
  body.centre = (cylinder * cylinder_centre + dome * dome_centre) / body.mass;
  body.endpoint = geometry.rod_endpoint();
  const double cylinder_across = cylinder * (3.0 * r * r + l * l) / 12.0;
  const double dome_across = 83.0 / 320.0 * dome * r * r;  // about the dome's own centre of mass
  const Vector3 own(cylinder_across + dome_across, cylinder_across + dome_across,
                    0.5 * cylinder * r * r + 0.4 * dome * r * r);
  body.inertia = Matrix3d(own.asDiagonal()) + shifted(cylinder, cylinder_centre - body.centre) +
                 shifted(dome, dome_centre - body.centre);
  return body;
}

Eigen::Quaterniond rotation_by(const Vector3& turn) {
  const double angle = turn.norm();
  if (angle < 1e-150) return Eigen::Quaterniond::Identity();
  return Eigen::Quaterniond(Eigen::AngleAxisd(angle, turn / angle));
}

Vector3 rotation_vector(const Eigen::Quaterniond& rotation) {
  const Eigen::AngleAxisd turn(rotation);
  return turn.angle() * turn.axis();
}

RodState::RodState(const RodBody& body) : body_(body), centre_(body.centre) {}

Pose RodState::pose() const {
  return {centre_ - orientation_ * body_.centre, orientation_};
}

Matrix3d RodState::world_inertia() const {
  const Matrix3d turn = orientation_.toRotationMatrix();
  return turn * body_.inertia * turn.transpose();
}

Vector3 RodState::angular_velocity() const {
  const Matrix3d turn = orientation_.toRotationMatrix();
  return turn * (body_.inertia.inverse() * (turn.transpose() * spin_));
}

Vector3 RodState::velocity_at(const Vector3& point) const {
  return velocity() + angular_velocity().cross(point - centre_);
}

double RodState::kinetic_energy() const {
  return 0.5 * momentum_.squaredNorm() / body_.mass + 0.5 * angular_velocity().dot(spin_);
}

void RodState::kick(const Wrench& wrench, const Vector3& at, double duration) {
  momentum_ += duration * wrench.force;
  spin_ += duration * (wrench.torque + (at - centre_).cross(wrench.force));
}

void RodState::drift(double duration) {
  const Eigen::Quaterniond start = orientation_;
  orientation_ = rotation_by(0.5 * duration * angular_velocity()) * start;  // halfway
  orientation_ = (rotation_by(duration * angular_velocity()) * start).normalized();
  centre_ += duration * velocity();
}

void RodState::prescribe(const Vector3& travel, const Vector3& velocity) {
  centre_ = body_.centre + travel;
  orientation_.setIdentity();
  set_velocity(velocity, Vector3::Zero());
}

void RodState::set_velocity(const Vector3& velocity, const Vector3& angular_velocity) {
  momentum_ = body_.mass * velocity;
  spin_ = world_inertia() * angular_velocity;
}

void RodState::set_state(const Vector3& centre, const Eigen::Quaterniond& orientation,
                         const Vector3& momentum, const Vector3& angular_momentum) {
  centre_ = centre;
  orientation_ = orientation.normalized();
  momentum_ = momentum;
  spin_ = angular_momentum;
}

}  // namespace fingertip::lattice::inline model
