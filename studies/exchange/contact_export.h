/// A finger for a program whose contact is a law fitted to the continuum's forces.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "studies/exchange/contact_curves.h"
#include "studies/exchange/transfer.h"

namespace fingertip::studies {

struct ContactExport {
  struct File {
    std::string name, text;
  };
  std::vector<File> files;  ///< beside transfer.json and README.md
  std::string readme;       ///< title and how to use the files
  std::string said;         ///< lines for the screen, of what was fitted
  TransferFile transfer;
  std::map<std::string, ContactExport> parts;  ///< exports in folders of their own
};

/// Of "pressure-law", "mujoco", "drake", "sofa", "vtk", or "all" that can carry the press: fitted
/// to the first curve, judged by all. Throws InvalidInput where that curve does not grow,
/// ConfigError for what the format cannot carry.
ContactExport contact_export(const std::string& format, const LoadedConfig& loaded,
                             const std::vector<ContactCurve>& curves,
                             const std::vector<Problem>& lost);

/// An export of the lattice itself beside the continuum: transfer.json and README.md, which begins
/// with `readme`.
ContactExport lattice_export(const std::string& format, const std::string& readme,
                             const std::vector<ContactCurve>& curves);

void write_contact_export(const ContactExport& made, const std::filesystem::path& folder);

}  // namespace fingertip::studies
