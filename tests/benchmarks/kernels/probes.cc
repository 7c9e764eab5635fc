#include "probes.h"

#include <fstream>
#include <string>

namespace kernel_probes {

void stream(const double* from, double* to, std::size_t count, double factor) {
  for (std::size_t i = 0; i < count; ++i) to[i] = from[i] + factor;
}

std::size_t cache_bytes(int level, std::size_t otherwise) {
  for (int index = 0; index < 8; ++index) {
    const std::string folder =
        "/sys/devices/system/cpu/cpu0/cache/index" + std::to_string(index) + "/";
    int found = 0;
    std::size_t size = 0;
    char unit = ' ';
    if (!(std::ifstream(folder + "level") >> found) || found != level) continue;
    if (!(std::ifstream(folder + "size") >> size >> unit)) continue;
    return size * (unit == 'M' ? 1024 * 1024 : unit == 'K' ? 1024 : 1);
  }
  return otherwise;
}

}  // namespace kernel_probes
