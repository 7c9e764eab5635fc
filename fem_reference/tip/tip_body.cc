#include "fem_reference/tip/tip_body.h"

#include <deal.II/base/mpi.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/fe/fe_values_extractors.h>
#include <deal.II/grid/grid_in.h>
#include <deal.II/grid/grid_tools.h>
#include <deal.II/grid/manifold.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <string>
#include <tuple>

#include "fem_reference/elements/kinematics.h"
#include "fem_reference/tip/curved_sides.h"
#include "meshes/base/errors.h"

namespace fingertip::fem_reference::inline tip {
namespace {

using dealii::types::global_dof_index;
using meshes::PhysicalTag;

/// A node's area over the largest one's that is round-off: of the pole of a meridian.
constexpr double no_area = 1e-9;

dealii::types::boundary_id id(PhysicalTag tag) {
  return dealii::types::boundary_id(tag);
}

/// Keeps new points on the sphere through their neighbours or on the cylinder: the mean of the
/// radii along the mean of the directions. deal.II's SphericalManifold gave some edges of this
/// mesh a "midpoint" that was one of their ends.
template <int dim>
class ShellManifold : public dealii::Manifold<dim> {
 public:
  /// `axis` is the cylinder's direction; zero means a sphere.
  explicit ShellManifold(const dealii::Tensor<1, dim>& axis) : axis_(axis) {}

  std::unique_ptr<dealii::Manifold<dim>> clone() const override {
    return std::make_unique<ShellManifold<dim>>(axis_);
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

template <int dim>
void read_mesh(const std::filesystem::path& file, Triangulation<dim>& triangulation) {
  meshes::inspect_tip_mesh(file);  // deal.II's reader crashes on a damaged file
  std::ifstream in(file);
  dealii::GridIn<dim> reader(triangulation);
  try {
    reader.read_msh(in);
  } catch (const std::exception& error) {
    refuse(file, std::string("the mesh file must be complete: ") + error.what());
  }
}

void turn(Triangulation<3>& triangulation, double tilt) {
  if (tilt != 0.0)
    dealii::GridTools::rotate(dealii::Tensor<1, 3>({0.0, 1.0, 0.0}), -tilt, triangulation);
}

/// Per unknown along z: its shape function times `of_place`, a function of the place, deformed
/// where there is a displacement, integrated over the outer surface (outer_area).
template <int dim>
Vector outer_integral(const Body<dim>& tip, const Vector* displacement,
                      const dealii::Quadrature<dim - 1>& quadrature, const auto& of_place) {
  const Space<dim>& space = tip.fine;
  dealii::FEFaceValues<dim> values(
      tip.mapping, space.element, quadrature,
      dealii::update_values | dealii::update_gradients | dealii::update_normal_vectors |
          dealii::update_quadrature_points | dealii::update_JxW_values);
  const dealii::FEValuesExtractors::Vector whole(0);
  std::vector<dealii::Tensor<2, dim>> gradients(quadrature.size());
  std::vector<dealii::Tensor<1, dim>> displacements(quadrature.size());
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
      if (displacement) {
        values[whole].get_function_gradients(ghosted, gradients);
        values[whole].get_function_values(ghosted, displacements);
      }
      local = 0.0;
      for (unsigned q = 0; q < quadrature.size(); ++q) {
        dealii::Tensor<1, dim> place = values.quadrature_point(q);
        if (displacement) place += displacements[q];
        double share = weight(values, q) * of_place(in_space<dim>(place));
        if (displacement) {  // Nanson: n da = J F^-T N dA
          const Eigen::Matrix3d f =
              Eigen::Matrix3d::Identity() +
              gradient_in_space(gradients[q], displacements[q], values.quadrature_point(q));
          const Eigen::Vector3d normal =
              f.inverse().transpose() * in_space<dim>(values.normal_vector(q));
          share *= std::abs(f.determinant() * normal.z());
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

}  // namespace

template <int dim>
std::unique_ptr<Body<dim>> read_tip(MPI_Comm communicator, const std::filesystem::path& mesh_file,
                                    int degree, double tilt, const meshes::Geometry& geometry,
                                    int components) {
  auto body = std::make_unique<Body<dim>>(communicator, degree, components);
  Triangulation<dim>& triangulation = body->triangulation;
  read_mesh(mesh_file, triangulation);
  if (!geometry.is_dome()) {
    if constexpr (dim == 3) turn(triangulation, tilt);
    follow_boundary(*body, geometry, tilt);
    return body;
  }
  constexpr dealii::types::manifold_id sphere = 1, cylinder = 2;
  for (const auto& cell : triangulation.cell_iterators())
    cell->set_all_manifold_ids(cell->center()[dim - 1] > 0.0 ? sphere : cylinder);
  triangulation.set_manifold(sphere, ShellManifold<dim>(dealii::Tensor<1, dim>()));
  if constexpr (dim == 3) {
    turn(triangulation, tilt);
    triangulation.set_manifold(
        cylinder, ShellManifold<3>(dealii::Tensor<1, 3>({-std::sin(tilt), 0.0, std::cos(tilt)})));
  } else {
    triangulation.set_manifold(cylinder, dealii::FlatManifold<dim>());
  }
  return body;
}

template <int dim>
std::vector<FixedComponent> tip_supports(int components) {
  std::vector<FixedComponent> fixed{{id(PhysicalTag::symmetry_x), 0}};
  if (dim == 3) fixed.push_back({id(PhysicalTag::symmetry_y), 1});
  if (dim < components) fixed.push_back({id(PhysicalTag::symmetry_x), 2});  // u_phi on the axis
  for (int component = 0; component < components; ++component)
    fixed.push_back({id(PhysicalTag::bond), component});
  return fixed;
}

template <int dim>
Vector outer_area(const Body<dim>& tip, const Vector* displacement) {
  // Gauss-Lobatto points are the nodes, so each one's weight is its node's share of the area.
  const dealii::QGaussLobatto<dim - 1> quadrature(unsigned(tip.degree()) + 1);
  return outer_integral(tip, displacement, quadrature,
                        [](const Eigen::Vector3d& /*place*/) { return 1.0; });
}

template <int dim>
std::vector<double> seen_areas(const Body<dim>& tip, const std::vector<SurfaceNode>& nodes,
                               const Vector* displacement) {
  const Vector rest = tip.fine.vector();
  std::vector<long> unknowns;
  for (const SurfaceNode& node : nodes) unknowns.push_back(node.unknown[2]);
  return tip.fine.gather(outer_area(tip, displacement ? displacement : &rest), unknowns);
}

std::vector<double> mean_squares(const Body<2>& tip, const std::vector<SurfaceNode>& nodes,
                                 const Vector* displacement) {
  const dealii::QGauss<1> quadrature(unsigned(tip.degree()) + 2);
  std::vector<long> unknowns;
  for (const SurfaceNode& node : nodes) unknowns.push_back(node.unknown[2]);
  const auto gathered = [&](const auto& of_place) {
    return tip.fine.gather(outer_integral(tip, displacement, quadrature, of_place), unknowns);
  };
  const auto areas = gathered([](const Eigen::Vector3d& /*place*/) { return 1.0; });
  std::vector<double> squares = gathered([](const Eigen::Vector3d& at) { return at.x() * at.x(); });
  for (std::size_t i = 0; i < squares.size(); ++i) squares[i] /= areas[i];
  return squares;
}

template <int dim>
std::vector<SurfaceNode> outer_nodes(const Body<dim>& tip) {
  const Space<dim>& space = tip.fine;
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
        const Eigen::Vector3d place = in_space<dim>(point);
        std::array<double, 10> entry{place.x(), place.y(), place.z(), area[indices[i]], -1, -1, -1};
        for (unsigned c = 0; c < unsigned(tip.components()); ++c) {
          const auto unknown = indices[space.element.component_to_system_index(c, node)];
          entry[4 + Kinematics<dim>::axis[c]] = double(unknown);
          entry[7 + Kinematics<dim>::axis[c]] =
              space.constraints.is_constrained(unknown) ? 0.0 : 1.0;
        }
        own.push_back(entry);
      }
    }
  }
  std::vector<SurfaceNode> nodes;
  const double largest = area.linfty_norm();
  for (const auto& part : dealii::Utilities::MPI::all_gather(space.communicator, own))
    for (const auto& e : part)
      nodes.push_back(
          {.position = {e[0], e[1], e[2]},
           .unknown = {long(e[4]), long(e[5]), long(e[6])},
           .free = {e[7] != 0.0, e[8] != 0.0, e[9] != 0.0},
           .area = e[3] > no_area * largest ? e[3] : 0.0,
           .extent = dim == 2 ? circumference(dealii::Point<2>(e[0], e[2])) : std::sqrt(e[3])});
  // Rounded, so that the order does not hang on the last bits of a position.
  const auto key = [](const SurfaceNode& node) {
    const auto rounded = [](double x) { return std::llround(x * 1e9); };
    return std::tuple(-rounded(node.position.z()), rounded(node.position.x()),
                      rounded(node.position.y()));
  };
  std::ranges::sort(nodes, {}, key);
  return nodes;
}

#define FINGERTIP_INSTANTIATE(dim)                                                           \
  template std::unique_ptr<Body<dim>> read_tip(MPI_Comm, const std::filesystem::path&, int,  \
                                               double, const meshes::Geometry&, int);        \
  template std::vector<FixedComponent> tip_supports<dim>(int);                               \
  template std::vector<SurfaceNode> outer_nodes(const Body<dim>&);                           \
  template Vector outer_area(const Body<dim>&, const Vector*);                               \
  template std::vector<double> seen_areas(const Body<dim>&, const std::vector<SurfaceNode>&, \
                                          const Vector*);
FINGERTIP_INSTANTIATE(2)
FINGERTIP_INSTANTIATE(3)
#undef FINGERTIP_INSTANTIATE

}  // namespace fingertip::fem_reference::inline tip
