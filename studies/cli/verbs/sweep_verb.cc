#include <fmt/format.h>

#include <algorithm>

#include "studies/cli/command_line/run_verb.h"
#include "studies/cli/verbs/verbs.h"
#include "studies/jobs/interrupt.h"
#include "studies/sweep/sweep_run.h"
#include "studies/sweep/sweep_table.h"

namespace fingertip::studies::inline cli::inline verbs {

namespace {

namespace fs = std::filesystem;

/// 3 when points are missing or did not converge. Throws InvalidInput when some are damaged.
int collect_all(const fs::path& folder, bool quiet) {
  const SweepCensus census = collect(folder);
  if (!quiet) {
    fmt::print("{}{} points: {} finished, {} not converged, {} missing{}\ntable: {}\n", census.text,
               census.points, census.finished, census.failed(), census.missing,
               census.damaged > 0 ? fmt::format(", {} damaged", census.damaged) : "",
               (folder / "table.csv").string());
    std::fflush(stdout);
  }
  if (!census.damage.empty()) throw meshes::InvalidInput(census.damage);
  return census.finished == census.points ? 0 : 3;
}

/// A shard joins the others' folder; a whole sweep has its own unless it is to be resumed.
void prepare(const Sweep& sweep, const CommandLine& line) {
  if (line.out.empty()) {
    refuse("sweep", "needs a folder that shards can share", "say --out DIR");
  }
  if (line.force) {
    refuse("--force", "a sweep never throws results away", "choose another folder");
  }
  if (fs::exists(line.out) && !fs::is_empty(line.out) && line.shard.empty() && !line.resume) {
    refuse("--out " + line.out.string(), "the output folder exists already",
           "choose another folder, or say --resume auto to compute what is missing");
  }
  claim_folder(sweep, line.out);
}

}  // namespace

int run_sweep(const CommandLine& line) {
  if (line.collect) {
    if (line.out.empty()) refuse("--collect", "needs the folder of a sweep", "say --out DIR");
    return collect_all(line.out, line.quiet);
  }
  if (line.arguments.size() > 1) refuse("sweep", "takes one verb", "sweep one after the other");
  const Sweep sweep = read_sweep(line.config, line.arguments.empty() ? "" : line.arguments.front());
  const Shard shard = line.shard.empty() ? Shard{} : parse_shard(line.shard);
  const std::vector<SweepPoint> points = points_of(sweep, shard);
  if (line.list) {
    for (const SweepPoint& point : points) fmt::print("{}\t{}\n", point.id, settings_text(point));
    return 0;
  }
  const std::vector<PlannedPoint> planned = plan(sweep, points);  // before a folder is made
  prepare(sweep, line);
  watch_for_interrupts();
  std::size_t done = 0;
  const auto tell = [&](const PointResult& result) {
    if (line.quiet) return;
    fmt::print("[{}/{}] {} {}{}\n", ++done, points.size(), result.id, result.status,
               result.reused ? " (earlier)" : "");
    std::fflush(stdout);
  };
  const auto results =
      run_points(sweep, planned, line.out, cores_for(sweep.base), line.words, tell);
  if (line.shard.empty()) return collect_all(line.out, line.quiet);
  const auto ok = [](const PointResult& result) { return result.status == "finished"; };
  return std::ranges::all_of(results, ok) ? 0 : 3;
}

}  // namespace fingertip::studies::inline cli::inline verbs
