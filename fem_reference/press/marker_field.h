/// The displacements of a press's markers (meshes/press/markers.h) on a mesh. deal.II's side.
#pragma once

#include <vector>

#include "fem_reference/elements/body.h"
#include "fem_reference/job/job.h"
#include "meshes/press/markers.h"

namespace fingertip::fem_reference::inline press {

/// A marker is looked for in the part of the tip that the mesh is of: on the meridian by its
/// distance from the axis, in a quarter or half as its mirror image. Its displacement is that of
/// the element's shape functions there, turned and mirrored back. Elements stand for a curved
/// surface but for 1e-5 of its radius or so: what lies outside all of them is taken at the nearest
/// point of the nearest one.
template <int dim>
class MarkerField {
 public:
  /// Of the present mesh of a tip (tip_body.h). Collective, as all that follows. Throws
  /// NotConverged for a marker that no element can place.
  MarkerField(const Body<dim>& body, const ReferenceJob& job);

  /// One per marker, in the finger's axes; sample, indentation and error are left to others.
  std::vector<meshes::MarkerRow> rows(const Vector& displacement) const;

 private:
  /// An unknown's share in a displacement, along an axis of the finger.
  struct Share {
    dealii::types::global_dof_index unknown;
    meshes::Vector3 weight;
  };
  const Body<dim>* body_;
  std::vector<meshes::Vector3> places_;     ///< [m]
  std::vector<std::vector<Share>> shares_;  ///< per marker; empty where another process has it
};

}  // namespace fingertip::fem_reference::inline press
