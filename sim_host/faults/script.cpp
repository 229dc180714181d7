#include "sim_host/faults/script.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <sstream>
#include <stdexcept>

#include "firmware/wire/codec.hpp"
#include "sim_host/faults/lies.hpp"
#include "sim_host/world/traffic/random.hpp"

namespace s4tp::faults {
namespace {

constexpr std::array<MessageName, kMessageCount> kMessages{{
    {"Motion", wire::kMotionId},
    {"Steering", wire::kSteeringId},
    {"Pose", wire::kPoseId},
    {"Tick", wire::kTickId},
    {"TrackList", wire::kTrackListId},
    {"TrackPose", wire::kTrackPoseId},
    {"TrackMotion", wire::kTrackMotionId},
    {"MapHeader", wire::kMapHeaderId},
    {"MapSlots", wire::kMapSlotsId},
    {"LaneHeader", wire::kLaneHeaderId},
    {"LaneRoute", wire::kLaneRouteId},
    {"LaneLinks", wire::kLaneLinksId},
    {"LanePoint", wire::kLanePointId},
    {"ConflictFirst", wire::kConflictFirstId},
    {"ConflictSecond", wire::kConflictSecondId},
    {"MapOrigin", wire::kMapOriginId},
    {"VersionWorld", wire::kVersionWorldId},
    {"Command", wire::kCommandId},
}};

constexpr MessageSet kCommand = 1U << 17U;
constexpr MessageSet kFromWorld = kCommand - 1U;
constexpr MessageSet kMotion = 1U << 0U;
constexpr MessageSet kSteering = 1U << 1U;
constexpr MessageSet kPose = 1U << 2U;
constexpr MessageSet kVehicle = 0xFU;
constexpr MessageSet kPerception = 0x7U << 4U;
constexpr MessageSet kMap = 0x3FFU << 7U;
constexpr MessageSet kTrackList = 1U << 4U;

// In the order of FaultKind.
constexpr std::array<KindTraits, kFaultKinds> kKinds{{
    {"loss", kFromWorld | kCommand, 1, 100, false, "percent of the frames lost"},
    {"delay", kFromWorld | kCommand, 1, 40, false, "each frame up to so many ticks late"},
    {"duplicate", kFromWorld | kCommand, 1, 100, false, "percent of the frames sent twice"},
    {"reorder", kFromWorld, 1, 100, false, "percent of the ticks whose frames come in any order"},
    {"corrupt", kFromWorld | kCommand, 1, 100, false, "percent of the frames damaged or cut short"},
    {"bus_off", 0, 0, 2, false, "0 off, 1 down, 2 error-passive"},
    {"burst", 0, 1, 700, false, "foreign frames a tick, before or after the world's"},
    {"babble", kFromWorld, 1, 60, true, "frames a tick with random content, valid CRC, ids of ours"},
    {"early_motion", kMotion | kTrackList, 3, 15, true, "ms each interval is too short"},
    {"late_motion", kMotion | kTrackList, 3, 200, true, "ms each interval is too long"},
    {"clock_jump", kMotion | kTrackList, -32000, 32000, true, "ms all stamps are off"},
    {"dead_map", kMap, 0, 0, false, "-"},
    {"dead_perception", kPerception, 0, 0, false, "-"},
    {"dead_vehicle", kVehicle, 0, 0, false, "-"},
    {"stuck", kFromWorld, 0, 1, true, "0 values, with Motion's time running; 1 all but counter and CRC"},
    {"pattern", kFromWorld, 0, 6, true,
     "0 zeros, 1 ones, 2 most negative, 3 most positive, 4 quiet NaN, 5 infinity, 6 denormal"},
    {"long_list", kPerception | kMap, 0, 4, true,
     "0 count beyond 16, 1 sixteen nonsense tracks, 2 members beyond the count, 3 map counts beyond 64 and "
     "128, 4 lane points beyond 12"},
    {"late_plan", 0, 1, 100, false, "percent of the boundaries that find the planner busy"},
    {"lie", kMotion | kSteering | kPose | kTrackList, 0, kLies - 1, true, "which one: lies.hpp, in order"},
}};

MessageSet choose_messages(traffic::Random& random, MessageSet allowed) {
  if (allowed == 0) return 0;
  if (random.uniform() < 0.2) return allowed;
  MessageSet chosen = 0;
  const int wanted = random.integer(1, 3);
  for (int i = 0; i < wanted || chosen == 0; ++i) {
    const MessageSet one = 1U << static_cast<unsigned>(random.integer(0, kMessageCount - 1));
    chosen |= one & allowed;
  }
  return chosen;
}

/// Small, middling and extreme ones equally often.
int choose_intensity(traffic::Random& random, const KindTraits& kind) {
  if (kind.intensity_min >= 0 && kind.intensity_max <= 6) {
    return random.integer(kind.intensity_min, kind.intensity_max);
  }
  const int extreme = random.integer(0, 3);
  if (extreme == 0) return random.integer(0, 1) == 0 ? kind.intensity_min : kind.intensity_max;
  if (extreme == 1) return random.integer(kind.intensity_min, kind.intensity_max);
  const int span = std::max(1, (kind.intensity_max - kind.intensity_min) / 20);
  const int middle = kind.intensity_min < 0 ? 0 : kind.intensity_min + span;
  return random.integer(middle - span, middle + span);
}

int choose_ticks(traffic::Random& random) {
  const double kind = random.uniform();
  if (kind < 0.3) return random.integer(1, 10);
  if (kind < 0.65) return random.integer(10, 100);
  if (kind < 0.9) return random.integer(100, 300);
  return kForGood;
}

Fault make_fault(traffic::Random& random) {
  Fault fault;
  fault.kind = static_cast<FaultKind>(random.integer(0, kFaultKinds - 1));
  const KindTraits& kind = traits(fault.kind);
  const bool whole_node = fault.kind == FaultKind::kDeadMap || fault.kind == FaultKind::kDeadPerception ||
                          fault.kind == FaultKind::kDeadVehicle || fault.kind == FaultKind::kLongList ||
                          fault.kind == FaultKind::kLie;
  fault.messages = whole_node ? kind.messages : choose_messages(random, kind.messages);
  fault.intensity = choose_intensity(random, kind);
  fault.from_tick = random.integer(-kPreRollTicks, 500);
  fault.ticks = choose_ticks(random);
  fault.dice = static_cast<std::uint32_t>(random.integer(0, 999'999));
  return fault;
}

std::string names_of(MessageSet set) {
  if (set == 0) return "-";
  std::string names;
  for (int i = 0; i < kMessageCount; ++i) {
    if (((set >> i) & 1U) != 0U) names += (names.empty() ? "" : ",") + std::string(message(i).name);
  }
  return names;
}

/// Reads a script line by line, and says where it does not understand one.
class Parser {
 public:
  Parser(const std::string& text, std::string source) : lines_(text), source_(std::move(source)) {}

  FaultScript parse() {
    FaultScript script;
    bool has_scenario = false;
    std::string line;
    while (std::getline(lines_, line)) {
      ++number_;
      std::istringstream words(line.substr(0, line.find('#')));
      std::string key;
      if (!(words >> key)) continue;
      if (key == "seed") {
        script.seed = number<std::uint64_t>(words, key, 0, UINT64_MAX);
      } else if (key == "scenario") {
        script.scenario = word(words, "the scenario's name");
        has_scenario = true;
      } else if (key == "tick") {
        const std::string source = word(words, "timer or lockstep");
        if (source != "timer" && source != "lockstep") fail("tick " + source + ": timer or lockstep");
        script.tick = source == "timer" ? TickSource::kTimer : TickSource::kLockstep;
      } else if (key == "fault") {
        script.faults.push_back(fault(words));
      } else {
        fail("'" + key + "': seed, scenario, tick or fault begins a line");
      }
      std::string more;
      if (words >> more) fail("'" + more + "' is too much");
    }
    if (!has_scenario) fail("a line 'scenario NAME' is missing");
    return script;
  }

 private:
  [[noreturn]] void fail(std::string what) const {
    // A zero would end the message, an escape reach the terminal.
    std::replace_if(
        what.begin(), what.end(), [](unsigned char c) { return c < ' ' || c > '~'; }, '?');
    throw std::runtime_error(source_ + ":" + std::to_string(number_) + ": " + what);
  }

  std::string word(std::istringstream& words, const std::string& wanted) const {
    std::string result;
    if (!(words >> result)) fail("expected " + wanted + " at the end of the line");
    return result;
  }

  void expect(std::istringstream& words, const std::string& wanted) const {
    const std::string found = word(words, "'" + wanted + "'");
    if (found != wanted) fail("'" + found + "' where '" + wanted + "' is expected");
  }

  template <typename Integer>
  Integer number(std::istringstream& words, const std::string& name, Integer low, Integer high) const {
    const std::string text = word(words, "a number");
    Integer value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || value < low || value > high) {
      fail(name + " " + text + ": a whole number from " + std::to_string(low) + " to " +
           std::to_string(high) + " is accepted");
    }
    return value;
  }

  MessageSet messages(std::istringstream& words, const KindTraits& kind) const {
    const std::string list = word(words, "names of messages");
    if (list == "-") return 0;
    MessageSet set = 0;
    std::istringstream names(list);
    for (std::string name; std::getline(names, name, ',');) {
      const auto* const found = std::find_if(kMessages.begin(), kMessages.end(),
                                             [&](const MessageName& one) { return name == one.name; });
      const MessageSet one =
          found == kMessages.end() ? 0U : 1U << static_cast<unsigned>(found - kMessages.begin());
      if ((one & kind.messages) == 0U) {
        fail(std::string(kind.name) + " on '" + name + "': accepted are " + names_of(kind.messages));
      }
      set |= one;
    }
    return set;
  }

  Fault fault(std::istringstream& words) const {
    Fault fault;
    const std::string name = word(words, "the kind of fault");
    const auto* const found =
        std::find_if(kKinds.begin(), kKinds.end(), [&](const KindTraits& one) { return name == one.name; });
    if (found == kKinds.end()) {
      std::string known;
      for (const KindTraits& one : kKinds) known += std::string(" ") + one.name;
      fail("no fault '" + name + "'; there are:" + known);
    }
    fault.kind = static_cast<FaultKind>(found - kKinds.begin());
    expect(words, "from");
    fault.from_tick = number(words, "from", -kPreRollTicks, kRunTicks);
    expect(words, "for");
    fault.ticks = number(words, "for", 1, kForGood);
    expect(words, "messages");
    fault.messages = messages(words, *found);
    expect(words, "intensity");
    fault.intensity = number(words, "intensity", found->intensity_min, found->intensity_max);
    expect(words, "dice");
    fault.dice = number<std::uint32_t>(words, "dice", 0, UINT32_MAX);
    return fault;
  }

  std::istringstream lines_;
  std::string source_;
  int number_ = 0;
};

}  // namespace

const MessageName& message(int index) {
  return kMessages.at(static_cast<std::size_t>(index));
}

int find_message(std::uint32_t id) {
  for (int i = 0; i < kMessageCount; ++i) {
    if (message(i).id == id) return i;
  }
  return -1;
}

bool contains(MessageSet set, std::uint32_t id) {
  const int index = find_message(id);
  return index >= 0 && ((set >> index) & 1U) != 0U;
}

const KindTraits& traits(FaultKind kind) {
  return kKinds.at(static_cast<std::size_t>(kind));
}

bool honest(const FaultScript& script) {
  return std::none_of(script.faults.begin(), script.faults.end(),
                      [](const Fault& fault) { return traits(fault.kind).lies; });
}

FaultScript make_script(std::uint64_t seed, const std::vector<std::string>& scenarios) {
  traffic::Random random(seed ^ 0xFA17ULL);
  FaultScript script;
  script.seed = seed;
  script.scenario = scenarios.at(seed % scenarios.size());
  script.tick = random.integer(0, 3) == 0 ? TickSource::kLockstep : TickSource::kTimer;
  const int count = random.integer(1, 6);
  for (int i = 0; i < count; ++i) script.faults.push_back(make_fault(random));
  return script;
}

std::string to_text(const Fault& fault) {
  std::ostringstream text;
  text << "fault " << traits(fault.kind).name << " from " << fault.from_tick << " for " << fault.ticks
       << " messages " << names_of(fault.messages) << " intensity " << fault.intensity << " dice "
       << fault.dice;
  return text.str();
}

std::string to_text(const FaultScript& script) {
  std::string text = "seed " + std::to_string(script.seed) + "\nscenario " + script.scenario + "\ntick " +
                     (script.tick == TickSource::kTimer ? "timer" : "lockstep") + "\n";
  for (const Fault& fault : script.faults) text += to_text(fault) + "\n";
  return text;
}

FaultScript parse_script(const std::string& text, const std::string& source) {
  return Parser(text, source).parse();
}

}  // namespace s4tp::faults
