#include "studies/config/shapes/sensor_file.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>

#include "meshes/base/files.h"
#include "studies/config/shapes/people_table.h"

namespace fingertip::studies::inline config::inline shapes {

using meshes::CsvTable;
using meshes::InvalidInput;
using meshes::Taxel;
using meshes::Vector3;

namespace {

constexpr int usual_rings = 4, usual_per_ring = 8;
constexpr double usual_length = 0.1;  ///< over the finger's radius
constexpr double same_place = 1e-4;   ///< over the finger's radius
constexpr long most_taxels = 10000;
const std::string places_head = "x [mm],y [mm],z [mm]";

/// What lies at the places of a file.
struct Sensors {
  std::string key, one;  ///< "sensor.taxels", "taxel"
  long most = 0;

  InvalidInput too_many(const std::string& value) const {
    return InvalidInput(
        {key, value, "at most " + std::to_string(most) + " " + one + "s", "leave some out"});
  }
};
const Sensors taxel_sensors{"sensor.taxels", "taxel", most_taxels},
    marker_sensors{"sensor.markers", "marker", long(meshes::most_markers)};

/// Calls put(row, place) for the places [m] of a table, which tells where the sensor lies after
/// all. Throws InvalidInput with file and line for whatever it refuses, for cells without a number
/// and for two in one place.
void put_all(const CsvTable& table, const Sensors& sensors, const meshes::Shape& shape,
             const std::function<Vector3(std::size_t row, const Vector3& place)>& put) {
  const std::string name = table.file.filename().string();
  if (long(table.rows.size()) > sensors.most) throw sensors.too_many(name);
  std::vector<Vector3> places(table.rows.size());
  for (int axis = 0; axis < 3; ++axis) {
    const QuantityColumn column = length_column(table, std::string(1, "xyz"[axis]), places_head);
    const std::vector<double> numbers = table.numbers(column.name);
    for (std::size_t row = 0; row < places.size(); ++row)
      places[row][axis] = numbers[row] * column.unit;
  }
  std::vector<meshes::Violation> broken;
  std::vector<std::pair<Vector3, std::size_t>> taken;  ///< places and their lines
  for (std::size_t row = 0; row < places.size(); ++row) {
    try {
      if (!places[row].allFinite())
        throw InvalidInput({sensors.key, "", "a " + sensors.one + " has x, y and z",
                            "fill in the number, or delete the line"});
      const Vector3 place = put(row, places[row]);
      for (const auto& [other, line] : taken)
        if ((other - place).norm() < same_place * shape.largest_radius())
          throw InvalidInput({sensors.key, "the place of line " + std::to_string(line),
                              "every " + sensors.one + " has a place of its own",
                              "move one of the two, or delete it"});
      taken.emplace_back(place, table.lines[row]);
    } catch (const InvalidInput& error) {
      broken.push_back(error.violations().front());
      broken.back().place = table.file.string() + ":" + std::to_string(table.lines[row]);
    }
  }
  if (places.empty())
    broken.push_back(
        {sensors.key, name, "names no " + sensors.one, "write a line for each below the names"});
  if (!broken.empty()) throw InvalidInput(broken);
}

/// Throws InvalidInput for an area that is none of a part of the surface [m²].
void check_area(double area, const meshes::Shape& shape) {
  if (!(area > 0.0 && std::isfinite(area)))
    throw InvalidInput({"sensor.taxels", "", "a taxel has a positive area",
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
  const QuantityColumn area = quantity_column(table, "area", "m^2", places_head + ",area [mm^2]");
  const std::vector<double> areas =
      area.name.empty() ? std::vector<double>(table.rows.size(), usual_area / area.unit)
                        : table.numbers(area.name);
  std::vector<Taxel> taxels;
  put_all(table, taxel_sensors, shape, [&](std::size_t row, const Vector3& place) {
    check_area(areas[row] * area.unit, shape);
    taxels.push_back(taxel_at(shape, place));
    taxels.back().area = areas[row] * area.unit;
    return taxels.back().place;
  });
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
      throw taxel_sensors.too_many(std::to_string(rings) + " rings of " + std::to_string(per_ring));
    skin.taxels = taxel_rings(*shape, rings, per_ring, layout.pitch.value_or(length));
  }
}

std::vector<Vector3> lay_markers(const MarkerLayout& layout, const meshes::Geometry& finger) {
  if (layout.file.empty()) return {};
  const auto shape = shape_of(finger);
  if (layout.file == "grid")
    return marker_grid(*shape, layout.pitch.value_or(usual_length * finger.tip_radius),
                       layout.depth);
  std::vector<Vector3> markers;
  put_all(meshes::read_csv_of_people(layout.file, separate_alike), marker_sensors, *shape,
          [&](std::size_t, const Vector3& place) {
            markers.push_back(marker_at(*shape, place));
            return markers.back();
          });
  return markers;
}

}  // namespace fingertip::studies::inline config::inline shapes
