#include "fem_reference/verification/elastic_problem.h"

#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/fe/fe_values_extractors.h>
#include <deal.II/numerics/vector_tools_boundary.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "fem_reference/elements/kinematics.h"
#include "fem_reference/solvers/field_solver.h"

namespace fingertip::fem_reference::inline verification {
namespace {

using dealii::types::boundary_id;
using dealii::types::global_dof_index;
using meshes::Vector3;

template <int dim>
class AsFunction : public dealii::Function<dim> {
 public:
  explicit AsFunction(const Loading::Field& field) : dealii::Function<dim>(dim), field_(field) {}
  double value(const dealii::Point<dim>& p, unsigned component) const override {
    return field_ ? field_(in_space<dim>(p))[Kinematics<dim>::axis[component]] : 0.0;
  }

 private:
  const Loading::Field& field_;
};

/// Hanging nodes alone, and with supports: the constraints of one loading.
template <int dim>
void constrain(Body<dim>& body, const Loading& loading) {
  Space<dim>& space = body.fine;
  space.constraints.clear();
  space.constraints.reinit(space.relevant);
  dealii::DoFTools::make_hanging_node_constraints(space.dofs, space.constraints);
  const AsFunction<dim> displacement(loading.displacement);
  for (const Prescribed& entry : loading.prescribed)
    for (unsigned c = 0; c < dim; ++c) {
      if (int(Kinematics<dim>::axis[c]) != entry.component) continue;
      dealii::ComponentMask mask(dim, false);
      mask.set(c, true);
      dealii::VectorTools::interpolate_boundary_values(body.mapping, space.dofs,
                                                       boundary_id(entry.boundary), displacement,
                                                       space.constraints, mask);
    }
  space.constraints.close();
}

template <int dim, class Values>
void add_load(const Values& values, unsigned q, const Vector3& density,
              dealii::Vector<double>& local) {
  const auto& element = values.get_fe();
  for (unsigned i = 0; i < local.size(); ++i)
    local[i] += values.shape_value(i, q) * weight<dim>(values, q) *
                density[Kinematics<dim>::axis[element.system_to_component_index(i).first]];
}

/// Consistent nodal forces of body force and traction, passed on by `constraints` [N].
template <int dim>
Vector external_load(const Body<dim>& body, const Loading& loading,
                     const dealii::AffineConstraints<double>& constraints) {
  const Space<dim>& space = body.fine;
  const unsigned points = unsigned(body.degree()) + 2;
  const auto flags =
      dealii::update_values | dealii::update_quadrature_points | dealii::update_JxW_values;
  dealii::FEValues<dim> inside(body.mapping, space.element, dealii::QGauss<dim>(points), flags);
  dealii::FEFaceValues<dim> surface(body.mapping, space.element, dealii::QGauss<dim - 1>(points),
                                    flags | dealii::update_normal_vectors);
  Vector load = space.vector();
  dealii::Vector<double> local(space.element.n_dofs_per_cell());
  std::vector<global_dof_index> indices(local.size());
  for (const auto& cell : space.dofs.active_cell_iterators()) {
    local = 0.0;
    if (loading.body_force) {
      inside.reinit(cell);
      for (const unsigned q : inside.quadrature_point_indices())
        add_load<dim>(inside, q, loading.body_force(in_space<dim>(inside.quadrature_point(q))),
                      local);
    }
    for (const auto& face : cell->face_iterators()) {
      if (!loading.traction || !face->at_boundary()) continue;
      surface.reinit(cell, face);
      for (const unsigned q : surface.quadrature_point_indices())
        add_load<dim>(
            surface, q,
            loading.traction(int(face->boundary_id()), in_space<dim>(surface.quadrature_point(q)),
                             in_space<dim>(surface.normal_vector(q))),
            local);
    }
    cell->get_dof_indices(indices);
    constraints.distribute_local_to_global(local, indices, load);
  }
  load.compress(dealii::VectorOperation::add);
  return load;
}

template <int dim>
class MeshedProblem final : public ElasticProblem {
 public:
  MeshedProblem(const BodyMesh& description, const ElementType& element,
                const meshes::Rubber& material)
      : ElasticProblem(material),
        body_(MPI_COMM_SELF, element.degree),
        volumetric_(element.volumetric),
        kernel_(material, element.volumetric) {
    make_mesh(description, body_);
    body_.number({});
    displacement_.reinit(body_.fine.vector());
    load_.reinit(displacement_);
  }

  std::size_t unknowns() const override { return body_.unknowns(); }
  double volume() const override { return fem_reference::volume(body_); }

  void solve(const Loading& loading) override {
    constrain(body_, loading);
    LinearSystem system(body_, false);
    assemble(body_, kernel_, body_.fine.vector(), system);
    Vector load = external_load(body_, loading, body_.fine.constraints);
    // At zero displacement only the prescribed unknowns move: their forces on the free ones.
    load -= condensed_force(body_, kernel_, body_.fine.vector(), body_.fine.constraints);
    // The solver is made for contact: one free unknown plays a contact that never closes.
    std::vector<long> contact;
    for (global_dof_index i = 0; contact.empty() && i < body_.unknowns(); ++i)
      if (!body_.fine.constraints.is_constrained(i)) contact.push_back(long(i));
    if (!contact.empty()) {
      const auto solver = make_condensed_solver(body_, contact);
      solver->set_matrix(system);
      solver->set_load(load);
      solver->solve_constrained({0}, Eigen::VectorXd::Zero(1), Eigen::VectorXd::Zero(1));
      displacement_ = solver->field();
    }
    body_.fine.constraints.distribute(displacement_);
    load_ = external_load(body_, loading, body_.fine.hanging_nodes());
  }

  Vector3 mean_displacement(int boundary) const override {
    const Space<dim>& space = body_.fine;
    dealii::FEFaceValues<dim> values(
        body_.mapping, space.element, dealii::QGauss<dim - 1>(unsigned(body_.degree()) + 2),
        dealii::update_values | dealii::update_quadrature_points | dealii::update_JxW_values);
    const dealii::FEValuesExtractors::Vector all(0);
    std::vector<dealii::Tensor<1, dim>> u(values.n_quadrature_points);
    Vector3 sum = Vector3::Zero();
    double area = 0.0;
    for (const auto& cell : space.dofs.active_cell_iterators())
      for (const auto& face : cell->face_iterators()) {
        if (!face->at_boundary() || face->boundary_id() != boundary_id(boundary)) continue;
        values.reinit(cell, face);
        values[all].get_function_values(displacement_, u);
        for (const unsigned q : values.quadrature_point_indices()) {
          sum += weight<dim>(values, q) * in_space<dim>(u[q]);
          area += weight<dim>(values, q);
        }
      }
    return sum / area;
  }

  Vector3 reaction(int boundary) const override {
    Vector force = unconstrained_force(body_, kernel_, displacement_);
    force -= load_;
    return resultant(body_, force, boundary_id(boundary));
  }

  double energy() const override {
    double sum = 0.0;
    for_each_element(body_, kernel_, displacement_,
                     [&](const CellIterator<dim>&, const dealii::FullMatrix<double>&,
                         const dealii::Vector<double>&,
                         const ElementSystem& element) { sum += element.energy; });
    return sum;
  }

  Eigen::MatrixXd stiffness() const override {
    const Space<dim>& space = body_.fine;
    const auto constraints = space.hanging_nodes();
    const auto count = unsigned(space.dofs.n_dofs());
    dealii::FullMatrix<double> matrix(count, count);
    std::vector<global_dof_index> indices(space.element.n_dofs_per_cell());
    for_each_element(body_, kernel_, space.vector(),
                     [&](const CellIterator<dim>& cell, const dealii::FullMatrix<double>& local,
                         const dealii::Vector<double>&, const ElementSystem&) {
                       cell->get_dof_indices(indices);
                       constraints.distribute_local_to_global(local, indices, matrix);
                     });
    std::vector<global_dof_index> order;
    visit([&](const Unknowns& unknowns, const Vector3&) {
      if (!constraints.is_constrained(unknowns[0]))
        order.insert(order.end(), unknowns.begin(), unknowns.end());
    });
    Eigen::MatrixXd result(order.size(), order.size());
    for (std::size_t i = 0; i < order.size(); ++i)
      for (std::size_t j = 0; j < order.size(); ++j)
        result(Eigen::Index(i), Eigen::Index(j)) = matrix(unsigned(order[i]), unsigned(order[j]));
    return result;
  }

 private:
  using Unknowns = std::array<global_dof_index, dim>;

  void for_each_point(const std::function<void(const PointState&)>& take) const override {
    const Space<dim>& space = body_.fine;
    dealii::FEValues<dim> values(body_.mapping, space.element,
                                 dealii::QGauss<dim>(unsigned(body_.degree()) + 2),
                                 dealii::update_values | dealii::update_gradients |
                                     dealii::update_quadrature_points | dealii::update_JxW_values);
    const dealii::FEValuesExtractors::Vector all(0);
    const std::size_t points = values.n_quadrature_points;
    std::vector<dealii::Tensor<1, dim>> u(points);
    std::vector<dealii::Tensor<2, dim>> gradients(points);
    std::vector<PointState> states(points);
    Eigen::VectorXd dilatation(points), weights(points);
    for (const auto& cell : space.dofs.active_cell_iterators()) {
      values.reinit(cell);
      values[all].get_function_values(displacement_, u);
      values[all].get_function_gradients(displacement_, gradients);
      for (std::size_t q = 0; q < points; ++q) {
        const auto& place = values.quadrature_point(unsigned(q));
        states[q] = {in_space<dim>(place), in_space<dim>(u[q]),
                     gradient_in_space(gradients[q], u[q], place)};
        dilatation[Eigen::Index(q)] = states[q].gradient.trace();
        weights[Eigen::Index(q)] = weight<dim>(values, unsigned(q));
      }
      if (volumetric_ == Volumetric::mean_dilatation) {
        const Eigen::MatrixXd basis =
            ElementPolynomials<dim>(values, body_.degree() - 1).at(values.get_quadrature_points());
        dilatation = basis * (basis.transpose() * weights.cwiseProduct(dilatation));
      }
      for (std::size_t q = 0; q < points; ++q) {
        states[q].dilatation = dilatation[Eigen::Index(q)];
        states[q].volume = weights[Eigen::Index(q)];
        take(states[q]);
      }
    }
  }

  void for_each_node(const TakeNode& take) const override {
    const auto constraints = body_.fine.hanging_nodes();
    visit([&](const Unknowns& unknowns, const Vector3& place) {
      dealii::Tensor<1, dim> found;
      for (unsigned c = 0; c < dim; ++c) found[c] = displacement_[unknowns[c]];
      take(place, in_space<dim>(found), constraints.is_constrained(unknowns[0]));
    });
  }

  /// Calls `take(unknowns, place)` once per node.
  template <class Take>
  void visit(Take take) const {
    const Space<dim>& space = body_.fine;
    std::vector<char> seen(space.dofs.n_dofs(), 0);
    std::vector<global_dof_index> indices(space.element.n_dofs_per_cell());
    for (const auto& cell : space.dofs.active_cell_iterators()) {
      cell->get_dof_indices(indices);
      for (unsigned node = 0; node < indices.size() / dim; ++node) {
        Unknowns unknowns{};
        for (unsigned c = 0; c < dim; ++c)
          unknowns[c] = indices[space.element.component_to_system_index(c, node)];
        if (seen[unknowns[0]]++) continue;
        take(unknowns, in_space<dim>(body_.mapping.transform_unit_to_real_cell(
                           cell, space.element.unit_support_point(
                                     space.element.component_to_system_index(0, node)))));
      }
    }
  }

  Body<dim> body_;
  Volumetric volumetric_;
  mutable HookeKernel<dim> kernel_;
  Vector displacement_;
  Vector load_;  ///< of the last solution, as if nothing were supported [N]
};

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

std::unique_ptr<ElasticProblem> ElasticProblem::on(const BodyMesh& body, const ElementType& element,
                                                   const meshes::Rubber& rubber) {
  if (revolved(body.shape)) return std::make_unique<MeshedProblem<2>>(body, element, rubber);
  return std::make_unique<MeshedProblem<3>>(body, element, rubber);
}

FieldError ElasticProblem::error(const analytic::ElasticField& exact) const {
  FieldError error, size;
  for_each_point([&](const PointState& state) {
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
  double error = 0.0, size = 0.0;
  for_each_point([&](const PointState& state) {
    const analytic::Matrix3 wanted = exact.stress(state.place);
    const analytic::Matrix3 found =
        rubber_.lame_lambda() * state.dilatation * analytic::Matrix3::Identity() +
        rubber_.shear_modulus * (state.gradient + state.gradient.transpose());
    error += state.volume * (wanted - found).squaredNorm();
    size += state.volume * wanted.squaredNorm();
  });
  return std::sqrt(error / size);
}

double ElasticProblem::nodal_error(const Loading::Field& exact) const {
  double error = 0.0, size = 0.0;
  for_each_node([&](const Vector3& place, const Vector3& found, bool) {
    const Vector3 wanted = exact(place);
    error = std::max(error, (found - wanted).norm());
    size = std::max(size, wanted.norm());
  });
  return error / size;
}

std::vector<Vector3> ElasticProblem::nodes() const {
  std::vector<Vector3> places;
  for_each_node([&](const Vector3& place, const Vector3&, bool hangs) {
    if (!hangs) places.push_back(place);
  });
  return places;
}

}  // namespace fingertip::fem_reference::inline verification
