/// Folders of fits made of formulas, so that every number in them is known.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>

namespace fingertip::report_testing {

/// calibration.json of a fit of E = 4 kPa ± 2 % and G = 1.4 kPa ± 3 %, correlated by 0.6, to two
/// presses. The profile is exactly that of the covariance; published lattice and ball as moduli.
nlohmann::json fit_result();

/// Writes `result` and its fit_data.csv: forces of 1000 N/m^1.5 indentation^1.5, those of "stick" a
/// tenth larger, measured 2 % above what was fitted, with a sigma of 1 % of the fitted force.
void write_fit(const std::filesystem::path& folder, const nlohmann::json& result);

/// surrogate.csv and surrogate.json: 100 N/m, a band of 4 %.
void write_surrogate(const std::filesystem::path& folder);

/// A study: fits "alone" and "both", predictions "stick" and "tilted", errors of -1 % and 4 % of
/// "both" and of 3 % and 25 % of "alone", the truth at 4.1 and 1.3 kPa.
void write_transfer_study(const std::filesystem::path& folder);

}  // namespace fingertip::report_testing
