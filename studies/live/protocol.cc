#include "studies/live/protocol.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>

#include "meshes/shape/meridian.h"

namespace fingertip::studies::inline live {

namespace {

using Json = nlohmann::json;
using Parsed = std::variant<LiveMessage, std::string>;

/// Numbers beyond this are no lengths, speeds or frequencies of a finger.
constexpr double largest_number = 1e6;

std::optional<double> number_in(const Json& message, const char* name) {
  const auto found = message.find(name);
  if (found == message.end() || !found->is_number()) return {};
  const double value = found->get<double>();
  if (!(std::abs(value) <= largest_number)) return {};
  return value;
}

Parsed parse_adjustment(const Json& message) {
  const auto found = message.find("name");
  const std::string name = found != message.end() && found->is_string() ? *found : "";
  const std::optional<double> value = number_in(message, "value");
  if (!value) return "set: value must be a number";
  if (name == "controller" || name == "contact_force" || name == "rate" ||
      std::ranges::find(sliders, name, &Slider::name) != std::end(sliders))
    return Adjust{name, *value};
  return "set: there is no such setting";
}

Parsed parse_hold(const Json& message) {
  const auto place = message.find("place");
  if (place == message.end() || !place->is_array() || place->size() != 3) {
    return "hold: place must be three numbers";
  }
  HandHolds hold;
  for (std::size_t k = 0; k < 3; ++k) {
    const Json& value = (*place)[k];
    if (!value.is_number() || !(std::abs(value.get<double>()) <= largest_number)) {
      return "hold: place must be three numbers";
    }
    hold.place[Eigen::Index(k)] = value.get<double>();
  }
  return hold;
}

Json vector_json(const meshes::Vector3& v) {
  return {v.x(), v.y(), v.z()};
}

Json wrench_json(const lattice::Wrench& wrench) {
  return {{"force", vector_json(wrench.force)}, {"torque", vector_json(wrench.torque)}};
}

Json pose_json(const lattice::Pose& pose) {
  const Eigen::Quaterniond& q = pose.orientation;
  return {{"position", vector_json(pose.position)}, {"orientation", {q.x(), q.y(), q.z(), q.w()}}};
}

Json span_json(const Span& span) {
  return {span.least, span.most};
}

Json limits_json(const LiveLimits& limits) {
  Json json = {{"reach", limits.reach}};
  for (const Slider& slider : sliders) json[slider.name] = span_json(limits.*slider.limits);
  if (limits.contact_force) json["contact_force"] = span_json(*limits.contact_force);
  return json;
}

std::string text_of(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

Json settings_json(const LiveState& state) {
  const LiveSettings& s = state.settings;
  Json json = {
      {"controller", s.controller}, {"contact_force", s.contact_force}, {"rate", state.rate}};
  for (const Slider& slider : sliders) json[slider.name] = s.*slider.value;
  return json;
}

Json frame_json(const LiveFrame& frame, std::size_t rows) {
  const LivePicture& picture = frame.picture;
  Json json = {{"type", "frame"},
               {"number", frame.number},
               {"epoch", frame.epoch},
               {"status", name(frame.status)},
               {"failure", frame.failure},
               {"real_time_factor", frame.real_time_factor},
               {"settings", settings_json(frame.state)},
               {"time", picture.row.time},
               {"indentation", picture.row.indentation},
               {"normal_force", picture.row.normal_force},
               {"speed", picture.row.speed},
               {"commanded_speed", picture.row.commanded_speed},
               {"tilt", picture.row.tilt},
               {"endpoint", vector_json(picture.measured.pose.position)},
               {"wrench", wrench_json(picture.measured.wrench)},
               {"commanded", wrench_json(picture.commanded)},
               {"rod", pose_json(picture.finger.rod)},
               {"plane",
                {{"point", vector_json(picture.finger.plane.point)},
                 {"normal", vector_json(picture.finger.plane.normal)}}},
               {"masses", picture.finger.boundary.size()},
               {"contact", picture.finger.contact.size()},
               {"markers", picture.markers.size()},
               {"rows", rows}};
  if (picture.measured.contact) {
    json["touching"] = picture.measured.contact->touching;
    json["contact_radius"] = picture.measured.contact->radius;
    json["force_error"] = picture.force_error;
  }
  for (const meshes::TaxelReading& taxel : picture.measured.taxels)
    json["taxels"].push_back({taxel.normal_stress, taxel.shear_u, taxel.shear_v});
  if (picture.hand_place) {
    json["hand"] = wrench_json(picture.hand);
    json["hand"]["place"] = vector_json(*picture.hand_place);
  }
  return json;
}

void append_float(std::string& bytes, double value) {
  const float small = float(value);
  char raw[sizeof small];
  std::memcpy(raw, &small, sizeof small);
  bytes.append(raw, sizeof raw);
}

}  // namespace

Parsed parse_message(std::string_view text) {
  if (text.size() > longest_message) return "the message is too long";
  const Json message = Json::parse(text, nullptr, false);
  if (!message.is_object()) return "the message is no JSON object";
  const auto found = message.find("type");
  if (found == message.end() || !found->is_string()) return "the message has no type";
  const std::string type = found->get<std::string>();
  static const std::map<std::string, Transport> transports = {{"run", Transport::run},
                                                              {"pause", Transport::pause},
                                                              {"step", Transport::step},
                                                              {"reset", Transport::reset}};
  if (const auto transport = transports.find(type); transport != transports.end()) {
    return transport->second;
  }
  if (type == "set") return parse_adjustment(message);
  if (type == "hold") return parse_hold(message);
  if (type == "release") return HandLetsGo{};
  if (type == "ack") {
    const auto number = message.find("frame");
    if (number == message.end() || !number->is_number_unsigned()) return "ack: frame is missing";
    return Acknowledge{number->get<std::uint64_t>()};
  }
  return "there is no such type of message";
}

namespace {

/// The table of units, `first` first: {"system": "si", "length": [1000, "mm"], ...}.
Json units_json(UnitSystem first) {
  Json all = Json::array();
  for (const UnitSystem system : values(UnitSystem())) {
    Json entry = {{"system", std::string(name(system))}};
    for (const ShownUnit* unit : units_of(system).all())
      entry[std::string(unit->quantity)] = {unit->factor, std::string(unit->name)};
    all.insert(system == first ? all.begin() : all.end(), std::move(entry));
  }
  return all;
}

/// Outlines of what the hand holds, (r, z).
Json held_json(const meshes::Geometry& geometry) {
  Json outlines = Json::array();
  for (const auto& outline : meshes::held_outlines(geometry, 16)) {
    Json points = Json::array();
    for (const meshes::Vector2& place : outline)
      points.push_back(Json::array({place.x(), place.y()}));
    outlines.push_back(std::move(points));
  }
  return outlines;
}

/// Null for a plane.
Json obstacle_json(const LiveScene& scene) {
  if (scene.obstacle.is_plane()) return nullptr;
  const auto mesh = meshes::obstacle_mesh(scene.obstacle, 1.75 * scene.geometry.tip_radius);
  Json points = Json::array();
  for (const meshes::Vector3& point : mesh.points)
    points.push_back(Json::array({point.x(), point.y(), point.z()}));
  return {{"points", points}, {"quadrangles", mesh.quadrangles}};
}

/// Where the taxels are, seen along the rod, and the diameters of discs of their areas.
Json taxels_json(const std::vector<meshes::Taxel>& taxels) {
  Json list = Json::array();
  for (const meshes::Taxel& taxel : taxels)
    list.push_back({taxel.place.x(), taxel.place.y(),
                    std::sqrt(4.0 * taxel.area * taxel.normal.z() / std::numbers::pi)});
  return list;
}

}  // namespace

LiveScene scene_of(const LiveRig& rig) {
  const lattice::PressSetup& setup = rig.setup();
  LiveScene scene;
  scene.title = fmt::format("{} lattice, R/{:.3g}, {} contact", lattice::name(setup.lattice.model),
                            setup.geometry.tip_radius / setup.lattice.spacing,
                            meshes::name(setup.protocol.contact));
  scene.geometry = setup.geometry;
  scene.obstacle = setup.protocol.obstacle;
  scene.limits = rig.limits();
  scene.taxels = setup.hardware.skin.taxels;
  scene.springs = rig.boundary().springs();
  scene.masses = rig.boundary().size();
  scene.period = rig.period();
  return scene;
}

std::string encode_scene(const LiveScene& scene) {
  return text_of({{"type", "scene"},
                  {"protocol", live_protocol_version},
                  {"title", scene.title},
                  {"geometry",
                   {{"tip_radius", scene.geometry.tip_radius},
                    {"rod_radius", scene.geometry.rod_radius},
                    {"sleeve_length", scene.geometry.sleeve_length},
                    {"rod_length", scene.geometry.rod_length},
                    {"dome", scene.geometry.is_dome()},
                    {"held", held_json(scene.geometry)}}},
                  {"obstacle", obstacle_json(scene)},
                  {"limits", limits_json(scene.limits)},
                  {"taxels", taxels_json(scene.taxels)},
                  {"masses", scene.masses},
                  {"springs", scene.springs},
                  {"period", scene.period},
                  {"reference", scene.reference},
                  {"reference_name", scene.reference_name},
                  {"remark", scene.remark},
                  {"comparable", scene.comparable},
                  {"units", units_json(scene.units)},
                  {"overlays", scene.overlays}});
}

std::string encode_error(const std::string& text) {
  return text_of({{"type", "error"}, {"message", text}});
}

std::string encode_frame(const LiveFrame& frame, const std::vector<LiveRow>& rows) {
  std::string text = text_of(frame_json(frame, rows.size()));
  text.resize((text.size() + 3) / 4 * 4, ' ');
  std::string bytes;
  bytes.reserve(4 + text.size() + 13 * frame.picture.finger.boundary.size() + 24 * rows.size());
  for (unsigned shift = 0; shift < 32; shift += 8) {
    bytes.push_back(char((text.size() >> shift) & 0xffU));
  }
  bytes += text;
  for (const meshes::Vector3& place : frame.picture.finger.boundary) {
    for (const double coordinate : place) append_float(bytes, coordinate);
  }
  for (const LiveRow& row : rows) {
    for (const double value :
         {row.time, row.indentation, row.normal_force, row.speed, row.commanded_speed, row.tilt}) {
      append_float(bytes, value);
    }
  }
  for (const std::uint8_t held : frame.picture.finger.held) bytes.push_back(char(held));
  while (bytes.size() % 4 != 0) bytes.push_back('\0');
  for (const meshes::ContactPoint& point : frame.picture.finger.contact) {
    for (const double coordinate : point.place) append_float(bytes, coordinate);
    for (const double value : {std::sqrt(point.area), point.normal_traction, point.shear.norm(),
                               double(point.state == meshes::ContactState::slip)})
      append_float(bytes, value);
  }
  for (const meshes::Vector3& place : frame.picture.markers)
    for (const double coordinate : place) append_float(bytes, coordinate);
  return bytes;
}

}  // namespace fingertip::studies::inline live
