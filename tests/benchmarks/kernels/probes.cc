#include "probes.h"

#include <sys/prctl.h>

#include <fstream>
#include <string>
#include <vector>

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

namespace {

/// The sum of a quantity over all that this process has mapped [bytes].
std::size_t mapped(const std::string& quantity) {
  std::ifstream map("/proc/self/smaps");
  std::size_t sum = 0;
  for (std::string word; map >> word;) {
    std::size_t kilobytes = 0;
    if (word == quantity && map >> kilobytes) sum += kilobytes;
  }
  return 1024 * sum;
}

/// What has been touched since the notes were cleared [bytes].
std::size_t referenced() {
  return mapped("Referenced:");
}

}  // namespace

std::size_t touched_bytes(const std::function<void()>& work) {
  constexpr std::size_t page = 4096;
  work();  // what it touches the first time only does not count
  // Pages whose translations the processor still holds are not noted again: others push them out.
  std::vector<char> others(std::size_t(64) << 20, 1);
  if (mapped("AnonHugePages:") > 0) return 0;  // pages of 2 MB tell nothing
  if (!(std::ofstream("/proc/self/clear_refs") << 1 << std::flush)) return 0;
  std::size_t sum = 0;
  for (std::size_t i = 0; i < others.size(); i += page)
    sum += std::size_t(static_cast<volatile char&>(others[i]));
  const std::size_t before = referenced(), itself = referenced() - before;
  work();
  const std::size_t after = referenced();
  return sum > 0 && after > before + itself ? after - before - itself : 0;
}

}  // namespace kernel_probes
