/// A finger for MuJoCo: a rigid geom with a fitted contact, and a flex of tetrahedra.
#pragma once

#include <vector>

#include "studies/exchange/contact_source.h"

namespace fingertip::studies::inline exchange {

/// finger_rigid.xml, and against a plane finger_flex.xml, whose modulus is fitted, too. Throws
/// ConfigError where MuJoCo has no such obstacle.
ContactExport mujoco_export(const ContactSource& source);

}  // namespace fingertip::studies::inline exchange
