#include "meshes/volume_mesh/mesh_builders.h"

#include <gmsh.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <vector>

#include "meshes/shape/meridian.h"

namespace fingertip::meshes::inline volume_mesh {

void name_group(int dimension, const std::vector<int>& tags, PhysicalTag tag, const char* name) {
  if (tags.empty()) return;
  gmsh::model::addPhysicalGroup(dimension, tags, int(tag));
  gmsh::model::setPhysicalName(dimension, int(tag), name);
}

void build_dome_meridian(const Geometry& geometry, const TipMeshOptions& options) {
  namespace geo = gmsh::model::geo;
  const double r = geometry.rod_radius, R = geometry.tip_radius, end = -geometry.sleeve_length;
  const int centre = geo::addPoint(0, 0, 0);
  std::vector<std::array<int, 2>> points{{geo::addPoint(0, r, 0), geo::addPoint(0, R, 0)},
                                         {geo::addPoint(r, 0, 0), geo::addPoint(R, 0, 0)}};
  if (end < 0.0) points.push_back({geo::addPoint(r, end, 0), geo::addPoint(R, end, 0)});
  std::vector<int> across, faces;
  std::array<std::vector<int>, 2> along;
  for (const auto& [inside, outside] : points) {
    across.push_back(geo::addLine(inside, outside));
    geo::mesh::setTransfiniteCurve(across.back(), options.radial_elements + 1, "Bump",
                                   1.0 / options.radial_grading);
  }
  const int dome = options.cap_elements + options.ring_elements;
  for (std::size_t layer = 0; layer < 2; ++layer) {
    along[layer].push_back(geo::addCircleArc(points[0][layer], centre, points[1][layer]));
    geo::mesh::setTransfiniteCurve(along[layer].back(), dome + 1, "Progression",
                                   std::pow(options.cap_grading, 1.0 / (dome - 1)));
    if (points.size() == 2) continue;
    along[layer].push_back(geo::addLine(points[1][layer], points[2][layer]));
    geo::mesh::setTransfiniteCurve(along[layer].back(), options.sleeve_elements + 1);
  }
  for (std::size_t block = 0; block + 1 < points.size(); ++block) {
    // Counter-clockwise in (r, z), so that Jacobians are positive.
    const int loop =
        geo::addCurveLoop({-across[block], along[0][block], across[block + 1], -along[1][block]});
    faces.push_back(geo::addPlaneSurface({loop}));
    geo::mesh::setTransfiniteSurface(faces.back());
    geo::mesh::setRecombine(2, faces.back());
  }
  geo::synchronize();
  name_group(2, faces, PhysicalTag::tip, "tip");
  name_group(1, along[1], PhysicalTag::outer, "outer");
  name_group(1, along[0], PhysicalTag::bond, "bond");
  name_group(1, {across.back()}, PhysicalTag::end, "end");
  name_group(1, {across.front()}, PhysicalTag::symmetry_x, "symmetry_x");
}

void build_meridian(const Geometry& geometry, const TipMeshOptions& options) {
  namespace geo = gmsh::model::geo;
  const Meridian meridian(geometry.corners());
  // A quadrilateral that gmsh makes is divided into four: so it makes those of twice the size.
  const double usual = 2.0 * std::min(geometry.thickness() / options.radial_elements,
                                      meridian.wall() / std::max(2, options.radial_elements / 3));
  const double smallest = usual / options.cap_grading;
  const auto add_point = [](const Vector2& x, double size) {
    return geo::addPoint(x.x(), x.y(), 0.0, size);
  };
  const std::vector<MeridianPiece>& pieces = meridian.pieces();
  std::vector<int> corners, loop;
  for (const MeridianPiece& piece : pieces) {
    const bool at_pole = piece.from().x() == 0.0 && piece.from().y() == meridian.pole();
    corners.push_back(add_point(piece.from(), at_pole ? smallest : usual));
  }
  std::map<ProfileSurface, std::vector<int>> curves;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const MeridianPiece& piece = pieces[i];
    const int from = corners[i], to = corners[(i + 1) % corners.size()];
    switch (piece.curve()) {
      case ProfileCurve::straight: loop.push_back(geo::addLine(from, to)); break;
      case ProfileCurve::arc:
        loop.push_back(geo::addCircleArc(from, add_point(piece.centre(), usual), to));
        break;
      case ProfileCurve::spline:
        loop.push_back(geo::addBezier(
            {from, add_point(piece.control1(), usual), add_point(piece.control2(), usual), to}));
        break;
    }
    curves[piece.surface()].push_back(loop.back());
  }
  const int face = geo::addPlaneSurface({geo::addCurveLoop(loop)});
  geo::mesh::setRecombine(2, face);
  geo::synchronize();
  gmsh::option::setNumber("Mesh.Algorithm", 6);  // those for quadrilaterals crash in gmsh 4.8
  gmsh::option::setNumber("Mesh.SubdivisionAlgorithm", 1);
  name_group(2, {face}, PhysicalTag::tip, "tip");
  name_group(1, curves[ProfileSurface::contact], PhysicalTag::outer, "outer");
  name_group(1, curves[ProfileSurface::bond], PhysicalTag::bond, "bond");
  name_group(1, curves[ProfileSurface::free], PhysicalTag::end, "end");
  name_group(1, curves[ProfileSurface::axis], PhysicalTag::symmetry_x, "symmetry_x");
}

}  // namespace fingertip::meshes::inline volume_mesh
