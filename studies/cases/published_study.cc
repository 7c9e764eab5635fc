#include "studies/cases/published_study.h"

#include <cmath>

#include <fmt/format.h>

#include "meshes/table_rows.h"
#include "studies/cases/force_errors.h"
#include "studies/files/run_tables.h"
#include "studies/report/run_data.h"
#include "studies/run/jobs.h"

namespace fingertip::studies {

using meshes::PressResponse;
using reporting::force_at;

PublishedStudy::PublishedStudy(const lattice::PressSetup& base) {
  const double radius = base.geometry.tip_radius;
  const auto with_spacing = [&](double spacing) {
    lattice::PressSetup setup = base;
    setup.lattice.spacing = spacing;
    setup.lattice.constants = lattice::published_constants(base.rubber, spacing);
    return setup;
  };
  add("spacing", "base", base, true);
  for (const int cells : {8, 10, 12, 14}) {
    const double spacing = radius / cells;
    const bool same = std::abs(spacing / base.lattice.spacing - 1.0) < 1e-9;
    const bool allowed = spacing <= 0.5 * base.geometry.thickness();
    if (!same && allowed) add("spacing", fmt::format("R{}", cells), with_spacing(spacing), false);
  }
  add("offset", "base", base, true);
  const std::vector<meshes::Vector3> offsets = {
      {0.5, 0.5, 0.0}, {0.0, 0.0, 0.5}, {0.5, 0.5, 0.5}, {0.25, 0.0, 0.5}};
  for (const meshes::Vector3& offset : offsets) {
    lattice::PressSetup setup = base;
    setup.lattice.offset = offset;
    add("offset", fmt::format("{}_{}_{}", offset.x(), offset.y(), offset.z()), setup, false);
  }
  add("ligament_stiffness", "base", base, true);
  for (const double factor : {0.1, 10.0}) {
    lattice::PressSetup setup = base;
    setup.lattice.ligament_stiffness = factor * base.lattice.ligament_stiffness;
    add("ligament_stiffness", fmt::format("x{}", factor), setup, false);
  }
}

void PublishedStudy::add(const std::string& varied, const std::string& label,
                         const lattice::PressSetup& setup, bool is_base) {
  variants_.push_back({varied,
                       is_base ? "published" : fmt::format("published_study/{}_{}", varied, label),
                       setup, is_base});
}

std::vector<PlannedJob> PublishedStudy::jobs() const {
  std::vector<PlannedJob> jobs;
  for (const Variant& variant : variants_) {
    if (!variant.is_base) jobs.push_back({variant.name, press_job(variant.setup), true});
  }
  return jobs;
}

void PublishedStudy::write_table(const std::filesystem::path& folder,
                                 const PressResponse& reference) const {
  std::vector<PublishedStudyRow> rows;
  for (const Variant& variant : variants_) {
    const auto file = folder / variant.name / "response.csv";
    const PressResponse response =
        std::filesystem::exists(file) ? PressResponse::read_csv(file) : PressResponse();
    const lattice::LatticeSettings& settings = variant.setup.lattice;
    for (const double depth : verdict_depths(variant.setup.protocol.depth)) {
      const double force = force_at(response, depth);
      const double error = force / force_at(reference, depth) - 1.0;
      rows.push_back({variant.varied, settings.spacing, settings.offset,
                      settings.ligament_stiffness, depth, force, error});
    }
  }
  meshes::write_rows(rows, folder / "published_study.csv");
}

}  // namespace fingertip::studies
