/// What a rubber that relaxes makes of the course of a test's deformation.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <vector>

#include "calibration/material_tests/material_test.h"

namespace fingertip::calibration::inline material_tests {

/// What the stress of a test is made of: components of the second Piola-Kirchhoff stress S, on the
/// shape at rest, where free faces bear none. Of stresses after long times; `kirchhoff` is known
/// but for a pressure [Pa].
///
///   uniaxial, equibiaxial, planar   S11 = (tau_1 - tau_k)/l², k the free direction; 0
///   simple shear                    S12 = T - gamma S22, S22 = (tau_1 + tau_3 - 2 tau_2
///                                   - gamma T)/2, T = (tau_1 - tau_3)/sqrt(4 + gamma²);
///                                   direction 2 of the principal ones is free
///
/// Not of a volumetric test.
std::array<double, 2> stress_parts(TestKind kind, const std::array<double, 3>& kirchhoff,
                                   double deformation);

/// The measured stress is the sum of those parts times these: F S, or F S Fᵀ.
std::array<double, 2> part_weights(TestKind kind, StressMeasure measure, double deformation);

/// Rows are states or points, columns quantities that fade alike.
using PartTable = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// A test as steps in time from rest. A branch's stress h obeys h' + h/tau = s', s the stress after
/// long times (meshes/rubber/relaxation.h). In each step s is taken for the parabola through its
/// start, middle and end, and h is then exact:
///
///   h_end = k h_start + g (s_end - s_start) + 4 f (s_end - 2 s_middle + s_start)
///   k = exp(-x), g = (1 - k)/x, f = ((1 + k)/2 - g)/x, x = duration/tau
///
/// Steps end at all corners of the path and all points, and stretch the rubber by at most 2 %.
class RelaxingTest {
 public:
  /// Of its path, or, where the course is slow, of its rate, both sides of rest on their own;
  /// without steps where there is neither.
  explicit RelaxingTest(const MaterialTest& test);

  bool empty() const { return steps_.empty(); }
  /// Deformations at which s is needed.
  const std::vector<double>& states() const { return states_; }
  /// From s at the states to s at the test's points.
  PartTable now(const PartTable& equilibrium) const;
  /// From s at the states to h at the test's points, and its derivative by tau; tau > 0 [s].
  struct Branch {
    PartTable held, by_time;
  };
  Branch branch(const PartTable& equilibrium, double tau) const;

 private:
  struct Step {
    double duration;
    std::size_t start, middle, end;  ///< among the states
    bool fresh = false;              ///< from rest, nothing remembered
  };
  static constexpr std::size_t none = std::size_t(-1);

  void follow(const StrainPath& path, TestKind kind, const std::vector<double>& times,
              const std::vector<std::size_t>& points);
  void go_to(TestKind kind, double deformation, double duration, std::size_t point);
  std::size_t state(double deformation);

  std::vector<double> states_;
  std::vector<Step> steps_;
  std::vector<std::size_t> points_;  ///< that a step ends at, or none
  bool fresh_ = true;
  std::size_t count_ = 0;  ///< of points
};

}  // namespace fingertip::calibration::inline material_tests
