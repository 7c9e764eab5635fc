#include "lattice/statics/held_vibrations.h"

#include <Eigen/CholmodSupport>
#include <Eigen/Eigenvalues>
#include <stdexcept>

#include "lattice/statics/elastic_system.h"
#include "lattice/statics/factor_memory.h"

namespace fingertip::lattice::inline statics {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

/// Displacements of all particles per motion of the hand.
MatrixXd rigid_motions(const LatticeBody& body, const meshes::Vector3& point) {
  MatrixXd motions(body.unknowns(), 6);
  for (std::size_t p = 0; p < body.rest.size(); ++p)
    motions.middleRows<3>(3 * Index(p)) = rigid_motion(body.rest[p] - point);
  return motions;
}

VectorXd masses(const LatticeBody& body) {
  VectorXd mass(body.unknowns());
  for (Index i = 0; i < mass.size(); ++i) mass[i] = body.mass[std::size_t(i / 3)];
  return mass;
}

}  // namespace

Matrix6 rubber_inertia(const LatticeBody& body, const meshes::Vector3& point) {
  const MatrixXd motions = rigid_motions(body, point);
  return motions.transpose() * masses(body).asDiagonal() * motions;
}

HeldVibrations held_vibrations(const LatticeBody& body, const meshes::Vector3& point) {
  if (body.sectors != 1 || body.bond.empty())
    throw std::logic_error("vibrations of a held body need all of it, and its bond");
  const ElasticSystem system(body);
  VectorXd force;
  Tangent matrix = system.empty_tangent();
  system.assemble(VectorXd::Zero(body.unknowns()), force, &matrix);
  Eigen::CholmodSupernodalLLT<Tangent, Eigen::Lower> factor;
  factor.cholmod().print = 0;
  factor.compute(matrix);
  require_memory(factor.cholmod(), matrix.rows());
  if (factor.info() != Eigen::Success)
    throw meshes::NotConverged("the lattice is not stable at rest: its stiffness is not positive");

  const VectorXd mass = masses(body);
  const MatrixXd motions = rigid_motions(body, point);
  const MatrixXd loads = mass.asDiagonal() * motions;
  MatrixXd basis(body.unknowns(), 12);
  basis.leftCols<6>() = factor.solve(loads);
  const MatrixXd first_loads = mass.asDiagonal() * basis.leftCols<6>();
  basis.rightCols<6>() = factor.solve(first_loads);
  // What the second answers have of the first would hide the rest of them in round-off.
  const MatrixXd gram = basis.leftCols<6>().transpose() * first_loads;
  basis.rightCols<6>() -=
      basis.leftCols<6>() * gram.ldlt().solve(first_loads.transpose() * basis.rightCols<6>());
  for (Index i = 0; i < basis.cols(); ++i)
    basis.col(i) /= std::sqrt(basis.col(i).dot(mass.cwiseProduct(basis.col(i))));

  const MatrixXd stiff = matrix.selfadjointView<Eigen::Lower>() * basis;
  const Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd> ritz(
      basis.transpose() * stiff, basis.transpose() * mass.asDiagonal() * basis);
  HeldVibrations found;
  found.inertia = motions.transpose() * loads;
  found.squares = ritz.eigenvalues();
  found.shares = loads.transpose() * (basis * ritz.eigenvectors());
  return found;
}

}  // namespace fingertip::lattice::inline statics
