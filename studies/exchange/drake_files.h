/// A finger for Drake: a rigid ball whose hydroelastic modulus is fitted.
#pragma once

#include <vector>

#include "studies/exchange/contact_export.h"

namespace fingertip::studies {

/// finger.sdf
ContactExport drake_export(const LoadedConfig& loaded, const std::vector<ContactCurve>& curves,
                           const std::vector<Problem>& lost);

}  // namespace fingertip::studies
