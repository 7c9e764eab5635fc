/// What a finger for another program is made of, and what is made.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "studies/exchange/contact_curves.h"
#include "studies/exchange/soft_body.h"
#include "studies/exchange/transfer.h"

namespace fingertip::studies::inline exchange {

/// What an export is made of. The references must outlive it.
class ContactSource {
 public:
  ContactSource(const LoadedConfig& own_loaded, const std::vector<ContactCurve>& own_curves,
                const std::vector<meshes::Violation>& own_lost)
      : loaded(own_loaded), curves(own_curves), lost(own_lost) {}

  const LoadedConfig& loaded;
  const std::vector<ContactCurve>& curves;  ///< the first one is fitted, all are judged
  const std::vector<meshes::Violation>& lost;

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

}  // namespace fingertip::studies::inline exchange
