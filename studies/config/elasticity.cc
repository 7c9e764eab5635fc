#include "studies/config/elasticity.h"

#include <string>

#include "calibration/words.h"
#include "meshes/files.h"
#include "studies/config/value_reader.h"

namespace fingertip::studies {

namespace {

constexpr const char* youngs = "rubber.youngs_modulus";
constexpr const char* shear = "rubber.shear_modulus";
constexpr const char* poisson = "rubber.poissons_ratio";
constexpr const char* hardness = "rubber.shore_hardness";

bool says_something(const LoadedConfig& loaded, const char* key) {
  const Entry& entry = loaded.entries.at(key);
  return entry.given && entry.literal != "\"auto\"";
}

std::string text_of(const LoadedConfig& loaded, const char* key) {
  const Entry& entry = loaded.entries.at(key);
  return std::string(key) + " = " + unquoted(entry.literal) + " (" + entry.place + ")";
}

std::string kilopascal(double modulus) {
  return calibration::rounded(1e-3 * modulus, 4) + " kPa";
}

}  // namespace

double youngs_modulus_of_hardness(double shore_a) {
  return 0.0981e6 * (56.0 + 7.62336 * shore_a) / (0.137505 * (254.0 - 2.54 * shore_a));
}

void resolve_elasticity(LoadedConfig& loaded, std::vector<Problem>& problems) {
  Config& config = loaded.config;
  meshes::Rubber& rubber = config.press.rubber;
  const bool has_e = says_something(loaded, youngs), has_g = says_something(loaded, shear);
  const bool has_nu = says_something(loaded, poisson), has_s = says_something(loaded, hardness);
  if (!has_e && !has_g && !has_nu && !has_s) return;
  const auto refuse = [&](const char* key, const std::string& rule, const std::string& remedy) {
    const Entry& entry = loaded.entries.at(key);
    problems.push_back({entry.place, key, unquoted(entry.literal), rule, remedy});
  };
  if (has_e && has_s) {
    refuse(
        hardness,
        "the hardness stands for Young's modulus, which is given, too: " + text_of(loaded, youngs),
        "give one of the two");
    return;
  }
  const bool has_stiffness = has_e || has_s;
  if (has_stiffness && has_g && has_nu) {
    refuse(poisson,
           "two constants describe an isotropic rubber, here are three: " +
               text_of(loaded, has_s ? hardness : youngs) + ", " + text_of(loaded, shear),
           "leave one of them out");
    return;
  }
  // A file of constants brings its own E and G, and what is given beside it has no effect.
  const auto note = [&](const std::string& text) {
    if (config.constants != ConstantsSource::file) loaded.notes.push_back(text);
  };
  const auto derived = [&](const char* key, const std::string& from) {
    loaded.entries.at(key) = {"\"auto\"", "from " + from, false};
  };
  if (has_s) {
    rubber.youngs_modulus = youngs_modulus_of_hardness(*config.shore_hardness);
    derived(youngs, hardness);
    note("a hardness of " + meshes::to_text(*config.shore_hardness) +
         " Shore A stands for E = " + kilopascal(rubber.youngs_modulus) +
         " by Gent's formula: a rough value, measure E where it matters");
  }
  if (has_stiffness && has_g) return;
  double ratio = usual_poissons_ratio;
  if (has_nu) {
    ratio = *config.poissons_ratio;
  } else {
    loaded.entries.at(poisson) = {meshes::to_text(ratio),
                                  "default for a rubber given by one modulus", false};
  }
  if (has_g) {
    rubber.youngs_modulus = 2.0 * rubber.shear_modulus * (1.0 + ratio);
    derived(youngs, std::string(shear) + " and " + poisson);
  } else {
    rubber.shear_modulus = rubber.youngs_modulus / (2.0 * (1.0 + ratio));
    derived(shear, std::string(has_s ? hardness : youngs) + " and " + poisson);
  }
  if (!has_nu)
    note("rubber.poissons_ratio is not given: " + meshes::to_text(ratio) +
         ", that of a nearly incompressible rubber, makes " +
         (has_g ? "E = " + kilopascal(rubber.youngs_modulus)
                : "G = " + kilopascal(rubber.shear_modulus)));
  if (has_nu && !has_stiffness && !has_g)
    note("rubber.poissons_ratio alone is given: E stays at its default, " +
         kilopascal(rubber.youngs_modulus) + ", G is " + kilopascal(rubber.shear_modulus));
}

}  // namespace fingertip::studies
