// Fingers for simulators whose contact is a law: what is written, and what these programs make of
// it.

#include <gtest/gtest.h>

#include <boost/property_tree/xml_parser.hpp>
#include <cmath>
#include <cstdlib>
#include <sstream>
#ifdef FINGERTIP_SDFORMAT
#include <sdf/Collision.hh>
#include <sdf/Geometry.hh>
#include <sdf/Link.hh>
#include <sdf/Model.hh>
#include <sdf/Root.hh>
#include <sdf/Sphere.hh>
#endif

#include "tests/studies/workplace.h"

using nlohmann::json;

namespace {

namespace tree = boost::property_tree;

/// Into the folder "run", of a quick continuum: small strain, wide bars; and few tetrahedra.
std::string to(const std::string& format) {
  return "export --out run --format " + format;
}
const Words quick = {"reference.strain=linear", "reference.tolerance=0.02", "press.depth=2 mm",
                     "exchange.edge=8 mm"};
const Words slips = quick + Words{"press.contact=frictionless"};
const Words sticks = quick + Words{"press.contact=stick"};

/// The file as a tree; throws where it is not well-formed.
tree::ptree parsed(const std::filesystem::path& file) {
  tree::ptree found;
  tree::read_xml(file.string(), found);
  return found;
}

std::vector<double> numbers_of(const tree::ptree& node, const std::string& attribute) {
  std::istringstream text(node.get<std::string>("<xmlattr>." + attribute));
  return {std::istream_iterator<double>(text), {}};
}

const json& model_of(const json& obstacle, const std::string& name) {
  for (const json& model : obstacle["models"])
    if (model["model"] == name) return model;
  throw std::runtime_error("no model " + name);
}

}  // namespace

TEST(ContactExport, EveryFormatIsWrittenWithTheForceErrorToExpect) {
  const Workplace folder;
  EXPECT_TRUE(
      says(folder.run(to("all"), slips).out,
           {"pressure-law: table", "mujoco: flex", "drake: hydroelastic ball", "newton: table"}));
  const json transfer = folder.json("run/transfer.json");
  ASSERT_EQ(transfer["obstacles"].size(), 3U);
  EXPECT_TRUE(transfer["lost"].empty());
  const json& plane = transfer["obstacles"][0];
  EXPECT_TRUE(plane["fitted"].get<bool>());
  ASSERT_EQ(plane["force"].size(), 5U);
  const json &table = model_of(plane, "pressure-law: table"),
             &power = model_of(plane, "pressure-law: power");
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_LT(std::abs(table["error"][i].get<double>()), 0.01);
    EXPECT_LT(std::abs(power["error"][i].get<double>()), 0.1);
    EXPECT_NEAR(power["force"][i].get<double>() / plane["force"][i].get<double>() - 1.0,
                power["error"][i].get<double>(), 1e-12);
  }
  EXPECT_NEAR(table["carries_to"].get<double>(), 2e-3, 1e-12);
  // A foundation takes a ball of half the relative radius for half as stiff, a half space for
  // 1/sqrt(2): at the least depth the truth is between. A contact of the penetration alone takes it
  // for as stiff as the plane.
  const json& ball = transfer["obstacles"][1];
  EXPECT_EQ(ball["obstacle"], "sphere of 10 mm");
  const double error = model_of(ball, "pressure-law: table")["error"][0];
  EXPECT_LT(error, -0.1);
  EXPECT_GT(error, 1.0 / std::sqrt(2.0) - 1.0 - 0.02);
  EXPECT_GT(model_of(ball, "mujoco: rigid geom")["error"][0].get<double>(), 0.3);
  EXPECT_TRUE(model_of(ball, "mujoco: flex")["error"][0].is_null());

  // On a dome newton's straight line is Drake's ball.
  EXPECT_LT(std::abs(model_of(plane, "newton: table")["error"][2].get<double>()), 0.01);
  for (const json& obstacle : transfer["obstacles"])
    for (std::size_t i = 0; i < 5; ++i)
      EXPECT_NEAR(model_of(obstacle, "newton: kh")["error"][i].get<double>(),
                  model_of(obstacle, "drake: hydroelastic ball")["error"][i].get<double>(), 0.01);

  const json law = folder.json("run/pressure-law/pressure_law.json");
  EXPECT_GT(law["exponent"].get<double>(), 0.5);  // Hertz' on a half space
  EXPECT_NEAR(law["hydroelastic_modulus"].get<double>() / law["line"].get<double>(), 0.01, 1e-9);
  EXPECT_TRUE(
      folder.text("run/pressure-law/pressure_table.csv").starts_with("penetration [m],pressure"));
  for (const std::string format :
       {"", "pressure-law/", "newton/", "mujoco/", "drake/", "sofa/", "vtk/"})
    EXPECT_TRUE(says(folder.text("run/" + format + "README.md"), "Force error to expect"));
}

/// newton is not at hand: its file's law as Python without Warp.
TEST(ContactExport, NewtonsLawIsTheTable) {
  const Workplace folder;
  folder.run(to("newton"), slips);
  const std::string script = "python3 -B '" FINGERTIP_SOURCES
                             "/tests/studies/exchange/newton_law.py' '" +
                             (folder / "run").string() + "'";
  EXPECT_EQ(std::system(script.c_str()), 0);
}

TEST(ContactExport, SoftBodiesAreTheSameForEveryProgram) {
  const Workplace folder;
  folder.run(to("all"), slips);
  const tree::ptree scene = parsed(folder / "run/sofa/finger.scn").get_child("Node.Node");
  const tree::ptree flex =
      parsed(folder / "run/mujoco/finger_flex.xml").get_child("mujoco.worldbody.flexcomp");
  const tree::ptree& mesh = scene.get_child("TetrahedronSetTopologyContainer");
  const std::vector<double> places = numbers_of(mesh, "position");
  EXPECT_EQ(places, numbers_of(flex, "point"));
  EXPECT_EQ(numbers_of(mesh, "tetrahedra"), numbers_of(flex, "element"));
  EXPECT_EQ(numbers_of(scene.get_child("FixedProjectiveConstraint"), "indices"),
            numbers_of(flex.get_child("pin"), "id"));
  EXPECT_EQ(numbers_of(scene.get_child("UniformMass"), "totalMass"), numbers_of(flex, "mass"));
  // mu and lambda there are those of half of lambda here.
  const std::vector<double> law =
      numbers_of(scene.get_child("TetrahedronHyperelasticityFEMForceField"), "ParameterSet");
  ASSERT_EQ(law.size(), 2U);
  const double young = numbers_of(flex.get_child("elasticity"), "young")[0],
               poisson = numbers_of(flex.get_child("elasticity"), "poisson")[0];
  const double mu = 0.5 * young / (1.0 + poisson),
               lambda = 2.0 * mu * poisson / (1.0 - 2.0 * poisson);
  EXPECT_NEAR(mu / law[0], 1.0, 1e-7);
  EXPECT_NEAR(2.0 * lambda / law[1], 1.0, 1e-7);
  // The plane touches the highest vertex; a vertex behind it is pushed as MuJoCo pushes it.
  double top = 0.0;
  for (std::size_t i = 2; i < places.size(); i += 3) top = std::max(top, places[i]);
  const tree::ptree& plane = scene.get_child("PlaneForceField");
  EXPECT_NEAR(numbers_of(plane, "d")[0], -top, 1e-12);
  const double vertex = numbers_of(flex, "mass")[0] / (double(places.size()) / 3.0);
  const std::vector<double> solref = numbers_of(flex.get_child("contact"), "solref"),
                            solimp = numbers_of(flex.get_child("contact"), "solimp");
  EXPECT_NEAR(-solref[0] * vertex / (1.0 - solimp[0]) / numbers_of(plane, "stiffness")[0], 1.0,
              1e-7);
  const tree::ptree piece =
      parsed(folder / "run/vtk/finger.vtu").get_child("VTKFile.UnstructuredGrid.Piece");
  EXPECT_EQ(std::size_t(numbers_of(piece, "NumberOfPoints")[0]), places.size() / 3);
  EXPECT_EQ(std::size_t(numbers_of(piece, "NumberOfCells")[0]),
            numbers_of(mesh, "tetrahedra").size() / 4);
}

/// Its forces under balls are not foretold, so the continuum is not pressed on them, either; a
/// tilt is refused in words that fit.
TEST(ContactExport, AMeshNeedsOnePress) {
  const Workplace folder;
  const std::string told = folder.run(to("vtk"), slips + Words{"press.tilt=0.1 rad"}, 2).err;
  EXPECT_TRUE(says(told, "fitted to a press straight down; choose 0"));
  EXPECT_TRUE(omits(told, "pressure"));
  folder.run(to("vtk"), slips);
  const json transfer = folder.json("run/transfer.json");
  ASSERT_EQ(transfer["obstacles"].size(), 1U);
  EXPECT_LT(std::abs(model_of(transfer["obstacles"][0], "tetrahedra")["error"][2].get<double>()),
            0.2);
  EXPECT_FALSE(folder.has("run/continuum/2"));
}

/// What MuJoCo makes of the folder "run"; null where it fails.
json pressed_in_mujoco(const Workplace& folder) {
  const std::string press =
      "node '" FINGERTIP_SOURCES "/tests/studies/exchange/press_in_mujoco.mjs' '" FINGERTIP_MUJOCO
      "' '" +
      (folder / "run").string() + "' > '" + (folder / "forces.json").string() + "'";
  return std::system(press.c_str()) == 0 ? folder.json("forces.json") : json();
}

/// Friction lets go of a turn about the normal where transfer.json says; the model's one length is
/// right in the middle of the loads.
TEST(ContactExport, MuJoCoTurnsAsForetold) {
  if (!std::filesystem::exists(FINGERTIP_MUJOCO))
    GTEST_SKIP() << "MuJoCo is not installed: ./fingertip test installs it";
  const Workplace folder;
  folder.run(to("mujoco"), quick + Words{"press.contact=coulomb", "press.friction=0.6"});
  const json obstacle = folder.json("run/transfer.json")["obstacles"][0];
  ASSERT_EQ(obstacle["torsion"].size(), 1U);
  const json& torsion = obstacle["torsion"][0];
  const json forces = pressed_in_mujoco(folder);
  ASSERT_FALSE(forces.is_null());
  for (std::size_t i = 0; i < 5; ++i) {
    const double foretold = torsion["model_moment"][i];
    EXPECT_NEAR(forces["torsion"][i].get<double>() / foretold, 1.0, 0.05) << i;
    // Of Hertz' pressure 3 pi/16 mu N a; the radius is that of a dome of 10 mm, 1 to 5 mm.
    const double arm =
        torsion["moment"][i].get<double>() / (0.6 * 0.589 * obstacle["force"][i].get<double>());
    EXPECT_GT(arm, 1e-3);
    EXPECT_LT(arm, 6e-3);
  }
  EXPECT_GT(torsion["error"].front().get<double>(), 0.0);
  EXPECT_LT(torsion["error"].back().get<double>(), 0.0);
  EXPECT_TRUE(says(folder.text("run/finger_rigid.xml"), "condim=\"4\""));
  EXPECT_TRUE(says(folder.text("run/README.md"), "about the normal"));
}

/// At the servo's target; and its README tells which version it needs.
TEST(ContactExport, MuJoCoPressesAsForetold) {
  if (!std::filesystem::exists(FINGERTIP_MUJOCO))
    GTEST_SKIP() << "MuJoCo is not installed: ./fingertip test installs it";
  const Workplace folder;
  const ProgramResult made = folder.run(to("mujoco"), slips);
  const json forces = pressed_in_mujoco(folder);
  ASSERT_FALSE(forces.is_null());
  const json models = folder.json("run/transfer.json")["obstacles"][0]["models"];
  int compared = 0;
  for (const auto& [file, model] : {std::pair("finger_rigid.xml", 0), {"finger_flex.xml", 1}})
    for (std::size_t i = 0; i < 5; ++i) {
      const json& foretold = models[std::size_t(model)]["force"][i];
      ASSERT_EQ(foretold.is_null(), forces[file][i].is_null());
      if (foretold.is_null()) continue;
      ++compared;
      EXPECT_NEAR(forces[file][i].get<double>() / foretold.get<double>(), 1.0, 0.01)
          << file << ", depth " << i;
    }
  EXPECT_GE(compared, 8);
  for (const char* file : {"run/README.md", "run/finger_flex.xml"})
    EXPECT_TRUE(says(folder.text(file), "MuJoCo 3.13")) << file;
  // So few tetrahedra meet the continuum at one depth.
  EXPECT_TRUE(says(made.out, "at 0.5 mm alone"));
}

TEST(ContactExport, LibsdformatAcceptsDrakesFile) {
#ifdef FINGERTIP_SDFORMAT
  const Workplace folder;
  folder.run(to("drake"), slips);
  sdf::Root root;
  const sdf::Errors errors = root.Load((folder / "run/finger.sdf").string());
  for (const sdf::Error& error : errors) ADD_FAILURE() << error.Message();
  ASSERT_NE(root.Model(), nullptr);
  const sdf::Collision* collision = root.Model()->LinkByIndex(0)->CollisionByIndex(0);
  const auto properties = collision->Element()->GetElement("drake:proximity_properties");
  EXPECT_GT(properties->Get<double>("drake:hydroelastic_modulus"), 0.0);
  EXPECT_NEAR(collision->Geom()->SphereShape()->Radius(), 0.01, 1e-12);
#else
  GTEST_SKIP() << "libsdformat is not installed: ./fingertip test installs it";
#endif
}

/// The default press sticks; who says nothing of the contact must not be refused for it.
TEST(ContactExport, AContactNotGivenIsFrictionless) {
  const Workplace folder;
  EXPECT_TRUE(says(folder.run(to("pressure-law"), quick).err,
                   "note: press.contact is not given: frictionless is taken"));
  const json taken = folder.json("run/transfer.json");
  EXPECT_TRUE(taken["lost"].empty());
  folder.run("export --out given --format pressure-law", slips);
  EXPECT_EQ(taken, folder.json("given/transfer.json"));
}

TEST(ContactExport, WhatAFormatCannotSayIsRefusedUnlessAskedFor) {
  const Workplace folder;
  folder.expect_refused(to("pressure-law"), sticks,
                        "add --set press.contact=frictionless, or --lossy");
  folder.expect_refused(to("drake") + " --lossy", quick + Words{"press.tilt=0.1 rad"},
                        "press.tilt");
  folder.run(to("pressure-law") + " --lossy", sticks);
  const json lost = folder.json("run/transfer.json")["lost"];
  ASSERT_EQ(lost.size(), 1U);
  EXPECT_TRUE(says(lost[0], "press.contact"));
}

TEST(ContactExport, SoftBodiesUnderOtherThanPlanesAreLeftOut) {
  const Workplace folder;
  const Words ball = slips + Words{"obstacle.shape=sphere", "obstacle.radius=8 mm"},
              edge = slips + Words{"obstacle.shape=edge", "obstacle.radius=8 mm"};
  folder.expect_refused(to("sofa"), ball, "obstacle.shape");
  // Before the continuum is pressed.
  folder.expect_refused(to("mujoco"), edge, "cylinder of the same radius");
  EXPECT_TRUE(says(folder.run(to("all"), ball).out, "sofa: "));
  EXPECT_FALSE(folder.has("run/sofa"));
  EXPECT_TRUE(folder.has("run/mujoco/finger_rigid.xml"));
  EXPECT_FALSE(folder.has("run/mujoco/finger_flex.xml"));
}
