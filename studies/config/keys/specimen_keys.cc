/// The keys of [geometry], [rubber] and [rod].
#include "studies/config/keys/key_builders.h"
#include "studies/config/keys/key_sections.h"

namespace fingertip::studies::inline config::inline keys {

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
  Key up = plain("geometry", "up", any,
                 "direction of the file that points to the obstacle, which becomes +z",
                 at(&Config::solid, &SolidFile::up));
  up.kind = Kind::choice;
  up.choices = {{"+z", "as it stands"},   {"-z", "upside down, turned about x"},
                {"+x", "turned about y"}, {"-x", "turned about y"},
                {"+y", "turned about x"}, {"-y", "turned about x"}};
  Key origin = plain("geometry", "origin", any,
                     "place in the file that becomes the origin, [x, y, z] before it is turned; "
                     "touch: the axis goes through what a plane touches first",
                     at(&Config::solid, &SolidFile::origin));
  origin.kind = Kind::quantities;
  origin.preset = "[\"0 mm\", \"0 mm\", \"0 mm\"]";
  origin.unit = "m";
  origin.length = 3;
  origin.word = "touch";
  origin.assign = [store = origin.assign](Config& config, const Value& value) {
    config.solid.touch = !value.word.empty();
    if (value.word.empty()) store(config, value);
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
                      "closed surface of one body: .stl, .step, .brep, or the .csv of a "
                      "meridian, made into triangles",
                      at(&Config::solid, &SolidFile::file))),
      of_solid(plain("geometry", "unit", any,
                     "unit of length of the numbers in geometry.file (STEP and CSV have their own)",
                     at(&Config::solid, &SolidFile::unit))),
      of_solid(std::move(up)),
      of_solid(std::move(origin)),
      of_solid(plain("geometry", "bond", any,
                     "what of a solid's surface the hand holds: half spaces like z < 1 mm, joined "
                     "by and, or; names of faces in a STEP file, or of solids in an STL text, "
                     "joined by or; of the finger as geometry.up and origin place it; the rest "
                     "may touch",
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
                "the A scale: of Shore 00 or D give E; not beside youngs_modulus", {}),
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

}  // namespace fingertip::studies::inline config::inline keys
