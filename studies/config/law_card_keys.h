/// A card of a rubber's law as configuration keys.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "calibration/material_tests/law_card.h"
#include "studies/config/loaded_config.h"

namespace fingertip::studies::inline config {

/// Branches as rubber.relaxation takes them: [[0.2, "0.1 s"]].
std::string branches_literal(const std::vector<meshes::RelaxationBranch>& branches);

/// Keys "rubber.yeoh" and their values as TOML literals, "[\"7.7e3 Pa\", ...]". Without a bulk
/// modulus nothing is said of the volume; with branches it relaxes as the shape does.
std::vector<std::pair<std::string, std::string>> keys_of(const calibration::LawCard& card);

/// What to beware of where `loaded` uses the card; the mean stretch of the rubber above the
/// contact, 1 - depth/thickness, stands for the stretches of a press on a dome, depth over speed
/// for its time.
std::vector<std::string> card_warnings(const calibration::LawCard& card,
                                       const LoadedConfig& loaded);

}  // namespace fingertip::studies::inline config
