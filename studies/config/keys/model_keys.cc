/// The keys of [lattice], [reference] and [run].
#include "studies/config/keys/key_builders.h"
#include "studies/config/keys/key_sections.h"

namespace fingertip::studies::inline config::inline keys {

namespace {

void assign_constants(Config& config, const Value& value) {
  config.constants = ConstantsSource::file;
  store(value, config.constants);
  if (config.constants == ConstantsSource::file) config.constants_file = value.word;
}

void assign_spacing(Config& config, const Value& value) {
  config.spacing_divisor.reset();
  config.automatic_spacing = value.word == "auto";
  if (value.word.empty()) {
    config.press.lattice.spacing = value.number;
  } else if (!config.automatic_spacing) {
    config.spacing_divisor = value.number;
  }
}

/// Members of what the continuum is asked for, as targets of keys.
constexpr auto job = [](auto member) { return at(&Config::reference, member); };

/// What the continuum computes.
std::vector<Key> continuum_model_keys() {
  using Job = fem_reference::ReferenceJob;
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
      with_rule(
          choice("reference", "mode",
                 {{"static", "one equilibrium per output depth"},
                  {"transient", "the press at press.speed, with inertia and damping"},
                  {"modes", "natural frequencies of the tip bonded to a fixed rod"}},
                 "what is solved", job(&Job::analysis)),
          "transient: linear strain, stick or frictionless, no tilt, no lateral motion, no twist",
          {"reference.strain", "press.contact", "press.tilt", "press.lateral", "press.twist"}),
      with_rule(
          choice("reference", "symmetry",
                 {{"automatic",
                   "the meridian of the body of revolution where nothing breaks "
                   "its symmetry, else the solid"},
                  {"axisymmetric", "the meridian; what breaks the symmetry is refused"},
                  {"none", "the solid"}},
                 "whether a straight press is computed on the meridian, in seconds",
                 job(&Job::symmetry)),
          "axisymmetric: no tilt, no lateral motion, no vibrations, a twist at small strain alone",
          {"press.tilt", "press.lateral", "press.twist", "reference.mode"}),
      only_with("reference.mode", {"modes"},
                plain("reference", "modes", {1, 1000, true},
                      "how many natural frequencies, lowest first", job(&Job::modes))),
  };
}

/// How the continuum computes it.
std::vector<Key> continuum_solver_keys() {
  using Job = fem_reference::ReferenceJob;
  return {
      plain("reference", "degree", {1, 3, true}, "polynomial degree of the elements",
            job(&Job::degree)),
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

/// "auto" is no integrator of its own: a press chooses one.
Key integrator_key() {
  Key key = choice(
      "run", "integrator",
      {{"symplectic-euler", "velocities first, then positions"},
       {"explicit-euler", "as printed in the paper's Fig. 4; published lattice"},
       {"runge-kutta", "order 5(4) by Boost.odeint, see run.tolerance"},
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

}  // namespace

std::vector<Key> lattice_keys() {
  Key spacing = with_rule(
      quantity(
          "lattice", "spacing", "m", "m", positive,
          "a, distance of neighbouring masses along the axes; auto: the coarsest tip_radius/N, N "
          "whole, that keeps lattice.tolerance",
          at(&Config::press, &lattice::PressSetup::lattice, &lattice::LatticeSettings::spacing)),
      "at most (tip_radius - rod_radius)/2, of another shape a quarter of its thinnest wall, "
      "and no more than 20 million masses",
      {"geometry.tip_radius", "geometry.rod_radius"});
  spacing.preset = "\"auto\"";
  spacing.pattern = "tip_radius/N";
  spacing.word = "auto";
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
      only_with(
          "lattice.spacing", {"auto"},
          plain("lattice", "tolerance", {4e-3, 0.5, true},
                "what the spacing may put on a force, relative to it, from the first of "
                "press.samples on, or from a tenth of the depth; 5 % where live, modes, grasp, "
                "an FMU or Python's Finger leave it out",
                at(&Config::spacing_tolerance))),
      only_with("lattice.spacing", {"auto"},
                plain("lattice", "max_particles", {100, 2e7, true},
                      "no more masses than these unless the finger's walls ask for more; what that "
                      "costs in accuracy is told",
                      at(&Config::max_particles))),
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

std::vector<Key> reference_keys() {
  std::vector<Key> keys = continuum_model_keys();
  for (Key& key : continuum_solver_keys()) keys.push_back(std::move(key));
  return keys;
}

std::vector<Key> run_keys() {
  return {
      plain("run", "threads", {0, 1024, true},
            "threads to use; 0: what is fastest, all cores, but for a moving lattice no more than "
            "one per "
            "1000 masses (volume over spacing cubed); results do not depend on it",
            at(&Config::press, &lattice::PressSetup::threads)),
      plain("run", "symmetry", {},
            "press a quarter or half of the tip where all is its own mirror image: grid, obstacle "
            "and way, under the built-in servo without noise; false: the whole tip, whose rod may "
            "tilt and sway",
            at(&Config::press, &lattice::PressSetup::symmetry)),
      choice("run", "error",
             {{"auto",
               "from the continuum where that takes seconds: a body of revolution, pressed "
               "straight; else estimated"},
              {"continuum", "from the continuum in the same press, of a solid, too"},
              {"estimate",
               "from spacing over contact radius, the model and the motion; none of published"},
              {"off", "not at all"}},
             "how press finds the error of the lattice's forces (column force_error); no force "
             "depends on it",
             at(&Config::force_error)),
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

}  // namespace fingertip::studies::inline config::inline keys
