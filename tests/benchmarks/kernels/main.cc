// fingertip-kernels: the functions that `fingertip bench` measures, each by itself, once. The verb
// calls it several times in turn with its peers and takes medians of ratios. Prints what Google
// Benchmark prints; its options (--benchmark_out=FILE ...) hold.
//
//   fingertip-kernels [--widest 2|4|8] [--threads N] [--per-radius N] [--seconds S]
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <string>

#include "arithmetic_rate.h"
#include "benchmarks.h"
#include "lattice/kernels/by_width.h"
#include "lattice/kernels/kernel.h"
#include "probes.h"

namespace kernel_benchmarks {

const char* isa_name(int width) {
  return width == 8 ? "avx512" : width == 4 ? "avx2" : "sse2";
}

std::string full_name(const std::string& name, int width, const std::string& precision, int threads,
                      int size) {
  return name + "/isa:" + isa_name(width) + "/precision:" + precision +
         "/threads:" + std::to_string(threads) + "/size:" + std::to_string(size);
}

void register_probes(const Scope& scope) {
  for (int width = 2; width <= scope.widest; width *= 2)
    benchmark::RegisterBenchmark(full_name("arithmetic", width, "float64", 1, 0).c_str(),
                                 [width](benchmark::State& state) {
                                   double best = 0.0;
                                   for (auto _ : state)
                                     best = std::max(best, kernel_probes::arithmetic_rate(width));
                                   state.counters["rate"] = best;
                                 })
        ->MinTime(scope.seconds)
        ->UseRealTime();
  const auto bandwidth = [&](const std::string& name, std::size_t bytes, std::size_t cache) {
    benchmark::RegisterBenchmark(full_name(name, 2, "float64", 1, 0).c_str(),
                                 [bytes, cache](benchmark::State& state) {
                                   const std::size_t count = bytes / 2 / sizeof(double);
                                   const auto from = std::make_unique<double[]>(count),
                                              to = std::make_unique<double[]>(count);
                                   for (auto _ : state) {
                                     kernel_probes::stream(from.get(), to.get(), count, 1.0);
                                     benchmark::ClobberMemory();
                                   }
                                   state.counters["amount"] = double(bytes);
                                   state.counters["cache"] = double(cache);
                                 })
        ->MinTime(scope.seconds)
        ->UseRealTime();
  };
  const std::size_t second = kernel_probes::cache_bytes(2, 1 << 20);
  const std::size_t third = kernel_probes::cache_bytes(3, 16 << 20);
  bandwidth("bandwidth_L2", second / 2, second);
  bandwidth("bandwidth_DRAM", 4 * third, third);
}

}  // namespace kernel_benchmarks

namespace {

/// The value of `--name value` among the words, which then lack both; `otherwise` without it.
std::string option(int& argc, char** argv, const char* name, const std::string& otherwise) {
  for (int i = 1; i + 1 < argc; ++i) {
    if (std::strcmp(argv[i], name) != 0) continue;
    const std::string value = argv[i + 1];
    for (int j = i; j + 2 <= argc; ++j) argv[j] = argv[j + 2];
    argc -= 2;
    return value;
  }
  return otherwise;
}

}  // namespace

int main(int argc, char** argv) {
  const int able = fingertip::lattice::kernel::supported_width();
  kernel_benchmarks::Scope scope;
  scope.widest = std::stoi(option(argc, argv, "--widest", std::to_string(able)));
  scope.threads = std::stoi(option(argc, argv, "--threads", "1"));
  scope.per_radius = std::stoi(option(argc, argv, "--per-radius", "12"));
  scope.seconds = std::stod(option(argc, argv, "--seconds", "0.1"));
  benchmark::Initialize(&argc, argv);
  if (scope.widest > able || benchmark::ReportUnrecognizedArguments(argc, argv)) {
    std::fprintf(stderr, "fingertip-kernels: this processor has registers of %d doubles\n", able);
    return 2;
  }
  kernel_benchmarks::register_probes(scope);
  kernel_benchmarks::register_parts(scope);
  kernel_benchmarks::register_tips(scope);
  benchmark::RunSpecifiedBenchmarks();
}
