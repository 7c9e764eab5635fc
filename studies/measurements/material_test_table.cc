#include "studies/measurements/material_test_table.h"

#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <set>
#include <utility>

#include "meshes/tables/csv_table.h"
#include "studies/measurements/curve_columns.h"

namespace fingertip::studies::inline measurements {

namespace fs = std::filesystem;
using calibration::StressMeasure;
using calibration::TestKind;
using std::string_view;

double StrainColumn::deformation(TestKind kind, double strain) const {
  switch (measure) {
    case StrainMeasure::engineering:
    case StrainMeasure::change: return 1.0 + strain;
    case StrainMeasure::logarithmic: return std::exp(strain);
    case StrainMeasure::displacement: return rest_of(kind) + strain / length;
    default: return strain;
  }
}

StrainColumn strain_column(const TestTable& test, TestKind kind, std::optional<double> length,
                           bool may_hold) {
  const TestTable table =
      needed(test, "strain",
             may_hold ? "strain = {value = 0.5, is = \"engineering\"}, or column = 2"
                      : "strain = {column = 1, is = \"stretch\"}");
  using enum StrainMeasure;
  std::vector<std::pair<string_view, StrainMeasure>> known;
  if (kind == TestKind::simple_shear)
    known = {{"shear", shear}, {"displacement", displacement}};
  else if (kind == TestKind::volumetric)
    known = {{"volume-ratio", ratio}, {"volume-change", change}};
  else
    known = {{"stretch", stretch},
             {"engineering", engineering},
             {"logarithmic", logarithmic},
             {"displacement", displacement}};
  StrainColumn result;
  result.measure = table.word("is", known);
  const std::string example = result.measure == displacement ? "mm" : "%";
  if (result.measure == displacement) {
    if (!length)
      test.refuse("length", "", "a displacement needs the length (or height) that it belongs to",
                  "write e.g. length = \"33 mm\"");
    result.length = *length;
  }
  if (may_hold && table.has("value")) {
    if (table.has("column"))
      table.refuse("value", "beside column", "a strain is a column or a value", "leave one out");
    table.check_keys({"value", "is", "unit", "sign"});
    const std::string unit = table.text("unit").value_or(result.measure == displacement ? "" : "1");
    const auto size = unit_size(unit, result.si());
    if (!size)
      table.refuse("unit", unit, "a strain has the unit 1 or %, a displacement one of length",
                   "write e.g. unit = \"" + example + "\"");
    result.value = sign_of(table) * *size * *table.number("value");
    return result;
  }
  result.described = described_column(table, "strain", result.si(), example, {"is", "zero"});
  const bool nominal =
      result.measure == engineering || result.measure == displacement || result.measure == shear;
  if (result.described.zero.by == ColumnZero::By::fit && !nominal)
    table.refuse("zero", "fit", "is sought of an engineering strain, a displacement or a shear",
                 "give the zero, or leave it out");
  return result;
}

StressColumn stress_column(const TestTable& test, std::optional<double> area) {
  const TestTable table =
      needed(test, "stress", "stress = {column = 2, is = \"nominal\", unit = \"kPa\"}");
  enum class Measure { nominal, cauchy, force, pressure };
  const Measure measure = table.word<Measure>("is", {{"nominal", Measure::nominal},
                                                     {"true", Measure::cauchy},
                                                     {"force", Measure::force},
                                                     {"pressure", Measure::pressure}});
  StressColumn result;
  if (measure == Measure::cauchy) result.measure = StressMeasure::cauchy;
  if (measure == Measure::force) {
    if (!area)
      test.refuse("area", "", "a force needs the area at rest that it acts on",
                  "write e.g. area = \"18 mm^2\", or diameter");
    result.area = area;
  }
  result.described = described_column(table, "stress", result.si(),
                                      measure == Measure::force ? "N" : "kPa", {"is", "zero"});
  if (measure == Measure::pressure) result.described.sign *= -1.0;
  return result;
}

DescribedRows described_rows(const FileText& text, const fs::path& file, TableLayout layout,
                             const TestColumns& columns, std::vector<std::string>& notes) {
  using calibration::CurveRow;
  constexpr const char* remedy = "compare the file with its [data] table";
  struct Wanted {
    const DescribedColumn* described;
    std::string si, example;
    double CurveRow::*number;
    ColumnUnit DescribedRows::*unit;
  };
  const StressColumn& stress = *columns.stress;
  std::vector<Wanted> wanted = {{&stress.described, stress.si(), stress.area ? "N" : "kPa",
                                 &CurveRow::y, &DescribedRows::stress}};
  if (!columns.strain->value)
    wanted.push_back({&columns.strain->described, columns.strain->si(), "mm", &CurveRow::x,
                      &DescribedRows::strain});
  if (columns.sigma != nullptr)
    wanted.push_back(
        {columns.sigma, stress.si(), wanted[0].example, &CurveRow::sigma, &DescribedRows::sigma});
  if (columns.time != nullptr)
    wanted.push_back({columns.time, "s", "s", &CurveRow::time, &DescribedRows::time});
  std::vector<std::string> names;
  for (const Wanted& each : wanted) names.push_back(each.described->column);
  DescribedColumns choose(names);
  if (choose.all_numbered()) layout.has_names = false;
  FileProblems problems(file);
  const TextTables found = tables_in(text.text, layout, std::ref(choose), problems);
  if (found.tables.empty()) choose.refuse(problems, remedy);
  if (found.tables.size() > 1)
    problems.add(found.tables[1].header_line, "", "", "a second table begins here",
                 "give each test a file of its own");
  problems.throw_if_any();
  std::vector<std::string> told = found.notes;
  const TextTable& table = found.tables.front();
  DescribedRows result;
  result.rows.resize(table.rows.size());
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    const Wanted& each = wanted[i];
    const TableTitle& title = table.titles[table.needed[i]];
    const std::string how = fmt::format("write e.g. {} = {{column = ..., unit = \"{}\"}}",
                                        each.described->quantity, each.example);
    const auto unit =
        unit_of(each.described, title, each.si, table.header_line, how, problems, told);
    const bool may_lack = each.si == "1" || each.si == "s";
    if (unit)
      result.*each.unit = *unit;
    else if (each.si == "1" && names_a_length(title))
      problems.add(table.header_line, title.written, "",
                   "the title names a length, which is a strain over the length at rest",
                   "write is = \"displacement\" with its unit, and the test's length = \"...\"; "
                   "where it is a strain, say so by unit = \"1\" or \"%\"");
    else if (may_lack)
      result.*each.unit = {each.si, each.described->scale * each.described->sign};
    else if (!title.unit || title.unit->empty())
      problems.add(table.header_line, title.written, "",
                   fmt::format("neither the file nor its description tells the unit of the {}",
                               each.described->quantity),
                   how);
  }
  problems.throw_if_any();
  for (const std::string& note : told) notes.push_back(file.filename().string() + ": " + note);
  for (std::size_t row = 0; row < result.rows.size(); ++row) {
    result.rows[row].line = table.lines[row];
    for (std::size_t i = 0; i < wanted.size(); ++i) {
      const std::size_t column = table.needed[i];
      const std::string& cell = table.rows[row][column];
      const double value = table.number(row, column).value_or(INFINITY);
      result.rows[row].*wanted[i].number = cell.empty() ? meshes::unknown : value;
      if (!cell.empty() && !(std::abs(value) <= meshes::largest_plausible))
        problems.add(table.lines[row], table.titles[column].written, shown(cell),
                     "must be a finite number, or nothing", remedy);
    }
  }
  problems.throw_if_any();
  return result;
}

}  // namespace fingertip::studies::inline measurements
