#include "studies/fits/setup/fit_displacements.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "calibration/statistics/fit_statistics.h"
#include "meshes/base/files.h"
#include "meshes/press/markers.h"
#include "studies/config/elasticity.h"
#include "studies/config/finger_defaults.h"
#include "studies/config/text/toml_text.h"
#include "studies/fits/models/fit_relaxation.h"
#include "studies/fits/setup/fit_curves.h"
#include "studies/presses/press_setup.h"

namespace fingertip::studies::inline fits::inline setup {

namespace {

namespace fs = std::filesystem;

constexpr const char* compression_word = "compression";
constexpr const char* slip_word = "slip";
constexpr std::array displacement_words = {"poissons_ratio", compression_word, slip_word};

bool asks(const LoadedConfig& loaded, const std::string& word) {
  return std::ranges::count(loaded.config.calibration.parameters, word) > 0;
}

/// What cannot be read is told by those who read it.
bool tells_displacements(const fs::path& entry) {
  try {
    return has_displacements(entry);
  } catch (const meshes::InvalidInput&) {
    return false;
  }
}

std::string toml_list(const std::vector<std::string>& texts) {
  toml::array list;
  for (const std::string& text : texts) list.push_back(text);
  return toml_literal(list);
}

template <typename T>
std::vector<T> without(std::vector<T> list, std::size_t place) {
  list.erase(list.begin() + std::ptrdiff_t(place));
  return list;
}

/// What forces are asked beside displacements.
std::vector<std::string> force_parameters(const LoadedConfig& loaded) {
  std::vector<std::string> words{"modulus"};
  for (const std::string& word : loaded.config.calibration.parameters)
    if (word != "modulus" && word != "youngs_modulus" && word != "shear_modulus" &&
        std::ranges::find(displacement_words, word) == displacement_words.end())
      words.push_back(word);
  return words;
}

LoadedConfig forces_of(const LoadedConfig& loaded, std::size_t displacements) {
  const CalibrationSettings& settings = loaded.config.calibration;
  std::vector<std::string> files;
  for (const fs::path& file : without(settings.data, displacements)) files.push_back(file.string());
  std::vector<std::string> sets{
      "calibration.data=" + toml_list(files),
      "calibration.parameters=" +
          toml_list(files.empty() ? std::vector<std::string>() : force_parameters(loaded))};
  if (!settings.conditions.empty())
    sets.push_back("calibration.conditions=" +
                   toml_list(without(settings.conditions, displacements)));
  return with_sets(loaded, sets);
}

void check(const LoadedConfig& loaded, bool has_forces) {
  if (loaded.entries.at("calibration.poisson_range").given)
    throw refused(loaded, "calibration.poisson_range", "",
                  "the measured displacements tell Poisson's ratio", "leave it out");
  if (has_forces) return;
  for (const std::string& word : loaded.config.calibration.parameters)
    if (std::ranges::find(displacement_words, word) == displacement_words.end())
      throw refused(loaded, "calibration.parameters", word,
                    "displacements tell Poisson's ratio alone: whatever the stiffness, points go "
                    "the same way",
                    "name poissons_ratio, or give forces of the same rubber among the data");
}

std::vector<meshes::Violation> placed(std::vector<meshes::Violation> broken,
                                      const std::string& place) {
  for (meshes::Violation& violation : broken)
    if (violation.place.empty()) violation.place = place;
  return broken;
}

/// Too few points, or such that tell no strain.
void check_points(const DisplacementFitInput& input) {
  try {
    calibration::DisplacementMoments(input.measured.places, input.measured.samples, input.frame);
  } catch (const meshes::InvalidInput& error) {
    throw ConfigError(placed(error.violations(), input.measured.name));
  }
}

}  // namespace

void put_markers(const DisplacementFile& measured, const meshes::Geometry& geometry,
                 const std::string& place, meshes::PressProtocol& protocol) {
  const std::vector<meshes::Violation> broken =
      meshes::marker_violations(measured.places, geometry);
  if (!broken.empty()) throw ConfigError(placed(broken, place));
  protocol.markers = measured.places;
}

DisplacementFitInput displacement_input(const LoadedConfig& loaded, DisplacementFile measured,
                                        const std::string& place) {
  DisplacementFitInput input;
  input.measured = std::move(measured);
  input.place = place;
  input.by_lattice = loaded.config.calibration.forward == ForwardKind::lattice;
  input.freed = {asks(loaded, compression_word), asks(loaded, slip_word)};
  if (loaded.config.calibration.frame_held) input.frame = calibration::FrameMotion::held;
  std::vector<double> depths;
  for (const auto& load : input.measured.samples) depths.push_back(load.indentation);
  std::vector<std::string> sets{"press.mode=static", "sensor.markers=none",
                                samples_setting(depths)};
  if (input.by_lattice && !loaded.entries.at("lattice.model").given)
    sets.emplace_back("lattice.model=network");
  LoadedConfig own = with_sets(in_equilibrium(loaded), sets);
  keep_spacing(own, loaded);
  const bool small = loaded.entries.at("lattice.kinematics").given &&
                     own.config.press.lattice.kinematics == lattice::Kinematics::small;
  if (input.by_lattice)
    input.press = press_setup(own);
  else
    input.continuum =
        continuum_beside(own, small ? lattice::Kinematics::small : lattice::Kinematics::finite);
  meshes::PressProtocol& protocol =
      input.by_lattice ? input.press.protocol : input.continuum.protocol;
  refuse_motion(own, protocol);
  put_markers(input.measured, own.config.press.geometry, input.measured.name, protocol);
  check_points(input);
  return input;
}

SplitData split_data(const LoadedConfig& loaded) {
  SplitData split{.forces = loaded};
  const CalibrationSettings& settings = loaded.config.calibration;
  if (settings.problem != CalibrationProblem::experiment) return split;
  const auto found = std::ranges::find_if(settings.data, tells_displacements);
  if (found == settings.data.end()) {
    for (const char* const word : displacement_words)
      if (asks(loaded, word))
        throw refused(loaded, "calibration.parameters", word,
                      "is told by measured displacements, and calibration.data has none",
                      "add a file of displacements; of forces alone name youngs_modulus and "
                      "shear_modulus");
    return split;
  }
  if (const auto second = std::find_if(found + 1, settings.data.end(), tells_displacements);
      second != settings.data.end())
    throw refused(loaded, "calibration.data", second->string(),
                  "a second file of displacements, beside " + found->string(),
                  "put the loads of one finger into one file, and fit two fingers one by one");
  const auto place = std::size_t(found - settings.data.begin());
  if (!settings.conditions.empty() && settings.conditions.size() != settings.data.size())
    throw refused(loaded, "calibration.conditions", "",
                  "there must be one per file of calibration.data, or none", "complete the list");
  split.has_forces = settings.data.size() > 1;
  check(loaded, split.has_forces);
  split.forces = forces_of(loaded, place);
  const LoadedConfig own = settings.conditions.empty()
                               ? loaded
                               : under(loaded, settings_in(settings.conditions[place]), {});
  split.displacements = displacement_input(own, read_displacements(*found), "ratios");
  for (const std::string& note : split.displacements->measured.notes)
    split.notes.push_back(split.displacements->measured.name + ": " + note);
  if (!own.entries.at("press.contact").given && !split.displacements->freed.slip)
    split.notes.push_back(fmt::format(
        "press.contact is not told: displacements are those of a finger that meets the obstacle "
        "by {} contact; name slip among calibration.parameters to have it fitted",
        meshes::name(own.config.press.protocol.contact)));
  return split;
}

LoadedConfig with_ratio(const LoadedConfig& loaded, const calibration::DisplacementFitFile& fit) {
  // A range is where a number may be anywhere: that of the interval's deviation, to either side.
  const double share = std::sqrt(3.0) / calibration::normal_95();
  const double nu = fit.poissons_ratio, low = nu + share * (fit.lower - nu),
               high = nu + share * (fit.upper - nu);
  std::vector<std::string> sets = settings_at_ratio(loaded, nu);
  sets.push_back("calibration.poisson_range=[" + meshes::to_text(low) + ", " +
                 meshes::to_text(high) + "]");
  LoadedConfig own = with_sets(loaded, sets);
  keep_spacing(own, loaded);
  return own;
}

}  // namespace fingertip::studies::inline fits::inline setup
