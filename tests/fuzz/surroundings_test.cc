// Hostile surroundings: many processes at once, full disks, missing rights, closed and broken
// output, odd names, other locales, a cache that was tampered with.

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <memory>

#include "attacks.h"
#include "tests/temporary_folder.h"

using namespace attacks;
namespace fs = std::filesystem;

namespace {

/// The press without any disturbance.
const std::map<std::string, std::string>& undisturbed() {
  static const std::map<std::string, std::string> results = [] {
    const TemporaryFolder folder;
    const ProgramResult result = run_program(folder.path(), static_press({"--out", "run"}));
    EXPECT_EQ(result.code, 0) << result.err;
    return results_in(folder / "run");
  }();
  return results;
}

std::vector<int> codes_of_ten(const fs::path& folder, const std::vector<std::string>& words,
                              bool own_folders) {
  std::vector<std::unique_ptr<Program>> programs;
  for (int i = 0; i < 10; ++i) {
    std::vector<std::string> own = words;
    own.insert(own.end(), {"--out", own_folders ? "run" + std::to_string(i) : "run"});
    programs.push_back(std::make_unique<Program>(folder, own));
  }
  std::vector<int> codes;
  for (const auto& program : programs) codes.push_back(program->wait().code);
  return codes;
}

/// Flips one bit in the middle of every file below `folder`.
void flip_a_bit_of_every_file(const fs::path& folder) {
  for (const auto& item : fs::recursive_directory_iterator(folder)) {
    if (!item.is_regular_file()) continue;
    std::string content = read_text(item.path());
    if (content.empty()) continue;
    content[content.size() / 2] ^= 1;
    write_text(item.path(), content);
  }
}

}  // namespace

TEST(Surroundings, OfTenProcessesInOneFolderOneWorks) {
  for (const bool resume : {false, true}) {
    const TemporaryFolder folder;
    const std::vector<int> codes =
        codes_of_ten(folder.path(),
                     static_press(resume ? std::vector<std::string>{"--resume", "auto"}
                                         : std::vector<std::string>{}),
                     false);
    const auto winners = std::ranges::count(codes, 0), refused = std::ranges::count(codes, 2);
    EXPECT_EQ(winners + refused, 10);
    // A folder that is finished may be resumed again.
    EXPECT_TRUE(winners == 1 || (resume && winners > 1)) << winners;
    EXPECT_EQ(results_in(folder / "run"), undisturbed());
    EXPECT_EQ(leftovers(folder.path()), std::vector<std::string>());
  }
}

TEST(Surroundings, TenProcessesShareACache) {
  const TemporaryFolder folder;
  const std::vector<int> codes = codes_of_ten(folder.path(), static_press(), true);
  EXPECT_EQ(std::ranges::count(codes, 0), 10);
  for (int i = 0; i < 10; ++i)
    EXPECT_EQ(results_in(folder / ("run" + std::to_string(i))), undisturbed()) << i;
  EXPECT_EQ(leftovers(folder.path()), std::vector<std::string>());
  const ProgramResult later = run_program(folder.path(), static_press({"--out", "later"}));
  EXPECT_NE(later.out.find("earlier run"), std::string::npos) << "the cache was left damaged";
}

TEST(Surroundings, ATamperedCacheIsNotServed) {
  const TemporaryFolder folder;
  ASSERT_EQ(run_program(folder.path(), static_press({"--out", "one"})).code, 0);
  flip_a_bit_of_every_file(folder / "cache");
  const ProgramResult second = run_program(folder.path(), static_press({"--out", "two"}));
  EXPECT_EQ(second.code, 0) << second.err;
  EXPECT_EQ(second.out.find("earlier run"), std::string::npos);
  EXPECT_EQ(results_in(folder / "two"), undisturbed());
  const ProgramResult third = run_program(folder.path(), static_press({"--out", "three"}));
  EXPECT_NE(third.out.find("earlier run"), std::string::npos) << "the entry was not replaced";
}

// No file may grow beyond some kB: it strikes at another file each time.
TEST(Surroundings, AFullDiskIsToldAndTheRunGoesOn) {
  for (const char* limit : {"0", "1", "2", "4", "8", "16", "32"}) {
    const TemporaryFolder folder;
    const std::string press = quoted(static_press({"--out", "run"}));
    // Standard output is no file here.
    const ProgramResult full =
        shell(folder.path(), "(ulimit -f " + std::string(limit) + "; " + press +
                                 ") 2>&1 | cat; exit ${PIPESTATUS[0]}");
    EXPECT_TRUE(told(full.code)) << limit << " kB: " << full.code;
    if (full.code != 0) {
      EXPECT_NE(full.out.find("cannot"), std::string::npos) << limit << ": " << full.out;
    }
    const ProgramResult again =
        run_program(folder.path(), static_press({"--out", "run", "--resume", "auto"}));
    EXPECT_EQ(again.code, 0) << limit << ": " << again.err;
    EXPECT_EQ(results_in(folder / "run"), undisturbed()) << limit;
    EXPECT_EQ(leftovers(folder.path()), std::vector<std::string>()) << limit;
  }
}

TEST(Surroundings, AFolderThatMayNotBeWrittenIsRefused) {
  const TemporaryFolder folder;
  fs::create_directory(folder / "locked");
  fs::permissions(folder / "locked", fs::perms::owner_read | fs::perms::owner_exec |
                                         fs::perms::others_read | fs::perms::others_exec);
  std::string drop;
  if (::geteuid() == 0) {
    if (std::system("setpriv --reuid 65534 --regid 65534 --clear-groups true 2> /dev/null") != 0)
      GTEST_SKIP() << "root may write everywhere, and setpriv cannot make it another user";
    drop = "setpriv --reuid 65534 --regid 65534 --clear-groups ";
    fs::permissions(folder.path(), fs::perms::others_read | fs::perms::others_exec,
                    fs::perm_options::add);
  }
  std::string press = quoted(static_press({"--out", "locked/run"}));
  press.replace(0, std::string("fingertip").size(), drop + "'" FINGERTIP_PROGRAM "'");
  const ProgramResult result = shell(folder.path(), press);
  if (result.code == 126 || result.code == 127) GTEST_SKIP() << "not to be started by others";
  EXPECT_EQ(result.code, 2) << result.err;
  EXPECT_NE(result.err.find("cannot be written"), std::string::npos) << result.err;
  EXPECT_TRUE(fs::is_empty(folder / "locked"));
}

TEST(Surroundings, WithoutHomeAndCacheFolders) {
  int number = 0;
  for (const char* surroundings :
       {"env -i TMPDIR=.", "env -i HOME=/nowhere TMPDIR=.", "env -i TMPDIR=/nowhere",
        "env -i XDG_CACHE_HOME=/proc/nowhere"}) {
    const TemporaryFolder folder;
    std::string press = quoted(static_press({"--out", "run" + std::to_string(number++)}));
    press.replace(0, std::string("fingertip").size(),
                  std::string(surroundings) + " '" FINGERTIP_PROGRAM "'");
    const ProgramResult result = shell(folder.path(), press);
    EXPECT_EQ(result.code, 0) << surroundings << ": " << result.err;
  }
}

TEST(Surroundings, ClosedAndBrokenOutputChangesNothing) {
  for (const char* where : {"%s >&-", "%s >&- 2>&-", "%s <&- >&- 2>&-", "%s | true",
                            "%s 2>&1 | true", "%s --progress json 2>&1 | head -c 1"}) {
    const TemporaryFolder folder;
    std::string script = where;
    script.replace(script.find("%s"), 2, quoted(static_press({"--out", "run"})));
    const ProgramResult result = shell(folder.path(), script + "\nexit ${PIPESTATUS[0]}");
    EXPECT_EQ(result.code, 0) << where << ": " << result.err;
    EXPECT_EQ(results_in(folder / "run"), undisturbed()) << where;
    EXPECT_NE(read_text(folder / "run/manifest.json").find("\"finished\""), std::string::npos);
    EXPECT_EQ(read_text(folder / "run/log.txt").find("run folder:"), std::string::npos)
        << "what was for the screen went into a file";
  }
}

TEST(Surroundings, OutputThatIsLostIsTold) {
  for (const char* words : {"init", "explain", "explain --schema", "explain lattice.model"}) {
    const TemporaryFolder folder;
    const ProgramResult result =
        shell(folder.path(), "fingertip " + std::string(words) + " > /dev/full");
    EXPECT_EQ(result.code, 3) << words;
    EXPECT_NE(result.err.find("standard output could not be written"), std::string::npos) << words;
  }
  const TemporaryFolder folder;
  const ProgramResult result =
      shell(folder.path(), quoted(static_press({"--out", "run"})) + " > /dev/full");
  EXPECT_EQ(result.code, 3) << result.err;
  EXPECT_EQ(results_in(folder / "run"), undisturbed());
}

TEST(Surroundings, OddNamesAreNamesAndNothingElse) {
  const TemporaryFolder folder;
  const std::vector<std::string> names = {"a b",
                                          " leading",
                                          "it's",
                                          "\"quoted\"",
                                          "$(touch pwned)",
                                          "`touch pwned`",
                                          "a;touch pwned",
                                          "line\nbreak",
                                          "\xc3\xbc\xe2\x9b\x84",
                                          "\xff\xfe",
                                          "esc\x1b[31m",
                                          "%s%n",
                                          "*",
                                          "a&b|c",
                                          "<script>alert(1)</script>",
                                          "a_{b}^c@d 'e' \"f\" \\n",
                                          "./-rf"};
  std::vector<std::string> compared = {"compare", "--out", "compared"};
  for (const std::string& name : names) {
    // A slash ends the name.
    std::string safe = name;
    if (name != "./-rf") std::ranges::replace(safe, '/', '|');
    const ProgramResult result = run_program(folder.path(), static_press({"--out", safe}));
    ASSERT_EQ(result.code, 0) << safe << ": " << result.err;
    EXPECT_EQ(results_in(folder / safe), undisturbed()) << safe;
    EXPECT_TRUE(told(run_program(folder.path(), {"report", safe}).code)) << safe;
    const ProgramResult checked =
        run_program(folder.path(), {"check", (fs::path(safe) / "parameters.toml").string()});
    EXPECT_EQ(checked.code, 0) << safe << ": " << checked.err;
    compared.push_back(safe);
  }
  const ProgramResult result = run_program(folder.path(), compared);
  EXPECT_EQ(result.code, 0) << result.err;
  const std::string page = read_text(folder / "compared/comparison.html");
  EXPECT_NE(page.find("a_{b}^c@d"), std::string::npos) << "gnuplot must not read names as markup";
  EXPECT_EQ(page.find("<script>alert"), std::string::npos);
  EXPECT_FALSE(fs::exists(folder / "pwned"));
  for (const char* dashed : {"-rf", "--force", "--"}) {
    const ProgramResult run = run_program(folder.path(), static_press({"--out", dashed}));
    EXPECT_TRUE(told(run.code)) << dashed << ": " << run.err;
  }
}

TEST(Surroundings, MessagesDoNotSteerTheTerminal) {
  const TemporaryFolder folder;
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"press", "--set", "press.depth=\x1b[2J\x07 cm"},
        std::vector<std::string>{"press", "--config", "\x1b]0;title\x07"},
        std::vector<std::string>{"report", "\x1b[31mred"},
        std::vector<std::string>{"press", "--set", "press.depth=" + std::string(100'000, '9')}}) {
    const ProgramResult result = run_program(folder.path(), words);
    EXPECT_EQ(result.code, 2) << result.err.substr(0, 300);
    EXPECT_EQ(result.err.find('\x1b'), std::string::npos) << result.err;
    EXPECT_LT(result.err.size(), 10'000U);
  }
}

TEST(Surroundings, DecimalCommas) {
  const TemporaryFolder folder;
  const ProgramResult made =
      shell(folder.path(), "mkdir locale && localedef -i de_DE -f UTF-8 locale/de_DE.UTF-8");
  if (!fs::exists(folder / "locale/de_DE.UTF-8/LC_NUMERIC"))
    GTEST_SKIP() << "localedef has no sources of de_DE here: " << made.err;
  const std::string german = "export LOCPATH=$PWD/locale\nexport LC_ALL=de_DE.UTF-8\n";
  const ProgramResult comma = shell(folder.path(), german + "/usr/bin/printf '%.1f' 0,5");
  ASSERT_EQ(comma.out, "0,5") << "the locale is not in effect";
  const ProgramResult result =
      shell(folder.path(), german + quoted(static_press({"--out", "run"})) + " && " +
                               quoted({"compare", "run", "run", "--out", "compared"}));
  EXPECT_EQ(result.code, 0) << result.err;
  EXPECT_EQ(results_in(folder / "run"), undisturbed());
  const ProgramResult plain = run_program(folder.path(), {"compare", "run", "run", "--out", "c"});
  EXPECT_EQ(plain.code, 0);
  EXPECT_EQ(read_text(folder / "compared/comparison.html"),
            read_text(folder / "c/comparison.html"));
}
