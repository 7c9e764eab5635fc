// The real program with controllers of people's own, in order and out of order.

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>

#include <cstdlib>
#include <sstream>
#include <thread>

#include "raw_client.h"
#include "tests/studies/workplace.h"

namespace fs = std::filesystem;
using nlohmann::json;

namespace {

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
  ProgramResult press(const Words& settings, int code, const std::string& out = "run") const {
    return place_.run("press --threads 1 --out " + out, coarse + settings, code);
  }
  /// Starts a press with a controller behind a socket, and waits until it listens and says so.
  Program listening(const std::string& timeout = "5 s") const {
    const Words socket = {"controller.type=socket", "controller.address=" + address(),
                          "controller.timeout=" + timeout};
    Program program = place_.start("press --threads 1 --out run", coarse + socket);
    EXPECT_TRUE(place_.hears("waiting for a controller") && fs::exists(path()));
    return program;
  }
  std::string path() const { return (place_ / "socket").string(); }
  std::string address() const { return "unix:" + path(); }
  json summary() const { return place_.json("run/summary.json"); }
  std::size_t trace_rows() const {
    std::istringstream in(place_.text("run/trace.csv"));
    std::size_t rows = 0;
    for (std::string line; std::getline(in, line);) ++rows;
    return rows == 0 ? 0 : rows - 1;
  }
  /// Exit code 3 with `part` as reason, and everything of the run kept.
  void expect_failed(const ProgramResult& result, const std::string& part, std::size_t rows) {
    EXPECT_EQ(result.code, 3) << result.err;
    EXPECT_TRUE(says(result.err, {part, "run is kept"}));
    const json manifest = place_.json("run/manifest.json");
    EXPECT_EQ(manifest["status"], "controller failed");
    EXPECT_EQ(manifest["exit_code"], 3);
    EXPECT_TRUE(says(manifest["error"], part));
    EXPECT_TRUE(summary()["status"].get<std::string>().starts_with("controller failed: "));
    EXPECT_EQ(trace_rows(), rows);
    EXPECT_TRUE(place_.has("run/response.csv"));
    EXPECT_FALSE(place_.has("run/finished.json"));
  }

  const Words coarse = {"press.depth=0.03 cm", "lattice.spacing=tip_radius/6", "run.error=off"};
  const Workplace place_;
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
  Program program = listening();
  Child client({FINGERTIP_PYTHON, FINGERTIP_CONTROL_FOLDER "/examples/client.py", address()});
  const ProgramResult result = program.wait();
  EXPECT_EQ(client.wait(), 0);
  ASSERT_EQ(result.code, 0) << result.err;
  const json tracking = summary()["tracking"];
  EXPECT_LT(tracking["speed_deviation"].get<double>(), 0.01);
  EXPECT_LT(tracking["tilt_deg"].get<double>(), 0.05);
  EXPECT_FALSE(fs::exists(path()));
  // Another process may do something else the next time: nothing of it is in the cache.
  EXPECT_FALSE(place_.has("cache"));
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
  const Words library = {"controller.type=library", "controller.library=" + object};
  build("-O1");
  press(library, 0);
  EXPECT_LT(summary()["tracking"]["speed_deviation"].get<double>(), 0.01);
  EXPECT_TRUE(says(press(library, 0, "again").out, "earlier run"));
  build("-O1 -g");
  EXPECT_TRUE(omits(press(library, 0, "other").out, "earlier run"));
}

TEST_F(OwnController, ThatCannotBeUsedIsBadInputOrAFailure) {
  press({"controller.type=library"}, 2);
  press({"controller.type=socket", "controller.address=tcp:0.0.0.0:1"}, 2);
  place_.put("text.so", "not an object");
  EXPECT_TRUE(says(press({"controller.type=library", "controller.library=text.so"}, 3).err,
                   "text.so cannot be loaded"));
}

TEST_F(OwnController, KilledEndsTheRunWithTheDataKept) {
  Program program = listening("1 s");
  Child client({FINGERTIP_CLIENT, address()});
  std::this_thread::sleep_for(std::chrono::milliseconds(30));
  client.send(SIGKILL);
  const ProgramResult result = program.wait();
  client.wait();
  if (result.code == 0) GTEST_SKIP() << "the press was faster than the signal";
  expect_failed(result, "did not come back within 1 s", trace_rows());
}

TEST_F(OwnController, StoppedEndsTheRunWithTheDataKept) {
  Program program = listening("1 s");
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
    Program program = listening();
    RawClient client(path());
    answer(client, 7);
    client.line();
    client.send(bytes);
    expect_failed(program.wait(), part, 7);
  }
}

TEST_F(OwnController, OfAnotherVersionIsRefused) {
  Program program = listening();
  RawClient client(path());
  client.line();
  client.send(R"({"protocol":"fingertip-control","version":2})");
  expect_failed(program.wait(), "version 2", 0);
}

TEST_F(OwnController, ThatComesBackFinishesTheRun) {
  Program program = listening();
  {
    RawClient client(path());
    answer(client, 5);
  }
  Child client({FINGERTIP_CLIENT, address()});
  const ProgramResult result = program.wait();
  EXPECT_EQ(result.code, 0) << result.err;
  EXPECT_TRUE(says(result.err, "the controller is back"));
  EXPECT_EQ(client.wait(), 0);
}

TEST_F(OwnController, ThatNeverComesCanBeInterrupted) {
  Program program = listening();
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  program.send(SIGINT);
  EXPECT_EQ(program.wait().code, 130);
  EXPECT_FALSE(fs::exists(path()));
}
