/// What the stages of a press's program came to.
#pragma once

#include <vector>

#include "lattice/press/press.h"
#include "meshes/press/press_protocol.h"
#include "studies/files/press_summary.h"

namespace fingertip::studies::inline presses {

/// Of a press in time, its forces from the rows of its trace around the moments; empty without a
/// program.
std::vector<StageEntry> stage_entries(const meshes::PressProtocol& protocol,
                                      const std::vector<lattice::TraceRow>& trace);

/// Of a press without a trace, its forces from its response. Where that knows no time a hold
/// changes nothing.
std::vector<StageEntry> stage_entries(const meshes::PressProtocol& protocol,
                                      const meshes::PressResponse& response);

/// What is put in and not given back on the way from first touch along all samples [J]: the area
/// below force over indentation, leg by leg by monotone cubics (Fritsch & Carlson 1980), and below
/// lateral force and torque about the normal over displacement and twist, by straight lines. Of a
/// program that ends where nothing touches, the area of its loop. Unknown where the plane both
/// moves aside and turns, for a torque about the centre of pressure does no work at another place.
double work_along(const meshes::PressResponse& response);

}  // namespace fingertip::studies::inline presses
