/// A finger for Drake: a rigid ball whose hydroelastic modulus is fitted.
#pragma once

#include <vector>

#include "studies/exchange/contact_source.h"

namespace fingertip::studies::inline exchange {

/// finger.sdf
ContactExport drake_export(const ContactSource& source);

}  // namespace fingertip::studies::inline exchange
