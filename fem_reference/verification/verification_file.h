/// verification.json: what checks the continuum's code. SI. Free of deal.II.
#pragma once

#include <string>
#include <vector>

#include "fem_reference/job/job.h"
#include "meshes/tables/file_fields.h"

namespace fingertip::fem_reference::inline verification {

/// Errors of one element on meshes of one body, coarse to fine, and how fast they fall.
struct ConvergenceStudy {
  std::string problem;
  int degree = 0;
  Volumetric volumetric = Volumetric::mean_dilatation;
  double poissons_ratio = 0.0;
  struct Mesh {
    double h = 0.0;         ///< edge of an element: along block or height, or through the wall [m]
    double unknowns = 0.0;  ///< their number
    /// FieldError: relative, of the displacement and of its gradient
    double error_l2 = 0.0, error_h1 = 0.0;
  };
  std::vector<Mesh> meshes;
  /// -d log error / d log(1/h) between the two finest meshes, and the theory's degree + 1 and
  /// degree
  double order_l2 = 0.0, order_h1 = 0.0, expected_l2 = 0.0, expected_h1 = 0.0;
};

/// A number that is known otherwise.
struct Check {
  std::string name, quantity, source;
  double value = 0.0, expected = 0.0;
  /// |value - expected| / |expected|; where zero is expected |value|, which then is a ratio itself
  double relative_error = 0.0;
  double tolerance = 0.0;
  bool passed = false;
};

/// One stiffness-like figure of one element at one Poisson's ratio.
struct LockingPoint {
  std::string problem;
  std::string element;  ///< "Q2 projected" and so on
  double poissons_ratio = 0.0;
  double value = 0.0, reference = 0.0;
  double relative_error = 0.0;  ///< value / reference - 1; positive is too stiff
};

struct VerificationFile {
  std::vector<ConvergenceStudy> studies;
  std::vector<Check> checks;
  std::vector<LockingPoint> locking;

  bool empty() const { return studies.empty() && checks.empty() && locking.empty(); }
};

FINGERTIP_FIELDS(ConvergenceStudy::Mesh, h, unknowns, error_l2, error_h1);
FINGERTIP_FIELDS(ConvergenceStudy, problem, degree, volumetric, poissons_ratio, meshes, order_l2,
                 order_h1, expected_l2, expected_h1);
FINGERTIP_FIELDS(Check, name, quantity, source, value, expected, relative_error, tolerance, passed);
FINGERTIP_FIELDS(LockingPoint, problem, element, poissons_ratio, value, reference, relative_error);
FINGERTIP_FIELDS(VerificationFile, studies, checks, locking);

}  // namespace fingertip::fem_reference::inline verification
