#include "lattice/scaling/edge_inertia.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "lattice/cells/largest_modulus.h"
#include "lattice/scaling/sweeps.h"

namespace fingertip::lattice {

namespace {

constexpr std::size_t grain = 16;  // packs of eight cells

/// From a cell's lowest corner to the start of edge `e` of 4 along d.
std::ptrdiff_t edge_start(const std::array<std::ptrdiff_t, 3>& next, std::size_t d, std::size_t e) {
  return std::ptrdiff_t(e & 1) * next[(d + 1) % 3] + std::ptrdiff_t(e >> 1) * next[(d + 2) % 3];
}

/// Eight deformation gradients, F[row][column].
using Gradients = double[3][3][lanes];

/// Mean of dx/dX over a cell's rubber.
void gather_gradients(const State& state, const std::array<std::ptrdiff_t, 3>& next,
                      const std::uint32_t* corner, const double (&mean)[12][lanes], double spacing,
                      Gradients& F) {
  for (std::size_t row = 0; row < 3; ++row) {
    const double* u = state.displacement.component[row].data();
    for (std::size_t d = 0; d < 3; ++d) {
      for (std::size_t i = 0; i < lanes; ++i) F[row][d][i] = 0.0;
      for (std::size_t e = 0; e < 4; ++e) {
        const std::ptrdiff_t start = edge_start(next, d, e);
        for (std::size_t i = 0; i < lanes; ++i) {
          const double* at = u + std::ptrdiff_t(corner[i]) + start;
          F[row][d][i] += mean[4 * d + e][i] * (at[next[d]] - at[0]);
        }
      }
      for (std::size_t i = 0; i < lanes; ++i) {
        F[row][d][i] = F[row][d][i] / spacing + (row == d ? 1.0 : 0.0);
      }
    }
  }
}

/// J = det F, and the largest row sum of |F⁻¹ F⁻ᵀ|, which bounds its eigenvalues.
FINGERTIP_CLONES void invert(const Gradients& F, double (&J)[lanes], double (&largest)[lanes]) {
  Gradients cofactor;
  for (std::size_t r = 0; r < 3; ++r) {
    for (std::size_t c = 0; c < 3; ++c) {
      const std::size_t r1 = (r + 1) % 3, r2 = (r + 2) % 3, c1 = (c + 1) % 3, c2 = (c + 2) % 3;
      for (std::size_t i = 0; i < lanes; ++i)
        cofactor[r][c][i] = F[r1][c1][i] * F[r2][c2][i] - F[r1][c2][i] * F[r2][c1][i];
    }
  }
  double product[3][3][lanes];  // of cofactorᵀ and cofactor
  for (std::size_t i = 0; i < lanes; ++i) {
    J[i] = F[0][0][i] * cofactor[0][0][i] + F[0][1][i] * cofactor[0][1][i] +
           F[0][2][i] * cofactor[0][2][i];
    largest[i] = 0.0;
  }
  for (std::size_t r = 0; r < 3; ++r)
    for (std::size_t c = 0; c < 3; ++c)
      for (std::size_t i = 0; i < lanes; ++i)
        product[r][c][i] =
            std::abs(cofactor[0][r][i] * cofactor[0][c][i] + cofactor[1][r][i] * cofactor[1][c][i] +
                     cofactor[2][r][i] * cofactor[2][c][i]);
  for (std::size_t r = 0; r < 3; ++r)
    for (std::size_t i = 0; i < lanes; ++i)
      largest[i] = std::max(
          largest[i], (product[r][0][i] + product[r][1][i] + product[r][2][i]) / (J[i] * J[i]));
}

/// Bound on dt² d²W/dF²/4 and half of dt times the viscous one, over all dF [Pa s²]. Law `network`:
/// W = G/2 (F:F - 3) - G ln J + lambda/2 ln² J, whose second derivative is G + (G - lambda ln J)
/// dF⁻¹ dF⁻¹ + lambda F⁻ᵀ F⁻ᵀ. Not below the value at rest.
double bound(const CellMaterial& m, double step, double J, double largest) {
  const double elastic = 0.25 * step * step, viscous = 0.5 * step * m.retardation_time;
  const double rest = largest_modulus(m);
  if (m.kind == CellLawKind::cubic) return (elastic + viscous) * rest;
  if (!(J > 0.0)) return (elastic + viscous) * rest;  // the press ends with CrushedCells
  const double pressure = std::abs(m.shear - m.lambda * std::log(J));
  return elastic * std::max(rest, m.shear + (pressure + 3.0 * m.lambda) * largest) +
         viscous * rest * std::max(1.0, largest);
}

}  // namespace

EdgeInertiaRule::EdgeInertiaRule(const LatticeModel& model)
    : model_(&model), next_{1, model.cell_lattice.row, model.cell_lattice.plane} {
  if (model.edges.empty()) {
    throw std::invalid_argument("mass scaling: the model must consist of cut cells with a law");
  }
  packs_.resize((model.cells.size() + lanes - 1) / lanes);
  for (std::size_t cell = 0; cell < lanes * packs_.size(); ++cell) {
    Pack& pack = packs_[cell / lanes];
    const bool fills_up = cell >= model.cells.size();  // with a cell that has no edges
    pack.corner[cell % lanes] = model.cells[fills_up ? 0 : cell];
    for (std::size_t e = 0; e < 12 && !fills_up; ++e) {
      pack.mean[e][cell % lanes] = model.edges[cell].mean[e];
      pack.majorant[e][cell % lanes] = model.edges[cell].majorant[e];
    }
  }
}

double EdgeInertiaRule::find(const State& state, double step, double room, Team& team,
                             EdgeInertia& edges) {
  const CellMaterial& material = model_->cell_lattice.material;
  const double unit = model_->spacing() * room;
  team.split(packs_.size(), grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      Pack& pack = packs_[p];
      Gradients F;
      gather_gradients(state, next_, pack.corner.data(), pack.mean, model_->spacing(), F);
      double J[lanes], largest[lanes];
      invert(F, J, largest);
      for (std::size_t i = 0; i < lanes; ++i)
        pack.stiffness[i] = unit * bound(material, step, J[i], largest[i]);
    }
  });
  for (auto& edge : edges) std::fill(edge.begin(), edge.end(), 0.0);
  double sum = 0.0;
  for (const Pack& pack : packs_) {
    for (const double stiffness : pack.stiffness) sum += stiffness;
    for (std::size_t d = 0; d < 3; ++d) {
      for (std::size_t e = 0; e < 4; ++e) {
        double* const start = edges[d].data() + edge_start(next_, d, e);
        for (std::size_t i = 0; i < lanes; ++i)
          start[pack.corner[i]] += pack.stiffness[i] * pack.majorant[4 * d + e][i];
      }
    }
  }
  return sum;
}

}  // namespace fingertip::lattice
