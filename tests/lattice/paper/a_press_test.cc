/// The example program of lattice/paper.
#include <gtest/gtest.h>

#include <cstdio>
#include <fstream>
#include <sstream>
#include <string>

TEST(APress, PrintsWhatItsReadmeShows) {
  std::FILE* program = ::popen(A_PRESS, "r");
  ASSERT_NE(program, nullptr);
  std::string printed;
  char part[256];
  while (std::fgets(part, sizeof part, program) != nullptr) printed += part;
  ASSERT_EQ(::pclose(program), 0);
  std::ostringstream readme;
  readme << std::ifstream(ITS_README).rdbuf();
  EXPECT_GT(printed.size(), 100u);
  EXPECT_NE(readme.str().find("```\n" + printed + "```\n"), std::string::npos) << printed;
}
