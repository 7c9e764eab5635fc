// The line by which a page says that its run is made again.
#include <gtest/gtest.h>

#include <iterator>
#include <regex>

#include "studies/cli/command_line/command_line.h"
#include "studies/jobs/run_folder.h"
#include "studies/report/report.h"
#include "tests/temporary_folder.h"

using namespace fingertip::studies;
namespace fs = std::filesystem;

namespace {

/// The words of the line on the page of `run`.
std::vector<std::string> reproduce_words(const fs::path& run) {
  report::write_report(run);
  const std::string page = read_text(run / "report.html");
  std::smatch line;
  if (!std::regex_search(page, line, std::regex("and run “([^”]*?)”"))) return {};
  std::istringstream words(line.str(1));
  return {std::istream_iterator<std::string>(words), {}};
}

CommandLine parsed(std::vector<std::string> words) {
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  const auto line = parse_command_line(int(argv.size()), argv.data());
  return std::holds_alternative<CommandLine>(line) ? std::get<CommandLine>(line) : CommandLine{};
}

}  // namespace

TEST(Reproduce, TheLineOfEveryVerbIsTheSameOrder) {
  const TemporaryFolder place;
  const std::vector<std::string> sets = {
      "press.depth=0.2 cm",          "lattice.model=network", "lattice.spacing=tip_radius/7",
      "rubber.youngs_modulus=5 kPa", "run.units=paper",       "calibration.problem=curve"};
  for (const char* verb : {"press", "modes", "grasp", "reference", "calibrate", "validate"}) {
    const LoadedConfig loaded = load_config({{}, sets, {}});
    RunFolderOptions options;
    options.verb = verb;
    options.out = place / verb;
    RunFolder folder(options, loaded);
    write_text(place / verb / "summary.json", "{}");
    folder.finish("finished", 0);
    std::vector<std::string> words = reproduce_words(place / verb);
    ASSERT_EQ(words.size(), 4U) << verb;
    EXPECT_EQ(words[3], "parameters.toml");
    words[3] = (place / verb / words[3]).string();
    const CommandLine line = parsed(words);
    EXPECT_EQ(line.verb, verb);
    const LoadedConfig again = load_config(line.config);
    for (const auto& [key, entry] : loaded.entries)
      EXPECT_EQ(again.entries.at(key).literal, entry.literal) << verb << ": " << key;
  }
}
