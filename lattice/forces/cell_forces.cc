#include "lattice/forces/cell_forces.h"

#include <algorithm>
#include <limits>
#include <mutex>
#include <numeric>

#include "lattice/forces/cell_arrays.h"
#include "lattice/forces/cell_energy.h"

namespace fingertip::lattice::inline forces {

namespace {

bool has_rates(const CellMaterial& material) {
  return material.kind != CellLawKind::cubic && material.retardation_time > 0.0;
}

void extend(kernel::CellBounds& all, const kernel::CellBounds& some) {
  all.smallest_jacobian = std::min(all.smallest_jacobian, some.smallest_jacobian);
  all.tangent = std::max(all.tangent, some.tangent);
  all.beyond = std::max(all.beyond, some.beyond);
  all.viscosity = std::max(all.viscosity, some.viscosity);
  all.fastest = std::max(all.fastest, some.fastest);
  all.velocity_gradient = std::max(all.velocity_gradient, some.velocity_gradient);
}

CellExtremes extremes_of(const CellMaterial& m, const kernel::CellBounds& bounds) {
  CellExtremes result;
  if (m.kind == CellLawKind::cubic) return result;
  result.smallest_jacobian = bounds.smallest_jacobian;
  const double G = m.shear, lambda = m.lambda, tangent = bounds.tangent;
  double stiffening = tangent;
  if (m.large_strain()) {
    stiffening = std::max(
        (G + tangent) / (lambda + 2.0 * G),
        (G + tangent + 2.0 * lambda * bounds.viscosity + bounds.beyond) / (3.0 * lambda + 2.0 * G));
  }
  result.stiffening = std::max(1.0, stiffening);
  result.thickening = bounds.viscosity;
  if (has_rates(m)) {
    result.fastest = bounds.fastest / m.retardation_time;
    result.velocity_gradient = bounds.velocity_gradient / m.retardation_time;
  }
  return result;
}

}  // namespace

CellForces::CellForces(const CellLattice& cells, const CellMaterial& material, Team& team,
                       int width)
    : cells_(&cells),
      material_(material),
      team_(&team),
      sweep_(kernel::select_cells(
          material.kind, has_rates(material) ? kernel::CellTask::damped : kernel::CellTask::elastic,
          width)),
      relaxing_sweep_(kernel::select_cells(material.kind, kernel::CellTask::relaxing, width)),
      storing_sweep_(kernel::select_cells(material.kind, kernel::CellTask::storing, width)),
      sums_energy_(material.kind == CellLawKind::network && has_rates(material)) {
  if (sums_energy_) stored_.resize(cells.slabs[0].size() + cells.slabs[1].size());
}

CellExtremes CellForces::add(const VectorField& displacement, const VectorField& velocity,
                             VectorField& force, const kernel::History& history) {
  return add(history.values == nullptr ? sweep_ : relaxing_sweep_, displacement, velocity, force,
             history);
}

CellExtremes CellForces::add(const VectorField& displacement, const VectorField& velocity,
                             VectorField& force, double& energy) {
  if (!sums_energy_) {
    energy = cell_energy(*cells_, material_, displacement, *team_);
    return add(sweep_, displacement, velocity, force, {});
  }
  const CellExtremes extremes = add(storing_sweep_, displacement, velocity, force, {});
  energy = std::accumulate(stored_.begin(), stored_.end(), 0.0);
  if (!(extremes.smallest_jacobian > 0.0)) energy = std::numeric_limits<double>::infinity();
  return extremes;
}

CellExtremes CellForces::add(kernel::CellSweep sweep, const VectorField& displacement,
                             const VectorField& velocity, VectorField& force,
                             const kernel::History& history) {
  kernel::CellArrays arrays = cell_arrays(*cells_, displacement);
  arrays.material = material_;
  arrays.history = history;
  for (std::size_t c = 0; c < 3; ++c) {
    arrays.velocity[c] = velocity.component[c].data();
    arrays.force[c] = force.component[c].data();
  }
  kernel::CellBounds all;
  std::mutex guard;
  std::size_t before = 0;  // slabs of the first list
  for (const auto& slabs : cells_->slabs) {
    // The same thread has neighbouring slabs of both lists, with most of their particles in its own
    // cache.
    team_->split(slabs.size(), 1, [&](std::size_t begin, std::size_t end) {
      kernel::CellBounds some;
      for (std::size_t s = begin; s < end; ++s) {
        const double stored =
            sweep(arrays, cells_->blocks.data(), slabs[s].first, slabs[s].last, some);
        if (sums_energy_) stored_[before + s] = stored;
      }
      const std::lock_guard<std::mutex> lock(guard);
      extend(all, some);
    });
    before += slabs.size();
  }
  return extremes_of(material_, all);
}

}  // namespace fingertip::lattice::inline forces
