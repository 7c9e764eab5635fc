#include "studies/bench/ratios.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>

#include "meshes/press_response.h"
#include "studies/run/json_file.h"

namespace fingertip::studies {

namespace {

using nlohmann::ordered_json;

constexpr const char* isas[] = {"sse2", "avx2", "avx512"};

double cost_in(const KernelRound& round, const std::string& key, bool wall = false) {
  const auto found = round.find(key);
  if (found == round.end()) return meshes::unknown;
  return wall ? found->second.wall_cost : found->second.cost;
}

std::vector<double> costs(const KernelRounds& rounds, const std::string& key) {
  std::vector<double> all;
  for (const KernelRound& round : rounds.rounds)
    if (const double cost = cost_in(round, key); std::isfinite(cost)) all.push_back(cost);
  return all;
}

std::string probe_key(const std::string& name, const std::string& isa) {
  return name + "/" + isa + "/float64/1/0";
}

std::string springs_key(int threads, int size) {
  return fmt::format("springs/avx512/float64/{}/{}", threads, size);
}

std::string edge_list_key(int size) {
  return fmt::format("edge_list/sse2/float64/1/{}", size);
}

std::string lammps_key(int ranks, int size) {
  return fmt::format("lammps_harmonic/as packaged/float64/{}/{}", ranks, size);
}

bool is_probe(const KernelSample& s) {
  return s.size == 0;
}
bool is_peer(const KernelSample& s) {
  return s.isa == "as packaged";
}

/// The roof over a kernel: of the spring engine the operations in multiply pipes are counted, of
/// the others all, unfused.
std::string roof_key(const KernelSample& s) {
  return probe_key(s.name == "springs" ? "multiply-add" : "arithmetic", s.isa);
}

constexpr const char* above_the_roof =
    "came out above 1, which no processor does: the probe was disturbed; run again";

/// Operations times `roof`, the time of one of them at best, over the time taken.
double roofline_fraction(const KernelSample& s, double cost, double roof) {
  if (!(s.operations > 0.0)) return meshes::unknown;
  const double lanes = s.precision == "float32" ? 0.5 : 1.0;
  return s.operations * roof * lanes / (cost * s.threads);
}

/// A fraction that can be true, else unknown.
double believable(double fraction) {
  return fraction <= 1.0 ? fraction : meshes::unknown;
}

/// Bytes; null where the probe did not run.
ordered_json cache_in(const KernelRounds& rounds, const std::string& probe) {
  for (const KernelRound& round : rounds.rounds)
    if (const auto found = round.find(probe_key(probe, "sse2")); found != round.end())
      return found->second.cache;
  return {};
}

}  // namespace

ordered_json probes_of(const KernelRounds& rounds) {
  const auto rate = [&](const std::string& key) {
    return number_or_null(1e9 / median(costs(rounds, key)));
  };
  ordered_json result = {{"multiply_adds_per_second", ordered_json::object()}};
  for (const char* isa : isas)
    result["multiply_adds_per_second"][isa] = rate(probe_key("multiply-add", isa));
  result["operations_per_second"] = ordered_json::object();
  for (const char* isa : isas)
    result["operations_per_second"][isa] = rate(probe_key("arithmetic", isa));
  result["bandwidth_L2"] = rate(probe_key("bandwidth_L2", "sse2"));
  result["bandwidth_DRAM"] = rate(probe_key("bandwidth_DRAM", "sse2"));
  result["cache_L2"] = cache_in(rounds, "bandwidth_L2");
  result["cache_L3"] = cache_in(rounds, "bandwidth_DRAM");
  return result;
}

ordered_json kernels_of(const KernelRounds& rounds, bool peers) {
  ordered_json list = ordered_json::array();
  std::set<std::string> done;
  for (const KernelRound& any : rounds.rounds) {
    for (const auto& [key, s] : any) {
      if (is_probe(s) || is_peer(s) != peers || !done.insert(key).second) continue;
      const std::vector<double> all = costs(rounds, key);
      const double cost = median(all);
      const double fraction = roofline_fraction(s, cost, median(costs(rounds, roof_key(s))));
      list.push_back({{"name", s.name},
                      {"isa", s.isa},
                      {"precision", s.precision},
                      {"threads", s.threads},
                      {"masses", s.masses},
                      {"ns_per_spring_step", cost},
                      {"springs", s.springs},
                      {"operations_per_spring",
                       s.operations > 0.0 ? ordered_json(s.operations) : ordered_json()},
                      {"roofline_fraction", number_or_null(believable(fraction))},
                      {"rounds", all}});
      if (fraction > 1.0) list.back()["remark"] = std::string("roofline ") + above_the_roof;
    }
  }
  return list;
}

Ratios ratios_of(const KernelRounds& rounds) {
  Ratios result{ordered_json::object(), ordered_json::object(), ordered_json::object()};
  const auto why = [&](const std::string& name) -> std::string {
    if (rounds.missing.contains("kernels")) return rounds.missing.at("kernels");
    const bool measured = !costs(rounds, probe_key("multiply-add", "avx512")).empty();
    const bool of_peers = name.starts_with("edge_list_over");
    if (!measured && !of_peers)
      return "needs AVX-512, which this processor lacks or the run left out";
    if (name.find("lammps") != name.npos && rounds.missing.contains("lammps"))
      return rounds.missing.at("lammps");
    if (name.starts_with("roofline") &&
        !costs(rounds, springs_key(1, name.find("48") != name.npos ? 48 : 20)).empty())
      return above_the_roof;
    return "not measured with these sizes and threads";
  };
  const auto add = [&](const std::string& name,
                       const std::function<double(const KernelRound&)>& f) {
    std::vector<double> all;
    for (const KernelRound& round : rounds.rounds)
      if (const double value = f(round); std::isfinite(value)) all.push_back(value);
    result.values[name] = number_or_null(median(all));
    result.rounds[name] = all;
    if (all.empty()) result.missing[name] = why(name);
  };
  const auto over = [](const std::string& numerator, const std::string& denominator) {
    return [=](const KernelRound& r) { return cost_in(r, numerator) / cost_in(r, denominator); };
  };
  for (const int threads : {1, 2})
    for (const int size : {48, 20})
      add(fmt::format("edge_list_{}_{}t", size, threads),
          over(edge_list_key(size), springs_key(threads, size)));
  for (const int threads : {1, 2})
    for (const int size : {48, 20})
      add(fmt::format("lammps_{}_{}t", size, threads), [=](const KernelRound& r) {
        // Ranks that wait spin. With others on the machine two of them take many times as long as
        // one, which says nothing of LAMMPS.
        const double cost = cost_in(r, lammps_key(threads, size));
        return std::min(cost, cost_in(r, lammps_key(1, size))) /
               cost_in(r, springs_key(threads, size));
      });
  for (const int size : {48, 20})
    add(fmt::format("edge_list_over_lammps_{}", size),
        over(edge_list_key(size), lammps_key(1, size)));
  for (const int size : {48, 20}) {
    add(fmt::format("roofline_{}_1t", size), [size](const KernelRound& r) {
      const auto found = r.find(springs_key(1, size));
      if (found == r.end()) return meshes::unknown;
      return believable(roofline_fraction(found->second, found->second.cost,
                                          cost_in(r, probe_key("multiply-add", "avx512"))));
    });
  }
  for (const int size : {20, 48}) {
    add(fmt::format("threads_{}", size), [size](const KernelRound& r) {
      return cost_in(r, springs_key(1, size), true) / cost_in(r, springs_key(2, size), true);
    });
  }
  return result;
}

}  // namespace fingertip::studies
