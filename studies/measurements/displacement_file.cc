#include "studies/measurements/displacement_file.h"

#include <fmt/format.h>

#include <toml++/toml.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>

#include "calibration/files/toml_file.h"
#include "meshes/tables/csv_table.h"
#include "studies/config/text/units.h"
#include "studies/measurements/description.h"

namespace fingertip::studies::inline measurements {

namespace {

namespace fs = std::filesystem;
using meshes::InvalidInput;
using meshes::Vector3;

constexpr std::array axes = {"x", "y", "z"};
constexpr const char* length_example = "mm";

/// A column and the SI unit of what stands in it.
struct WantedColumn {
  DescribedColumn described;
  std::string si;
  bool may_be_empty = false;
};

/// The columns of a table in SI, in the order wanted; empty cells are NaN.
struct ColumnNumbers {
  std::vector<std::vector<double>> columns;
  std::vector<std::size_t> lines;
  std::vector<std::string> notes;
  std::string sha256;

  Vector3 vector(std::size_t first, std::size_t row) const {
    return {columns[first][row], columns[first + 1][row], columns[first + 2][row]};
  }
};

/// SI over the numbers of a column; a count [1] needs no unit.
double factor_of(const WantedColumn& wanted, const TextTable& table, std::size_t column,
                 FileProblems& problems, std::vector<std::string>& notes) {
  const TableTitle& title = table.titles[column];
  const std::string how = fmt::format("write the unit into the title, as in {} [{}]",
                                      wanted.described.quantity, length_example);
  if (const auto unit =
          unit_of(&wanted.described, title, wanted.si, table.header_line, how, problems, notes))
    return unit->factor;
  if (wanted.si == "1") return wanted.described.scale * wanted.described.sign;
  if (!title.unit || title.unit->empty())
    problems.add(table.header_line, title.written, "",
                 "neither the file nor a description tells its unit", how);
  return meshes::unknown;
}

ColumnNumbers column_numbers(const fs::path& file, TableLayout layout,
                             const std::vector<WantedColumn>& wanted) {
  std::vector<std::string> names;
  for (const WantedColumn& each : wanted) names.push_back(each.described.column);
  DescribedColumns choose(names);
  if (choose.all_numbered()) layout.has_names = false;
  const FileText text = text_of(file);
  FileProblems problems(file);
  const TextTables found = tables_in(text.text, layout, std::ref(choose), problems);
  if (found.tables.empty()) choose.refuse(problems, "name the columns that the file has");
  problems.throw_if_any();
  const TextTable& table = found.tables.front();
  ColumnNumbers result;
  result.lines = table.lines;
  result.notes = found.notes;
  result.sha256 = text.sha256;
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    const std::size_t column = table.needed[i];
    const double factor = factor_of(wanted[i], table, column, problems, result.notes);
    std::vector<double>& values = result.columns.emplace_back();
    for (std::size_t row = 0; row < table.rows.size(); ++row) {
      const std::string& cell = table.rows[row][column];
      const bool missing = cell.empty() && wanted[i].may_be_empty;
      values.push_back(missing ? meshes::unknown
                               : factor * table.number(row, column).value_or(INFINITY));
      if (!missing && !(std::abs(values.back()) < meshes::largest_plausible) &&
          std::isfinite(factor))
        problems.add(table.lines[row], table.titles[column].written, shown(cell),
                     wanted[i].may_be_empty ? "must be a finite number, or nothing"
                                            : "must be a finite number",
                     "mend the cell, or delete the line");
    }
  }
  problems.throw_if_any();
  return result;
}

DisplacementFile file_with(const fs::path& entry, const ColumnNumbers& numbers) {
  DisplacementFile file;
  file.name = entry.stem().string();
  file.notes = numbers.notes;
  file.sha256 = numbers.sha256;
  return file;
}

/// Named as the quantity is.
WantedColumn named(const std::string& name, bool may_be_empty = false) {
  WantedColumn wanted;
  wanted.described.quantity = wanted.described.column = name;
  wanted.si = "m";
  wanted.may_be_empty = may_be_empty;
  return wanted;
}

/// Refuses two points of one place.
void check_places(const fs::path& file, const DisplacementFile& found,
                  const std::vector<std::size_t>& lines) {
  FileProblems problems(file);
  std::map<std::array<double, 3>, std::size_t> taken;
  for (std::size_t i = 0; i < found.places.size(); ++i) {
    const Vector3& at = found.places[i];
    const auto [other, is_new] = taken.try_emplace({at.x(), at.y(), at.z()}, lines[i]);
    if (!is_new)
      problems.add(lines[i], "", fmt::format("the place of line {}", other->second),
                   "every point has a place of its own", "delete one of the two");
  }
  problems.throw_if_any();
}

void sort_samples(const fs::path& file, DisplacementFile& found) {
  std::ranges::sort(found.samples, {}, &calibration::MeasuredDisplacements::indentation);
  const auto refuse = [&](const std::string& value, const std::string& rule,
                          const std::string& remedy) {
    throw InvalidInput({file.string(), value, rule, remedy});
  };
  if (found.samples.empty()) refuse("", "the file has no displacements", "give at least one load");
  for (std::size_t i = 0; i < found.samples.size(); ++i) {
    const double at = found.samples[i].indentation;
    if (!(at > 0.0))
      refuse(fmt::format("{} m", at), "an indentation is positive", "leave that load out");
    if (i > 0 && found.samples[i - 1].indentation == at)
      refuse(fmt::format("{} m", at), "two samples have this indentation", "leave one of them out");
  }
}

/// [x, y, z] of a table.
void add_columns(const TestTable& table, const std::string& si,
                 const std::array<const char*, 3>& keys, bool may_be_empty,
                 std::vector<WantedColumn>& wanted) {
  for (const char* const key : keys) {
    const auto own = table.table(key);
    if (!own)
      table.refuse(key, "", "is needed",
                   fmt::format("write e.g. {} = {{column = \"{}0\", unit = \"mm\"}}", key, key));
    wanted.push_back(
        {described_column(*own, key, si, si == "1" ? "1" : length_example), si, may_be_empty});
  }
}

/// Three lengths; none where the key is not there.
std::optional<Vector3> middle_of(const TestTable& whole, const toml::table& root) {
  const toml::node* const node = root.get("middle");
  if (node == nullptr) return {};
  const auto refuse = [&] {
    whole.refuse("middle", "", "must be three lengths, those of x, y and z",
                 "write e.g. middle = [\"0 mm\", \"0 mm\", \"40 mm\"]");
  };
  const toml::array* const list = node->as_array();
  if (list == nullptr || list->size() != 3) refuse();
  Vector3 middle;
  for (std::size_t axis = 0; axis < 3; ++axis) try {
      middle(Eigen::Index(axis)) =
          parse_quantity(list->at(axis).value_or(std::string()), "m", "40 mm");
    } catch (const UnitError&) {
      refuse();
    }
  return middle;
}

/// A sample of a description.
struct DescribedSample {
  double indentation = 0.0;
  bool displaced = false;  ///< displacements, not places
};

std::vector<DescribedSample> add_samples(const fs::path& entry, const toml::table& root,
                                         std::vector<WantedColumn>& wanted) {
  std::vector<DescribedSample> samples;
  each_table(
      entry, root, "sample", "indentation, x, y and z", {"indentation", "x", "y", "z", "is"},
      [&](const TestTable& table) {
        const auto depth = table.quantity("indentation", "m", "4 mm");
        if (!depth) table.refuse("indentation", "", "a sample needs it", "write e.g. \"4 mm\"");
        samples.push_back(
            {*depth, table.word<bool>("is", {{"place", false}, {"displacement", true}}, false)});
        add_columns(table, "m", axes, true, wanted);
      });
  return samples;
}

DisplacementFile read_described(const fs::path& entry) {
  const toml::table root = calibration::parsed_toml(entry, "mend the file");
  const TestTable whole(entry, root, "");
  whole.check_keys(
      {"path", "separator", "decimal", "skip", "header", "middle", "place", "grid", "sample"});
  const std::vector<fs::path> paths = whole.paths("path");
  if (paths.size() != 1)
    whole.refuse("path", "", "displacements stand in one table", "name one file");
  std::vector<WantedColumn> wanted;
  add_columns(needed(whole, "place", "[place], with x, y and z"), "m", axes, false, wanted);
  const auto grid = whole.table("grid");
  if (grid) add_columns(*grid, "1", {"i", "j", "k"}, false, wanted);
  const std::size_t first = wanted.size();
  const std::vector<DescribedSample> samples = add_samples(entry, root, wanted);
  const ColumnNumbers numbers = column_numbers(paths.front(), layout_of(whole), wanted);
  DisplacementFile found = file_with(entry, numbers);
  Vector3 mean = Vector3::Zero();
  for (std::size_t row = 0; row < numbers.lines.size(); ++row) {
    found.places.push_back(numbers.vector(0, row));
    mean += numbers.vector(0, row) / double(numbers.lines.size());
    if (grid) found.grid.push_back(numbers.vector(3, row));
  }
  for (std::size_t s = 0; s < samples.size(); ++s) {
    auto& sample = found.samples.emplace_back(samples[s].indentation);
    for (std::size_t row = 0; row < found.places.size(); ++row)
      sample.displacement.push_back(numbers.vector(first + 3 * s, row) -
                                    (samples[s].displaced ? Vector3::Zero() : found.places[row]));
  }
  check_places(paths.front(), found, numbers.lines);
  if (const auto middle = middle_of(whole, root))
    for (Vector3& place : found.places) place += *middle - mean;
  sort_samples(entry, found);
  return found;
}

/// Of a plain file: which of the two ways it has, by the titles of its first table.
std::optional<std::string> columns_in(const fs::path& file) {
  for (const std::string way : {"displacement", "moved"}) {
    std::vector<std::string> names{axes.begin(), axes.end()};
    for (const char* const axis : axes) names.push_back(way + "_" + axis);
    DescribedColumns choose(names);
    FileProblems ignored(file);
    if (!tables_in(text_of(file).text, {}, std::ref(choose), ignored).tables.empty()) return way;
  }
  return {};
}

DisplacementFile read_plain(const fs::path& file) {
  const std::string way = columns_in(file).value_or("displacement");
  std::vector<WantedColumn> wanted{named("indentation")};
  for (const char* const axis : axes) wanted.push_back(named(axis));
  for (const char* const axis : axes) wanted.push_back(named(way + "_" + axis, true));
  const ColumnNumbers numbers = column_numbers(file, {}, wanted);
  DisplacementFile found = file_with(file, numbers);
  std::map<std::array<double, 3>, std::size_t> known;
  std::map<double, std::map<std::size_t, Vector3>> loads;
  FileProblems problems(file);
  for (std::size_t row = 0; row < numbers.lines.size(); ++row) {
    const Vector3 place = numbers.vector(1, row);
    const auto [point, is_new] =
        known.try_emplace({place.x(), place.y(), place.z()}, found.places.size());
    if (is_new) found.places.push_back(place);
    const Vector3 seen = numbers.vector(4, row);
    if (!loads[numbers.columns[0][row]]
             .try_emplace(point->second, way == "moved" ? Vector3(seen - place) : seen)
             .second)
      problems.add(numbers.lines[row], "", "", "this point stands there twice under this load",
                   "delete one of the two lines");
  }
  problems.throw_if_any();
  for (const auto& [indentation, points] : loads) {
    auto& sample = found.samples.emplace_back(indentation);
    sample.displacement.assign(found.places.size(), Vector3::Constant(meshes::unknown));
    for (const auto& [point, displacement] : points) sample.displacement[point] = displacement;
  }
  sort_samples(file, found);
  return found;
}

}  // namespace

bool has_displacements(const fs::path& entry) {
  if (entry.extension() != ".toml") return columns_in(entry).has_value();
  return calibration::parsed_toml(entry, "mend the file").contains("place");
}

DisplacementFile read_displacements(const fs::path& entry) {
  return entry.extension() == ".toml" ? read_described(entry) : read_plain(entry);
}

std::vector<std::vector<Vector3>> fields_of(const std::vector<meshes::MarkerRow>& rows,
                                            const DisplacementFile& file) {
  std::vector<std::vector<Vector3>> fields(file.samples.size());
  for (std::size_t s = 0; s < fields.size(); ++s) {
    const double depth = file.samples[s].indentation;
    constexpr double same = 1e-6;
    for (const meshes::MarkerRow& row : rows)
      if (std::abs(row.indentation - depth) <= same * depth) fields[s].push_back(row.displacement);
    if (fields[s].size() != file.places.size()) fields[s].clear();
  }
  return fields;
}

}  // namespace fingertip::studies::inline measurements
