#include "studies/run/continuum_table.h"

#include <cmath>
#include <string>

#include "meshes/files.h"
#include "meshes/press_response.h"

namespace fingertip::studies {

namespace {

using Eigen::Index;
using fem_reference::ReferenceJob;
using meshes::InvalidInput;
using meshes::PressSample;
using meshes::Violation;
namespace fs = std::filesystem;

/// The run's samples, which are those of the order.
std::vector<PressSample> samples_of(const fs::path& folder, const ReferenceJob& order) {
  const fs::path file = folder / "response.csv";
  std::vector<PressSample> samples = meshes::PressResponse::read_csv(file).samples();
  const auto refuse = [&](const std::string& value, const std::string& rule) {
    throw InvalidInput({file.string(), value, rule, "run this press again, to its end"});
  };
  if (samples.size() != order.protocol.samples.size())
    refuse(std::to_string(samples.size()) + " samples",
           "a table needs the " + std::to_string(order.protocol.samples.size()) +
               " samples of its order");
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double wanted = order.protocol.samples[i], depth = samples[i].indentation;
    if (!(std::abs(depth - wanted) <= 1e-9 * wanted))
      refuse(meshes::to_text(depth) + " m",
             "the order has its sample at " + meshes::to_text(wanted) + " m");
    if (!(samples[i].normal_force > 0.0))
      refuse(meshes::to_text(samples[i].normal_force) + " N", "a pressed tip has a force > 0");
  }
  return samples;
}

}  // namespace

std::vector<ReferenceJob> continuum_table_orders(const ReferenceJob& order,
                                                 const std::vector<double>& poissons_ratios) {
  std::vector<ReferenceJob> orders;
  std::vector<Violation> broken;
  if (order.analysis != fem_reference::Analysis::static_press)
    broken.push_back({"reference.mode", std::string(name(order.analysis)),
                      "a table is made of static presses", "choose reference.mode = \"static\""});
  for (const double nu : poissons_ratios) {
    ReferenceJob& one = orders.emplace_back(order);
    one.rubber.youngs_modulus = 2.0 * order.rubber.shear_modulus * (1.0 + nu);
    one.write_fields = false;
    for (Violation violation : one.violations()) {
      violation.value += " (at Poisson's ratio " + meshes::to_text(nu) + " of the table)";
      broken.push_back(std::move(violation));
    }
  }
  if (!broken.empty()) throw InvalidInput(broken);
  return orders;
}

ContinuumTable read_continuum_table(const ReferenceJob& order,
                                    const std::vector<double>& poissons_ratios,
                                    const std::vector<fs::path>& folders,
                                    const std::vector<calibration::MaterialParameter>& parameters) {
  if (folders.size() != poissons_ratios.size())
    throw InvalidInput(
        {"folders", std::to_string(folders.size()),
         "a table has one run per Poisson's ratio, here " + std::to_string(poissons_ratios.size()),
         "give a folder for each"});
  const Index rows = Index(order.protocol.samples.size());
  Eigen::MatrixXd scaled(rows, Index(folders.size()));
  Eigen::VectorXd error = Eigen::VectorXd::Zero(rows);
  for (Index k = 0; k < scaled.cols(); ++k) {
    const auto samples = samples_of(folders[std::size_t(k)], order);
    for (Index i = 0; i < rows; ++i) {
      const PressSample& sample = samples[std::size_t(i)];
      scaled(i, k) = sample.normal_force / order.rubber.shear_modulus;
      // Written so that one unknown error makes the largest unknown.
      const double relative = sample.force_error / sample.normal_force;
      if (!(relative <= error(i))) error(i) = std::isnan(error(i)) ? error(i) : relative;
    }
  }
  return {calibration::ScaledTable(poissons_ratios, scaled, parameters, order.rubber),
          std::move(error)};
}

}  // namespace fingertip::studies
