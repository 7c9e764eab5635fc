#include "studies/presses/taxel_record.h"

#include <fmt/format.h>

#include <algorithm>

#include "lattice/model/plane.h"
#include "meshes/tables/table_rows.h"
#include "studies/files/shown_units.h"
#include "studies/presses/pictures/contact_frames.h"

namespace fingertip::studies::inline presses {

namespace fs = std::filesystem;
using meshes::TaxelRow;

std::vector<TaxelRow> write_taxels(const fs::path& folder, const lattice::PressSetup& setup) {
  const fs::path table = folder / "taxels.csv", field = folder / "contact_field.csv";
  fs::remove(table);
  const meshes::TaxelSkin& skin = setup.hardware.skin;
  if (skin.taxels.empty() || !fs::exists(field)) return {};
  const auto axes =
      lattice::field_axes(lattice::press_plane(setup.protocol, setup.geometry).normal);
  const auto rows =
      taxel_rows(meshes::read_rows<meshes::ContactPoint>(field), skin, axes.transpose());
  meshes::write_rows(rows, table);
  return rows;
}

std::vector<TaxelRow> write_contact_files(const fs::path& folder,
                                          const lattice::PressSetup& setup) {
  write_contact_frames(folder);
  return write_taxels(folder, setup);
}

std::string taxel_words(const std::vector<TaxelRow>& rows) {
  if (rows.empty()) return "";
  const auto last = std::ranges::find(rows, rows.back().sample, &TaxelRow::sample);
  const std::span<const TaxelRow> here(last, rows.end());
  const TaxelRow& most = *std::ranges::max_element(here, {}, &TaxelRow::normal_stress);
  double force = 0.0;
  for (const TaxelRow& row : here) force += row.area * row.normal_stress;
  return fmt::format("{} taxels at {}: {} at most (taxel {}), together {}", here.size(),
                     shown_units().length.text(most.indentation),
                     shown_units().stress.text(most.normal_stress), most.taxel,
                     shown_units().force.text(force));
}

}  // namespace fingertip::studies::inline presses
