#include "fem_reference/verification/elastic_problem.h"

#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/fe/fe_values_extractors.h>
#include <deal.II/numerics/vector_tools_boundary.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "fem_reference/field_solver.h"

namespace fingertip::fem_reference {
namespace {

using dealii::types::boundary_id;
using dealii::types::global_dof_index;
using meshes::Vector3;

Vector3 to_eigen(const dealii::Tensor<1, 3>& t) {
  return {t[0], t[1], t[2]};
}

class AsFunction : public dealii::Function<3> {
 public:
  explicit AsFunction(const Loading::Field& field) : dealii::Function<3>(3), field_(field) {}
  double value(const dealii::Point<3>& p, unsigned component) const override {
    return field_ ? field_(to_eigen(p))[component] : 0.0;
  }

 private:
  const Loading::Field& field_;
};

/// Hanging nodes alone, and with supports: the constraints of one loading.
void constrain(Body<3>& body, const Loading& loading) {
  Space<3>& space = body.fine;
  space.constraints.clear();
  space.constraints.reinit(space.relevant);
  dealii::DoFTools::make_hanging_node_constraints(space.dofs, space.constraints);
  const AsFunction displacement(loading.displacement);
  for (const Prescribed& entry : loading.prescribed) {
    dealii::ComponentMask mask(3, false);
    mask.set(unsigned(entry.component), true);
    dealii::VectorTools::interpolate_boundary_values(body.mapping, space.dofs,
                                                     boundary_id(entry.boundary), displacement,
                                                     space.constraints, mask);
  }
  space.constraints.close();
}

template <class Values>
void add_load(const Values& values, unsigned q, const Vector3& density,
              dealii::Vector<double>& local) {
  const auto& element = values.get_fe();
  for (unsigned i = 0; i < local.size(); ++i)
    local[i] += values.shape_value(i, q) * values.JxW(q) *
                density[element.system_to_component_index(i).first];
}

/// Consistent nodal forces of body force and traction, passed on by `constraints` [N].
Vector external_load(const Body<3>& body, const Loading& loading,
                     const dealii::AffineConstraints<double>& constraints) {
  const Space<3>& space = body.fine;
  const unsigned points = unsigned(body.degree()) + 2;
  const auto flags =
      dealii::update_values | dealii::update_quadrature_points | dealii::update_JxW_values;
  dealii::FEValues<3> inside(body.mapping, space.element, dealii::QGauss<3>(points), flags);
  dealii::FEFaceValues<3> surface(body.mapping, space.element, dealii::QGauss<3 - 1>(points),
                                  flags | dealii::update_normal_vectors);
  Vector load = space.vector();
  dealii::Vector<double> local(space.element.n_dofs_per_cell());
  std::vector<global_dof_index> indices(local.size());
  for (const auto& cell : space.dofs.active_cell_iterators()) {
    local = 0.0;
    if (loading.body_force) {
      inside.reinit(cell);
      for (const unsigned q : inside.quadrature_point_indices())
        add_load(inside, q, loading.body_force(to_eigen(inside.quadrature_point(q))), local);
    }
    for (const auto& face : cell->face_iterators()) {
      if (!loading.traction || !face->at_boundary()) continue;
      surface.reinit(cell, face);
      for (const unsigned q : surface.quadrature_point_indices())
        add_load(surface, q,
                 loading.traction(int(face->boundary_id()), to_eigen(surface.quadrature_point(q)),
                                  to_eigen(surface.normal_vector(q))),
                 local);
    }
    cell->get_dof_indices(indices);
    constraints.distribute_local_to_global(local, indices, load);
  }
  load.compress(dealii::VectorOperation::add);
  return load;
}

}  // namespace

std::vector<Prescribed> whole(const std::vector<int>& boundaries) {
  std::vector<Prescribed> result;
  for (const int b : boundaries)
    for (int component = 0; component < 3; ++component) result.push_back({b, component});
  return result;
}

Loading loading_of(const analytic::ElasticField& exact, std::vector<Prescribed> prescribed) {
  Loading loading;
  loading.prescribed = std::move(prescribed);
  loading.displacement = [&exact](const Vector3& x) { return exact.displacement(x); };
  loading.body_force = [&exact](const Vector3& x) { return exact.body_force(x); };
  loading.traction = [&exact](int, const Vector3& x, const Vector3& n) {
    return exact.traction(x, n);
  };
  return loading;
}

/// The solution at a quadrature point.
struct PointState {
  Vector3 place, displacement;
  analytic::Matrix3 gradient;
  double dilatation = 0.0;  ///< as the element takes it, projected or not
  double volume = 0.0;
};

struct ElasticProblem::Implementation {
  Body<3> body;
  Volumetric volumetric;
  meshes::Rubber rubber;
  mutable HookeKernel<3> kernel;
  Vector displacement;
  Vector load;  ///< of the last solution, as if nothing were supported [N]

  Implementation(const BodyMesh& description, const ElementType& element,
                 const meshes::Rubber& material)
      : body(MPI_COMM_SELF, element.degree),
        volumetric(element.volumetric),
        rubber(material),
        kernel(material, element.volumetric) {
    make_mesh(description, body);
    body.number({});
    displacement.reinit(body.fine.vector());
    load.reinit(displacement);
  }

  /// Calls `take(PointState)` at points enough for errors of the elements' order.
  template <class Take>
  void for_each_point(Take take) const {
    const Space<3>& space = body.fine;
    dealii::FEValues<3> values(body.mapping, space.element,
                               dealii::QGauss<3>(unsigned(body.degree()) + 2),
                               dealii::update_values | dealii::update_gradients |
                                   dealii::update_quadrature_points | dealii::update_JxW_values);
    const dealii::FEValuesExtractors::Vector all(0);
    std::vector<dealii::Tensor<1, 3>> u(values.n_quadrature_points);
    std::vector<dealii::Tensor<2, 3>> gradients(values.n_quadrature_points);
    const auto points = Eigen::Index(values.n_quadrature_points);
    Eigen::VectorXd dilatation(points), weights(points);
    for (const auto& cell : space.dofs.active_cell_iterators()) {
      values.reinit(cell);
      values[all].get_function_values(displacement, u);
      values[all].get_function_gradients(displacement, gradients);
      for (Eigen::Index q = 0; q < points; ++q) {
        dilatation[q] = trace(gradients[std::size_t(q)]);
        weights[q] = values.JxW(unsigned(q));
      }
      if (volumetric == Volumetric::projected) {
        const Eigen::MatrixXd basis =
            ElementPolynomials<3>(values, body.degree() - 1).at(values.get_quadrature_points());
        dilatation = basis * (basis.transpose() * weights.cwiseProduct(dilatation));
      }
      for (Eigen::Index q = 0; q < points; ++q) {
        PointState state{to_eigen(values.quadrature_point(unsigned(q))),
                         to_eigen(u[std::size_t(q)]),
                         {},
                         dilatation[q],
                         weights[q]};
        for (unsigned i = 0; i < 3; ++i)
          for (unsigned j = 0; j < 3; ++j) state.gradient(i, j) = gradients[std::size_t(q)][i][j];
        take(state);
      }
    }
  }

  /// Calls `take(unknowns of the three components, place)` once per node.
  template <class Take>
  void for_each_node(Take take) const {
    const Space<3>& space = body.fine;
    std::vector<char> seen(space.dofs.n_dofs(), 0);
    std::vector<global_dof_index> indices(space.element.n_dofs_per_cell());
    for (const auto& cell : space.dofs.active_cell_iterators()) {
      cell->get_dof_indices(indices);
      for (unsigned node = 0; node < indices.size() / 3; ++node) {
        std::array<global_dof_index, 3> unknowns{};
        for (unsigned c = 0; c < 3; ++c)
          unknowns[c] = indices[space.element.component_to_system_index(c, node)];
        if (seen[unknowns[0]]++) continue;
        take(unknowns, to_eigen(body.mapping.transform_unit_to_real_cell(
                           cell, space.element.unit_support_point(
                                     space.element.component_to_system_index(0, node)))));
      }
    }
  }
};

ElasticProblem::ElasticProblem(const BodyMesh& body, const ElementType& element,
                               const meshes::Rubber& rubber)
    : implementation_(std::make_unique<Implementation>(body, element, rubber)) {}

ElasticProblem::~ElasticProblem() = default;

std::size_t ElasticProblem::unknowns() const {
  return implementation_->body.unknowns();
}

double ElasticProblem::volume() const {
  return fem_reference::volume(implementation_->body);
}

void ElasticProblem::solve(const Loading& loading) {
  Implementation& self = *implementation_;
  Body<3>& body = self.body;
  constrain(body, loading);
  LinearSystem system(body, false);
  assemble(body, self.kernel, body.fine.vector(), system);
  Vector load = external_load(body, loading, body.fine.constraints);
  // At zero displacement only the prescribed unknowns move: their forces on the free ones.
  load -= condensed_force(body, self.kernel, body.fine.vector(), body.fine.constraints);
  // The solver is made for contact: one free unknown plays a contact that never closes.
  std::vector<long> contact;
  for (global_dof_index i = 0; contact.empty() && i < body.unknowns(); ++i)
    if (!body.fine.constraints.is_constrained(i)) contact.push_back(long(i));
  if (!contact.empty()) {
    const auto solver = make_condensed_solver(body, contact);
    solver->set_matrix(system);
    solver->set_load(load);
    solver->solve_constrained({0}, Eigen::VectorXd::Zero(1), Eigen::VectorXd::Zero(1));
    self.displacement = solver->field();
  }
  body.fine.constraints.distribute(self.displacement);
  self.load = external_load(body, loading, body.fine.hanging_nodes());
}

FieldError ElasticProblem::error(const analytic::ElasticField& exact) const {
  FieldError error, size;
  implementation_->for_each_point([&](const PointState& state) {
    const Vector3 u = exact.displacement(state.place);
    const analytic::Matrix3 g = exact.gradient(state.place);
    error.l2 += state.volume * (u - state.displacement).squaredNorm();
    error.h1 += state.volume * (g - state.gradient).squaredNorm();
    size.l2 += state.volume * u.squaredNorm();
    size.h1 += state.volume * g.squaredNorm();
  });
  return {std::sqrt(error.l2 / size.l2), std::sqrt(error.h1 / size.h1)};
}

double ElasticProblem::stress_error(const analytic::ElasticField& exact) const {
  const meshes::Rubber& rubber = implementation_->rubber;
  double error = 0.0, size = 0.0;
  implementation_->for_each_point([&](const PointState& state) {
    const analytic::Matrix3 wanted = exact.stress(state.place);
    const analytic::Matrix3 found =
        rubber.lame_lambda() * state.dilatation * analytic::Matrix3::Identity() +
        rubber.shear_modulus * (state.gradient + state.gradient.transpose());
    error += state.volume * (wanted - found).squaredNorm();
    size += state.volume * wanted.squaredNorm();
  });
  return std::sqrt(error / size);
}

double ElasticProblem::nodal_error(const Loading::Field& exact) const {
  const Implementation& self = *implementation_;
  double error = 0.0, size = 0.0;
  self.for_each_node([&](const std::array<global_dof_index, 3>& unknowns, const Vector3& x) {
    const Vector3 wanted = exact(x);
    Vector3 found;
    for (unsigned c = 0; c < 3; ++c) found[c] = self.displacement[unknowns[c]];
    error = std::max(error, (found - wanted).norm());
    size = std::max(size, wanted.norm());
  });
  return error / size;
}

Vector3 ElasticProblem::mean_displacement(int boundary) const {
  const Implementation& self = *implementation_;
  const Space<3>& space = self.body.fine;
  dealii::FEFaceValues<3> values(self.body.mapping, space.element,
                                 dealii::QGauss<3 - 1>(unsigned(self.body.degree()) + 2),
                                 dealii::update_values | dealii::update_JxW_values);
  const dealii::FEValuesExtractors::Vector all(0);
  std::vector<dealii::Tensor<1, 3>> u(values.n_quadrature_points);
  Vector3 sum = Vector3::Zero();
  double area = 0.0;
  for (const auto& cell : space.dofs.active_cell_iterators())
    for (const auto& face : cell->face_iterators()) {
      if (!face->at_boundary() || face->boundary_id() != boundary_id(boundary)) continue;
      values.reinit(cell, face);
      values[all].get_function_values(self.displacement, u);
      for (const unsigned q : values.quadrature_point_indices()) {
        sum += values.JxW(q) * to_eigen(u[q]);
        area += values.JxW(q);
      }
    }
  return sum / area;
}

Vector3 ElasticProblem::reaction(int boundary) const {
  const Implementation& self = *implementation_;
  Vector force = unconstrained_force(self.body, self.kernel, self.displacement);
  force -= self.load;
  return resultant(self.body, force, boundary_id(boundary));
}

double ElasticProblem::energy() const {
  const Implementation& self = *implementation_;
  double sum = 0.0;
  for_each_element(
      self.body, self.kernel, self.displacement,
      [&](const CellIterator<3>&, const dealii::FullMatrix<double>&, const dealii::Vector<double>&,
          const ElementSystem& element) { sum += element.energy; });
  return sum;
}

Eigen::MatrixXd ElasticProblem::stiffness() const {
  const Implementation& self = *implementation_;
  const Space<3>& space = self.body.fine;
  const auto constraints = space.hanging_nodes();
  const auto count = unsigned(space.dofs.n_dofs());
  dealii::FullMatrix<double> matrix(count, count);
  std::vector<global_dof_index> indices(space.element.n_dofs_per_cell());
  for_each_element(self.body, self.kernel, space.vector(),
                   [&](const CellIterator<3>& cell, const dealii::FullMatrix<double>& local,
                       const dealii::Vector<double>&, const ElementSystem&) {
                     cell->get_dof_indices(indices);
                     constraints.distribute_local_to_global(local, indices, matrix);
                   });
  std::vector<global_dof_index> order;
  self.for_each_node([&](const std::array<global_dof_index, 3>& unknowns, const Vector3&) {
    if (!constraints.is_constrained(unknowns[0]))
      order.insert(order.end(), unknowns.begin(), unknowns.end());
  });
  Eigen::MatrixXd result(order.size(), order.size());
  for (std::size_t i = 0; i < order.size(); ++i)
    for (std::size_t j = 0; j < order.size(); ++j)
      result(Eigen::Index(i), Eigen::Index(j)) = matrix(unsigned(order[i]), unsigned(order[j]));
  return result;
}

std::vector<Vector3> ElasticProblem::nodes() const {
  const Implementation& self = *implementation_;
  const auto constraints = self.body.fine.hanging_nodes();
  std::vector<Vector3> places;
  self.for_each_node([&](const std::array<global_dof_index, 3>& unknowns, const Vector3& x) {
    if (!constraints.is_constrained(unknowns[0])) places.push_back(x);
  });
  return places;
}

}  // namespace fingertip::fem_reference
