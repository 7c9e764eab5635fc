#include "calibration/press_fit/displacements.h"

#include <Eigen/Geometry>
#include <cmath>

#include "meshes/base/dense.h"

namespace fingertip::calibration::inline press_fit {

using Eigen::Index;
using Eigen::Matrix3Xd;
using meshes::Vector3;

namespace {

/// A plane's points leave no rotation open, a line's do.
constexpr Index fewest_for_motion = 4;
constexpr double least_width = 1e-6;  ///< of points across their line, over their extent

Matrix3Xd chosen_columns(const std::vector<Vector3>& points,
                         const std::vector<std::size_t>& which) {
  Matrix3Xd matrix(3, Index(which.size()));
  for (std::size_t i = 0; i < which.size(); ++i) matrix.col(Index(i)) = points[which[i]];
  return matrix;
}

Matrix3Xd centred(const Matrix3Xd& points) {
  return points.colwise() - points.rowwise().mean();
}

double rms_length(const Matrix3Xd& vectors) {
  return std::sqrt(vectors.squaredNorm() / double(vectors.cols()));
}

bool on_a_line(const Matrix3Xd& points) {
  const Eigen::VectorXd sizes = meshes::singular_values(centred(points).transpose()).values;
  return !(sizes(1) > least_width * sizes(0));
}

/// `moved` as the rigid motion that brings it nearest to `to` leaves it.
Matrix3Xd brought_to(const Matrix3Xd& moved, const Matrix3Xd& to, double* turn = nullptr) {
  const Eigen::Matrix4d motion = Eigen::umeyama(moved, to, false);
  if (turn != nullptr)
    *turn = std::abs(Eigen::AngleAxisd(Eigen::Matrix3d(motion.topLeftCorner<3, 3>())).angle());
  return (motion.topLeftCorner<3, 3>() * moved).colwise() +
         Eigen::Vector3d(motion.topRightCorner<3, 1>());
}

}  // namespace

DisplacementDistance distance_of(const std::vector<Vector3>& places,
                                 const std::vector<Vector3>& measured,
                                 const std::vector<Vector3>& computed) {
  DisplacementDistance result;
  result.displacement.assign(places.size(), Vector3::Constant(meshes::unknown));
  std::vector<std::size_t> known;
  for (std::size_t i = 0; i < places.size(); ++i)
    if (measured[i].allFinite() && computed[i].allFinite()) known.push_back(i);
  if (Index(known.size()) < fewest_for_motion) return result;
  const Matrix3Xd rest = chosen_columns(places, known), field = chosen_columns(computed, known),
                  loaded = rest + chosen_columns(measured, known);
  if (on_a_line(rest)) return result;
  const Matrix3Xd own = brought_to(loaded, rest + field, &result.turn) - rest;
  const Eigen::VectorXd apart = (own - field).colwise().norm();
  Index farthest = 0;
  result.largest = apart.maxCoeff(&farthest);
  result.farthest = known[std::size_t(farthest)];
  result.rms = rms_length(own - field);
  for (std::size_t i = 0; i < known.size(); ++i) result.displacement[known[i]] = own.col(Index(i));
  const Matrix3Xd strained = brought_to(rest + field, rest) - rest,
                  seen = brought_to(loaded, rest) - rest;
  result.size = rms_length(seen);
  result.ratio = strained.cwiseProduct(seen).sum() / strained.squaredNorm();
  return result;
}

GridScatter grid_scatter(const std::vector<Vector3>& grid, const std::vector<Vector3>& places) {
  GridScatter result;
  std::vector<std::size_t> known;
  for (std::size_t i = 0; i < places.size(); ++i)
    if (places[i].allFinite() && grid[i].allFinite()) known.push_back(i);
  if (Index(known.size()) < fewest_for_motion) return result;
  const Matrix3Xd wanted = chosen_columns(grid, known), found = chosen_columns(places, known);
  if (on_a_line(wanted)) return result;
  const Eigen::Matrix4d motion = Eigen::umeyama(wanted, found, true);
  const Matrix3Xd apart = found - ((motion.topLeftCorner<3, 3>() * wanted).colwise() +
                                   Eigen::Vector3d(motion.topRightCorner<3, 1>()));
  result.rms = rms_length(apart);
  result.largest = apart.colwise().norm().maxCoeff();
  result.pitch = std::cbrt(motion.topLeftCorner<3, 3>().determinant());
  return result;
}

}  // namespace fingertip::calibration::inline press_fit
