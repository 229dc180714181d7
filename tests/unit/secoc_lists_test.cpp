// Track lists through the bus decorator of firmware/secoc: a list that lacks something, is old, or is of another
// session is not handed on, nor is any part of it.
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "firmware/wire/codec.hpp"
#include "tests/support/secoc_can.hpp"

namespace s4tp::secoc {
namespace {

struct SecocLists : SecocCan {
  /// These frames as the world's end says them, their companion last; they do not reach the ECU.
  Frames said(const Frames& frames) { return protected_ones(on_the_bus(frames)); }
  Frames said(int tracks, int seed) { return said(list(tracks, seed)); }
  Frames handed_on(const Frames& frames) { return protected_ones(reaches_ecu(frames)); }
  /// Whether the whole list is handed on, and nothing else.
  bool comes_out(const Frames& list) { return is_list(handed_on(list), list); }
  static bool is_list(const Frames& got, const Frames& list) {
    return got.size() + 1 == list.size() && std::is_permutation(got.begin(), got.end(), list.begin(), same);
  }
  std::uint32_t refused() const { return rig.ecu.can->tally().refused; }
};

Frames joined(Frames first, const Frames& second) {
  first.insert(first.end(), second.begin(), second.end());
  return first;
}
Frames without(Frames frames, std::size_t missing) {
  frames.erase(frames.begin() + static_cast<std::ptrdiff_t>(missing));
  return frames;
}
Frames bare(const Frames& list) {
  return without(list, list.size() - 1);
}
/// The header as a stranger would have it: of another time.
void stamp(wire::Frame& frame, std::uint16_t vehicle_time_ms) {
  wire::TrackList header;
  ASSERT_TRUE(wire::decode(frame, header));
  header.vehicle_time_ms = vehicle_time_ms;
  ASSERT_TRUE(wire::encode(header, frame));
  wire::e2e_seal(frame);
}

// AUTH-006 A controller that repeats frames, or sends the lower id first, takes nothing from a list.
TEST_F(SecocLists, RepeatedAndReorderedMembersDoNotMatter) {
  for (const int tracks : {0, 1, 16}) {
    const Frames sent = list(tracks, 3 + tracks);
    Frames bus = said(sent);
    ASSERT_EQ(bus.size(), sent.size() + 1);
    EXPECT_EQ(bus.back().id, wire::kTrackListAuthId);
    std::reverse(bus.begin() + 1, bus.end() - 1);
    bus.insert(bus.begin() + 1, wire::Frame(bus[0]));
    bus.insert(bus.end() - 1, wire::Frame(bus[bus.size() / 2]));
    const Frames got = reaches_ecu(bus);
    EXPECT_EQ(got.size(), sent.size());
    EXPECT_TRUE(std::is_sorted(got.begin(), got.end(),
                               [](const wire::Frame& a, const wire::Frame& b) { return a.id < b.id; }));
    for (const wire::Frame& frame : sent) {
      EXPECT_TRUE(
          std::any_of(got.begin(), got.end(), [&](const wire::Frame& one) { return same(one, frame); }));
    }
  }
}

// AUTH-005 A forged member slipped into a list: the list does not come out, nor does the member.
TEST_F(SecocLists, NothingOfAListWithAForgedMember) {
  Frames bus = said(3, 5);
  wire::Frame forged = bus[1];
  forged.data[3] ^= 1U;
  wire::e2e_seal(forged);
  bus.insert(bus.begin() + 2, forged);
  EXPECT_TRUE(handed_on(bus).empty());
  EXPECT_TRUE(comes_out(said(3, 6)));
}

// AUTH-005 Truncated: with any one of its frames missing, the header or a member, nothing of a list comes out;
// the next whole one does.
TEST_F(SecocLists, NothingOfAListThatLacksAFrame) {
  int seed = 10;
  for (const int tracks : {1, 16}) {
    const int frames = 1 + 2 * tracks;
    for (int missing = 0; missing < frames; ++missing) {
      const Frames bus = said(tracks, ++seed);
      ASSERT_EQ(bus.size(), static_cast<std::size_t>(frames) + 1);
      const std::uint32_t before = refused();
      EXPECT_TRUE(handed_on(without(bus, static_cast<std::size_t>(missing))).empty()) << missing;
      EXPECT_EQ(refused(), before + 1) << missing;
    }
    EXPECT_TRUE(comes_out(said(tracks, ++seed)));
  }
}

// AUTH-005 A list does not come out without its companion: not when the next list begins, nor with the
// companion of that, nor with its own once the next has begun. The next comes out with its own all the same.
TEST_F(SecocLists, NothingOfAListWhoseCompanionIsLost) {
  const Frames lost = said(3, 1);
  EXPECT_TRUE(handed_on(bare(lost)).empty());
  EXPECT_TRUE(comes_out(said(2, 2)));
  EXPECT_TRUE(handed_on({lost.back()}).empty());

  const Frames first = said(3, 3);
  const Frames second = said(3, 4);
  EXPECT_TRUE(handed_on(bare(first)).empty());
  EXPECT_TRUE(handed_on({second.back()}).empty());
  EXPECT_TRUE(handed_on(bare(second)).empty());
  EXPECT_TRUE(handed_on({first.back()}).empty());
  EXPECT_TRUE(is_list(handed_on({second.back()}), second));
}

// AUTH-005 A list with the companion of another, said before it or behind it, or with members of another:
// nothing comes out.
TEST_F(SecocLists, NothingOfAListWithAnothersCompanion) {
  const Frames lists_said[] = {said(3, 21), said(3, 22), said(3, 23)};
  for (const Frames& list : lists_said) {
    for (const Frames& other : lists_said) {
      if (&list == &other) continue;
      Frames mixed = list;
      mixed.back() = other.back();
      EXPECT_TRUE(handed_on(mixed).empty());
      mixed = list;
      mixed[1] = other[1];
      EXPECT_TRUE(handed_on(mixed).empty());
    }
  }
  EXPECT_TRUE(comes_out(said(3, 24)));
}

// AUTH-004, AUTH-005 Whole authentic lists said again, each for itself, in a row, in reverse, and under a new
// header with the time of now: none comes out a second time, though generation (16) and counter (15) have come
// round among them.
TEST_F(SecocLists, NothingOfAReplayedList) {
  std::vector<Frames> recorded;
  Frames all;
  for (int seed = 1; seed <= 40; ++seed) {
    recorded.push_back(said(seed % 5, seed));
    ASSERT_TRUE(comes_out(recorded.back())) << seed;
    all = joined(all, recorded.back());
  }
  const std::uint32_t before = refused();
  for (const Frames& list : recorded) EXPECT_TRUE(handed_on(list).empty());
  EXPECT_TRUE(handed_on(all).empty());
  std::reverse(recorded.begin(), recorded.end());
  for (Frames& list : recorded) {
    EXPECT_TRUE(handed_on(list).empty());
    stamp(list.front(), 4100);
    EXPECT_TRUE(handed_on(list).empty());
  }
  EXPECT_EQ(refused(), before + 160U) << "each companion, each time";
  EXPECT_TRUE(comes_out(said(3, 41)));
}

// AUTH-004 Reordered: an older authentic list that the ECU has never had does not come out behind a newer one,
// nor when the newer one comes in the middle of it.
TEST_F(SecocLists, NothingOfAnOlderListAfterANewer) {
  for (int seed = 50; seed < 70; seed += 2) {
    const Frames older = said(4, seed);
    const Frames newer = said(seed % 5, seed + 1);
    ASSERT_TRUE(comes_out(newer)) << seed;
    EXPECT_TRUE(handed_on(older).empty()) << seed;
  }
  const Frames older = said(4, 80);
  const Frames newer = said(4, 81);
  Frames among = older;
  among.insert(among.begin() + 3, newer.begin(), newer.end());
  EXPECT_TRUE(is_list(handed_on(among), newer)) << "the newer one, and nothing of the older";
}

// AUTH-010 Lists of an earlier session, whichever end has restarted since: none comes out, though the new
// session has had no list and so their freshness values are above its last one.
TEST_F(SecocLists, NothingOfAnEarlierSession) {
  for (int restarted = 1; restarted < 4; ++restarted) {
    std::vector<Frames> recorded;
    for (int seed = 1; seed <= 20; ++seed) recorded.push_back(said(3, seed));
    EXPECT_TRUE(comes_out(recorded.front()));
    if ((restarted & 1) != 0) rig.ecu.restart();
    if ((restarted & 2) != 0) rig.world.restart();
    ASSERT_GE(rig.until_both_ways(), 0) << restarted;
    const std::uint32_t before = refused();
    for (const Frames& list : recorded) EXPECT_TRUE(handed_on(list).empty()) << restarted;
    EXPECT_EQ(refused(), before + 20U) << restarted;
    EXPECT_TRUE(comes_out(said(3, 21))) << restarted;
  }
}

}  // namespace
}  // namespace s4tp::secoc
