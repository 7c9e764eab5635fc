#include "studies/control/messages.h"

#include <algorithm>
#include <cstddef>
#include <initializer_list>
#include <nlohmann/json.hpp>

#include "studies/control/c_structs.h"

namespace fingertip::studies::inline control {

using lattice::ControllerFailed;
using meshes::Vector3;
using nlohmann::json;
using nlohmann::ordered_json;

namespace {

constexpr const char* protocol_name = "fingertip-control";

ordered_json list(const Vector3& v) {
  return {v.x(), v.y(), v.z()};
}

ordered_json list(const Eigen::Quaterniond& q) {
  return {q.w(), q.x(), q.y(), q.z()};
}

/// Names of the fields of a target, as they are written and read.
ordered_json object(const lattice::Target& target) {
  return {{"position", list(target.pose.position)},
          {"orientation", list(target.pose.orientation)},
          {"velocity", list(target.twist.velocity)},
          {"angular_velocity", list(target.twist.angular_velocity)},
          {"acceleration", list(target.acceleration.velocity)},
          {"angular_acceleration", list(target.acceleration.angular_velocity)}};
}

/// The start of a line for an error message, harmless on a terminal.
std::string excerpt(std::string_view line) {
  constexpr std::size_t most = 80;
  std::string text(line.substr(0, most));
  std::ranges::replace_if(
      text, [](char c) { return c < ' ' || c > '~'; }, '?');
  return "\"" + text + (line.size() > most ? "...\"" : "\"");
}

[[noreturn]] void refuse(const std::string& what, std::string_view line) {
  throw ControllerFailed("the controller sent " + what + ": " + excerpt(line));
}

json parse_object(std::string_view line, const char* expected) {
  json object = json::parse(line, nullptr, false);
  if (object.is_discarded()) {
    refuse("what is not JSON (in which NaN and infinity do not exist), instead of " +
               std::string(expected),
           line);
  }
  if (!object.is_object()) refuse("no JSON object, instead of " + std::string(expected), line);
  return object;
}

void check_names(const json& object, std::initializer_list<const char*> known,
                 std::string_view line) {
  for (const auto& [name, value] : object.items()) {
    const bool is_known =
        std::ranges::any_of(known, [&](const char* other) { return name == other; });
    if (!is_known) refuse("the unknown field " + excerpt(name), line);
  }
}

template <std::size_t N>
std::array<double, N> numbers(const json& value, const char* name, std::string_view line) {
  const bool fits = value.is_array() && value.size() == N &&
                    std::ranges::all_of(value, [](const json& v) { return v.is_number(); });
  if (!fits) refuse(name + (" that is no list of " + std::to_string(N)) + " numbers", line);
  return value.get<std::array<double, N>>();
}

Vector3 vector(const json& target, const char* name, std::string_view line) {
  if (!target.contains(name)) return Vector3::Zero();
  return Vector3(numbers<3>(target[name], name, line).data());
}

lattice::Target read_target(const json& value, std::string_view line) {
  if (!value.is_object() || !value.contains("position")) {
    refuse("a target that is no object with a position", line);
  }
  check_names(value,
              {"position", "orientation", "velocity", "angular_velocity", "acceleration",
               "angular_acceleration"},
              line);
  lattice::Target target;
  target.pose.position = vector(value, "position", line);
  if (value.contains("orientation")) {
    const auto q = numbers<4>(value["orientation"], "orientation", line);
    target.pose.orientation = {q[0], q[1], q[2], q[3]};
  }
  target.twist = {vector(value, "velocity", line), vector(value, "angular_velocity", line)};
  target.acceleration = {vector(value, "acceleration", line),
                         vector(value, "angular_acceleration", line)};
  return target;
}

}  // namespace

std::string hello_line(const lattice::ControlTask& task, double timeout, bool resumed) {
  ordered_json inertia = ordered_json::array();
  for (int i = 0; i < 6; ++i) {
    ordered_json row = ordered_json::array();
    for (int j = 0; j < 6; ++j) row.push_back(task.inertia(i, j));
    inertia.push_back(row);
  }
  ordered_json order = {{"period", task.period},
                        {"inertia", inertia},
                        {"force_limit", task.force_limit},
                        {"torque_limit", task.torque_limit},
                        {"normal", list(task.normal)},
                        {"clearance", task.clearance},
                        {"depth", task.depth},
                        {"speed", task.speed}};
  for (const meshes::Taxel& taxel : task.taxels)
    order["taxels"].push_back(
        {{"place", list(taxel.place)}, {"normal", list(taxel.normal)}, {"area", taxel.area}});
  return ordered_json{
      {"message", "hello"}, {"protocol", protocol_name}, {"version", control_protocol_version},
      {"resumed", resumed}, {"timeout", timeout},        {"task", order}}
      .dump();
}

std::string measurement_line(const lattice::Measurement& m, const lattice::ControlTask& task,
                             long cycle) {
  ordered_json line = {{"message", "measurement"},
                       {"cycle", cycle},
                       {"time", m.time},
                       {"position", list(m.pose.position)},
                       {"orientation", list(m.pose.orientation)},
                       {"velocity", list(m.twist.velocity)},
                       {"angular_velocity", list(m.twist.angular_velocity)},
                       {"force", list(m.wrench.force)},
                       {"torque", list(m.wrench.torque)}};
  if (m.contact) {
    line["contact"] = {{"touching", m.contact->touching},
                       {"radius", m.contact->radius},
                       {"force", list(m.contact->on_tip.force)},
                       {"torque", list(m.contact->on_tip.torque)}};
  }
  for (const meshes::TaxelReading& taxel : m.taxels)
    line["taxels"].push_back({taxel.normal_stress, taxel.shear_u, taxel.shear_v});
  if (task.path) line["set_point"] = object(task.path(m.time));
  return line.dump();
}

std::string reset_line() {
  return R"({"message":"reset"})";
}

std::string bye_line(const std::string& reason) {
  return ordered_json{{"message", "bye"}, {"reason", reason}}.dump(
      -1, ' ', false, ordered_json::error_handler_t::replace);
}

void check_hello(std::string_view line) {
  const json hello = parse_object(line, "its hello");
  const auto protocol = hello.find("protocol"), version = hello.find("version");
  if (protocol == hello.end() || *protocol != protocol_name || version == hello.end() ||
      !version->is_number_integer()) {
    refuse(R"(no hello like {"protocol":"fingertip-control","version":1})", line);
  }
  if (*version != control_protocol_version) {
    throw ControllerFailed("the controller speaks version " + version->dump() + " of " +
                           protocol_name + ", this program version " +
                           std::to_string(control_protocol_version));
  }
}

lattice::Command parse_command(std::string_view line) {
  const json answer = parse_object(line, "a command");
  check_names(answer, {"wrench", "target"}, line);
  if (answer.size() != 1) refuse("not exactly one of wrench and target", line);
  if (answer.contains("target")) return checked(read_target(answer["target"], line));
  const auto w = numbers<6>(answer["wrench"], "wrench", line);
  return checked(lattice::Wrench{Vector3(w[0], w[1], w[2]), Vector3(w[3], w[4], w[5])});
}

}  // namespace fingertip::studies::inline control
