#include "lattice/statics/mode_motion.h"

#include <array>
#include <cmath>
#include <complex>
#include <map>
#include <utility>

namespace fingertip::lattice::inline statics {

namespace {

using Vector3 = meshes::Vector3;

constexpr int orders = 4;  ///< numbers of waves told apart: 0 to 3

/// Sums over the particles of a ring, for each number of waves.
struct Ring {
  double mass = 0.0;
  std::array<Eigen::Vector3cd, orders> amplitude{Eigen::Vector3cd::Zero(), Eigen::Vector3cd::Zero(),
                                                 Eigen::Vector3cd::Zero(),
                                                 Eigen::Vector3cd::Zero()};
};

/// Radial, circumferential and axial part.
Vector3 cylindrical(const Vector3& u, double phi) {
  return {std::cos(phi) * u.x() + std::sin(phi) * u.y(),
          std::cos(phi) * u.y() - std::sin(phi) * u.x(), u.z()};
}

int max_waves(const std::map<std::pair<long, long>, Ring>& rings) {
  std::array<double, orders> energy{};
  for (const auto& [place, ring] : rings) {
    for (int n = 0; n < orders; ++n) {
      // A real field has the amplitude of +n and of -n.
      const double both = n == 0 ? 1.0 : 2.0;
      energy[std::size_t(n)] += both * ring.amplitude[std::size_t(n)].squaredNorm() / ring.mass;
    }
  }
  int most = 0;
  for (int n = 1; n < orders; ++n)
    if (energy[std::size_t(n)] > energy[std::size_t(most)]) most = n;
  return energy[std::size_t(most)] >= 0.5 ? most : orders;
}

}  // namespace

ModeMotion motion_of(const LatticeBody& body, const Eigen::VectorXd& shape, double spacing) {
  ModeMotion motion;
  double mass = 0.0, inertia = 0.0, torsion = 0.0;
  std::map<std::pair<long, long>, Ring> rings;
  for (std::size_t i = 0; i < body.rest.size(); ++i) {
    const Vector3& place = body.rest[i];
    const Vector3 u = shape.segment<3>(3 * Eigen::Index(i));
    const double m = body.mass[i], radius = std::hypot(place.x(), place.y());
    const double phi = std::atan2(place.y(), place.x());
    const Vector3 part = cylindrical(u, phi);
    mass += m;
    inertia += m * radius * radius;
    torsion += m * radius * part[1];
    motion.effective_mass += m * u;
    motion.radial += m * part[0] * part[0];
    motion.circumferential += m * part[1] * part[1];
    motion.axial += m * part[2] * part[2];
    Ring& ring =
        rings[{std::lround(2.0 * radius / spacing), std::lround(2.0 * place.z() / spacing)}];
    ring.mass += m;
    for (int n = 0; n < orders; ++n)
      ring.amplitude[std::size_t(n)] += m * std::polar(1.0, -n * phi) * part;
  }
  motion.effective_mass = motion.effective_mass.cwiseAbs2() / mass;
  motion.effective_inertia = torsion * torsion / inertia;
  motion.waves = max_waves(rings);
  return motion;
}

std::string description(const ModeMotion& motion) {
  switch (motion.waves) {
    case 0:
      if (motion.circumferential > 0.5) return "torsion";
      return motion.axial > motion.radial ? "along the axis" : "breathing";
    case 1: return "sideways";
    case orders: return std::to_string(orders) + " or more waves around the axis";
    default: return std::to_string(motion.waves) + " waves around the axis";
  }
}

}  // namespace fingertip::lattice::inline statics
