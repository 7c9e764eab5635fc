#include "calibration/press_fit/model_error.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>
#include <string>
#include <utility>

#include "lattice/model/constants.h"
#include "lattice/press/press_deviation.h"
#include "lattice/press/setup_fields.h"
#include "lattice/press/static_press.h"
#include "meshes/press/press_protocol.h"
#include "meshes/shape/solid.h"
#include "meshes/tables/fields_json.h"
#include "meshes/tables/interpolation.h"

namespace fingertip::calibration::inline press_fit {

using Eigen::Index;
using lattice::Kinematics;
using lattice::ModelKind;
using lattice::PressSetup;

namespace {

/// Cells over which the error where masses touch swings.
constexpr double contact_length = 0.5;

/// The errors of one force, each of known size and unknown sign: half of what covers 95 % of them.
struct Place {
  const PressSetup* press = nullptr;
  double cells = 0.0;  ///< under the contact's radius
  double contact = 0.0, inside = 0.0;
};

/// Of a solid, else empty.
std::string content(const meshes::Geometry& geometry) {
  return geometry.solid ? geometry.solid->content() : "";
}

bool same_cells(const PressSetup& a, const PressSetup& b) {
  const auto place = [](const meshes::ProfileCorner& corner) {
    return std::pair(corner.r, corner.z);
  };
  return a.lattice.spacing == b.lattice.spacing && a.lattice.offset == b.lattice.offset &&
         a.lattice.axes == b.lattice.axes && a.protocol.tilt == b.protocol.tilt &&
         a.geometry.tip_radius == b.geometry.tip_radius &&
         content(a.geometry) == content(b.geometry) &&
         std::ranges::equal(a.geometry.profile, b.geometry.profile, {}, place, place);
}

double covariance(const Place& a, const Place& b) {
  double sum = a.inside * b.inside;
  if (same_cells(*a.press, *b.press))
    sum += a.contact * b.contact * std::exp(-std::abs(a.cells - b.cells) / contact_length);
  return sum;
}

/// Cells through the thickness, and depths between which the ratio of two theories is straight.
constexpr double coarse_cells = 5.0;
constexpr std::size_t coarse_depths = 8;

std::vector<double> forces(PressSetup press, ModelKind model, Kinematics kinematics) {
  press.lattice.model = model;
  press.lattice.kinematics = kinematics;
  press.lattice.constants = lattice::hookean_constants(press.rubber, press.lattice.spacing);
  // A fit asks several times for the same press: when it is planned, checked and run.
  static std::map<std::string, std::vector<double>> known;
  static std::mutex one_at_a_time;
  const std::string key = meshes::json_of(std::as_const(press)).dump();
  {
    const std::scoped_lock lock(one_at_a_time);
    if (const auto found = known.find(key); found != known.end()) return found->second;
  }
  std::vector<double> result;
  const lattice::StaticOutcome outcome = lattice::run_static_press(press);
  for (const auto& sample : outcome.response.samples()) result.push_back(sample.normal_force);
  const std::scoped_lock lock(one_at_a_time);
  known.emplace(key, result);
  return result;
}

/// By the lattice of cells whose theory it is.
std::vector<double> forces(const PressSetup& press, Kinematics kinematics) {
  return forces(press, kinematics == Kinematics::finite ? ModelKind::network : ModelKind::hookean,
                kinematics);
}

/// Few cells and depths.
void make_coarse(PressSetup& press, std::size_t depths = coarse_depths) {
  press.lattice.spacing =
      std::min(press.geometry.thickness() / coarse_cells, press.geometry.coarsest_spacing());
  press.rubber.youngs_modulus =
      std::max(press.rubber.youngs_modulus, 2.0 * press.rubber.shear_modulus);
  press.protocol.samples = meshes::even_depths(press.protocol.samples.back(), depths);
  press.protocol.depth = press.protocol.samples.back();
}

/// Of something known at depths, straight between them.
Eigen::VectorXd at_depths(const std::vector<double>& depths, const std::vector<double>& known,
                          const std::vector<double>& wanted) {
  Eigen::VectorXd result{Index(wanted.size())};
  for (std::size_t i = 0; i < wanted.size(); ++i)
    result(Index(i)) = meshes::interpolated(depths, known, wanted[i]);
  return result;
}

/// Of `other` over `own`, known at the samples of `press`, at the `wanted` depths.
Eigen::VectorXd excess(const PressSetup& press, const std::vector<double>& own,
                       const std::vector<double>& other, const std::vector<double>& wanted) {
  std::vector<double> depths{0.0}, ratio{0.0};
  for (std::size_t i = 0; i < own.size(); ++i) {
    depths.push_back(press.protocol.samples[i]);
    ratio.push_back(other[i] / own[i] - 1.0);
  }
  return at_depths(depths, ratio, wanted);
}

}  // namespace

Eigen::MatrixXd lattice_covariance(const std::vector<PressSetup>& presses) {
  std::vector<Place> places;
  for (const PressSetup& press : presses) {
    PressSetup cells = press;  // what springs alone cannot be is fitted
    if (cells.lattice.model == ModelKind::central) cells.lattice.model = ModelKind::hookean;
    const lattice::ForceEstimator estimator(cells);
    const double pole_radius =
        meshes::relative_radius(*meshes::shape_of(press.geometry), press.protocol.obstacle);
    for (const double depth : press.protocol.samples) {
      const lattice::ForceEstimate error = estimator.at(depth).value_or(lattice::ForceEstimate());
      places.push_back({&press, std::sqrt(pole_radius * depth) / press.lattice.spacing,
                        0.5 * error.contact, 0.5 * error.inside});
    }
  }
  const Index count = Index(places.size());
  Eigen::MatrixXd result(count, count);
  for (Index i = 0; i < count; ++i)
    for (Index j = 0; j <= i; ++j)
      result(i, j) = result(j, i) = covariance(places[std::size_t(i)], places[std::size_t(j)]);
  return result;
}

Eigen::VectorXd excess_of_finite_strain(PressSetup press) {
  const std::vector<double> wanted = press.protocol.samples;
  make_coarse(press);
  return excess(press, forces(press, ModelKind::hookean, Kinematics::small),
                forces(press, ModelKind::network, Kinematics::finite), wanted);
}

Eigen::VectorXd excess_of_other_contact(PressSetup press) {
  const std::vector<double> wanted = press.protocol.samples;
  make_coarse(press);
  PressSetup other = press;
  using enum meshes::ContactMode;
  other.protocol.contact = press.protocol.contact == stick ? frictionless : stick;
  const Kinematics kinematics = press.lattice.kinematics;
  return excess(press, forces(press, kinematics), forces(other, kinematics), wanted);
}

bool has(const PressSetup& press, Described what) {
  const meshes::Obstacle& obstacle = press.protocol.obstacle;
  switch (what) {
    case Described::tip_radius:
    case Described::rod_radius: return press.geometry.is_dome();
    case Described::obstacle_radius: return !obstacle.is_plane();
    case Described::obstacle_offset: return !obstacle.is_plane() && obstacle.has_offset();
    default: return true;
  }
}

double value_of(const PressSetup& press, Described what) {
  switch (what) {
    case Described::scale: return 1.0;
    case Described::tip_radius: return press.geometry.tip_radius;
    case Described::rod_radius: return press.geometry.rod_radius;
    case Described::obstacle_radius: return press.protocol.obstacle.radius;
    case Described::obstacle_offset: return press.protocol.obstacle.offset;
    case Described::tilt: return press.protocol.tilt;
    case Described::poissons_ratio: return press.rubber.poissons_ratio();
  }
  return 0.0;
}

namespace {

/// Forces of a coarse press that differs in one number from that described, on the same cells,
/// whose errors so nearly cancel: a larger finger is the same one under smaller depths and
/// obstacles, F = s² F(d/s), a larger tip such a finger with a smaller rod.
std::vector<double> forces_with(PressSetup press, Described what, double value,
                                Kinematics kinematics) {
  meshes::PressProtocol& protocol = press.protocol;
  double scale = 1.0;
  switch (what) {
    case Described::scale: scale = value; break;
    case Described::tip_radius:
      scale = value / press.geometry.tip_radius;
      press.geometry.rod_radius /= scale;
      break;
    case Described::rod_radius: press.geometry.rod_radius = value; break;
    case Described::obstacle_radius: protocol.obstacle.radius = value; break;
    case Described::obstacle_offset: protocol.obstacle.offset = value; break;
    case Described::tilt: protocol.tilt = value; break;
    case Described::poissons_ratio:
      press.rubber.shear_modulus = 0.5 * press.rubber.youngs_modulus / (1.0 + value);
  }
  for (double& depth : protocol.samples) depth /= scale;
  for (double* length : {&protocol.depth, &protocol.obstacle.radius, &protocol.obstacle.offset})
    *length /= scale;
  std::vector<double> found = forces(press, kinematics);
  for (double& force : found) force *= scale * scale;
  return found;
}

}  // namespace

Eigen::VectorXd change_between(PressSetup press, Described what, double low, double high,
                               Kinematics kinematics, std::size_t depths) {
  const std::vector<double> wanted = press.protocol.samples;
  make_coarse(press, depths);
  const std::vector<double> own = forces(press, kinematics),
                            below = forces_with(press, what, low, kinematics),
                            above = forces_with(press, what, high, kinematics);
  std::vector<double> change;
  for (std::size_t i = 0; i < own.size(); ++i) change.push_back((above[i] - below[i]) / own[i]);
  return at_depths(press.protocol.samples, change, wanted);
}

}  // namespace fingertip::calibration::inline press_fit
