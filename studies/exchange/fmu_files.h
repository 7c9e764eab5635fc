/// The lattice as a functional mock-up unit (FMI 2.0, co-simulation): finger.fmu.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "studies/config/loader.h"
#include "studies/fmu/fmu_variables.h"

namespace fingertip::studies::inline exchange {

struct FmuExport {
  struct File {
    std::filesystem::path source;
    std::string name;  ///< beside the settings
  };
  std::string settings;     ///< parameters.toml among its resources
  std::string description;  ///< modelDescription.xml
  std::vector<File> files;  ///< that the settings name
  std::vector<FmuVariable> variables;
  double period = 0.0;  ///< of the control loop, the step that it suggests [s]
};

/// Of a finger that is pressed by whoever steps it. Throws ConfigError for what free_press refuses.
FmuExport fmu_export(const LoadedConfig& loaded);

std::string fmu_readme(const FmuExport& unit);
/// Writes finger.fmu, with `zip`. Throws InvalidInput where the program or the
/// shared object is missing.
void write_fmu(const FmuExport& unit, const std::filesystem::path& folder);

}  // namespace fingertip::studies::inline exchange
