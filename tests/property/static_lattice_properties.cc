// Properties of the lattice at equilibrium that hold for every body, rubber and deformation,
// checked on random ones of all models at small and finite strain.
#include <rapidcheck.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "lattice/statics/elastic_system.h"
#include "lattice/statics/vibration_modes.h"
#include "tests/property/random_bodies.h"

using namespace fingertip;
using namespace fingertip::random;
using lattice::ElasticSystem;
using lattice::EmbeddedPoint;
using lattice::Tangent;

namespace {

VectorXd forces(const ElasticSystem& system, const VectorXd& u) {
  VectorXd force;
  system.assemble(u, force, nullptr);
  return force;
}

/// Of one particle that is moved alone by a spacing [N]: what forces are small against.
double unit_force(const ElasticSystem& system, const Specimen& specimen) {
  VectorXd force;
  Tangent tangent = system.empty_tangent();
  system.assemble(VectorXd::Zero(specimen.body.unknowns()), force, &tangent);
  return tangent.diagonal().cwiseAbs().maxCoeff() * specimen.spacing;
}

bool forces_come_from_the_energy() {
  return rc::check("power against any motion is the fall of the energy", [] {
    const Specimen specimen = random_specimen();
    const ElasticSystem system(specimen.body);
    const VectorXd u = random_displacement(specimen), motion = random_field(specimen.body, 1.0);
    const double h = 1e-5 * specimen.spacing;
    const double slope = (system.energy(u + h * motion) - system.energy(u - h * motion)) / (2 * h);
    const VectorXd force = forces(system, u);
    RC_ASSERT(std::abs(slope + force.dot(motion)) <=
              1e-7 * (force.lpNorm<1>() + unit_force(system, specimen)));
  });
}

bool tangent_is_the_derivative_of_force() {
  return rc::check("the tangent is minus the derivative of the force", [] {
    const Specimen specimen = random_specimen();
    const ElasticSystem system(specimen.body);
    const VectorXd u = random_displacement(specimen), motion = random_field(specimen.body, 1.0);
    const double h = 1e-5 * specimen.spacing;
    VectorXd force;
    Tangent tangent = system.empty_tangent();
    system.assemble(u, force, &tangent);
    const VectorXd expected =
        (forces(system, u - h * motion) - forces(system, u + h * motion)) / (2.0 * h);
    const VectorXd computed = tangent.selfadjointView<Eigen::Lower>() * motion;
    RC_ASSERT((computed - expected).norm() <= 1e-7 * expected.norm());
  });
}

bool rest_is_free_of_force() {
  return rc::check("nothing pulls at rest", [] {
    const Specimen specimen = random_specimen();
    const ElasticSystem system(specimen.body);
    const VectorXd rest = VectorXd::Zero(specimen.body.unknowns());
    RC_ASSERT(system.energy(rest) == 0.0);
    RC_ASSERT(forces(system, rest).lpNorm<Eigen::Infinity>() <=
              1e-12 * unit_force(system, specimen));
  });
}

bool forces_balance() {
  return rc::check("forces of a free body add up to nothing, and so do their moments", [] {
    const Specimen specimen = random_free_specimen();
    const LatticeBody& body = specimen.body;
    const ElasticSystem system(body);
    const VectorXd u = random_displacement(specimen), force = forces(system, u);
    Vector3 sum = Vector3::Zero(), moment = Vector3::Zero();
    double moments = 0.0;
    for (std::size_t p = 0; p < body.rest.size(); ++p) {
      const Vector3 f = force.segment<3>(3 * Eigen::Index(p));
      Vector3 at = body.rest[p];
      if (body.finite) at += u.segment<3>(3 * Eigen::Index(p));
      sum += f;
      moment += at.cross(f);
      moments += at.norm() * f.norm();
    }
    const double unit = unit_force(system, specimen);
    RC_ASSERT(sum.norm() <= 1e-12 * (force.lpNorm<1>() + unit));
    RC_ASSERT(moment.norm() <= 1e-12 * (moments + specimen.spacing * unit));
  });
}

/// `u` followed by a rigid motion; at small strain by its linearisation.
VectorXd moved(const LatticeBody& body, const VectorXd& u, const Matrix3d& turn,
               const Vector3& shift) {
  VectorXd result(u.size());
  for (std::size_t p = 0; p < body.rest.size(); ++p) {
    const Eigen::Index i = 3 * Eigen::Index(p);
    const Vector3 x = body.rest[p] + u.segment<3>(i);
    const Vector3 spun = u.segment<3>(i) + turn * body.rest[p];
    result.segment<3>(i) = shift + (body.finite ? Vector3(turn * x - body.rest[p]) : spun);
  }
  return result;
}

bool rigid_motions_cost_nothing() {
  return rc::check("a rigid motion costs nothing and only turns the forces", [] {
    const Specimen specimen = random_free_specimen();
    const LatticeBody& body = specimen.body;
    const ElasticSystem system(body);
    const VectorXd u = *rc::gen::element(0.0, 1.0) * random_displacement(specimen);
    const Matrix3d turn = body.finite ? random_rotation() : skew(random_vector(1.0));
    const VectorXd after = moved(body, u, turn, random_vector(10.0 * specimen.spacing));
    const VectorXd before_forces = forces(system, u), after_forces = forces(system, after);
    const double unit = unit_force(system, specimen);
    RC_ASSERT(std::abs(system.energy(after) - system.energy(u)) <=
              1e-11 * (unit * specimen.spacing * double(body.rest.size()) + system.energy(u)));
    for (Eigen::Index i = 0; i < body.unknowns(); i += 3) {
      const Vector3 f = before_forces.segment<3>(i);
      const Vector3 expected = body.finite ? Vector3(turn * f) : f;
      RC_ASSERT((after_forces.segment<3>(i) - expected).norm() <= 1e-10 * (unit + f.norm()));
    }
  });
}

/// One of the 48 maps of the cube onto itself: x -> sign_i x_order[i].
struct CubeMap {
  std::array<int, 3> order{0, 1, 2};
  Vector3 sign = Vector3::Ones();

  Vector3 operator()(const Vector3& x) const {
    return sign.cwiseProduct(Vector3(x[order[0]], x[order[1]], x[order[2]]));
  }
};

CubeMap random_cube_map() {
  CubeMap map;
  const int turns = integer(0, 6);
  for (int n = 0; n < turns; ++n) std::next_permutation(map.order.begin(), map.order.end());
  for (int i = 0; i < 3; ++i) map.sign[i] = *rc::gen::element(-1.0, 1.0);
  return map;
}

bool blocks_have_cubic_symmetry() {
  return rc::check("a permuted, mirrored and turned block has the same forces", [] {
    LatticeSettings settings = random_model();
    const Rubber rubber = random_rubber_for(settings);
    give_constants(settings, rubber, std::pow(10.0, uniform(-4.0, -2.0)));
    const std::array<int, 3> cells = random_cells();
    const CubeMap map = random_cube_map();
    const std::array<int, 3> other_cells{cells[std::size_t(map.order[0])],
                                         cells[std::size_t(map.order[1])],
                                         cells[std::size_t(map.order[2])]};
    const Specimen first{{}, settings.spacing, block_of(rubber, settings, cells)};
    if (settings.model != ModelKind::published) settings.axes = random_rotation();
    const Specimen other{{}, settings.spacing, block_of(rubber, settings, other_cells)};
    const double a = settings.spacing;
    const Vector3 size(cells[0], cells[1], cells[2]);
    const Vector3 other_size(other_cells[0], other_cells[1], other_cells[2]);

    const VectorXd u = random_displacement(first);
    VectorXd other_u(u.size());
    std::vector<Eigen::Index> image;
    for (std::size_t p = 0; p < first.body.rest.size(); ++p) {
      const Vector3 at =
          map(first.body.rest[p] / a - 0.5 * size) + 0.5 * other_size;  // grid coordinates
      const Eigen::Index i = std::lround(at.x()), j = std::lround(at.y()), k = std::lround(at.z());
      image.push_back(3 * ((k * (other_cells[1] + 1) + j) * (other_cells[0] + 1) + i));
      RC_ASSERT((other.body.rest[std::size_t(image.back() / 3)] - a * (settings.axes * at)).norm() <
                1e-9 * a);
      other_u.segment<3>(image.back()) = settings.axes * map(u.segment<3>(3 * Eigen::Index(p)));
    }
    const ElasticSystem system(first.body), other_system(other.body);
    const VectorXd force = forces(system, u), other_force = forces(other_system, other_u);
    const double unit = unit_force(system, first);
    for (std::size_t p = 0; p < image.size(); ++p) {
      const Vector3 f = force.segment<3>(3 * Eigen::Index(p));
      RC_ASSERT((other_force.segment<3>(image[p]) - settings.axes * map(f)).norm() <=
                1e-10 * (unit + f.norm()));
    }
  });
}

LatticeSettings random_cut_model() {
  LatticeSettings settings = random_model();
  if (settings.model == ModelKind::published) settings.model = ModelKind::hookean;
  return settings;
}

bool linear_fields_are_reproduced() {
  return rc::check("ties and mean cells reproduce linear fields", [] {
    const Specimen specimen = random_tip(random_cut_model());
    const LatticeBody& body = specimen.body;
    const Matrix3d H = random_matrix(1.0);
    const Vector3 constant = random_vector(specimen.spacing);
    VectorXd u(body.unknowns());
    for (std::size_t p = 0; p < body.rest.size(); ++p)
      u.segment<3>(3 * Eigen::Index(p)) = constant + H * body.rest[p];
    for (const auto* points : {&body.bond, &body.outer}) {
      RC_ASSERT(!points->empty());
      for (const EmbeddedPoint& point : *points) {
        const Vector3 expected = constant + H * point.rest;
        RC_ASSERT((shift(point, u) - expected).norm() <= 1e-11 * specimen.spacing);
        const auto [least, most] = std::ranges::minmax(point.weights);
        RC_ASSERT(std::max(-least, most) <= 8.0);
      }
    }
    for (const auto& cell : body.cells) {
      RC_ASSERT((cell.gradients.rowwise().sum() * specimen.spacing).norm() <= 1e-13);
      RC_ASSERT((cell_gradient(cell, u) - H).norm() <= 1e-12);
      RC_ASSERT(cell.volume > 0.0);
    }
    RC_ASSERT(*std::ranges::min_element(body.mass) > 0.0);
  });
}

// ---- natural vibrations ------------------------------------------------------------------------

bool frequencies_follow_the_wave_speed() {
  return rc::check("natural frequencies scale like (G/rho)^½ over the size", [] {
    LatticeSettings settings;
    settings.model = ModelKind::network;
    settings.kinematics = *rc::gen::element(Kinematics::small, Kinematics::finite);
    settings.spacing = std::pow(10.0, uniform(-4.0, -2.0));
    Rubber rubber = random_rubber(0.0);
    const std::array<int, 3> cells = random_cells();
    constexpr int rigid = 6, count = 9;
    const auto first = vibration_modes(block_of(rubber, settings, cells), count);

    const double stiffer = std::pow(10.0, uniform(-8.0, 8.0));
    const double denser = std::pow(10.0, uniform(-8.0, 8.0));
    const double larger = std::pow(10.0, uniform(-2.0, 2.0));
    rubber.youngs_modulus *= stiffer;
    rubber.shear_modulus *= stiffer;
    rubber.density *= denser;
    settings.spacing *= larger;
    const auto other = vibration_modes(block_of(rubber, settings, cells), count);
    const double factor = std::sqrt(stiffer / denser) / larger;
    for (std::size_t i = 0; i < count; ++i) {
      const double expected = factor * first[i].frequency, lowest = factor * first[rigid].frequency;
      if (i < rigid) RC_ASSERT(other[i].frequency <= 1e-4 * lowest);
      if (i >= rigid) RC_ASSERT(std::abs(other[i].frequency - expected) <= 1e-7 * expected);
    }
  });
}

}  // namespace

int main() {
  bool good = forces_come_from_the_energy();
  good = tangent_is_the_derivative_of_force() && good;
  good = rest_is_free_of_force() && good;
  good = forces_balance() && good;
  good = rigid_motions_cost_nothing() && good;
  good = blocks_have_cubic_symmetry() && good;
  good = linear_fields_are_reproduced() && good;
  good = frequencies_follow_the_wave_speed() && good;
  return good ? 0 : 1;
}
