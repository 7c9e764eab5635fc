#include "calibration/contact_laws/pressure_law.h"

#include <Eigen/Core>
#include <algorithm>
#include <boost/math/tools/minima.hpp>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "calibration/statistics/non_negative.h"
#include "meshes/base/dense.h"
#include "meshes/base/errors.h"
#include "meshes/base/files.h"
#include "meshes/cells/surface_points.h"
#include "meshes/press/obstacle.h"
#include "meshes/shape/geometry.h"

namespace fingertip::calibration::inline contact_laws {

namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using meshes::Vector3;

/// Patches across the half width of the contact at the smallest depth that matters.
constexpr double patches = 80.0;
/// Where each is asked for its distance, at every indentation.
constexpr double patches_by_distance = 20.0;
/// That depth over the whole.
constexpr double shallow = 1.0 / 12.0;
/// Difference of gaps over the depth that no force shows.
constexpr double same_gap = 5e-4;
/// Finest patches that surface_points makes, and the coarsest that make sense, over the radius.
constexpr double finest = 1e-3, coarsest = 1e-2;
/// Exponents of power laws among which is sought.
constexpr double highest_power = 4.0;

/// A curve and the overlap of each of its samples.
struct Samples {
  Samples(const ForceCurve& forces, const Overlaps& overlaps) : curve(forces) {
    for (const double at : curve.indentation) overlap.push_back(overlaps(at));
  }
  ForceCurve curve;
  std::vector<Overlap> overlap;
};

/// Forces of laws with coefficient one over those of the curve: a row per sample.
template <typename Laws>
MatrixXd shares(const Samples& samples, const Laws& laws) {
  MatrixXd matrix(Eigen::Index(samples.overlap.size()), Eigen::Index(laws.size()));
  for (Eigen::Index j = 0; j < matrix.rows(); ++j)
    for (Eigen::Index k = 0; k < matrix.cols(); ++k)
      matrix(j, k) = force_of(laws[std::size_t(k)], samples.overlap[std::size_t(j)]) /
                     samples.curve.force[std::size_t(j)];
  return matrix;
}

/// Coefficients >= 0 by which the laws add up to the curve.
template <typename Laws>
VectorXd sized(const Samples& samples, const Laws& laws) {
  MatrixXd matrix = shares(samples, laws);
  const VectorXd size = matrix.colwise().norm();  // d³ in metres is small beside d
  matrix *= size.cwiseInverse().asDiagonal();
  return non_negative_least_squares(matrix, VectorXd::Ones(matrix.rows())).cwiseQuotient(size);
}

/// From 0 to 1 between two penetrations.
struct Ramp {
  double begin = 0.0, end = 0.0;
  double at(double d) const { return std::clamp((d - begin) / (end - begin), 0.0, 1.0); }
};

/// More samples than a table has knots: a pressure that met as many forces as it has knots would
/// swing from knot to knot. Between samples, and before the first one, F is a power of d.
ForceCurve refined(const ForceCurve& curve) {
  constexpr int pieces = 4;
  ForceCurve fine;
  double from = 0.5 * curve.indentation.front();
  for (std::size_t i = 0; i < curve.force.size(); ++i) {
    const std::size_t other = i == 0 ? 1 : i - 1;
    const double to = curve.indentation[i];
    const double exponent =
        std::log(curve.force[other] / curve.force[i]) / std::log(curve.indentation[other] / to);
    for (int piece = i == 0 ? 0 : 1; piece <= pieces; ++piece) {
      const double d = from + (to - from) * piece / pieces;
      fine.indentation.push_back(d);
      fine.force.push_back(curve.force[i] * std::pow(d / to, exponent));
    }
    from = to;
  }
  return fine;
}

struct Patch {
  double gap = 0.0, area = 0.0;  ///< or depth [m]; projected [m²]
  Vector3 place = Vector3::Zero();
};

/// Of the finger's surface, by growing gap at first touch; `across` half the narrowest contact.
std::vector<Patch> patches_of(const meshes::Geometry& geometry, const meshes::Obstacle& obstacle,
                              double depth, double across) {
  const auto shape = meshes::shape_of(geometry);
  const double narrow =
      std::sqrt(2.0 * meshes::relative_radius(*shape, obstacle) * shallow * depth);
  const double radius = geometry.tip_radius;
  const double spacing = std::clamp(narrow / across, finest * radius, coarsest * radius);
  const double touch = meshes::first_touch(geometry, 0.0, obstacle);
  std::vector<Patch> found;
  for (const meshes::SurfacePoint& point :
       meshes::surface_points(geometry, meshes::ProfileSurface::contact, spacing)) {
    const double gap = touch - meshes::height(obstacle, point.position) - point.position.z();
    if (point.normal.z() > 0.0 && gap < depth)
      found.push_back({std::max(gap, 0.0), point.area * point.normal.z(), point.position});
  }
  std::ranges::sort(found, {}, &Patch::gap);
  return found;
}

/// Those of nearly the same gap as one, at the middle of theirs.
std::vector<Patch> merged(const std::vector<Patch>& sorted, double depth) {
  std::vector<Patch> few;
  double begin = -1.0;
  for (const Patch& patch : sorted) {
    if (patch.gap > begin + same_gap * depth) {
      begin = patch.gap;
      few.push_back(patch);
      continue;
    }
    Patch& mean = few.back();
    mean.area += patch.area;
    mean.gap += (patch.gap - mean.gap) * patch.area / mean.area;
  }
  return few;
}

}  // namespace

void check_growth(const ForceCurve& curve) {
  const auto refuse = [](const std::string& value, const char* rule) {
    throw meshes::InvalidInput({"force curve", value, rule, "press deeper, or at more depths"});
  };
  if (curve.indentation.size() < 2 || curve.force.size() != curve.indentation.size())
    refuse(std::to_string(curve.indentation.size()) + " samples", "needs two samples or more");
  double depth = 0.0, force = 0.0;
  for (std::size_t i = 0; i < curve.force.size(); ++i) {
    if (!(curve.indentation[i] > depth && curve.force[i] > force))
      refuse(
          meshes::to_text(curve.force[i]) + " N at " + meshes::to_text(curve.indentation[i]) + " m",
          "indentation and force must grow from first touch on");
    depth = curve.indentation[i];
    force = curve.force[i];
  }
}

double fitted_factor(const std::vector<double>& forces, const ForceCurve& curve) {
  double sum = 0.0, squares = 0.0;
  for (std::size_t i = 0; i < forces.size(); ++i) {
    const double share = forces[i] / curve.force[i];
    sum += share;
    squares += share * share;
  }
  return sum / squares;
}

double GapField::overlap(double indentation) const {
  const auto end = std::ranges::lower_bound(gap, indentation);
  return std::accumulate(area.begin(), area.begin() + (end - gap.begin()), 0.0);
}

Overlap GapField::operator()(double indentation) const {
  Overlap overlap;
  for (std::size_t i = 0; i < gap.size() && gap[i] < indentation; ++i) {
    overlap.depth.push_back(indentation - gap[i]);
    overlap.area.push_back(area[i]);
  }
  return overlap;
}

GapField gap_field(const meshes::Geometry& geometry, const meshes::Obstacle& obstacle,
                   double depth) {
  GapField field;
  for (const Patch& patch : merged(patches_of(geometry, obstacle, depth, patches), depth)) {
    field.gap.push_back(patch.gap);
    field.area.push_back(patch.area);
  }
  return field;
}

Overlaps surface_distances(const meshes::Geometry& geometry, const meshes::Obstacle& obstacle,
                           double depth) {
  const auto shape = meshes::shape_of(geometry);
  const auto parts = patches_of(geometry, obstacle, depth, patches_by_distance);
  return [shape, parts, depth](double indentation) {
    std::vector<Patch> found;
    for (const Patch& part : parts) {
      if (!(part.gap < indentation)) break;
      const Vector3 place = part.place - (indentation - part.gap) * Vector3::UnitZ();
      found.push_back({shape->nearest(meshes::ProfileSurface::contact, place).distance, part.area});
    }
    std::ranges::sort(found, {}, &Patch::gap);
    Overlap overlap;
    for (const Patch& patch : merged(found, depth)) {
      overlap.depth.push_back(patch.gap);
      overlap.area.push_back(patch.area);
    }
    return overlap;
  };
}

double PressureTable::at(double d) const {
  if (!(d > 0.0) || penetration.size() < 2) return 0.0;
  const auto above = std::upper_bound(penetration.begin() + 1, penetration.end() - 1, d);
  const auto i = std::size_t(above - penetration.begin());
  const double slope = (pressure[i] - pressure[i - 1]) / (penetration[i] - penetration[i - 1]);
  return pressure[i - 1] + slope * (d - penetration[i - 1]);
}

double PowerLaw::at(double d) const {
  return d > 0.0 ? stiffness * std::pow(d, exponent) : 0.0;
}

double PressurePolynomial::at(double d) const {
  return d > 0.0 ? d * (first + d * (second + d * third)) : 0.0;
}

bool PressurePolynomial::grows_to(double d) const {
  const auto slope = [&](double at) { return first + at * (2.0 * second + at * 3.0 * third); };
  const double turn = third > 0.0 ? std::clamp(-second / (3.0 * third), 0.0, d) : 0.0;
  return std::min({slope(0.0), slope(turn), slope(d)}) >= 0.0;
}

PressureTable fitted_table(const ForceCurve& curve, const Overlaps& overlaps) {
  check_growth(curve);
  const double first = curve.indentation.front();
  std::vector<double> knots = {0.25 * first, 0.5 * first};
  knots.insert(knots.end(), curve.indentation.begin(), curve.indentation.end());
  std::vector<Ramp> ramps;
  double begin = 0.0;
  for (const double end : knots) ramps.push_back({std::exchange(begin, end), end});
  const VectorXd rise = sized(Samples(refined(curve), overlaps), ramps);
  PressureTable table{{0.0}, {0.0}};
  for (std::size_t k = 0; k < ramps.size(); ++k) {
    table.penetration.push_back(ramps[k].end);
    table.pressure.push_back(table.pressure.back() + rise[Eigen::Index(k)]);
  }
  return table;
}

PowerLaw fitted_power(const ForceCurve& curve, const Overlaps& overlaps) {
  check_growth(curve);
  const Samples samples(curve, overlaps);
  const auto with = [&](double exponent) {
    // Of penetrations over the depth, lest stiffness become a number without bounds.
    const double depth = curve.indentation.back();
    const std::vector<PowerLaw> law{{std::pow(depth, -exponent), exponent}};
    const VectorXd share = shares(samples, law).col(0);
    const double size = share.sum() / share.squaredNorm();
    return std::pair(PowerLaw{size * law[0].stiffness, exponent},
                     (size * share.array() - 1.0).square().sum());
  };
  constexpr int bits = std::numeric_limits<double>::digits / 2;
  const auto found = boost::math::tools::brent_find_minima(
      [&](double exponent) { return with(exponent).second; }, 0.0, highest_power, bits);
  return with(found.first).first;
}

PressurePolynomial fitted_polynomial(const ForceCurve& curve, const Overlaps& overlaps) {
  check_growth(curve);
  const Samples samples(curve, overlaps);
  const std::vector<PressurePolynomial> powers{{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}};
  const VectorXd free = meshes::least_squares(shares(samples, powers),
                                              VectorXd::Ones(Eigen::Index(curve.force.size())));
  const PressurePolynomial law{free[0], free[1], free[2]};
  if (law.grows_to(curve.indentation.back())) return law;
  const VectorXd size = sized(samples, powers);
  return {size[0], size[1], size[2]};
}

PressurePolynomial fitted_line(const ForceCurve& curve, const Overlaps& overlaps) {
  check_growth(curve);
  const Samples samples(curve, overlaps);
  return {sized(samples, std::vector<PressurePolynomial>{{1.0, 0.0, 0.0}})[0], 0.0, 0.0};
}

double HydroelasticBall::force(const meshes::Obstacle& obstacle, double indentation) const {
  if (!(indentation > 0.0)) return 0.0;
  const double top = radius - indentation;  // of the obstacle, over the centre
  const double reach =
      std::sqrt(std::max(radius * radius - std::max(top, 0.0) * std::max(top, 0.0), 0.0));
  constexpr int rings = 200, sectors = 64;  // of the quadrature over the ball's section
  double sum = 0.0;
  for (int ring = 0; ring < rings; ++ring) {
    const double rho = reach * (ring + 0.5) / rings;
    double mean = 0.0;
    for (int sector = 0; sector < sectors; ++sector) {
      const double angle = 2.0 * std::numbers::pi * (sector + 0.5) / sectors;
      const meshes::Vector3 place(rho * std::cos(angle), rho * std::sin(angle), 0.0);
      const double z = top - meshes::height(obstacle, place);
      mean += std::max(1.0 - std::hypot(rho, z) / radius, 0.0) / sectors;
    }
    sum += mean * 2.0 * std::numbers::pi * rho * reach / rings;
  }
  return modulus * sum;
}

HydroelasticBall fitted_hydroelastic_ball(const ForceCurve& curve, const meshes::Obstacle& obstacle,
                                          double radius) {
  check_growth(curve);
  HydroelasticBall ball{1.0, radius};
  std::vector<double> forces;
  for (const double at : curve.indentation) forces.push_back(ball.force(obstacle, at));
  ball.modulus = fitted_factor(forces, curve);
  return ball;
}

}  // namespace fingertip::calibration::inline contact_laws
