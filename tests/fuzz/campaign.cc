#include "campaign.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/time.h>
#include <unistd.h>

#include <charconv>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>

namespace fuzz {

namespace {

std::size_t number_from(const char* variable, std::size_t otherwise) {
  const char* const text = std::getenv(variable);
  if (text == nullptr) return otherwise;
  std::size_t value = otherwise;
  std::from_chars(text, text + std::strlen(text), value);
  return value;
}

double processor_seconds() {
  timespec now{};
  ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return double(now.tv_sec) + 1e-9 * double(now.tv_nsec);
}

/// The start of the input, as C++ would have it written.
std::string escaped(const std::string& input) {
  std::string text;
  for (const char c : input.substr(0, 1500)) {
    char code[8];
    if (c == '\n') {
      text += "\\n\n";
    } else if (c >= ' ' && c <= '~') {
      text += c;
    } else {
      std::snprintf(code, sizeof code, "\\x%02x", unsigned(static_cast<unsigned char>(c)));
      text += code;
    }
  }
  return text + (input.size() > 1500 ? "..." : "") + " (" + std::to_string(input.size()) +
         " bytes)";
}

// A signal handler reaches nothing but a global.
char overdue[64] = "";

extern "C" void tell_overdue(int) {
  [[maybe_unused]] const auto written = ::write(STDERR_FILENO, overdue, std::strlen(overdue));
  ::_exit(1);
}

/// Ends the program when a minute of processor time passes without a new input.
class Watchdog {
 public:
  Watchdog() { ::signal(SIGPROF, tell_overdue); }
  ~Watchdog() { set(0); }
  void new_input(std::size_t number) {
    std::snprintf(overdue, sizeof overdue, "input %zu does not end\n", number);
    set(60);
  }

 private:
  static void set(long seconds) {
    const itimerval timer{{0, 0}, {seconds, 0}};
    ::setitimer(ITIMER_PROF, &timer, nullptr);
  }
};

/// What is wrong about this input beyond failed expectations; empty: nothing.
std::string outcome(const Reader& reader, const std::string& input, double patience,
                    std::size_t& accepted) {
  const double start = processor_seconds();
  try {
    if (reader(input)) ++accepted;
  } catch (const std::exception& error) {
    return std::string("another exception: ") + error.what();
  } catch (const std::string& finding) {
    return finding;
  }
  const double seconds = processor_seconds() - start;
  return seconds <= patience ? "" : "took " + std::to_string(seconds) + " s";
}

}  // namespace

std::size_t wanted_inputs() {
  return number_from("FINGERTIP_FUZZ_INPUTS", 400);
}

void attack(const Material& material, const Reader& reader, double patience) {
  for (const std::string& seed : material.seeds)
    EXPECT_TRUE(reader(seed)) << "a seed must be accepted:\n" << escaped(seed);
  if (testing::Test::HasFailure()) return;
  const auto failures = [] {
    return testing::UnitTest::GetInstance()->current_test_info()->result()->total_part_count();
  };
  const std::size_t first = number_from("FINGERTIP_FUZZ_FIRST", 0), inputs = wanted_inputs();
  std::size_t accepted = 0;
  int findings = 0;
  Watchdog watchdog;
  for (std::size_t number = first; number < first + inputs && findings < 3; ++number) {
    const std::string input = mutated(material, number);
    watchdog.new_input(number);
    const int before = failures();
    const std::string finding = outcome(reader, input, patience, accepted);
    if (finding.empty() && failures() == before) continue;
    ++findings;
    ADD_FAILURE() << "input " << number << ": " << finding << "\n" << escaped(input);
  }
  std::printf("%zu inputs, %zu accepted\n", inputs, accepted);
  if (inputs < 100 || findings > 0) return;
  EXPECT_GT(accepted, 0U) << "no mutation leaves anything to read";
  EXPECT_LT(accepted, inputs) << "nothing is refused";
}

}  // namespace fuzz
