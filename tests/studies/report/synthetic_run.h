/// A run folder of `validate` made of formulas, so that every number in it is known.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/temporary_folder.h"

namespace fingertip::report_testing {

/// Writes `text` into a file, making its folders.
void write_file(const std::filesystem::path& file, const std::string& text);

/// Elastic constants of a cubic material from C11, C12, C44 [Pa] by the textbook compliances,
/// in the names of summary.json.
nlohmann::json cubic_moduli(double c11, double c12, double c44);

/// Force of the synthetic continuum [N]: 120 N/m^1.5 times indentation^1.5, a smooth stiffening
/// curve.
double continuum_force(double indentation);

/// A contact_field.csv: Hertz's pressure at each indentation d, `factor` times 1e6 Pa/m d in the
/// middle, out to a² = 1.1 d R, in 20 rings of 24 points.
void write_contact_field(const std::filesystem::path& folder,
                         const std::vector<double>& indentations, double factor = 1.0);

/// Fills `folder` with everything a complete run has: 40 gf/cm² rubber, the published lattice at
/// twice the continuum's force, central at 0.9, hookean at 1.02 of it; the continuum on three
/// meshes with estimated errors of 0.3 %, but 0.45 % at 0.1 cm; a verification of which the element
/// Q1 pointwise and the check "balance of forces" fail.
void write_synthetic_run(const std::filesystem::path& folder);

}  // namespace fingertip::report_testing
