/// Force and tangent of the rubber on a meridian mesh.
#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <array>
#include <vector>

#include "meshes/rubber/rubber.h"
#include "tests/verification/axisymmetric/meridian.h"

namespace fingertip::verification {

/// Unknown 2 n + c is component c (r, z) of node n. With H = (u_r,r; u_r,z; u_z,r; u_z,z; u_r/r),
/// F = 1 + H and weights 2 pi r. The nodes of the bond stand still, those of the axis stay on it.
class MeridianBody {
 public:
  MeridianBody(const Meridian& mesh, const meshes::Rubber& rubber, bool finite);

  /// force = dU/du [N]; tangent = d²U/du² [N/m], lower triangle, unless null. False where an
  /// element is turned inside out.
  bool assemble(const Eigen::VectorXd& u, Eigen::VectorXd& force,
                Eigen::SparseMatrix<double>* tangent) const;
  Eigen::SparseMatrix<double> empty_tangent() const { return pattern_; }
  const std::vector<char>& fixed() const { return fixed_; }

 private:
  using Five = Eigen::Matrix<double, 5, 1>;
  using FiveByFive = Eigen::Matrix<double, 5, 5>;
  struct Point {
    Eigen::Matrix<double, 5, 18> gradient;
    double weight = 0.0;  ///< 2 pi r dA [m³]
  };

  void make_points(const Meridian& mesh);
  void make_pattern();
  bool respond(const Five& h, Five& stress, FiveByFive& stiffness) const;

  std::vector<std::array<int, 9>> elements_;
  std::vector<Point> points_;  ///< nine per element
  double shear_, lambda_;
  bool finite_;
  std::vector<char> fixed_;
  Eigen::SparseMatrix<double> pattern_;
  std::vector<std::array<int, 171>> places_;  ///< per element, of its lower triangle's entries
};

}  // namespace fingertip::verification
