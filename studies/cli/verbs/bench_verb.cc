#include <fmt/format.h>

#include <vector>

#include "meshes/tables/fields_json.h"
#include "studies/bench/bench.h"
#include "studies/bench/history.h"
#include "studies/cli/command_line/run_verb.h"
#include "studies/cli/verbs/verbs.h"
#include "studies/report/report.h"

namespace fingertip::studies::inline cli::inline verbs {

namespace {

int width_of(const std::string& isa) {
  return isa == "avx512" ? 8 : isa == "avx2" ? 4 : isa == "sse2" ? 2 : 0;
}

}  // namespace

int run_bench(const CommandLine& line) {
  const LoadedConfig loaded = load_checked(line);
  BenchPlan plan = line.quick ? quick_plan() : full_plan();
  plan.widest = width_of(line.isa);
  std::erase_if(plan.presses,
                [&](const PressedLattice& press) { return press.per_radius > line.finest; });
  const std::filesystem::path history = history_file(line.history);
  return run_in_folder(line, loaded, {}, [&](Session& session) {
    const nlohmann::ordered_json bench = run_bench(session, loaded, plan);
    const std::filesystem::path& folder = session.folder().path();
    meshes::write_json_file(bench, folder / "bench.json");
    append_history(bench, history);
    report::write_report(folder);
    if (!line.json.empty()) meshes::write_json_file(bench, line.json);
    if (line.quiet) return 0;
    fmt::print("{}", bench_text(bench));
    fmt::print("history: {}\nreport: {}\n", history.string(), (folder / "report.html").string());
    return 0;
  });
}

}  // namespace fingertip::studies::inline cli::inline verbs
