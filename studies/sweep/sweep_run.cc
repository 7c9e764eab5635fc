#include "studies/sweep/sweep_run.h"

#include <algorithm>
#include <mutex>

#include "lattice/control/controller.h"
#include "meshes/base/errors.h"
#include "meshes/tables/fields_json.h"
#include "studies/files/json_entry.h"
#include "studies/files/places.h"
#include "studies/jobs/cache.h"
#include "studies/jobs/file_lock.h"
#include "studies/jobs/progress.h"
#include "studies/jobs/run_folder.h"
#include "studies/jobs/session.h"
#include "studies/presses/grasp_job.h"
#include "studies/presses/modes_job.h"
#include "studies/presses/press_job.h"
#include "studies/presses/press_setup.h"
#include "studies/presses/reference_job.h"

namespace fingertip::studies::inline sweep {

namespace {

namespace fs = std::filesystem;

nlohmann::ordered_json content_of(const Sweep& sweep) {
  auto points = nlohmann::ordered_json::array();
  for (const SweepPoint& point : sweep.points) {
    points.push_back({{"id", point.id}, {"settings", point.settings}});
  }
  return {{"verb", sweep.verb}, {"axes", sweep.axes}, {"points", points}};
}

Job job_of(const Sweep& sweep, const SweepPoint& point) {
  LoadedConfig loaded = config_of(sweep, point);
  check_all(loaded);
  if (sweep.verb == "reference") return reference_job(continuum_setup(loaded));
  const bool press = sweep.verb == "press";
  loaded = press ? with_material(loaded, LatticeUse::press)
                 : with_material(at_pace(loaded), LatticeUse::modes);
  if (press) return press_job(press_setup(loaded));
  if (sweep.verb == "modes") return modes_job(press_setup(loaded), loaded.config.lattice_modes);
  return grasp_job(grasp_setup(loaded));
}

/// What a process that was killed before it had noted what it was doing has left.
void clear_fragment(const fs::path& folder) {
  if (fs::exists(folder) && !fs::exists(folder / "manifest.json")) fs::remove_all(folder);
}

/// The job in a run folder of its own.
PointResult compute(const Sweep& sweep, const PlannedPoint& planned, const fs::path& folder,
                    const std::vector<std::string>& command_line) {
  const auto& [point, job] = planned;
  clear_fragment(folder);
  Progress progress(ProgressStyle::off);
  RunFolder run({sweep.verb, folder, false, true, command_line}, config_of(sweep, point));
  Session session(run, progress, Cache(cache_folder()), 1);
  const auto failed = [&](const char* status, const std::exception& error) {
    run.finish(status, 3, error.what());
    return PointResult{point.id, std::string("failed: ") + error.what(), false};
  };
  try {
    const JobResult result = session.run({"", job, true});
    run.finish(result.ok() ? "finished" : "not converged", result.ok() ? 0 : 3);
    return {point.id, result.status, result.reused};
  } catch (const meshes::Interrupted& error) {
    run.finish("interrupted", 130, error.what());
    throw;
  } catch (const ProcessLost& error) {
    return failed("process lost", error);
  } catch (const lattice::ControllerFailed& error) {
    return failed("controller failed", error);
  } catch (const meshes::InvalidInput& error) {
    return failed("bad input", error);
  }
}

PointResult run_point(const Sweep& sweep, const PlannedPoint& planned, const fs::path& folder,
                      const std::vector<std::string>& command_line) {
  const auto& [point, job] = planned;
  const FileLock lock(folder / "locks" / point.id);
  if (!lock.held()) return {point.id, "at work elsewhere", false};
  const fs::path own = folder / "points" / point.id;
  // Also where the point was finished when its process was killed.
  remove_abandoned_parts(own, lock);
  const std::string status = marked_status(job, own);
  if (!status.empty()) return {point.id, status, true};
  return compute(sweep, planned, own, command_line);
}

}  // namespace

std::vector<PlannedPoint> plan(const Sweep& sweep, const std::vector<SweepPoint>& points) {
  std::vector<PlannedPoint> planned;
  for (const SweepPoint& point : points) planned.push_back({point, job_of(sweep, point)});
  return planned;
}

void claim_folder(const Sweep& sweep, const fs::path& folder) {
  const auto refuse = [&](const char* rule) {
    throw ConfigError({"", "", rule, "choose another folder", "--out " + folder.string()});
  };
  const auto content = content_of(sweep);
  if (fs::exists(folder / sweep_file)) {
    if (parse_json(folder / sweep_file) != content) refuse("the folder belongs to another sweep");
    return;
  }
  const auto foreign = [](const fs::directory_entry& item) {
    const fs::path name = item.path().filename();
    return name != "points" && name != "locks" && !name.string().starts_with(sweep_file);
  };
  if (fs::exists(folder) && std::any_of(fs::directory_iterator(folder), {}, foreign)) {
    refuse("exists and is not the folder of a sweep");
  }
  fs::create_directories(folder / "points");
  fs::create_directories(folder / "locks");
  meshes::write_json_file(content, folder / sweep_file);
}

std::vector<PointResult> run_points(const Sweep& sweep, const std::vector<PlannedPoint>& points,
                                    const fs::path& folder, int threads,
                                    const std::vector<std::string>& command_line,
                                    const std::function<void(const PointResult&)>& tell) {
  Cache(cache_folder()).tidy();
  std::vector<PointResult> results(points.size());
  std::mutex mutex;
  side_by_side(points.size(), threads, [&](std::size_t p) {
    results[p] = run_point(sweep, points[p], folder, command_line);
    const std::lock_guard lock(mutex);
    tell(results[p]);
  });
  return results;
}

}  // namespace fingertip::studies::inline sweep
