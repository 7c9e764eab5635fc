#include "fem_reference/output/press_fields.h"

#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_dgq.h>
#include <deal.II/fe/fe_values.h>

#include <Eigen/LU>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "fem_reference/elements/element.h"
#include "fem_reference/elements/kinematics.h"

namespace fingertip::fem_reference::inline output {
namespace {

using dealii::types::global_dof_index;

constexpr std::array contact_fields{"contact_pressure", "contact_shear", "contact_status"};

/// Components of the stress, row by row: all of space, or those of the meridian and the hoop's.
template <int dim>
constexpr auto stress_places = Kinematics<dim>::entries;
/// With the equivalent stress.
template <int dim>
constexpr unsigned field_count = unsigned(stress_places<dim>.size()) + 1;

double von_mises(const Eigen::Matrix3d& stress) {
  const double mean = stress.trace() / 3;
  return std::sqrt(1.5) * (stress - mean * Eigen::Matrix3d::Identity()).norm();
}

/// The job's law: what is projected, and stress from it and the displacement gradient.
class Law {
 public:
  explicit Law(const ReferenceJob& job) : shear_(job.rubber.shear_modulus) {
    lambda_ = job.rubber.lame_lambda();
    relaxing_lambda_ = job.rubber.relaxation.bulk ? lambda_ : -2.0 / 3.0 * shear_;
    if (job.strain == Strain::finite) finite_.emplace(job.rubber);
  }

  /// div u at small strain, h(J) at large strain.
  double volumetric(const Eigen::Matrix3d& gradient) const {
    if (!finite_) return gradient.trace();
    const double jacobian = (one_ + gradient).determinant();
    return jacobian > 0.0 ? finite_->volumetric(jacobian).value : std::nan("");
  }

  Eigen::Matrix3d stress(const Eigen::Matrix3d& gradient, double volumetric) const {
    if (!finite_) return hookean(lambda_, gradient, volumetric);
    const Eigen::Matrix3d f = one_ + gradient;
    const double jacobian = f.determinant();
    // Nodes are not quadrature points; an element may be inverted there alone.
    if (!(jacobian > 0.0)) return Eigen::Matrix3d::Constant(std::nan(""));
    const double pressure =
        finite_->volumetric_modulus() * volumetric * finite_->volumetric(jacobian).first;
    return finite_->pointwise(f).stress * f.transpose() / jacobian + pressure * one_;
  }

  /// At small strain, of the moduli that relax.
  Eigen::Matrix3d relaxing_stress(const Eigen::Matrix3d& gradient, double volumetric) const {
    return hookean(relaxing_lambda_, gradient, volumetric);
  }

 private:
  Eigen::Matrix3d hookean(double lambda, const Eigen::Matrix3d& gradient, double volumetric) const {
    return lambda * volumetric * one_ + shear_ * (gradient + gradient.transpose());
  }

  double lambda_, relaxing_lambda_, shear_;
  std::optional<meshes::HyperelasticLaw> finite_;
  Eigen::Matrix3d one_ = Eigen::Matrix3d::Identity();
};

/// Stress at the nodes of one element after another.
template <int dim>
class NodalStress {
 public:
  NodalStress(const Body<dim>& body, const ReferenceJob& job)
      : law_(job),
        projected_(job.volumetric == Volumetric::mean_dilatation),
        inside_(body.mapping, body.fine.element, dealii::QGauss<dim>(unsigned(body.degree()) + 1),
                dealii::update_values | dealii::update_gradients |
                    dealii::update_quadrature_points | dealii::update_JxW_values),
        nodes_(
            body.mapping, body.fine.element,
            dealii::Quadrature<dim>(
                dealii::FE_DGQ<dim>(unsigned(body.degree())).get_unit_support_points()),
            dealii::update_values | dealii::update_gradients | dealii::update_quadrature_points) {}

  std::vector<Eigen::Matrix3d> on(const CellIterator<dim>& cell, const Vector& displacement) {
    const auto [gradients, volumetric] = strain_on(cell, displacement);
    std::vector<Eigen::Matrix3d> stresses;
    for (std::size_t a = 0; a < gradients.size(); ++a)
      stresses.push_back(law_.stress(gradients[a], volumetric[Eigen::Index(a)]));
    return stresses;
  }

  /// Adds the stress that the relaxing moduli make of a displacement.
  void add_relaxing(const CellIterator<dim>& cell, const Vector& displacement,
                    std::vector<Eigen::Matrix3d>& stresses) {
    const auto [gradients, volumetric] = strain_on(cell, displacement);
    for (std::size_t a = 0; a < gradients.size(); ++a)
      stresses[a] += law_.relaxing_stress(gradients[a], volumetric[Eigen::Index(a)]);
  }

  /// Adds second Piola-Kirchhoff stresses, carried from the quadrature points to the nodes by
  /// polynomials.
  void add_remembered(const CellIterator<dim>& cell, const Vector& displacement,
                      const PointStresses& kept, std::vector<Eigen::Matrix3d>& stresses) {
    inside_.reinit(cell);
    nodes_.reinit(cell);
    const ElementPolynomials<dim> polynomials(inside_, int(inside_.get_fe().degree));
    Eigen::VectorXd weights(kept.points);
    for (Eigen::Index q = 0; q < weights.size(); ++q) weights[q] = weight(inside_, unsigned(q));
    const Eigen::MatrixXd at_nodes = kept.of_cell(cell->active_cell_index()) *
                                     weights.asDiagonal() *
                                     polynomials.at(inside_.get_quadrature_points()) *
                                     polynomials.at(nodes_.get_quadrature_points()).transpose();
    const auto gradients = gradients_of(nodes_, displacement);
    for (std::size_t a = 0; a < gradients.size(); ++a) {
      const Eigen::Matrix3d f = Eigen::Matrix3d::Identity() + gradients[a];
      stresses[a] += f * tensor_of(at_nodes.col(Eigen::Index(a))) * f.transpose() / f.determinant();
    }
  }

 private:
  /// At the nodes: displacement gradients and the volumetric measure that elements work with.
  std::pair<std::vector<Eigen::Matrix3d>, Eigen::VectorXd> strain_on(const CellIterator<dim>& cell,
                                                                     const Vector& displacement) {
    nodes_.reinit(cell);
    auto gradients = gradients_of(nodes_, displacement);
    Eigen::VectorXd volumetric(Eigen::Index(gradients.size()));
    if (projected_) {
      volumetric = projection(cell, displacement);
    } else {
      for (std::size_t a = 0; a < gradients.size(); ++a)
        volumetric[Eigen::Index(a)] = law_.volumetric(gradients[a]);
    }
    return {std::move(gradients), std::move(volumetric)};
  }

  static std::vector<Eigen::Matrix3d> gradients_of(const dealii::FEValues<dim>& values,
                                                   const Vector& displacement) {
    const dealii::FEValuesExtractors::Vector whole(0);
    std::vector<dealii::Tensor<2, dim>> tensors(values.n_quadrature_points);
    std::vector<dealii::Tensor<1, dim>> displacements(values.n_quadrature_points);
    values[whole].get_function_gradients(displacement, tensors);
    values[whole].get_function_values(displacement, displacements);
    std::vector<Eigen::Matrix3d> gradients;
    for (const unsigned q : values.quadrature_point_indices())
      gradients.push_back(
          gradient_in_space(tensors[q], displacements[q], values.quadrature_point(q)));
    if (Kinematics<dim>::revolved && values.get_fe().n_components() > dim)
      add_twist(values, displacement, gradients);
    return gradients;
  }

  /// What u_phi adds: u_phi,r and u_phi,z, and -u_phi/r where e_r turns into e_phi; on the axis,
  /// where u_phi vanishes, that is -u_phi,r.
  static void add_twist(const dealii::FEValues<dim>& values, const Vector& displacement,
                        std::vector<Eigen::Matrix3d>& gradients) {
    const dealii::FEValuesExtractors::Scalar around(2);
    std::vector<dealii::Tensor<1, dim>> slopes(values.n_quadrature_points);
    std::vector<double> moved(values.n_quadrature_points);
    values[around].get_function_gradients(displacement, slopes);
    values[around].get_function_values(displacement, moved);
    for (const unsigned q : values.quadrature_point_indices()) {
      const double r = values.quadrature_point(q)[0];
      gradients[q](1, 0) = slopes[q][0];
      gradients[q](1, 2) = slopes[q][1];
      gradients[q](0, 1) = r > 0.0 ? -moved[q] / r : -slopes[q][0];
    }
  }

  /// At the nodes, of the measure projected as `ElementKernel`s do it.
  Eigen::VectorXd projection(const CellIterator<dim>& cell, const Vector& displacement) {
    inside_.reinit(cell);
    const auto gradients = gradients_of(inside_, displacement);
    const ElementPolynomials<dim> polynomials(inside_, int(inside_.get_fe().degree) - 1);
    Eigen::VectorXd weighted(Eigen::Index(gradients.size()));
    for (std::size_t q = 0; q < gradients.size(); ++q)
      weighted[Eigen::Index(q)] = weight(inside_, unsigned(q)) * law_.volumetric(gradients[q]);
    const Eigen::VectorXd coefficients =
        polynomials.at(inside_.get_quadrature_points()).transpose() * weighted;
    return polynomials.at(nodes_.get_quadrature_points()) * coefficients;
  }

  const Law law_;
  const bool projected_;
  dealii::FEValues<dim> inside_, nodes_;
};

}  // namespace

template <int dim>
StressField<dim>::StressField(const Body<dim>& body, const ReferenceJob& job,
                              const Vector& displacement, const RememberedStress& kept)
    : element_(dealii::FE_DGQ<dim>(unsigned(body.degree())), field_count<dim>),
      dofs_(body.triangulation) {
  dofs_.distribute_dofs(element_);
  Vector own(dofs_.locally_owned_dofs(), body.fine.communicator);
  const Vector u = body.fine.ghosted(displacement);
  const Vector past =
      kept.displacement.size() > 0 ? body.fine.ghosted(kept.displacement) : Vector();
  NodalStress<dim> nodal(body, job);
  std::vector<global_dof_index> unknowns(element_.n_dofs_per_cell());
  for (const auto& cell : dofs_.active_cell_iterators()) {
    if (!cell->is_locally_owned()) continue;
    const CellIterator<dim> elastic(&body.triangulation, cell->level(), cell->index(),
                                    &body.fine.dofs);
    auto stresses = nodal.on(elastic, u);
    if (past.size() > 0) nodal.add_relaxing(elastic, past, stresses);
    if (kept.stress.points > 0) nodal.add_remembered(elastic, u, kept.stress, stresses);
    cell->get_dof_indices(unknowns);
    for (unsigned a = 0; a < stresses.size(); ++a) {
      for (unsigned c = 0; c + 1 < field_count<dim>; ++c) {
        const Eigen::Index place = stress_places<dim>[c];
        own[unknowns[element_.component_to_system_index(c, a)]] = stresses[a](place / 3, place % 3);
      }
      own[unknowns[element_.component_to_system_index(field_count<dim> - 1, a)]] =
          von_mises(stresses[a]);
    }
  }
  own.compress(dealii::VectorOperation::insert);
  dealii::IndexSet relevant;
  dealii::DoFTools::extract_locally_relevant_dofs(dofs_, relevant);
  values_.reinit(dofs_.locally_owned_dofs(), relevant, body.fine.communicator);
  values_ = own;
}

template <int dim>
void StressField<dim>::add_to(dealii::DataOut<dim>& out) const {
  using namespace dealii::DataComponentInterpretation;
  std::vector<std::string> names(field_count<dim>, "stress");
  std::vector<DataComponentInterpretation> kinds(field_count<dim>, component_is_part_of_tensor);
  if (Kinematics<dim>::revolved) {
    names[4] = "hoop_stress";
    kinds[4] = component_is_scalar;
  }
  names.back() = "von_mises_stress";
  kinds.back() = component_is_scalar;
  out.add_data_vector(dofs_, values_, names, kinds);
}

template <int dim>
std::vector<Eigen::Matrix3d> StressField<dim>::on(const CellIterator<dim>& cell) const {
  std::vector<global_dof_index> unknowns(element_.n_dofs_per_cell());
  CellIterator<dim>(&dofs_.get_triangulation(), cell->level(), cell->index(), &dofs_)
      ->get_dof_indices(unknowns);
  std::vector<Eigen::Matrix3d> stresses(unknowns.size() / field_count<dim>,
                                        Eigen::Matrix3d::Zero());
  for (unsigned a = 0; a < stresses.size(); ++a)
    for (unsigned c = 0; c + 1 < field_count<dim>; ++c) {
      const Eigen::Index place = stress_places<dim>[c];
      stresses[a](place / 3, place % 3) =
          values_[unknowns[element_.component_to_system_index(c, a)]];
    }
  return stresses;
}

template <int dim>
ContactField<dim>::ContactField(const Body<dim>& body, const PlaneContact& contact,
                                const Vector& area)
    : body_(body),
      values_((contact_fields.size() + body.components() - 1) / body.components(),
              Vector(body.fine.owned, body.fine.relevant, body.fine.communicator)) {
  const auto components = std::size_t(body.components());
  std::vector<Vector> own(values_.size(), body.fine.vector());
  const std::vector<SurfaceNode>& nodes = contact.unknowns().nodes;
  std::vector<long> unknowns;
  for (const SurfaceNode& node : nodes) unknowns.push_back(node.unknown[2]);
  const std::vector<double> areas = body.fine.gather(area, unknowns);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const std::size_t shown = contact.leader(i);
    const double values[] = {contact.push(shown) / areas[shown],
                             contact.shear(shown) / areas[shown], double(contact.status()[i])};
    for (std::size_t f = 0; f < contact_fields.size(); ++f) {
      const auto unknown = unsigned(nodes[i].unknown[Kinematics<dim>::axis[f % components]]);
      if (body.fine.owned.is_element(unknown)) own[f / components][unknown] = values[f];
    }
  }
  for (std::size_t v = 0; v < own.size(); ++v) {
    own[v].compress(dealii::VectorOperation::insert);
    body.fine.hanging_nodes().distribute(own[v]);
    values_[v] = own[v];
  }
}

template <int dim>
void ContactField<dim>::add_to(dealii::DataOut<dim>& out) const {
  using namespace dealii::DataComponentInterpretation;
  const auto components = std::size_t(body_.components());
  for (std::size_t v = 0; v < values_.size(); ++v) {
    std::vector<std::string> names;
    for (std::size_t f = v * components; f < (v + 1) * components; ++f)
      names.emplace_back(f < contact_fields.size() ? contact_fields[f] : no_field);
    out.add_data_vector(body_.fine.dofs, values_[v], names,
                        std::vector<DataComponentInterpretation>(components, component_is_scalar));
  }
}

template class StressField<2>;
template class StressField<3>;
template class ContactField<2>;
template class ContactField<3>;

}  // namespace fingertip::fem_reference::inline output
