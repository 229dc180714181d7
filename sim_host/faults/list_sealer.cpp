#include "sim_host/faults/list_sealer.hpp"

#include <algorithm>
#include <cstddef>

#include "firmware/wire/codec.hpp"
#include "firmware/wire/e2e.hpp"
#include "firmware/wire/track_list.hpp"

namespace s4tp::faults {
namespace {

using wire::Frame;

bool intact(const Frame& frame) {
  return frame.length == 8 && wire::e2e_crc_fits(frame);
}

bool is_member(const Frame& frame) {
  return frame.id == wire::kTrackPoseId || frame.id == wire::kTrackMotionId;
}

/// \return whether `list`, a header and members, has become whole and is sealed
bool seal(std::vector<Frame>& list) {
  wire::TrackList header;
  if (!wire::decode(list[0], header)) return false;
  wire::TrackMembers members;
  unsigned poses = 0;
  unsigned motions = 0;
  for (std::size_t i = 1; i < list.size(); ++i) {
    const unsigned index = list[i].data[1] >> 4U;
    const bool pose = list[i].id == wire::kTrackPoseId;
    (pose ? poses : motions) |= 1U << index;
    std::copy_n(list[i].data, 8, pose ? members.poses[index] : members.motions[index]);
  }
  const unsigned all = (1U << header.count) - 1U;
  if ((poses & all) != all || (motions & all) != all) return false;
  const std::uint8_t counter = list[0].data[1] & 0x0FU;
  header.digest = wire::list_digest(members, header.count);
  if (!wire::encode(header, list[0])) return false;
  list[0].data[1] = static_cast<std::uint8_t>((list[0].data[1] & 0xF0U) | counter);
  wire::e2e_seal(list[0]);
  return true;
}

}  // namespace

void ListSealer::release(std::vector<Frame>& frames) {
  frames.insert(frames.end(), held_.begin(), held_.end());
  held_.clear();
}

void ListSealer::pass(bool lying, std::vector<Frame>& frames) {
  std::vector<Frame> result;
  if (!lying) release(result);
  for (const Frame& frame : frames) {
    if (lying && frame.id == wire::kTrackListId && intact(frame)) {
      release(result);
      held_ = {frame};
    } else if (!held_.empty() && is_member(frame) && intact(frame)) {
      held_.push_back(frame);
    } else {
      result.push_back(frame);
      continue;
    }
    if (seal(held_)) release(result);
  }
  frames = result;
}

}  // namespace s4tp::faults
