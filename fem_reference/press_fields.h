/// What a press shows in ParaView besides displacements. deal.II's side.
#pragma once

#include <deal.II/numerics/data_out.h>

#include "fem_reference/body.h"
#include "fem_reference/job.h"
#include "fem_reference/plane_contact.h"

namespace fingertip::fem_reference {

/// Cauchy stress and von Mises' equivalent stress [Pa] at the nodes of each element, where elements
/// may disagree. The volumetric part is the one that the elements work with: when the job asks for
/// it projected, its pointwise values would oscillate near nu = 1/2.
class StressField {
 public:
  /// At the displacement given (owned entries). Small strain with Kelvin-Voigt damping: give
  /// u + tau v.
  StressField(const Body& body, const ReferenceJob& job, const Vector& displacement);

  /// As `stress` (a tensor) and `von_mises_stress`; not a number where an element is turned inside
  /// out at a node alone.
  void add_to(dealii::DataOut<3>& out) const;

  /// Stress at the nodes of one locally owned cell, which are those of FE_DGQ.
  std::vector<Eigen::Matrix3d> on(const CellIterator& cell) const;

 private:
  dealii::FESystem<dim> element_;
  dealii::DoFHandler<dim> dofs_;
  Vector values_;
};

/// Pressure [Pa], shear [Pa] and status of the contact nodes.
class ContactField {
 public:
  /// `area` is the lumped area of the surface on which the plane's forces act (`outer_area`).
  ContactField(const Body& body, const PlaneContact& contact, const Vector& area);

  /// As `contact_pressure`, `contact_shear` and `contact_status`.
  void add_to(dealii::DataOut<3>& out) const;

 private:
  const Body& body_;
  Vector values_;
};

}  // namespace fingertip::fem_reference
