/// transfer.json: forces to expect of a finger elsewhere, beside the continuum's.
#pragma once

#include <string>
#include <vector>

#include "meshes/tables/file_fields.h"

namespace fingertip::studies::inline files {

/// A model of the other program on one obstacle; SI. NaN: not known.
struct TransferModelEntry {
  std::string model;
  std::vector<double> force, error;  ///< at the depths told; error relative
  /// The longest stretch of samples whose errors are within 5 % [m].
  double carries_from = meshes::unknown, carries_to = meshes::unknown;
};
FINGERTIP_FIELDS(TransferModelEntry, model, force, error, carries_from, carries_to);

/// The moment about the normal at which Coulomb friction lets go, at the depths told; SI.
struct TransferTorsionEntry {
  std::string model;
  std::vector<double> moment;        ///< of the continuum's pressure, NaN where it is not known
  std::vector<double> model_moment;  ///< in the other program
  std::vector<double> error;         ///< relative
};
FINGERTIP_FIELDS(TransferTorsionEntry, model, moment, model_moment, error);

struct TransferObstacleEntry {
  std::string obstacle;
  bool fitted = false;
  std::vector<double> indentation, force, force_error;  ///< of the continuum at the depths told
  std::vector<TransferModelEntry> models;
  std::vector<TransferTorsionEntry> torsion;
};
consteval auto fields_of(const TransferObstacleEntry*) {
  return FINGERTIP_ALL_MEMBERS(TransferObstacleEntry, obstacle, fitted, indentation, force,
                               force_error, models, torsion)
      .newer("torsion");
}

struct TransferFile {
  std::string format, how;
  std::vector<std::string> lost;
  std::vector<TransferObstacleEntry> obstacles;
};
FINGERTIP_FIELDS(TransferFile, format, how, lost, obstacles);

}  // namespace fingertip::studies::inline files
