#include "studies/config/shapes/profile_file.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <sstream>
#include <string>

#include "meshes/base/errors.h"
#include "meshes/press/fields.h"
#include "meshes/tables/csv_table.h"
#include "studies/config/shapes/people_table.h"

namespace fingertip::studies::inline config::inline shapes {
namespace {

using meshes::CsvTable;
using meshes::InvalidInput;
using meshes::ProfileCorner;
using meshes::ProfileCurve;

constexpr const char* head = "r [mm],z [mm],surface,curve";

[[noreturn]] void refuse(const CsvTable& table, std::size_t row, const std::string& value,
                         const std::string& rule, const std::string& remedy) {
  throw InvalidInput(
      {table.file.string() + ":" + std::to_string(table.lines[row]), value, rule, remedy});
}

/// The next word, which must be a number as a whole: of 0.12.5, where a comma stood for a blank, a
/// stream would make 0.12 and 0.5.
bool take_number(std::istream& words, double& number) {
  std::string word;
  if (!(words >> word)) return false;
  const char* const end = word.data() + word.size();
  const auto [stop, error] = std::from_chars(word.data(), end, number);
  return error == std::errc() && stop == end && std::isfinite(number);
}

}  // namespace

std::vector<ProfileCorner> read_profile(const std::filesystem::path& file) {
  const CsvTable table = meshes::read_csv_of_people(file, separate_alike);
  const QuantityColumn r = length_column(table, "r", head), z = length_column(table, "z", head);
  if (!table.has("surface"))
    refuse_names(table, "", "the first line must name the column surface", write_names(head));
  const std::vector<double> radii = table.numbers(r.name), heights = table.numbers(z.name);
  const std::vector<std::string> surfaces = table.texts("surface"), curves = table.texts("curve");
  std::vector<ProfileCorner> corners;
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    ProfileCorner corner;
    corner.r = radii[row] * r.unit, corner.z = heights[row] * z.unit;
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
      if (!take_number(words, corner.centre_r) || !take_number(words, corner.centre_z) ||
          words >> rest)
        refuse(table, row, curves[row], "an arc names its centre",
               "write arc R C, two numbers in the unit of the first line with a blank between");
      corner.centre_r *= r.unit, corner.centre_z *= z.unit;
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

}  // namespace fingertip::studies::inline config::inline shapes
