// What the program tells man and the shell.

#include <gtest/gtest.h>

#include <cstdlib>
#include <set>
#include <sstream>

#include "studies/config/keys/key_table.h"
#include "tests/studies/program.h"
#include "tests/temporary_folder.h"

using namespace fingertip;

namespace {

/// What bash would offer behind `line`, by the program's completion.
std::string offered(const TemporaryFolder& folder, const std::string& line) {
  const std::string script =
      ". completion.bash\n"
      "compopt() { :; }\n"
      "COMP_LINE='" +
      line +
      "'\n"
      "COMP_POINT=${#COMP_LINE}\n"
      "read -ra COMP_WORDS <<< \"${COMP_LINE//=/ = }\"\n"
      "[[ $COMP_LINE == *' ' ]] && COMP_WORDS+=('')\n"
      "COMP_CWORD=$((${#COMP_WORDS[@]} - 1))\n"
      "_fingertip\n"
      "echo \"${COMPREPLY[*]}\"\n";
  write_text(folder / "try.bash", script);
  const std::string command =
      "cd '" + folder.path().string() + "' && bash try.bash > offered 2> told";
  EXPECT_EQ(std::system(command.c_str()), 0) << read_text(folder / "told");
  EXPECT_EQ(read_text(folder / "told"), "");
  std::string words = read_text(folder / "offered");
  words.erase(words.find_last_not_of('\n') + 1);
  return words;
}

}  // namespace

TEST(ShellTexts, CompletionOffersVerbsOptionsKeysAndWords) {
  const TemporaryFolder folder;
  const ProgramResult told = run_program(folder.path(), {"explain", "--completion"});
  ASSERT_EQ(told.code, 0);
  write_text(folder / "completion.bash", told.out);
  EXPECT_EQ(offered(folder, "fingertip val"), "validate");
  EXPECT_EQ(offered(folder, "fingertip export --form"), "--format");
  EXPECT_EQ(offered(folder, "fingertip export --format s"), "sofa");
  EXPECT_EQ(offered(folder, "fingertip press --set press.cont"), "press.contact=");
  EXPECT_EQ(offered(folder, "fingertip press --set press.contact=st"), "stick");
  EXPECT_EQ(offered(folder, "fingertip press --form"), "");  // no option of that verb
  EXPECT_EQ(offered(folder, "fingertip --config a.toml pre"), "press");
}

TEST(ShellTexts, ManPageNamesEveryVerbAndKeyInWordsThatManKnows) {
  const TemporaryFolder folder;
  const ProgramResult told = run_program(folder.path(), {"explain", "--man"});
  ASSERT_EQ(told.code, 0);
  const std::set<std::string> known = {".TH", ".SH", ".SS", ".TP", ".B", ".BI", ".BR", ".I", ".RI"};
  std::istringstream lines(told.out);
  for (std::string line; std::getline(lines, line);) {
    if (line.empty() || (line.front() != '.' && line.front() != '\'')) continue;
    EXPECT_TRUE(known.contains(line.substr(0, line.find(' ')))) << line;
  }
  for (const studies::Key& key : studies::key_table())
    EXPECT_NE(told.out.find(".B " + key.full_name() + "\n"), std::string::npos) << key.full_name();
  for (const char* verb : {"validate", "press", "export", "doctor"})
    EXPECT_NE(told.out.find(std::string(".SS ") + verb), std::string::npos) << verb;
}
