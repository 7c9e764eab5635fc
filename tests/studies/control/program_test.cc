// The real program with controllers of people's own, in order and out of order.

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>

#include <chrono>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <sstream>
#include <thread>

#include "raw_client.h"
#include "tests/studies/program.h"
#include "tests/temporary_folder.h"

namespace fs = std::filesystem;
using nlohmann::json;

namespace {

using Words = std::vector<std::string>;

/// A process that a test starts and that dies with it.
class Child {
 public:
  explicit Child(const Words& words) : process_(::fork()) {
    if (process_ != 0) return;
    std::vector<char*> arguments;
    for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);
    ::execv(arguments[0], arguments.data());
    ::_exit(127);
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;
  ~Child() {
    if (process_ > 0) end(SIGKILL);
  }
  void send(int signal) const { ::kill(process_, signal); }
  int end(int signal) {
    send(signal);
    return wait();
  }
  int wait() {
    int status = 0;
    ::waitpid(process_, &status, 0);
    process_ = -1;
    return status;
  }

 private:
  pid_t process_;
};

class OwnController : public testing::Test {
 protected:
  Words press(Words more) const {
    Words all = {"press",
                 "--out",
                 "run",
                 "--threads",
                 "1",
                 "--set",
                 "press.depth=0.03 cm",
                 "--set",
                 "lattice.spacing=tip_radius/6"};
    for (const std::string& set : more) {
      all.push_back("--set");
      all.push_back(set);
    }
    return all;
  }
  Words over_socket(const std::string& timeout = "5 s") const {
    return press({"controller.type=socket", "controller.address=" + address(),
                  "controller.timeout=" + timeout});
  }
  std::string path() const { return (place_ / "socket").string(); }
  std::string address() const { return "unix:" + path(); }
  /// Until the program listens, and says so.
  void wait_for_socket() const {
    const auto listens = [&] {
      return read_text(place_ / "stderr").find("waiting for a controller") != std::string::npos;
    };
    for (int i = 0; i < 1000 && !listens(); ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    ASSERT_TRUE(listens() && fs::exists(path())) << read_text(place_ / "stderr");
  }
  json summary() const { return json::parse(read_text(place_ / "run/summary.json")); }
  std::size_t trace_rows() const {
    std::istringstream in(read_text(place_ / "run/trace.csv"));
    std::size_t rows = 0;
    for (std::string line; std::getline(in, line);) ++rows;
    return rows == 0 ? 0 : rows - 1;
  }
  /// Exit code 3 with `part` as reason, and everything of the run kept.
  void expect_failed(const ProgramResult& result, const std::string& part, std::size_t rows) {
    EXPECT_EQ(result.code, 3) << result.err;
    EXPECT_NE(result.err.find(part), std::string::npos) << result.err;
    EXPECT_NE(result.err.find("run is kept"), std::string::npos) << result.err;
    const json manifest = json::parse(read_text(place_ / "run/manifest.json"));
    EXPECT_EQ(manifest["status"], "controller failed");
    EXPECT_EQ(manifest["exit_code"], 3);
    EXPECT_NE(manifest["error"].get<std::string>().find(part), std::string::npos) << manifest;
    EXPECT_TRUE(summary()["status"].get<std::string>().starts_with("controller failed: "));
    EXPECT_EQ(trace_rows(), rows);
    EXPECT_TRUE(fs::exists(place_ / "run/response.csv"));
    EXPECT_FALSE(fs::exists(place_ / "run/finished.json"));
  }

  TemporaryFolder place_;
};

/// Answers `count` measurements with no wrench at all.
void answer(RawClient& client, int count) {
  client.greet();
  for (int i = 0; i < count; ++i) {
    client.line();
    client.send(R"({"wrench":[0,0,0,0,0,0]})");
  }
}

}  // namespace

TEST_F(OwnController, InPythonRunsTheTaskOfThePaper) {
  Program program(place_.path(), over_socket());
  wait_for_socket();
  Child client({FINGERTIP_PYTHON, FINGERTIP_CONTROL_FOLDER "/examples/client.py", address()});
  const ProgramResult result = program.wait();
  EXPECT_EQ(client.wait(), 0);
  ASSERT_EQ(result.code, 0) << result.err;
  const json tracking = summary()["tracking"];
  EXPECT_LT(tracking["speed_deviation"].get<double>(), 0.01);
  EXPECT_LT(tracking["tilt_deg"].get<double>(), 0.05);
  EXPECT_FALSE(fs::exists(path()));
  // Another process may do something else the next time: nothing of it is in the cache.
  EXPECT_FALSE(fs::exists(place_ / "cache"));
}

TEST_F(OwnController, AsALibraryIsRecognisedByItsContent) {
  const std::string object = (place_ / "pid.so").string();
  const auto build = [&](const std::string& flags) {
    const std::string folder = FINGERTIP_CONTROL_FOLDER;
    const std::string command = std::string(FINGERTIP_C_COMPILER) + " -std=c99 " + flags +
                                " -shared -fPIC -ffp-contract=off -I" + folder + " -o " + object +
                                " " + folder + "/examples/shared_object/pid_controller.c -lm";
    ASSERT_EQ(std::system(command.c_str()), 0) << command;
  };
  Words words = press({"controller.type=library", "controller.library=" + object});
  build("-O1");
  const ProgramResult first = run_program(place_.path(), words);
  ASSERT_EQ(first.code, 0) << first.err;
  EXPECT_LT(summary()["tracking"]["speed_deviation"].get<double>(), 0.01);
  words[2] = "again";
  EXPECT_NE(run_program(place_.path(), words).out.find("earlier run"), std::string::npos);
  build("-O1 -g");
  words[2] = "other";
  EXPECT_EQ(run_program(place_.path(), words).out.find("earlier run"), std::string::npos);
}

TEST_F(OwnController, ThatCannotBeUsedIsBadInputOrAFailure) {
  EXPECT_EQ(run_program(place_.path(), press({"controller.type=library"})).code, 2);
  EXPECT_EQ(run_program(place_.path(),
                        press({"controller.type=socket", "controller.address=tcp:0.0.0.0:1"}))
                .code,
            2);
  write_text(place_ / "text.so", "not an object");
  const ProgramResult result =
      run_program(place_.path(), press({"controller.type=library", "controller.library=text.so"}));
  EXPECT_EQ(result.code, 3) << result.err;
  EXPECT_NE(result.err.find("text.so cannot be loaded"), std::string::npos) << result.err;
}

TEST_F(OwnController, KilledEndsTheRunWithTheDataKept) {
  Program program(place_.path(), over_socket("1 s"));
  wait_for_socket();
  Child client({FINGERTIP_CLIENT, address()});
  std::this_thread::sleep_for(std::chrono::milliseconds(30));
  client.send(SIGKILL);
  const ProgramResult result = program.wait();
  client.wait();
  if (result.code == 0) GTEST_SKIP() << "the press was faster than the signal";
  expect_failed(result, "did not come back within 1 s", trace_rows());
}

TEST_F(OwnController, StoppedEndsTheRunWithTheDataKept) {
  Program program(place_.path(), over_socket("1 s"));
  wait_for_socket();
  RawClient client(path());
  answer(client, 20);
  client.line();  // and no answer to this one
  expect_failed(program.wait(), "a command within 1 s", 20);
  const auto bye = client.line();
  EXPECT_TRUE(bye && bye->find("bye") != bye->npos);
}

TEST_F(OwnController, ThatSendsNonsenseEndsTheRunWithTheDataKept) {
  const std::pair<std::string, std::string> cases[] = {
      {R"({"wrench":[NaN,0,0,0,0,0]})", "NaN"},
      {std::string("\x01\xfe\xff"), "not JSON"},
      {std::string(70'000, '['), "65536 bytes"},
      {R"({"target":{"position":[1,2]}})", "3 numbers"}};
  for (const auto& [bytes, part] : cases) {
    fs::remove_all(place_ / "run");
    fs::remove(place_ / "stderr");
    Program program(place_.path(), over_socket());
    wait_for_socket();
    RawClient client(path());
    answer(client, 7);
    client.line();
    client.send(bytes);
    expect_failed(program.wait(), part, 7);
  }
}

TEST_F(OwnController, OfAnotherVersionIsRefused) {
  Program program(place_.path(), over_socket());
  wait_for_socket();
  RawClient client(path());
  client.line();
  client.send(R"({"protocol":"fingertip-control","version":2})");
  expect_failed(program.wait(), "version 2", 0);
}

TEST_F(OwnController, ThatComesBackFinishesTheRun) {
  Program program(place_.path(), over_socket());
  wait_for_socket();
  {
    RawClient client(path());
    answer(client, 5);
  }
  Child client({FINGERTIP_CLIENT, address()});
  const ProgramResult result = program.wait();
  EXPECT_EQ(result.code, 0) << result.err;
  EXPECT_NE(result.err.find("the controller is back"), std::string::npos) << result.err;
  EXPECT_EQ(client.wait(), 0);
}

TEST_F(OwnController, ThatNeverComesCanBeInterrupted) {
  Program program(place_.path(), over_socket());
  wait_for_socket();
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  program.send(SIGINT);
  EXPECT_EQ(program.wait().code, 130);
  EXPECT_FALSE(fs::exists(path()));
}
