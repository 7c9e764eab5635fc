#include "fem_reference/analytic/bonded_disc.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <cmath>
#include <numbers>
#include <string>
#include <unsupported/Eigen/KroneckerProduct>

#include "fem_reference/analytic/elastic_field.h"

namespace fingertip::fem_reference::analytic {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using std::numbers::pi;

/// Legendre polynomials and their derivatives, a row per point, column k for P_k.
struct LegendreTable {
  MatrixXd value, slope;

  LegendreTable(const VectorXd& x, Index degree)
      : value(x.size(), degree + 1), slope(x.size(), degree + 1) {
    value.col(0).setOnes();
    slope.col(0).setZero();
    value.col(1) = x;
    slope.col(1).setOnes();
    for (Index k = 1; k < degree; ++k) {
      const double n = double(k);
      value.col(k + 1) =
          ((2 * n + 1) * x.cwiseProduct(value.col(k)) - n * value.col(k - 1)) / (n + 1);
      slope.col(k + 1) = slope.col(k - 1) + (2 * n + 1) * value.col(k);
    }
  }
};

/// Gauss points and weights on [0, 1], from the eigenvectors of the Jacobi matrix (Golub & Welsch,
/// Math. Comput. 23 (1969) 221).
struct GaussRule {
  VectorXd point, weight;

  explicit GaussRule(Index size) {
    MatrixXd jacobi = MatrixXd::Zero(size, size);
    for (Index k = 1; k < size; ++k)
      jacobi(k, k - 1) = double(k) / std::sqrt(4.0 * double(k) * double(k) - 1.0);
    const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(jacobi);  // reads the lower half
    point = (solver.eigenvalues().array() + 1.0) / 2.0;
    weight = solver.eigenvectors().row(0).transpose().array().square();
  }
};

/// Functions of one coordinate at the Gauss points of half the disc, a column per function.
struct Basis {
  VectorXd radial_weight, axial_weight;  ///< r dr and dz [m², m]
  MatrixXd ur, ur_slope, hoop;           ///< radial factor of u_r, its derivative and itself / r
  MatrixXd uz, uz_slope;                 ///< radial factor of u_z
  MatrixXd even, even_slope;             ///< axial factor of u_r
  MatrixXd odd, odd_slope;               ///< axial factor of u_z

  Basis(Index n, double radius, double half_thickness) {
    const GaussRule gauss(2 * n + 2);  // exact to degree 4n + 3, the highest that occurs
    const LegendreTable legendre(gauss.point, 2 * n + 1);
    const auto every_second = [&](const MatrixXd& table, Index first) -> MatrixXd {
      return table(Eigen::all, Eigen::seqN(first, n, 2));
    };
    radial_weight = radius * radius * gauss.weight.cwiseProduct(gauss.point);
    axial_weight = half_thickness * gauss.weight;
    ur = every_second(legendre.value, 1);
    ur_slope = every_second(legendre.slope, 1) / radius;
    hoop = (radius * gauss.point).cwiseInverse().asDiagonal() * ur;
    uz = every_second(legendre.value, 0);
    uz_slope = every_second(legendre.slope, 0) / radius;
    // N_k = P_{k+1} - P_{k-1}, whose derivative is (2k + 1) P_k, for k = 1, 3, ... and 2, 4, ...
    const MatrixXd &p = legendre.value, &dp = legendre.slope;
    even = every_second(p, 2) - every_second(p, 0);
    even_slope = (every_second(dp, 2) - every_second(dp, 0)) / half_thickness;
    odd = every_second(p, 3) - every_second(p, 1);
    odd_slope = (every_second(dp, 3) - every_second(dp, 1)) / half_thickness;
  }
};

/// Integrals of f_i g_j over one coordinate.
MatrixXd integrals(const MatrixXd& f, const VectorXd& weight, const MatrixXd& g) {
  return f.transpose() * weight.asDiagonal() * g;
}

/// Stiffness matrix of half the disc, without the factor 2 pi of the angle; unknowns (a, b). Every
/// term of the energy is an integral over r times one over z, hence a Kronecker product.
MatrixXd energy_matrix(const Basis& f, double lambda, double G) {
  const auto radial = [&](const MatrixXd& p, const MatrixXd& q) -> MatrixXd {
    return integrals(p, f.radial_weight, q);
  };
  const auto axial = [&](const MatrixXd& p, const MatrixXd& q) -> MatrixXd {
    return integrals(p, f.axial_weight, q);
  };
  const auto kron = [](const MatrixXd& p, const MatrixXd& q) -> MatrixXd {
    return Eigen::kroneckerProduct(p, q);
  };
  const MatrixXd spread = f.ur_slope + f.hoop;  // e_rr + e_tt
  const MatrixXd squares = radial(f.ur_slope, f.ur_slope) + radial(f.hoop, f.hoop);
  const Index n = f.ur.cols() * f.ur.cols();
  MatrixXd result(2 * n, 2 * n);
  result.topLeftCorner(n, n) =
      kron(lambda * radial(spread, spread) + 2.0 * G * squares, axial(f.even, f.even)) +
      kron(G * radial(f.ur, f.ur), axial(f.even_slope, f.even_slope));
  result.bottomRightCorner(n, n) =
      kron((lambda + 2.0 * G) * radial(f.uz, f.uz), axial(f.odd_slope, f.odd_slope)) +
      kron(G * radial(f.uz_slope, f.uz_slope), axial(f.odd, f.odd));
  result.topRightCorner(n, n) = kron(lambda * radial(spread, f.uz), axial(f.even, f.odd_slope)) +
                                kron(G * radial(f.ur, f.uz_slope), axial(f.even_slope, f.odd));
  result.bottomLeftCorner(n, n) = result.topRightCorner(n, n).transpose();
  return result;
}

/// Integrals of e_rr + e_tt for every unknown a_ij, without the factor 2 pi. Those of e_zz vanish
/// for every b_ij, since all u_z but the uniform one are zero on the plate and the middle plane.
VectorXd spread_integrals(const Basis& f) {
  const VectorXd radial = (f.ur_slope + f.hoop).transpose() * f.radial_weight;
  const VectorXd axial = f.even.transpose() * f.axial_weight;
  return Eigen::kroneckerProduct(radial, axial);
}

}  // namespace

BondedDisc::BondedDisc(const meshes::Rubber& rubber, double radius, double thickness)
    : rubber_(checked(rubber)),
      radius_(checked_positive("radius", radius)),
      thickness_(checked_positive("thickness", thickness)) {}

double BondedDisc::area() const {
  return pi * radius_ * radius_;
}

double BondedDisc::confined_stiffness() const {
  return rubber_.longitudinal_modulus() * area() / thickness_;
}

double BondedDisc::stiffness(int order) const {
  require(order >= 1 && order <= 40, "order", order, "must be 1 to 40");
  const Basis basis(order, radius_, thickness_ / 2.0);
  const double lambda = rubber_.lame_lambda();
  const Eigen::LLT<MatrixXd> factor(energy_matrix(basis, lambda, rubber_.shear_modulus));
  if (factor.info() != Eigen::Success)
    throw meshes::NotConverged("bonded disc: the Ritz matrix of order " + std::to_string(order) +
                               " is singular to working precision");
  // The uniform strain e_zz = -1/H costs the confined stiffness; lambda e_zz (e_rr + e_tt) drives
  // the material sideways and gives part of it back. Twice 2 pi: both halves of the disc.
  const VectorXd spread = spread_integrals(basis);
  VectorXd load = VectorXd::Zero(2 * spread.size());
  load.head(spread.size()) = lambda / thickness_ * spread;
  return confined_stiffness() - 4.0 * pi * load.dot(factor.solve(load));
}

double BondedDisc::corner_exponent() const {
  const double nu = rubber_.poissons_ratio(), kappa = 3.0 - 4.0 * nu;
  require(nu > -1e-12, "poissons_ratio", nu, "must not be negative");  // 0 with round-off is 0
  // The equation's left minus right side increases from -kappa²/4 to (kappa + 1)(3 - kappa)/4.
  double low = 0.5, high = 1.0;
  while (high - low > 1e-14) {
    const double alpha = (low + high) / 2.0, sine = std::sin(alpha * pi / 2.0);
    const double excess = kappa * sine * sine + alpha * alpha - (kappa + 1.0) * (kappa + 1.0) / 4.0;
    (excess < 0.0 ? low : high) = alpha;
  }
  return (low + high) / 2.0;
}

double BondedDisc::extrapolated_stiffness(int order) const {
  require(order >= 4 && order <= 40 && order % 2 == 0, "order", order, "must be even, 4 to 40");
  const double gain = std::pow(2.0, 4.0 * corner_exponent());
  const double fine = stiffness(order);
  return fine - (stiffness(order / 2) - fine) / (gain - 1.0);
}

}  // namespace fingertip::fem_reference::analytic
