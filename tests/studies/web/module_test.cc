// The module under Node: the forces of the program.
#include <gtest/gtest.h>

#include <cstring>
#include <nlohmann/json.hpp>

#include "meshes/base/files.h"
#include "meshes/base/text_file.h"
#include "studies/files/process.h"
#include "studies/web/page_session.h"
#include "studies/web/web_folder.h"
#include "tests/coarse_press.h"
#include "tests/fingers.h"
#include "tests/studies/presses/pictures/vtk_reader.h"
#include "tests/temporary_folder.h"

using namespace fingertip;
using namespace fingertip::studies;

namespace {

constexpr int periods = 45;  // to 1 mm and some rest

nlohmann::json head_of(const std::string& frame) {
  std::uint32_t length = 0;
  std::memcpy(&length, frame.data(), 4);
  return nlohmann::json::parse(frame.substr(4, length));
}

/// The last frame of the module.
nlohmann::json module_frame(const WebPress& press) {
  const TemporaryFolder folder;
  meshes::write_json_file(press, folder / "press.json");
  const int code =
      run_process({{program_on_path("node").string(), FINGERTIP_DRIVER, module_file().string(),
                    (folder / "press.json").string(), std::to_string(periods)},
                   {}},
                  folder / "told.json");
  const std::string told = meshes::read_text(folder / "told.json");
  EXPECT_EQ(code, 0) << told;
  const nlohmann::json answer = nlohmann::json::parse(told);
  EXPECT_GT(answer.at("pace"), 0.0);
  return head_of(decoded(answer.at("told").back().at(1)));
}

/// The same of the rig in this program.
nlohmann::json program_frame(const WebPress& press) {
  PageSession session(press);
  for (int i = 0; i < periods; ++i) session.take(R"({"type":"step"})");
  session.run(PageSession::Seconds(60.0));
  return head_of(session.answers().back().bytes);
}

class WebModule : public testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(module_file()) || program_on_path("node").empty())
      GTEST_SKIP() << "the module is not built (./fingertip web builds it)";
  }
  static void expect_equal(const WebPress& press) {
    const nlohmann::json ours = program_frame(press), theirs = module_frame(press);
    EXPECT_NEAR(ours.at("time"), 1e-3 * periods, 1e-12);
    EXPECT_GT(ours.at("normal_force"), 1e-2);
    for (const char* name : {"time", "indentation", "normal_force", "contact_radius"}) {
      const double value = ours.at(name);
      EXPECT_NEAR(theirs.at(name), value, 1e-9 * std::abs(value)) << name;
    }
    EXPECT_EQ(ours.at("touching"), theirs.at("touching"));
  }
};

}  // namespace

TEST_F(WebModule, PressesADomeAsTheProgramDoes) {
  expect_equal({coarse_press(), {}, {}});
}

TEST_F(WebModule, PressesAProfileAtLargeStrainAsTheProgramDoes) {
  WebPress press{coarse_press(), {}, {}};
  lattice::PressSetup& setup = press.setup;
  setup.geometry = meshes::Geometry::of_profile(fingers::solid());
  setup.lattice.model = lattice::ModelKind::network;
  setup.lattice.kinematics = lattice::Kinematics::finite;
  setup.lattice.spacing = setup.geometry.tip_radius / 5.0;
  setup.lattice.constants = lattice::hookean_constants(setup.rubber, setup.lattice.spacing);
  expect_equal(press);
}

TEST_F(WebModule, ScaledMassesKeepTheForce) {
  WebPress press{coarse_press(), {}, {}};
  press.setup.integrator = lattice::Integrator::mass_scaled;
  const nlohmann::json ours = program_frame(press), theirs = module_frame(press);
  // Their inertia is in single precision.
  EXPECT_NEAR(theirs.at("normal_force"), double(ours.at("normal_force")),
              1e-5 * double(ours.at("normal_force")));
}
