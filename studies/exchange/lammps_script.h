/// The input script that goes with a data file.
#pragma once

#include <string>

#include "studies/exchange/lammps_files.h"

namespace fingertip::studies {

/// Name of the data file's section with the mass of every atom.
inline constexpr const char* lammps_masses_section = "Particle_masses";

std::string lammps_script_text(const UndampedBody& body, const LammpsSettings& settings);

}  // namespace fingertip::studies
