/// A finger as a law of pressure over penetration: files for simulators of rigid bodies that
/// overlap.
#pragma once

#include <string>
#include <vector>

#include "meshes/tables/file_fields.h"
#include "studies/exchange/contact_source.h"

namespace fingertip::studies::inline exchange {

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
FINGERTIP_FIELDS(PressureLawFile, finger, obstacle, contact, depth, stiffness, exponent, polynomial,
                 line, extent, hydroelastic_modulus, penetration, pressure);

/// Fits the laws to the first curve and judges them by all: pressure_law.json, pressure_table.csv.
/// Throws InvalidInput where that curve does not grow.
ContactExport pressure_law_export(const ContactSource& source);

/// The table as newton's pressure over signed distance, newton_finger.py. Throws
/// likewise.
ContactExport newton_export(const ContactSource& source);

}  // namespace fingertip::studies::inline exchange
