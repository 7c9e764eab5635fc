#include "studies/presses/taxel_record.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "lattice/model/plane.h"
#include "meshes/press/markers.h"
#include "meshes/press/press_response.h"
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

/// Empty of a folder without one: a field that nobody has judged.
std::vector<double> pressure_errors(const fs::path& folder) {
  const fs::path table = folder / "response.csv";
  if (!fs::exists(table)) return {};
  std::vector<double> errors;
  const auto response = meshes::PressResponse::read_csv(table);
  for (const meshes::PressSample& sample : response.samples())
    errors.push_back(sample.pressure_error);
  return errors;
}

std::vector<TaxelRow> write_taxels(const std::vector<ContactPoint>& field, const fs::path& folder,
                                   const lattice::PressSetup& setup, FieldOf model) {
  fs::remove(folder / "taxels.csv");
  const meshes::TaxelSkin& skin = setup.hardware.skin;
  if (skin.taxels.empty() || field.empty()) return {};
  const auto axes =
      lattice::field_axes(lattice::press_plane(setup.protocol, setup.geometry).normal);
  const auto rows = taxel_rows(
      field, skin, axes.transpose(),
      {pressure_errors(folder), model == FieldOf::lattice ? setup.lattice.spacing : 0.0});
  meshes::write_rows(rows, folder / "taxels.csv");
  return rows;
}

}  // namespace

void write_taxels(const fs::path& folder, const lattice::PressSetup& setup, FieldOf model) {
  write_taxels(field_in(folder), folder, setup, model);
}

std::vector<TaxelRow> write_contact_files(const fs::path& folder, const lattice::PressSetup& setup,
                                          FieldOf model) {
  const std::vector<ContactPoint> field = field_in(folder);
  write_contact_frames(field, folder);
  return write_taxels(field, folder, setup, model);
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

std::string marker_words(const fs::path& folder) {
  if (!fs::exists(folder / "markers.csv")) return "";
  const auto rows = meshes::read_rows<meshes::MarkerRow>(folder / "markers.csv");
  if (rows.empty()) return "";
  const auto last = meshes::samples_of(rows).back();
  const auto moved = [](const meshes::MarkerRow& row) { return row.displacement.norm(); };
  const auto& length = shown_units().length;
  const meshes::MarkerRow& most = *std::ranges::max_element(last, {}, moved);
  std::string words =
      fmt::format("{} markers at {}: {} at most (marker {})", last.size(),
                  length.text(most.indentation), length.text(moved(most)), most.marker);
  const double error = std::ranges::max_element(last, {}, &meshes::MarkerRow::error)->error;
  if (std::isfinite(error)) words += fmt::format(", off by up to {}", length.text(error));
  return words;
}

std::string footprint_note(const std::vector<TaxelRow>& rows, double footprint) {
  if (rows.empty()) return "";
  const double spacing = meshes::coarsest_spacing(meshes::samples_of(rows).back());
  if (!(footprint < spacing)) return "";
  const auto& length = shown_units().length;
  return fmt::format(
      "sensor.footprint = {} is finer than the field, which tells places {} apart: what a taxel "
      "reads is interpolated; take a wider footprint or a finer grid or mesh",
      length.text(footprint), length.text(spacing));
}

}  // namespace fingertip::studies::inline presses
