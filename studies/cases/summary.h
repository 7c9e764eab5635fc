/// What summary.json says of a case's runs.
#pragma once

#include <nlohmann/json.hpp>

#include "studies/cases/planner.h"

namespace fingertip::studies {

/// The sections of summary.json that the kinds of the case's runs call for; their fields are in
/// studies/manual/files.md.
nlohmann::ordered_json summary_of(const Case& one, const Planner& planner,
                                  const RunResults& results, const std::filesystem::path& folder);

}  // namespace fingertip::studies
