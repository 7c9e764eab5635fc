/// Tests at finite strain that a formula answers: uniaxial stretch and simple shear under law A,
///   W = G/2 (I1 - 3 - 2 ln J) + lambda/2 (ln J)²   per volume at rest,
/// the law of the finite-strain continuum and, exactly, of the network lattice in homogeneous
/// deformation.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "calibration/material/material_parameter.h"
#include "calibration/statistics/forward_model.h"
#include "meshes/rubber/rubber.h"

namespace fingertip::calibration::inline press_fit {

/// Lengths over the length at rest that a bar of this law is asked for.
inline constexpr double min_stretch = 0.01, largest_stretch = 100.0;

/// G and lambda as functions of free parameters: youngs_modulus and shear_modulus, or lame_shear
/// and lambda; or modulus. One that is not free is the given rubber's.
class LawParameters {
 public:
  /// Throws InvalidInput for an empty list, a parameter named twice, another parameter than these
  /// four, E or G beside a parameter of the law, and a rubber that breaks its own rules.
  LawParameters(std::vector<MaterialParameter> parameters, const meshes::Rubber& rubber);

  struct Values {
    double shear = 0.0;     ///< G [Pa]
    double lambda = 0.0;    ///< [Pa]
    Eigen::MatrixXd chain;  ///< d(G, lambda)/d(parameters), dimensionless, 2 rows
  };
  /// Throws InvalidInput unless E, G > 0 and lambda >= 0 (nu >= 0: for lambda < 0 the energy of law
  /// A falls without bound as J -> 0) and, in terms of E and G, G > E/3.
  Values at(const Eigen::VectorXd& parameters) const;

 private:
  std::vector<MaterialParameter> parameters_;
  meshes::Rubber rubber_;
};

/// Nominal stress (force over the area at rest) [Pa] of a bar that is stretched along its axis and
/// free at its sides. With s along and t across, the sides carry no stress where
///   G (t² - 1) + lambda ln(s t²) = 0,   and then   P = G (s - t²/s).
/// Incompressible: P = G (s - 1/s²); small strain: P = E (s - 1). Derivatives are exact, by the
/// implicit-function theorem for t.
///
/// What such a test tells: G always; lambda only as far as the bar changes its volume, by about
/// G/lambda of its stress. So for a nearly incompressible rubber lambda stays open, while E and G,
/// whose ratio then is 3, are both sharp: their difference 3G - E, of which lambda is made, is not.
class UniaxialModel final : public ForwardModel {
 public:
  /// `stretches` s = length over length at rest, 0.01 to 100. Throws InvalidInput beyond, and as
  /// LawParameters do.
  UniaxialModel(std::vector<double> stretches, std::vector<MaterialParameter> parameters,
                const meshes::Rubber& rubber = {});

  CurveSlopes evaluate(const Eigen::VectorXd& parameters) override;

 private:
  std::vector<double> stretches_;
  LawParameters law_;
};

/// Shear stress [Pa] in simple shear, F = 1 + gamma e1 (x) e2: tau = G gamma at any strain, nominal
/// and true alike. The volume does not change, so lambda (and E at given G) is not seen at all; on
/// the sheared faces law A has no normal stress.
class SimpleShearModel final : public ForwardModel {
 public:
  /// `shears` gamma, finite. Throws InvalidInput otherwise, and as LawParameters do.
  SimpleShearModel(std::vector<double> shears, std::vector<MaterialParameter> parameters,
                   const meshes::Rubber& rubber = {});

  CurveSlopes evaluate(const Eigen::VectorXd& parameters) override;

 private:
  Eigen::VectorXd shears_;
  LawParameters law_;
};

}  // namespace fingertip::calibration::inline press_fit
