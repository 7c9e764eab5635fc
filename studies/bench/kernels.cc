#include "studies/bench/kernels.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "meshes/press/press_response.h"
#include "studies/bench/lammps.h"
#include "studies/exchange/lammps/lammps_program.h"
#include "studies/files/json_entry.h"
#include "studies/files/places.h"
#include "studies/files/process.h"
#include "studies/jobs/interrupt.h"
#include "studies/jobs/provenance.h"

namespace fingertip::studies::inline bench {

namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

/// "NAME/isa:X/precision:P/threads:N/size:N/min_time:..." into its parts.
KernelSample sample_named(const std::string& full) {
  KernelSample sample;
  std::istringstream words(full);
  for (std::string word; std::getline(words, word, '/');) {
    const auto colon = word.find(':');
    const std::string key = word.substr(0, colon);
    const std::string value = colon == word.npos ? "" : word.substr(colon + 1);
    if (colon == word.npos && sample.name.empty()) sample.name = word;
    if (key == "isa") sample.isa = value;
    if (key == "precision") sample.precision = value;
    if (key == "threads") sample.threads = std::stoi(value);
    if (key == "size") sample.size = std::stoi(value);
  }
  return sample;
}

std::string key_of(const KernelSample& s) {
  return fmt::format("{}/{}/{}/{}/{}", s.name, s.isa, s.precision, s.threads, s.size);
}

void add(KernelRound& round, const KernelSample& sample) {
  round[key_of(sample)] = sample;
}

KernelSample peer(const char* name, int size, double springs, double cost) {
  KernelSample sample;
  sample.name = name;
  sample.isa = "as packaged";
  sample.precision = "float64";
  sample.size = size;
  sample.masses = std::pow(size, 3);
  sample.springs = springs;
  sample.cost = sample.wall_cost = cost;
  return sample;
}

/// Programs beside this one, and the peers.
class Programs {
 public:
  Programs(const BenchPlan& plan, const fs::path& folder, KernelRounds& rounds)
      : plan_(plan), folder_(folder), rounds_(rounds) {
    prepare_lammps();
    bullet_ = executable_folder() / "fingertip-bullet";
    if (!plan.bullet) rounds_.missing["bullet"] = "left out";
    if (plan.bullet && ::access(bullet_.c_str(), X_OK) != 0)
      rounds_.missing["bullet"] = "fingertip-bullet is not built (package libbullet-dev)";
  }

  void kernels(int number, KernelRound& round) {
    const fs::path program = executable_folder() / "fingertip-kernels";
    if (::access(program.c_str(), X_OK) != 0) {
      rounds_.missing["kernels"] = "fingertip-kernels is not built (package libbenchmark-dev)";
      return;
    }
    const fs::path out = folder_ / fmt::format("kernels_{}.json", number + 1);
    std::vector<std::string> words = {program.string(),
                                      "--threads",
                                      std::to_string(plan_.threads),
                                      "--seconds",
                                      std::to_string(plan_.seconds),
                                      "--benchmark_out_format=json",
                                      "--benchmark_out=" + out.string()};
    if (plan_.widest > 0) words.insert(words.end(), {"--widest", std::to_string(plan_.widest)});
    words.push_back(number < plan_.wide_rounds
                        ? "--benchmark_filter=-part plain|part scaled 10?e"  // the slowest alone
                        : "--benchmark_filter=arithmetic|bandwidth|_step|part scaled 30e");
    const fs::path log = folder_ / "kernels.log";
    if (const int code = run_process({words, {}}, log, interrupted); code != 0)
      throw std::runtime_error(
          fmt::format("fingertip-kernels ended with {}; see {}", code, log.string()));
    round.merge(read_kernel_round(out));
  }

  void lammps(KernelRound& round) {
    if (rounds_.missing.contains("lammps")) return;
    try {
      for (const auto& [size, springs] : lammps_springs_)
        for (int ranks = 1; ranks <= plan_.threads; ranks *= 2) {
          const LammpsTiming timing = run_lammps(lammps_folder(size), ranks, plan_.lammps);
          rounds_.versions["lammps"] = timing.version;
          KernelSample sample =
              peer("lammps_harmonic", size, double(springs), timing.ns_per_spring_step(springs));
          sample.threads = ranks;
          if (ranks == 1) sample.cost *= timing.processor_share;
          add(round, sample);
        }
    } catch (const std::exception& error) {
      rounds_.missing["lammps"] = error.what();
    }
  }

  void bullet(KernelRound& round) {
    if (rounds_.missing.contains("bullet")) return;
    const fs::path log = folder_ / "bullet.json";
    const int code =
        run_process({{bullet_.string(), "20", plan_.quick ? "20" : "100"}, {}}, log, interrupted);
    if (code != 0) {
      rounds_.missing["bullet"] = fmt::format("fingertip-bullet ended with {}", code);
      return;
    }
    const ordered_json found = parse_json(log);
    const double springs = found.at("springs");
    add(round, peer("bullet_soft_body", 20, springs,
                    1e9 * found.at("seconds").get<double>() /
                        (springs * found.at("steps").get<double>())));
  }

 private:
  void prepare_lammps() {
    if (plan_.lammps.empty() || program_on_path(plan_.lammps).empty()) {
      rounds_.missing["lammps"] =
          plan_.lammps.empty() ? "left out" : plan_.lammps + " is not on the PATH (package lammps)";
      return;
    }
    for (const int size : plan_.sizes)
      lammps_springs_[size] = write_lammps_cube(lammps_folder(size), size, size > 30 ? 40 : 400);
  }

  fs::path lammps_folder(int size) const {
    return fs::absolute(folder_) / fmt::format("lammps_{}", size);
  }

  const BenchPlan& plan_;
  fs::path folder_;
  KernelRounds& rounds_;
  std::map<int, std::size_t> lammps_springs_;  ///< of the cubes LAMMPS marches, by their size
  fs::path bullet_;
};

}  // namespace

KernelRound read_kernel_round(const fs::path& file) {
  KernelRound round;
  const ordered_json all = parse_json(file);
  try {
    for (const ordered_json& entry : all.at("benchmarks")) {
      KernelSample sample = sample_named(entry.at("name").get<std::string>());
      const auto number = [&](const char* key) { return entry.value(key, 0.0); };
      sample.masses = number("masses");
      sample.springs = number("springs");
      sample.operations = number("operations");
      sample.cache = number("cache");
      sample.bytes = number("bytes");
      const double amount =
          entry.contains("amount") ? number("amount") : sample.springs * number("steps");
      sample.wall_cost = number("real_time") / amount;
      sample.cost = sample.threads == 1 ? number("cpu_time") / amount : sample.wall_cost;
      if (entry.contains("rate")) sample.cost = sample.wall_cost = 1e9 / number("rate");
      add(round, sample);
    }
  } catch (const nlohmann::json::exception& error) {
    throw meshes::InvalidInput({file.string(), "", error.what(), "run the benchmark again"});
  }
  return round;
}

double median(std::vector<double> values) {
  if (values.empty()) return meshes::unknown;
  std::ranges::sort(values);
  const std::size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

KernelRounds measure_kernels(const BenchPlan& plan, const fs::path& folder,
                             const JobContext& context) {
  KernelRounds result;
  Programs programs(plan, folder, result);
  for (int number = 0; number < plan.rounds; ++number) {
    if (!context.report(double(number) / plan.rounds, fmt::format("round {}", number + 1)))
      throw meshes::Interrupted("stopped by the user");
    KernelRound round;
    programs.kernels(number, round);
    programs.lammps(round);
    if (number < plan.wide_rounds) programs.bullet(round);
    result.rounds.push_back(std::move(round));
  }
  return result;
}

}  // namespace fingertip::studies::inline bench
