#include "fem_reference/press_fields.h"

#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_dgq.h>
#include <deal.II/fe/fe_values.h>

#include <Eigen/LU>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "fem_reference/element.h"

namespace fingertip::fem_reference {
namespace {

using dealii::types::global_dof_index;

/// Nine components of the stress, row by row, and the equivalent stress.
constexpr unsigned fields = 10;

Eigen::Matrix3d to_eigen(const dealii::Tensor<2, dim>& tensor) {
  Eigen::Matrix3d result;
  for (unsigned i = 0; i < dim; ++i)
    for (unsigned j = 0; j < dim; ++j) result(i, j) = tensor[i][j];
  return result;
}

double von_mises(const Eigen::Matrix3d& stress) {
  const double mean = stress.trace() / 3;
  return std::sqrt(1.5) * (stress - mean * Eigen::Matrix3d::Identity()).norm();
}

/// The job's law: what is projected, and stress from it and the displacement gradient.
class Law {
 public:
  explicit Law(const ReferenceJob& job)
      : lambda_(job.rubber.lame_lambda()), shear_(job.rubber.shear_modulus) {
    if (job.strain == Strain::finite) finite_.emplace(job.law, job.rubber);
  }

  /// div u at small strain, h(J) at large strain.
  double volumetric(const Eigen::Matrix3d& gradient) const {
    if (!finite_) return gradient.trace();
    const double jacobian = (one_ + gradient).determinant();
    return jacobian > 0.0 ? finite_->volumetric(jacobian).value : std::nan("");
  }

  Eigen::Matrix3d stress(const Eigen::Matrix3d& gradient, double volumetric) const {
    if (!finite_) return lambda_ * volumetric * one_ + shear_ * (gradient + gradient.transpose());
    const Eigen::Matrix3d f = one_ + gradient;
    const double jacobian = f.determinant();
    // Nodes are not quadrature points; an element may be inverted there alone.
    if (!(jacobian > 0.0)) return Eigen::Matrix3d::Constant(std::nan(""));
    const double pressure =
        finite_->volumetric_modulus() * volumetric * finite_->volumetric(jacobian).first;
    return finite_->pointwise(f).stress * f.transpose() / jacobian + pressure * one_;
  }

 private:
  double lambda_, shear_;
  std::optional<HyperelasticLaw> finite_;
  Eigen::Matrix3d one_ = Eigen::Matrix3d::Identity();
};

/// Stress at the nodes of one element after another.
class NodalStress {
 public:
  NodalStress(const Body& body, const ReferenceJob& job)
      : law_(job),
        projected_(job.volumetric == Volumetric::projected),
        inside_(body.mapping, body.fine.element, dealii::QGauss<dim>(unsigned(body.degree()) + 1),
                dealii::update_gradients | dealii::update_quadrature_points |
                    dealii::update_JxW_values),
        nodes_(body.mapping, body.fine.element,
               dealii::Quadrature<dim>(
                   dealii::FE_DGQ<dim>(unsigned(body.degree())).get_unit_support_points()),
               dealii::update_gradients | dealii::update_quadrature_points) {}

  std::vector<Eigen::Matrix3d> on(const CellIterator& cell, const Vector& displacement) {
    nodes_.reinit(cell);
    const auto gradients = gradients_of(nodes_, displacement);
    Eigen::VectorXd volumetric(Eigen::Index(gradients.size()));
    if (projected_) {
      volumetric = projection(cell, displacement);
    } else {
      for (std::size_t a = 0; a < gradients.size(); ++a)
        volumetric[Eigen::Index(a)] = law_.volumetric(gradients[a]);
    }
    std::vector<Eigen::Matrix3d> stresses;
    for (std::size_t a = 0; a < gradients.size(); ++a)
      stresses.push_back(law_.stress(gradients[a], volumetric[Eigen::Index(a)]));
    return stresses;
  }

 private:
  static std::vector<Eigen::Matrix3d> gradients_of(const dealii::FEValues<dim>& values,
                                                   const Vector& displacement) {
    std::vector<dealii::Tensor<2, dim>> tensors(values.n_quadrature_points);
    values[dealii::FEValuesExtractors::Vector(0)].get_function_gradients(displacement, tensors);
    std::vector<Eigen::Matrix3d> gradients;
    for (const auto& tensor : tensors) gradients.push_back(to_eigen(tensor));
    return gradients;
  }

  /// At the nodes, of the measure projected as `ElementKernel`s do it.
  Eigen::VectorXd projection(const CellIterator& cell, const Vector& displacement) {
    inside_.reinit(cell);
    const auto gradients = gradients_of(inside_, displacement);
    const ElementPolynomials polynomials(inside_, int(inside_.get_fe().degree) - 1);
    Eigen::VectorXd weighted(Eigen::Index(gradients.size()));
    for (std::size_t q = 0; q < gradients.size(); ++q)
      weighted[Eigen::Index(q)] = inside_.JxW(unsigned(q)) * law_.volumetric(gradients[q]);
    const Eigen::VectorXd coefficients =
        polynomials.at(inside_.get_quadrature_points()).transpose() * weighted;
    return polynomials.at(nodes_.get_quadrature_points()) * coefficients;
  }

  const Law law_;
  const bool projected_;
  dealii::FEValues<dim> inside_, nodes_;
};

}  // namespace

StressField::StressField(const Body& body, const ReferenceJob& job, const Vector& displacement)
    : element_(dealii::FE_DGQ<dim>(unsigned(body.degree())), fields), dofs_(body.triangulation) {
  dofs_.distribute_dofs(element_);
  Vector own(dofs_.locally_owned_dofs(), body.fine.communicator);
  const Vector u = body.fine.ghosted(displacement);
  NodalStress nodal(body, job);
  std::vector<global_dof_index> unknowns(element_.n_dofs_per_cell());
  for (const auto& cell : dofs_.active_cell_iterators()) {
    if (!cell->is_locally_owned()) continue;
    const CellIterator elastic(&body.triangulation, cell->level(), cell->index(), &body.fine.dofs);
    const auto stresses = nodal.on(elastic, u);
    cell->get_dof_indices(unknowns);
    for (unsigned a = 0; a < stresses.size(); ++a) {
      for (unsigned c = 0; c < 9; ++c)
        own[unknowns[element_.component_to_system_index(c, a)]] = stresses[a](c / 3, c % 3);
      own[unknowns[element_.component_to_system_index(9, a)]] = von_mises(stresses[a]);
    }
  }
  own.compress(dealii::VectorOperation::insert);
  dealii::IndexSet relevant;
  dealii::DoFTools::extract_locally_relevant_dofs(dofs_, relevant);
  values_.reinit(dofs_.locally_owned_dofs(), relevant, body.fine.communicator);
  values_ = own;
}

void StressField::add_to(dealii::DataOut<3>& out) const {
  using namespace dealii::DataComponentInterpretation;
  std::vector<std::string> names(9, "stress");
  names.emplace_back("von_mises_stress");
  std::vector<DataComponentInterpretation> kinds(9, component_is_part_of_tensor);
  kinds.push_back(component_is_scalar);
  out.add_data_vector(dofs_, values_, names, kinds);
}

std::vector<Eigen::Matrix3d> StressField::on(const CellIterator& cell) const {
  std::vector<global_dof_index> unknowns(element_.n_dofs_per_cell());
  CellIterator(&dofs_.get_triangulation(), cell->level(), cell->index(), &dofs_)
      ->get_dof_indices(unknowns);
  std::vector<Eigen::Matrix3d> stresses(unknowns.size() / fields);
  for (unsigned a = 0; a < stresses.size(); ++a)
    for (unsigned c = 0; c < 9; ++c)
      stresses[a](c / 3, c % 3) = values_[unknowns[element_.component_to_system_index(c, a)]];
  return stresses;
}

ContactField::ContactField(const Body& body, const PlaneContact& contact, const Vector& area)
    : body_(body), values_(body.fine.owned, body.fine.relevant, body.fine.communicator) {
  Vector own = body.fine.vector();
  const std::vector<SurfaceNode>& nodes = contact.unknowns().nodes;
  std::vector<long> unknowns;
  for (const SurfaceNode& node : nodes) unknowns.push_back(node.unknown[2]);
  const std::vector<double> areas = body.fine.gather(area, unknowns);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const meshes::Vector3 traction = contact.reaction(i) / areas[i];
    const double values[] = {-traction.z(), traction.head<2>().norm(), double(contact.status()[i])};
    for (std::size_t c = 0; c < 3; ++c)
      if (body.fine.owned.is_element(unsigned(nodes[i].unknown[c])))
        own[unsigned(nodes[i].unknown[c])] = values[c];
  }
  own.compress(dealii::VectorOperation::insert);
  body.fine.hanging_nodes().distribute(own);
  values_ = own;
}

void ContactField::add_to(dealii::DataOut<3>& out) const {
  using namespace dealii::DataComponentInterpretation;
  out.add_data_vector(body_.fine.dofs, values_,
                      {"contact_pressure", "contact_shear", "contact_status"},
                      std::vector<DataComponentInterpretation>(dim, component_is_scalar));
}

}  // namespace fingertip::fem_reference
