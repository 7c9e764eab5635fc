#include "studies/cases/equilibrium_study.h"

#include <cmath>

#include <fmt/format.h>

#include "meshes/table_rows.h"
#include "studies/cases/folders.h"
#include "studies/cases/force_errors.h"
#include "studies/files/run_tables.h"
#include "studies/report/run_data.h"
#include "studies/run/jobs.h"

namespace fingertip::studies {

namespace {

using meshes::PressResponse;
using reporting::force_at;

}  // namespace

EquilibriumStudy::EquilibriumStudy(const lattice::PressSetup& hookean,
                                   const lattice::PressSetup& central) {
  add("hookean", hookean);
  add("central", central);
  const double finest = hookean.lattice.spacing;
  for (const int cells : {6, 8}) {
    lattice::PressSetup setup = hookean;
    setup.lattice.spacing = setup.geometry.tip_radius / cells;
    const bool coarser = setup.lattice.spacing > finest * (1.0 + 1e-9);
    const bool allowed = setup.lattice.spacing <= 0.5 * setup.geometry.thickness();
    if (!coarser || !allowed) continue;
    setup.lattice.constants =
        lattice::hookean_constants(setup.rubber, setup.lattice.spacing,
                                   hookean.lattice.constants.k3 * setup.lattice.spacing / finest);
    add(fmt::format("hookean_R{}", cells), setup);
  }
}

void EquilibriumStudy::add(const std::string& name, lattice::PressSetup setup) {
  setup.protocol.mode = meshes::DriveMode::equilibrium;
  setup.lattice.kinematics = lattice::Kinematics::small;
  variants_.push_back({"equilibrium/" + name, setup});
}

std::vector<PlannedJob> EquilibriumStudy::jobs() const {
  std::vector<PlannedJob> jobs;
  for (const Variant& variant : variants_)
    jobs.push_back({variant.name, press_job(variant.setup), true});
  return jobs;
}

void EquilibriumStudy::write_table(const std::filesystem::path& folder,
                                   const PressResponse& reference) const {
  std::vector<EquilibriumStudyRow> rows;
  for (const Variant& variant : variants_) {
    const PressResponse response = response_in(folder / variant.name);
    for (const double depth : verdict_depths(variant.setup.protocol.depth)) {
      const double force = force_at(response, depth);
      const double error = force / force_at(reference, depth) - 1.0;
      rows.push_back({std::string(lattice::name(variant.setup.lattice.model)),
                      variant.setup.lattice.spacing, depth, force, error});
    }
  }
  meshes::write_rows(rows, folder / "equilibrium_study.csv");
}

nlohmann::ordered_json EquilibriumStudy::hookean_errors(const std::filesystem::path& folder,
                                                        const PressResponse& reference) const {
  const Variant& own = variants_.front();
  return force_errors(response_in(folder / own.name), reference, own.setup.protocol.depth);
}

}  // namespace fingertip::studies
