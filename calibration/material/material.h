/// Calibrated constants as they travel from one run to another: material.toml, and what to beware
/// of where it is used.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "lattice/press/press_setup.h"
#include "meshes/base/errors.h"
#include "meshes/press/press_protocol.h"
#include "meshes/rubber/rubber.h"
#include "meshes/shape/geometry.h"

namespace fingertip::calibration::inline material {

/// Where constants were fitted or checked. What is empty is unknown, or knows no bound.
struct Validity {
  std::optional<double> largest_indentation;  ///< [m], together with `thickness`
  std::optional<double> thickness;            ///< R - r of the finger it was found on [m]
  std::optional<double> rod_ratio;            ///< r/R of that finger, in (0, 1)
  /// Range of the spacing on that finger [m]; both or none.
  std::optional<double> smallest_spacing, largest_spacing;
  std::optional<double> smallest_poissons_ratio, largest_poissons_ratio;  ///< both or none
  std::optional<double> model_error;          ///< largest relative error of a force there, >= 0
  std::vector<meshes::ContactMode> contacts;  ///< of the curves fitted; none: found from moduli
};

/// SI.
struct Material {
  lattice::ModelKind model = lattice::ModelKind::hookean;  ///< any but published
  double spacing = 0.0;                                    ///< a at which the constants hold [m]
  /// At which the constants were found; unknown: small for hookean and central.
  std::optional<lattice::Kinematics> kinematics;
  /// Of the network, whose stiffness is the rubber's, hookean_constants of it.
  lattice::SpringConstants constants;
  double ligament_stiffness = 1.0;  ///< LatticeSettings::ligament_stiffness
  double contact_stiffness = 1.0;   ///< LatticeSettings::contact_stiffness
  meshes::Rubber rubber;            ///< the rubber they stand for
  /// Whether the rubber's own are known; if not, they are not written, and a press has its own.
  bool density_known = true, retardation_time_known = true;
  std::optional<meshes::Geometry> geometry;  ///< of the dome they were found on
  Validity validity;
  std::string provenance;  ///< how they were found and from what: "moduli", files with SHA-256
  std::string program;     ///< with its version; may be empty
  std::string date;        ///< may be empty
  /// Why the fit failed its own tests; empty: it passed them.
  std::string rejected;
  std::string statement;  ///< what they are good for, in words

  /// Every broken rule, with keys of material.toml: "constants.k1".
  std::vector<meshes::Violation> violations() const;
};

/// How a warning of a material or a law begins whose fit failed its own tests.
inline constexpr std::string_view failed_its_tests = "the fit failed its own tests: ";

/// The constants for another spacing [m], > 0: k ∝ a leaves the moduli (∝ k/a) as they are, and
/// kappa is a modulus itself.
lattice::SpringConstants at_spacing(const Material& material, double spacing);

/// Plain sentences on a material whose fit failed its own tests, and on what of `setup` lies
/// outside of where `material` was fitted: spacing (as a share of the thickness), thickness of the
/// rubber, kinematics, and where the setup's own rubber or ties are others than the material's. E
/// and G of setup.rubber count as what the user believes in, the stiffness being the material's.
/// Empty: nothing to beware of.
std::vector<std::string> lattice_warnings(const Material& material,
                                          const lattice::PressSetup& setup);

/// lattice_warnings, and those on how the lattice is pressed: depth (as a share of the thickness)
/// and contact.
std::vector<std::string> warnings(const Material& material, const lattice::PressSetup& setup);

/// material.toml: every quantity a string with its SI unit, "1.144 N/m", what has none a number.
/// Written atomically, reads back to the same bits; what is unknown is left out (and Rubber's
/// default when read), the network's constants too. Throws InvalidInput for a material that breaks
/// a rule, std::runtime_error when the file cannot be written.
void write_material_toml(const Material& material, const std::filesystem::path& file);

/// Reads material.toml; [validity] and what was added with it may be missing, as in files of
/// version 0.1 written before. Throws InvalidInput naming file, line and key for a file that
/// cannot be read or parsed, a missing or unknown key, a wrong unit or a value out of range.
Material read_material_toml(const std::filesystem::path& file);

}  // namespace fingertip::calibration::inline material
