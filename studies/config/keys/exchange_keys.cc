/// The keys of [exchange].
#include "studies/config/keys/key_builders.h"
#include "studies/config/keys/key_sections.h"

namespace fingertip::studies::inline config::inline keys {

namespace {

/// Members of what is handed over, as targets of keys.
constexpr auto exchange = [](auto member) { return at(&Config::exchange, member); };

/// 350 million springs; the model alone takes some 10 GB then.
constexpr double max_cells = 300;
constexpr double max_steps = 1e9;
constexpr double max_agitation = 0.2;

}  // namespace

std::vector<Key> exchange_keys() {
  return {
      choice("exchange", "body",
             {{"fingertip", "the tip of [geometry]"},
              {"cube", "a free cube of exchange.cells cells a side, for checks and benchmarks"}},
             "which lattice is handed to another program", exchange(&ExchangeSettings::cube)),
      plain("exchange", "cells", {1, max_cells, true}, "cells along an edge of the cube",
            exchange(&ExchangeSettings::cells)),
      with_rule(
          choice("exchange", "hold",
                 {{"rod", "ligaments to a rod at rest (published)"},
                  {"free", "nothing holds the lattice"}},
                 "what holds the tip; a cube is always free", exchange(&ExchangeSettings::is_free)),
          "the other models are bonded to the rod at points of its surface, which bonds between "
          "masses cannot express",
          {"lattice.model"}),
      with_rule(choice("exchange", "plane",
                       {{"none", "no plane"},
                        {"wall", "an elastic wall that comes from press.clearance at press.speed"}},
                       "what the tip is pressed against", exchange(&ExchangeSettings::has_wall)),
                "a wall needs press.contact = \"frictionless\" and the fingertip",
                {"press.contact", "exchange.body"}),
      plain("exchange", "wall_stiffness", positive,
            "force of the wall per penetration of a mass, over the stiffness of an axis spring",
            exchange(&ExchangeSettings::wall_stiffness)),
      plain("exchange", "steps", {1, max_steps, true}, "how many steps",
            exchange(&ExchangeSettings::steps)),
      plain("exchange", "every", {0, max_steps, true}, "steps between stored frames; 0: none",
            exchange(&ExchangeSettings::every)),
      plain("exchange", "agitation", {0.0, max_agitation, true},
            "largest random displacement of a mass along an axis at the start, in spacings; "
            "velocities are as large, times the frequency of an axis spring",
            exchange(&ExchangeSettings::agitation)),
      quantity("exchange", "edge", "mm", "m", positive,
               "edges of the tetrahedra of a soft body (mujoco); auto: a quarter of the radius, at "
               "most half of the thinnest wall",
               exchange(&ExchangeSettings::edge)),
  };
}

}  // namespace fingertip::studies::inline config::inline keys
