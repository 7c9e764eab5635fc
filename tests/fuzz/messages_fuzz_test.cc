// Damaged messages of controllers and web pages, and files of other programs.

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "campaign.h"
#include "meshes/base/errors.h"
#include "studies/control/c_structs.h"
#include "studies/control/local_socket.h"
#include "studies/control/messages.h"
#include "studies/exchange/lammps/lammps_program.h"
#include "studies/live/access.h"
#include "studies/live/protocol.h"
#include "studies/live/reference.h"
#include "tests/studies/live/shell_vtu.h"
#include "tests/temporary_folder.h"

using namespace fingertip;
using namespace fingertip::studies;
using lattice::ControllerFailed;

namespace {

const std::vector<std::string> json_words = {
    "[",  "]",    "{",    "}",       ",",   ":",    "\"",         "1e999",      "-",
    "[]", "null", "true", "\\u0000", "NaN", "\xff", "\"wrench\"", "\"target\"", "\"orientation\""};

}  // namespace

TEST(FuzzMessages, CommandsOfAController) {
  fuzz::attack({{R"({"wrench":[1,2.5,-3e-2,4,5,6]})",
                 R"({"target":{"position":[0,0,1],"orientation":[1,0,0,0],"velocity":[1,2,3]}})"},
                json_words},
               fuzz::refusing<ControllerFailed>([](const std::string& line) {
                 checked(parse_command(line));  // refuses what is not finite
               }));
}

TEST(FuzzMessages, HellosOfAController) {
  fuzz::attack(
      {{R"({"protocol":"fingertip-control","version":1,"by":"x"})"}, json_words},
      fuzz::refusing<ControllerFailed>([](const std::string& line) { check_hello(line); }));
}

TEST(FuzzMessages, AddressesOfSockets) {
  fuzz::attack(
      {{"unix:here/it", "tcp:127.0.0.1:4711"}, {":", "/", "tcp:", "0", "localhost", "::1"}},
      fuzz::refusing<meshes::InvalidInput>([](const std::string& text) {
        const LocalAddress address = LocalAddress::parse(text);
        EXPECT_TRUE(address.port >= 0 && address.port < 65536);
      }));
}

TEST(FuzzMessages, MessagesOfAPage) {
  const std::vector<std::string> seeds = {
      R"({"type":"set","name":"speed","value":0.05})", R"({"type":"hold","place":[0.1,-0.2,3e-3]})",
      R"({"type":"ack","frame":18446744073709551615})", R"({"type":"step"})"};
  fuzz::attack({seeds, json_words}, [](const std::string& text) {
    const auto result = parse_message(text);
    if (const auto* refusal = std::get_if<std::string>(&result)) {
      // The answer is good JSON whatever came.
      EXPECT_EQ(nlohmann::json::parse(encode_error(*refusal)).at("type"), "error");
      return false;
    }
    const auto& message = std::get<LiveMessage>(result);
    if (const auto* change = std::get_if<Adjust>(&message)) {
      EXPECT_TRUE(std::isfinite(change->value));
    } else if (const auto* hold = std::get_if<HandHolds>(&message)) {
      EXPECT_TRUE(hold->place.allFinite());
    }
    return true;
  });
}

// Only the whole token opens.
TEST(FuzzMessages, RequestsToTheServer) {
  const Access access(8080, "0123456789abcdef0123456789abcdef");
  const std::string cookie = access.cookie_name() + "=" + access.token();
  fuzz::attack({{"127.0.0.1:8080\nhttp://127.0.0.1:8080\na=b; " + cookie + "\n",
                 "localhost:8080\nhttp://localhost:8080\n\ntoken=" + access.token()},
                {"; ", "=", "&", "token=", "evil.example", ":8080", "@", "%00", "localhost"}},
               [&](const std::string& input) {
                 std::vector<std::string> lines(4);
                 std::size_t line = 0;
                 for (const char c : input)
                   c == '\n' ? void(line = std::min(line + 1, std::size_t(3)))
                             : lines[line].push_back(c);
                 const Credentials request{lines[0], lines[1], lines[2], lines[3]};
                 const bool connects = access.may_connect(request);
                 if (!connects) return false;
                 EXPECT_NE(input.find(access.token()), input.npos);
                 EXPECT_TRUE(access.is_here(request.host) && access.is_own_page(request.origin));
                 EXPECT_TRUE(access.may_read(request));
                 return true;
               });
}

TEST(FuzzExchange, LogsOfLammps) {
  const TemporaryFolder folder;
  const std::string log =
      "LAMMPS (29 Sep 2021 - Update 2)\nrun 1000\n"
      "Loop time of 0.75 on 2 procs for 1000 steps with 1234 atoms\n\n98.5% CPU use with 2 MPI\n";
  fuzz::attack({{log}, {"ERROR: lost atoms\n", "LAMMPS (", ")", "%", "Loop time of ", "nan", "-"}},
               fuzz::refusing<meshes::InvalidInput>([&](const std::string& input) {
                 write_text(folder / "log", input);
                 const LammpsTiming timing = read_lammps_log(folder / "log");
                 EXPECT_TRUE(timing.loop_time >= 0.0 && std::isfinite(timing.loop_time));
                 EXPECT_TRUE(timing.processor_share >= 0.0 && timing.processor_share <= 1.0);
                 EXPECT_GE(timing.ranks, 1);
                 EXPECT_GE(timing.steps, 0);
               }));
}

TEST(FuzzLive, FieldsBesideTheRun) {
  const TemporaryFolder folder;
  const auto file = folder / "a.vtu";
  const std::vector<std::string> words = {
      "<DataArray ",   ">", "\"", "AAAA", "=", "<Cells>", "format=\"binary\"", "////",
      "type=\"Int32\""};
  fuzz::attack({{ShellVtu(2).text(), ShellVtu(2).text(false)}, words},
               fuzz::refusing<meshes::InvalidInput>([&](const std::string& input) {
                 write_text(file, input);
                 const SurfaceMesh surface = completed(outer_surface(read_vtu(file)));
                 EXPECT_EQ(surface.rest.size(), surface.displacement.size());
                 for (const meshes::Vector3& place : surface.rest) EXPECT_TRUE(place.allFinite());
                 for (const auto& edge : surface.edges)
                   EXPECT_TRUE(edge[0] < surface.rest.size() && edge[1] < surface.rest.size());
               }));
}

TEST(FuzzLive, SeriesOfFields) {
  const TemporaryFolder folder;
  std::filesystem::create_directories(folder / "fields");
  write_text(folder / "response.csv", "indentation [m],normal_force [N]\n0.001,0.1\n");
  write_text(folder / "fields/a.vtu", ShellVtu(1).text());
  fuzz::attack({{"<Collection>\n<DataSet timestep=\"0.001\" group=\"\" file=\"a.vtu\"/>\n"
                 "<DataSet timestep=\"0.002\" file=\"a.vtu\"/>\n</Collection>\n"},
                {"<DataSet ", "\"", "file=\"", "timestep=\"", "../", "nan"}},
               fuzz::refusing<meshes::InvalidInput>([&](const std::string& input) {
                 write_text(folder / "fields/press.pvd", input);
                 const Reference reference = read_reference(folder.path());
                 for (const Overlay& overlay : reference.overlays)
                   EXPECT_TRUE(std::isfinite(overlay.indentation));
               }));
}
