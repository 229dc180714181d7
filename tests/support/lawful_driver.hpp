#pragma once
/// One who does the worst to us that the law leaves it, along a line. The law is written here again, by method.md
/// 4.9's words.

#include <algorithm>
#include <random>

#include "tests/support/shared_ground.hpp"

namespace s4tp::test {

inline float drawn_between(std::mt19937& random, float low, float high) {
  return std::uniform_real_distribution<float>(low, high)(random);
}

/// Motion along a line; 5 m long, `s_m` is the box centre.
struct Mover {
  float s_m = 0.0F;
  float speed_mps = 0.0F;
  float acceleration_mps2 = 0.0F;

  void drive(float wanted_mps2, float duration_s, float top_mps) {
    float next_mps = std::max(0.0F, speed_mps + wanted_mps2 * duration_s);
    if (wanted_mps2 > 0.0F) next_mps = std::min(next_mps, std::max(top_mps, speed_mps));
    s_m += 0.5F * (speed_mps + next_mps) * duration_s;
    acceleration_mps2 = (next_mps - speed_mps) / duration_s;
    speed_mps = next_mps;
  }
};

inline constexpr float kTickS = 0.05F;
inline constexpr float kTopMps = 1.1F * kLimitMps;
inline constexpr float kEntryM = 96.0F;  // of SharedGround's zone, on both ways
inline constexpr float kExitM = 104.0F;

/// What a driver goes by.
struct SeenEgo {
  const Mover& ego;
  float time_s;
  bool merging;     ///< the ego comes into its lane, and does not cross it
  float entered_s;  ///< when the ego came into the zone; < 0: it has not
  bool left_out;    ///< of the ego's lists
};

/// One who shares ground with us, or leads us.
struct Lawful {
  Mover motion;
  bool leads = false;  ///< in our own lane
  bool was_left_out = false;
  float known_s = 0.0F;
  float stood_s = 0.0F;
  // Random and bang-bang.
  float wanted_mps2 = 0.0F;
  float until_s = 0.0F;
  // What it owes us now, braking up to `owed_mps2` from `owed_from_s` on; 0: nothing.
  float owed_mps2 = 0.0F;
  float owed_from_s = 0.0F;
  bool stays = false;  ///< stands, and lets us pass

  [[nodiscard]] float to_entry_m() const { return kEntryM - motion.s_m; }
  /// Gaining speed as fast as the law allows for 1.5 s, it still stops half a metre before the zone with 2
  /// m/s^2.
  [[nodiscard]] bool can_be_asked() const {
    Mover fastest = motion;
    for (int i = 0; i < 150; ++i) fastest.drive(2.0F, 0.01F, kTopMps);
    const float room_m = kEntryM - 0.5F - fastest.s_m;
    return room_m > 0.0F && fastest.speed_mps * fastest.speed_mps <= 4.0F * room_m;
  }

  /// D1, where we have priority: who could give way after what is left of its second does, and gains no speed until
  /// then.
  void answer() {
    const float left_s = std::max(0.0F, 1.0F - known_s);
    const float room_m = to_entry_m() - motion.speed_mps * left_s;
    if (!leads && room_m > 0.0F && motion.speed_mps * motion.speed_mps <= 8.0F * room_m) owed_mps2 = 4.0F;
  }

  /// A tick of anything that it does not owe us to leave. \param in_front  whom it follows; null: nobody
  void drive(const SeenEgo& seen, const Lawful* in_front, std::mt19937& random) {
    const Mover& ego = seen.ego;
    const auto between = [&](float low, float high) { return drawn_between(random, low, high); };
    const auto chance = [&](float share) { return between(0.0F, 1.0F) < share; };
    if (seen.time_s >= until_s) {
      until_s = seen.time_s + (chance(0.3F) ? kTickS : between(0.1F, 3.0F));
      const float kind = between(0.0F, 1.0F);
      wanted_mps2 = kind < 0.4F ? 2.0F : kind < 0.6F ? -8.0F : kind < 0.7F ? 0.0F : between(-8.0F, 2.0F);
    }
    float now_mps2 = wanted_mps2;
    const auto stops_before = [&](float place_m, float braking_mps2) {
      // It waits until braking is due, and then brakes as hard as that takes, and no less than it must.
      Mover next = motion;
      next.drive(now_mps2, kTickS, kTopMps);
      const float room_m = place_m - next.s_m;
      if (room_m > 0.0F && next.speed_mps * next.speed_mps <= 2.0F * braking_mps2 * room_m) return;
      const float left_m = std::max(place_m - motion.s_m, 0.01F);
      const float needed_mps2 = motion.speed_mps * motion.speed_mps / (2.0F * left_m);
      now_mps2 = std::min(now_mps2, -std::max(braking_mps2, needed_mps2));
    };
    const bool gone = ego.s_m > kExitM;
    if (!leads && !gone) {
      if (stays) now_mps2 = -8.0F;
      if (owed_mps2 > 3.0F && known_s < 1.0F) {
        now_mps2 = std::min(now_mps2, 0.0F);
      } else if (motion.s_m < kEntryM && owed_mps2 > 0.0F && seen.time_s >= owed_from_s)
        stops_before(kEntryM - 0.01F, owed_mps2);
    }
    if (in_front != nullptr) {
      const float front_mps = in_front->motion.speed_mps;
      stops_before(in_front->motion.s_m - 5.5F + front_mps * front_mps / 16.0F, 8.0F);
    }
    // Whoever has been in its lane ahead of it for a second is not driven into, if 4 m/s^2 do.
    if (seen.merging && !leads && seen.entered_s >= 0.0F && seen.time_s >= seen.entered_s + 1.0F &&
        motion.s_m < ego.s_m) {
      const float slower_mps = std::max(0.0F, motion.speed_mps - ego.speed_mps);
      const float gap_m = ego.s_m - motion.s_m - 5.05F;
      const bool braking = ego.acceleration_mps2 < 0.0F;
      if (slower_mps * slower_mps >= 8.0F * (gap_m - 0.05F * slower_mps - 0.1F) || gap_m < 0.3F)
        now_mps2 = std::min(now_mps2, braking ? -8.0F : -4.0F);
    }
    // Whoever is left out keeps to the limit.
    motion.drive(now_mps2, kTickS, seen.left_out ? kLimitMps : kTopMps);
  }
};

}  // namespace s4tp::test
