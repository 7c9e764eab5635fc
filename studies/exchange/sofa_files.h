/// A finger of tetrahedra for SOFA, and for whoever reads VTK's meshes.
#pragma once

#include <vector>

#include "studies/exchange/contact_source.h"

namespace fingertip::studies::inline exchange {

/// finger.scn: the soft body under a plane. Throws as fitted_soft_body().
ContactExport sofa_export(const ContactSource& source);
/// finger.vtu: its mesh with moduli, density and what is held. Throws as fitted_soft_body().
ContactExport vtk_export(const ContactSource& source);

}  // namespace fingertip::studies::inline exchange
