#include "studies/exchange/contact_curves.h"

#include <fmt/format.h>

#include "meshes/base/files.h"
#include "meshes/press/limit_surface.h"
#include "meshes/press/press_response.h"
#include "meshes/shape/geometry.h"
#include "meshes/tables/table_rows.h"
#include "studies/files/shown_units.h"
#include "studies/presses/press_job.h"
#include "studies/presses/press_setup.h"
#include "studies/presses/reference_job.h"

namespace fingertip::studies::inline exchange {

namespace {

using meshes::Obstacle;
using meshes::ObstacleShape;

constexpr int samples = 12;

std::string name_of(const Obstacle& obstacle) {
  return obstacle.is_plane() ? "plane"
                             : fmt::format("{} of {}", meshes::name(obstacle.shape),
                                           shown_units().length.text(obstacle.radius));
}

std::vector<Obstacle> pressed(const Config& config, ContactCurves::Of of) {
  const Obstacle& own = config.press.protocol.obstacle;
  if (of != ContactCurves::Of::contacts) return {own};
  Obstacle large = own, small = own;
  if (own.is_plane()) {
    large.shape = small.shape = ObstacleShape::sphere;
    large.radius = meshes::shape_of(config.press.geometry)->pole_radius();
  } else {
    large.radius = 2.0 * own.radius;
  }
  small.radius = own.is_plane() ? 0.5 * large.radius : 0.5 * own.radius;
  return {own, large, small};
}

std::vector<double> depths_to(double depth) {
  std::vector<double> depths;
  for (int i = 1; i <= samples; ++i) depths.push_back(depth * (double(i) / samples));
  return depths;
}

/// Of every sample of a press, by its own pressure.
std::vector<double> greatest_moments(const std::filesystem::path& folder) {
  std::vector<double> moments(samples, meshes::unknown);
  const std::filesystem::path file = folder / "contact_field.csv";
  if (!std::filesystem::exists(file)) return moments;
  const auto field = meshes::read_rows<meshes::ContactPoint>(file);
  for (const auto points : meshes::samples_of(field)) {
    const int sample = points.front().sample;
    if (sample < 1 || sample > samples) continue;
    moments[std::size_t(sample) - 1] = meshes::limit_point(points, 0.0).moment;
  }
  return moments;
}

}  // namespace

std::vector<meshes::Violation> not_straight(const meshes::PressProtocol& protocol) {
  std::vector<meshes::Violation> found;
  const auto refuse = [&](const char* key, const std::string& value, const char* remedy) {
    found.push_back({key, value,
                     "contact and moduli for another program are fitted to a press straight down",
                     remedy});
  };
  if (protocol.tilt != 0.0)
    refuse("press.tilt", meshes::to_text(protocol.tilt) + " rad", "choose 0");
  if (protocol.lateral != 0.0)
    refuse("press.lateral", meshes::to_text(protocol.lateral) + " m", "choose 0");
  if (protocol.has_twist())
    refuse("press.twist", meshes::to_text(protocol.twist) + " rad", "choose 0");
  if (!protocol.program.empty())
    refuse("press.program", std::to_string(protocol.program.size()) + " stages",
           "leave it out; press.depth says how deep");
  return found;
}

ContactCurves::ContactCurves(const LoadedConfig& loaded, Of of) {
  const std::vector<meshes::Violation> found = not_straight(loaded.config.press.protocol);
  if (!found.empty()) throw loaded.locate(found);
  const double depth = loaded.config.press.protocol.depth;
  for (const Obstacle& obstacle : pressed(loaded.config, of)) {
    LoadedConfig own = loaded;
    meshes::PressProtocol& protocol = own.config.press.protocol;
    protocol.obstacle = obstacle;
    protocol.samples = depths_to(depth);
    protocol.markers.clear();
    const fem_reference::Strain strain = loaded.entries.at("reference.strain").given
                                             ? loaded.config.reference.strain
                                             : fem_reference::Strain::finite;
    const bool fitted = jobs_.empty();
    jobs_.push_back({fmt::format("continuum/{}", jobs_.size() + 1),
                     reference_job(continuum_at_rest(own, strain)), !fitted});
    curves_.push_back({name_of(obstacle), obstacle, fitted, {}, {}, {}, {}});
  }
  if (of == Of::lattice) {
    LoadedConfig own = loaded;
    meshes::PressProtocol& protocol = own.config.press.protocol;
    protocol.mode = meshes::DriveMode::equilibrium;
    protocol.samples = depths_to(depth);
    if (lattice::beyond_the_lattice(own.config.press).empty())
      jobs_.push_back({"lattice", press_job(press_setup(own)), true});
  }
}

std::vector<ContactCurve> ContactCurves::read(const std::filesystem::path& folder) const {
  std::vector<ContactCurve> curves = curves_;
  if (jobs_.size() > curves.size()) {
    const std::filesystem::path file = folder / jobs_.back().name / "response.csv";
    if (std::filesystem::exists(file)) {
      const auto response = meshes::PressResponse::read_csv(file);
      for (const meshes::PressSample& sample : response.samples())
        curves.front().lattice.push_back(sample.normal_force);
    }
  }
  for (std::size_t i = 0; i < curves.size(); ++i) {
    const std::filesystem::path file = folder / jobs_[i].name / "response.csv";
    if (!std::filesystem::exists(file)) continue;
    const auto response = meshes::PressResponse::read_csv(file);
    if (response.samples().size() != std::size_t(samples)) continue;
    curves[i].greatest_moment = greatest_moments(folder / jobs_[i].name);
    for (const meshes::PressSample& sample : response.samples()) {
      curves[i].forces.indentation.push_back(sample.indentation);
      curves[i].forces.force.push_back(sample.normal_force);
      curves[i].force_error.push_back(sample.force_error);
    }
  }
  return curves;
}

std::vector<meshes::Violation> lost_in_contact(const LoadedConfig& loaded) {
  const lattice::PressSetup& press = loaded.config.press;
  std::vector<meshes::Violation> lost;
  const auto add = [&](const char* key, const char* rule, const char* remedy) {
    const Entry& entry = loaded.entries.at(key);
    lost.push_back({key, entry.literal, rule, remedy, entry.place});
  };
  if (press.protocol.contact == meshes::ContactMode::stick)
    add("press.contact",
        "rubber that sticks is stiffer than rubber that slips, by traction along the surface that "
        "is not handed over: the other program would add its own friction to it",
        "add --set press.contact=frictionless, or --lossy to go on with this");
  if (!press.rubber.relaxation.empty())
    add("rubber.relaxation", "what is fitted to a press at rest knows no time",
        "add --set rubber.relaxation=[]: the forces are then those after long times; or --lossy to "
        "go on with this");
  return lost;
}

}  // namespace fingertip::studies::inline exchange
