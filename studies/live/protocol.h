/// The language between page and program (README tells it in full): JSON in, JSON and frames out.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "meshes/base/names.h"
#include "studies/files/shown_units.h"
#include "studies/live/rig.h"

namespace fingertip::studies::inline live {

/// Of the protocol; it changes when an old page could misread a new program.
inline constexpr int live_protocol_version = 1;
/// Longest message from a page [bytes].
inline constexpr std::size_t longest_message = 1024;

/// The page has drawn frame `number` and wants the next one.
struct Acknowledge {
  std::uint64_t number = 0;
};
enum class Transport { run, pause, step, reset };
/// One of LiveSettings, or "rate": the wanted real-time factor, 0 for as fast as it can.
struct Adjust {
  std::string name;
  double value = 0.0;
};
struct HandHolds {
  meshes::Vector3 place;  ///< [m]
};
struct HandLetsGo {};

using LiveMessage = std::variant<Acknowledge, Transport, Adjust, HandHolds, HandLetsGo>;

/// The message in `text`, or why it is none.
std::variant<LiveMessage, std::string> parse_message(std::string_view text);

/// What is the same for all frames: the first message to a page. SI.
struct LiveScene {
  std::string title;
  meshes::Geometry geometry;
  meshes::Obstacle obstacle;
  LiveLimits limits;
  std::vector<meshes::Taxel> taxels;  ///< of the skin; empty without one
  std::vector<std::array<int, 2>> springs;
  std::size_t masses = 0;
  double period = 0.0;  ///< of the controller [s]
  /// Indentation [m], normal force and its estimated error [N], NaN where that is not known.
  std::vector<std::array<double, 3>> reference;
  std::string reference_name;         ///< as its legend has it
  std::vector<double> overlays;       ///< indentations of the continuum's fields [m]
  std::string remark;                 ///< on the reference; empty without any
  UnitSystem units = UnitSystem::si;  ///< the page begins with; it has the others, too
  bool comparable = true;             ///< whether errors against the reference mean anything
};

enum class LiveStatus { running, paused, failed };
using meshes::name, meshes::values;
constexpr auto names_of(LiveStatus) {
  using enum LiveStatus;
  return meshes::names<LiveStatus>({{running, "running"}, {paused, "paused"}, {failed, "failed"}});
}

struct LiveState {
  LiveSettings settings;
  double rate = 1.0;  ///< wanted real-time factor; 0: as fast as it can
};

struct LiveFrame {
  std::uint64_t number = 0;                ///< from 1
  std::shared_ptr<const LiveScene> scene;  ///< another one where the lattice has changed
  std::uint64_t epoch = 0;                 ///< counts the resets
  LiveStatus status = LiveStatus::paused;
  std::string failure;            ///< why the simulation stopped
  double real_time_factor = 0.0;  ///< achieved
  LiveState state;
  LivePicture picture;
};

/// What the rig tells of it; title, reference and units are the caller's.
LiveScene scene_of(const LiveRig& rig);
/// "scene" as JSON.
std::string encode_scene(const LiveScene& scene);
/// "error" as JSON; text that is no UTF-8 is mended.
std::string encode_error(const std::string& text);
/// A frame: uint32 length of the JSON text, the text padded with blanks so that what follows starts
/// at a multiple of 4, float32 places (3 per mass) and rows (6 each), a byte per mass that tells
/// whether the obstacle holds it, bytes up to a multiple of 4, float32 points of the contact (7
/// each: place, side of a square of its area, pressure, shear, 1 where it slips) and places of
/// markers (3 each). Little-endian.
std::string encode_frame(const LiveFrame& frame, const std::vector<LiveRow>& rows);

}  // namespace fingertip::studies::inline live
