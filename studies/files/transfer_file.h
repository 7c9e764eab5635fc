/// transfer.json: forces to expect of a finger elsewhere, beside the continuum's.
#pragma once

#include <string>
#include <vector>

#include "meshes/press/press_response.h"
#include "meshes/tables/file_fields.h"

namespace fingertip::studies::inline files {

/// A model of the other program on one obstacle; SI. NaN: not known.
struct TransferModelEntry {
  std::string model;
  std::vector<double> force, error;  ///< at the depths told; error relative
  /// The longest stretch of samples whose errors are within 5 % [m].
  double carries_from = meshes::unknown, carries_to = meshes::unknown;
};
constexpr auto fields_of(const TransferModelEntry*) {
  using Whole = TransferModelEntry;
  return meshes::named("model force error carries_from carries_to", &Whole::model, &Whole::force,
                       &Whole::error, &Whole::carries_from, &Whole::carries_to);
}

struct TransferObstacleEntry {
  std::string obstacle;
  bool fitted = false;
  std::vector<double> indentation, force, force_error;  ///< of the continuum at the depths told
  std::vector<TransferModelEntry> models;
};
constexpr auto fields_of(const TransferObstacleEntry*) {
  using Whole = TransferObstacleEntry;
  return meshes::named("obstacle fitted indentation force force_error models", &Whole::obstacle,
                       &Whole::fitted, &Whole::indentation, &Whole::force, &Whole::force_error,
                       &Whole::models);
}

struct TransferFile {
  std::string format, how;
  std::vector<std::string> lost;
  std::vector<TransferObstacleEntry> obstacles;
};
constexpr auto fields_of(const TransferFile*) {
  using Whole = TransferFile;
  return meshes::named("format how lost obstacles", &Whole::format, &Whole::how, &Whole::lost,
                       &Whole::obstacles);
}

}  // namespace fingertip::studies::inline files
