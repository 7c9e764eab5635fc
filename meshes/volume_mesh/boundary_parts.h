/// The smooth parts of a finger's boundary, between which it has edges: how a mesh follows the true
/// surface.
#pragma once

#include <memory>
#include <vector>

#include "meshes/volume_mesh/mesh_options.h"
#include "meshes/volume_mesh/tetrahedra.h"

namespace fingertip::meshes::inline volume_mesh {

/// Immutable. Numbers from 0; those of a body of revolution are the pieces of its meridian, of a
/// solid the facets that neighbours continue within 40 degrees; the mirror planes y = 0 and x = 0
/// come last. Lengths in metres.
class BoundaryParts {
 public:
  virtual ~BoundaryParts() = default;

  int count() const { return own_count() + 2; }
  PhysicalTag tag(int part) const;
  /// Whether it is held and narrow neighbours were united with it, at edges that a mesh need
  /// not have.
  virtual bool hides_edges(int part) const = 0;
  /// Its point nearest to `w`.
  Vector3 nearest(int part, const Vector3& w) const;
  /// The closed surface of a sector, on the solid's own facets, or inscribed.
  virtual PartedSurface surface(Sector sector) const = 0;

  /// The part with this tag nearest to `w`.
  int part_at(PhysicalTag tag, const Vector3& w) const;
  /// A point near `w` that lies on all of these parts, which meet there.
  Vector3 on(const std::vector<int>& parts, const Vector3& w) const;

 protected:
  int plane_y() const { return own_count(); }
  int plane_x() const { return own_count() + 1; }

 private:
  /// Without the planes.
  virtual int own_count() const = 0;
  virtual PhysicalTag own_tag(int part) const = 0;
  virtual Vector3 own_nearest(int part, const Vector3& w) const = 0;
};

/// Of a geometry's solid, else of its meridian. Throws InvalidInput for an invalid geometry.
std::unique_ptr<const BoundaryParts> boundary_parts(const Geometry& geometry);

}  // namespace fingertip::meshes::inline volume_mesh
