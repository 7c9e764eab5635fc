#include "fem_reference/elastic_tip.h"

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/grid/grid_in.h>
#include <deal.II/grid/manifold.h>
#include <deal.II/lac/dynamic_sparsity_pattern.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <set>
#include <stdexcept>

#include "fem_reference/discretisation.h"
#include "meshes/volume_mesh.h"

namespace fingertip::fem_reference {
namespace {

constexpr int dim = 3;
using dealii::types::global_dof_index;
using meshes::PhysicalTag;

bool lies_on(const dealii::DoFHandler<dim>::cell_iterator& cell, unsigned face, PhysicalTag tag) {
  return cell->face(face)->at_boundary() &&
         cell->face(face)->boundary_id() == dealii::types::boundary_id(tag);
}

/// Keeps new points on the sphere through their neighbours (z > 0) or on the cylinder (z < 0): the
/// mean of the radii along the mean of the directions. deal.II's SphericalManifold gave some edges
/// of this mesh a "midpoint" that was one of their ends.
class ShellManifold : public dealii::Manifold<dim> {
 public:
  explicit ShellManifold(bool sphere) : sphere_(sphere) {}

  std::unique_ptr<dealii::Manifold<dim>> clone() const override {
    return std::make_unique<ShellManifold>(sphere_);
  }

  dealii::Point<dim> get_new_point(const dealii::ArrayView<const dealii::Point<dim>>& points,
                                   const dealii::ArrayView<const double>& weights) const override {
    double radius = 0.0, height = 0.0;
    dealii::Tensor<1, dim> direction;
    for (unsigned i = 0; i < points.size(); ++i) {
      dealii::Tensor<1, dim> from_core = points[i];
      if (!sphere_) {
        height += weights[i] * from_core[2];
        from_core[2] = 0.0;
      }
      const double distance = from_core.norm();
      radius += weights[i] * distance;
      direction += weights[i] / distance * from_core;
    }
    dealii::Point<dim> result(radius / direction.norm() * direction);
    if (!sphere_) result[2] = height;
    return result;
  }

 private:
  bool sphere_;
};

void read_mesh(const std::filesystem::path& file, dealii::Triangulation<dim>& triangulation) {
  std::ifstream in(file);
  if (!in) throw std::runtime_error("cannot read the mesh " + file.string());
  dealii::GridIn<dim> reader(triangulation);
  try {
    reader.read_msh(in);
  } catch (const std::exception& error) {
    throw std::runtime_error("the mesh " + file.string() + " is damaged: " + error.what());
  }
  constexpr dealii::types::manifold_id sphere = 1, cylinder = 2;
  for (const auto& cell : triangulation.active_cell_iterators())
    cell->set_all_manifold_ids(cell->center()[2] > 0.0 ? sphere : cylinder);
  triangulation.set_manifold(sphere, ShellManifold(true));
  triangulation.set_manifold(cylinder, ShellManifold(false));
}

/// Adds w ∫ sigma(phi_b e_j) : grad(phi_a e_i) of one quadrature point for all i, j:
/// lambda da_i db_j + G (da_j db_i + delta_ij da·db).
void add_node_pair(const dealii::Tensor<1, dim>& da, const dealii::Tensor<1, dim>& db,
                   double weighted_lambda, double weighted_shear, double* block) {
  const double dot = weighted_shear * (da * db);
  for (int i = 0; i < dim; ++i)
    for (int j = 0; j < dim; ++j)
      block[3 * i + j] += weighted_lambda * da[i] * db[j] + weighted_shear * da[j] * db[i];
  for (int i = 0; i < dim; ++i) block[4 * i] += dot;
}

/// Stiffness of one element as 3 x 3 blocks over pairs of nodes, row-major, a <= b filled.
void element_stiffness(const dealii::FEValues<dim>& values, const meshes::Rubber& rubber,
                       std::vector<double>& blocks) {
  const unsigned nodes = values.get_fe().n_dofs_per_cell();
  std::ranges::fill(blocks, 0.0);
  for (unsigned q = 0; q < values.n_quadrature_points; ++q) {
    const double lambda = rubber.lame_lambda() * values.JxW(q);
    const double shear = rubber.shear_modulus * values.JxW(q);
    for (unsigned a = 0; a < nodes; ++a)
      for (unsigned b = a; b < nodes; ++b)
        add_node_pair(values.shape_grad(a, q), values.shape_grad(b, q), lambda, shear,
                      &blocks[9 * (a * nodes + b)]);
  }
}

ElasticTip::Matrix empty_matrix(const dealii::DoFHandler<dim>& dof_handler) {
  const int n = int(dof_handler.n_dofs());
  dealii::DynamicSparsityPattern pattern(dof_handler.n_dofs());
  dealii::DoFTools::make_sparsity_pattern(dof_handler, pattern);
  ElasticTip::Matrix matrix(n, n);
  matrix.resizeNonZeros(int(pattern.n_nonzero_elements()));
  int entry = 0;
  for (int row = 0; row < n; ++row) {  // the pattern is symmetric: its rows are the columns
    matrix.outerIndexPtr()[row] = entry;
    std::vector<int> columns;
    for (auto it = pattern.begin(global_dof_index(row)); it != pattern.end(global_dof_index(row));
         ++it)
      columns.push_back(int(it->column()));
    std::ranges::sort(columns);
    for (const int column : columns) {
      matrix.innerIndexPtr()[entry] = column;
      matrix.valuePtr()[entry++] = 0.0;
    }
  }
  matrix.outerIndexPtr()[n] = entry;
  return matrix;
}

/// Adds the element's three rows of node `a` into one column of the matrix.
void scatter(ElasticTip::Matrix& matrix, int column, const std::vector<int>& sorted_rows,
             const std::vector<double>& sorted_values) {
  // Both the element's rows and the column's entries are sorted, so one merging pass suffices.
  const int* row = matrix.innerIndexPtr() + matrix.outerIndexPtr()[column];
  double* value = matrix.valuePtr() + matrix.outerIndexPtr()[column];
  for (std::size_t k = 0; k < sorted_rows.size(); ++k) {
    while (*row < sorted_rows[k]) ++row, ++value;
    *value += sorted_values[k];
  }
}

}  // namespace

ElasticTip::Discretisation::Discretisation(int degree)
    : element(dealii::FE_Q<dim>(unsigned(degree)), dim),
      mapping(unsigned(degree)),
      dof_handler(triangulation) {}

ElasticTip::ElasticTip(const meshes::Rubber& rubber, const std::filesystem::path& mesh_file,
                       int degree)
    : discretisation_(std::make_unique<Discretisation>(degree)), rubber_(rubber) {
  read_mesh(mesh_file, discretisation_->triangulation);
  discretisation_->dof_handler.distribute_dofs(discretisation_->element);
  assemble();
  find_constraints();
  find_outer_nodes();
}

ElasticTip::~ElasticTip() = default;
ElasticTip::ElasticTip(ElasticTip&&) noexcept = default;

std::size_t ElasticTip::cells() const {
  return discretisation_->triangulation.n_active_cells();
}

void ElasticTip::assemble() {
  const Discretisation& d = *discretisation_;
  stiffness_ = empty_matrix(d.dof_handler);

  const dealii::FiniteElement<dim>& scalar = d.element.base_element(0);
  const dealii::QGauss<dim> quadrature(scalar.degree + 1);
  dealii::FEValues<dim> values(d.mapping, scalar, quadrature,
                               dealii::update_gradients | dealii::update_JxW_values);
  const unsigned nodes = scalar.n_dofs_per_cell(), size = d.element.n_dofs_per_cell();
  std::vector<double> blocks(std::size_t(9) * nodes * nodes);
  std::vector<global_dof_index> dofs(size);
  std::vector<unsigned> order(size);
  std::vector<int> rows(size);
  std::vector<double> column_values(size);

  for (const auto& cell : d.dof_handler.active_cell_iterators()) {
    values.reinit(static_cast<dealii::Triangulation<dim>::cell_iterator>(cell));
    element_stiffness(values, rubber_, blocks);
    cell->get_dof_indices(dofs);
    for (unsigned i = 0; i < size; ++i) order[i] = i;
    std::ranges::sort(order, {}, [&](unsigned i) { return dofs[i]; });
    for (unsigned k = 0; k < size; ++k) rows[k] = int(dofs[order[k]]);
    for (unsigned j = 0; j < size; ++j) {
      const auto [jc, b] = d.element.system_to_component_index(j);
      for (unsigned k = 0; k < size; ++k) {
        const auto [ic, a] = d.element.system_to_component_index(order[k]);
        column_values[k] = a <= b ? blocks[9 * (a * nodes + b) + 3 * ic + jc]
                                  : blocks[9 * (b * nodes + a) + 3 * jc + ic];
      }
      scatter(stiffness_, int(dofs[j]), rows, column_values);
    }
  }
}

void ElasticTip::find_constraints() {
  const Discretisation& d = *discretisation_;
  const std::size_t n = d.dof_handler.n_dofs();
  fixed_.assign(n, 0);
  component_of_dof_.resize(n);
  node_of_dof_.assign(n, -1);
  std::vector<dealii::Point<dim>> points(n);
  dealii::DoFTools::map_dofs_to_support_points(d.mapping, d.dof_handler, points);

  std::vector<global_dof_index> dofs(d.element.n_dofs_per_cell());
  std::vector<int> node_of_local(d.element.n_dofs_per_cell());
  for (const auto& cell : d.dof_handler.active_cell_iterators()) {
    cell->get_dof_indices(dofs);
    // The x unknown of a node comes first and gives the node its number; y and z follow it.
    for (unsigned i = 0; i < dofs.size(); ++i) {
      const auto [component, node] = d.element.system_to_component_index(i);
      component_of_dof_[dofs[i]] = int(component);
      if (component == 0) {
        if (node_of_dof_[dofs[i]] < 0) {
          node_of_dof_[dofs[i]] = int(nodes_.size());
          nodes_.push_back({points[dofs[i]][0], points[dofs[i]][1], points[dofs[i]][2]});
        }
        node_of_local[node] = node_of_dof_[dofs[i]];
      }
    }
    for (unsigned i = 0; i < dofs.size(); ++i)
      node_of_dof_[dofs[i]] = node_of_local[d.element.system_to_component_index(i).second];
  }
  const auto fix = [&](PhysicalTag tag, const std::vector<bool>& components) {
    const dealii::ComponentMask mask(components);
    for (const auto dof : dealii::DoFTools::extract_boundary_dofs(
             d.dof_handler, mask, {dealii::types::boundary_id(tag)}))
      fixed_[dof] = 1;
  };
  fix(PhysicalTag::bond, {true, true, true});
  fix(PhysicalTag::symmetry_x, {true, false, false});
  fix(PhysicalTag::symmetry_y, {false, true, false});
}

void ElasticTip::find_outer_nodes() {
  const Discretisation& d = *discretisation_;
  // Gauss-Lobatto points are the nodes, so each one's weight is its node's share of the area.
  const dealii::QGaussLobatto<dim - 1> quadrature(d.element.degree + 1);
  dealii::FEFaceValues<dim> values(d.mapping, d.element, quadrature,
                                   dealii::update_values | dealii::update_JxW_values);
  std::vector<global_dof_index> dofs(d.element.n_dofs_per_cell());
  std::map<int, SurfaceNode> found;
  for (const auto& cell : d.dof_handler.active_cell_iterators())
    for (const unsigned face : cell->face_indices()) {
      if (!lies_on(cell, face, PhysicalTag::outer)) continue;
      values.reinit(cell, face);
      cell->get_dof_indices(dofs);
      for (unsigned i = 0; i < dofs.size(); ++i) {
        if (!d.element.has_support_on_face(i, face)) continue;
        const int component = component_of_dof_[dofs[i]];
        SurfaceNode& node = found[node_of_dof_[dofs[i]]];
        node.dof[std::size_t(component)] = int(dofs[i]);
        if (component == 0)
          for (unsigned q = 0; q < values.n_quadrature_points; ++q)
            node.area += values.shape_value(i, q) * values.JxW(q);
      }
    }
  nodal_area_.assign(nodes_.size(), 0.0);
  for (auto& [number, node] : found) {
    node.position = nodes_[std::size_t(number)];
    nodal_area_[std::size_t(number)] = node.area;
    outer_nodes_.push_back(node);
  }
}

double ElasticTip::volume() const {
  const Discretisation& d = *discretisation_;
  dealii::FEValues<dim> values(d.mapping, d.element, dealii::QGauss<dim>(4),
                               dealii::update_JxW_values);
  double sum = 0.0;
  for (const auto& cell : d.dof_handler.active_cell_iterators()) {
    values.reinit(cell);
    for (unsigned q = 0; q < values.n_quadrature_points; ++q) sum += values.JxW(q);
  }
  return sum;
}

double ElasticTip::area(meshes::Surface surface) const {
  const Discretisation& d = *discretisation_;
  const PhysicalTag tag = surface == meshes::Surface::outer  ? PhysicalTag::outer
                          : surface == meshes::Surface::bond ? PhysicalTag::bond
                                                             : PhysicalTag::end;
  dealii::FEFaceValues<dim> values(d.mapping, d.element, dealii::QGauss<dim - 1>(4),
                                   dealii::update_JxW_values);
  double sum = 0.0;
  for (const auto& cell : d.dof_handler.active_cell_iterators())
    for (const unsigned face : cell->face_indices()) {
      if (!lies_on(cell, face, tag)) continue;
      values.reinit(cell, face);
      for (unsigned q = 0; q < values.n_quadrature_points; ++q) sum += values.JxW(q);
    }
  return sum;
}

meshes::Vector3 ElasticTip::bond_reaction(const Eigen::VectorXd& displacement) const {
  const Discretisation& d = *discretisation_;
  const Eigen::VectorXd residual = stiffness_ * displacement;
  meshes::Vector3 force = meshes::Vector3::Zero();
  for (const auto dof :
       dealii::DoFTools::extract_boundary_dofs(d.dof_handler, dealii::ComponentMask(dim, true),
                                               {dealii::types::boundary_id(PhysicalTag::bond)}))
    force[component_of_dof_[dof]] += residual[Eigen::Index(dof)];
  return force;
}

std::vector<SectionEdge> ElasticTip::section(const Eigen::VectorXd& displacement) const {
  const Discretisation& d = *discretisation_;
  std::vector<SectionEdge> edges;
  std::set<std::array<unsigned, 2>> seen;
  const auto moved = [&](const dealii::DoFHandler<dim>::line_iterator& line, unsigned end,
                         int component) {
    return line->vertex(end)[unsigned(component)] +
           displacement[Eigen::Index(line->vertex_dof_index(end, unsigned(component)))];
  };
  for (const auto& cell : d.dof_handler.active_cell_iterators())
    for (const unsigned face : cell->face_indices()) {
      if (!lies_on(cell, face, PhysicalTag::symmetry_y)) continue;
      for (unsigned l = 0; l < 4; ++l) {
        const auto line = cell->face(face)->line(l);
        if (!seen.insert({line->vertex_index(0), line->vertex_index(1)}).second) continue;
        edges.push_back(
            {{line->vertex(0)[0], line->vertex(0)[2], line->vertex(1)[0], line->vertex(1)[2]},
             {moved(line, 0, 0), moved(line, 0, 2), moved(line, 1, 0), moved(line, 1, 2)}});
      }
    }
  return edges;
}

}  // namespace fingertip::fem_reference
