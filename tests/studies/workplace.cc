#include "tests/studies/workplace.h"

#include <iterator>
#include <sstream>
#include <thread>

namespace {

Words words_of(const std::string& command) {
  std::istringstream words(command);
  return {std::istream_iterator<std::string>(words), {}};
}

/// Asks until it is so, for a hundred seconds at most.
bool in_time(const auto& condition) {
  for (int i = 0; i < 10000 && !condition(); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  return condition();
}

}  // namespace

Words operator+(Words first, const Words& second) {
  first.insert(first.end(), second.begin(), second.end());
  return first;
}

Program Workplace::start(const std::string& command, const Words& settings) const {
  return Program(path(), with_settings(words_of(command), settings), program_);
}

ProgramResult Workplace::run(const std::string& command, const Words& settings, int code) const {
  SCOPED_TRACE(testing::PrintToString(settings));
  ProgramResult result = start(command, settings).wait();
  const bool expected = code == any_code || result.code == code ||
                        (code == judged && (result.code == 0 || result.code == 4));
  EXPECT_TRUE(expected) << command << ": " << result.code << '\n' << result.out << result.err;
  return result;
}

void Workplace::expect_refused(const std::string& command, const Words& settings,
                               const Parts& parts) const {
  SCOPED_TRACE(testing::PrintToString(settings));
  const std::vector<std::string> before = made_in(path());
  EXPECT_TRUE(says(run(command, settings, 2).err, parts));
  EXPECT_EQ(made_in(path()), before) << command << " wrote something";
}

bool Workplace::comes(const std::string& name) const {
  return in_time([&] { return has(name); });
}

bool Workplace::hears(const std::string& words) const {
  return in_time([&] { return bool(says(text("stdout") + text("stderr"), words)); });
}

void Workplace::expect_files(const std::string& in, const Words& names) const {
  for (const std::string& name : names) EXPECT_TRUE(has(in + "/" + name)) << in << "/" << name;
}
