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

namespace {

using meshes::ContactPoint;

/// Nothing where no point touched.
std::vector<ContactPoint> field_in(const fs::path& folder) {
  const fs::path table = folder / "contact_field.csv";
  return fs::exists(table) ? meshes::read_rows<ContactPoint>(table) : std::vector<ContactPoint>();
}

std::vector<TaxelRow> write_taxels(const std::vector<ContactPoint>& field, const fs::path& folder,
                                   const lattice::PressSetup& setup) {
  fs::remove(folder / "taxels.csv");
  const meshes::TaxelSkin& skin = setup.hardware.skin;
  if (skin.taxels.empty() || field.empty()) return {};
  const auto axes =
      lattice::field_axes(lattice::press_plane(setup.protocol, setup.geometry).normal);
  const auto rows = taxel_rows(field, skin, axes.transpose());
  meshes::write_rows(rows, folder / "taxels.csv");
  return rows;
}

}  // namespace

void write_taxels(const fs::path& folder, const lattice::PressSetup& setup) {
  write_taxels(field_in(folder), folder, setup);
}

std::vector<TaxelRow> write_contact_files(const fs::path& folder,
                                          const lattice::PressSetup& setup) {
  const std::vector<ContactPoint> field = field_in(folder);
  write_contact_frames(field, folder);
  return write_taxels(field, folder, setup);
}

std::string taxel_words(const std::vector<TaxelRow>& rows) {
  if (rows.empty()) return "";
  const auto last = meshes::samples_of(rows).back();
  const TaxelRow& most = *std::ranges::max_element(last, {}, &TaxelRow::normal_stress);
  return fmt::format("{} taxels at {}: {} at most (taxel {}), together {}", last.size(),
                     shown_units().length.text(most.indentation),
                     shown_units().stress.text(most.normal_stress), most.taxel,
                     shown_units().force.text(felt_force(last)));
}

}  // namespace fingertip::studies::inline presses
