#include "calibration/material/material.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "calibration/files/words.h"
#include "calibration/material/material_parameter.h"
#include "calibration/material/moduli.h"
#include "meshes/base/files.h"

namespace fingertip::calibration::inline material {
namespace {

using lattice::Kinematics;
using lattice::ModelKind;
using lattice::PressSetup;
using meshes::to_text;
using meshes::Violation;
using Sentences = std::vector<std::string>;

/// Collects broken rules.
class Rules {
 public:
  void require(bool holds, const char* key, double value, const char* rule,
               const char* remedy = "run calibrate again") {
    if (!holds) found.push_back({key, to_text(value), rule, remedy});
  }
  /// Both or none of a range, in order.
  void range(const std::optional<double>& smallest, const std::optional<double>& largest,
             const char* key) {
    if (!smallest && !largest) return;
    require(smallest && largest && *smallest <= *largest, key, largest.value_or(*smallest),
            "a range has a smallest and a largest value, in this order", "give both, or none");
  }
  std::vector<Violation> found;
};

void check_constants(Rules& rules, const Material& m) {
  const lattice::SpringConstants& c = m.constants;
  for (const auto& [key, k] :
       {std::pair("constants.k1", c.k1), {"constants.k2", c.k2}, {"constants.k3", c.k3}})
    rules.require(std::isfinite(k) && k >= 0.0, key, k, "a spring constant must not be negative");
  rules.require(std::isfinite(c.kappa) && (m.model == ModelKind::hookean || c.kappa == 0.0),
                "constants.kappa", c.kappa,
                "the central model has no volume constant, kappa must be 0");
  if (!rules.found.empty()) return;
  const ElasticModuli moduli = homogenised_moduli(c, m.spacing);
  rules.require(moduli.shear_modulus > 0.0 && moduli.c11 > moduli.c12 && moduli.bulk_modulus > 0.0,
                "constants.k1", c.k1,
                "the lattice must resist every deformation: G > 0, C11 > C12, K > 0");
}

void check_validity(Rules& rules, const Validity& v) {
  const auto positive = [&](const std::optional<double>& value, const char* key) {
    if (value)
      rules.require(std::isfinite(*value) && *value > 0.0, key, *value, "must be positive");
  };
  positive(v.largest_indentation, "validity.largest_indentation");
  positive(v.thickness, "validity.thickness");
  positive(v.smallest_spacing, "validity.smallest_spacing");
  positive(v.largest_spacing, "validity.largest_spacing");
  if (v.largest_indentation)
    rules.require(v.thickness && *v.largest_indentation < *v.thickness,
                  "validity.largest_indentation", *v.largest_indentation,
                  "must be less than validity.thickness", "give the thickness R - r, too");
  if (v.rod_ratio)
    rules.require(*v.rod_ratio > 0.0 && *v.rod_ratio < 1.0, "validity.rod_ratio", *v.rod_ratio,
                  "r/R must lie between 0 and 1", "give the rod's radius over the tip's");
  if (v.model_error)
    rules.require(std::isfinite(*v.model_error) && *v.model_error >= 0.0, "validity.model_error",
                  *v.model_error, "a relative error must not be negative",
                  "leave it out if it is unknown");
  rules.range(v.smallest_spacing, v.largest_spacing,
              v.largest_spacing ? "validity.largest_spacing" : "validity.smallest_spacing");
  rules.range(v.smallest_poissons_ratio, v.largest_poissons_ratio,
              v.largest_poissons_ratio ? "validity.largest_poissons_ratio"
                                       : "validity.smallest_poissons_ratio");
}

/// Equal but for the round-off of units.
bool same(double a, double b) {
  return std::abs(a - b) <= 1e-9 * std::max(std::abs(a), std::abs(b));
}

/// For people, who tell values apart by six digits.
std::string shown(double value) {
  return rounded(value, 6);
}

std::string tenths_of_percent(double share) {
  return shown(std::round(1e3 * share) / 10.0) + " %";
}

std::string between(double least, double most, const char* unit) {
  return same(least, most) ? shown(least) + unit : shown(least) + " to " + shown(most) + unit;
}

void warn_of_spacing(Sentences& found, const Validity& v, const PressSetup& setup) {
  if (!v.smallest_spacing || !v.largest_spacing) return;
  // What a lattice gets wrong depends on how many cells go through the rubber.
  const double scale = v.thickness ? setup.geometry.thickness() / *v.thickness : 1.0;
  const double least = scale * *v.smallest_spacing, most = scale * *v.largest_spacing;
  const double a = setup.lattice.spacing;
  if (a >= least * (1.0 - 1e-9) && a <= most * (1.0 + 1e-9)) return;
  found.push_back(
      "the spacing " + shown(a) + " m is not that of the fit (" + between(least, most, " m") +
      " on this finger): k1, k2, k3 are scaled with it, which keeps the moduli, but a fit to "
      "curves also makes good the error of its own grid, 1 to 3 % of the force at R/6 and R/8, 0.3 "
      "% at R/12, which does not scale; expect errors of that size, or calibrate at this spacing");
}

void warn_of_geometry(Sentences& found, const Validity& v, const PressSetup& setup) {
  const double ratio = setup.geometry.rod_radius / setup.geometry.tip_radius;
  if (v.rod_ratio && std::abs(ratio - *v.rod_ratio) > 0.01)
    found.push_back("the finger's r/R is " + shown(ratio) + " and the fit's " +
                    shown(*v.rod_ratio) +
                    ": its rubber is of another relative thickness, where these constants have "
                    "not been compared with anything");
}

/// The material's rules its lattice, so the user's are of no effect.
void warn_of_moduli(Sentences& found, const Material& material, const PressSetup& setup) {
  const meshes::Rubber &ours = material.rubber, &theirs = setup.rubber;
  if (!same(ours.youngs_modulus, theirs.youngs_modulus) ||
      !same(ours.shear_modulus, theirs.shear_modulus))
    found.push_back("the stiffness is the material's, E = " + shown(ours.youngs_modulus) +
                    " Pa and G = " + shown(ours.shear_modulus) +
                    " Pa; the press's own E = " + shown(theirs.youngs_modulus) +
                    " Pa and G = " + shown(theirs.shear_modulus) + " Pa have no effect");
  const Validity& v = material.validity;
  if (!v.smallest_poissons_ratio || !v.largest_poissons_ratio) return;
  const double nu = theirs.poissons_ratio();
  if (nu < *v.smallest_poissons_ratio - 1e-6 || nu > *v.largest_poissons_ratio + 1e-6)
    found.push_back("the press's Poisson's ratio " + shown(nu) +
                    " is not among those of the fit (" +
                    between(*v.smallest_poissons_ratio, *v.largest_poissons_ratio, "") +
                    "): the lattice keeps the material's");
}

void warn_of_differences(Sentences& found, const Material& material, const PressSetup& setup) {
  const auto compare = [&](const char* what, double ours, double theirs, const char* unit) {
    if (!same(ours, theirs))
      found.push_back(std::string(what) + " is " + shown(theirs) + unit +
                      " as configured, not the material's " + shown(ours) + unit);
  };
  if (material.density_known)
    compare("the rubber's density", material.rubber.density, setup.rubber.density, " kg/m^3");
  if (material.retardation_time_known)
    compare("the rubber's retardation time", material.rubber.retardation_time,
            setup.rubber.retardation_time, " s");
  compare("the factor on the bond", material.ligament_stiffness, setup.lattice.ligament_stiffness,
          "");
  compare("the factor on the contact", material.contact_stiffness, setup.lattice.contact_stiffness,
          "");
}

void warn_of_kinematics(Sentences& found, const Material& material, const PressSetup& setup) {
  if (!material.kinematics && material.model == ModelKind::network) return;
  const Kinematics known = material.kinematics.value_or(Kinematics::small);
  if (known == setup.lattice.kinematics) return;
  found.push_back("the constants were found at " + std::string(lattice::name(known)) +
                  " strain and are used at " +
                  std::string(lattice::name(setup.lattice.kinematics)) +
                  " strain: the moduli at rest are the same, forces of deep presses are not");
}

}  // namespace

std::vector<Violation> Material::violations() const {
  Rules rules;
  rules.require(std::isfinite(spacing) && spacing > 0.0, "lattice.spacing", spacing,
                "the spacing must be positive");
  for (const auto& [key, factor] : {std::pair("lattice.ligament_stiffness", ligament_stiffness),
                                    {"lattice.contact_stiffness", contact_stiffness}})
    rules.require(factor >= 1e-3 && factor <= 1e3, key, factor,
                  "a factor on the ties must lie between 0.001 and 1000", "1 is the standard tie");
  if (model == ModelKind::published)
    rules.found.push_back({"lattice.model", "published",
                           "calibrated models are central, hookean and network",
                           "give one of them"});
  for (const Violation& violation : rubber.violations()) rules.found.push_back(violation);
  if (2 * rubber.relaxation.branches.size() > relaxation_parameters.size() ||
      !rubber.relaxation.bulk)
    rules.found.push_back({"rubber.relaxation_g1",
                           std::to_string(rubber.relaxation.branches.size()) + " branches",
                           "a material keeps at most five, in which all moduli fade alike",
                           "join branches of similar times"});
  if (geometry)
    for (const Violation& violation : geometry->violations()) rules.found.push_back(violation);
  if (rules.found.empty())
    rules.require(std::isfinite(spacing * rubber.longitudinal_modulus()), "lattice.spacing",
                  spacing, "the springs' stiffness, spacing times modulus, must be finite");
  // The rules on constants divide by the spacing.
  if (rules.found.empty() && model != ModelKind::network) check_constants(rules, *this);
  check_validity(rules, validity);
  return std::move(rules.found);
}

lattice::SpringConstants at_spacing(const Material& material, double spacing) {
  const double ratio = spacing / material.spacing;
  const lattice::SpringConstants& c = material.constants;
  return {c.k1 * ratio, c.k2 * ratio, c.k3 * ratio, c.kappa};
}

Sentences lattice_warnings(const Material& material, const PressSetup& setup) {
  Sentences found;
  if (!material.rejected.empty())
    found.push_back(std::string(failed_its_tests) + material.rejected);
  warn_of_spacing(found, material.validity, setup);
  warn_of_geometry(found, material.validity, setup);
  warn_of_kinematics(found, material, setup);
  warn_of_moduli(found, material, setup);
  warn_of_differences(found, material, setup);
  return found;
}

Sentences warnings(const Material& material, const PressSetup& setup) {
  Sentences found = lattice_warnings(material, setup);
  const Validity& v = material.validity;
  const meshes::PressProtocol& protocol = setup.protocol;
  if (v.largest_indentation && v.thickness) {
    const double fitted = *v.largest_indentation / *v.thickness;
    const double depth = protocol.depth / setup.geometry.thickness();
    if (depth > fitted * (1.0 + 1e-9))
      found.push_back("the press goes to " + tenths_of_percent(depth) +
                      " of the rubber's thickness, the fit to " + tenths_of_percent(fitted) +
                      " only: deeper forces are extrapolated" +
                      (v.model_error ? ", the error of " + tenths_of_percent(*v.model_error) +
                                           " was not measured there"
                                     : ""));
  }
  if (!v.contacts.empty() && std::ranges::find(v.contacts, protocol.contact) == v.contacts.end()) {
    std::string known;
    for (const meshes::ContactMode mode : v.contacts)
      known += (known.empty() ? "" : ", ") + std::string(meshes::name(mode));
    found.push_back("the contact is " + std::string(meshes::name(protocol.contact)) +
                    ", the fit's was " + known + ": the force under it has not been compared");
  }
  return found;
}

}  // namespace fingertip::calibration::inline material
