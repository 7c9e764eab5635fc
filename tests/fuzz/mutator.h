/// Damages texts as slips of the pen, other programs, full disks and attackers do.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace fuzz {

/// What inputs are made from.
struct Material {
  std::vector<std::string> seeds;  ///< well-formed inputs
  std::vector<std::string> words;  ///< of the grammar, put in where they may not belong
};

/// Input `number` of the endless series of `material`: a seed with one to some changes. Bytes
/// flipped, put in and lost; lines lost, doubled and swapped; cut off; numbers replaced by NaN,
/// infinity, huge, tiny and negative ones; decimal commas; brackets and quotes lost; zero bytes,
/// byte order marks, what is no UTF-8, other line ends; deep nesting and very long lines; parts of
/// another seed. The same number always gives the same input.
std::string mutated(const Material& material, std::uint64_t number);

}  // namespace fuzz
