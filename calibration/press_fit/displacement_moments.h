/// A field of displacements as few independent numbers that a fit takes for the values of a curve.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "calibration/press_fit/displacements.h"

namespace fingertip::calibration::inline press_fit {

/// The rigid motion of the frame that measured, at every load: fitted, or known to be none.
enum class FrameMotion { fitted, held };

/// Of displacements at points, per load, the coordinates along orthonormal fields that are
/// polynomials of the place: noise that is alike and independent at all points is so of these, and
/// a smooth field keeps nearly all of itself. Where the frame's motion is fitted, places under load
/// are first brought to those at rest by the rigid motion that suits them best (distance_of), and
/// of the fields those that are left orthogonal to all small rigid motions: six values less per
/// load. A computed field goes the same way, so that one that differs by a rigid motion alone has
/// the same values. What was not measured counts on neither side.
class DisplacementMoments {
 public:
  /// Throws InvalidInput for a load with fewer than `fewest_points` points measured, or whose
  /// points stand so that no strain is told.
  DisplacementMoments(std::vector<meshes::Vector3> places,
                      const std::vector<MeasuredDisplacements>& measured, FrameMotion frame);

  static constexpr std::size_t fewest_points = 8;

  /// Of all loads in order [m]: of what was measured, and of a field per load.
  const Eigen::VectorXd& measured() const { return measured_; }
  Eigen::VectorXd of(const std::vector<std::vector<meshes::Vector3>>& fields) const;

  /// Per load: how many values, and the deviation of a displacement's component about the smooth
  /// fields [m], NaN where these leave nothing.
  struct Load {
    Eigen::Index values = 0;
    double scatter = meshes::unknown;
  };
  const std::vector<Load>& loads() const { return counts_; }

  /// Covariance of the values [m²] of a field that a model may miss: smooth over half of the
  /// points' extent and over half of the largest indentation, of the size of what was measured
  /// without rigid motion.
  Eigen::MatrixXd misfit_covariance() const;

 private:
  struct Fields {
    std::vector<std::size_t> points;       ///< measured under this load
    Eigen::MatrixXd scalar;                ///< orthonormal polynomials: a row per point
    Eigen::MatrixXd kept;                  ///< combinations of them along x, y and z, orthonormal
    double indentation = 0.0, size = 0.0;  ///< [m]
  };
  Eigen::MatrixXd strained(const Fields& load,
                           const std::vector<meshes::Vector3>& displacement) const;
  Eigen::VectorXd values(const Fields& load, const Eigen::MatrixXd& displacement) const;

  std::vector<meshes::Vector3> places_;
  FrameMotion frame_;
  std::vector<Fields> fields_;
  std::vector<Load> counts_;
  Eigen::VectorXd measured_;
};

}  // namespace fingertip::calibration::inline press_fit
