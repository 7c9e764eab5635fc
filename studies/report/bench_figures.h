/// The figures of a `bench` run. Without data they have no panels.
#pragma once

#include <nlohmann/json.hpp>

#include "studies/report/figure.h"

namespace fingertip::studies::reporting {

/// Error of the force against the real-time factor: every way of simulating the press.
Figure pace_figure(const nlohmann::json& bench);

/// Cost per spring and step against the number of masses, and what bounds it.
Figure growth_figure(const nlohmann::json& bench);

/// What DRAM alone would take per spring and step of the spring engine [ns], by the bandwidth that
/// was measured; NaN without it.
double dram_cost(const nlohmann::json& bench);

/// Cost per mass and step of the presses against the number of masses, on one thread.
Figure press_growth_figure(const nlohmann::json& bench);

/// Ratios from run to run.
Figure history_figure(const nlohmann::json& history);

}  // namespace fingertip::studies::reporting
