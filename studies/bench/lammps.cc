#include "studies/bench/lammps.h"

#include <fmt/format.h>

#include "studies/exchange/lammps/lammps_files.h"

namespace fingertip::studies::inline bench {

std::size_t write_lammps_cube(const std::filesystem::path& folder, int size, long steps) {
  ConfigSource source;
  source.sets = {"lattice.model=published", "exchange.body=cube",
                 fmt::format("exchange.cells={}", size - 1)};
  std::filesystem::create_directories(folder);
  return write_lammps(undamped_body(load_config(source)), {steps, 0}, folder).springs;
}

}  // namespace fingertip::studies::inline bench
