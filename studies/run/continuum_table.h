/// The continuum as a forward model: presses at a few Poisson's ratios, and the table from them.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <vector>

#include "calibration/curves/scaled_table.h"
#include "fem_reference/job.h"

namespace fingertip::studies {

/// `order` once per Poisson's ratio, with its G and E = 2G(1 + nu), without fields. Depth, contact,
/// tilt, strain, law, mesh and tolerance are the order's. Throws InvalidInput, with the Poisson's
/// ratio in its value, for an order that is no static press or breaks a rule (finite strain with
/// the laws A and B needs nu >= 0).
std::vector<fem_reference::ReferenceJob> continuum_table_orders(
    const fem_reference::ReferenceJob& order, const std::vector<double>& poissons_ratios);

struct ContinuumTable {
  calibration::ScaledTable table;  ///< at the samples of the order
  /// Largest force_error over normal_force of all runs at every sample, dimensionless; NaN where a
  /// run has not estimated it.
  Eigen::VectorXd continuum_error;
};

/// The table from the folders in which `continuum_table_orders` were carried out, in their order.
/// Throws InvalidInput for another number of folders, a response.csv that cannot be read or has
/// other samples than the order, forces that are not positive, and what ScaledTable refuses.
ContinuumTable read_continuum_table(const fem_reference::ReferenceJob& order,
                                    const std::vector<double>& poissons_ratios,
                                    const std::vector<std::filesystem::path>& folders,
                                    const std::vector<calibration::MaterialParameter>& parameters);

}  // namespace fingertip::studies
