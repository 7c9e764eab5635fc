#include "studies/exchange/lammps/lammps_script.h"

#include <fmt/format.h>

#include "studies/exchange/texts/texts.h"

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

/// How far behind the wall's surface a mass may be, in spacings; LAMMPS stops when one goes beyond.
constexpr double wall_depth = 4.0;

std::string text_of(const meshes::Vector3& v) {
  return fmt::format("{} {} {}", v.x() + 0.0, v.y() + 0.0, v.z() + 0.0);  // takes the sign from -0
}

/// A plane so far behind the wall's surface that its force, 2 eps times what is left of the cutoff,
/// begins at the surface.
std::string wall(const UndampedBody& body) {
  const lattice::Plane& plane = body.wall->plane;
  const double depth = wall_depth * body.model.spacing();
  return filled("lattice_wall.in", fmt::arg("x", plane.velocity.x() + 0.0),
                fmt::arg("y", plane.velocity.y() + 0.0), fmt::arg("z", plane.velocity.z() + 0.0),
                fmt::arg("behind", text_of(plane.point - depth * plane.normal)),
                fmt::arg("normal", text_of(plane.normal)),
                fmt::arg("energy", 0.5 * body.wall->stiffness), fmt::arg("depth", depth));
}

std::string weight(const UndampedBody& body) {
  const meshes::Vector3& g = body.gravity;
  return filled("lattice_weight.in", fmt::arg("norm", g.norm()),
                fmt::arg("direction", fmt::format("{} {} {}", g.x(), g.y(), g.z())));
}

}  // namespace

std::string lammps_script_text(const UndampedBody& body, const LammpsSettings& settings) {
  const double a = body.model.spacing();
  return filled(
      "lattice.in", fmt::arg("script", lammps_script), fmt::arg("cell", 2.0 * a),
      fmt::arg("reach", reach * a), fmt::arg("skin", skin * a), fmt::arg("data", lammps_data),
      fmt::arg("masses", lammps_masses_section),
      fmt::arg("anchors", body.model.ligaments.empty() ? "" : filled("lattice_anchors.in")),
      fmt::arg("wall", body.wall ? wall(body) : ""),
      fmt::arg("weight", body.gravity.isZero(0.0) ? "" : weight(body)),
      fmt::arg("steps", settings.steps), fmt::arg("every", settings.every),
      fmt::arg("step", body.step), fmt::arg("dump", lammps_dump));
}

}  // namespace fingertip::studies::inline exchange::inline lammps
