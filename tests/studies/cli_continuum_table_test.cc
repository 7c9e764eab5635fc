// A table from real runs of the continuum, on a mesh coarse enough for a test, against a run of its
// own between the nodes and with other moduli.

#include <gtest/gtest.h>

#include "meshes/files.h"
#include "meshes/press_response.h"
#include "program.h"
#include "studies/run/continuum_table.h"
#include "tests/temporary_folder.h"

namespace fs = std::filesystem;
using namespace fingertip;
using namespace fingertip::studies;
using enum calibration::MaterialParameter;

namespace {

/// The forces of `order` on the first mesh, in the folder `name`.
void press(const TemporaryFolder& folder, const std::string& name,
           const fem_reference::ReferenceJob& order) {
  const auto quantity = [](const std::string& key, double value) {
    return key + "=" + meshes::to_text(value) + " Pa";
  };
  const ProgramResult result = run_program(
      folder.path(), {"reference", "--out", name, "--set", "reference.estimate_error=false",
                      "--set", "reference.refinement=0.25", "--set", "press.contact=frictionless",
                      "--set", "press.samples=[\"0.02 cm\", \"0.08 cm\"]", "--set",
                      quantity("rubber.youngs_modulus", order.rubber.youngs_modulus), "--set",
                      quantity("rubber.shear_modulus", order.rubber.shear_modulus)});
  ASSERT_EQ(result.code, 0) << result.err;
}

}  // namespace

TEST(ContinuumTable, ForeseesARunBetweenItsNodes) {
  const TemporaryFolder folder;
  fem_reference::ReferenceJob order;
  order.press_to({2e-4, 8e-4});
  const auto nodes = calibration::chebyshev_nodes(0.2, 0.45, 5);
  std::vector<fs::path> folders;
  for (const auto& one : continuum_table_orders(order, nodes)) {
    const std::string name = "node_" + std::to_string(folders.size());
    press(folder, name, one);
    folders.push_back(folder / name);
  }
  ContinuumTable made =
      read_continuum_table(order, nodes, folders, {youngs_modulus, shear_modulus});
  fem_reference::ReferenceJob other = order;
  other.rubber.shear_modulus = 3.0 * order.rubber.shear_modulus;
  other.rubber.youngs_modulus = 2.0 * other.rubber.shear_modulus * 1.38;
  press(folder, "other", other);
  const auto expected = meshes::PressResponse::read_csv(folder / "other/response.csv").samples();
  const auto forces =
      made.table.evaluate(Eigen::Vector2d(other.rubber.youngs_modulus, other.rubber.shear_modulus));
  for (int i = 0; i < 2; ++i) {
    const double error = std::abs(forces.value(i) / expected[std::size_t(i)].normal_force - 1.0);
    EXPECT_LT(error, made.table.interpolation_error()(i)) << i;
    EXPECT_LT(error, 1e-3) << i;
  }
  EXPECT_TRUE(made.continuum_error.array().isNaN().all()) << "not estimated on one mesh";
}
