/// The curves of a fit and what answers for each.
#pragma once

#include <string>

#include "studies/run/fit_setup.h"

namespace fingertip::studies {

ConfigError refused(const LoadedConfig& loaded, const std::string& key, const std::string& value,
                    const std::string& rule, const std::string& remedy);

/// A curve per condition, whose y the continuum will make.
void add_continuum_curves(FitSetup& fit, const LoadedConfig& loaded);

/// A curve per file of calibration.data; the parameters of `fit` are known. Throws ConfigError,
/// with file and line, for files that cannot be read or do not go into one fit.
void add_measured_curves(FitSetup& fit, const LoadedConfig& loaded);

}  // namespace fingertip::studies
