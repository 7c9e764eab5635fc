#include "studies/config/key_sections.h"

#include "calibration/words.h"
#include "studies/config/key_builders.h"

#include <algorithm>

namespace fingertip::studies {

namespace {

void assign_constants(Config& config, const Value& value) {
  config.constants = ConstantsSource::file;
  store(value, config.constants);
  if (config.constants == ConstantsSource::file) config.constants_file = value.word;
}

void assign_spacing(Config& config, const Value& value) {
  config.spacing_divisor.reset();
  if (value.word.empty()) {
    config.press.lattice.spacing = value.number;
  } else {
    config.spacing_divisor = value.number;
  }
}

void assign_samples(Config& config, const Value& value) {
  config.press.protocol.samples = value.numbers;
  std::ranges::sort(config.press.protocol.samples);
}

/// Members of what the continuum is asked for, as targets of keys.
constexpr auto job = [](auto member) { return at(&Config::reference, member); };

}  // namespace

const std::vector<Section>& sections() {
  static const std::vector<Section> all = {
      {"geometry", "The finger: rigid rod inside a rubber tip (paper, Fig. 1)"},
      {"rubber", "The tip's material: isotropic, at small and at large strain"},
      {"rod", "The rigid rod"},
      {"lattice", "The mass-spring model of the tip"},
      {"press", "What is done to the finger"},
      {"obstacle", "The rigid obstacle that the finger is pressed against"},
      {"controller", "The 6-degree-of-freedom controller that moves the rod in mode pid"},
      {"hardware", "Sensors and actuators between controller and rod; the defaults are perfect"},
      {"grasp", "Two fingers that lift a rigid block, with press.contact, press.friction"},
      {"reference", "The continuum (finite elements)"},
      {"calibration", "How spring constants are fitted"},
      {"exchange", "An undamped lattice for another program (verbs export, import)"},
      {"run", "How to compute"},
  };
  return all;
}

std::vector<Key> specimen_keys() {
  const auto geometry = [](auto member) {
    return at(&Config::press, &lattice::PressSetup::geometry, member);
  };
  const auto rubber = [](auto member) {
    return at(&Config::press, &lattice::PressSetup::rubber, member);
  };
  const auto energy = [](auto member) {
    return at(&Config::press, &lattice::PressSetup::rubber, &meshes::Rubber::energy, member);
  };
  const auto coefficients = [](auto member) { return at(&Config::coefficients, member); };
  const auto list = [](Key key, std::size_t length) {
    key.kind = Kind::quantities;
    key.unit = "Pa";
    key.length = length;
    return key;
  };
  using meshes::Geometry;
  using meshes::Rubber;
  const auto or_auto = [](Key key) {
    key.word = "auto";
    key.assign = [assign = key.assign](Config& config, const Value& value) {
      if (value.word.empty()) assign(config, value);
    };
    return key;
  };
  const auto of_dome = [](Key key) {
    return only_with("geometry.shape", {"dome"}, std::move(key));
  };
  const auto of_profile = [](Key key) {
    return only_with("geometry.shape", {"profile"}, std::move(key));
  };
  const auto of_solid = [](Key key) {
    return only_with("geometry.shape", {"solid"}, std::move(key));
  };
  Key terms = plain("rubber", "ogden", any,
                    "pairs of mu and alpha, [[\"2 kPa\", 1.3], ...]; G is "
                    "the sum of the mu",
                    coefficients(&LawCoefficients::ogden));
  terms.kind = Kind::terms;
  terms.unit = "Pa";
  const auto relaxation = [](auto member) {
    return at(&Config::press, &lattice::PressSetup::rubber, &Rubber::relaxation, member);
  };
  Key branches = plain("rubber", "relaxation", any,
                       "Prony series: pairs of a share g of G0 and its time, [[0.2, \"0.1 s\"], "
                       "...]; E and G are those after long times",
                       relaxation(&meshes::Relaxation::branches));
  branches.number_first = true;
  branches.unit = "s";
  return {
      choice("geometry", "shape",
             {{"dome", "the paper's finger: hemisphere and sleeve on a rod"},
              {"profile", "the body of revolution of geometry.profile"},
              {"solid", "the closed surface of geometry.file"}},
             "what the finger is", at(&Config::shape)),
      of_profile(choice("geometry", "profile", {{"none", "only for a profile"}},
                        "closed meridian, a CSV file with the columns r [mm],z [mm],surface,curve",
                        at(&Config::profile))),
      of_solid(choice("geometry", "file", {{"none", "only for a solid"}},
                      "closed surface of one body that points along +z: .stl, .step, .brep, "
                      "or the .csv of a meridian, made into triangles",
                      at(&Config::solid, &SolidFile::file))),
      of_solid(plain("geometry", "unit", any,
                     "unit of length of the numbers in geometry.file (STEP and CSV have their own)",
                     at(&Config::solid, &SolidFile::unit))),
      of_solid(plain("geometry", "bond", any,
                     "what of a solid's surface the hand holds: half spaces like z < 1 mm, joined "
                     "by and, or; names of faces in a STEP file, or of solids in an STL text, "
                     "joined by or; the rest may touch",
                     at(&Config::solid, &SolidFile::bond))),
      only_with("geometry.shape", {"profile", "solid"},
                quantity("geometry", "endpoint", "cm", "m", any,
                         "height on the axis where force and torque are told; auto: the lowest",
                         at(&Config::endpoint))),
      of_dome(quantity("geometry", "tip_radius", "cm", "m", positive,
                       "R, outer radius of the rubber", geometry(&Geometry::tip_radius))),
      of_dome(with_rule(quantity("geometry", "rod_radius", "cm", "m", positive,
                                 "r, radius of the rod; the rubber is bonded to it",
                                 geometry(&Geometry::rod_radius)),
                        "smaller than tip_radius", {"geometry.tip_radius"})),
      of_dome(quantity("geometry", "sleeve_length", "cm", "m", not_negative,
                       "L, length of the rubber sleeve behind the hemisphere",
                       geometry(&Geometry::sleeve_length))),
      of_dome(with_rule(quantity("geometry", "rod_length", "cm", "m", positive,
                                 "l, from the hemisphere's centre to the rod's endpoint, which is "
                                 "held",
                                 geometry(&Geometry::rod_length)),
                        "at least sleeve_length", {"geometry.sleeve_length"})),
      or_auto(quantity("rubber", "youngs_modulus", "gf/cm^2", "Pa", positive,
                       "E, Young's modulus; auto: from the others",
                       rubber(&Rubber::youngs_modulus))),
      with_rule(or_auto(quantity("rubber", "shear_modulus", "gf/cm^2", "Pa", positive,
                                 "G, shear modulus; auto: from the others",
                                 rubber(&Rubber::shear_modulus))),
                "greater than youngs_modulus/3 (Poisson's ratio below 1/2)",
                {"rubber.youngs_modulus"}),
      with_rule(plain("rubber", "poissons_ratio", {-1.0, 0.4999, false},
                      "nu, beside E or G; auto: from E and G, 0.49 where one is given alone",
                      at(&Config::poissons_ratio)),
                "two of E (or hardness), G and nu", {}),
      with_rule(plain("rubber", "shore_hardness", {10.0, 90.0, true},
                      "Shore A hardness instead of E, by Gent's formula: rough; auto: none",
                      at(&Config::shore_hardness)),
                "not beside youngs_modulus", {}),
      with_rule(or_auto(quantity("rubber", "bulk_modulus", "", "Pa", positive,
                                 "K, bulk modulus, beside one of E and G; auto: from the others",
                                 coefficients(&LawCoefficients::bulk_modulus))),
                "two of E (or hardness), G, nu and K", {}),
      choice("rubber", "card", {{"none", "the keys below"}},
             "material.toml with a law of rubber, which calibrate of material tests writes",
             at(&Config::card)),
      choice("rubber", "law",
             {{"linear", "Hooke's law; refused at large strain"},
              {"neo-hookean", "G/2 (I1 - 3)"},
              {"yeoh", "C1 (I1 - 3) + C2 (I1 - 3)^2 + C3 (I1 - 3)^3"},
              {"mooney-rivlin", "C10 (I1 - 3) + C01 (I2 - 3)"},
              {"ogden", "sum of 2 mu/alpha^2 (l1^alpha + l2^alpha + l3^alpha - 3)"},
              {"gent", "-G Jm/2 ln(1 - (I1 - 3)/Jm)"}},
             "strain energy at large strain; at small strain only E and G count",
             energy(&meshes::StrainEnergy::law)),
      choice(
          "rubber", "volumetric",
          {{"logarithmic", "I1, I2, l as they are, and m/2 (ln J)^2; m is lambda less their share"},
           {"quadratic", "I1, I2, l free of the volume, and K/2 (J - 1)^2"},
           {"full-quadratic", "as logarithmic, but m/2 (J - 1)^2"},
           {"isochoric-logarithmic", "as quadratic, but K/2 (ln J)^2"}},
          "what a change of volume costs at large strain",
          energy(&meshes::StrainEnergy::volumetric)),
      with_rule(only_with("rubber.law", {"yeoh"},
                          list(plain("rubber", "yeoh", any, "C1, C2, C3 or fewer; G is 2 C1",
                                     coefficients(&LawCoefficients::yeoh)),
                               0)),
                "one to three, the first positive; instead of E and G", {}),
      with_rule(only_with("rubber.law", {"mooney-rivlin"},
                          list(plain("rubber", "mooney_rivlin", any,
                                     "C10 and C01; G is twice "
                                     "their sum",
                                     coefficients(&LawCoefficients::mooney_rivlin)),
                               0)),
                "two with a positive sum; instead of E and G", {}),
      with_rule(only_with("rubber.law", {"ogden"}, terms),
                "one to three pairs, the mu with a positive sum; instead of E and G", {}),
      with_rule(only_with("rubber.law", {"gent"},
                          plain("rubber", "gent_jm", positive, "Jm, the largest I1 - 3",
                                coefficients(&LawCoefficients::gent_jm))),
                "given for gent", {}),
      quantity("rubber", "density", "g/cm^3", "kg/m^3", positive, "rho, mass density",
               rubber(&Rubber::density)),
      quantity("rubber", "retardation_time", "ms", "s", not_negative,
               "tau of the Kelvin-Voigt damping, loss factor = omega tau",
               rubber(&Rubber::retardation_time)),
      with_rule(branches, "shares and times positive, shares with a sum below 1", {}),
      plain("rubber", "relaxation_bulk", any,
            "whether the bulk modulus fades as the shear modulus does, or not at all",
            relaxation(&meshes::Relaxation::bulk)),
      quantity("rod", "density", "g/cm^3", "kg/m^3", positive,
               "mass density of the rod; sets its inertia",
               at(&Config::press, &lattice::PressSetup::rod, &lattice::RodSettings::density)),
  };
}

std::vector<Key> lattice_keys() {
  Key spacing = with_rule(
      quantity(
          "lattice", "spacing", "m", "m", positive,
          "a, distance of neighbouring masses along the axes",
          at(&Config::press, &lattice::PressSetup::lattice, &lattice::LatticeSettings::spacing)),
      "at most (tip_radius - rod_radius)/2, of another shape a quarter of its thinnest wall, "
      "and no more than 20 million masses",
      {"geometry.tip_radius", "geometry.rod_radius"});
  const double divisor = meshes::Geometry().tip_radius / lattice::LatticeSettings().spacing;
  spacing.preset = "\"tip_radius/" + calibration::rounded(divisor, 12) + '"';
  spacing.word = "tip_radius/N";
  spacing.assign = assign_spacing;
  Key constants = with_rule(
      choice("lattice", "constants",
             {{"auto", "central: calibrated; the others: rule"},
              {"rule", "published, central: k = E a^2/l0; hookean, network: exact closed forms"},
              {"calibrated", "least-squares fit to the rubber's moduli (central, hookean)"}},
             "spring constants: a word, or a material.toml written by calibrate",
             at(&Config::constants)),
      "a file must be for the same model; published has a rule and is never calibrated",
      {"lattice.model"});
  constants.kind = Kind::source;
  constants.assign = assign_constants;
  Key rotation =
      with_rule(plain("lattice", "rotation", any, "turns of the grid about x, then y, then z",
                      at(&Config::rotation)),
                "three angles; not with the published model", {"lattice.model"});
  rotation.kind = Kind::quantities;
  rotation.preset = "[\"0 deg\", \"0 deg\", \"0 deg\"]";
  rotation.unit = "rad";
  rotation.length = 3;
  return {
      choice("lattice", "model",
             {{"published", "Reznik & Laugier 1996 as printed: every spring counts fully"},
              {"central", "spring constants fitted to E and G, weighted per cell"},
              {"hookean", "central plus one volume constant per cell: exact E, G and nu"},
              {"network", "fibres of zero rest length under a cell pressure: finite strain"}},
             "which mass-spring model",
             at(&Config::press, &lattice::PressSetup::lattice, &lattice::LatticeSettings::model)),
      spacing,
      plain("lattice", "offset", {-1.0, 1.0, true},
            "shift of the grid along x, y, z in units of the spacing",
            at(&Config::press, &lattice::PressSetup::lattice, &lattice::LatticeSettings::offset)),
      rotation,
      constants,
      plain("lattice", "ligament_stiffness", positive,
            "multiplies the stiffness of the bond between tip and rod (published: its ligaments)",
            at(&Config::press, &lattice::PressSetup::lattice,
               &lattice::LatticeSettings::ligament_stiffness)),
      with_rule(plain("lattice", "contact_stiffness", positive,
                      "multiplies the stiffness of the ties between tip and plane",
                      at(&Config::press, &lattice::PressSetup::lattice,
                         &lattice::LatticeSettings::contact_stiffness)),
                "1 for the published model", {"lattice.model"}),
      choice("lattice", "kinematics",
             {{"auto", "published, network: finite; central, hookean: small"},
              {"small", "linearised about the rest state"},
              {"finite", "true spring lengths and cell volumes"}},
             "how deformation is measured", at(&Config::kinematics)),
      plain("lattice", "modes", {1, 1000, true},
            "how many natural frequencies, lowest first, for the verb modes",
            at(&Config::lattice_modes)),
  };
}

std::vector<Key> obstacle_keys() {
  using meshes::Obstacle;
  const auto obstacle = [](auto member) {
    return at(&Config::press, &lattice::PressSetup::protocol, &meshes::PressProtocol::obstacle,
              member);
  };
  return {
      choice("obstacle", "shape",
             {{"plane", "a plane"},
              {"sphere", "a ball"},
              {"cylinder", "an endless cylinder"},
              {"edge", "an endless wedge of 90 degrees, rounded"}},
             "what the finger is pressed against", obstacle(&Obstacle::shape)),
      only_with("obstacle.shape", {"sphere", "cylinder", "edge"},
                quantity("obstacle", "radius", "cm", "m", positive,
                         "radius of sphere or cylinder, of an edge that of its rounding",
                         obstacle(&Obstacle::radius))),
      only_with("obstacle.shape", {"cylinder", "edge"},
                choice("obstacle", "along", {{"x", "along t1"}, {"y", "along t2"}},
                       "axis of cylinder and edge", obstacle(&Obstacle::along))),
      with_rule(only_with("obstacle.shape", {"sphere", "cylinder", "edge"},
                          quantity("obstacle", "offset", "cm", "m", any,
                                   "place of its top along t1, from the finger's axis",
                                   obstacle(&Obstacle::offset))),
                "where it touches first, the finger may touch", {"geometry.shape"}),
  };
}

std::vector<Key> press_keys() {
  const auto protocol = [](auto member) {
    return at(&Config::press, &lattice::PressSetup::protocol, member);
  };
  using meshes::PressProtocol;
  Key samples = with_rule(
      plain("press", "samples", positive,
            "output depths, e.g. [\"0.05 cm\", \"0.1 cm\"]; [] means ten up to depth",
            protocol(&PressProtocol::samples)),
      "different depths; the largest one becomes the depth of the press", {"press.depth"});
  samples.kind = Kind::quantities;
  samples.assign = assign_samples;
  samples.unit = "m";
  const Key program = with_rule(
      plain("press", "program", any,
            "stages in time, instead of depth and speed: e.g. [[\"0.3 cm\", \"1 cm/s\"], "
            "[\"hold\", \"2 s\"], [\"0 cm\", \"1 cm/s\"]]; [] means one press",
            protocol(&PressProtocol::program)),
      "begins with a move that presses; indentations from -clearance to less than the thickness",
      {"press.clearance", "geometry.tip_radius", "geometry.rod_radius"});
  return {
      choice("press", "mode",
             {{"pid", "dynamics; a controller holds speed and orientation"},
              {"quasi-static", "dynamics; the rod's motion is prescribed"},
              {"static", "no time: equilibrium at every sample depth"}},
             "what moves the rod (lattice only)", protocol(&PressProtocol::mode)),
      choice("press", "contact",
             {{"stick", "infinite friction: anchored where it first touched"},
              {"frictionless", "only the normal gap is held, compressive only"},
              {"coulomb",
               "sticks until the shear exceeds friction times the push, then slides "
               "(moving lattices and reference)"}},
             "how tip and plane interact", protocol(&PressProtocol::contact)),
      only_with("press.contact", {"coulomb"},
                plain("press", "friction", positive, "Coulomb's coefficient of friction",
                      at(&Config::press, &lattice::PressSetup::protocol,
                         &meshes::PressProtocol::friction))),
      with_rule(
          quantity(
              "press", "tilt", "deg", "rad", any,
              "of the rod against the plane's normal, about y (published: static presses only)",
              protocol(&PressProtocol::tilt)),
          "between -45 and 45 degrees", {}),
      with_rule(
          quantity("press", "lateral", "cm", "m", any,
                   "how far the plane has moved along t1 at the end; press.lateral_path says when "
                   "it moves (published: static presses only)",
                   protocol(&PressProtocol::lateral)),
          "at most tip_radius either way", {"geometry.tip_radius"}),
      with_rule(
          choice("press", "lateral_path",
                 {{"diagonal",
                   "on the way down, in proportion to the indentation: a tip that sticks is "
                   "sheared from first touch on"},
                  {"after", "first down to full depth, then along the plane at that depth"}},
                 "when the plane moves by press.lateral", protocol(&PressProtocol::lateral_path)),
          "after: static presses and reference", {"press.mode"}),
      only_with(
          "press.lateral_path", {"after"},
          plain("press", "lateral_samples", {1, 1000, true},
                "outputs of the lateral motion at full depth, in equal steps to press.lateral",
                at(&Config::press, &lattice::PressSetup::protocol,
                   &meshes::PressProtocol::lateral_samples))),
      with_rule(quantity("press", "depth", "cm", "m", positive, "final indentation",
                         protocol(&PressProtocol::depth)),
                "less than tip_radius - rod_radius, of a profile than the pole is above the bond",
                {"press.samples", "geometry.tip_radius", "geometry.rod_radius"}),
      quantity("press", "speed", "cm/s", "m/s", positive,
               "approach speed of the rod; the continuum's, too, when reference.mode is transient",
               protocol(&PressProtocol::speed)),
      quantity("press", "clearance", "cm", "m", positive,
               "gap between pole and plane at the start, where the rod is at rest",
               protocol(&PressProtocol::clearance)),
      samples,
      program,
      quantity("press", "gravity", "m/s^2", "m/s^2", not_negative,
               "acceleration of gravity on rod and tip, toward the plane (moving lattices)",
               at(&Config::press, &lattice::PressSetup::gravity)),
      quantity("press", "duration", "", "s", positive,
               "ends a moving press at this time, if not at its depth before; auto: no such end",
               at(&Config::press, &lattice::PressSetup::duration)),
  };
}

namespace {

/// What the continuum computes.
std::vector<Key> continuum_model_keys() {
  using namespace fem_reference;
  using Job = ReferenceJob;
  return {
      with_rule(choice("reference", "strain",
                       {{"linear", "small strain, Hooke's law"},
                        {"finite", "large strain, the law of rubber.law"}},
                       "continuum theory", job(&Job::strain)),
                "finite needs a Poisson's ratio of 0 or more",
                {"rubber.youngs_modulus", "rubber.shear_modulus", "rubber.poissons_ratio"}),
      only_with("reference.strain", {"finite"},
                choice("reference", "law",
                       {{"A", "the rubber's own"},
                        {"B", "volumetric = full-quadratic"},
                        {"C", "volumetric = isochoric-logarithmic"}},
                       "another rubber.volumetric for the continuum alone (rubber.law neo-hookean)",
                       at(&Config::continuum_law))),
      with_rule(choice("reference", "mode",
                       {{"static", "one equilibrium per output depth"},
                        {"transient", "the press at press.speed, with inertia and damping"},
                        {"modes", "natural frequencies of the tip bonded to a fixed rod"}},
                       "what is solved", job(&Job::analysis)),
                "transient: linear strain, stick or frictionless, no tilt, no lateral motion",
                {"reference.strain", "press.contact", "press.tilt", "press.lateral"}),
      with_rule(choice("reference", "symmetry",
                       {{"automatic",
                         "the meridian of the body of revolution where nothing breaks "
                         "its symmetry, else the solid"},
                        {"axisymmetric", "the meridian; what breaks the symmetry is refused"},
                        {"none", "the solid"}},
                       "whether a straight press is computed on the meridian, in seconds",
                       job(&Job::symmetry)),
                "axisymmetric: no tilt, no lateral motion, no vibrations",
                {"press.tilt", "press.lateral", "reference.mode"}),
      only_with(
          "reference.mode", {"modes"},
          plain("reference", "modes", {1, 1000, true}, "how many natural frequencies, lowest first",
                at(&Config::reference, &fem_reference::ReferenceJob::modes))),
  };
}

/// How the continuum computes it.
std::vector<Key> continuum_solver_keys() {
  using namespace fem_reference;
  using Job = ReferenceJob;
  return {
      plain("reference", "degree", {1, 3, true}, "polynomial degree of the elements",
            at(&Config::reference, &fem_reference::ReferenceJob::degree)),
      choice("reference", "volumetric",
             {{"pointwise", "at every quadrature point: the plain displacement element"},
              {"projected", "its dilatation projected, per element, on one degree lower"}},
             "how the volumetric part of the energy is integrated", job(&Job::volumetric)),
      plain("reference", "refinement", {0.25, 4, true},
            "factor on the element counts of the first mesh", job(&Job::refinement)),
      plain("reference", "tolerance", {1e-5, 0.5, true},
            "wanted force_error over normal_force at every output depth; the mesh is refined until "
            "it is met",
            job(&Job::tolerance)),
      plain("reference", "max_unknowns", {1e3, 1e9, true},
            "no mesh with more unknowns is tried; 4e5 needs about 8 GB", job(&Job::max_unknowns)),
      choice("reference", "solver",
             {{"automatic", "condensed while it fits into memory, else multigrid"},
              {"condensed", "sparse Cholesky factors, condensed to the contact patch"},
              {"multigrid", "conjugate gradients with algebraic multigrid"}},
             "linear solver of the solid; a meridian is always factored", job(&Job::solver)),
      plain("reference", "solver_tolerance", {1e-14, 1e-4, true},
            "relative residual of the multigrid solver (the condensed one is direct)",
            job(&Job::solver_tolerance)),
      plain("reference", "estimate_error", any,
            "refine until the tolerance is met and fill in the column force_error; false: the "
            "first mesh alone",
            job(&Job::estimate_error)),
      plain("reference", "fields", any, "write displacement, stress and pressure for ParaView",
            job(&Job::write_fields)),
      with_rule(plain("reference", "field_sectors", {0, 360, true},
                      "turn the fields of a meridian into a solid of so many sectors for ParaView; "
                      "0: the meridian alone",
                      job(&Job::field_sectors)),
                "0, or 3 and more", {"reference.symmetry"}),
  };
}

}  // namespace

std::vector<Key> reference_keys() {
  std::vector<Key> keys = continuum_model_keys();
  for (Key& key : continuum_solver_keys()) keys.push_back(std::move(key));
  return keys;
}

/// "auto" is no integrator of its own: a press chooses one.
Key integrator_key() {
  Key key = choice(
      "run", "integrator",
      {{"symplectic-euler", "velocities first, then positions"},
       {"explicit-euler", "as printed in the paper's Fig. 4; published lattice"},
       {"runge-kutta", "order 5(4) by SUNDIALS ARKODE, see run.tolerance"},
       {"mass-scaled",
        "symplectic Euler at long steps, with inertia against deformation; for slow presses: fast "
        "ones take plain masses unless run.time_step is given, and then tell the error"},
       {"energy-controlled", "symplectic Euler, see run.energy_bound"},
       {"auto",
        "mass-scaled where that is faster and keeps the force within 2 %, else symplectic-euler"}},
      "time integration of the lattice", at(&Config::press, &lattice::PressSetup::integrator));
  key.assign = [assign = key.assign](Config& config, Value value) {
    config.automatic_integrator = value.word == "auto";
    if (config.automatic_integrator) value.word = "symplectic-euler";
    assign(config, value);
  };
  return key;
}

std::vector<Key> run_keys() {
  return {
      plain("run", "threads", {0, 1024, true},
            "threads to use; 0: what is fastest, all cores, but for a moving lattice no more than "
            "one per "
            "1000 masses (volume over spacing cubed); results do not depend on it",
            at(&Config::press, &lattice::PressSetup::threads)),
      choice("run", "units",
             {{"si", "mN, mm, kPa"}, {"paper", "gf, cm, gf/cm^2, as in the paper of 1996"}},
             "units of screens, pages, figures and the live view; files keep theirs, and no result "
             "depends on it"),
      integrator_key(),
      only_with("run.integrator", {"runge-kutta"},
                plain("run", "tolerance", {0.0, 1.0, false},
                      "error of a step, relative to a strain of 1 % in root mean square",
                      at(&Config::press, &lattice::PressSetup::tolerance))),
      only_with("run.integrator", {"energy-controlled"},
                plain("run", "energy_bound", {0.0, 1.0, false},
                      "energy that a step may make or lose, per Young's modulus times tip_radius^3",
                      at(&Config::press, &lattice::PressSetup::energy_bound))),
      quantity("run", "time_step", "", "s", positive,
               "lattice time step; auto takes the largest safe one, of scaled masses one that "
               "keeps the force within 2 %",
               at(&Config::press, &lattice::PressSetup::time_step)),
  };
}

}  // namespace fingertip::studies
