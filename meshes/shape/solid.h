/// A finger of any shape: a closed surface of triangles, some of which the hand holds.
#pragma once

#include <mutex>
#include <string>
#include <vector>

#include "meshes/shape/shape.h"
#include "meshes/shape/triangle_mesh.h"

namespace fingertip::meshes::inline shape {

/// The side of a plane across one of the axes, the plane itself included.
struct HalfSpace {
  int axis = 2;        ///< 0, 1, 2: x, y, z
  bool below = true;   ///< coordinate <= limit, else >=
  double limit = 0.0;  ///< [m]
};

/// Where any of the lists holds, all half spaces of which hold.
using Region = std::vector<std::vector<HalfSpace>>;

/// Immutable. Lengths in metres. Facets within `bond` are bonded, all others may touch.
class Solid final : public Shape {
 public:
  /// What lies within `bond` is held, and the faces of the mesh that have one of the names. Facets
  /// that straddle a plane of `bond` are cut along it, so that areas are exact. Throws InvalidInput
  /// with the place: closed_surface, check_crossings; all or nothing is held, or higher than what
  /// may touch, or the axis x = y = 0 misses the finger.
  Solid(const TriangleMesh& mesh, const Region& bond, const std::vector<std::string>& faces = {});

  /// One of this mesh and bond as another one has them, whose content() it must have: else throws
  /// InvalidInput.
  Solid(TriangleMesh mesh, const std::vector<bool>& bonded, const std::string& content);

  const TriangleMesh& mesh() const { return mesh_; }
  /// Per triangle those across its edges, from its first and second corner on.
  const std::vector<std::array<std::size_t, 3>>& neighbours() const { return neighbours_; }
  bool is_bond(std::size_t triangle) const { return groups_[triangle] == bond_group; }
  /// Tells solids apart: a digest of vertices, triangles and what is bonded.
  const std::string& content() const { return content_; }
  bool contains(const Vector3& w) const { return tree_->contains(w); }
  /// Whether it is its own mirror image in the plane through the origin across an axis (0: x, 1:
  /// y): corners and middles of facets have their image, held where they are, within
  /// mirrored_within of its largest radius and the height of chords there.
  bool mirrored(int axis) const;
  static constexpr double mirrored_within = 1e-4;
  /// surface_points() of one of its surfaces; areas and their first moments add up exactly. Of a
  /// mirrored solid they are those of the part at x, y >= 0 and their images.
  std::vector<SurfacePoint> points(ProfileSurface surface, double spacing) const;

  double signed_distance(const Vector3& w) const override;
  NearestPoint nearest(ProfileSurface surface, const Vector3& w) const override;
  double reach(double tilt) const override;
  HighestPlace highest(ProfileSurface surface, const HeightOf& height) const override;
  double volume() const override { return volume_; }
  double area(ProfileSurface surface) const override;
  double pole() const override { return pole_; }
  double lowest() const override { return lowest_; }
  double largest_radius() const override { return radius_; }
  double bond_top() const override { return bond_top_; }
  double bond_radius() const override { return bond_radius_; }
  double pole_radius() const override { return pole_radius_; }
  double wall() const override;

 private:
  static constexpr int contact_group = 0, bond_group = 1;

  void complete();
  bool is(ProfileSurface surface, std::size_t triangle) const;
  std::array<Vector3, 3> corners(std::size_t triangle) const;
  void measure();
  double thinnest() const;
  /// From a facet through the rubber to another one.
  struct WallRay {
    double depth;
    std::size_t from, to;
    Vector3 start, end;
  };
  /// Whether its ends are far apart along the surface.
  bool apart(const WallRay& ray) const;

  TriangleMesh mesh_;
  std::vector<int> groups_;
  std::vector<std::array<std::size_t, 3>> neighbours_;
  std::string content_;
  std::unique_ptr<TriangleTree> tree_;
  double volume_ = 0.0, contact_area_ = 0.0, bond_area_ = 0.0, pole_ = 0.0, lowest_ = 0.0,
         radius_ = 0.0, bond_top_ = 0.0, bond_radius_ = 0.0, pole_radius_ = 0.0;
  mutable std::once_flag wall_known_;
  mutable double wall_ = 0.0;
  bool compare_with_image(int axis) const;
  mutable std::array<std::once_flag, 2> image_compared_;
  mutable std::array<bool, 2> mirrored_{};
};

}  // namespace fingertip::meshes::inline shape
