#include "studies/bench/ratios.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>
#include <sstream>

#include "meshes/press/press_response.h"
#include "meshes/tables/fields_json.h"

namespace fingertip::studies::inline bench {

namespace {

using nlohmann::ordered_json;

constexpr const char* isas[] = {"sse2", "avx2", "avx512"};

double cost_in(const KernelRound& round, const std::string& key) {
  const auto found = round.find(key);
  return found == round.end() ? meshes::unknown : found->second.cost;
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

std::string lammps_key(int ranks, int size) {
  return fmt::format("lammps_harmonic/as packaged/float64/{}/{}", ranks, size);
}

bool is_probe(const KernelSample& s) {
  return s.size == 0;
}
bool is_peer(const KernelSample& s) {
  return s.isa == "as packaged";
}
/// "part scaled|plain DEPTH PART"
bool is_part(const KernelSample& s) {
  return s.name.starts_with("part ");
}

/// The roof over a kernel.
std::string roof_key(const KernelSample& s) {
  return probe_key("arithmetic", s.isa);
}

/// A time step of a model, with the widest registers that there are; none: null.
const KernelSample* step_of(const KernelRound& round, const std::string& model, int threads) {
  for (const auto& [key, s] : round)
    if (s.name == model + "_step" && s.threads == threads) return &s;
  return nullptr;
}

constexpr const char* own_roof =
    "the ceiling is what this kernel reached in some round: the probe was slower there, disturbed "
    "by others";

/// Time per operation and thread, as long as one in double precision; unknown where operations are
/// not counted.
double operation_time(const KernelSample& s) {
  const double lanes = s.precision == "float32" ? 0.5 : 1.0;
  return s.operations > 0.0 ? s.cost * s.threads / (s.operations * lanes) : meshes::unknown;
}

/// The best that the probe or any kernel under its roof reached in a round: a fraction of it is at
/// most 1, whatever disturbed the probe.
double ceiling(const KernelRound& round, const std::string& roof) {
  double best = cost_in(round, roof);
  if (!std::isfinite(best)) return best;
  for (const auto& [key, s] : round)
    if (!is_probe(s) && roof_key(s) == roof) best = std::fmin(best, operation_time(s));
  return best;
}

/// Of a kernel in a round; unknown where there is none, or no probe.
double roofline_fraction(const KernelRound& round, const std::string& key) {
  const auto found = round.find(key);
  if (found == round.end()) return meshes::unknown;
  return ceiling(round, roof_key(found->second)) / operation_time(found->second);
}

std::vector<double> roofline_fractions(const KernelRounds& rounds, const std::string& key) {
  std::vector<double> all;
  for (const KernelRound& round : rounds.rounds)
    if (const double part = roofline_fraction(round, key); std::isfinite(part)) all.push_back(part);
  return all;
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
    return meshes::json_of(1e9 / median(costs(rounds, key)));
  };
  ordered_json result = {{"operations_per_second", ordered_json::object()}};
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
      if (is_probe(s) || is_part(s) || is_peer(s) != peers || !done.insert(key).second) continue;
      const std::vector<double> all = costs(rounds, key);
      const double cost = median(all);
      const std::vector<double> fractions = roofline_fractions(rounds, key);
      list.push_back({{"name", s.name},
                      {"isa", s.isa},
                      {"precision", s.precision},
                      {"threads", s.threads},
                      {"masses", s.masses},
                      {"ns_per_spring_step", cost},
                      {"springs", s.springs},
                      {"operations_per_spring",
                       s.operations > 0.0 ? ordered_json(s.operations) : ordered_json()},
                      {"roofline_fraction", meshes::json_of(median(fractions))},
                      {"rounds", all}});
      if (std::ranges::find(fractions, 1.0) != fractions.end())
        list.back()["remark"] = std::string("roofline: ") + own_roof;
    }
  }
  return list;
}

ordered_json parts_of(const KernelRounds& rounds) {
  std::vector<ordered_json> list;
  std::set<std::string> done;
  for (const KernelRound& any : rounds.rounds)
    for (const auto& [key, s] : any) {
      if (!is_part(s) || !done.insert(key).second) continue;
      std::istringstream words(s.name);
      std::string part, masses, unit;
      double depth = meshes::unknown;
      words >> part >> masses >> depth >> unit >> std::ws;
      std::getline(words, part);
      list.push_back({{"part", part},
                      {"scaled_masses", masses == "scaled"},
                      {"spacing_over_R", 1.0 / s.size},
                      {"indentation", depth},
                      {"seconds", 1e-9 * median(costs(rounds, key))},
                      {"bytes", s.bytes > 0.0 ? ordered_json(s.bytes) : ordered_json()}});
    }
  std::ranges::stable_sort(list, std::greater(),
                           [](const ordered_json& p) { return p.at("seconds").get<double>(); });
  return list;
}

Ratios ratios_of(const KernelRounds& rounds) {
  Ratios result{ordered_json::object(), ordered_json::object(), ordered_json::object()};
  const auto why = [&](const std::string& name) -> std::string {
    if (rounds.missing.contains("kernels")) return rounds.missing.at("kernels");
    const bool measured = std::ranges::any_of(rounds.rounds, [](const KernelRound& round) {
      return step_of(round, "published", 1) != nullptr;
    });
    if (!measured) return "steps take the widest registers, which the run left out";
    if (name.find("lammps") != name.npos && rounds.missing.contains("lammps"))
      return rounds.missing.at("lammps");
    return "not measured with these sizes and threads";
  };
  const auto add = [&](const std::string& name,
                       const std::function<double(const KernelRound&)>& f) {
    std::vector<double> all;
    for (const KernelRound& round : rounds.rounds)
      if (const double value = f(round); std::isfinite(value)) all.push_back(value);
    result.values[name] = meshes::json_of(median(all));
    result.rounds[name] = all;
    if (all.empty()) result.missing[name] = why(name);
  };
  for (const int threads : {1, 2})
    for (const int size : {48, 20})
      add(fmt::format("lammps_{}_{}t", size, threads), [=](const KernelRound& r) {
        const KernelSample* own = step_of(r, "published", threads);
        // Ranks that wait spin. With others on the machine two of them take many times as long as
        // one, which says nothing of LAMMPS.
        const double cost =
            std::min(cost_in(r, lammps_key(threads, size)), cost_in(r, lammps_key(1, size)));
        return own ? cost / own->cost : meshes::unknown;
      });
  for (const char* model : {"published", "network"})
    add(fmt::format("threads_{}", model), [=](const KernelRound& r) {
      const KernelSample *one = step_of(r, model, 1), *two = step_of(r, model, 2);
      return one && two ? one->wall_cost / two->wall_cost : meshes::unknown;
    });
  return result;
}

}  // namespace fingertip::studies::inline bench
