/// transfer.json: the force to expect of a finger in another program, beside the continuum's.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "meshes/file_fields.h"
#include "studies/exchange/contact_curves.h"

namespace fingertip::studies {

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

/// A model by its name, and the forces it has on a curve's obstacle at the curve's indentations,
/// NaN where that is not known [N].
struct ForetoldModel {
  std::string name;
  std::function<std::vector<double>(const ContactCurve&)> forces;
};

/// By a law: the force on a curve's obstacle at an indentation [m].
ForetoldModel by_law(const std::string& name,
                     const std::function<double(const ContactCurve&, double)>& force);
/// The lattice at rest, as the curves know it.
ForetoldModel lattice_at_rest();

/// Told are 1/6, 1/3, 1/2, 2/3 and all of the depth.
TransferFile transfer_of(const std::string& format, const std::string& how,
                         const std::vector<Problem>& lost, const std::vector<ContactCurve>& curves,
                         const std::vector<ForetoldModel>& models);

/// Chapters "Force error to expect" and "What is lost" of a README.
std::string transfer_chapters(const TransferFile& transfer);
/// A line per model for the screen: largest errors where it was fitted and elsewhere, and how far
/// it carries.
std::string transfer_lines(const TransferFile& transfer);

}  // namespace fingertip::studies
