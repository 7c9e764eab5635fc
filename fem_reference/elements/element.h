/// Element matrices: what one element of a given material contributes, of a solid (dim = 3) or a
/// body of revolution (dim = 2). Rows and columns are ordered node by node, dim a + i for component
/// i of node a, 3 a + i where a body of revolution is twisted.
#pragma once

#include <deal.II/fe/fe_values.h>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <memory>
#include <vector>

#include "fem_reference/job/job.h"
#include "meshes/rubber/hyperelastic_law.h"
#include "meshes/rubber/rubber.h"

namespace fingertip::fem_reference::inline elements {

/// Symmetric tensors in columns: entries 11, 22, 33, 23, 13, 12.
using SymmetricTensors = Eigen::Matrix<double, 6, Eigen::Dynamic>;
/// One of them, and back.
Eigen::Matrix3d tensor_of(const Eigen::Matrix<double, 6, 1>& entries);
Eigen::Matrix<double, 6, 1> entries_of(const Eigen::Matrix3d& tensor);

/// Second Piola-Kirchhoff stresses [Pa] at the quadrature points of every active cell of a mesh, as
/// `assemble` chooses them; cells that other processes own are zero.
struct PointStresses {
  Eigen::Index points = 0;  ///< of a cell
  SymmetricTensors values;  ///< column: active cell index times `points` plus point

  auto of_cell(unsigned cell) const {
    return values.middleCols(Eigen::Index(cell) * points, points);
  }
  auto of_cell(unsigned cell) { return values.middleCols(Eigen::Index(cell) * points, points); }
};

/// Stiffness (or mass) and internal force of an element.
struct ElementSystem {
  Eigen::MatrixXd matrix;     ///< (dim n, dim n)
  Eigen::VectorXd force;      ///< (dim n), zero where a kernel has none
  double min_jacobian = 1.0;  ///< smallest J = det F at the quadrature points
  double energy = 0.0;        ///< [J]
  SymmetricTensors stresses;  ///< second Piola-Kirchhoff, at the quadrature points [Pa]
};

/// What is asked of an element: its force, which costs a fifth of its stiffness at large strain;
/// that and the stresses, of which small strain has none; force and stiffness.
enum class Parts { force, stresses, all };

/// Integrates one element. A kernel may fill in the matrix though only the force is asked for.
/// `values` is of the scalar element, with gradients, values, points and JxW; `displacement` holds
/// the element's nodal displacements [m].
template <int dim>
class ElementKernel {
 public:
  virtual ~ElementKernel() = default;
  virtual void integrate(const dealii::FEValues<dim>& values, const Eigen::VectorXd& displacement,
                         Parts parts, ElementSystem& result) = 0;
  /// For another thread: a kernel keeps work space.
  virtual std::unique_ptr<ElementKernel> clone() const = 0;
};

/// Hooke's law at small strain: K_ai,bj = ∫ lambda da_i db_j + G (da_j db_i + delta_ij da·db), with
/// phi_a/r added to da_r in the first part and 2 G phi_a phi_b/r² to K_ar,br in a body of
/// revolution. With the projected volumetric term the first part is lambda ∫ P(da_i) P(db_j), P the
/// L2 projection on the element onto polynomials of one degree less in the coordinates; quadratic
/// elements with it are the Q2/P1 pair, free of locking as nu -> 1/2 (Boffi, Brezzi & Fortin,
/// Mixed Finite Element Methods and Applications, section 8.6). Displacements of three components
/// twist a body of revolution: G ∫ (phi_a,r - phi_a/r)(phi_b,r - phi_b/r) + phi_a,z phi_b,z between
/// the third ones.
template <int dim>
class HookeKernel : public ElementKernel<dim> {
 public:
  HookeKernel(const meshes::Rubber& rubber, Volumetric volumetric);
  /// Of Lamé's constants [Pa], whatever their signs.
  HookeKernel(double lambda, double shear, Volumetric volumetric)
      : lambda_(lambda), shear_(shear), volumetric_(volumetric) {}
  void integrate(const dealii::FEValues<dim>& values, const Eigen::VectorXd& displacement,
                 Parts parts, ElementSystem& result) override;
  std::unique_ptr<ElementKernel<dim>> clone() const override {
    return std::make_unique<HookeKernel>(*this);
  }

 private:
  /// Adds the third component of nodes to the matrix of the other two.
  void add_twist(Eigen::MatrixXd& matrix);

  double lambda_, shear_;
  Volumetric volumetric_;
  Eigen::MatrixXd gradients_, hoops_, divergences_, products_;
};

/// Large strain, total Lagrangian, exact tangent. The volumetric term m/2 h(J)² becomes
/// m/2 (P h(J))² when projected; energy, force and tangent stay derivatives of one another.
/// Throws NotConverged for an inverted element. `carried` stresses S stay what they are whatever
/// the displacement: P = dW/dF + F S. They have no share of the energy.
template <int dim>
class HyperelasticKernel : public ElementKernel<dim> {
 public:
  /// `carried` must stay alive.
  HyperelasticKernel(const meshes::HyperelasticLaw& law, Volumetric volumetric,
                     const PointStresses* carried = nullptr);
  void integrate(const dealii::FEValues<dim>& values, const Eigen::VectorXd& displacement,
                 Parts parts, ElementSystem& result) override;
  std::unique_ptr<ElementKernel<dim>> clone() const override {
    return std::make_unique<HyperelasticKernel>(*this);
  }

 private:
  void fill_tangent(Eigen::MatrixXd& matrix);
  void add_swelling(const Eigen::MatrixXd& swelling, const Eigen::MatrixXd& weighted_basis,
                    double modulus, Eigen::MatrixXd& matrix);

  meshes::HyperelasticLaw law_;
  Volumetric volumetric_;
  const PointStresses* carried_;
  Eigen::MatrixXd slopes_, stressed_, block_, projected_;
  /// dP/dF of every point, by component and slope of both.
  std::vector<Eigen::Matrix<double, 3 * dim, 3 * dim>> tangents_;
};

/// Consistent mass, rho ∫ phi_a phi_b delta_ij.
template <int dim>
class MassKernel : public ElementKernel<dim> {
 public:
  explicit MassKernel(double density) : density_(density) {}
  void integrate(const dealii::FEValues<dim>& values, const Eigen::VectorXd& displacement,
                 Parts parts, ElementSystem& result) override;
  std::unique_ptr<ElementKernel<dim>> clone() const override {
    return std::make_unique<MassKernel>(*this);
  }

 private:
  double density_;
};

/// Polynomials of total degree `degree` in the coordinates, orthonormal in L2 of one element (of
/// the ring that it stands for, in a body of revolution).
template <int dim>
class ElementPolynomials {
 public:
  /// The inner product is the quadrature of `values`.
  ElementPolynomials(const dealii::FEValues<dim>& values, int degree);
  /// Their values: (points, polynomials).
  Eigen::MatrixXd at(const std::vector<dealii::Point<dim>>& points) const;

 private:
  Eigen::MatrixXd monomials(const std::vector<dealii::Point<dim>>& points) const;

  int degree_;
  dealii::Tensor<1, dim> centre_;
  double size_;
  Eigen::LLT<Eigen::MatrixXd> mass_;  ///< of the monomials
};

}  // namespace fingertip::fem_reference::inline elements
