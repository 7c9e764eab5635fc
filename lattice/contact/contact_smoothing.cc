#include "lattice/contact/contact_smoothing.h"

#include <Eigen/Geometry>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace fingertip::lattice::inline contact {

using Eigen::Matrix3d;
using meshes::ContactPoint;
using meshes::Vector3;

namespace {

Vector3 across(const Vector3& vector, const Vector3& normal) {
  return vector - vector.dot(normal) * normal;
}

/// What acts on a particle [N].
struct Load {
  double pressed = 0.0, profile = 0.0;  ///< by pressures: the ties', those of the profile
  double slides = 0.0;                  ///< by pressures of ties that slide along the shear
  Vector3 sheared = Vector3::Zero();    ///< by the ties' shear
};
using Loads = std::unordered_map<std::uint32_t, Load>;

/// Of the load of a point, what slides along its shear where it slips: of 0.65 to 0.8 the areas are
/// nearest those of the continuum (studies/MEASUREMENTS.md, cases 19 to 21).
constexpr double least_sliding = 0.75;

/// At a point, of profile 1.
struct Tractions {
  double pressed = 0.0, slides = 0.0;  ///< [Pa]
  Vector3 sheared = Vector3::Zero();   ///< [Pa]

  Tractions(const TiedPoint& tied, const Loads& loads) {
    for (std::size_t c = 0; c < 8; ++c) {
      const auto load = loads.find(tied.particles[c]);
      if (load == loads.end() || !(load->second.profile > 0.0)) continue;
      const double share = tied.weights[c] / load->second.profile;
      pressed += share * load->second.pressed;
      slides += share * load->second.slides;
      sheared += share * load->second.sheared;
    }
  }
};

/// Tells the particles what slides around them, of ties whose shear is along that of the field.
void add_sliding(std::span<const TiedPoint> points, Loads& loads) {
  for (const TiedPoint& tied : points) {
    const ContactPoint& point = tied.point;
    if (!tied.touches() || point.state != meshes::ContactState::slip) continue;
    const Vector3 around = Tractions(tied, loads).sheared;
    const double sizes = around.norm() * point.shear.norm(),
                 along = point.shear.isZero(0.0) ? 1.0  // without friction
                         : sizes > 0.0           ? around.dot(point.shear) / sizes
                                                 : 0.0;
    for (std::size_t c = 0; c < 8; ++c)
      loads[tied.particles[c]].slides +=
          tied.weights[c] * point.area * point.normal_traction * along;
  }
}

/// Gives `points` the sums of `wanted` by small changes of their forces.
void restore(std::span<const ContactPoint> wanted, std::vector<ContactPoint>& points) {
  using Matrix6 = Eigen::Matrix<double, 6, 6>;
  using Vector6 = Eigen::Matrix<double, 6, 1>;
  const auto is_pushed_only = [](const ContactPoint& point) { return point.shear.isZero(0.0); };
  const bool along_normals = std::ranges::all_of(points, is_pushed_only);
  const Vector3 centre = centre_of_pressure(points);
  double reach = 0.0;
  for (const ContactPoint& point : points) reach = std::max(reach, (point.place - centre).norm());
  if (!(reach > 0.0)) return;  // a single point
  // What changes of the force by unit a and b, and its part of force and moment.
  const auto lever = [&](const ContactPoint& point) {
    const Vector3 arm = (point.place - centre) / reach;
    Eigen::Matrix<double, 3, 6> change;
    change << Matrix3d::Identity(), Matrix3d::Zero();
    for (int c = 0; c < 3; ++c) change.col(3 + c) = Vector3::Unit(c).cross(arm);
    if (along_normals) change = (point.normal * point.normal.transpose() * change).eval();
    return change;
  };
  // Twice: what round-off leaves of the first.
  for (int round = 0; round < 2; ++round) {
    Matrix6 response = Matrix6::Zero();
    for (const ContactPoint& point : points)
      response += point.force().norm() * lever(point).transpose() * lever(point);
    const meshes::ContactSums now = sums_of(points, centre), sums = sums_of(wanted, centre);
    Vector6 lacking;
    lacking << sums.force - now.force, (sums.torque - now.torque) / reach;
    // Of normals that go through one point, a ball's, nothing turns: rank 3.
    Eigen::CompleteOrthogonalDecomposition<Matrix6> solver;
    const Vector6 factors = solver.setThreshold(1e-10).compute(response).solve(lacking);
    for (ContactPoint& point : points) {
      const Vector3 force = point.force();
      point.set_force(force + force.norm() * (lever(point) * factors));
      if (along_normals) point.shear.setZero();
    }
  }
}

}  // namespace

std::vector<ContactPoint> contact_field(std::span<const TiedPoint> points,
                                        const meshes::ContactPatch& patch, int sectors) {
  const auto in_ellipse = [&](const TiedPoint& tied) {
    return patch.profile(tied.point.place.head<2>());
  };
  // A contact narrower than the points are apart may miss them all.
  const bool has_profile =
      patch.is_ellipse() && std::ranges::any_of(points, [&](const TiedPoint& tied) {
        return tied.touches() && in_ellipse(tied) > 0.0;
      });
  const auto profile = [&](const TiedPoint& tied) {
    return has_profile ? in_ellipse(tied) : double(tied.touches());
  };
  Loads loads;
  for (const TiedPoint& tied : points) {
    const double pressure = profile(tied);
    if (!tied.touches() && !(pressure > 0.0)) continue;
    for (std::size_t c = 0; c < 8; ++c) {
      Load& load = loads[tied.particles[c]];
      const double share = tied.weights[c] * tied.point.area;
      load.pressed += share * tied.point.normal_traction;
      load.profile += share * pressure;
      load.sheared += share * tied.point.shear;
    }
  }
  add_sliding(points, loads);
  std::vector<ContactPoint> raw, smooth;
  for (const TiedPoint& tied : points) {
    if (tied.touches()) raw.push_back(tied.point);
    const double pressure = profile(tied);
    if (!(pressure > 0.0)) continue;
    const Tractions here(tied, loads);
    if (!(here.pressed > 0.0)) continue;
    ContactPoint& point = smooth.emplace_back(tied.point);
    point.normal_traction = pressure * here.pressed;
    point.shear = across(pressure * here.sheared, point.normal);
    point.state = here.slides >= least_sliding * here.pressed ? meshes::ContactState::slip
                                                              : meshes::ContactState::stick;
  }
  raw = unfolded(raw, sectors);
  smooth = unfolded(smooth, sectors);
  if (!smooth.empty()) restore(raw, smooth);
  return smooth;
}

std::vector<ContactPoint> contact_field(std::span<const TiedPoint> points, int sectors) {
  std::vector<ContactPoint> loaded;
  for (const TiedPoint& tied : points)
    if (tied.touches()) loaded.push_back(tied.point);
  return contact_field(points, meshes::contact_patch(loaded, sectors), sectors);
}

}  // namespace fingertip::lattice::inline contact
