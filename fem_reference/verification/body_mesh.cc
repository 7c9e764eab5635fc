#include "fem_reference/verification/body_mesh.h"

#include <deal.II/grid/grid_generator.h>
#include <deal.II/grid/grid_tools.h>
#include <deal.II/grid/manifold_lib.h>

#include <bit>
#include <cmath>
#include <functional>
#include <memory>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "fem_reference/elements/body.h"

namespace fingertip::fem_reference::inline verification {
namespace {

using dealii::Point;

constexpr dealii::types::manifold_id curved = 1;

/// Three shears, one after the other: smooth, invertible in closed form, and no plane stays one.
class Bend : public dealii::ChartManifold<3, 3, 3> {
 public:
  explicit Bend(const meshes::Vector3& size) : size_(size) {}
  std::unique_ptr<dealii::Manifold<3>> clone() const override {
    return std::make_unique<Bend>(size_);
  }
  Point<3> push_forward(const Point<3>& chart) const override {
    Point<3> p = chart;
    for (unsigned i = 0; i < 3; ++i) p[i] += shear(i, p);
    return p;
  }
  Point<3> pull_back(const Point<3>& point) const override {
    Point<3> p = point;
    for (unsigned i = 3; i-- > 0;) p[i] -= shear(i, p);
    return p;
  }

 private:
  /// Motion along axis i; depends on the other two coordinates only.
  double shear(unsigned i, const Point<3>& p) const {
    const unsigned j = (i + 1) % 3, k = (i + 2) % 3;
    return 0.12 * size_[i] * std::sin(2.0 * p[j] / size_[j] + 1.5 * p[k] / size_[k] + 0.7 * i);
  }
  meshes::Vector3 size_;
};

template <int dim, class Belongs>
void name_boundary(Triangulation<dim>& mesh, int id, Belongs belongs) {
  for (const auto& cell : mesh.active_cell_iterators())
    for (const auto& face : cell->face_iterators()) {
      bool all = face->at_boundary();
      for (unsigned v = 0; all && v < face->n_vertices(); ++v) all = belongs(face->vertex(v));
      if (all) face->set_boundary_id(dealii::types::boundary_id(id));
    }
}

/// Names the plane faces through the coordinate planes and w_z = `top`.
void name_planes(Triangulation<3>& mesh, double top) {
  constexpr double tiny = 1e-9;
  for (unsigned i = 0; i < 3; ++i)
    name_boundary(mesh, 2 * int(i), [&](const Point<3>& p) { return std::abs(p[i]) < tiny; });
  name_boundary(mesh, boundary::high_z,
                [&](const Point<3>& p) { return std::abs(p[2] - top) < tiny; });
}

void make_block(const BodyMesh& body, const Point<3>& low, const Point<3>& high,
                Triangulation<3>& mesh) {
  std::vector<unsigned> counts;
  for (const int n : body.divisions) {
    if (n < 1) throw std::invalid_argument("a block needs at least one division each way");
    counts.push_back(unsigned(n));
  }
  dealii::GridGenerator::subdivided_hyper_rectangle(mesh, counts, low, high, true);
  if (body.distortion > 0.0) dealii::GridTools::distort_random(body.distortion, mesh, true);
}

void make_cylinder(const BodyMesh& body, Triangulation<3>& mesh) {
  // The box is radius, angle and height; its faces become those of the cylinder.
  make_block(body, Point<3>(body.size[0], 0.0, 0.0),
             Point<3>(body.size[1], std::numbers::pi / 2, body.size[2]), mesh);
  constexpr std::array<int, 6> names{boundary::inner, boundary::outer, boundary::low_y,
                                     boundary::low_x, boundary::low_z, boundary::high_z};
  for (const auto& cell : mesh.active_cell_iterators())
    for (const auto& face : cell->face_iterators())
      if (face->at_boundary())
        face->set_boundary_id(dealii::types::boundary_id(names[face->boundary_id()]));
  dealii::GridTools::transform(
      [](const Point<3>& p) {
        return Point<3>(p[0] * std::cos(p[1]), p[0] * std::sin(p[1]), p[2]);
      },
      mesh);
  mesh.set_all_manifold_ids(curved);
  mesh.set_manifold(curved, dealii::CylindricalManifold<3>(2));
}

/// The bend of a section: radii by a factor, so that the axis stays, and heights.
class MeridianBend : public dealii::ChartManifold<2, 2, 2> {
 public:
  MeridianBend(double radius, double height) : radius_(radius), height_(height) {}
  std::unique_ptr<dealii::Manifold<2>> clone() const override {
    return std::make_unique<MeridianBend>(radius_, height_);
  }
  Point<2> push_forward(const Point<2>& chart) const override {
    Point<2> p = chart;
    p[0] *= factor(p[1]);
    p[1] += rise(p[0]);
    return p;
  }
  Point<2> pull_back(const Point<2>& point) const override {
    Point<2> p = point;
    p[1] -= rise(p[0]);
    p[0] /= factor(p[1]);
    return p;
  }

 private:
  double factor(double z) const { return 1.0 + 0.12 * std::sin(2.0 * z / height_ + 0.7); }
  double rise(double r) const { return 0.12 * height_ * std::cos(2.0 * r / radius_); }
  double radius_, height_;
};

/// The section of a ring, a disc or a cylinder's wall.
void make_rectangle(const BodyMesh& body, Triangulation<2>& mesh) {
  const bool wall = body.shape == Shape::cylinder_meridian;
  const Point<2> low(wall ? body.size[0] : body.origin[0], body.origin[2]);
  const Point<2> high(wall ? body.size[1] : low[0] + body.size[0], low[1] + body.size[2]);
  if (body.divisions[0] < 1 || body.divisions[2] < 1)
    throw std::invalid_argument("a ring needs at least one division each way");
  dealii::GridGenerator::subdivided_hyper_rectangle(
      mesh, {unsigned(body.divisions[0]), unsigned(body.divisions[2])}, low, high, true);
  const std::array<int, 4> names{wall ? boundary::inner : boundary::low_x,
                                 wall ? boundary::outer : boundary::high_x, boundary::low_z,
                                 boundary::high_z};
  for (const auto& cell : mesh.active_cell_iterators())
    for (const auto& face : cell->face_iterators())
      if (face->at_boundary())
        face->set_boundary_id(dealii::types::boundary_id(names[face->boundary_id()]));
  if (body.distortion > 0.0) dealii::GridTools::distort_random(body.distortion, mesh, true);
}

unsigned levels(const BodyMesh& body) {
  const int n = body.divisions[0];
  if (n < 1 || !std::has_single_bit(unsigned(n)))
    throw std::invalid_argument("an octant is divided by a power of two");
  return unsigned(std::countr_zero(unsigned(n)));
}

void make_sphere(const BodyMesh& body, Triangulation<3>& mesh) {
  dealii::GridGenerator::quarter_hyper_shell(mesh, Point<3>(), body.size[0], body.size[1], 3,
                                             false);
  const double middle = 0.5 * (body.size[0] + body.size[1]);
  name_boundary(mesh, boundary::inner, [&](const Point<3>& p) { return p.norm() < middle; });
  name_boundary(mesh, boundary::outer, [&](const Point<3>& p) { return p.norm() > middle; });
  name_planes(mesh, 2.0 * body.size[1]);
  mesh.refine_global(levels(body));
}

void make_disc(const BodyMesh& body, Triangulation<3>& mesh) {
  dealii::Triangulation<2> section;
  dealii::GridGenerator::quarter_hyper_ball(section, Point<2>(), body.size[0]);
  dealii::GridGenerator::extrude_triangulation(section, 2, body.size[2], mesh);
  mesh.set_all_manifold_ids(dealii::numbers::flat_manifold_id);
  const auto on_side = [&](const Point<3>& p) {
    return std::abs(std::hypot(p[0], p[1]) - body.size[0]) < 1e-9;
  };
  name_boundary(mesh, boundary::outer, on_side);
  name_planes(mesh, body.size[2]);
  for (const auto& cell : mesh.active_cell_iterators())
    for (const auto& face : cell->face_iterators())
      if (face->at_boundary() && face->boundary_id() == boundary::outer)
        face->set_all_manifold_ids(curved);
  mesh.set_manifold(curved, dealii::CylindricalManifold<3>(2));
  mesh.refine_global(levels(body));
}

/// Halves the elements that have a vertex where `belongs` says so.
template <int dim, class Belongs>
void refine_at(Triangulation<dim>& mesh, Belongs belongs) {
  for (const auto& cell : mesh.active_cell_iterators())
    for (const unsigned v : cell->vertex_indices())
      if (belongs(cell->vertex(v))) {
        cell->set_refine_flag();
        break;
      }
  mesh.execute_coarsening_and_refinement();
}

}  // namespace

void make_mesh(const BodyMesh& description, Body<3>& body) {
  Triangulation<3>& mesh = body.triangulation;
  const meshes::Vector3& size = description.size;
  Point<3> corner(description.origin[0], description.origin[1], description.origin[2]);
  switch (description.shape) {
    case Shape::block:
    case Shape::curved_block:
      make_block(description, corner, corner + dealii::Tensor<1, 3>({size[0], size[1], size[2]}),
                 mesh);
      break;
    case Shape::sphere_octant: make_sphere(description, mesh); break;
    case Shape::cylinder_quarter: make_cylinder(description, mesh); break;
    case Shape::disc_octant: make_disc(description, mesh); break;
    default: throw std::invalid_argument("a meridian is no solid");
  }
  if (description.shape == Shape::curved_block) {
    const Bend bend(size);
    dealii::GridTools::transform([&](const Point<3>& p) { return bend.push_forward(p); }, mesh);
    mesh.set_all_manifold_ids(curved);
    mesh.set_manifold(curved, bend);
    corner = bend.push_forward(corner);
  }
  for (int i = 0; i < description.local_refinements; ++i)
    refine_at(mesh, [&](const Point<3>& p) {
      if (description.shape == Shape::disc_octant)
        return std::abs(std::hypot(p[0], p[1]) - size[0]) < 1e-9 && std::abs(p[2] - size[2]) < 1e-9;
      return p.distance(corner) < 1e-9;
    });
}

void make_mesh(const BodyMesh& description, Body<2>& body) {
  Triangulation<2>& mesh = body.triangulation;
  const meshes::Vector3& size = description.size;
  Point<2> corner(description.origin[0], description.origin[2]);
  if (description.shape == Shape::sphere_meridian) {
    dealii::GridGenerator::quarter_hyper_shell(mesh, Point<2>(), size[0], size[1], 1, false);
    const double middle = 0.5 * (size[0] + size[1]);
    name_boundary(mesh, boundary::inner, [&](const Point<2>& p) { return p.norm() < middle; });
    name_boundary(mesh, boundary::outer, [&](const Point<2>& p) { return p.norm() > middle; });
    name_boundary(mesh, boundary::low_x, [](const Point<2>& p) { return std::abs(p[0]) < 1e-9; });
    name_boundary(mesh, boundary::low_z, [](const Point<2>& p) { return std::abs(p[1]) < 1e-9; });
    mesh.refine_global(levels(description));
  } else {
    make_rectangle(description, mesh);
  }
  if (description.shape == Shape::curved_ring) {
    const MeridianBend bend(size[0], size[2]);
    dealii::GridTools::transform([&](const Point<2>& p) { return bend.push_forward(p); }, mesh);
    mesh.set_all_manifold_ids(curved);
    mesh.set_manifold(curved, bend);
    corner = bend.push_forward(corner);
  }
  if (description.shape == Shape::disc_meridian) corner = Point<2>(size[0], size[2]);
  for (int i = 0; i < description.local_refinements; ++i)
    refine_at(mesh, [&](const Point<2>& p) { return p.distance(corner) < 1e-9; });
}

}  // namespace fingertip::fem_reference::inline verification
