// Every key of the table against every kind of job: either changing the key makes another job of
// it, whose result is not looked for under the old one, or the key stands here as one that the
// result does not depend on.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <functional>
#include <map>
#include <optional>
#include <ostream>
#include <sstream>

#include "meshes/base/files.h"
#include "meshes/press/press_response.h"
#include "studies/config/keys/key_table.h"
#include "studies/config/value_reader.h"
#include "studies/fits/runs/calibration_stages.h"
#include "studies/fits/runs/plan_job.h"
#include "studies/fits/setup/configured_fit.h"
#include "studies/presses/grasp_job.h"
#include "studies/presses/modes_job.h"
#include "studies/presses/press_job.h"
#include "studies/presses/press_setup.h"
#include "studies/presses/reference_job.h"
#include "tests/fingers.h"
#include "tests/stl_text.h"
#include "tests/temporary_folder.h"

using namespace fingertip::studies;
namespace meshes = fingertip::meshes;
namespace fs = std::filesystem;

namespace {

using Sets = std::vector<std::string>;
using Identity = std::function<std::string(const LoadedConfig&)>;

Sets operator+(Sets all, const Sets& more) {
  all.insert(all.end(), more.begin(), more.end());
  return all;
}

/// The words of a text.
Sets split(const std::string& text) {
  std::istringstream words(text);
  return {std::istream_iterator<std::string>(words), {}};
}

std::string press(const LoadedConfig& loaded) {
  return press_job(press_setup(loaded)).key();
}
std::string lattice_modes(const LoadedConfig& loaded) {
  return modes_job(press_setup(loaded), loaded.config.lattice_modes).key();
}
std::string grasp(const LoadedConfig& loaded) {
  return grasp_job(grasp_setup(loaded)).key();
}
std::string continuum(const LoadedConfig& loaded) {
  return reference_job(continuum_setup(loaded)).key();
}

/// What a continuum might have answered.
void answer(const PlannedJob& planned, const fs::path& folder) {
  meshes::PressResponse response;
  for (const double depth : planned.job.inputs["protocol"]["samples"]) {
    meshes::PressSample sample;
    sample.indentation = depth;
    sample.normal_force = 100.0 * depth;
    response.append(sample);
  }
  fs::create_directories(folder / planned.name);
  response.write_csv(folder / planned.name / "response.csv");
}

/// The jobs of a calibration up to its fit.
std::string calibration(const LoadedConfig& loaded) {
  const TemporaryFolder run;
  CalibrationStages plan(loaded, "", CalibrationStages::Failed::refused);
  std::string keys;
  for (bool fitted = false; !fitted;)
    for (const PlannedJob& planned : plan.next(run.path())) {
      keys += planned.job.key();
      fitted = planned.job.kind != "reference";
      if (!fitted) answer(planned, run.path());
    }
  return keys;
}

/// Values of a key besides the one it has; some may be refused.
Sets other_values(const Key& key, const std::string& literal) {
  static const std::map<std::string, Sets> given = {
      {"lattice.spacing", {"tip_radius/7"}},
      {"lattice.rotation", {"[\"1 deg\", \"0 deg\", \"0 deg\"]"}},
      {"sensor.taxels", {"{rings = 2}"}},
      {"press.samples", {"[\"0.1 cm\", \"0.3 cm\"]"}},
      {"press.program", {"[[\"0.3 cm\", \"1 cm/s\"], [\"0 cm\", \"1 cm/s\"]]"}},
      {"calibration.conditions", {"[\"press.contact=frictionless\"]"}},
      {"calibration.parameters", {"[\"k1\", \"k2\"]", "[\"youngs_modulus\"]"}},
      {"calibration.profile", {"[\"k1\", \"k2\"]", "[\"youngs_modulus\", \"shear_modulus\"]"}},
      {"rubber.poissons_ratio", {"0.4"}},
      {"rubber.bulk_modulus", {"1 MPa"}},
      {"rubber.yeoh", {"[\"3 kPa\"]"}},
      {"rubber.mooney_rivlin", {"[\"3 kPa\", \"1 kPa\"]"}},
      {"rubber.ogden", {"[[\"3 kPa\", 2.5]]"}},
      {"rubber.relaxation", {"[[0.2, \"0.1 s\"]]"}},
      {"rubber.shore_hardness", {"30.0"}}};
  if (const auto found = given.find(key.full_name()); found != given.end()) return found->second;
  const std::string text = unquoted(literal);
  Sets values;
  switch (key.kind) {
    case Kind::choice:
    case Kind::source:
      for (const Choice& choice : key.choices)
        if (choice.word != text) values.push_back(choice.word);
      return values;
    case Kind::boolean: return {text == "true" ? "false" : "true"};
    case Kind::integer:
      return {std::to_string(std::stol(text) + 1), std::to_string(std::stol(text) + 16)};
    case Kind::numbers: return {"[0.1, 0.2, 0.3]"};
    case Kind::number_pair: return {"[0.1, 0.4]"};
    case Kind::number:
    case Kind::quantity: {
      const std::string unit = key.kind == Kind::quantity ? " " + key.unit : "";
      if (text == "auto") return {"1e-5" + unit, "0.1" + unit};
      std::size_t end = 0;
      const double number = std::stod(text, &end);
      if (number == 0.0) return {"0.001" + unit};
      for (const double factor : {0.9, 1.1})
        values.push_back(meshes::to_text(factor * number) + text.substr(end));
      return values;
    }
    default: return {"unix:other.socket"};
  }
}

std::optional<std::string> identity_of(const Identity& identity, const Sets& sets) {
  try {
    return identity(load_config({{}, sets, {}}));
  } catch (const meshes::InvalidInput&) {
  }
  return {};
}

struct World {
  const char* name;
  Sets sets;  ///< under which as much as possible matters
  Identity identity;
  Sets idle;  ///< keys without effect, sections as "rod."
};

bool lists(const Sets& list, const Key& key) {
  return std::ranges::any_of(list, [&](const std::string& entry) {
    return entry.ends_with('.') ? key.section + "." == entry : key.full_name() == entry;
  });
}

struct Base {
  std::optional<std::string> identity;
  decltype(LoadedConfig::entries) entries;
};

/// Most keys are compared with the same.
const Base& base_of(const World& world, const Sets& sets) {
  static std::map<Sets, Base> known;
  const auto [found, anew] = known.try_emplace(Sets{world.name} + sets);
  Base& base = found->second;
  if (anew) base.identity = identity_of(world.identity, sets);
  if (anew && base.identity) base.entries = load_config({{}, sets, {}}).entries;
  return base;
}

/// Whether any other value makes another job.
bool matters(const World& world, const Key& key) {
  Sets sets = world.sets;
  if (!key.matters_with.empty()) sets.push_back(key.matters_with + "=" + key.matters_words[0]);
  if (key.full_name() == "lattice.constants") sets.emplace_back("lattice.model=central");
  static const std::map<std::string, const char*> coefficients = {
      {"rubber.yeoh", "rubber.yeoh=[\"2 kPa\"]"},
      {"rubber.mooney_rivlin", "rubber.mooney_rivlin=[\"2 kPa\", \"1 kPa\"]"},
      {"rubber.ogden", "rubber.ogden=[[\"2 kPa\", 2.5]]"},
      {"rubber.gent_jm", "rubber.gent_jm=9.0"},
      {"rubber.relaxation_bulk", "rubber.relaxation=[[0.2, \"0.1 s\"]]"}};
  if (const auto own = coefficients.find(key.full_name()); own != coefficients.end())
    sets.emplace_back(own->second);
  const Base& base = base_of(world, sets);
  if (!base.identity) return false;
  const std::string literal = base.entries.at(key.full_name()).literal;
  return std::ranges::any_of(other_values(key, literal), [&](const std::string& value) {
    const auto changed = identity_of(world.identity, sets + Sets{key.full_name() + "=" + value});
    return changed && changed != base.identity;
  });
}

void PrintTo(const World& world, std::ostream* out) {
  *out << world.name;
}

/// No result depends on these: screens and threads, what verbs without a cache do, what is asked of
/// another process, files whose content counts and not their name (controller_choice_test).
const Sets nowhere = {  // At small strain E and G alone count; see KnowsTheLawAtLargeStrain.
    // Nobody but people's own controllers asks a skin; see ChangesWithTheSkinThatItFeels.
    "sensor.taxels", "sensor.pitch", "sensor.footprint", "sensor.depth", "sensor.noise",
    "sensor.resolution", "sensor.rate", "sensor.latency", "rubber.law", "rubber.volumetric",
    "rubber.gent_jm", "run.threads", "run.units", "run.error",
    // Of spacing = "auto"; see finger_defaults_test.
    "lattice.max_particles", "exchange.", "controller.address", "controller.timeout",
    "controller.connect_timeout", "controller.library", "controller.schedule",
    // Of other shapes, see below.
    "geometry.shape", "geometry.profile", "geometry.file", "geometry.unit", "geometry.up",
    "geometry.origin", "geometry.bond", "geometry.endpoint",
    // Its keys count, and of material tests what they say (law_job_test).
    "rubber.card", "calibration.tests", "calibration.laws", "calibration.weights",
    "calibration.branches", "calibration.stretch_range",
    // Of measured files; see ChangesWithItsDataAndHowTheyWereTaken.
    "calibration.rig", "calibration.machine", "calibration.candidates", "calibration.intervals",
    "calibration.tolerances",
    // No search of moduli has random starts any more; those of laws see law_job_test.
    "calibration.starts", "calibration.seed",
    // Of plans; see IdentityOfAPlan. The other contact is another fit.
    "calibration.noise", "calibration.noise_force", "calibration.contact",
    // Of displacements.
    "calibration.frame"};
/// Of the fit of constants to moduli.
const Sets moduli_fit = {"calibration.isotropy_weight", "calibration.bulk_weight"};
/// What becomes of a fit: further jobs.
const Sets follow_up = {"calibration.bias", "calibration.surrogate"};
const Sets controllers = split(
    "controller.type controller.natural_frequency controller.derivative_filter "
    "controller.setpoint_weight controller.bond_compensation controller.force_limit "
    "controller.torque_limit controller.sensitivity controller.relay controller.adaptation "
    "controller.memory controller.force controller.force_bandwidth controller.touch_force "
    "controller.release_force controller.confirmation controller.dwell");
const Sets no_continuum = {"reference."}, no_fit = {"calibration."}, no_grasp = {"grasp."},
           no_markers = {"sensor.markers", "sensor.marker_pitch", "sensor.marker_depth"},
           no_modes = {"lattice.modes"}, no_rod = {"rod.", "hardware."},
           no_time = {"run.",          "controller.",   "press.speed", "press.clearance",
                      "press.gravity", "press.duration"};
/// A lattice that moves does so diagonally, and knows no slopes.
const Sets diagonal = {"press.lateral_path", "press.lateral_samples", "press.twist",
                       "press.slopes"},
           no_friction = {"press.friction"};
/// Refused where a lattice in equilibrium takes part.
const Sets relaxation = {"rubber.relaxation", "rubber.relaxation_bulk"};
/// The continuum beside a fit is what the fit needs.
const Sets beside = {"reference.mode",  "reference.strain", "reference.law",
                     "reference.modes", "reference.fields", "reference.field_sectors"};
/// A fit presses where its data are.
const Sets own_depths = {"press.mode", "press.depth", "press.samples", "press.program"};

const World worlds[] = {
    {"controlled press",
     {},
     press,
     nowhere + diagonal + no_continuum + no_fit + no_grasp + no_modes},
    {"driven press",
     {"press.mode=quasi-static"},
     press,
     nowhere + diagonal + no_continuum + no_fit + no_grasp + no_modes + no_rod + controllers},
    {"static press",
     {"press.mode=static", "press.lateral=1 mm"},
     press,
     nowhere + no_continuum + no_fit + no_grasp + no_modes + no_rod + no_time + relaxation +
         Sets{"press.lateral_samples"} + Sets{"rubber.density", "rubber.retardation_time"}},
    {"lattice's modes",
     {"press.mode=static", "lattice.spacing=tip_radius/12"},
     lattice_modes,
     nowhere + no_markers + no_continuum + no_fit + no_grasp + no_rod + no_time + relaxation +
         split("press. obstacle. rubber.retardation_time")},
    {"grasp",
     {"lattice.spacing=tip_radius/12"},
     grasp,
     nowhere + no_markers + diagonal + no_continuum + no_fit + no_modes + no_rod + controllers +
         // The rods are driven as the grip says; it takes symplectic Euler alone.
         split("obstacle. press.mode press.tilt press.lateral press.depth press.speed "
               "press.samples press.program press.gravity press.duration run.integrator "
               "run.tolerance run.energy_bound run.symmetry")},
    {"continuum",
     {"press.lateral=1 mm"},
     continuum,
     nowhere + Sets{"press.lateral_samples"} + no_fit + no_grasp + no_rod + no_time +
         // Aside, so that it is no meridian.
         split("lattice. press.mode press.slopes rubber.density rubber.retardation_time "
               "reference.field_sectors")},
    {"continuum in time",
     {"reference.mode=transient"},
     continuum,
     nowhere + no_fit + no_grasp + no_rod + no_friction + diagonal +
         // It knows small strain and upright presses that start at the plane.
         split("run. controller. lattice. press.mode press.clearance press.gravity press.duration "
               "press.tilt press.lateral obstacle.along obstacle.offset reference.strain "
               "reference.law")},
    {"continuum's modes",
     {"reference.mode=modes"},
     continuum,
     nowhere + no_markers + no_fit + no_grasp + no_rod + no_time +
         split("lattice. press. obstacle. rubber.retardation_time rubber.relaxation "
               "rubber.relaxation_bulk reference.field_sectors reference.law")},
    {"fit to moduli",
     {"calibration.problem=moduli", "lattice.model=central", "lattice.spacing=tip_radius/12"},
     calibration,
     nowhere + no_markers + no_continuum + no_grasp + no_modes + no_rod + no_time + follow_up +
         split("press. obstacle. geometry.rod_radius geometry.sleeve_length geometry.rod_length "
               "lattice.offset lattice.rotation lattice.constants lattice.kinematics "
               "lattice.ligament_stiffness lattice.contact_stiffness calibration.data "
               "calibration.conditions calibration.depth "
               "calibration.points calibration.parameters "
               "calibration.forward calibration.prior calibration.model_error "
               "calibration.robust_width calibration.poisson_range calibration.evaluations "
               "calibration.profile")},
    {"fit to the continuum's curves",
     {"calibration.problem=curve", "calibration.points=2", "lattice.spacing=tip_radius/6"},
     calibration,
     nowhere + no_markers + no_grasp + no_modes + no_rod + no_time + no_friction + diagonal +
         moduli_fit + follow_up + beside + own_depths + relaxation +
         split("calibration.data calibration.forward calibration.poisson_range")},
    {"fit of the damping",
     {"calibration.problem=damping", "calibration.points=2", "lattice.spacing=tip_radius/6"},
     calibration,
     nowhere + no_markers + no_grasp + no_modes + no_rod + diagonal + moduli_fit + follow_up +
         beside + own_depths + controllers + relaxation +
         // Presses come from far enough; tau alone is free.
         split("press.clearance calibration.data calibration.forward calibration.poisson_range "
               "calibration.parameters calibration.profile")},
};

class IdentityOfAJob : public testing::TestWithParam<World> {};

TEST_P(IdentityOfAJob, ChangesWithEveryKeyThatHasAnEffect) {
  const World& world = GetParam();
  ASSERT_TRUE(identity_of(world.identity, world.sets));
  for (const Key& key : key_table())
    EXPECT_EQ(matters(world, key), !lists(world.idle, key)) << key.full_name();
}

INSTANTIATE_TEST_SUITE_P(Jobs, IdentityOfAJob, testing::ValuesIn(worlds), [](const auto& world) {
  std::string name = world.param.name;
  std::erase_if(name, [](char c) { return !std::isalnum(static_cast<unsigned char>(c)); });
  return name;
});

TEST(IdentityOfAPress, ChangesWithTheSkinThatItsControllerFeels) {
  const Sets own = {"controller.type=socket", "sensor.taxels={rings = 2}"};
  const auto before = identity_of(press, own);
  ASSERT_TRUE(before);
  for (const char* matters :
       {"sensor.taxels={rings = 3}", "sensor.pitch=0.5 mm", "sensor.footprint=2 mm",
        "sensor.depth=1 mm", "sensor.noise=1 Pa", "sensor.rate=100 Hz", "sensor.latency=2 ms"}) {
    const auto changed = identity_of(press, own + Sets{matters});
    EXPECT_TRUE(changed && changed != before) << matters;
  }
}

/// Fits to files know what the others do, and their data.
TEST(IdentityOfAFit, ChangesWithItsDataAndHowTheyWereTaken) {
  const TemporaryFolder folder;
  write_text(folder / "a.csv",
             "indentation [mm],force [mN],force_error [mN]\n0.5,10,1\n1,25,1\n1.5,45,1\n");
  write_text(folder / "b.csv",
             "indentation [mm],force [mN],force_error [mN]\n0.5,10,1\n1,25,1\n1.5,46,1\n");
  write_text(folder / "ramp.csv", "time [s],force [mN]\n0.05,10\n0.1,25\n0.2,45\n0.4,44\n");
  const auto data = [&](const char* file) {
    return "calibration.data=[\"" + (folder / file).string() + "\"]";
  };
  const Sets experiment = {"calibration.problem=experiment", "lattice.model=network",
                           "lattice.spacing=tip_radius/6", data("a.csv")},
             ramp = {"calibration.problem=damping", "lattice.spacing=tip_radius/6",
                     data("ramp.csv")};
  const auto differs = [](Sets sets, const std::string& other) {
    const auto base = identity_of(calibration, sets);
    sets.push_back(other);
    const auto changed = identity_of(calibration, sets);
    EXPECT_TRUE(base && changed) << other;
    return base != changed;
  };
  for (const std::string& matters :
       {data("b.csv"), std::string("calibration.poisson_range=[0.1, 0.49]"),
        std::string("calibration.forward=continuum"), std::string("calibration.prior=0.1"),
        std::string("calibration.robust_width=3.0"), std::string("calibration.evaluations=60"),
        std::string("calibration.profile=[\"youngs_modulus\", \"shear_modulus\"]"),
        std::string("calibration.candidates=[\"repeat\"]"),
        std::string("calibration.intervals=profile"), std::string("press.contact=frictionless"),
        std::string("calibration.tolerances={rod_radius = \"0.1 mm\"}"),
        std::string("geometry.tip_radius=1.1 cm")})
    EXPECT_TRUE(differs(experiment, matters)) << matters;
  write_text(folder / "travel.csv",
             "position [mm],force [mN],sigma [mN]\n0,0,1\n0.5,10,1\n1,25,1\n1.5,45,1\n");
  const Sets travel = experiment + Sets{data("travel.csv")};
  for (const char* matters :
       {"calibration.rig={touch_offset = \"0.1 mm\"}", "calibration.rig={compliance = \"fit\"}",
        "calibration.rig={compliance = \"1 mm/N\"}",
        "calibration.rig={touch_offset = \"0.1 +- 0.2 mm\"}",
        "calibration.rig={force_offset = \"1 mN\"}", "calibration.machine=B"})
    EXPECT_TRUE(differs(travel, matters)) << matters;
  // A rubber that relaxes knows the time, which speed tells where a file does not.
  const Sets relaxing =
      experiment + Sets{"rubber.relaxation=[[0.2, \"0.1 s\"]]", "press.speed=1 mm/s"};
  for (const char* matters : {"press.speed=2 mm/s", "rubber.relaxation=[[0.3, \"0.1 s\"]]",
                              "rubber.relaxation=[[0.2, \"0.2 s\"]]",
                              "calibration.parameters=[\"modulus\", \"relaxation_g1\"]"})
    EXPECT_TRUE(differs(relaxing, matters)) << matters;
  // How fast the plane comes is all that the elastic press does not know.
  EXPECT_TRUE(differs(ramp, "press.speed=2 cm/s"));
  EXPECT_FALSE(differs(ramp, "press.clearance=1 mm"));
}

TEST(IdentityOfAPlan, ChangesWithItsPressesAndTheirNoise) {
  const Identity plan = [](const LoadedConfig& loaded) {
    const CalibrationSettings& settings = loaded.config.calibration;
    return plan_job(plan_setup(loaded).input, {settings.noise, settings.noise_force}).key();
  };
  const Sets base = {"calibration.problem=experiment", "lattice.model=network",
                     "lattice.spacing=tip_radius/6", "press.depth=1 mm",
                     "calibration.candidates=[\"repeat\"]"};
  const auto key = identity_of(plan, base);
  ASSERT_TRUE(key);
  for (const char* matters :
       {"calibration.noise=0.02", "calibration.noise_force=1 mN", "calibration.points=7",
        "press.depth=1.1 mm", "press.contact=frictionless", "calibration.candidates=[]",
        "calibration.rig={compliance = \"fit\"}", "calibration.data=[\"a.csv\"]",
        "calibration.conditions=[\"obstacle.shape=sphere; obstacle.radius=5 mm\"]",
        "rubber.youngs_modulus=5 kPa"}) {
    const auto other = identity_of(plan, base + Sets{matters});
    EXPECT_TRUE(other) << matters;
    EXPECT_NE(other, key) << matters;
  }
}

/// An equilibrium knows time where the rubber relaxes, and there alone.
TEST(IdentityOfAJob, KnowsTimeWhereTheRubberRelaxes) {
  const std::string relaxing = "rubber.relaxation=[[0.2, \"0.1 s\"]]", fast = "press.speed=3 cm/s";
  const auto program = [](const std::string& speed, const std::string& hold) {
    return "press.program=[[\"0.3 cm\", \"" + speed + "\"], [\"hold\", \"" + hold + "\"]]";
  };
  const auto same = [](const Sets& one, const Sets& other) {
    const auto a = identity_of(continuum, one), b = identity_of(continuum, other);
    EXPECT_TRUE(a && b);
    return a == b;
  };
  EXPECT_TRUE(same({}, {fast}));
  EXPECT_FALSE(same({relaxing}, {relaxing, fast}));
  EXPECT_TRUE(same({relaxing}, {relaxing, "press.clearance=1 mm"}));
  const std::string once = program("1 cm/s", "1 s");
  EXPECT_TRUE(same({once}, {program("2 cm/s", "2 s")}));
  EXPECT_FALSE(same({relaxing, once}, {relaxing, program("2 cm/s", "1 s")}));
  EXPECT_FALSE(same({relaxing, once}, {relaxing, program("1 cm/s", "2 s")}));
  EXPECT_FALSE(same({relaxing, once}, {relaxing, once, "press.clearance=0.1 mm"}));
}

/// Of every job whose strain is large.
TEST(IdentityOfAJob, KnowsTheLawAtLargeStrain) {
  const Sets lattice = {"press.mode=static", "lattice.model=network"},
             finite = {"reference.strain=finite"};
  for (const auto& [identity, sets] :
       {std::pair(Identity(press), lattice), std::pair(Identity(continuum), finite)}) {
    const Sets gent = sets + Sets{"rubber.law=gent", "rubber.gent_jm=9.0"};
    const auto base = identity_of(identity, sets), with_gent = identity_of(identity, gent);
    EXPECT_TRUE(base && with_gent);
    EXPECT_NE(with_gent, base);
    EXPECT_NE(identity_of(identity, gent + Sets{"rubber.gent_jm=10.0"}), with_gent);
    EXPECT_NE(identity_of(identity, gent + Sets{"rubber.volumetric=quadratic"}), with_gent);
  }
}

/// What a solid is counts, not what its file is called.
TEST(IdentityOfAJob, KnowsASolidByItsContent) {
  const TemporaryFolder folder;
  const auto finger = [](double width) {
    return fingers::box({-0.006, -0.005, 0.0}, {width, 0.007, 0.02});
  };
  write_text(folder / "a.stl", stl_text(finger(0.004)));
  write_text(folder / "same.stl", stl_text(finger(0.004)));
  write_text(folder / "other.stl", stl_text(finger(0.0041)));
  const auto sets = [&](const char* file, Sets further = {}) {
    Sets all = {"geometry.shape=solid", "geometry.file=" + (folder / file).string(),
                "geometry.bond=z < 1 mm", "press.mode=static"};
    all.insert(all.end(), further.begin(), further.end());
    return all;
  };
  for (const Identity& identity : {Identity(press), Identity(continuum)}) {
    const auto base = identity_of(identity, sets("a.stl"));
    EXPECT_TRUE(base);
    EXPECT_EQ(identity_of(identity, sets("same.stl")), base);
    for (const Sets& other : {sets("other.stl"), sets("a.stl", {"geometry.bond=z < 2 mm"}),
                              sets("a.stl", {"geometry.unit=cm", "geometry.bond=z < 1 cm"}),
                              sets("a.stl", {"geometry.up=+x", "geometry.bond=z < -5 mm"}),
                              sets("a.stl", {"geometry.origin=touch"}),
                              sets("a.stl", {"geometry.origin=[\"1 mm\", \"0 mm\", \"0 mm\"]"}),
                              sets("a.stl", {"geometry.endpoint=-1 mm"})}) {
      EXPECT_TRUE(identity_of(identity, other)) << other.back();
      EXPECT_NE(identity_of(identity, other), base) << other.back();
    }
  }
}

/// What a profile is counts, not what its file is called.
TEST(IdentityOfAJob, KnowsAProfileByItsContent) {
  const TemporaryFolder folder;
  const std::string finger = "12.5,12.5,contact,arc 0 12.5\n0,25,axis,\n0,0,bond,\n";
  write_text(folder / "a.csv", "r [mm],z [mm],surface,curve\n12.5,0,contact,\n" + finger);
  write_text(folder / "same.csv", "r [mm],z [mm],surface,curve\n12.5,0,contact,\n" + finger);
  write_text(folder / "other.csv", "r [mm],z [mm],surface,curve\n12.4,0,contact,\n" + finger);
  const auto sets = [&](const char* file) {
    return Sets{"geometry.shape=profile", "geometry.profile=" + (folder / file).string(),
                "press.mode=static"};
  };
  for (const Identity& identity : {Identity(press), Identity(continuum)}) {
    const auto base = identity_of(identity, sets("a.csv"));
    EXPECT_TRUE(base);
    EXPECT_EQ(identity_of(identity, sets("same.csv")), base);
    EXPECT_NE(identity_of(identity, sets("other.csv")), base);
    Sets held = sets("a.csv");
    held.emplace_back("geometry.endpoint=-1 mm");
    EXPECT_NE(identity_of(identity, held), base);
    EXPECT_NE(identity_of(identity, {"press.mode=static"}), base);
  }
}

}  // namespace
