/// A finger for a program whose contact is a law fitted to the continuum's forces.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "studies/exchange/contact_curves.h"
#include "studies/exchange/soft_body.h"
#include "studies/exchange/transfer.h"

namespace fingertip::studies {

/// What an export is made of. The references must outlive it.
class ContactSource {
 public:
  ContactSource(const LoadedConfig& own_loaded, const std::vector<ContactCurve>& own_curves,
                const std::vector<Problem>& own_lost)
      : loaded(own_loaded), curves(own_curves), lost(own_lost) {}

  const LoadedConfig& loaded;
  const std::vector<ContactCurve>& curves;  ///< the first one is fitted, all are judged
  const std::vector<Problem>& lost;

  /// The soft body of the first curve, fitted when it is asked for first. Throws as
  /// fitted_soft_body().
  const SoftBody& soft() const;

 private:
  mutable std::optional<SoftBody> soft_;
};

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

/// The curves that an export is made of. Throws ConfigError for what no press of the continuum
/// makes good: as ContactCurves, and an obstacle that the format cannot have.
ContactCurves contact_curves(const std::string& format, const LoadedConfig& loaded);

/// Of "pressure-law", "mujoco", "drake", "sofa", "vtk", or "all" that can carry the press: fitted
/// to the first curve, judged by all. Throws InvalidInput where that curve does not grow,
/// ConfigError for tetrahedra that bear no press.
ContactExport contact_export(const std::string& format, const ContactSource& source);

/// An export of the lattice itself beside the continuum: transfer.json and README.md, which begins
/// with `readme`.
ContactExport lattice_export(const std::string& format, const std::string& readme,
                             const std::vector<ContactCurve>& curves);

void write_contact_export(const ContactExport& made, const std::filesystem::path& folder);

}  // namespace fingertip::studies
