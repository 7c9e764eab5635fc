/// The discretised elastic tip: mesh, unknowns, stiffness matrix and what is read off a solution.
/// Free of deal.II.
#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <array>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <vector>

#include "meshes/geometry.h"
#include "meshes/rubber.h"

namespace fingertip::fem_reference {

/// A node of the outer surface, where the rubber may meet the plane.
struct SurfaceNode {
  meshes::Vector3 position;  ///< in the reference shape [m]
  std::array<int, 3> dof{};  ///< unknowns of its displacement along x, y, z
  double area = 0.0;         ///< its entry of the lumped (Gauss-Lobatto) surface mass [m²]
};

/// A mesh edge in the plane y = 0, undeformed and deformed, as (x1, z1, x2, z2) [m].
struct SectionEdge {
  std::array<double, 4> undeformed{};
  std::array<double, 4> deformed{};
};

/// Small-strain linear isotropic elasticity on the quarter of the tip that `write_tip_mesh` makes:
/// isoparametric Lagrange hexahedra whose nodes lie on the true sphere and cylinder.
/// Unknowns are numbered over all nodes, the held ones included; u is in the rod's frame [m].
class ElasticTip {
 public:
  using Matrix = Eigen::SparseMatrix<double>;

  /// Reads the mesh and assembles. `degree` is 1 or 2. Throws std::runtime_error when the mesh
  /// cannot be read.
  ElasticTip(const meshes::Rubber& rubber, const std::filesystem::path& mesh_file, int degree);
  ~ElasticTip();
  ElasticTip(ElasticTip&&) noexcept;

  std::size_t cells() const;
  int dofs() const { return int(stiffness_.rows()); }

  /// Stiffness of all unknowns, without any constraint: symmetric, both halves stored [N/m].
  const Matrix& stiffness() const { return stiffness_; }
  /// 1 for unknowns that bond (u = 0) or symmetry (u_x = 0 at x = 0, u_y = 0 at y = 0) hold.
  const std::vector<char>& fixed() const { return fixed_; }
  /// Node and component (0, 1, 2) of every unknown.
  const std::vector<int>& node_of_dof() const { return node_of_dof_; }
  const std::vector<int>& component_of_dof() const { return component_of_dof_; }
  /// Position of every node [m].
  const std::vector<meshes::Vector3>& nodes() const { return nodes_; }
  const std::vector<SurfaceNode>& outer_nodes() const { return outer_nodes_; }

  /// Volume [m³] and area of a surface [m²] of the curved mesh, by Gauss quadrature.
  double volume() const;
  double area(meshes::Surface surface) const;

  /// Force [N] with which the rod holds the mesh's bond surface, from the residual K u there.
  meshes::Vector3 bond_reaction(const Eigen::VectorXd& displacement) const;

  /// Writes a VTU with displacement [m], stress and von Mises stress [Pa] and the contact traction
  /// [Pa] of the plane on the rubber. `reaction` holds the nodal forces of the plane [N].
  void write_fields(const Eigen::VectorXd& displacement, const Eigen::VectorXd& reaction,
                    const std::filesystem::path& file) const;

  /// The mesh edges in the plane y = 0.
  std::vector<SectionEdge> section(const Eigen::VectorXd& displacement) const;

 private:
  struct Discretisation;
  void assemble();
  void find_constraints();
  void find_outer_nodes();

  std::unique_ptr<Discretisation> discretisation_;
  meshes::Rubber rubber_;
  Matrix stiffness_;
  std::vector<char> fixed_;
  std::vector<int> node_of_dof_, component_of_dof_;
  std::vector<meshes::Vector3> nodes_;
  std::vector<SurfaceNode> outer_nodes_;
  std::vector<double> nodal_area_;
};

}  // namespace fingertip::fem_reference
