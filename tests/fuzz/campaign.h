/// Many damaged inputs for one reader, and what must hold for each.
#pragma once

#include <functional>
#include <string>

#include "mutator.h"

namespace fuzz {

/// Takes one input: true when the reader accepted it, false when it refused it as it documents.
/// Whatever leaves it as an exception is a finding; so is what it reports with EXPECT_.
using Reader = std::function<bool(const std::string& input)>;

/// A reader that refuses by one of `Refusals` and no other exception.
template <class Refusal, class... More, class Read>
Reader refusing(Read read) {
  return [read](const std::string& input) {
    try {
      if constexpr (sizeof...(More) == 0) {
        read(input);
        return true;
      } else {
        return refusing<More...>(read)(input);
      }
    } catch (const Refusal& refusal) {
      return refusal.what()[0] == '\0' ? throw std::string("refused without a word") : false;
    }
  };
}

/// How many inputs a reader gets: $FINGERTIP_FUZZ_INPUTS, else 400. The first is number
/// $FINGERTIP_FUZZ_FIRST, else 0, so that a finding can be repeated alone.
std::size_t wanted_inputs();

/// Hands all seeds of `material` to `reader`, which must accept them, and then wanted_inputs()
/// mutations, of which it must accept some and refuse some. Fails for every other exception, for an
/// input that takes more than `patience` seconds of processor time, and ends the program when one
/// takes a minute. At the first three findings it stops; each tells number and input.
void attack(const Material& material, const Reader& reader, double patience = 2.0);

}  // namespace fuzz
