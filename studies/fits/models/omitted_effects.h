/// What the data of a fit may contain that its model leaves out.
#pragma once

#include <vector>

#include "calibration/statistics/score_tests.h"
#include "studies/fits/models/fit_models.h"

namespace fingertip::studies::inline fits::inline models {

/// Per press of an experiment what finite strain adds to its forces, relative, at every sample;
/// empty where a theory of large strain is fitted, or where none could be pressed so far.
std::vector<std::vector<double>> excess_of_finite_strain(const FitInput& input);

/// Of measured presses, at the estimates of `fit`, each with a factor of its own where they
/// `scatter`, the gravest first: touch offset and zero of the
/// force of every curve and compliance of every machine, which is not below zero, where they are
/// not fitted, drift where there are times, each fitted together with the scale of the forces and
/// the rig's own parameters; a stiffening that no compliance makes; and to first order finite
/// strain and the other contact, pressed on coarse lattices. Where none alone makes the misfit one
/// of chance, the two kinds of a rig's quantities come first that together explain most: a late
/// touch and a soft frame look like a zero of the force.
std::vector<calibration::ScoreTest> score_tests_of(const FitInput& input,
                                                   const calibration::CurveFit& fit,
                                                   const calibration::CurveFitOptions& options,
                                                   const FitModels& models, bool scatter);

}  // namespace fingertip::studies::inline fits::inline models
