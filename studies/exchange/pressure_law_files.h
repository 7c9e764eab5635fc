/// A finger as a law of pressure over penetration: files for simulators of rigid bodies that
/// overlap.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "meshes/file_fields.h"
#include "studies/exchange/contact_curves.h"

namespace fingertip::studies {

/// A force at one of five depths, beside what each law makes of it; SI. NaN: not known.
struct TransferDepthEntry {
  double indentation = meshes::unknown, force = meshes::unknown, force_error = meshes::unknown;
  double table_error = meshes::unknown, power_error = meshes::unknown,
         polynomial_error = meshes::unknown, line_error = meshes::unknown;  ///< relative
};
constexpr auto fields_of(const TransferDepthEntry*) {
  using Whole = TransferDepthEntry;
  return meshes::named(
      "indentation force force_error table_error power_error polynomial_error line_error",
      &Whole::indentation, &Whole::force, &Whole::force_error, &Whole::table_error,
      &Whole::power_error, &Whole::polynomial_error, &Whole::line_error);
}

/// One obstacle.
struct TransferObstacleEntry {
  std::string obstacle;
  bool fitted = false;
  std::vector<TransferDepthEntry> depths;
};
constexpr auto fields_of(const TransferObstacleEntry*) {
  using Whole = TransferObstacleEntry;
  return meshes::named("obstacle fitted depths", &Whole::obstacle, &Whole::fitted, &Whole::depths);
}

/// transfer.json
struct TransferFile {
  std::string format, how;
  std::vector<std::string> lost;
  std::vector<TransferObstacleEntry> obstacles;

  /// Largest magnitude over the depths of the fitted obstacle, or of the others.
  double worst(double TransferDepthEntry::*error, bool fitted) const;
};
constexpr auto fields_of(const TransferFile*) {
  using Whole = TransferFile;
  return meshes::named("format how lost obstacles", &Whole::format, &Whole::how, &Whole::lost,
                       &Whole::obstacles);
}

/// pressure_law.json: p in Pa over d in m.
struct PressureLawFile {
  std::string finger, obstacle, contact;
  double depth = meshes::unknown;      ///< up to which it was fitted [m]
  double stiffness = meshes::unknown;  ///< of p = stiffness d^exponent
  double exponent = meshes::unknown;
  std::vector<double> polynomial;                 ///< of d, d², d³
  double line = meshes::unknown;                  ///< of p = line d
  double extent = meshes::unknown;                ///< radius of the pole [m]
  double hydroelastic_modulus = meshes::unknown;  ///< line times extent [Pa]
  std::vector<double> penetration, pressure;      ///< the table
};
constexpr auto fields_of(const PressureLawFile*) {
  using Whole = PressureLawFile;
  return meshes::named(
      "finger obstacle contact depth stiffness exponent polynomial line extent "
      "hydroelastic_modulus penetration pressure",
      &Whole::finger, &Whole::obstacle, &Whole::contact, &Whole::depth, &Whole::stiffness,
      &Whole::exponent, &Whole::polynomial, &Whole::line, &Whole::extent,
      &Whole::hydroelastic_modulus, &Whole::penetration, &Whole::pressure);
}

struct PressureLawExport {
  PressureLawFile law;
  TransferFile transfer;
};

/// Fits the laws to the first curve and judges them by all. Throws InvalidInput where that curve
/// does not grow.
PressureLawExport pressure_law_export(const LoadedConfig& loaded,
                                      const std::vector<ContactCurve>& curves,
                                      const std::vector<Problem>& lost);

/// Writes pressure_law.json, pressure_table.csv, transfer.json and README.md.
void write_pressure_law(const PressureLawExport& made, const std::filesystem::path& folder);

}  // namespace fingertip::studies
