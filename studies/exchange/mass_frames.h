/// Frames of a free lattice as a time series for ParaView.
#pragma once

#include <filesystem>
#include <vector>

#include "lattice/model/model.h"
#include "lattice/model/state.h"

namespace fingertip::studies {

/// Writes FOLDER/frame_0000.vtu, ... and FOLDER/frames.pvd, which is complete after every frame:
/// all masses as vertices, axis springs as lines, point data displacement [m] and velocity [m/s],
/// TimeValue [s].
class MassFrames {
 public:
  /// The model must outlive it.
  MassFrames(std::filesystem::path folder, const lattice::LatticeModel& model);

  void add(const lattice::State& state, double time);

 private:
  std::filesystem::path folder_;
  const lattice::LatticeModel* model_;
  std::vector<std::int32_t> connectivity_, offsets_;
  std::vector<std::uint8_t> types_;
  std::vector<double> times_;  ///< [s]
};

}  // namespace fingertip::studies
