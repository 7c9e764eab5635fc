/// The live view as a whole: simulation, server, and how it ends.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "studies/live/paced_rig.h"

namespace fingertip::studies::inline live {

struct LiveOptions {
  int port = 0;                     ///< on 127.0.0.1; 0: a free one
  std::filesystem::path reference;  ///< run folder or response.csv; empty: none
  /// Without a reference the continuum's press beside this one, computed while the page is served;
  /// empty where there is none. It ends with what it has when `stop`.
  std::function<meshes::PressResponse(const std::function<bool()>& stop)> continuum;
  PaceSettings pace;
  std::optional<double> exit_after;   ///< [s] of wall time
  std::function<bool()> interrupted;  ///< asked ten times a second
};

/// Serves the press of `setup` until interrupted, or until exit_after; `ready` is told the address
/// as soon as the page can be opened, and how the reference differs from the press ("" when it does
/// not). Returns the real-time factor in the slowest half second of its running, NaN where it ran
/// for less. Throws InvalidInput.
double run_live_view(
    const lattice::PressSetup& setup, const LiveOptions& options,
    const std::function<void(const std::string& url, const std::string& remark)>& ready);

}  // namespace fingertip::studies::inline live
