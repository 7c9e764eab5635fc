/// A finger for a program whose contact is a law fitted to the continuum's forces.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "studies/exchange/contact_source.h"

namespace fingertip::studies::inline exchange {

/// The curves that an export is made of. Throws ConfigError for what no press of the continuum
/// makes good: as ContactCurves, and an obstacle that the format cannot have.
ContactCurves contact_curves(const std::string& format, const LoadedConfig& loaded);

/// Of "pressure-law", "newton", "mujoco", "drake", "sofa", "vtk", or "all" that can carry the press:
/// fitted to the first curve, judged by all. Throws InvalidInput where that curve does not grow,
/// ConfigError for tetrahedra that bear no press.
ContactExport contact_export(const std::string& format, const ContactSource& source);

/// An export of the lattice itself beside the continuum: transfer.json and README.md, which begins
/// with `readme`.
ContactExport lattice_export(const std::string& format, const std::string& readme,
                             const std::vector<ContactCurve>& curves);

void write_contact_export(const ContactExport& made, const std::filesystem::path& folder);

}  // namespace fingertip::studies::inline exchange
