#include "studies/config/shapes/people_table.h"

#include "meshes/base/errors.h"
#include "studies/config/text/units.h"

namespace fingertip::studies::inline config::inline shapes {

using meshes::CsvTable;

void refuse_names(const CsvTable& table, const std::string& value, const std::string& rule,
                  const std::string& remedy) {
  throw meshes::InvalidInput(
      {table.file.string() + ":" + std::to_string(table.names_line), value, rule, remedy});
}

std::string write_names(const std::string& head) {
  return "write " + head + ", separated by commas, semicolons or tabs";
}

QuantityColumn quantity_column(const CsvTable& table, const std::string& symbol,
                               const std::string& si, const std::string& head) {
  for (const std::string& name : table.names) {
    if (!name.starts_with(symbol + " [") || !name.ends_with("]")) continue;
    const std::string unit = name.substr(symbol.size() + 2, name.size() - symbol.size() - 3);
    try {
      return {name, parse_quantity("1 " + unit, si, "1 " + si)};
    } catch (const UnitError& error) {
      refuse_names(table, name, error.rule, "write e.g. " + head);
    }
  }
  return {};
}

QuantityColumn length_column(const CsvTable& table, const std::string& symbol,
                             const std::string& head) {
  const QuantityColumn column = quantity_column(table, symbol, "m", head);
  if (column.name.empty())
    refuse_names(
        table, "",
        "the first line must name the column " + symbol + " with its unit of length in brackets",
        write_names(head));
  return column;
}

}  // namespace fingertip::studies::inline config::inline shapes
