#include "studies/config/elasticity.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include "calibration/files/words.h"
#include "meshes/base/files.h"
#include "meshes/rubber/plausible.h"
#include "studies/config/value_reader.h"

namespace fingertip::studies::inline config {

namespace {

constexpr const char* youngs = "rubber.youngs_modulus";
constexpr const char* shear = "rubber.shear_modulus";
constexpr const char* poisson = "rubber.poissons_ratio";
constexpr const char* hardness = "rubber.shore_hardness";
constexpr const char* bulk = "rubber.bulk_modulus";

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

namespace {

/// E and G of what is given, one by one where it is one alone.
class Elasticity {
 public:
  Elasticity(LoadedConfig& loaded, std::vector<meshes::Violation>& problems)
      : loaded_(loaded), problems_(problems), rubber_(loaded.config.press.rubber) {}

  void resolve() {
    find_moduli();
    const double ratio = rubber_.poissons_ratio();
    if (ratio < 0.0 && ratio > -1.0)
      note("Poisson's ratio is " + calibration::rounded(ratio, 3) + " of E = " +
           kilopascal(rubber_.youngs_modulus) + " and G = " + kilopascal(rubber_.shear_modulus) +
           ": pulled, such a solid grows wider; a rubber has some 0.49, with G = " +
           kilopascal(rubber_.youngs_modulus / (2.0 * (1.0 + usual_poissons_ratio))));
    const std::string odd = meshes::implausible_modulus(rubber_.youngs_modulus);
    if (!odd.empty() && !has(hardness)) note(odd);
  }

 private:
  void find_moduli() {
    if (!resolve_law()) return;
    for (const char* key : {youngs, hardness, shear, poisson, bulk})
      if (says_something(loaded_, key)) given_.emplace_back(key);
    if (coefficients_) given_.emplace_back(coefficients_);
    if (given_.empty()) return;
    if (!consistent()) return;
    if (has(hardness)) take_hardness();
    if (has(bulk)) return with_bulk_modulus();
    if (stiffness() && (has(shear) || coefficients_)) return;
    with_poissons_ratio();
  }
  bool has(std::string_view key) const { return std::ranges::find(given_, key) != given_.end(); }
  /// The key that E comes from.
  const char* stiffness() const {
    return has(youngs) ? youngs : has(hardness) ? hardness : nullptr;
  }
  const char* shear_source() const {
    return coefficients_ ? coefficients_ : has(shear) ? shear : nullptr;
  }
  void refuse(const char* key, const std::string& rule, const std::string& remedy) {
    const Entry& entry = loaded_.entries.at(key);
    problems_.push_back({key, unquoted(entry.literal), rule, remedy, entry.place});
  }
  // A file of constants brings its own E and G, and what is given beside it has no effect.
  void note(const std::string& text) {
    if (loaded_.config.constants != ConstantsSource::file) loaded_.notes.push_back(text);
  }
  void derive(const char* key, const std::string& from) {
    loaded_.entries.at(key) = {"\"auto\"", "from " + from, false};
  }

  /// The law's shape from its coefficients, and G where they tell it.
  bool resolve_law();
  bool consistent();
  void take_hardness();
  void with_bulk_modulus();
  void with_poissons_ratio();

  LoadedConfig& loaded_;
  std::vector<meshes::Violation>& problems_;
  meshes::Rubber& rubber_;
  const char* coefficients_ = nullptr;  ///< the key that G comes from, where a law tells it
  std::vector<std::string> given_;
};

bool Elasticity::resolve_law() {
  const LawCoefficients& given = loaded_.config.coefficients;
  meshes::StrainEnergy& energy = rubber_.energy;
  using meshes::RubberLaw;
  const auto take = [&](const char* key, const std::vector<double>& numbers, bool right,
                        const char* rule, double shear_modulus) {
    if (!right || !(shear_modulus > 0.0) || !std::isfinite(shear_modulus)) {
      refuse(key, numbers.empty() ? "the law needs its coefficients" : rule,
             "give the coefficients of your rubber's fit, or take rubber.law = \"neo-hookean\"");
      return false;
    }
    rubber_.shear_modulus = shear_modulus;
    coefficients_ = key;
    return true;
  };
  switch (energy.law) {
    case RubberLaw::yeoh: {
      const auto& c = given.yeoh;
      const double G = c.empty() ? 0.0 : 2.0 * c[0];
      if (!take("rubber.yeoh", c, c.size() >= 1 && c.size() <= 3,
                "one to three coefficients, the first one positive", G))
        return false;
      for (std::size_t i = 1; i < c.size(); ++i) energy.shape[i - 1] = c[i] / G;
      return true;
    }
    case RubberLaw::mooney_rivlin: {
      const auto& c = given.mooney_rivlin;
      const double half = c.size() == 2 ? c[0] + c[1] : 0.0;
      if (!take("rubber.mooney_rivlin", c, c.size() == 2,
                "two coefficients, C10 and C01, with a positive sum", 2.0 * half))
        return false;
      energy.shape[0] = c[1] / half;
      return true;
    }
    case RubberLaw::ogden: {
      const auto& c = given.ogden;
      double G = 0.0;
      for (std::size_t i = 0; i < c.size(); i += 2) G += c[i];
      if (!take("rubber.ogden", c, !c.empty() && c.size() <= 6,
                "one to three pairs of mu and alpha, the mu with a positive sum", G))
        return false;
      for (std::size_t i = 0; i < c.size(); i += 2) {
        energy.shape[i] = c[i] / G;
        energy.shape[i + 1] = c[i + 1];
      }
      return true;
    }
    case RubberLaw::gent:
      if (!given.gent_jm) {
        refuse("rubber.gent_jm", "the law needs its coefficient",
               "give Jm, the largest I1 - 3, or take rubber.law = \"neo-hookean\"");
        return false;
      }
      energy.shape[0] = *given.gent_jm;
      return true;
    default: return true;
  }
}

bool Elasticity::consistent() {
  if (has(youngs) && has(hardness)) {
    refuse(
        hardness,
        "the hardness stands for Young's modulus, which is given, too: " + text_of(loaded_, youngs),
        "give one of the two");
    return false;
  }
  for (const char* key : {youngs, hardness, shear}) {
    if (!coefficients_ || !has(key)) continue;
    refuse(key, "the coefficients tell the stiffness: " + text_of(loaded_, coefficients_),
           "leave one of the two out");
    return false;
  }
  if (given_.size() <= 2) return true;
  const char* last = has(bulk) ? bulk : poisson;
  std::string others;
  for (const std::string& key : given_)
    if (key != last) others += (others.empty() ? "" : ", ") + text_of(loaded_, key.c_str());
  refuse(last, "two constants describe an isotropic rubber, here are three: " + others,
         "leave one of them out");
  return false;
}

void Elasticity::take_hardness() {
  const double shore = *loaded_.config.shore_hardness;
  rubber_.youngs_modulus = youngs_modulus_of_hardness(shore);
  derive(youngs, hardness);
  note("a hardness of " + meshes::to_text(shore) +
       " Shore A stands for E = " + kilopascal(rubber_.youngs_modulus) +
       " by Gent's formula: a rough value, measure E where it matters");
}

/// Beside E, G or nu; alone, E is its default.
void Elasticity::with_bulk_modulus() {
  const double K = *loaded_.config.coefficients.bulk_modulus;
  double& E = rubber_.youngs_modulus;
  double& G = rubber_.shear_modulus;
  const char* other = shear_source();
  if (other) {
    E = 9.0 * K * G / (3.0 * K + G);
  } else if (has(poisson)) {
    other = poisson;
    E = 3.0 * K * (1.0 - 2.0 * *loaded_.config.poissons_ratio);
    G = E / (2.0 * (1.0 + *loaded_.config.poissons_ratio));
  } else {
    G = 3.0 * K * E / (9.0 * K - E);
    other = stiffness() ? stiffness() : "the default of rubber.youngs_modulus";
  }
  const std::string from = std::string(other) + " and " + bulk;
  if (!stiffness()) derive(youngs, from);
  if (!has(shear)) derive(shear, from);
  if (!(G > 0.0) || !(3.0 * G > E))
    refuse(bulk, "K must exceed E/9 and, with E and G, leave G above E/3",
           "raise bulk_modulus: rubbers have thousands of times their shear modulus");
}

void Elasticity::with_poissons_ratio() {
  double& E = rubber_.youngs_modulus;
  double& G = rubber_.shear_modulus;
  const bool has_nu = has(poisson);
  double ratio = usual_poissons_ratio;
  if (has_nu) {
    ratio = *loaded_.config.poissons_ratio;
  } else {
    loaded_.entries.at(poisson) = {meshes::to_text(ratio),
                                   "default for a rubber given by one modulus", false};
  }
  const char* of_shear = shear_source();
  if (of_shear) {
    E = 2.0 * G * (1.0 + ratio);
    derive(youngs, std::string(of_shear) + " and " + poisson);
  } else {
    G = E / (2.0 * (1.0 + ratio));
  }
  if (!has(shear)) {
    const std::string from = of_shear ? of_shear : stiffness() ? stiffness() : youngs;
    derive(shear, from + " and " + poisson);
  }
  if (!has_nu)
    note("rubber.poissons_ratio is not given: " + meshes::to_text(ratio) +
         ", that of a nearly incompressible rubber, makes " +
         (of_shear ? "E = " + kilopascal(E) : "G = " + kilopascal(G)));
  if (given_.size() == 1 && has_nu)
    note("rubber.poissons_ratio alone is given: E is its default, " + kilopascal(E) +
         ", where a fit of E begins; G is " + kilopascal(G));
}

}  // namespace

void resolve_elasticity(LoadedConfig& loaded, std::vector<meshes::Violation>& problems) {
  Elasticity(loaded, problems).resolve();
}

std::vector<std::string> settings_at_ratio(const LoadedConfig& loaded, double poissons_ratio) {
  const auto set = [](const char* key, const std::string& value) {
    return std::string(key) + "=" + value;
  };
  const meshes::Rubber& rubber = loaded.config.press.rubber;
  using enum meshes::RubberLaw;
  const meshes::RubberLaw law = rubber.energy.law;
  const bool has_shear =
      law == yeoh || law == mooney_rivlin || law == ogden || loaded.entries.at("rubber.card").given;
  std::vector<std::string> sets{set(poisson, meshes::to_text(poissons_ratio)),
                                set(hardness, "auto"), set(bulk, "auto")};
  if (has_shear) {
    sets.push_back(set(youngs, "auto"));
  } else {
    sets.push_back(set(youngs, meshes::to_text(rubber.youngs_modulus) + " Pa"));
    sets.push_back(set(shear, "auto"));
  }
  return sets;
}

}  // namespace fingertip::studies::inline config
