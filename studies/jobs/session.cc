#include "studies/jobs/session.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <exception>
#include <mutex>
#include <thread>

#include "lattice/control/controller.h"
#include "meshes/base/errors.h"
#include "studies/jobs/interrupt.h"
#include "studies/jobs/result_files.h"

namespace fingertip::studies::inline jobs {

namespace fs = std::filesystem;

namespace {

/// Where a result from the cache waits to be moved to its place.
constexpr const char* fetched_name = ".fetched";

}  // namespace

void side_by_side(std::size_t count, int threads, const std::function<void(std::size_t)>& work) {
  std::atomic<std::size_t> next = 0;
  std::mutex mutex;
  std::exception_ptr failure;
  const auto work_on = [&] {
    for (std::size_t i = next++; i < count; i = next++) {
      try {
        if (interrupted()) throw meshes::Interrupted("stopped by the user");
        work(i);
      } catch (...) {
        const std::lock_guard lock(mutex);
        if (!failure) failure = std::current_exception();
        next = count;
      }
    }
  };
  {
    std::vector<std::jthread> workers;
    for (int worker = 0; worker < std::max(1, threads); ++worker) workers.emplace_back(work_on);
  }
  if (failure) std::rethrow_exception(failure);
}

JobResult Session::run(const PlannedJob& planned) {
  return run_with(planned, threads_);
}

void Session::clear(const PlannedJob& planned) const {
  const fs::path folder = path_of(planned);
  fs::create_directories(folder);
  for (const auto& item : fs::directory_iterator(folder)) {
    if (!is_run_file(item.path())) fs::remove_all(item.path());
  }
}

bool Session::fetch(const PlannedJob& planned) const {
  const fs::path target = path_of(planned), fetched = target / fetched_name;
  fs::create_directories(target);
  if (!cache_.fetch(planned.job, fetched)) return false;
  clear(planned);
  for (const auto& item : fs::directory_iterator(fetched)) {
    if (item.path().filename() != marker_name)
      fs::rename(item.path(), target / item.path().filename());
  }
  fs::rename(fetched / marker_name, target / marker_name);
  fs::remove(fetched);
  return true;
}

bool Session::reuse(const PlannedJob& planned, JobResult& result) {
  const fs::path target = path_of(planned);
  if (const std::string file = damaged_result(target); !file.empty()) {
    const std::string words = fmt::format("{} is not as it was computed: {} starts again",
                                          (target / file).string(), result.name);
    folder_.log(words);
    progress_.clear();
    fmt::print(stderr, "fingertip: note: {}\n", words);
  }
  const auto usable = [&] {
    result.status = marked_status(planned.job, target);
    return result.ok() || (planned.exhibit && !result.status.empty());
  };
  if (usable()) {
    folder_.log(result.name + ": kept from the resumed run");
    return true;
  }
  if (planned.job.repeatable && fetch(planned) && usable()) {
    folder_.log(result.name + ": from the cache, " + planned.job.key().substr(0, 16));
    return true;
  }
  const bool goes_on = planned.job.resumable && attempted(planned.job, target);
  if (goes_on) {
    folder_.log(result.name + ": goes on from an attempt that ended early");
  } else {
    clear(planned);
  }
  return false;
}

void Session::compute(const PlannedJob& planned, JobResult& result, int threads) {
  const auto start = std::chrono::steady_clock::now();
  const fs::path target = path_of(planned);
  const JobContext context{[&](double fraction, const std::string& stage) {
                             progress_.report(result.name, fraction, stage);
                             return !interrupted();
                           },
                           [&](const std::string& line) { folder_.log(result.name + ": " + line); },
                           threads, ranks_,
                           [&](std::vector<PlannedJob> further) {
                             std::vector<fs::path> folders;
                             for (PlannedJob& follower : further) {
                               follower.name = fs::path(planned.name).parent_path() / follower.name;
                               folders.push_back(path_of(follower));
                             }
                             run_all(further);
                             return folders;
                           }};
  result.status = finished;
  mark_attempt(planned.job, target);
  try {
    planned.job.run(target, context);
  } catch (const ProcessLost& error) {
    folder_.log(result.name + ": " + error.what());
    throw;
  } catch (const lattice::ControllerFailed& error) {
    folder_.log(result.name + ": " + error.what());
    throw;
  } catch (const meshes::NotConverged& error) {
    result.status = std::string("not converged: ") + error.what();
    if (!planned.exhibit) {
      folder_.log(result.name + ": " + result.status);
      throw;
    }
  }
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
  result.wall_time = elapsed.count();
  mark(planned.job, target, result.status, result.wall_time);
}

JobResult Session::run_with(const PlannedJob& planned, int threads) {
  JobResult result{planned.name.empty() ? planned.job.kind : planned.name, "", true, 0.0};
  progress_.expect(result.name, planned.job.weight);
  if (!reuse(planned, result)) {
    result.reused = false;
    folder_.log(result.name + ": started");
    compute(planned, result, threads);
    if (planned.job.repeatable && !cache_.store(planned.job, path_of(planned))) {
      folder_.log(result.name + ": could not be cached");
    }
    folder_.log(fmt::format("{}: {} in {:.2f} s", result.name, result.status, result.wall_time));
  }
  if (result.reused) {
    progress_.reused(result.name);
  } else {
    progress_.report(result.name, 1.0, "finished");
  }
  return result;
}

std::vector<JobResult> Session::run_all(const std::vector<PlannedJob>& planned) {
  for (const PlannedJob& job : planned) progress_.expect(job.name, job.job.weight);
  std::vector<JobResult> results(planned.size());
  side_by_side(planned.size(), threads_,
               [&](std::size_t i) { results[i] = run_with(planned[i], 1); });
  return results;
}

}  // namespace fingertip::studies::inline jobs
