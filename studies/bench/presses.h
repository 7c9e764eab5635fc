/// Presses of the default fingertip against the clock.
#pragma once

#include "studies/bench/plan.h"
#include "studies/config/loader.h"
#include "studies/jobs/job.h"

namespace fingertip::studies::inline bench {

/// The default specimen and press of `loaded` with sticking contact, this lattice and depth.
LoadedConfig press_config(const LoadedConfig& loaded, const PressedLattice& press, double depth);

/// File: pace.json {"real_time_factor", "real_time_factor_processor" (null with more threads than
/// one), "whole_press_factor", "ns_per_mass_step" (processor time of the pressing thread), "step"
/// [s], "steps", "particles", "parts"}, and response.csv. Never cached: it is the time that
/// matters.
Job pace_job(const LoadedConfig& loaded, const PressedLattice& press, double depth);

/// The same lattice in equilibrium at these indentations [m]; cached by content.
Job static_job(const LoadedConfig& loaded, const PressedLattice& press,
               const std::vector<double>& depths);

/// "network_R12_1t", "network_mass-scaled_R12_1t", "network_mass-scaled_R12_1t_whole"
std::string press_name(const PressedLattice& press);

}  // namespace fingertip::studies::inline bench
