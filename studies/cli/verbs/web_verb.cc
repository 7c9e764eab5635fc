#include "studies/web/web_folder.h"

#include <fmt/format.h>

#include <array>
#include <filesystem>

#include "meshes/press/press_response.h"
#include "studies/cli/command_line/real_time.h"
#include "studies/cli/command_line/run_verb.h"
#include "studies/cli/verbs/verbs.h"
#include "studies/config/asked_units.h"
#include "studies/files/places.h"
#include "studies/presses/pace_choice.h"
#include "studies/presses/pace_trial.h"
#include "studies/presses/press_setup.h"
#include "studies/presses/reference_job.h"

namespace fingertip::studies::inline cli::inline verbs {

namespace {

namespace fs = std::filesystem;

/// Parts of the tip's radius; the page takes the finest that keeps up.
constexpr std::array divisors = {6, 8, 10, 12};
/// Of studies/examples: beside the dome what a page may press, which has no solids.
constexpr std::array examples = {"solid_finger", "hollow_finger", "flat_ellipsoid"};

struct Source {
  std::string name;
  LoadedConfig loaded;
};

LoadedConfig loaded_from(const CommandLine& line, const fs::path& file) {
  ConfigSource source = line.config;
  if (!file.empty()) source.file = file;
  return with_any_integrator(with_sets(load_config(source), as_a_person_presses()));
}

/// The finger that somebody has configured, or the dome and the examples.
std::vector<Source> sources_of(const CommandLine& line) {
  const fs::path& own = line.config.file;
  std::vector<Source> sources = {
      {own.empty() ? "dome" : own.stem().string(), loaded_from(line, own)}};
  if (!own.empty()) return sources;
  const fs::path folder = data_folder("examples", FINGERTIP_EXAMPLES);
  for (const std::string name : examples)
    sources.push_back({name, loaded_from(line, folder / (name + ".toml"))});
  return sources;
}

void check(const LoadedConfig& loaded) {
  if (loaded.config.press.geometry.solid)
    refuse("web", "a page presses no solids", "take a dome or a profile, or the verb live");
  if (press_setup(with_material(loaded, LatticeUse::press)).make_controller)
    refuse("web", "a page has no controller but the built-in one",
           "leave controller.type, or take the verb live");
}

std::vector<WebSample> samples_of(const fs::path& curve) {
  std::vector<WebSample> samples;
  const meshes::PressResponse response = meshes::PressResponse::read_csv(curve);
  for (const meshes::PressSample& sample : response.pressing())
    samples.push_back({sample.indentation, sample.normal_force, sample.force_error});
  return samples;
}

/// With the integrator and the step that --real-time takes where nobody has chosen them.
lattice::PressSetup paced(const LoadedConfig& loaded) {
  lattice::PressSetup setup = press_setup(loaded);
  const PaceCandidate choice = pace_candidates(setup, loaded.config.automatic_integrator, 1).back();
  setup.integrator = choice.integrator;
  if (choice.integrator == lattice::Integrator::mass_scaled) setup.time_step = choice.step;
  return setup;
}

/// At all spacings that the finger's thin parts allow, else at its own.
WebFinger finger_of(const Source& source, const std::vector<WebSample>& reference) {
  WebFinger finger{source.name, {}};
  const auto add = [&](const LoadedConfig& loaded) {
    const lattice::PressSetup setup = paced(with_material(loaded, LatticeUse::press));
    const double divisor = setup.geometry.tip_radius / setup.lattice.spacing;
    finger.presses.push_back(
        {fmt::format("R/{:.3g}", divisor), {setup, {}, reference, asked_units(source.loaded)}});
  };
  const meshes::Geometry& geometry = source.loaded.config.press.geometry;
  for (const int divisor : divisors)
    if (geometry.tip_radius / divisor <= geometry.coarsest_spacing())
      add(with_sets(source.loaded, {fmt::format("lattice.spacing=tip_radius/{}", divisor)}));
  if (finger.presses.empty()) add(source.loaded);
  return finger;
}

PlannedJob continuum_of(const Source& source) {
  const lattice::Kinematics kinematics = source.loaded.config.press.lattice.kinematics;
  return {
      "continuum/" + source.name,
      reference_job(continuum_beside(with_material(source.loaded, LatticeUse::press), kinematics)),
      false};
}

}  // namespace

int run_web(const CommandLine& line) {
  const std::vector<Source> sources = sources_of(line);
  for (const Source& source : sources) check(source.loaded);
  if (!fs::exists(module_file()))
    refuse("web", "the lattice for browsers is not built: there is no " + module_file().string(),
           "start ./fingertip web from a clone, which builds it");
  return run_in_folder(line, sources.front().loaded, {}, [&](Session& session) {
    std::vector<PlannedJob> continua;
    for (const Source& source : sources) continua.push_back(continuum_of(source));
    session.run_all(continua);
    std::vector<WebFinger> fingers;
    for (std::size_t i = 0; i < sources.size(); ++i) {
      const fs::path curve = session.path_of(continua[i]) / "response.csv";
      fingers.push_back(finger_of(sources[i], samples_of(curve)));
    }
    const fs::path folder = session.folder().path();
    write_page(folder, fingers);
    if (!line.quiet)
      fmt::print("open this file in a browser, or put the folder on any web server:\n{}\n",
                 (fs::absolute(folder) / "index.html").string());
    return 0;
  });
}

}  // namespace fingertip::studies::inline cli::inline verbs
