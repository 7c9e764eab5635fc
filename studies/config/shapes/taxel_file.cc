#include "studies/config/shapes/taxel_file.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "meshes/base/files.h"
#include "studies/config/shapes/people_table.h"

namespace fingertip::studies::inline config::inline shapes {

using meshes::CsvTable;
using meshes::InvalidInput;
using meshes::Taxel;

namespace {

constexpr int usual_rings = 4, usual_per_ring = 8;
constexpr double usual_length = 0.1;  ///< over the finger's radius
constexpr long most_taxels = 10000;
constexpr double same_place = 1e-4;  ///< over the finger's radius
const std::string places_head = "x [mm],y [mm],z [mm]";

InvalidInput too_many(const std::string& value) {
  return InvalidInput({"sensor.taxels", value, "at most " + std::to_string(most_taxels) + " taxels",
                       "leave some out"});
}

/// Throws InvalidInput for an area that is none of a part of the surface [m²].
void check_area(double area, const meshes::Shape& shape) {
  if (!(area > 0.0 && std::isfinite(area)))
    throw InvalidInput({"sensor.taxels", "", "a taxel has x, y and z, and a positive area",
                        "fill in the number, or delete the line"});
  const double whole = shape.area(meshes::ProfileSurface::contact);
  if (area > whole)
    throw InvalidInput({"sensor.taxels", meshes::to_text(area) + " m^2",
                        "a taxel's area is part of the surface that may touch, which has " +
                            meshes::to_text(1e6 * whole) + " mm^2",
                        "check the unit of the column area, as in area [mm^2]"});
}

std::vector<Taxel> read_taxels(const std::filesystem::path& file, const meshes::Shape& shape,
                               double usual_area) {
  const CsvTable table = meshes::read_csv_of_people(file, separate_alike);
  if (long(table.rows.size()) > most_taxels) throw too_many(file.filename().string());
  std::vector<meshes::Vector3> places(table.rows.size());
  for (int axis = 0; axis < 3; ++axis) {
    const QuantityColumn column = length_column(table, std::string(1, "xyz"[axis]), places_head);
    const std::vector<double> numbers = table.numbers(column.name);
    for (std::size_t row = 0; row < places.size(); ++row)
      places[row][axis] = numbers[row] * column.unit;
  }
  const QuantityColumn area = quantity_column(table, "area", "m^2", places_head + ",area [mm^2]");
  const std::vector<double> areas = area.name.empty()
                                        ? std::vector<double>(places.size(), usual_area / area.unit)
                                        : table.numbers(area.name);
  std::vector<meshes::Violation> broken;
  std::vector<Taxel> taxels;
  std::vector<std::size_t> lines;  ///< where they stand
  for (std::size_t row = 0; row < places.size(); ++row) {
    const std::string place = file.string() + ":" + std::to_string(table.lines[row]);
    try {
      check_area(places[row].allFinite() ? areas[row] * area.unit : meshes::unknown, shape);
      Taxel taxel = taxel_at(shape, places[row]);
      taxel.area = areas[row] * area.unit;
      for (std::size_t i = 0; i < taxels.size(); ++i)
        if ((taxels[i].place - taxel.place).norm() < same_place * shape.largest_radius())
          throw InvalidInput({"sensor.taxels", "the place of line " + std::to_string(lines[i]),
                              "every taxel has a place of its own",
                              "move one of the two, or delete it"});
      taxels.push_back(taxel);
      lines.push_back(table.lines[row]);
    } catch (const InvalidInput& error) {
      broken.push_back(error.violations().front());
      broken.back().place = place;
    }
  }
  if (places.empty())
    broken.push_back({"sensor.taxels", file.filename().string(), "names no taxel",
                      "write a line for each below the names"});
  if (!broken.empty()) throw InvalidInput(broken);
  return taxels;
}

}  // namespace

void lay_taxels(const TaxelLayout& layout, const meshes::Geometry& finger,
                meshes::TaxelSkin& skin) {
  const double length = usual_length * finger.tip_radius;
  skin.footprint = layout.footprint.value_or(length);
  const auto shape = shape_of(finger);
  if (!layout.file.empty()) {
    skin.taxels =
        read_taxels(layout.file, *shape, 0.25 * std::numbers::pi * skin.footprint * skin.footprint);
  } else {
    const int rings = layout.rings > 0 ? layout.rings : usual_rings,
              per_ring = layout.per_ring > 0 ? layout.per_ring : usual_per_ring;
    if (long(rings) * per_ring > most_taxels)
      throw too_many(std::to_string(rings) + " rings of " + std::to_string(per_ring));
    skin.taxels = taxel_rings(*shape, rings, per_ring, layout.pitch.value_or(length));
  }
}

}  // namespace fingertip::studies::inline config::inline shapes
