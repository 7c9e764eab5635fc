/// Where the contact of a press ends. Free of deal.II.
#pragma once

#include "fem_reference/job/press_state.h"

namespace fingertip::fem_reference::inline press {

/// Radius of the contact edge [m]. Pressure vanishes there like the square root of the distance, as
/// in Hertz's p² ∝ a² - r²: the zero of a parabola in r² fitted to p² over the outer third of the
/// contact (the outer half where that has few nodes), kept within one node spacing of the outermost
/// node that is pushed. `contact` is sorted by radius; about `nodes_per_ring` of its points share
/// one.
double contact_edge(const std::vector<ContactPoint>& contact, double node_spacing,
                    int nodes_per_ring);

/// Sorts the contact of a state whose node spacing is known, and tells edge and largest pressure.
void measure_contact(PressState& state, int nodes_per_ring);

}  // namespace fingertip::fem_reference::inline press
