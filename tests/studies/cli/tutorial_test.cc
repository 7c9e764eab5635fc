/// The tutorial, word by word: what it shows is what the program prints.
#include <gtest/gtest.h>
#include <wordexp.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iterator>
#include <regex>
#include <sstream>

#include "tests/studies/program.h"
#include "tests/temporary_folder.h"

namespace {

using Tokens = std::vector<std::string>;

/// Between lines of three back quotes, the language with the text.
std::vector<std::string> blocks_of(const std::string& page) {
  std::vector<std::string> blocks;
  std::size_t begin = 0;
  while ((begin = page.find("\n```", begin)) != page.npos) {
    const std::size_t end = page.find("\n```", begin + 4);
    blocks.push_back(page.substr(begin + 4, end - begin - 3));
    begin = end + 4;
  }
  return blocks;
}

struct Step {
  std::string command;  ///< without the program's name
  std::string shown;
};

/// Of "$ ./fingertip ..." with lines that go on, and what follows it.
std::vector<Step> steps_of(const std::string& block) {
  std::vector<Step> steps;
  std::istringstream lines(block);
  const std::string prompt = "$ ./fingertip ";
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with(prompt)) {
      Step& step = steps.emplace_back();
      for (line = line.substr(prompt.size()); line.ends_with('\\');) {
        step.command += line.substr(0, line.size() - 1);
        std::getline(lines, line);
      }
      step.command += line;
    } else if (!steps.empty()) {
      steps.back().shown += line + '\n';
    }
  }
  return steps;
}

Tokens words_of(const std::string& command) {
  wordexp_t words;
  EXPECT_EQ(wordexp(command.c_str(), &words, WRDE_NOCMD), 0) << command;
  Tokens result(words.we_wordv, words.we_wordv + words.we_wordc);
  wordfree(&words);
  return result;
}

Tokens tokens_of(const std::string& text) {
  std::istringstream stream(text);
  return {std::istream_iterator<std::string>(stream), {}};
}

/// Equal, or numbers within a thousandth or a unit of the last digit shown.
bool alike(const std::string& shown, const std::string& printed) {
  if (shown == printed) return true;
  char *shown_end = nullptr, *printed_end = nullptr;
  const double a = std::strtod(shown.c_str(), &shown_end),
               b = std::strtod(printed.c_str(), &printed_end);
  if (shown_end == shown.c_str() || std::string(shown_end) != printed_end) return false;
  const std::size_t point = shown.find('.');
  const double digit = point == shown.npos
                           ? 0.0
                           : std::pow(10.0, -double(shown_end - shown.c_str() - 1) + double(point));
  return std::abs(a - b) <= std::max(1e-3 * std::abs(a), 1.01 * digit);
}

bool contains(const Tokens& printed, const Tokens& run) {
  return std::search(printed.begin(), printed.end(), run.begin(), run.end(),
                     [](const std::string& p, const std::string& s) { return alike(s, p); }) !=
         printed.end();
}

/// Stretches between what the page shortens to "..." and what no two runs share.
std::vector<Tokens> stretches_of(std::string shown) {
  shown = std::regex_replace(shown, std::regex("(computed in|real-time factor)[^\n]*"), "...");
  std::vector<Tokens> stretches(1);
  for (const std::string& token : tokens_of(shown)) {
    if (token.find("...") != token.npos)
      stretches.emplace_back();
    else
      stretches.back().push_back(token);
  }
  std::erase_if(stretches, [](const Tokens& run) { return run.empty(); });
  return stretches;
}

}  // namespace

TEST(Tutorial, ShowsWhatTheProgramPrints) {
  const TemporaryFolder folder;
  int steps = 0;
  for (const std::string& block : blocks_of(read_text(FINGERTIP_TUTORIAL))) {
    if (block.starts_with("toml\n[rubber]")) write_text(folder / "rubber.toml", block.substr(5));
    for (const Step& step : steps_of(block)) {
      const ProgramResult run = run_program(folder.path(), words_of(step.command));
      EXPECT_TRUE(run.code == 0 || step.shown.starts_with("fingertip: error")) << run.err;
      const Tokens printed = tokens_of(run.err + "\n" + run.out);
      for (const Tokens& stretch : stretches_of(step.shown)) {
        std::string text;
        for (const std::string& token : stretch) text += token + ' ';
        EXPECT_TRUE(contains(printed, stretch))
            << "./fingertip " << step.command << "\nshown: " << text << "\nprinted:\n"
            << run.err << run.out;
      }
      ++steps;
    }
  }
  EXPECT_GT(steps, 12);
}
