/// The keys of [exchange].
#include "studies/config/key_builders.h"
#include "studies/config/key_sections.h"

namespace fingertip::studies {

namespace {

void assign_body(Config& config, const Value& value) {
  config.exchange.cube = value.word == "cube";
}

void assign_hold(Config& config, const Value& value) {
  config.exchange.hangs_on_rod = value.word == "rod";
}

void assign_plane(Config& config, const Value& value) {
  config.exchange.has_wall = value.word == "wall";
}

/// 350 million springs; the model alone takes some 10 GB then.
constexpr double most_cells = 300;
constexpr double most_steps = 1e9;
constexpr double most_agitation = 0.2;

}  // namespace

std::vector<Key> exchange_keys() {
  return {
      choice("exchange", "body", "fingertip",
             {{"fingertip", "the tip of [geometry]"},
              {"cube", "a free cube of exchange.cells cells a side, for checks and benchmarks"}},
             "which lattice is handed to another program", assign_body),
      plain("exchange", "cells", Kind::integer, "8", {1, most_cells, true},
            "cells along an edge of the cube",
            [](Config& config, const Value& value) { config.exchange.cells = int(value.number); }),
      with_rule(
          choice("exchange", "hold", "rod",
                 {{"rod", "ligaments to a rod at rest (published)"},
                  {"free", "nothing holds the lattice"}},
                 "what holds the tip; a cube is always free", assign_hold),
          "the other models are tied to the rod at points of its surface, which bonds between "
          "masses cannot express",
          {"lattice.model"}),
      with_rule(choice("exchange", "plane", "none",
                       {{"none", "no plane"},
                        {"wall", "an elastic wall that comes from press.clearance at press.speed"}},
                       "what the tip is pressed against", assign_plane),
                "a wall needs press.contact = \"frictionless\" and the fingertip",
                {"press.contact", "exchange.body"}),
      plain("exchange", "wall_stiffness", Kind::number, "1.0", positive,
            "force of the wall per penetration of a mass, over the stiffness of an axis spring",
            [](Config& config, const Value& value) {
              config.exchange.wall_stiffness = value.number;
            }),
      plain("exchange", "steps", Kind::integer, "1000", {1, most_steps, true}, "how many steps",
            [](Config& config, const Value& value) { config.exchange.steps = long(value.number); }),
      plain("exchange", "every", Kind::integer, "100", {0, most_steps, true},
            "steps between stored frames; 0: none",
            [](Config& config, const Value& value) { config.exchange.every = long(value.number); }),
      plain("exchange", "agitation", Kind::number, "0.01", {0.0, most_agitation, true},
            "largest random displacement of a mass along an axis at the start, in spacings; "
            "velocities are as large, times the frequency of an axis spring",
            [](Config& config, const Value& value) { config.exchange.agitation = value.number; }),
  };
}

}  // namespace fingertip::studies
