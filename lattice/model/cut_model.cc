#include "lattice/model/cut_model.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>

#include "lattice/model/cut_tip.h"

namespace fingertip::lattice::inline model {

using Eigen::Matrix3d;
using meshes::CutCell;
using meshes::Vector3;

namespace {

/// Largest squared frequency of a single particle, its neighbours held, over that of a particle
/// among whole cells.
constexpr double frequency_ratio = 1.7;

/// What a cell's law, at small strain and along the grid's axes, contributes to the stiffness of
/// each of its corners against its neighbours [N/m].
std::array<Matrix3d, 8> law_stiffness(const CutCell& cell, const CellMaterial& material,
                                      double spacing) {
  const CornerMoments moments = corner_moments(cell);
  const auto gradients = mean_gradients(moments, spacing, Matrix3d::Identity());
  const double volume = cell.fraction() * std::pow(spacing, 3);
  const auto [c11, c12, c44] = material.at_rest();
  std::array<Matrix3d, 8> result;
  for (int c = 0; c < 8; ++c) {
    const Vector3 g = gradients.col(c);
    Matrix3d& block = result[std::size_t(c)];
    block =
        volume * ((c12 + c44) * g * g.transpose() + c44 * g.squaredNorm() * Matrix3d::Identity());
    block.diagonal() += volume * (c11 - c12 - 2.0 * c44) * g.cwiseAbs2();
    // Fibres see the corner's own three edges where the law sees the mean.
    double edges = -volume * g.squaredNorm();
    for (const std::size_t d : along_axis)
      edges += spacing * spring_share(moments, c, half_stencil[d]);
    block.diagonal().array() += material.hourglass_modulus * edges;
  }
  return result;
}

/// The same for the central springs that a cell owns.
std::array<Matrix3d, 8> spring_stiffness(const CutCell& cell, const SpringConstants& constants) {
  const CornerMoments moments = corner_moments(cell);
  const std::array<double, 3> k{constants.k1, constants.k2, constants.k3};
  std::array<Matrix3d, 8> result;
  result.fill(Matrix3d::Zero());
  for (const CellSpring& spring : cell_springs) {
    const Direction& d = half_stencil[spring.direction];
    const Vector3 apart(d.dx, d.dy, d.dz);
    const Matrix3d block = k[d.family] * spring_share(moments, spring.start, d) * apart *
                           apart.transpose() / apart.squaredNorm();
    result[std::size_t(spring.start)] += block;
    result[std::size_t(spring.end)] += block;
  }
  return result;
}

std::array<Matrix3d, 8> corner_stiffness(const CutCell& cell, const Formulation& formulation,
                                         double spacing) {
  std::array<Matrix3d, 8> sum;
  sum.fill(Matrix3d::Zero());
  if (formulation.cell_law) sum = law_stiffness(cell, formulation.material, spacing);
  if (!formulation.central_springs) return sum;
  const std::array<Matrix3d, 8> springs = spring_stiffness(cell, formulation.constants);
  for (std::size_t c = 0; c < 8; ++c) sum[c] += springs[c];
  return sum;
}

double largest_eigenvalue(const Matrix3d& matrix) {
  return Eigen::SelfAdjointEigenSolver<Matrix3d>(matrix, Eigen::EigenvaluesOnly)
      .eigenvalues()
      .maxCoeff();
}

/// Largest eigenvalue of a particle's stiffness, per particle of `cells` [N/m].
std::vector<double> particle_stiffness(const LatticeModel& model, const GridCells& cells,
                                       const Formulation& formulation) {
  std::vector<Matrix3d> sum(cells.particles(), Matrix3d::Zero());
  for (const CutCell& cell : cells.cells()) {
    const auto corners = cells.corners(cell);
    const auto stiffness = corner_stiffness(cell, formulation, cells.grid().spacing);
    for (std::size_t c = 0; c < 8; ++c) sum[corners[c]] += stiffness[c];
  }
  std::vector<double> result;
  for (std::size_t p = 0; p < sum.size(); ++p) {
    // The other parts do not couple its motions across a mirror plane and along it.
    const Vector3 own = sum[p].diagonal();
    model.sector.hold(model.place(cells.point(p)), sum[p]);
    sum[p].diagonal() = own;
    result.push_back(largest_eigenvalue(sum[p]));
  }
  return result;
}

/// Squared frequency of a particle among whole cells, its neighbours held [1/s²].
double whole_frequency(const Formulation& formulation, double spacing, double density) {
  Matrix3d sum = Matrix3d::Zero();
  for (const Matrix3d& corner :
       corner_stiffness(whole_cells({0, 0, 0}, {1, 1, 1}).front(), formulation, spacing)) {
    sum += corner;
  }
  return largest_eigenvalue(sum) / (density * std::pow(spacing, 3));
}

void raise_light_masses(LatticeModel& model, const CutTip& tip, double density) {
  const double limit = frequency_ratio * whole_frequency(tip.formulation, model.spacing(), density);
  const std::vector<double> stiffness = particle_stiffness(model, tip.cells, tip.formulation);
  for (std::size_t p = 0; p < tip.cells.particles(); ++p) {
    const std::size_t i = tip.cells.point(p);
    const double missing = std::max(0.0, stiffness[p] / limit - model.mass[i]);
    model.added_mass += model.sector.count() * missing;
    model.mass[i] += missing;
    model.inverse_mass[i] = 1.0 / model.mass[i];
  }
}

/// For models whose energy is that of their cells alone (scaling/).
void list_edges(LatticeModel& model, const CutTip& tip) {
  for (const CutCell& cell : tip.cells.cells())
    model.edges.push_back(cell_edges(corner_moments(cell)));
}

/// From particle numbers to grid indices.
std::vector<EmbeddedPoint> on_grid(std::vector<EmbeddedPoint> points, const GridCells& cells) {
  for (EmbeddedPoint& point : points) {
    for (std::uint32_t& corner : point.corners) corner = cells.point(corner);
  }
  return points;
}

}  // namespace

LatticeModel build_cut_model(const meshes::Geometry& geometry, const meshes::Rubber& rubber,
                             const LatticeSettings& settings, int sectors) {
  CutTip tip = cut_tip(geometry, rubber, settings, sectors, row_margin);
  LatticeModel model =
      build_model(tip.cells, settings.model, tip.formulation, rubber.density, tip.sector);
  raise_light_masses(model, tip, rubber.density);
  if (tip.formulation.cell_law && !tip.formulation.central_springs) list_edges(model, tip);
  find_boundary(model, geometry);
  model.bond = on_grid(std::move(tip.bond), tip.cells);
  model.outer = on_grid(std::move(tip.outer), tip.cells);
  model.contact = tip.contact;
  return model;
}

LatticeModel build_tip(const meshes::Geometry& geometry, const meshes::Rubber& rubber,
                       const LatticeSettings& settings, int sectors) {
  return settings.model == ModelKind::published
             ? build_published_tip(geometry, rubber, settings, sectors)
             : build_cut_model(geometry, rubber, settings, sectors);
}

}  // namespace fingertip::lattice::inline model
