#include "studies/exchange/fmu_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <boost/algorithm/string/predicate.hpp>
#include <ostream>

#include "meshes/base/errors.h"
#include "meshes/base/files.h"
#include "studies/config/keys/key_table.h"
#include "studies/config/shapes/surface_cache.h"
#include "studies/exchange/texts/texts.h"
#include "studies/files/places.h"
#include "studies/files/process.h"
#include "studies/jobs/digest.h"
#include "studies/jobs/provenance.h"
#include "studies/presses/press_setup.h"

namespace fingertip::studies::inline exchange {

namespace fs = std::filesystem;

namespace {

constexpr const char* identifier = "fingertip_fmu";  ///< of the shared object

/// Sections that a finger depends on which somebody else moves.
constexpr std::array sections_of_a_finger = {"geometry", "rubber", "lattice",  "rod",
                                             "sensor",   "press",  "obstacle", "run"};

/// The file that a key names, absolute; empty where it names none.
fs::path file_of(const Config& config, const std::string& key) {
  if (key == "geometry.profile") return config.profile;
  if (key == "geometry.file") return config.solid.file;
  if (key == "lattice.constants") return config.constants_file;
  if (key == "rubber.card") return config.card;
  if (key == "sensor.taxels") return config.taxels.file;
  return {};
}

/// As it lies in the unit: of a CAD solid its triangles, for which no other program is needed.
FmuExport::File packed(const fs::path& file, const std::string& up) {
  if (!is_solid_file(file) || boost::iequals(file.extension().string(), ".stl"))
    return {file, file.filename().string()};
  return {triangulated(file, up), file.stem().string() + ".stl"};
}

/// What was given, with its files beside it.
std::string settings_of(const LoadedConfig& loaded, std::vector<FmuExport::File>& files) {
  std::string text;
  for (const char* section : sections_of_a_finger) {
    std::string keys;
    for (const Key& key : key_table()) {
      const Entry& entry = loaded.entries.at(key.full_name());
      const bool spacing = key.full_name() == "lattice.spacing";
      if (key.section != section || !(entry.given || spacing) || key.full_name() == "press.mode")
        continue;
      std::string literal = entry.literal;
      // The lattice that is told stays.
      if (spacing && loaded.config.automatic_spacing)
        literal = fmt::format("\"tip_radius/{:.0f}\"", *loaded.config.spacing_divisor);
      if (const fs::path file = file_of(loaded.config, key.full_name()); !file.empty()) {
        files.push_back(packed(file, loaded.config.solid.up));
        // Another folder may have a file of that name.
        if (std::ranges::count(files, files.back().name, &FmuExport::File::name) > 1)
          files.back().name.insert(0, key.name + "_");
        literal = '"' + files.back().name + '"';
      }
      keys += key.name + " = " + literal + "\n";
    }
    if (!keys.empty()) text += fmt::format("[{}]\n{}\n", section, keys);
  }
  return text;
}

std::string description_of(const FmuExport& unit) {
  std::string variables, outputs;
  for (std::size_t i = 0; i < unit.variables.size(); ++i) {
    const FmuVariable& variable = unit.variables[i];
    variables += fmt::format(
        "    <ScalarVariable name=\"{}\" valueReference=\"{}\" causality=\"{}\" "
        "variability=\"continuous\" description=\"{}\"><Real unit=\"{}\"{}/></ScalarVariable>\n",
        variable.name, i, variable.input ? "input" : "output", variable.description, variable.unit,
        variable.input ? " start=\"0\"" : "");
    if (!variable.input) outputs += fmt::format("      <Unknown index=\"{}\"/>\n", i + 1);
  }
  return filled("modelDescription.xml",
                fmt::arg("guid", sha256(unit.settings + program_version()).substr(0, 32)),
                fmt::arg("version", program_version()), fmt::arg("identifier", identifier),
                fmt::arg("period", meshes::to_text(unit.period)), fmt::arg("variables", variables),
                fmt::arg("outputs", outputs));
}

void copy_to(const fs::path& file, const fs::path& to) {
  std::error_code failure;
  fs::copy_file(file, to, fs::copy_options::overwrite_existing, failure);
  if (failure)
    throw meshes::InvalidInput({file.string(), failure.message(), "must be there and readable",
                                "./fingertip export builds what it needs"});
}

}  // namespace

FmuExport fmu_export(const LoadedConfig& loaded) {
  FmuExport unit;
  unit.settings = settings_of(loaded, unit.files);
  lattice::PressSetup setup = press_setup(loaded);
  unit.period = setup.controller.period;
  unit.variables = fmu_variables(setup.hardware.skin.taxels.size());
  unit.description = description_of(unit);
  return unit;
}

std::string fmu_readme(const FmuExport& unit) {
  std::string variables;
  for (const FmuVariable& variable : unit.variables)
    variables +=
        fmt::format("| `{}` | {} | {} | {} |\n", variable.name, variable.input ? "input" : "output",
                    variable.unit, variable.description);
  return filled("fmu_readme.txt", fmt::arg("period", meshes::to_text(unit.period)),
                fmt::arg("variables", variables));
}

void write_fmu(const FmuExport& unit, const fs::path& folder) {
  const fs::path zip = program_on_path("zip");
  if (zip.empty())
    throw meshes::InvalidInput({"zip", "not found", "packs the unit", "install Debian's zip"});
  const fs::path content = folder / "content", resources = content / "resources",
                 binaries = content / "binaries/linux64";
  fs::create_directories(resources);
  fs::create_directories(binaries);
  const auto write = [](const fs::path& file, const std::string& text) {
    meshes::write_atomically(file, [&](std::ostream& out) { out << text; });
  };
  write(content / "modelDescription.xml", unit.description);
  write(resources / fmu_settings, unit.settings);
  for (const FmuExport::File& file : unit.files) copy_to(file.source, resources / file.name);
  const std::string program = std::string(identifier) + ".so";
  copy_to(passed_on(program), binaries / program);
  Command pack{
      {zip.string(), "-q", "-X", "-r", (fs::absolute(folder) / "finger.fmu").string(), "."}, {}};
  pack.folder = content;
  fs::remove(folder / "finger.fmu");
  if (run_process(pack, folder / "zip.log") != 0)
    throw meshes::InvalidInput(
        {"zip", (folder / "zip.log").string(), "could not pack the unit", "see its log"});
  fs::remove_all(content);
  fs::remove(folder / "zip.log");
}

}  // namespace fingertip::studies::inline exchange
