/// What the rounds add up to: medians, ratios, rooflines.
#pragma once

#include <nlohmann/json.hpp>

#include "studies/bench/kernels.h"

namespace fingertip::studies {

/// {"multiply_adds_per_second": {ISA: rate}, "bandwidth_L2", "bandwidth_DRAM" [B/s]}, medians.
nlohmann::ordered_json probes_of(const KernelRounds& rounds);

/// Entries `kernels` (and `peers`) of the contract: medians over the rounds. Beyond the contract
/// each has `operations_per_spring` (null where not counted), `roofline_fraction`: these over the
/// multiply-add rate of the same instruction set and precision, over the time taken; and `rounds`.
nlohmann::ordered_json kernels_of(const KernelRounds& rounds, bool peers);

struct Ratios {
  nlohmann::ordered_json values;   ///< the contract's names; null where there is none
  nlohmann::ordered_json rounds;   ///< the same per round
  nlohmann::ordered_json missing;  ///< name → why it is null
};

/// Each the median over rounds of the ratio within a round.
Ratios ratios_of(const KernelRounds& rounds);

}  // namespace fingertip::studies
