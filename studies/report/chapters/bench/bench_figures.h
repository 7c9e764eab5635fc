/// The figures of a `bench` run. Without data they have no panels.
#pragma once

#include "studies/files/json_entry.h"
#include "studies/report/figure/figure.h"

namespace fingertip::studies::reporting {

/// Mirror images of a press's tip of which one was computed; runs of earlier versions knew none.
double parts_of(const JsonEntry& press);

/// Error of the force against the real-time factor: every way of simulating the press.
Figure pace_figure(const JsonEntry& bench);

/// Cost per spring and step against the number of masses, and what bounds it.
Figure growth_figure(const JsonEntry& bench);

/// What DRAM alone would take per spring and step of the spring engine [ns], by the bandwidth that
/// was measured; NaN without it.
double dram_cost(const JsonEntry& bench);

/// Cost per mass and step of the presses against the number of masses, on one thread.
Figure press_growth_figure(const JsonEntry& bench);

/// Ratios from run to run.
Figure history_figure(const JsonList& history);

}  // namespace fingertip::studies::reporting
