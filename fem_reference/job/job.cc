#include "fem_reference/job/job.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <ostream>
#include <string>
#include <utility>

#include "meshes/base/files.h"
#include "meshes/rubber/hyperelastic_law.h"
#include "meshes/tables/fields_json.h"

namespace fingertip::fem_reference::inline job {
namespace {

using Json = nlohmann::json;
using meshes::InvalidInput;
using meshes::Violation;

template <class T>
void get(const Json& value, T& target) {
  if constexpr (std::is_same_v<T, double>)
    if (!value.is_number()) throw std::invalid_argument("must be a number");
  if constexpr (std::is_same_v<T, bool>)
    if (!value.is_boolean()) throw std::invalid_argument("must be true or false");
  if constexpr (std::is_same_v<T, int>) {
    constexpr double most = std::numeric_limits<int>::max();
    const bool fits = value.is_number_integer() && std::abs(value.get<double>()) <= most;
    if (!fits) throw std::invalid_argument("must be an integer of at most ten digits");
  }
  if constexpr (std::is_enum_v<T>) {
    std::string list;
    for (const T candidate : values(T()))
      list += (list.empty() ? "" : ", ") + std::string(name(candidate));
    const auto found = meshes::enumerator<T>(value.get<std::string>());
    if (!found) throw std::invalid_argument("must be one of " + list);
    target = *found;
  } else {
    target = value.get<T>();
  }
}

void get(const Json& value, std::vector<meshes::Vector3>& places) {
  const auto rows = value.get<std::vector<std::array<double, 3>>>();
  places.clear();
  for (const std::array<double, 3>& row : rows) places.emplace_back(row.data());
}

/// The surface stands beside the job.
void get(const Json&, std::shared_ptr<const meshes::Solid>&) {}

template <class List>
concept HoldsFields = meshes::HasFields<typename List::value_type>;

/// Refuses what is no entry and what an entry cannot be, all of it in `broken`.
template <class Settings>
void read_fields(const Json& object, const std::string& place, Settings& settings,
                 std::vector<Violation>& broken) {
  const auto refuse = [&](const std::string& key, const Json& value, const char* rule) {
    broken.push_back({place + key, value.dump(), rule, "correct the entry or leave it out"});
  };
  if (!object.is_object()) return refuse("", object, "must be a JSON object");
  std::vector<std::string> known;
  meshes::for_each_field<Settings>([&](const auto& field) {
    const std::string& key = known.emplace_back(field.name);
    if (!object.contains(key)) return;
    auto& member = settings.*field.member;
    using Member = std::remove_reference_t<decltype(member)>;
    if constexpr (meshes::HasFields<Member>) {
      read_fields(object.at(key), place + key + ".", member, broken);
    } else if constexpr (HoldsFields<Member>) {
      const Json& list = object.at(key);
      if (!list.is_array()) return refuse(key, list, "must be a list");
      member.resize(list.size());
      for (std::size_t i = 0; i < list.size(); ++i)
        read_fields(list[i], place + key + "[" + std::to_string(i) + "].", member[i], broken);
    } else {
      try {
        get(object.at(key), member);
      } catch (const std::invalid_argument& error) {
        refuse(key, object.at(key), error.what());
      } catch (const Json::exception&) {
        refuse(key, object.at(key), "is of the wrong type");
      }
    }
  });
  for (const auto& [key, value] : object.items())
    if (std::ranges::find(known, key) == known.end())
      refuse(key, value, "is no entry of a reference job");
}

/// Beside the job: the surface of its solid, from which the digest was taken.
constexpr const char* surface_file = "solid.json";

void write_surface(const meshes::Solid& solid, const std::filesystem::path& file) {
  Json vertices = Json::array(), triangles = Json::array(), bonded = Json::array();
  for (const meshes::Vector3& w : solid.mesh().vertices) vertices.push_back({w.x(), w.y(), w.z()});
  for (std::size_t t = 0; t < solid.mesh().triangles.size(); ++t) {
    triangles.push_back(solid.mesh().triangles[t]);
    bonded.push_back(solid.is_bond(t));
  }
  const Json json{{"vertices", vertices}, {"triangles", triangles}, {"bonded", bonded}};
  meshes::write_atomically(file, [&](std::ostream& out) { out << json << '\n'; });
}

std::shared_ptr<const meshes::Solid> read_surface(const std::filesystem::path& file,
                                                  const std::string& content) {
  std::ifstream in(file);
  meshes::TriangleMesh mesh;
  std::vector<bool> bonded;
  try {
    const Json json = Json::parse(in);
    for (const Json& w : json.at("vertices"))
      mesh.vertices.emplace_back(w.at(0).get<double>(), w.at(1).get<double>(),
                                 w.at(2).get<double>());
    json.at("triangles").get_to(mesh.triangles);
    json.at("bonded").get_to(bonded);
  } catch (const Json::exception& error) {
    throw InvalidInput({file.string(), "", std::string("no surface of a solid: ") + error.what(),
                        "write it with write_job or start `fingertip reference`"});
  }
  return std::make_shared<meshes::Solid>(std::move(mesh), bonded, content);
}

}  // namespace

void ReferenceJob::press_to(std::vector<double> samples) {
  protocol.depth = samples.empty() ? 0.0 : samples.back();
  protocol.samples = std::move(samples);
  protocol.program.clear();
}

bool ReferenceJob::axisymmetric() const {
  const bool press = analysis == Analysis::static_press || analysis == Analysis::transient;
  return !geometry.solid && symmetry != Symmetry::none && press && protocol.tilt == 0.0 &&
         protocol.lateral_range() == std::pair(0.0, 0.0) && protocol.obstacle.on_axis() &&
         (!protocol.twists() || (strain == Strain::linear && !in_time()));
}

std::vector<Violation> ReferenceJob::violations() const {
  std::vector<Violation> broken = geometry.violations();
  append(broken, rubber.violations());
  const bool press = analysis == Analysis::static_press || analysis == Analysis::transient;
  if (press) append(broken, protocol.violations(geometry));
  if (press && protocol.samples.empty())
    broken.push_back({"press.samples", "none", "the continuum is asked for forces at some depths",
                      "name at least one"});
  const auto require = [&](bool valid, const char* key, double value, const char* rule,
                           const char* remedy) {
    if (!valid) broken.push_back({key, meshes::to_text(value), rule, remedy});
  };
  require(degree >= 1 && degree <= 3, "reference.degree", degree, "must be 1, 2 or 3",
          "choose 2, quadratic elements");
  require(refinement >= 0.25 && refinement <= 4.0, "reference.refinement", refinement,
          "must lie between 0.25 and 4", "choose 0.5 and let the tolerance refine");
  require(tolerance >= 1e-5 && tolerance <= 0.5, "reference.tolerance", tolerance,
          "must lie between 1e-5 and 0.5", "choose 0.005 for half a percent");
  require(max_unknowns >= 1e3 && max_unknowns <= 1e9, "reference.max_unknowns", max_unknowns,
          "must lie between 1e3 and 1e9", "choose what your memory holds: 4e5 needs about 8 GB");
  require(solver_tolerance >= 1e-14 && solver_tolerance <= 1e-4, "reference.solver_tolerance",
          solver_tolerance, "must lie between 1e-14 and 1e-4", "choose 1e-10");
  require(field_sectors == 0 || (field_sectors >= 3 && field_sectors <= 360),
          "reference.field_sectors", field_sectors, "must be 0 or lie between 3 and 360",
          "choose 16 for a smooth body, 0 for the meridian alone");
  require(modes >= 1 && modes <= 1000, "reference.modes", modes, "must lie between 1 and 1000",
          "choose 10");
  if (strain == Strain::finite && broken.empty())
    for (Violation& violation : meshes::large_strain_violations(rubber)) {
      if (violation.key == "rubber.youngs_modulus") violation.key = "rubber";  // E beside G
      broken.push_back(std::move(violation));
    }
  if (symmetry == Symmetry::axisymmetric && !axisymmetric())
    broken.push_back(
        {"reference.symmetry", "axisymmetric",
         geometry.solid ? "a solid need not be a body of revolution"
         : press
             ? "a tilt, a lateral motion or an obstacle that is not round about the axis breaks "
               "the symmetry, and at large strain or where the rubber relaxes a twist"
             : "vibrations leave the meridian: they need the solid",
         "choose reference.symmetry = \"automatic\""});
  const bool split = strain == Strain::linear || rubber.energy.isochoric();
  if (press && !rubber.relaxation.empty() && !rubber.relaxation.bulk && !split)
    broken.push_back({"rubber.relaxation_bulk", "false",
                      "a law of full invariants has no part that a change of volume leaves alone, "
                      "so shear cannot relax without it",
                      "choose rubber.volumetric = \"quadratic\", or let all moduli relax"});
  if (analysis == Analysis::transient && geometry.solid)
    broken.push_back({"reference.mode", "transient",
                      "a transient press tells the force along the axis alone, and a solid, which "
                      "has no symmetry, is pushed aside, too",
                      "choose reference.mode = \"static\""});
  if (analysis == Analysis::transient)
    require(strain == Strain::linear && protocol.tilt == 0.0 && protocol.is_straight() &&
                protocol.obstacle.on_axis() && protocol.contact != meshes::ContactMode::coulomb,
            "reference.mode", 0.0,
            "a transient press is small-strain, along the axis, and frictionless or stick",
            "choose reference.strain = \"linear\", press.contact = \"stick\", no tilt, no twist");
  if (press && !rubber.relaxation.empty() && protocol.has_plane_moves())
    broken.push_back({"press.program", std::to_string(protocol.program.size()) + " stages",
                      "a rubber that relaxes is in time, where stages press and hold",
                      "leave lateral and twist stages out, or the relaxation"});
  return broken;
}

void write_job(const ReferenceJob& job, const std::filesystem::path& file) {
  const auto json = meshes::json_of<Json>(job);
  if (job.geometry.solid) write_surface(*job.geometry.solid, file.parent_path() / surface_file);
  meshes::write_atomically(file, [&](std::ostream& out) { out << json.dump(2) << '\n'; });
}

ReferenceJob read_job(const std::filesystem::path& file) {
  std::ifstream in(file);
  if (!in || !std::filesystem::is_regular_file(file))
    throw InvalidInput({file.string(), "unreadable", "the job file must exist and be readable",
                        "write it with write_job or start `fingertip reference`"});
  Json json;
  try {
    json = Json::parse(in);
  } catch (const Json::exception& error) {
    throw InvalidInput({file.string(), "", std::string("no valid JSON: ") + error.what(),
                        "write it with write_job or start `fingertip reference`"});
  }
  ReferenceJob job;
  std::vector<Violation> broken;
  // Its surface stands in a file of its own.
  std::string content;
  if (json.is_object() && json.contains("geometry") && json["geometry"].is_object() &&
      json["geometry"].contains("solid")) {
    const Json& solid = json["geometry"]["solid"];
    if (solid.is_string()) content = solid.get<std::string>();
    if (content.empty())
      broken.push_back({file.string() + ": geometry.solid", solid.dump(),
                        "must be the digest of a surface", "correct the entry or leave it out"});
    json["geometry"].erase("solid");
  }
  read_fields(json, file.string() + ": ", job, broken);
  if (broken.empty() && !content.empty())
    job.geometry.solid = read_surface(file.parent_path() / surface_file, content);
  if (broken.empty()) broken = job.violations();
  if (!broken.empty()) throw InvalidInput(broken);
  return job;
}

}  // namespace fingertip::fem_reference::inline job
