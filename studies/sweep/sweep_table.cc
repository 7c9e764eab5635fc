#include "studies/sweep/sweep_table.h"

#include <fstream>
#include <map>
#include <ostream>
#include <set>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "meshes/files.h"
#include "studies/config/loader.h"
#include "studies/run/cache.h"
#include "studies/run/json_file.h"
#include "studies/sweep/sweep_run.h"

namespace fingertip::studies {

namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

struct Row {
  std::string id, status;
  std::vector<std::string> settings;     ///< in the order of the axes
  std::map<std::string, double> values;  ///< numbers of summary.json
};

/// Quoted where a comma, a quote or a line break needs it (RFC 4180).
std::string cell(const std::string& text) {
  if (text.find_first_of(",\"\n") == text.npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + '"';
}

void flatten(const ordered_json& node, const std::string& prefix, Row& row) {
  for (const auto& [name, value] : node.items()) {
    if (value.is_object()) flatten(value, prefix + name + ".", row);
    if (value.is_number()) row.values[prefix + name] = value.get<double>();
  }
}

std::string status_in(const fs::path& point) {
  if (!fs::exists(point / marker_name)) return "missing";
  return read_json(point / marker_name).value("status", "missing");
}

/// A text of TOML without its quotes.
std::string bare(const std::string& literal) {
  const bool quoted = literal.size() >= 2 && literal.front() == '"' && literal.back() == '"';
  return quoted ? literal.substr(1, literal.size() - 2) : literal;
}

Row read_row(const ordered_json& point, const ordered_json& axes, const fs::path& folder) {
  Row row;
  row.id = point["id"];
  row.status = status_in(folder / row.id);
  for (const auto& axis : axes) {
    row.settings.push_back(bare(point["settings"][axis.get<std::string>()]));
  }
  const fs::path summary = folder / row.id / "summary.json";
  if (row.status == finished && fs::exists(summary)) flatten(read_json(summary), "", row);
  return row;
}

void write_head(const ordered_json& axes, std::ostream& out) {
  for (const auto& axis : axes) out << ',' << cell(axis.get<std::string>());
}

void write_table(const std::vector<Row>& rows, const ordered_json& axes, const fs::path& file) {
  std::set<std::string> columns;
  for (const Row& row : rows) {
    for (const auto& [name, value] : row.values) columns.insert(name);
  }
  meshes::write_atomically(file, [&](std::ostream& out) {
    out << "point,status";
    write_head(axes, out);
    for (const std::string& name : columns) out << ',' << cell(name);
    out << '\n';
    for (const Row& row : rows) {
      out << row.id << ',' << cell(row.status);
      for (const std::string& value : row.settings) out << ',' << cell(value);
      for (const std::string& name : columns) {
        const auto found = row.values.find(name);
        out << ',' << (found == row.values.end() ? "" : meshes::to_text(found->second));
      }
      out << '\n';
    }
  });
}

void write_curves(const std::vector<Row>& rows, const ordered_json& axes, const fs::path& folder) {
  bool headed = false;
  std::string text;
  for (const Row& row : rows) {
    std::ifstream in(folder / "points" / row.id / "response.csv");
    std::string line, front = row.id;
    for (const std::string& value : row.settings) front += ',' + cell(value);
    if (row.status != finished || !std::getline(in, line)) continue;
    if (!headed) {
      text = "point";
      for (const auto& axis : axes) text += ',' + cell(axis.get<std::string>());
      text += ',' + line + '\n';
      headed = true;
    }
    while (std::getline(in, line)) text += front + ',' + line + '\n';
  }
  if (headed) {
    meshes::write_atomically(folder / "curves.csv", [&](std::ostream& out) { out << text; });
  }
}

}  // namespace

SweepCensus collect(const fs::path& folder) {
  if (!fs::exists(folder / sweep_file)) {
    throw ConfigError({{"--collect " + folder.string(), "", "", "is not the folder of a sweep",
                        "give what sweep --out has written to"}});
  }
  const ordered_json sweep = read_json(folder / sweep_file);
  std::vector<Row> rows;
  SweepCensus census;
  for (const auto& point : sweep["points"]) {
    rows.push_back(read_row(point, sweep["axes"], folder / "points"));
    ++census.points;
    if (rows.back().status == finished) {
      ++census.finished;
    } else if (rows.back().status != "missing") {
      ++census.failed;
    }
  }
  write_table(rows, sweep["axes"], folder / "table.csv");
  write_curves(rows, sweep["axes"], folder);
  return census;
}

}  // namespace fingertip::studies
