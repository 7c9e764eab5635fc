/// The keys of [press] and [obstacle].
#include <algorithm>

#include "studies/config/keys/key_builders.h"
#include "studies/config/keys/key_sections.h"

namespace fingertip::studies::inline config::inline keys {

namespace {

void assign_samples(Config& config, const Value& value) {
  config.press.protocol.samples = value.numbers;
  std::ranges::sort(config.press.protocol.samples);
}

}  // namespace

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
            "[\"hold\", \"2 s\"], [\"0 cm\", \"1 cm/s\"]]; static presses and reference move along "
            "the plane, too: [\"lateral\", \"1 mm\", \"1 cm/s\"], [\"twist\", \"5 deg\", "
            "\"10 deg/s\"]; [] means one press",
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
              {"coulomb", "sticks until the shear exceeds friction times the push, then slides"}},
             "how tip and plane interact", protocol(&PressProtocol::contact)),
      only_with("press.contact", {"coulomb"},
                plain("press", "friction", positive, "Coulomb's coefficient of friction",
                      protocol(&PressProtocol::friction))),
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
      with_rule(quantity("press", "twist", "deg", "rad", any,
                         "how far the plane turns about its normal at full depth, together with a "
                         "lateral motion that follows (static presses and reference)",
                         protocol(&PressProtocol::twist)),
                "between -90 and 90 degrees; static presses and reference", {"press.mode"}),
      plain("press", "lateral_samples", {1, 1000, true},
            "outputs of a motion along the plane at full depth or of a twist, in equal steps",
            protocol(&PressProtocol::lateral_samples)),
      with_rule(quantity("press", "depth", "cm", "m", positive, "final indentation",
                         protocol(&PressProtocol::depth)),
                "less than tip_radius - rod_radius, of a profile than the pole is above the bond; "
                "where the default is not, a tenth of that",
                {"press.samples", "geometry.tip_radius", "geometry.rod_radius"}),
      quantity("press", "speed", "cm/s", "m/s", positive,
               "approach speed of the rod; the continuum's, too, when reference.mode is transient",
               protocol(&PressProtocol::speed)),
      quantity("press", "clearance", "cm", "m", positive,
               "gap between pole and plane at the start, where the rod is at rest",
               protocol(&PressProtocol::clearance)),
      samples,
      program,
      with_rule(plain("press", "slopes", {},
                      "also tell how the normal force changes with E (Poisson's ratio held) and "
                      "with Poisson's ratio (E held): columns slope_youngs_modulus and "
                      "slope_poissons_ratio",
                      at(&Config::press, &lattice::PressSetup::slopes)),
                "static presses, stick or frictionless, hookean or network",
                {"press.mode", "press.contact", "lattice.model"}),
      quantity("press", "gravity", "m/s^2", "m/s^2", not_negative,
               "acceleration of gravity on rod and tip, toward the plane (moving lattices)",
               at(&Config::press, &lattice::PressSetup::gravity)),
      quantity("press", "duration", "", "s", positive,
               "ends a moving press at this time, if not at its depth before; auto: no such end",
               at(&Config::press, &lattice::PressSetup::duration)),
  };
}

}  // namespace fingertip::studies::inline config::inline keys
