#include "studies/web/page_session.h"

#include <algorithm>
#include <utility>

namespace fingertip::studies::inline web {

namespace {

using Clock = PacedRig::Clock;

/// While nothing moves, frames are looked after as often.
constexpr std::chrono::duration<double> rest(0.03);

/// One thread is all that a page gives; solids and people's controllers stay with the program.
lattice::PressSetup alone(lattice::PressSetup setup) {
  setup.threads = 1;
  return setup;
}

/// The finest that is as coarse as wanted, or the coarsest.
SetupAt coarser_than(const WebPress& press) {
  if (press.coarser.empty()) return {};
  return [setups = press.coarser](double spacing) {
    const auto found = std::ranges::find_if(
        setups, [&](const lattice::PressSetup& setup) { return setup.lattice.spacing >= spacing; });
    return alone(found == setups.end() ? setups.back() : *found);
  };
}

}  // namespace

PageSession::PageSession(const WebPress& press)
    : press_(press), paced_(alone(press.setup), {true, 1.0, coarser_than(press)}) {
  show(paced_.scene());
}

void PageSession::show(const std::shared_ptr<const LiveScene>& scene) {
  LiveScene complete = *scene;
  complete.units = press_.units;
  complete.reference_name = "continuum";
  for (const WebSample& sample : press_.reference)
    complete.reference.push_back({sample.indentation, sample.normal_force, sample.force_error});
  answers_.push_back({true, encode_scene(complete)});
  viewer_.shown(scene);
}

void PageSession::take(std::string_view text) {
  const auto parsed = parse_message(text);
  if (const std::string* why = std::get_if<std::string>(&parsed)) {
    answers_.push_back({true, encode_error(*why)});
    return;
  }
  const LiveMessage& message = std::get<LiveMessage>(parsed);
  if (const Acknowledge* seen = std::get_if<Acknowledge>(&message))
    viewer_.acknowledge(seen->number);
  else
    paced_.obey(message);
}

PageSession::Seconds PageSession::run(Seconds budget) {
  const Clock::time_point start = Clock::now();
  Clock::time_point due = start;
  while (!paced_.idle() && (due = paced_.due()) <= Clock::now() && Clock::now() - start < budget)
    paced_.advance();
  paced_.measure_pace();
  if (viewer_.waits() && paced_.frame_due()) tell(paced_.frame());
  if (paced_.idle()) return rest;
  return std::clamp<Seconds>(due - Clock::now(), Seconds(0.0), rest);
}

void PageSession::tell(const LiveFrame& frame) {
  if (!viewer_.knows(frame.scene)) show(frame.scene);
  answers_.push_back({false, viewer_.send(frame, paced_.rows())});
}

std::deque<WebMessage> PageSession::answers() {
  return std::exchange(answers_, {});
}

double pace_of(const WebPress& press, std::chrono::duration<double> wall) {
  LiveRig rig(alone(press.setup));
  const Clock::time_point start = Clock::now();
  const auto passed = [&] { return PageSession::Seconds(Clock::now() - start); };
  do {
    rig.advance();
  } while (passed() < wall || (rig.row().indentation <= 0.0 && passed() < 4.0 * wall));
  return rig.time() / passed().count();
}

}  // namespace fingertip::studies::inline web
