#include "lattice/mass_scaling.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "lattice/stencil.h"

namespace fingertip::lattice {

using Eigen::Matrix3d;
using meshes::Vector3;

namespace {

constexpr std::size_t grain = 32;  // blocks of eight points

/// x p(x) stays above half of this: no motion is left without a response.
constexpr double damping = 0.2;

std::array<std::ptrdiff_t, 3> neighbours(const LatticeModel& model) {
  return {1, model.cell_lattice.row, model.cell_lattice.plane};
}

/// From a cell's lowest corner to the start of edge `e` of 4 along d.
std::ptrdiff_t edge_start(const std::array<std::ptrdiff_t, 3>& next, std::size_t d, std::size_t e) {
  return std::ptrdiff_t(e & 1) * next[(d + 1) % 3] + std::ptrdiff_t(e >> 1) * next[(d + 2) % 3];
}

double largest_row(const Matrix3d& symmetric) {
  return symmetric.cwiseAbs().rowwise().sum().maxCoeff();
}

/// Bounds on the eigenvalues of a cell's elastic and viscous d²W/dF², over all dF [Pa].
struct Tangent {
  double elastic = 0.0, viscous = 0.0;
};

Tangent tangent_of(const CellMaterial& m, const Matrix3d& F) {
  if (m.kind == CellLawKind::cubic) {
    const double bound = m.c11 + 2.0 * m.c12;
    return {bound, bound};
  }
  const double rest = 3.0 * m.lambda + 2.0 * m.shear, J = F.determinant();
  if (!(J > 0.0)) return {rest, rest};  // the press ends with CrushedCells
  const Matrix3d T = F.inverse();
  const double g = largest_row(T * T.transpose());
  const double pressure = std::abs(m.shear - m.lambda * std::log(J));
  return {std::max(rest, m.shear + (pressure + 3.0 * m.lambda) * g), std::max(rest, rest * g)};
}

/// Mean of dx/dX over a cell's rubber.
Matrix3d deformation(const LatticeModel& model, std::size_t cell, const State& state) {
  const auto next = neighbours(model);
  const CellEdges& edges = model.edges[cell];
  Matrix3d F = Matrix3d::Identity();
  for (std::size_t d = 0; d < 3; ++d) {
    for (std::size_t e = 0; e < 4; ++e) {
      const std::size_t i = std::size_t(std::ptrdiff_t(model.cells[cell]) + edge_start(next, d, e));
      F.col(Eigen::Index(d)) +=
          edges.mean[4 * d + e] / model.spacing() *
          (state.displacement.at(i + std::size_t(next[d])) - state.displacement.at(i));
    }
  }
  return F;
}

/// The recursion of accelerate().
struct Recursion {
  const double* edge[3];
  const double* inverse;
  const double* plain[3];
  const double* from[3];
  double* to[3];
  std::ptrdiff_t next[2];  ///< along y and z
  double centre, pull, share;
};

/// Compiled for several instruction sets; without sums across lanes the bits are the same.
[[gnu::target_clones("avx512f", "avx2", "default")]] void advance_blocks(
    const Recursion& r, const std::uint32_t* blocks, std::size_t count) {
  const std::ptrdiff_t y = r.next[0], z = r.next[1];
  for (std::size_t b = 0; b < count; ++b) {
    const std::size_t first = blocks[b];
    const double *right = r.edge[0] + first, *up = r.edge[1] + first, *far = r.edge[2] + first;
    for (std::size_t c = 0; c < 3; ++c) {
      const double *from = r.from[c] + first, *plain = r.plain[c] + first;
      double* const to = r.to[c] + first;
      double result[lanes];
      for (std::size_t i = 0; i < lanes; ++i) {
        const double* u = from + i;
        const double sum = right[i] * (u[0] - u[1]) +
                           right[std::ptrdiff_t(i) - 1] * (u[0] - u[-1]) + up[i] * (u[0] - u[y]) +
                           up[std::ptrdiff_t(i) - y] * (u[0] - u[-y]) + far[i] * (u[0] - u[z]) +
                           far[std::ptrdiff_t(i) - z] * (u[0] - u[-z]);
        result[i] =
            r.centre * u[0] - r.pull * (r.inverse[first + i] * sum) - to[i] + r.share * plain[i];
      }
      std::copy(result, result + lanes, to);
    }
  }
}

}  // namespace

AccelerationFields::AccelerationFields(const LatticeModel& model)
    : plain(model.points()),
      iterates{VectorField(model.points()), VectorField(model.points())},
      inverse(model.inverse_mass) {}

MassScaling::MassScaling(const LatticeModel& model, const State& state, double step, double room)
    : model_(&model), step_(step) {
  if (model.edges.empty()) {
    throw std::invalid_argument("MassScaling: the model must consist of cut cells with a law");
  }
  for (auto& edge : edge_) edge.assign(model.points(), 0.0);
  for (std::size_t cell = 0; cell < model.cells.size(); ++cell) add_cell(cell, state, room);
  const auto next = neighbours(model);
  for (const std::uint32_t i : model.particles) {
    double sum = 0.0;
    for (std::size_t d = 0; d < 3; ++d) sum += edge_[d][i] + edge_[d][i - std::size_t(next[d])];
    largest_ = std::max(largest_, 2.0 * sum * model.inverse_mass[i]);
  }
  choose_polynomial();
}

void MassScaling::add_cell(std::size_t cell, const State& state, double room) {
  const CellMaterial& m = model_->cell_lattice.material;
  Matrix3d F = Matrix3d::Identity();
  if (m.kind != CellLawKind::cubic) F = deformation(*model_, cell, state);
  const Tangent tangent = tangent_of(m, F);
  const double unit = model_->spacing() * room * step_ *
                      (0.25 * step_ * tangent.elastic + 0.5 * m.retardation_time * tangent.viscous);
  const auto next = neighbours(*model_);
  for (std::size_t d = 0; d < 3; ++d) {
    for (std::size_t e = 0; e < 4; ++e) {
      edge_[d][std::size_t(std::ptrdiff_t(model_->cells[cell]) + edge_start(next, d, e))] +=
          unit * model_->edges[cell].majorant[4 * d + e];
    }
  }
}

void MassScaling::choose_polynomial() {
  for (stages_ = 1;; ++stages_) {
    const double s = stages_, angle = std::acosh(1.0 + damping) / s;  // T_s(w0) = 1 + damping
    w0_ = std::cosh(angle);
    const double slope = s * std::sinh(s * angle) / std::sinh(angle);  // T_s'(w0)
    w1_ = (2.0 + damping) / slope;
    if ((1.0 + w0_) / w1_ >= largest_) return;
  }
}

/// Who resists by how much, for this step.
void MassScaling::note(std::span<const TieInertia> ties, AccelerationFields& fields) const {
  fields.contact.clear();
  for (const TieInertia& tie : ties) {
    const double inertia = model_->mass[tie.particle] + tie.bond;
    fields.inverse[tie.particle] = 1.0 / inertia;
    if (tie.contact.isZero(0.0)) continue;
    const Matrix3d whole = inertia * Matrix3d::Identity() + tie.contact;
    fields.contact.push_back(
        {tie.particle, 1.0 / inertia * Matrix3d::Identity() - whole.inverse()});
  }
}

/// Row of S times a field.
Vector3 MassScaling::product(const VectorField& field, std::size_t point) const {
  const auto next = neighbours(*model_);
  const Vector3 here = field.at(point);
  Vector3 sum = Vector3::Zero();
  for (std::size_t d = 0; d < 3; ++d) {
    const std::size_t step = std::size_t(next[d]);
    sum += edge_[d][point] * (here - field.at(point + step)) +
           edge_[d][point - step] * (here - field.at(point - step));
  }
  return sum;
}

/// to = 2 (w0 - w1 D⁻¹ S) from - to + share * plain.
void MassScaling::advance(const AccelerationFields& fields, const VectorField& from, double share,
                          Team& team, VectorField& to) const {
  const auto next = neighbours(*model_);
  Recursion r{{edge_[0].data(), edge_[1].data(), edge_[2].data()},
              fields.inverse.data(),
              {},
              {},
              {},
              {next[1], next[2]},
              2.0 * w0_,
              2.0 * w1_,
              share};
  for (std::size_t c = 0; c < 3; ++c) {
    r.plain[c] = fields.plain.component[c].data();
    r.from[c] = from.component[c].data();
    r.to[c] = to.component[c].data();
  }
  const std::uint32_t* blocks = model_->blocks.data();
  team.split(model_->blocks.size(), grain, [&](std::size_t begin, std::size_t end) {
    advance_blocks(r, blocks + begin, end - begin);
  });
  for (const AccelerationFields::Contact& contact : fields.contact) {
    to.add(contact.particle, 2.0 * w1_ * (contact.excess * product(from, contact.particle)));
  }
}

/// With t_k = T_k(w0), g_k(x) = (t_k - T_k(w0 - w1 x))/x obeys g_(k+1) = 2 (w0 - w1 x) g_k + 2 w1
/// t_k - g_(k-1), g_0 = 0, g_1 = w1, and p = g_s/(1 + t_s).
void MassScaling::accelerate(std::span<const TieInertia> ties, Team& team,
                             AccelerationFields& fields, VectorField& force) const {
  const LatticeModel& model = *model_;
  note(ties, fields);
  for (std::size_t c = 0; c < 3; ++c) {
    for (const std::uint32_t i : model.particles) {
      fields.plain.component[c][i] = force.component[c][i] * model.inverse_mass[i];
      fields.iterates[0].component[c][i] = 0.0;
      fields.iterates[1].component[c][i] = w1_ * fields.plain.component[c][i];
    }
  }
  double before = 1.0, now = w0_;  // t_0, t_1
  for (int k = 1; k < stages_; ++k) {
    const VectorField& from = fields.iterates[std::size_t(k % 2)];
    VectorField& to = fields.iterates[std::size_t((k + 1) % 2)];
    advance(fields, from, 2.0 * w1_ * now, team, to);
    std::tie(before, now) = std::pair(now, 2.0 * w0_ * now - before);
  }
  const VectorField& last = fields.iterates[std::size_t(stages_ % 2)];
  for (std::size_t c = 0; c < 3; ++c) {
    for (const std::uint32_t i : model.particles) {
      force.component[c][i] = model.mass[i] / (1.0 + now) * last.component[c][i];
    }
  }
  fields.changes.clear();
  for (const TieInertia& tie : ties) {
    fields.changes.push_back(last.at(tie.particle) / (1.0 + now) - fields.plain.at(tie.particle));
    fields.inverse[tie.particle] = model.inverse_mass[tie.particle];
  }
}

}  // namespace fingertip::lattice
