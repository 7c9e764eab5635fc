/// A rubber's law as it travels from a fit to a press: material.toml with a section [law], and what
/// to beware of where it is used.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "calibration/material_tests/law_fit.h"
#include "meshes/base/errors.h"

namespace fingertip::calibration::inline material_tests {

/// A test of the card: how well the law meets it.
struct CardTest {
  std::string name;
  TestKind kind = TestKind::uniaxial;
  bool fitted = true;  ///< else predicted
  std::size_t points = 0;
  double rms_relative = 0.0, largest_relative = 0.0;  ///< TestMisfit's
  TestCourse course = TestCourse::slow;
};

/// A number with its 95 % interval; no interval where both ends are NaN.
struct CardValue {
  double value = 0.0, lower = 0.0, upper = 0.0;
};

/// SI.
struct LawCard {
  LawChoice choice;
  std::vector<CardValue> coefficients;         ///< in the order of calibration::coefficients
  std::optional<CardValue> bulk_modulus;       ///< none: no test tells it
  std::array<double, 2> tested = {1.0, 1.0};   ///< principal stretches of the fitted tests
  std::optional<std::array<double, 2>> rates;  ///< nominal strain rates [1/s], where known
  /// LawFit::times [s], where the law has branches.
  std::optional<std::array<double, 2>> times = {};
  std::vector<CardTest> tests;
  std::vector<std::string> contradictions;  ///< what speaks against it, in plain sentences
  std::string material, source, licence;    ///< may be empty
  std::string provenance;                   ///< files with SHA-256
  std::string program, date;                ///< may be empty
  std::string rejected;                     ///< why the fit failed its own tests; empty: it passed
  std::string statement;                    ///< what it is good for, in words

  SizedLaw law() const;  ///< after long times; throws as sized_law does
  meshes::Relaxation relaxation() const;
  /// Every broken rule, with keys of material.toml.
  std::vector<meshes::Violation> violations() const;
};

/// The card of a fit to `tests` that was asked for `validation`.
LawCard card_of(const LawFit& fit, const std::vector<MaterialTest>& tests,
                const std::vector<MaterialTest>& validation);

/// material.toml: [law] with coefficients, shares and times, [rubber] with E and G that follow (E
/// for incompressible rubber where K is unknown), [validity], [[test]], [about]. Written
/// atomically, read back to the same bits. Throws InvalidInput for a card that breaks a rule,
/// std::runtime_error when it cannot be written.
void write_law_card(const LawCard& card, const std::filesystem::path& file);

/// Throws InvalidInput naming file, line and key: a file that cannot be read, a missing or unknown
/// key, a wrong unit, a value out of range, a file of lattice constants, which has no [law].
LawCard read_law_card(const std::filesystem::path& file);

/// Plain sentences on a use at principal stretches `used` [1] and nominal strain rate `rate` [1/s],
/// where they are known: outside of the tests, contradicted, K unknown. Empty: nothing to beware
/// of.
std::vector<std::string> warnings(const LawCard& card,
                                  const std::optional<std::array<double, 2>>& used);

}  // namespace fingertip::calibration::inline material_tests
