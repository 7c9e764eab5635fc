#include "studies/sweep/sweep_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <ostream>
#include <set>
#include <string>
#include <vector>

#include "meshes/tables/csv_table.h"
#include "meshes/tables/table_rows.h"
#include "studies/config/loader.h"
#include "studies/config/value_reader.h"
#include "studies/files/folder_reader.h"
#include "studies/files/mode_table.h"
#include "studies/jobs/cache.h"
#include "studies/jobs/result_files.h"
#include "studies/sweep/sweep_run.h"

namespace fingertip::studies::inline sweep {

namespace {

namespace fs = std::filesystem;

struct Row {
  std::string id, status;
  std::vector<std::string> settings;      ///< in the order of the axes
  std::map<std::string, double> values;   ///< numbers of summary.json
  std::map<std::string, double> answers;  ///< by column, see `answer_columns`
  meshes::CsvTable curve;                 ///< response.csv
};

/// Of the last row of response.csv, at the end of the press; from the fifth on those of a lateral
/// motion. At last the lowest frequency.
constexpr const char* answer_names[] = {
    "indentation [m]",          "normal_force [N]",    "force_error [N]",      "contact_radius [m]",
    "lateral_displacement [m]", "lateral_force_x [N]", "lowest_frequency [Hz]"};
constexpr std::size_t straight = 4, lateral = 6;

/// The columns in which some row has its answer, in the order in which they are shown.
std::vector<std::string> answer_columns(const std::vector<Row>& rows) {
  std::vector<std::string> columns;
  for (const char* name : answer_names)
    if (std::ranges::any_of(rows, [&](const Row& row) { return row.answers.contains(name); }))
      columns.emplace_back(name);
  return columns;
}

void flatten(const JsonEntry& node, const std::string& prefix, Row& row) {
  for (const auto& [name, value] : node.members()) {
    if (value.is_object()) flatten(value, prefix + name + ".", row);
    if (value.is_number()) row.values[prefix + name] = value.number();
  }
}

/// A curve whose cells are all numbers, or nothing.
meshes::CsvTable read_curve(const fs::path& file, FolderReader& reader) {
  if (reader.response(file).empty()) return {};
  return reader.attempt([&] {
    const meshes::CsvTable table = reader.csv(file);
    for (const std::string& name : table.names) table.numbers(name);
    return table;
  });
}

/// What the point was computed for: force and contact at the end, or the lowest frequency.
void read_answer(const fs::path& folder, Row& row, FolderReader& reader) {
  if (!row.curve.empty()) {
    const bool moved = row.curve.has(answer_names[straight]);  // along the plane
    for (std::size_t i = 0; i < (moved ? lateral : straight); ++i)
      if (const char* name = answer_names[i]; row.curve.has(name))
        row.answers[name] = row.curve.numbers(name).back();
  }
  const meshes::CsvTable modes = reader.csv(folder / "modes.csv");
  if (!modes.empty()) row.answers[answer_names[lateral]] = vibration_modes(modes).front().frequency;
  std::erase_if(row.answers, [](const auto& entry) { return std::isnan(entry.second); });
}

/// Empty: none is told. Throws InvalidInput for a word that no run ends with.
std::string known_status(const JsonEntry& marker) {
  const std::string status = text_if_any(marker, "status");
  const auto is = [&](const char* word) { return status.starts_with(word); };
  if (!status.empty() && status != finished && !is("not converged") && !is("failed"))
    marker.at("status").refuse("a run that ended is finished, not converged or failed");
  return status;
}

/// Everything of a point that can be read; a point with damaged files says so.
Row read_row(const JsonEntry& point, const std::vector<std::string>& axes, const fs::path& folder,
             FolderReader& reader) {
  Row row;
  row.id = text_at(point, "id");
  const JsonEntry settings = object_at(point, "settings");
  for (const std::string& axis : axes)
    row.settings.push_back(unquoted(text_if_any(settings, axis.c_str())));
  const std::size_t damage = reader.damage().size();
  const JsonEntry marker = reader.json(folder / row.id / marker_name);
  row.status = reader.attempt([&] { return known_status(marker); });
  if (row.status == finished) {
    const JsonEntry summary = reader.json(folder / row.id / "summary.json");
    reader.attempt([&] { flatten(summary, "", row); });
    row.curve = read_curve(folder / row.id / "response.csv", reader);
    reader.attempt([&] { read_answer(folder / row.id, row, reader); });
  }
  if (reader.damage().size() > damage)
    row.status = "damaged";
  else if (row.status.empty())
    row.status = "missing";
  return row;
}

void write_cells(const std::vector<std::string>& texts, std::ostream& out) {
  for (const std::string& text : texts) out << ',' << meshes::csv_cell(text);
}

std::string text_in(const std::map<std::string, double>& values, const std::string& name) {
  const auto found = values.find(name);
  return found == values.end() ? "" : meshes::to_text(found->second);
}

void write_table(const std::vector<Row>& rows, const std::vector<std::string>& axes,
                 const fs::path& file) {
  const std::vector<std::string> answers = answer_columns(rows);
  std::set<std::string> columns;
  for (const Row& row : rows) {
    for (const auto& [name, value] : row.values) columns.insert(name);
  }
  meshes::write_atomically(file, [&](std::ostream& out) {
    out << "point,status";
    write_cells(axes, out);
    write_cells(answers, out);
    for (const std::string& name : columns) out << ',' << meshes::csv_cell(name);
    out << '\n';
    for (const Row& row : rows) {
      out << row.id << ',' << meshes::csv_cell(row.status);
      write_cells(row.settings, out);
      for (const std::string& name : answers) out << ',' << text_in(row.answers, name);
      for (const std::string& name : columns) out << ',' << text_in(row.values, name);
      out << '\n';
    }
  });
}

/// The curves of all points. Cells are empty in columns that a point's own curve does not have.
void write_curves(const std::vector<Row>& rows, const std::vector<std::string>& axes,
                  const fs::path& file) {
  std::vector<std::string> columns;
  for (const Row& row : rows)
    for (const std::string& name : row.curve.names)
      if (std::ranges::find(columns, name) == columns.end()) columns.push_back(name);
  if (columns.empty()) return;
  meshes::write_atomically(file, [&](std::ostream& out) {
    out << "point";
    write_cells(axes, out);
    write_cells(columns, out);
    out << '\n';
    for (const Row& row : rows) {
      std::vector<std::vector<std::string>> cells;
      for (const std::string& name : columns) cells.push_back(row.curve.texts(name));
      for (std::size_t i = 0; i < row.curve.rows.size(); ++i) {
        out << row.id;
        write_cells(row.settings, out);
        for (const auto& column : cells) out << ',' << meshes::csv_cell(column[i]);
        out << '\n';
      }
    }
  });
}

/// For a terminal: the first rows with settings and answers.
std::string screen_text(const std::vector<Row>& rows, const std::vector<std::string>& axes) {
  constexpr std::size_t max_rows = 40;
  const std::vector<std::string> answers = answer_columns(rows);
  std::vector<std::vector<std::string>> cells;
  cells.push_back({"point", "status"});
  cells.back().insert(cells.back().end(), axes.begin(), axes.end());
  cells.back().insert(cells.back().end(), answers.begin(), answers.end());
  for (const Row& row : rows) {
    if (cells.size() > max_rows) break;
    cells.push_back({row.id, row.status.substr(0, row.status.find(':'))});
    cells.back().insert(cells.back().end(), row.settings.begin(), row.settings.end());
    for (const std::string& name : answers) {
      const auto found = row.answers.find(name);
      cells.back().push_back(found == row.answers.end() ? ""
                                                        : fmt::format("{:.5g}", found->second));
    }
  }
  std::string text;
  for (const auto& line : cells) {
    for (std::size_t c = 0; c < line.size(); ++c) {
      std::size_t width = 0;
      for (const auto& other : cells) width = std::max(width, other[c].size());
      text += fmt::format("{:<{}}", line[c], width + 2);
    }
    text.erase(text.find_last_not_of(' ') + 1);
    text += '\n';
  }
  if (rows.size() > max_rows) text += fmt::format("... {} more\n", rows.size() - max_rows);
  return text;
}

}  // namespace

SweepCensus collect(const fs::path& folder) {
  if (!fs::exists(folder / sweep_file)) {
    throw ConfigError({"", "", "is not the folder of a sweep",
                       "give what sweep --out has written to", "--collect " + folder.string()});
  }
  const JsonEntry sweep = read_entry(folder / sweep_file);
  std::vector<std::string> axes;
  for (const JsonEntry& axis : array_at(sweep, "axes")) axes.push_back(axis.text());
  FolderReader reader;
  std::vector<Row> rows;
  for (const JsonEntry& point : array_at(sweep, "points"))
    rows.push_back(read_row(point, axes, folder / "points", reader));
  write_curves(rows, axes, folder / "curves.csv");
  write_table(rows, axes, folder / "table.csv");
  SweepCensus census;
  census.points = rows.size();
  for (const Row& row : rows) {
    census.finished += row.status == finished ? 1 : 0;
    census.missing += row.status == "missing" ? 1 : 0;
    census.damaged += row.status == "damaged" ? 1 : 0;
  }
  census.damage = reader.damage();
  census.text = screen_text(rows, axes);
  return census;
}

}  // namespace fingertip::studies::inline sweep
