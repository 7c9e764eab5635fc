/// What this processor's memory can do at best, for rooflines.
#pragma once

#include <cstddef>
#include <functional>

namespace kernel_probes {

/// to[i] = from[i] + factor: a read and a write per element.
void stream(const double* from, double* to, std::size_t count, double factor);

/// What Linux says of the largest cache of that level of core 0 [bytes]; `otherwise` without it.
std::size_t cache_bytes(int level, std::size_t otherwise);

/// Memory that `work` reads or writes, in whole pages of 4 KB [bytes], once each however often it
/// does: as Linux notes them (/proc/self/clear_refs); 0 where it does not tell or
/// pages are larger.
std::size_t touched_bytes(const std::function<void()>& work);

}  // namespace kernel_probes
