/// What the data of a fit may contain that its model leaves out.
#pragma once

#include <vector>

#include "calibration/statistics/score_tests.h"
#include "studies/fits/models/fit_models.h"

namespace fingertip::studies::inline fits::inline models {

/// Names of what the other contact would be.
inline constexpr const char *sticking_name = "sticking", *slip_name = "slip";

/// Per press of an experiment what finite strain adds to its forces, relative, at every sample;
/// empty where a theory of large strain is fitted, or where none could be pressed so far.
std::vector<std::vector<double>> excess_of_finite_strain(const FitInput& input);

/// Of measured presses whose machine is what was told of it, and else rigid and tared, each with a
/// factor of its own where they `scatter`: what would explain the misfit, the gravest first. Of the
/// machines touch, zero and drift of every curve and compliance of every machine, which is not
/// below zero, each fitted together with the scale of the forces; a stiffening that no compliance
/// makes; to first order finite strain and the other contact, pressed on coarse lattices, and a
/// rubber that relaxes where files show it. `fit` tells where the search starts.
std::vector<calibration::ScoreTest> score_tests_of(const FitInput& input,
                                                   const calibration::CurveFit& fit,
                                                   const calibration::CurveFitOptions& options,
                                                   const FitModels& models, bool scatter);

}  // namespace fingertip::studies::inline fits::inline models
