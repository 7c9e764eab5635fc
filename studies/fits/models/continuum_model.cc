#include "studies/fits/models/continuum_model.h"

#include <fmt/format.h>

#include <cmath>

#include "meshes/base/files.h"
#include "meshes/press/press_response.h"
#include "studies/presses/reference_job.h"

namespace fingertip::studies::inline fits::inline models {

namespace {

using Eigen::VectorXd;
using fem_reference::ReferenceJob;
using meshes::InvalidInput;
using meshes::Violation;
namespace fs = std::filesystem;

/// F/G of a run, whose samples are those of the job.
VectorXd scaled_forces(const fs::path& folder, const ReferenceJob& reference) {
  const fs::path file = folder / "response.csv";
  const auto samples = meshes::PressResponse::read_csv(file).samples();
  const auto refuse = [&](const std::string& value, const std::string& rule) {
    throw InvalidInput({file.string(), value, rule, "run this press again, to its end"});
  };
  if (samples.size() != reference.protocol.samples.size())
    refuse(std::to_string(samples.size()) + " samples",
           "the fit needs the " + std::to_string(reference.protocol.samples.size()) +
               " samples of its data");
  VectorXd forces(Eigen::Index(samples.size()));
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double wanted = reference.protocol.samples[i], depth = samples[i].indentation;
    if (!(std::abs(depth - wanted) <= 1e-9 * wanted))
      refuse(meshes::to_text(depth) + " m",
             "the job has its sample at " + meshes::to_text(wanted) + " m");
    if (!(samples[i].normal_force > 0.0))
      refuse(meshes::to_text(samples[i].normal_force) + " N", "a pressed tip has a force > 0");
    forces(Eigen::Index(i)) = samples[i].normal_force / reference.rubber.shear_modulus;
  }
  return forces;
}

}  // namespace

double lowest_ratio(const ReferenceJob& reference) {
  // The energies of laws A and B fall without bound for lambda < 0.
  return reference.strain == fem_reference::Strain::finite ? 0.0 : -0.9;
}

ReferenceJob at_ratio(const ReferenceJob& reference, double poissons_ratio) {
  ReferenceJob job = reference;
  job.rubber.youngs_modulus = 2.0 * reference.rubber.shear_modulus * (1.0 + poissons_ratio);
  job.write_fields = false;
  std::vector<Violation> broken = job.violations();
  for (Violation& violation : broken)
    violation.value += " (at Poisson's ratio " + meshes::to_text(poissons_ratio) + " of the fit)";
  if (reference.analysis != fem_reference::Analysis::static_press)
    broken.push_back({"reference.mode", std::string(name(reference.analysis)),
                      "a fit presses statically", "choose reference.mode = \"static\""});
  if (!broken.empty()) throw InvalidInput(broken);
  return job;
}

calibration::ScaledModel continuum_model(
    const ReferenceJob& reference, const std::vector<calibration::MaterialParameter>& parameters,
    const std::string& place, const JobContext& context, calibration::ScaledModel::Use use) {
  const auto solve = [reference, place,
                      run_all = context.run_all](const std::vector<double>& ratios) {
    std::vector<PlannedJob> jobs;
    for (const double nu : ratios)
      jobs.push_back({fmt::format("{}/{:.6f}", place, nu), reference_job(at_ratio(reference, nu))});
    std::vector<VectorXd> forces;
    for (const fs::path& folder : run_all(jobs)) forces.push_back(scaled_forces(folder, reference));
    return forces;
  };
  return {solve, parameters, reference.rubber, lowest_ratio(reference), use};
}

}  // namespace fingertip::studies::inline fits::inline models
