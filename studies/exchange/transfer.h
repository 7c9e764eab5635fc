/// transfer.json: the force to expect of a finger in another program, beside the continuum's.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "studies/exchange/contact_curves.h"
#include "studies/files/transfer_file.h"

namespace fingertip::studies::inline exchange {

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

/// What a model makes of the moment about the normal on a curve's obstacle at the curve's
/// indentations, NaN where that is not known [N m], where friction has the coefficient `friction`.
struct ForetoldTorsion {
  std::string name;
  double friction = 0.0;
  std::function<std::vector<double>(const ContactCurve&)> moments;
};
void add_torsion(TransferFile& file, const std::vector<ContactCurve>& curves,
                 const ForetoldTorsion& model);

/// Told are 1/6, 1/3, 1/2, 2/3 and all of the depth.
TransferFile transfer_of(const std::string& format, const std::string& how,
                         const std::vector<meshes::Violation>& lost,
                         const std::vector<ContactCurve>& curves,
                         const std::vector<ForetoldModel>& models);

/// Chapters "Force error to expect" and "What is lost" of a README.
std::string transfer_chapters(const TransferFile& transfer);
/// A line per model for the screen: largest errors where it was fitted and elsewhere, and how far
/// it carries.
std::string transfer_lines(const TransferFile& transfer);

}  // namespace fingertip::studies::inline exchange
