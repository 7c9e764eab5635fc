#include "lattice/dynamics/scaling/edge_inertia.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "lattice/kernels/by_width.h"

namespace fingertip::lattice::inline dynamics::inline scaling {

namespace {

using Shares = sweeps::EdgeShares;

constexpr std::size_t edges_at_once = 32;  // packs of eight cells

const sweeps::EdgeLoops& edge_loops() {
  static const sweeps::EdgeLoops& widest =
      kernel::by_width(0, [](auto w) { return sweeps::edge_loops_at<w()>; })();
  return widest;
}

Shares whole_shares() {
  const CellEdges edges = cell_edges({0.125, 0.125, 0.125, 0.125, 0.125, 0.125, 0.125, 0.125});
  Shares shares;
  for (std::size_t e = 0; e < 12; ++e) {
    std::fill_n(shares.mean[e], lanes, Single(edges.mean[e]));
    std::fill_n(shares.majorant[e], lanes, Single(edges.majorant[e]));
    std::fill_n(shares.spread[e], lanes, Single(edges.spread[e]));
  }
  return shares;
}

/// Of the cells from `cell` on that lie within a pack; `cell` is the next one afterwards.
Shares take_pack(const LatticeModel& model, std::size_t& cell) {
  const std::uint32_t first = model.cells[cell];
  Shares shares;
  for (; cell < model.cells.size() && model.cells[cell] < first + lanes; ++cell) {
    const std::size_t lane = model.cells[cell] - first;
    const CellEdges& edges = model.edges[cell];
    for (std::size_t e = 0; e < 12; ++e) {
      shares.mean[e][lane] = Single(edges.mean[e]);
      shares.majorant[e][lane] = Single(edges.majorant[e]);
      shares.spread[e][lane] = Single(edges.spread[e]);
    }
  }
  return shares;
}

}  // namespace

EdgeInertiaRule::EdgeInertiaRule(const LatticeModel& model)
    : model_(&model), shares_{whole_shares()} {
  if (model.edges.empty() || model.cell_lattice.material.holds_fibres()) {
    throw std::invalid_argument(
        "mass scaling: the model must consist of cut cells with a law it "
        "has a bound for");
  }
  for (std::size_t cell = 0; cell < model.cells.size();) {
    sweeps::EdgePack pack;
    pack.first = model.cells[cell];
    const Shares shares = take_pack(model, cell);
    if (!(shares == shares_.front())) {
      pack.shares = std::uint32_t(shares_.size());
      shares_.push_back(shares);
    }
    packs_.push_back(pack);
  }
}

/// `elastic` and `viscous`: dt²/4 and dt tau/2, with all that multiplies them.
sweeps::EdgeFactors EdgeInertiaRule::factors(double elastic, double viscous) const {
  const CellMaterial& m = model_->cell_lattice.material;
  const double both = elastic + viscous;
  const auto [c11, c12, c44] = m.at_rest();
  const double shear = m.kind == CellLawKind::network ? m.shear : 0.0,
               lambda = m.kind == CellLawKind::network ? std::abs(m.lambda) : 0.0;
  return {Single(elastic * shear),
          Single(elastic * lambda),
          Single(viscous * shear),
          Single(viscous * lambda),
          Single(both * (std::abs(c11) + 2.0 * std::abs(c12))),
          Single(both * 2.0 * c44)};
}

double EdgeInertiaRule::find(const State& state, double step, double allowance, Team& team,
                             EdgeInertia& edges) {
  const CellLattice& cells = model_->cell_lattice;
  const double unit = allowance * cells.spacing,
               elastic = unit * 0.25 * step * step * model_->relaxation.instantaneous_ratio(),
               viscous = unit * 0.5 * step * cells.material.retardation_time;
  const sweeps::EdgeFactors now = factors(elastic, viscous);
  sweeps::EdgeArrays arrays{{}, shares_.data(), 1.0 / cells.spacing, {1, cells.row, cells.plane}};
  for (std::size_t c = 0; c < 3; ++c)
    arrays.displacement[c] = state.displacement.component[c].data();
  team.split(packs_.size(), edges_at_once, [&](std::size_t begin, std::size_t end) {
    edge_loops().find_moduli(arrays, now, packs_.data() + begin, end - begin);
  });
  const Single spread = Single((elastic + viscous) * cells.material.hourglass_modulus);
  team.split(3, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t d = begin; d < end; ++d) {
      Single* along[3];
      for (std::size_t c = 0; c < 3; ++c) {
        std::fill(edges[c][d].begin(), edges[c][d].end(), 0.0F);
        along[c] = edges[c][d].data();
      }
      edge_loops().add_blocks(arrays, packs_.data(), packs_.size(), d, spread, along);
    }
  });
  double sum = 0.0;
  for (std::size_t c = 0; c < 3; ++c) {
    const std::vector<Single>& stretched = edges[c][c];
    sum += Eigen::Map<const Eigen::ArrayXf>(stretched.data(), Eigen::Index(stretched.size()))
               .cast<double>()
               .sum();
  }
  return sum;
}

}  // namespace fingertip::lattice::inline dynamics::inline scaling
