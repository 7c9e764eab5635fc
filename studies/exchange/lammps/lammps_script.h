/// The input script that goes with a data file.
#pragma once

#include <string>

#include "studies/exchange/lammps/undamped_body.h"

namespace fingertip::studies::inline exchange::inline lammps {

inline constexpr const char* lammps_script = "lattice.in";
inline constexpr const char* lammps_data = "lattice.data";
inline constexpr const char* lammps_dump = "lattice.dump";
inline constexpr const char* lammps_log = "log.lammps";  ///< LAMMPS's own default

/// How long LAMMPS is to march, and how often it writes; both can be changed on its command line
/// (-var steps 5000 -var every 0).
struct LammpsSettings {
  long steps = 1000;
  long every = 100;  ///< 0: no dump
};

/// Name of the data file's section with the mass of every atom.
inline constexpr const char* lammps_masses_section = "Particle_masses";

std::string lammps_script_text(const UndampedBody& body, const LammpsSettings& settings);

}  // namespace fingertip::studies::inline exchange::inline lammps
