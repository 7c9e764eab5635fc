#include <fmt/format.h>

#include "studies/bench/bench.h"
#include "studies/report/chapters/bench/bench_page.h"
#include "studies/report/page/terminal.h"

namespace fingertip::studies::inline bench {

namespace {

using nlohmann::ordered_json;

std::string cell(const ordered_json& value, const char* form) {
  return value.is_number() ? fmt::format(fmt::runtime(form), value.get<double>()) : "-";
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
  return text +
         report::tables_text(report::pace_chapter(JsonEntry(bench, "bench.json")), {"presses"});
}

}  // namespace fingertip::studies::inline bench
