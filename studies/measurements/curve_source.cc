#include "studies/measurements/curve_source.h"

#include <fmt/format.h>

#include <set>

#include "calibration/files/toml_file.h"

namespace fingertip::studies::inline measurements {

namespace {

namespace fs = std::filesystem;
using std::string_view;

/// A column's name and the SI unit of what stands in it.
struct KnownColumn {
  const char *quantity, *unit, *example;
  bool has_zero = true;

  std::set<string_view> further() const {
    return has_zero ? std::set<string_view>{"zero"} : std::set<string_view>();
  }
};
constexpr KnownColumn known_columns[] = {{"position", "m", "mm"},
                                         {"indentation", "m", "mm"},
                                         {"force", "N", "N"},
                                         {"time", "s", "s", false},
                                         {"sigma", "N", "N", false}};

const std::set<string_view> shared_press_keys = {
    "condition", "block",       "separator", "decimal", "skip",  "header", "rows",
    "force",     "indentation", "position",  "time",    "sigma", "finger", "use"};

void add_press(const TestTable& press, std::vector<CurveSource>& sources) {
  CurveSource source;
  source.layout = layout_of(press);
  source.rows = press.pair("rows");
  source.block = std::size_t(press.whole("block", 0, 1, 1000000));
  source.condition = press.text("condition").value_or("");
  source.rigid = press.word<bool>("finger", {{"soft", false}, {"rigid", true}}, false);
  source.predicted = press.word<bool>("use", {{"fit", false}, {"predict", true}}, false);
  if (source.rigid && source.predicted)
    press.refuse("use", "predict", "a rigid blank tells the machine, and no fit foretells it",
                 "leave use out");
  for (const KnownColumn& known : known_columns)
    if (known.quantity == string_view("sigma") && press.is_text(known.quantity))
      source.sigma = *press.quantity(known.quantity, known.unit, "0.01 N");
    else if (const auto table = press.table(known.quantity))
      source.columns.push_back(
          described_column(*table, known.quantity, known.unit, known.example, known.further()));
  if (press.has("position") && press.has("indentation"))
    press.refuse("indentation", "", "beside position", "leave one of the two out");
  if (source.columns.empty() && !source.layout.has_names)
    press.refuse("header", "false", "without a header the columns must be numbered",
                 "write e.g. position = {column = 1, unit = \"mm\"}, and force alike");
  if (!source.columns.empty() &&
      ((!press.has("position") && !press.has("indentation")) || !press.has("force")))
    press.refuse("force", "", "a press needs a force, and a position or an indentation",
                 "give both, or neither where the file names them itself");
  const std::vector<fs::path> paths = press.paths("path");
  const auto name = press.text("name");
  for (const fs::path& path : paths) {
    source.path = path;
    source.name = name && paths.size() == 1 ? *name
                  : name                    ? *name + " " + path.stem().string()
                                            : path.stem().string();
    sources.push_back(source);
  }
}

}  // namespace

std::vector<CurveSource> curve_sources(const fs::path& entry) {
  if (entry.extension() != ".toml") return {{entry, entry.stem().string()}};
  const toml::table root = calibration::parsed_toml(entry, "mend the file");
  const TestTable whole(entry, root, "");
  whole.check_keys({"data", "press"});
  std::vector<CurveSource> sources;
  each_table(entry, root, "press", "path", shared_press_keys,
             [&](const TestTable& press) { add_press(press, sources); });
  return sources;
}

}  // namespace fingertip::studies::inline measurements
