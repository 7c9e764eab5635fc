#include "lattice/dynamics/scaling/edge_inertia.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/lattice/fixtures.h"

using namespace fingertip;
using namespace fixtures;
using lattice::CellMaterial;
using lattice::EdgeInertia;
using lattice::Kinematics;
using lattice::LatticeModel;
using lattice::ModelKind;
using lattice::State;

namespace {

constexpr double step = 1e-3, margin = 1.2;

/// A tip in which some particle lies among whole cells.
LatticeModel rubber(ModelKind kind) {
  lattice::LatticeSettings settings =
      settings_for(kind, kind == ModelKind::network ? Kinematics::finite : Kinematics::small, 8);
  settings.constants = lattice::hookean_constants({}, settings.spacing);
  return lattice::build_tip({}, {}, settings);
}

/// A point all of whose edges are those of whole cells.
std::uint32_t among_whole_cells(const LatticeModel& model) {
  const std::ptrdiff_t row = model.cell_lattice.row, plane = model.cell_lattice.plane;
  for (const std::uint32_t p : model.particles) {
    bool deep = true;
    for (std::ptrdiff_t z = -2; z <= 2; ++z)
      for (std::ptrdiff_t y = -2; y <= 2; ++y)
        for (std::ptrdiff_t x = -2; x <= 2; ++x)
          deep = deep &&
                 model.is_particle[std::size_t(std::ptrdiff_t(p) + x + y * row + z * plane)] != 0;
    if (deep) return p;
  }
  throw std::logic_error("no such particle");
}

EdgeInertia edges_of(const LatticeModel& model, const State& state) {
  EdgeInertia edges;
  for (auto& component : edges) component.fill(std::vector<float>(model.points(), 0.0F));
  lattice::Team team(2);
  lattice::EdgeInertiaRule(model).find(state, step, margin, team, edges);
  return edges;
}

/// dt²/4 + dt tau/2, times a and the margin for later.
double unit(const LatticeModel& model) {
  const double tau = model.cell_lattice.material.retardation_time;
  return margin * model.spacing() * (0.25 * step * step + 0.5 * step * tau);
}

/// x = F X.
State deformed(const LatticeModel& model, const Eigen::Matrix3d& F) {
  State state(model);
  for (const std::uint32_t p : model.particles) {
    const Vector3 rest = model.grid.axes.transpose() * model.rest_position(p);
    state.displacement.set(p, (F - Eigen::Matrix3d::Identity()) * rest);
  }
  return state;
}

}  // namespace

TEST(EdgeInertia, OfRestMeetsTheBulkAlongTheAxesAlone) {
  for (const ModelKind kind : {ModelKind::network, ModelKind::hookean}) {
    const LatticeModel model = rubber(kind);
    const CellMaterial& m = model.cell_lattice.material;
    const bool cubic = m.kind == lattice::CellLawKind::cubic;
    const double same = cubic ? m.c11 + 2.0 * m.c12 : 3.0 * m.lambda + 2.0 * m.shear,
                 other = cubic ? 2.0 * m.c44 : 2.0 * m.shear;
    const EdgeInertia edges = edges_of(model, State(model));
    const std::uint32_t p = among_whole_cells(model);
    for (std::size_t c = 0; c < 3; ++c) {
      for (std::size_t d = 0; d < 3; ++d) {
        const double expected = unit(model) * ((c == d ? same : other) + m.hourglass_modulus);
        EXPECT_NEAR(edges[c][d][p], expected, 1e-5 * expected) << int(kind) << c << d;
      }
    }
  }
}

/// As a form in dF the sum of M_cd dF_cd² is not below dt²/4 d²W/dF² + dt/2 of its viscous
/// counterpart, both by central differences of the stress of law A.
TEST(EdgeInertia, IsNotBelowTheTangentOfDeformedCells) {
  const LatticeModel model = rubber(ModelKind::network);
  const CellMaterial& m = model.cell_lattice.material;
  const std::uint32_t p = among_whole_cells(model);
  Eigen::Matrix3d squeezed, sheared;
  squeezed << 1.15, 0.1, 0.0, -0.05, 1.2, 0.1, 0.1, 0.0, 0.6;
  sheared << 1.0, 0.4, 0.0, 0.0, 1.0, 0.3, 0.0, 0.0, 1.0;
  for (const Eigen::Matrix3d& F : {squeezed, sheared, Eigen::Matrix3d(1.2 * squeezed)}) {
    const EdgeInertia edges = edges_of(model, deformed(model, F));
    const auto stress = [&](const Eigen::Matrix3d& at) {
      const Eigen::Matrix3d T = at.inverse().transpose();
      return Eigen::Matrix3d(m.shear * (at - T) + m.lambda * std::log(at.determinant()) * T);
    };
    const auto viscous = [&](const Eigen::Matrix3d& rate) {
      const Eigen::Matrix3d L = rate * F.inverse();
      return Eigen::Matrix3d(
          (m.shear * (L + L.transpose()) + m.lambda * L.trace() * Eigen::Matrix3d::Identity()) *
          F.inverse().transpose());
    };
    Eigen::Matrix<double, 9, 9> excess = Eigen::Matrix<double, 9, 9>::Zero();
    for (Eigen::Index n = 0; n < 9; ++n) {
      Eigen::Matrix3d change = Eigen::Matrix3d::Zero();
      change(n / 3, n % 3) = 1.0;
      const double h = 1e-6;
      const Eigen::Matrix3d slope = (stress(F + h * change) - stress(F - h * change)) / (2.0 * h);
      const Eigen::Matrix3d all =
          model.spacing() * margin *
          (0.25 * step * step * slope + 0.5 * step * m.retardation_time * viscous(change));
      for (Eigen::Index k = 0; k < 9; ++k) excess(k, n) -= all(k / 3, k % 3);
      excess(n, n) += double(edges[std::size_t(n / 3)][std::size_t(n % 3)][p]) -
                      unit(model) * m.hourglass_modulus;
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 9, 9>> solver(
        0.5 * (excess + excess.transpose()));
    EXPECT_GT(solver.eigenvalues()[0], -1e-6 * unit(model) * m.lambda) << F;
    // Nor far above: by less than what swelling at rest takes.
    EXPECT_LT(solver.eigenvalues()[8], 3.0 * unit(model) * 3.0 * m.lambda) << F;
  }
}

TEST(EdgeInertia, StaysFiniteWhereCellsAreFlatOrInsideOut) {
  const LatticeModel model = rubber(ModelKind::network);
  const EdgeInertia at_rest = edges_of(model, State(model));
  const std::uint32_t p = among_whole_cells(model);
  for (const double stretch : {0.0, -1e-12, 1e-12, -0.5}) {
    const EdgeInertia edges =
        edges_of(model, deformed(model, Eigen::Vector3d(1.0, 1.0, stretch).asDiagonal()));
    for (std::size_t c = 0; c < 3; ++c) {
      for (std::size_t d = 0; d < 3; ++d) {
        EXPECT_GE(edges[c][d][p], 0.999F * at_rest[c][d][p]) << stretch;
        EXPECT_LT(edges[c][d][p], 20.0F * at_rest[c][c][p]) << stretch;
      }
    }
  }
}
