/// Writes a candump log of every message and, beside it, what our own codec reads in it: for
/// wire_log_check.py.
///
///     wire_log LOG VALUES       a line of VALUES: message, signal=value ... for the frame of the same line
///     of LOG

#include <charconv>
#include <cmath>
#include <fstream>
#include <random>
#include <string>

#include "firmware/wire/candump.hpp"
#include "firmware/wire/codec.hpp"
#include "firmware/wire/e2e.hpp"
#include "firmware/wire/generated/s4tp_fields.hpp"
#include "firmware/wire/version.hpp"

namespace {

using namespace s4tp::wire;

constexpr int kFramesOfEach = 50;

/// Enough digits to tell any two floats apart.
std::string exact(auto value) {
  char text[64];
  const auto end = std::to_chars(text, text + sizeof text, value).ptr;
  return {text, end};
}

bool has_counter(std::uint32_t id) {
  switch (id) {
    case kTrackPoseId:
    case kTrackMotionId:
    case kMapSlotsId:
    case kLaneHeaderId:
    case kLaneRouteId:
    case kLaneLinksId:
    case kLanePointId:
    case kConflictFirstId:
    case kConflictSecondId:
      return false;
    default:
      return true;
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  std::ofstream log(argv[1]);
  std::ofstream values(argv[2]);
  std::mt19937 random(1);
  LoggedFrame logged{1'700'000'000'000'000, "can0", {}};
  bool good = true;
  for_each_message([&](auto message) {
    E2eSender sender;
    for (int i = 0; i < kFramesOfEach; ++i) {
      for_each_field(message, [&](const FieldInfo& info, auto& field) {
        const double share = std::uniform_real_distribution<double>(0.0, 1.0)(random);
        const double steps = std::floor(share * (info.maximum - info.minimum) / info.step);
        field = static_cast<std::remove_reference_t<decltype(field)>>(info.minimum + steps * info.step);
      });
      good = good && encode(message, logged.frame);
      if (has_counter(logged.frame.id)) {
        sender.protect(logged.frame);
      } else {
        e2e_seal(logged.frame);
      }
      good = good && decode(logged.frame, message);
      char line[kCandumpLineSize];
      static_cast<void>(format_candump(logged, line));
      log << line << '\n';
      values << message_name(logged.frame.id);
      for_each_field(message, [&](const FieldInfo& info, auto field) {
        values << ' ' << info.name << '=' << exact(field);
      });
      values << '\n';
      logged.time_us += 1234;
    }
  });
  return good && log.flush() && values.flush() ? 0 : 1;
}
