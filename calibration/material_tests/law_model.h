/// From coefficients of a law at large strain to the stresses of material tests, in closed form.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "calibration/material/material_parameter.h"
#include "calibration/material_tests/material_test.h"
#include "calibration/material_tests/relaxing_test.h"
#include "calibration/statistics/forward_model.h"
#include "meshes/rubber/relaxation.h"
#include "meshes/rubber/strain_energy.h"

namespace fingertip::calibration::inline material_tests {

/// Branches of a relaxation that can be fitted.
inline constexpr int max_branches = 5;

/// A law, how many terms of its series it has, yeoh and ogden 1 to 3, the others 1, and how many
/// branches its relaxation, 0 to `max_branches`.
struct LawChoice {
  meshes::RubberLaw law = meshes::RubberLaw::neo_hookean;
  int terms = 1;
  int branches = 0;
  bool operator==(const LawChoice&) const = default;
};
/// "neo-hookean", "yeoh-3", "ogden-2+prony-1".
std::string name(const LawChoice& choice);
/// Every law that can be fitted, the simplest first, without relaxation. Yeoh of one term is
/// neo-hookean.
const std::vector<LawChoice>& known_laws();
std::optional<LawChoice> law_named(std::string_view name);

/// Of the law after long times, in the order in which they are fitted.
std::vector<MaterialParameter> law_coefficients(const LawChoice& choice);
/// The same, then share and time of every branch.
std::vector<MaterialParameter> coefficients(const LawChoice& choice);
/// Of coefficients in that order, as many branches as the choice has; its rules may be broken.
meshes::Relaxation relaxation_of(const LawChoice& choice, const Eigen::VectorXd& coefficients);

/// A law with its shear modulus; what `meshes::StrainEnergy` is made of.
struct SizedLaw {
  double shear_modulus = 0.0;  ///< G at rest [Pa]
  meshes::StrainEnergy energy;
};
/// After long times, from coefficients in that order. neo_hookean G; yeoh C_i, G = 2 C1;
/// mooney_rivlin C10, C01, G = 2 (C10 + C01); ogden mu_i, alpha_i, G = sum mu_i; gent G, Jm. Throws
/// InvalidInput unless G > 0.
SizedLaw sized_law(const LawChoice& choice, const Eigen::VectorXd& coefficients);

/// d(G)/d(coefficients) there.
Eigen::VectorXd shear_modulus_slopes(const LawChoice& choice, const Eigen::VectorXd& coefficients);

/// Stress [Pa] of an incompressible body after long times: with tau_k of `principal_response` and l
/// the deformation
///
///   uniaxial               (tau_1 - tau_2)/l        nominal; times l: true
///   equibiaxial, planar    (tau_1 - tau_3)/l        likewise
///   simple shear           (tau_1 - tau_3)/sqrt(4 + l²)
///
/// (the sum of stress_parts times part_weights), the last by dW/d(shear), ln of the longest stretch
/// being asinh(l/2). Infinite beyond the limit of a gent law. Not for volumetric tests.
double test_stress(const SizedLaw& law, TestKind kind, StressMeasure measure, double deformation);

/// Mean stress K (J - 1) [Pa] of the volumetric law `quadratic`, which the deviatoric law does not
/// enter; d/dK is J - 1.
double mean_stress(double bulk_modulus, double volume_ratio);

/// A material test as a curve, every stress over a scale of its own. Derivatives are exact
/// (ceres::Jet). Where the choice has branches and the test a path or a rate (RelaxingTest), each
/// of its stress_parts s becomes s + sum b_i h_i, all moduli relaxing alike: free faces then bear
/// nothing at any time, for K of any size, and the rest follows (README). A slow test without a
/// rate is one after long times.
class LawModel final : public ForwardModel {
 public:
  /// `scales` > 0, one per point [Pa]. `parameters` are the choice's coefficients, bulk_modulus
  /// after them where it is sought.
  LawModel(MaterialTest test, std::vector<double> scales, LawChoice choice,
           std::vector<MaterialParameter> parameters);

  /// Throws InvalidInput unless G > 0, NotConverged beyond the limit of a gent law and for shares
  /// that sum to 1 or more.
  CurveSlopes evaluate(const Eigen::VectorXd& parameters) override;

  /// stress_parts of the law at the course's states and their derivatives by its coefficients, two
  /// columns each, over 1; from the law alone.
  PartTable equilibrium_parts(const Eigen::VectorXd& parameters) const;
  const RelaxingTest& course() const { return course_; }
  /// Over its scale, the sum at point p of parts times part_weights.
  double scaled(std::size_t p, const Eigen::RowVector2d& parts) const;

 private:
  CurveSlopes volume(const Eigen::VectorXd& parameters) const;
  /// stress_parts at deformations, and their derivatives; NotConverged beyond the law's limit.
  PartTable parts_at(const std::vector<double>& deformations,
                     const Eigen::VectorXd& parameters) const;

  MaterialTest test_;
  std::vector<double> scales_;
  LawChoice choice_;
  std::vector<MaterialParameter> parameters_;
  RelaxingTest course_;
};

}  // namespace fingertip::calibration::inline material_tests
