/// What the rounds add up to: medians, ratios, rooflines.
#pragma once

#include <nlohmann/json.hpp>

#include "studies/bench/kernels.h"

namespace fingertip::studies::inline bench {

/// {"operations_per_second": {ISA: rate} (multiplications and additions in turns), "bandwidth_L2",
/// "bandwidth_DRAM" [B/s], "cache_L2", "cache_L3" [B]}, medians.
nlohmann::ordered_json probes_of(const KernelRounds& rounds);

/// Entries `kernels` (and `peers`) of the contract: medians over the rounds. Beyond the contract
/// each has `operations_per_spring` (null where not counted), `roofline_fraction`: these over what
/// the same instruction set does at best in that precision, over the time taken; and `rounds`. At
/// best is the probe's or any such kernel's rate in the same round, whichever is higher: a fraction
/// is at most 1, and 1 has a `remark`.
nlohmann::ordered_json kernels_of(const KernelRounds& rounds, bool peers);

/// Entries `parts`: what the parts of a time step cost, the dearest first: `part`, `scaled_masses`,
/// `spacing_over_R`, `indentation` [m], `seconds` (median over the rounds) and `bytes`, the memory
/// that it touches, null where the system does not tell.
nlohmann::ordered_json parts_of(const KernelRounds& rounds);

struct Ratios {
  nlohmann::ordered_json values;   ///< the contract's names; null where there is none
  nlohmann::ordered_json rounds;   ///< the same per round
  nlohmann::ordered_json missing;  ///< name → why it is null
};

/// Each the median over rounds of the ratio within a round.
Ratios ratios_of(const KernelRounds& rounds);

}  // namespace fingertip::studies::inline bench
