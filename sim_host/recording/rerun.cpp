#include "sim_host/recording/rerun.hpp"

#include <algorithm>

#include "firmware/wire/codec.hpp"
#include "sim_host/world/nodes/perception.hpp"
#include "sim_host/world/nodes/tick_echo.hpp"
#include "sim_host/world/traffic/traffic_engine.hpp"

namespace s4tp::recording {
namespace {

/// "bytes 0, 3"
std::string bytes_that_differ(const wire::Frame& a, const wire::Frame& b) {
  std::string text;
  int count = 0;
  for (int i = 0; i < std::max<int>(a.length, b.length); ++i) {
    if (i < a.length && i < b.length && a.data[i] == b.data[i]) continue;
    text += (count++ > 0 ? ", " : "") + std::to_string(i);
  }
  return (count == 1 ? "byte " : "bytes ") + text;
}

std::string difference(const wire::Frame* recorded, const wire::Frame* now) {
  std::string text = "recorded " + (recorded != nullptr ? words(*recorded) : std::string("nothing")) +
                     ", now " + (now != nullptr ? words(*now) : std::string("nothing"));
  if (recorded != nullptr && now != nullptr && recorded->id == now->id) {
    text += " (" + bytes_that_differ(*recorded, *now) + ")";
  }
  return text;
}

world::WorldOptions world_options(const DriveNote& note) {
  world::WorldOptions options;
  options.seed = note.seed;
  options.engine = scenario::engine_of(note.traffic);
  options.perception = scenario::perception_preset(note.perception);
  return options;
}

}  // namespace

void Agreement::compare(const RecordedTick& tick, const std::vector<wire::Frame>& recorded,
                        const std::vector<wire::Frame>& now, const std::vector<std::uint64_t>& lines) {
  const std::size_t count = std::max(recorded.size(), now.size());
  compared += recorded.size();
  for (std::size_t i = 0; i < count; ++i) {
    const wire::Frame* const then = i < recorded.size() ? &recorded[i] : nullptr;
    const wire::Frame* const again = i < now.size() ? &now[i] : nullptr;
    if (then != nullptr && again != nullptr && same(*then, *again)) continue;
    if (differing++ > 0) continue;
    const Place place{tick.place.file, i < lines.size() ? lines[i] : tick.place.line};
    first_tick = tick.number;
    first = "tick " + std::to_string(tick.number + 1) + ", " + place.text() + ": " + difference(then, again);
  }
}

EcuRerun::EcuRerun(const DriveNote& note, campaign::Trace* trace)
    : driver_(campaign::make_driver(note.planner, note.guarded, note.parameters, trace, trace)) {}

void EcuRerun::play(const RecordedTick& tick, Agreement& agreement) {
  for (int i = 0; i < tick.misses; ++i) driver_->inject_deadline_miss();
  answers_.clear();
  driver_->tick(tick.from_world, answers_);
  agreement.compare(tick, tick.from_ecu, answers_, tick.lines);
}

WorldRerun::WorldRerun(const DriveNote& note, const scenario::Scenario& scenario)
    : meeting_(note.meeting), world_(scenario, world_options(note)) {}

void WorldRerun::play(const RecordedTick& tick) {
  frames_.clear();
  if (!world_.finished()) world_.tick(frames_);
  agreement_.compare(tick, tick.from_world, frames_, {});
  std::vector<wire::Frame>& commands = commands_.emplace_back();
  for (const wire::Frame& frame : tick.from_ecu) {
    if (!reached_vehicle(frame, tick.number)) continue;
    world_.receive(frame);
    if (frame.id == wire::kCommandId) commands.push_back(frame);
  }
}

bool WorldRerun::reached_vehicle(const wire::Frame& frame, std::uint64_t tick) {
  if (meeting_ == Meeting::kInProcess) return true;
  const unsigned oldest = meeting_ == Meeting::kRealTime ? nodes::kOldestEcho : 0U;
  const bool reached = frame.id == wire::kCommandId &&
                       nodes::answers_tick(frame, static_cast<unsigned>(tick + 1), oldest, !answered_);
  answered_ = answered_ || reached;
  return reached;
}

}  // namespace s4tp::recording
