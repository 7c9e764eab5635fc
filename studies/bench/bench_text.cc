#include <fmt/format.h>

#include "studies/bench/bench.h"

namespace fingertip::studies::inline bench {

namespace {

using nlohmann::ordered_json;

std::string cell(const ordered_json& value, const char* form) {
  return value.is_number() ? fmt::format(fmt::runtime(form), value.get<double>()) : "-";
}

/// How much of the tip was computed.
std::string part_of(const ordered_json& press) {
  const int parts = press.at("parts").get<int>();
  return parts == 1 ? "whole" : fmt::format("1/{}", parts);
}

}  // namespace

std::string bench_text(const ordered_json& bench) {
  std::string text;
  for (const auto& [name, value] : bench.at("ratios").items()) {
    const ordered_json why = bench.at("missing_ratios").value(name, ordered_json(""));
    text += fmt::format("{:<20}{:>10}  {}\n", name, cell(value, "{:.3f}"), why.get<std::string>());
  }
  for (const ordered_json& peer : bench.at("peers"))
    text += fmt::format(
        "{:<20}{:>10} ns per spring and step, {:.0f} masses\n", peer.at("name").get<std::string>(),
        cell(peer.at("ns_per_spring_step"), "{:.2f}"), peer.at("masses").get<double>());
  text += fmt::format("{:<12}{:<18}{:<6}{:>6}{:>9}{:>14}{:>14}\n", "model", "integrator", "tip",
                      "R/a", "threads", "real time", "force error");
  for (const ordered_json& press : bench.at("press")) {
    text +=
        fmt::format("{:<12}{:<18}{:<6}{:>6.3g}{:>9}{:>14}{:>12} %\n",
                    press.at("model").get<std::string>(), press.at("integrator").get<std::string>(),
                    part_of(press), 1.0 / press.at("spacing_over_R").get<double>(),
                    press.at("threads").get<int>(), cell(press.at("real_time_factor"), "{:.4f}"),
                    press.at("worst_force_error").is_number()
                        ? fmt::format("{:.2f}", 100.0 * press.at("worst_force_error").get<double>())
                        : "-");
  }
  return text;
}

}  // namespace fingertip::studies::inline bench
