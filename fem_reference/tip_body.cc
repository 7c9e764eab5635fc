#include "fem_reference/tip_body.h"

#include <deal.II/base/mpi.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/fe/fe_values_extractors.h>
#include <deal.II/grid/grid_in.h>
#include <deal.II/grid/grid_tools.h>
#include <deal.II/grid/manifold.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <string>
#include <tuple>

#include "meshes/errors.h"

namespace fingertip::fem_reference {
namespace {

using dealii::types::global_dof_index;
using meshes::PhysicalTag;

dealii::types::boundary_id id(PhysicalTag tag) {
  return dealii::types::boundary_id(tag);
}

/// Keeps new points on the sphere through their neighbours or on the cylinder: the mean of the
/// radii along the mean of the directions. deal.II's SphericalManifold gave some edges of this
/// mesh a "midpoint" that was one of their ends.
class ShellManifold : public dealii::Manifold<dim> {
 public:
  /// `axis` is the cylinder's direction; zero means a sphere.
  explicit ShellManifold(const dealii::Tensor<1, dim>& axis) : axis_(axis) {}

  std::unique_ptr<dealii::Manifold<dim>> clone() const override {
    return std::make_unique<ShellManifold>(axis_);
  }

  dealii::Point<dim> get_new_point(const dealii::ArrayView<const dealii::Point<dim>>& points,
                                   const dealii::ArrayView<const double>& weights) const override {
    double radius = 0.0, height = 0.0;
    dealii::Tensor<1, dim> direction;
    for (unsigned i = 0; i < points.size(); ++i) {
      const double along = points[i] * axis_;
      height += weights[i] * along;
      const dealii::Tensor<1, dim> from_core = points[i] - along * axis_;
      const double distance = from_core.norm();
      radius += weights[i] * distance;
      direction += weights[i] / distance * from_core;
    }
    return dealii::Point<dim>(radius / direction.norm() * direction + height * axis_);
  }

 private:
  dealii::Tensor<1, dim> axis_;
};

[[noreturn]] void refuse(const std::filesystem::path& file, const std::string& rule) {
  throw meshes::InvalidInput(
      {"mesh", file.string(), rule, "make it anew: delete it and run again"});
}

void read_mesh(const std::filesystem::path& file, Triangulation& triangulation) {
  meshes::inspect_tip_mesh(file);  // deal.II's reader crashes on a damaged file
  std::ifstream in(file);
  dealii::GridIn<dim> reader(triangulation);
  try {
    reader.read_msh(in);
  } catch (const std::exception& error) {
    refuse(file, std::string("the mesh file must be complete: ") + error.what());
  }
}

}  // namespace

std::unique_ptr<Body> read_tip(MPI_Comm communicator, const std::filesystem::path& mesh_file,
                               int degree, double tilt) {
  auto body = std::make_unique<Body>(communicator, degree);
  Triangulation& triangulation = body->triangulation;
  read_mesh(mesh_file, triangulation);
  constexpr dealii::types::manifold_id sphere = 1, cylinder = 2;
  for (const auto& cell : triangulation.cell_iterators())
    cell->set_all_manifold_ids(cell->center()[2] > 0.0 ? sphere : cylinder);
  const dealii::Tensor<1, dim> y({0.0, 1.0, 0.0});
  if (tilt != 0.0) dealii::GridTools::rotate(y, -tilt, triangulation);
  triangulation.set_manifold(sphere, ShellManifold(dealii::Tensor<1, dim>()));
  triangulation.set_manifold(
      cylinder, ShellManifold(dealii::Tensor<1, dim>({-std::sin(tilt), 0.0, std::cos(tilt)})));
  return body;
}

std::vector<FixedComponent> tip_supports() {
  return {{id(PhysicalTag::bond), 0},
          {id(PhysicalTag::bond), 1},
          {id(PhysicalTag::bond), 2},
          {id(PhysicalTag::symmetry_x), 0},
          {id(PhysicalTag::symmetry_y), 1}};
}

Vector outer_area(const Body& tip, const Vector* displacement) {
  const Space& space = tip.fine;
  // Gauss-Lobatto points are the nodes, so each one's weight is its node's share of the area.
  const dealii::QGaussLobatto<dim - 1> quadrature(unsigned(tip.degree()) + 1);
  dealii::FEFaceValues<dim> values(tip.mapping, space.element, quadrature,
                                   dealii::update_values | dealii::update_gradients |
                                       dealii::update_normal_vectors | dealii::update_JxW_values);
  const dealii::FEValuesExtractors::Vector whole(0);
  std::vector<dealii::Tensor<2, dim>> gradients(quadrature.size());
  std::vector<global_dof_index> indices(space.element.n_dofs_per_cell());
  dealii::Vector<double> local(unsigned(indices.size()));
  Vector result = space.vector();
  Vector ghosted;
  if (displacement) ghosted = space.ghosted(*displacement);
  for (const auto& cell : space.dofs.active_cell_iterators()) {
    if (!cell->is_locally_owned()) continue;
    for (const unsigned face : cell->face_indices()) {
      if (!cell->face(face)->at_boundary() ||
          cell->face(face)->boundary_id() != id(PhysicalTag::outer))
        continue;
      values.reinit(cell, face);
      if (displacement) values[whole].get_function_gradients(ghosted, gradients);
      local = 0.0;
      for (unsigned q = 0; q < quadrature.size(); ++q) {
        double share = values.JxW(q);
        if (displacement) {  // Nanson: n da = J F^-T N dA
          const auto f = gradients[q] + dealii::unit_symmetric_tensor<dim>();
          share *= std::abs((determinant(f) * transpose(invert(dealii::Tensor<2, dim>(f))) *
                             values.normal_vector(q))[dim - 1]);
        }
        for (unsigned i = 0; i < indices.size(); ++i)
          if (space.element.system_to_component_index(i).first == dim - 1)
            local[i] += values.shape_value(i, q) * share;
      }
      cell->get_dof_indices(indices);
      space.constraints.distribute_local_to_global(local, indices, result);
    }
  }
  result.compress(dealii::VectorOperation::add);
  return result;
}

std::vector<SurfaceNode> outer_nodes(const Body& tip) {
  const Space& space = tip.fine;
  const Vector area = outer_area(tip);
  std::vector<std::array<double, 10>> own;  // position, area, unknowns, which are free
  std::vector<char> seen(space.owned.n_elements(), 0);
  std::vector<global_dof_index> indices(space.element.n_dofs_per_cell());
  for (const auto& cell : space.dofs.active_cell_iterators()) {
    if (!cell->is_locally_owned()) continue;
    cell->get_dof_indices(indices);
    for (const unsigned face : cell->face_indices()) {
      if (!cell->face(face)->at_boundary() ||
          cell->face(face)->boundary_id() != id(PhysicalTag::outer))
        continue;
      for (unsigned i = 0; i < indices.size(); ++i) {
        const auto [component, node] = space.element.system_to_component_index(i);
        if (component != dim - 1 || !space.element.has_support_on_face(i, face) ||
            !space.owned.is_element(indices[i]) || space.constraints.is_constrained(indices[i]))
          continue;
        char& done = seen[space.owned.index_within_set(indices[i])];
        if (done) continue;
        done = 1;
        const auto point =
            tip.mapping.transform_unit_to_real_cell(cell, space.element.unit_support_point(i));
        std::array<double, 10> entry{point[0], point[1], point[2], area[indices[i]]};
        for (unsigned c = 0; c < dim; ++c) {
          const auto unknown = indices[space.element.component_to_system_index(c, node)];
          entry[4 + c] = double(unknown);
          entry[7 + c] = space.constraints.is_constrained(unknown) ? 0.0 : 1.0;
        }
        own.push_back(entry);
      }
    }
  }
  std::vector<SurfaceNode> nodes;
  for (const auto& part : dealii::Utilities::MPI::all_gather(space.communicator, own))
    for (const auto& e : part)
      nodes.push_back({{e[0], e[1], e[2]},
                       {long(e[4]), long(e[5]), long(e[6])},
                       {e[7] != 0.0, e[8] != 0.0, e[9] != 0.0},
                       e[3]});
  // Rounded, so that the order does not hang on the last bits of a position.
  const auto key = [](const SurfaceNode& node) {
    const auto rounded = [](double x) { return std::llround(x * 1e9); };
    return std::tuple(-rounded(node.position.z()), rounded(node.position.x()),
                      rounded(node.position.y()));
  };
  std::ranges::sort(nodes, {}, key);
  return nodes;
}

}  // namespace fingertip::fem_reference
