/// The cube of damped springs' undamped twin in LAMMPS, as a peer.
#pragma once

#include <filesystem>
#include <string>

namespace fingertip::studies {

/// Writes `folder`/cube.data and cube.in: size³ atoms on a simple cubic lattice, harmonic bonds to
/// their 26 neighbours, no pair forces, velocity Verlet, `steps` steps, units of LAMMPS' own. Atoms
/// start off the lattice by up to a hundredth of its spacing. Bonds are listed by their first atom.
void write_lammps_cube(const std::filesystem::path& folder, int size, int steps);

/// Number of bonds of that cube.
std::size_t cube_springs(int size);

/// Nanoseconds of processor time per spring and step from what LAMMPS has printed ("Loop time of T
/// on P procs for N steps", "X% CPU use"): setting up is not in it. NaN when it has not printed
/// that.
double lammps_cost(const std::string& printed, std::size_t springs);

/// "29 Sep 2021 - Update 2" from its first line; empty when it is not there.
std::string lammps_version(const std::string& printed);

}  // namespace fingertip::studies
