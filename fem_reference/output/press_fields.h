/// What a press shows in ParaView besides displacements. deal.II's side.
#pragma once

#include <deal.II/numerics/data_out.h>

#include <filesystem>
#include <vector>

#include "fem_reference/contact/plane_contact.h"
#include "fem_reference/elements/body.h"
#include "fem_reference/elements/element.h"
#include "fem_reference/job/job.h"

namespace fingertip::fem_reference::inline output {

/// A component with this name is no field, and not written.
inline constexpr const char* no_field = "none";

/// The fields of a mesh, for ParaView: those of a meridian are written in space, in the plane y = 0
/// or turned around the axis. Call as dealii::DataOut, then `write`.
template <int dim>
class FieldOutput : public dealii::DataOut<dim> {
 public:
  /// VTU under a temporary name, then renamed. With `around` > 0 a meridian becomes a solid of so
  /// many sectors.
  void write(const std::filesystem::path& file, int around = 0);
};

/// Of what a rubber that relaxes remembers (memory.h): at small strain the displacement of which
/// the relaxing moduli make stress, at large strain the stress itself. Both empty for one that does
/// not.
struct RememberedStress {
  Vector displacement;  ///< [m]
  PointStresses stress;
};

/// Cauchy stress and von Mises' equivalent stress [Pa] at the nodes of each element, where elements
/// may disagree. The volumetric part is the one that the elements work with: when the job asks for
/// it projected, its pointwise values would oscillate near nu = 1/2.
template <int dim>
class StressField {
 public:
  /// At the displacement given (owned entries). Small strain with Kelvin-Voigt damping: give
  /// u + tau v.
  StressField(const Body<dim>& body, const ReferenceJob& job, const Vector& displacement,
              const RememberedStress& kept = {});

  /// As `stress` (a tensor) and `von_mises_stress`; not a number where an element is turned inside
  /// out at a node alone.
  void add_to(dealii::DataOut<dim>& out) const;

  /// Stress at the nodes of one locally owned cell, which are those of FE_DGQ.
  std::vector<Eigen::Matrix3d> on(const CellIterator<dim>& cell) const;

 private:
  dealii::FESystem<dim> element_;
  dealii::DoFHandler<dim> dofs_;
  Vector values_;
};

/// Pressure [Pa], shear [Pa] and status of the contact nodes.
template <int dim>
class ContactField {
 public:
  /// `area` is the lumped area of the surface on which the plane's forces act (`outer_area`).
  ContactField(const Body<dim>& body, const PlaneContact& contact, const Vector& area);

  /// As `contact_pressure`, `contact_shear` and `contact_status`.
  void add_to(dealii::DataOut<dim>& out) const;

 private:
  const Body<dim>& body_;
  std::vector<Vector> values_;  ///< `dim` of the fields each, in the places of the components
};

}  // namespace fingertip::fem_reference::inline output
