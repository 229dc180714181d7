#include "algo/scene/track_memory.hpp"

#include "algo/core/inline.hpp"
#include "algo/core/input_ranges.hpp"
#include "algo/core/vehicle_time.hpp"

namespace s4tp::scene {
namespace {

constexpr std::int32_t kMissingMs = 1000;    // a vehicle that fresh lists lack
constexpr std::int32_t kLongestMs = 60'000;  // that a duration counts, and that anybody stays without lists
constexpr float kSameVehicleM = 2.0F;        // a new id this near a lost vehicle is that vehicle
constexpr float kSameSpeedMps = 4.0F;
constexpr float kJumpM = 8.0F;    // an id this far from where it should be is another vehicle
constexpr float kHinderS = 2.5F;  // a vehicle within this headway explains another's braking
constexpr float kHinderBesideM = 2.0F;
constexpr std::uint8_t kNobodysId = 255;

bool sound(const Track& track) {
  return abs(track.centre.x_m) < kFarthestInputM && abs(track.centre.y_m) < kFarthestInputM &&
         abs(track.centre.heading_rad) < kMostInputHeadingRad && is_finite(track.speed_mps) &&
         is_finite(track.acceleration_mps2) && is_finite(track.yaw_rate_radps) && is_finite(track.length_m) &&
         is_finite(track.width_m);
}

// Where a vehicle last seen as `track` is `seconds` later, roughly.
Point coasted(const Track& track, float seconds) {
  return offset_point(track.centre, track.speed_mps * seconds, 0.0F);
}

}  // namespace

void shift(History& history, int steps) {
  if (steps >= kHistorySamples) {
    history.valid = 0;
    return;
  }
  for (int i = 0; i + steps < kHistorySamples; ++i) history.samples[i] = history.samples[i + steps];
  history.valid = static_cast<std::uint16_t>(history.valid >> steps);
}

std::uint16_t bounded_ms(std::int32_t duration_ms) {
  return static_cast<std::uint16_t>(duration_ms < kLongestMs ? duration_ms : kLongestMs);
}

void TrackMemory::reset() {
  forget_all();
  listed_ = KnownGround{};
  last_list_ms_ = 0;
  id_clashes_ = 0;
  last_spare_id_ = 0;
}

void TrackMemory::shift_histories(int steps) {
  for (RememberedTrack& past : tracks) shift(past.history, steps);
}

void TrackMemory::forget_all() {
  tracks.clear();
  kept_ = KnownGround{};
}

int TrackMemory::find(const Track& track, std::uint32_t list_ms) const {
  for (int i = 0; i < tracks.size(); ++i) {
    if (tracks[i].track.id == track.id) return i;
  }
  for (int i = 0; i < tracks.size(); ++i) {
    const RememberedTrack& past = tracks[i];
    if (past.seen_ms == list_ms) continue;
    const float seconds = 1e-3F * static_cast<float>(elapsed_ms(past.seen_ms, list_ms));
    if (distance(coasted(past.track, seconds), position(track.centre)) < kSameVehicleM &&
        abs(past.track.speed_mps - track.speed_mps) < kSameSpeedMps) {
      return i;
    }
  }
  return -1;
}

std::uint8_t TrackMemory::spare_id(const TrackList& list) {
  const auto used = [&](std::uint8_t id) {
    bool found = id == kNobodysId;
    for (const Track& track : list) found = found || track.id == id;
    for (const RememberedTrack& past : tracks) found = found || past.track.id == id;
    return found;
  };
  do {  // at most twice kMaxTracks are used
    ++last_spare_id_;
  } while (used(last_spare_id_));
  return last_spare_id_;
}

void TrackMemory::add(const Track& track, bool nameless, std::uint32_t list_ms) {
  RememberedTrack past;
  past.track = track;
  past.nameless = nameless;
  past.seen_ms = list_ms;
  if (tracks.push(past)) return;
  float furthest_m = away_m(track, 0.0F);
  int furthest = -1;  // the new one itself
  for (int i = 0; i < tracks.size(); ++i) {
    const float seconds = 1e-3F * static_cast<float>(elapsed_ms(tracks[i].seen_ms, list_ms));
    const float its_m = away_m(tracks[i].track, seconds);
    if (its_m <= furthest_m) continue;
    furthest = i;
    furthest_m = its_m;
  }
  if (furthest >= 0) tracks[furthest] = past;
  if (kept_ms_ != list_ms) kept_ = KnownGround{};
  kept_ms_ = list_ms;
  kept_.radius_m = max(0.0F, min(kept_.radius_m, furthest_m));
  ++kept_.left_out;
}

KnownGround TrackMemory::known_ground(std::uint32_t time_ms) const {
  KnownGround known = listed_;
  if (kept_.left_out > 0) {
    known.radius_m = min(known.radius_m, kept_.radius_m);
    const int left_out = known.left_out + kept_.left_out;
    known.left_out = static_cast<std::uint8_t>(left_out < 255 ? left_out : 255);
  }
  const std::int32_t age_ms = elapsed_ms(last_list_ms_, time_ms);
  known.age_ms = bounded_ms(age_ms > 0 ? age_ms : 0);
  return known;
}

float list_distance_m(float distance_m, float relative_mps) {
  return distance_m - kListLeadS * relative_mps;
}

float TrackMemory::away_m(const Track& track, float coasted_s) const {
  const Point velocity = track.speed_mps * direction(track.centre.heading_rad);
  return list_distance_m(distance(coasted(track, coasted_s), listed_.centre),
                         norm(velocity - listed_.velocity));
}

void TrackMemory::take(const TrackList& list, std::uint32_t list_ms, Point centre, Point velocity) {
  listed_.centre = centre;
  listed_.velocity = velocity;
  listed_.left_out = list.left_out;
  listed_.radius_m = KnownGround::kEverywhereM;
  if (list.left_out > 0) {
    listed_.radius_m = 0.0F;
    for (const Track& track : list) {
      if (sound(track)) listed_.radius_m = max(listed_.radius_m, away_m(track, 0.0F));
    }
  }
  drop_unseen(list_ms);  // after a time without lists: they need their room for who is there now
  // An id that stands twice belongs to nobody: what is known of it is given up, and those who bear it are
  // other vehicles in each list.
  bool clashes[kMaxTracks] = {};
  id_clashes_ = 0;
  for (int i = 0; i < list.size(); ++i) {
    for (int k = 0; k < list.size(); ++k) clashes[i] = clashes[i] || (k != i && list[k].id == list[i].id);
    if (clashes[i]) ++id_clashes_;
  }
  for (int i = tracks.size() - 1; i >= 0; --i) {
    bool gone = tracks[i].nameless;
    for (int k = 0; k < list.size(); ++k) gone = gone || (clashes[k] && list[k].id == tracks[i].track.id);
    if (gone) tracks.swap_remove(i);
  }
  // Known ids first, so that a new id cannot take the past of a vehicle that is still in the list.
  for (int pass = 0; pass < 2; ++pass) {
    for (int i = 0; i < list.size(); ++i) {
      if (!sound(list[i])) continue;
      Track track = limited(list[i]);
      if (clashes[i]) {
        if (pass == 0) continue;
        track.id = spare_id(list);
        add(track, true, list_ms);
        continue;
      }
      const int index = find(track, list_ms);
      const bool known = index >= 0 && tracks[index].track.id == track.id;
      if (known != (pass == 0)) continue;
      if (index >= 0) {
        RememberedTrack& past = tracks[index];
        const float seconds = 1e-3F * static_cast<float>(elapsed_ms(past.seen_ms, list_ms));
        if (distance(coasted(past.track, seconds), position(track.centre)) > kJumpM) {
          past.history.valid = 0;
          past.stood_ms = 0;
          past.known_ms = 0;
          past.lane = kNoLaneIndex;
        }
        past.track = track;
        past.seen_ms = list_ms;
        continue;
      }
      add(track, false, list_ms);
    }
  }
  last_list_ms_ = list_ms;
}

bool TrackMemory::in_anothers_place(const RememberedTrack& missing) const {
  if (missing.seen_ms == last_list_ms_) return false;
  const float seconds = 1e-3F * static_cast<float>(elapsed_ms(missing.seen_ms, last_list_ms_));
  const Point place = coasted(missing.track, seconds);
  for (const RememberedTrack& seen : tracks) {
    const float half_m = 0.5F * min(missing.track.length_m, seen.track.length_m);
    if (seen.seen_ms == last_list_ms_ && distance(position(seen.track.centre), place) < half_m) return true;
  }
  return false;
}

void TrackMemory::drop_unseen(std::uint32_t by_ms) {
  for (int i = tracks.size() - 1; i >= 0; --i) {
    if (elapsed_ms(tracks[i].seen_ms, by_ms) > kMissingMs) tracks.swap_remove(i);
  }
  if (elapsed_ms(kept_ms_, by_ms) > kMissingMs)
    kept_ = KnownGround{};  // for good: 2^31 ms on it would lie ahead
}

void TrackMemory::forget_lost(std::uint32_t time_ms, bool ego_stands) {
  const std::int32_t blind_ms = elapsed_ms(last_list_ms_, time_ms);
  const bool over = blind_ms > kLongestMs || (blind_ms > kMissingMs && ego_stands);
  drop_unseen(blind_ms <= kFreshMs || over ? time_ms : last_list_ms_);
  for (int i = tracks.size() - 1; i >= 0; --i) {
    if (in_anothers_place(tracks[i])) tracks.swap_remove(i);
  }
}

bool TrackMemory::hindered(const Track& track) const {
  const Point ahead = direction(track.centre.heading_rad);
  const float reach_m = kHinderS * track.speed_mps + 0.5F * track.length_m;
  for (const RememberedTrack& other : tracks) {
    const Point offset = position(other.track.centre) - position(track.centre);
    const float ahead_m = dot(ahead, offset);
    if (ahead_m > 0.0F && ahead_m < reach_m + 0.5F * other.track.length_m &&
        abs(cross(ahead, offset)) < kHinderBesideM) {
      return true;
    }
  }
  return false;
}

}  // namespace s4tp::scene
