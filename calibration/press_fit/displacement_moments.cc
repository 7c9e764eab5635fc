#include "calibration/press_fit/displacement_moments.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "meshes/base/dense.h"
#include "meshes/base/errors.h"

namespace fingertip::calibration::inline press_fit {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using meshes::Vector3;

namespace {

/// Of polynomials: beyond, a field of a press has next to nothing, and noise all of its share.
constexpr int most_degree = 5;
/// A function that others tell to this share is none of its own: points on a plane or a surface.
constexpr double dependent = 1e-6;
/// Of what a model misses, over the points' extent and over the largest indentation.
constexpr double field_length = 0.5;

/// Places in [-1, 1] along each axis, and 0 along one without extent.
MatrixXd scaled_places(const std::vector<Vector3>& places) {
  MatrixXd at(Index(places.size()), 3);
  for (std::size_t i = 0; i < places.size(); ++i) at.row(Index(i)) = places[i].transpose();
  const Eigen::RowVectorXd low = at.colwise().minCoeff(), high = at.colwise().maxCoeff();
  const double extent = (high - low).maxCoeff();
  for (Index axis = 0; axis < 3; ++axis) {
    const double half = std::max(0.5 * (high(axis) - low(axis)), 1e-9 * extent);
    at.col(axis) = (at.col(axis).array() - 0.5 * (low(axis) + high(axis))) / half;
  }
  return at;
}

/// Monomials of total degree up to `degree`, a row per point; products of Legendre's are as well.
MatrixXd monomial_columns(const MatrixXd& at, int degree) {
  std::vector<VectorXd> all;
  for (int i = 0; i <= degree; ++i)
    for (int j = 0; i + j <= degree; ++j)
      for (int k = 0; i + j + k <= degree; ++k)
        all.emplace_back(at.col(0).array().pow(i) * at.col(1).array().pow(j) *
                         at.col(2).array().pow(k));
  MatrixXd columns(at.rows(), Index(all.size()));
  for (std::size_t c = 0; c < all.size(); ++c) columns.col(Index(c)) = all[c].normalized();
  return columns;
}

/// Orthonormal columns of the same span.
MatrixXd orthonormal_columns(const MatrixXd& columns) {
  const meshes::OrthonormalBasis basis = meshes::orthonormal_basis(columns, dependent);
  return basis.columns.leftCols(basis.rank);
}

/// The largest degree whose functions are at most half as many as the points.
MatrixXd scalar_fields(const MatrixXd& at) {
  MatrixXd found;
  for (int degree = 1; degree <= most_degree; ++degree) {
    const MatrixXd more = orthonormal_columns(monomial_columns(at, degree));
    if (found.size() > 0 && 2 * more.cols() > at.rows()) break;
    found = more;
  }
  return found;
}

/// Components of a field [3 columns] one below the other, x first.
VectorXd stacked_components(const MatrixXd& field) {
  return Eigen::Map<const VectorXd>(field.data(), field.size());
}

/// Small rigid motions as coordinates along scalar fields of x, y and z.
MatrixXd rigid_coordinates(const MatrixXd& scalar, const MatrixXd& at) {
  const Index functions = scalar.cols();
  MatrixXd motions(3 * functions, 6);
  for (Index axis = 0; axis < 3; ++axis) {
    MatrixXd field = MatrixXd::Zero(at.rows(), 3);
    field.col(axis).setOnes();
    motions.col(axis) = stacked_components(scalar.transpose() * field);
    field.setZero();
    const Index next = (axis + 1) % 3, last = (axis + 2) % 3;
    field.col(next) = -at.col(last);
    field.col(last) = at.col(next);
    motions.col(3 + axis) = stacked_components(scalar.transpose() * field);
  }
  return motions;
}

/// Orthonormal columns of everything orthogonal to `columns`.
MatrixXd complement_of(const MatrixXd& columns) {
  const meshes::OrthonormalBasis basis = meshes::orthonormal_basis(columns, dependent);
  return basis.columns.rightCols(columns.rows() - basis.rank);
}

MatrixXd true_places(const std::vector<Vector3>& places, const std::vector<std::size_t>& points) {
  MatrixXd at(Index(points.size()), 3);
  for (std::size_t i = 0; i < points.size(); ++i) at.row(Index(i)) = places[points[i]].transpose();
  const double extent = (at.colwise().maxCoeff() - at.colwise().minCoeff()).maxCoeff();
  return (at.rowwise() - at.colwise().mean()) / extent;  // rotations, whose unit does not matter
}

}  // namespace

DisplacementMoments::DisplacementMoments(std::vector<Vector3> places,
                                         const std::vector<MeasuredDisplacements>& measured,
                                         FrameMotion frame)
    : places_(std::move(places)), frame_(frame) {
  std::vector<VectorXd> all;
  Index total = 0;
  for (const MeasuredDisplacements& load : measured) {
    Fields& fields = fields_.emplace_back();
    fields.indentation = load.indentation;
    for (std::size_t i = 0; i < places_.size(); ++i)
      if (load.displacement[i].allFinite()) fields.points.push_back(i);
    const auto refuse = [&](const std::string& rule) {
      throw meshes::InvalidInput({"displacements", std::to_string(fields.points.size()) + " points",
                                  rule, "measure more points, spread over the rubber"});
    };
    if (fields.points.size() < fewest_points)
      refuse("a load needs at least " + std::to_string(fewest_points) + " points");
    std::vector<Vector3> own;
    for (const std::size_t i : fields.points) own.push_back(places_[i]);
    const MatrixXd at = scaled_places(own);
    if (orthonormal_columns(monomial_columns(at, 1)).cols() < 3)
      refuse("points on a line tell no strain");
    fields.scalar = scalar_fields(at);
    const Index functions = fields.scalar.cols();
    fields.kept =
        frame_ == FrameMotion::held
            ? MatrixXd(MatrixXd::Identity(3 * functions, 3 * functions))
            : complement_of(rigid_coordinates(fields.scalar, true_places(places_, fields.points)));
    const MatrixXd field = strained(fields, load.displacement);
    fields.size = std::sqrt(field.squaredNorm() / double(field.rows()));
    all.push_back(values(fields, field));
    const double rest = field.squaredNorm() - (fields.scalar.transpose() * field).squaredNorm();
    const Index free = field.size() - 3 * functions;
    counts_.push_back({all.back().size(),
                       free > 0 ? std::sqrt(std::max(0.0, rest) / double(free)) : meshes::unknown});
    total += all.back().size();
  }
  measured_.resize(total);
  Index first = 0;
  for (const VectorXd& own : all) {
    measured_.segment(first, own.size()) = own;
    first += own.size();
  }
}

MatrixXd DisplacementMoments::strained(const Fields& load,
                                       const std::vector<Vector3>& displacement) const {
  std::vector<Vector3> rest, field;
  for (const std::size_t i : load.points) {
    rest.push_back(places_[i]);
    field.push_back(displacement[i]);
  }
  if (frame_ == FrameMotion::fitted)
    field =
        distance_of(rest, field, std::vector<Vector3>(rest.size(), Vector3::Zero())).displacement;
  MatrixXd result(Index(field.size()), 3);
  for (std::size_t i = 0; i < field.size(); ++i) result.row(Index(i)) = field[i].transpose();
  return result;
}

VectorXd DisplacementMoments::values(const Fields& load, const MatrixXd& displacement) const {
  return load.kept.transpose() * stacked_components(load.scalar.transpose() * displacement);
}

VectorXd DisplacementMoments::of(const std::vector<std::vector<Vector3>>& fields) const {
  VectorXd all(measured_.size());
  Index first = 0;
  for (std::size_t s = 0; s < fields_.size(); ++s) {
    const Index count = counts_[s].values;
    all.segment(first, count) = values(fields_[s], strained(fields_[s], fields.at(s)));
    first += count;
  }
  return all;
}

MatrixXd DisplacementMoments::misfit_covariance() const {
  const MatrixXd at = scaled_places(places_);
  const double deepest = fields_.back().indentation;
  const auto near = [](double apart) { return std::exp(-0.5 * std::pow(apart / field_length, 2)); };
  MatrixXd covariance(measured_.size(), measured_.size());
  Index row = 0;
  for (std::size_t s = 0; s < fields_.size(); ++s) {
    Index column = 0;
    for (std::size_t t = 0; t < fields_.size(); ++t) {
      const Fields &one = fields_[s], &other = fields_[t];
      const MatrixXd between = MatrixXd::NullaryExpr(
          Index(one.points.size()), Index(other.points.size()), [&](Index i, Index j) {
            return near(0.5 * (at.row(Index(one.points[std::size_t(i)])) -
                               at.row(Index(other.points[std::size_t(j)])))
                                  .norm());
          });
      const MatrixXd scalar = one.scalar.transpose() * between * other.scalar;
      MatrixXd all = MatrixXd::Zero(3 * scalar.rows(), 3 * scalar.cols());
      for (Index axis = 0; axis < 3; ++axis)
        all.block(axis * scalar.rows(), axis * scalar.cols(), scalar.rows(), scalar.cols()) =
            scalar;
      // Of a component: a third of the square of the field's size.
      const double size =
          one.size * other.size / 3.0 * near((one.indentation - other.indentation) / deepest);
      covariance.block(row, column, counts_[s].values, counts_[t].values) =
          size * one.kept.transpose() * all * other.kept;
      column += counts_[t].values;
    }
    row += counts_[s].values;
  }
  return covariance;
}

}  // namespace fingertip::calibration::inline press_fit
