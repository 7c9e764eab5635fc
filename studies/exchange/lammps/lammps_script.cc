#include "studies/exchange/lammps/lammps_script.h"

#include <fmt/format.h>

namespace fingertip::studies::inline exchange::inline lammps {

namespace {

/// Partners of a bond are found among an atom's own domain and this much of its neighbours': the
/// body diagonal, nearly doubled, and the way atoms go between two exchanges. LAMMPS warns below
/// 3.1.
constexpr double reach = 3.5;
/// Domains exchange atoms when one has moved by half of this.
/// Looking whether one has costs a pass over all masses, 4 % of a step, so it is done every 20th:
/// even a mass that flies at a twentieth of the speed of sound, half a spacing per step, has by
/// then come no further than the reach allows.
constexpr double skin = 0.5;

std::string head(const UndampedBody& body) {
  const double a = body.model.spacing();
  return fmt::format(
      R"(# Undamped mass-spring lattice for LAMMPS, SI units (studies/exchange/README.md).
# lmp -in {0}      or in parallel: mpirun -n N lmp -in {0}
# -var steps S -var every E on the command line replace the two numbers below.
units           si
boundary        s s s
atom_style      bond
atom_modify     sort 1000 {1}
newton          on
# No pair forces: nothing is excluded, so lists of second and third neighbours are not built.
special_bonds   lj/coul 1 1 1
pair_style      none
comm_modify     cutoff {2}
neighbor        {3} bin
neigh_modify    delay 0 every 20 check yes

bond_style      harmonic
fix             particle_masses all property/atom rmass
read_data       {4} fix particle_masses NULL {5}
group           masses type 1
)",
      lammps_script, 2.0 * a, reach * a, skin * a, lammps_data, lammps_masses_section);
}

/// How far behind the wall's surface a mass may be, in spacings; LAMMPS stops when one goes beyond.
constexpr double wall_depth = 4.0;

/// A plane so far behind the wall's surface that its force, 2 eps times what is left of the cutoff,
/// begins at the surface.
std::string wall(const UndampedBody& body) {
  const lattice::Plane& plane = body.wall->plane;
  const double depth = wall_depth * body.model.spacing();
  const meshes::Vector3 zero = meshes::Vector3::Zero();  // adding it takes the sign from -0
  const meshes::Vector3 behind = plane.point - depth * plane.normal + zero;
  const meshes::Vector3 normal = plane.normal + zero, velocity = plane.velocity + zero;
  std::string text = "\n# Elastic wall: force k times penetration on every mass behind it.\n";
  for (int axis = 0; axis < 3; ++axis) {
    text += fmt::format("variable        wall_{} equal {}*step*dt\n", "xyz"[axis], velocity[axis]);
  }
  return text + fmt::format(
                    "region          wall plane {} {} {} {} {} {} side in "
                    "move v_wall_x v_wall_y v_wall_z\n"
                    "fix             wall masses wall/region wall harmonic {} 1.0 {}\n"
                    "fix_modify      wall energy yes\n",
                    behind.x(), behind.y(), behind.z(), normal.x(), normal.y(), normal.z(),
                    0.5 * body.wall->stiffness, depth);
}

std::string weight(const UndampedBody& body) {
  const meshes::Vector3& g = body.gravity;
  return fmt::format("\nfix             weight masses gravity {} vector {} {} {}\n", g.norm(),
                     g.x(), g.y(), g.z());
}

}  // namespace

std::string lammps_script_text(const UndampedBody& body, const LammpsSettings& settings) {
  std::string text = head(body);
  if (!body.model.ligaments.empty()) {
    text +=
        "\n# Atoms of type 2 are places of the rod at rest; no fix moves them. Bonds of length "
        "zero "
        "are the ligaments.\n"
        "group           anchors type 2\n";
  }
  text += "\nfix             motion masses nve\n";
  if (body.wall) text += wall(body);
  if (!body.gravity.isZero(0.0)) text += weight(body);
  return text + fmt::format(R"(
variable        steps index {}
variable        every index {}
timestep        {}
thermo          ${{every}}
thermo_style    custom step time ke pe
thermo_modify   norm no format float %.17g
if "${{every}} > 0" then &
  "dump frames masses custom ${{every}} {} id x y z vx vy vz" &
  "dump_modify frames sort id format float %.17g"
run             ${{steps}}
)",
                            settings.steps, settings.every, body.step, lammps_dump);
}

}  // namespace fingertip::studies::inline exchange::inline lammps
