/// Sums over many things on a team of threads.
#pragma once

#include <array>
#include <cstddef>
#include <numeric>

#include "lattice/threads/parallel.h"

namespace fingertip::lattice::inline threads {

/// body(begin, end) for `portions` pieces that cover [0, count), concurrently; their sum in order,
/// the same bits for any number of threads. Allocates nothing.
template <std::size_t portions, typename Body>
double sum_in_portions(Team& team, std::size_t count, const Body& body) {
  std::array<double, portions> part{};
  team.split(portions, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p)
      part[p] = body(p * count / portions, (p + 1) * count / portions);
  });
  return std::accumulate(part.begin(), part.end(), 0.0);
}

}  // namespace fingertip::lattice::inline threads
