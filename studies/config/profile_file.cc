#include "studies/config/profile_file.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>

#include "meshes/csv_table.h"
#include "meshes/errors.h"
#include "meshes/fields.h"
#include "studies/config/trimmed.h"
#include "studies/config/units.h"

namespace fingertip::studies {
namespace {

using meshes::CsvTable;
using meshes::InvalidInput;
using meshes::ProfileCorner;
using meshes::ProfileCurve;

constexpr const char* head = "r [mm],z [mm],surface,curve";

/// The column `r [mm]` and metres per its unit.
struct LengthColumn {
  std::string name;
  double metres = 1.0;
};

LengthColumn length_column(const CsvTable& table, const std::string& symbol) {
  for (const std::string& name : table.names) {
    if (!name.starts_with(symbol + " [") || !name.ends_with("]")) continue;
    const std::string unit = name.substr(symbol.size() + 2, name.size() - symbol.size() - 3);
    try {
      return {name, parse_quantity("1 " + unit, "m", "1 mm")};
    } catch (const UnitError& error) {
      throw InvalidInput(
          {table.file.string(), name, error.rule, "write e.g. " + std::string(head)});
    }
  }
  throw InvalidInput(
      {table.file.string(), "",
       "the first line must name the column " + symbol + " with its unit of length in brackets",
       "write " + std::string(head)});
}

[[noreturn]] void refuse(const CsvTable& table, std::size_t row, const std::string& value,
                         const std::string& rule, const std::string& remedy) {
  throw InvalidInput(
      {table.file.string() + ":" + std::to_string(table.lines[row]), value, rule, remedy});
}

}  // namespace

std::vector<ProfileCorner> read_profile(const std::filesystem::path& file) {
  const CsvTable table = meshes::read_csv(file);
  const LengthColumn r = length_column(table, "r"), z = length_column(table, "z");
  if (!table.has("surface"))
    throw InvalidInput({file.string(), "", "the first line must name the column surface",
                        "write " + std::string(head)});
  const std::vector<double> radii = table.numbers(r.name), heights = table.numbers(z.name);
  const std::vector<std::string> surfaces = table.texts("surface"), curves = table.texts("curve");
  std::vector<ProfileCorner> corners;
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    ProfileCorner corner;
    corner.r = radii[row] * r.metres, corner.z = heights[row] * z.metres;
    if (std::isnan(corner.r) || std::isnan(corner.z))
      refuse(table, row, "", "a corner has r and z", "fill the empty cell");
    const auto known = values(meshes::ProfileSurface());
    const auto surface =
        std::ranges::find_if(known, [&](auto one) { return name(one) == surfaces[row]; });
    if (surface == known.end())
      refuse(table, row, surfaces[row], "a piece's surface is contact, bond, free or axis",
             "name what the piece from this corner to the next is");
    corner.surface = *surface;
    std::istringstream words(curves[row]);
    std::string kind, rest;
    words >> kind;
    if (kind == "arc") {
      corner.curve = ProfileCurve::arc;
      if (!(words >> corner.centre_r >> corner.centre_z) || words >> rest)
        refuse(table, row, curves[row], "an arc names its centre",
               "write arc R C, two numbers in the unit of the first line");
      corner.centre_r *= r.metres, corner.centre_z *= z.metres;
    } else if (kind == "spline") {
      corner.curve = ProfileCurve::spline;
      if (words >> rest) refuse(table, row, curves[row], "spline stands alone", "delete the rest");
    } else if (!kind.empty()) {
      refuse(table, row, curves[row], "a curve is empty (straight), arc R C or spline",
             "correct the cell");
    }
    corners.push_back(corner);
  }
  return corners;
}

}  // namespace fingertip::studies
