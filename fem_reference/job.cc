#include "fem_reference/job.h"

#include <array>
#include <cmath>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <ostream>
#include <string>
#include <utility>

#include "meshes/files.h"

namespace fingertip::fem_reference {
namespace {

using Json = nlohmann::json;
using meshes::ContactMode;
using meshes::InvalidInput;
using meshes::Violation;

constexpr std::array contact_modes{ContactMode::stick, ContactMode::frictionless,
                                   ContactMode::coulomb};
constexpr std::array lateral_paths{meshes::LateralPath::diagonal, meshes::LateralPath::after};
constexpr std::array strains{Strain::linear, Strain::finite};
constexpr std::array analyses{Analysis::static_press, Analysis::transient, Analysis::modes,
                              Analysis::verification};
constexpr std::array volumetrics{Volumetric::pointwise, Volumetric::projected};
constexpr std::array laws{StrainEnergy::law_a, StrainEnergy::law_b, StrainEnergy::law_c};
constexpr std::array symmetries{Symmetry::automatic, Symmetry::axisymmetric, Symmetry::none};
constexpr std::array solvers{LinearSolver::automatic, LinearSolver::condensed,
                             LinearSolver::multigrid};

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
  target = value.get<T>();
}

template <class Names, class T>
void get_name(const Json& value, const Names& allowed, T& target) {
  const auto wanted = value.get<std::string>();
  std::string list;
  for (const T candidate : allowed) {
    if (name(candidate) == wanted) {
      target = candidate;
      return;
    }
    list += (list.empty() ? "" : ", ") + std::string(name(candidate));
  }
  throw std::invalid_argument("must be one of " + list);
}

/// Reads the entries of one JSON object and refuses those that nobody asked for.
class Section {
 public:
  Section(const Json& object, std::string prefix, std::vector<Violation>& broken)
      : object_(object), prefix_(std::move(prefix)), broken_(broken) {
    if (!object.is_object()) report("", object, "must be a JSON object");
  }
  ~Section() {
    if (!object_.is_object()) return;
    for (const auto& [key, value] : object_.items())
      if (std::ranges::find(known_, key) == known_.end())
        report(key, value, "is no entry of a reference job");
  }
  Section(const Section&) = delete;
  Section& operator=(const Section&) = delete;

  template <class Read>
  void read(const char* key, Read read_value) {
    known_.push_back(key);
    if (!object_.is_object() || !object_.contains(key)) return;
    try {
      read_value(object_.at(key));
    } catch (const std::invalid_argument& error) {
      report(key, object_.at(key), error.what());
    } catch (const Json::exception&) {
      report(key, object_.at(key), "is of the wrong type");
    }
  }
  template <class T>
  void value(const char* key, T& target) {
    read(key, [&](const Json& json) { get(json, target); });
  }

 private:
  void report(const std::string& key, const Json& value, const char* rule) {
    broken_.push_back({prefix_ + key, value.dump(), rule, "correct the entry or leave it out"});
  }

  const Json& object_;
  std::string prefix_;
  std::vector<Violation>& broken_;
  std::vector<std::string> known_;
};

void read_entries(const Json& json, const std::string& file, ReferenceJob& job,
                  std::vector<Violation>& broken) {
  Section top(json, file + ": ", broken);
  top.read("geometry", [&](const Json& object) {
    Section section(object, file + ": geometry.", broken);
    section.value("tip_radius", job.geometry.tip_radius);
    section.value("rod_radius", job.geometry.rod_radius);
    section.value("sleeve_length", job.geometry.sleeve_length);
    section.value("rod_length", job.geometry.rod_length);
  });
  top.read("rubber", [&](const Json& object) {
    Section section(object, file + ": rubber.", broken);
    section.value("youngs_modulus", job.rubber.youngs_modulus);
    section.value("shear_modulus", job.rubber.shear_modulus);
    section.value("density", job.rubber.density);
    section.value("retardation_time", job.rubber.retardation_time);
  });
  top.read("analysis", [&](const Json& j) { get_name(j, analyses, job.analysis); });
  top.read("strain", [&](const Json& j) { get_name(j, strains, job.strain); });
  top.read("law", [&](const Json& j) { get_name(j, laws, job.law); });
  top.read("symmetry", [&](const Json& j) { get_name(j, symmetries, job.symmetry); });
  top.read("volumetric", [&](const Json& j) { get_name(j, volumetrics, job.volumetric); });
  top.read("contact", [&](const Json& j) { get_name(j, contact_modes, job.contact); });
  top.read("solver", [&](const Json& j) { get_name(j, solvers, job.solver); });
  top.value("samples", job.samples);
  top.value("degree", job.degree);
  top.value("refinement", job.refinement);
  top.value("tolerance", job.tolerance);
  top.value("max_unknowns", job.max_unknowns);
  top.value("solver_tolerance", job.solver_tolerance);
  top.value("friction", job.friction);
  top.value("tilt", job.tilt);
  top.value("lateral", job.lateral);
  top.read("lateral_path", [&](const Json& j) { get_name(j, lateral_paths, job.lateral_path); });
  top.value("lateral_samples", job.lateral_samples);
  top.value("speed", job.speed);
  top.value("modes", job.modes);
  top.value("write_fields", job.write_fields);
  top.value("estimate_error", job.estimate_error);
}

}  // namespace

std::string_view name(LinearSolver solver) {
  switch (solver) {
    case LinearSolver::automatic: return "automatic";
    case LinearSolver::condensed: return "condensed";
    case LinearSolver::multigrid: return "multigrid";
  }
  return "";
}

std::string_view name(Strain strain) {
  return strain == Strain::linear ? "linear" : "finite";
}

std::string_view name(Analysis analysis) {
  switch (analysis) {
    case Analysis::static_press: return "static";
    case Analysis::transient: return "transient";
    case Analysis::modes: return "modes";
    case Analysis::verification: return "verification";
  }
  return "";
}

std::string_view name(Volumetric volumetric) {
  return volumetric == Volumetric::pointwise ? "pointwise" : "projected";
}

std::string_view name(StrainEnergy law) {
  switch (law) {
    case StrainEnergy::law_a: return "A";
    case StrainEnergy::law_b: return "B";
    case StrainEnergy::law_c: return "C";
  }
  return "";
}

std::string_view name(Symmetry symmetry) {
  switch (symmetry) {
    case Symmetry::automatic: return "automatic";
    case Symmetry::axisymmetric: return "axisymmetric";
    case Symmetry::none: return "none";
  }
  return "";
}

bool ReferenceJob::axisymmetric() const {
  const bool press = analysis == Analysis::static_press || analysis == Analysis::transient;
  return symmetry != Symmetry::none && press && tilt == 0.0 && lateral == 0.0;
}

meshes::PressProtocol ReferenceJob::protocol() const {
  meshes::PressProtocol protocol;
  protocol.depth = samples.empty() ? 0.0 : samples.back();
  protocol.samples = samples;
  protocol.contact = contact;
  protocol.friction = friction;
  protocol.tilt = tilt;
  protocol.lateral = lateral;
  protocol.lateral_path = lateral_path;
  protocol.lateral_samples = lateral_samples;
  return protocol;
}

std::vector<Violation> ReferenceJob::violations() const {
  std::vector<Violation> broken = geometry.violations();
  for (const Violation& violation : rubber.violations()) broken.push_back(violation);
  const bool press = analysis == Analysis::static_press || analysis == Analysis::transient;
  if (press)
    for (const Violation& violation : protocol().violations(geometry)) broken.push_back(violation);
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
  require(speed > 0.0 && std::isfinite(speed), "press.speed", speed, "must be positive",
          "choose for instance 1 cm/s");
  require(modes >= 1 && modes <= 1000, "reference.modes", modes, "must lie between 1 and 1000",
          "choose 10");
  if (strain == Strain::finite && law != StrainEnergy::law_c)  // C needs a bulk modulus > 0 only
    require(rubber.lame_lambda() >= -1e-12 * rubber.shear_modulus, "rubber", rubber.lame_lambda(),
            "finite strain needs nu >= 0: with a negative Lame constant lambda the energy falls "
            "without bound as the volume goes to zero",
            "choose G <= E/2, or reference.strain = \"linear\"");
  if (symmetry == Symmetry::axisymmetric && !axisymmetric())
    broken.push_back(
        {"reference.symmetry", "axisymmetric",
         analysis == Analysis::modes
             ? "natural vibrations leave the meridian: they need the solid"
             : "a tilt or a lateral motion of the plane breaks the symmetry about the axis",
         "choose reference.symmetry = \"automatic\", or press.tilt = \"0 deg\" and "
         "press.lateral = \"0 m\""});
  if (analysis == Analysis::transient)
    require(strain == Strain::linear && tilt == 0.0 && lateral == 0.0 &&
                contact != ContactMode::coulomb,
            "reference.mode", 0.0,
            "a transient press is small-strain, along the axis, and frictionless or stick",
            "choose reference.strain = \"linear\", press.contact = \"stick\", no tilt");
  return broken;
}

void write_job(const ReferenceJob& job, const std::filesystem::path& file) {
  const Json json{{"analysis", name(job.analysis)},
                  {"strain", name(job.strain)},
                  {"law", name(job.law)},
                  {"symmetry", name(job.symmetry)},
                  {"volumetric", name(job.volumetric)},
                  {"friction", job.friction},
                  {"tilt", job.tilt},
                  {"lateral", job.lateral},
                  {"lateral_path", name(job.lateral_path)},
                  {"lateral_samples", job.lateral_samples},
                  {"speed", job.speed},
                  {"modes", job.modes},
                  {"max_unknowns", job.max_unknowns},
                  {"solver_tolerance", job.solver_tolerance},
                  {"geometry",
                   {{"tip_radius", job.geometry.tip_radius},
                    {"rod_radius", job.geometry.rod_radius},
                    {"sleeve_length", job.geometry.sleeve_length},
                    {"rod_length", job.geometry.rod_length}}},
                  {"rubber",
                   {{"youngs_modulus", job.rubber.youngs_modulus},
                    {"shear_modulus", job.rubber.shear_modulus},
                    {"density", job.rubber.density},
                    {"retardation_time", job.rubber.retardation_time}}},
                  {"contact", name(job.contact)},
                  {"samples", job.samples},
                  {"degree", job.degree},
                  {"refinement", job.refinement},
                  {"tolerance", job.tolerance},
                  {"solver", name(job.solver)},
                  {"write_fields", job.write_fields},
                  {"estimate_error", job.estimate_error}};
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
  read_entries(json, file.string(), job, broken);
  if (broken.empty()) broken = job.violations();
  if (!broken.empty()) throw InvalidInput(broken);
  return job;
}

}  // namespace fingertip::fem_reference
