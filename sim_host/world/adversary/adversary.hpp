#pragma once
/// The legal adversary: the built-in traffic, whose drivers do to the ego the worst that the law leaves them
/// (judge/law.hpp; docs/method.md 4.9). It says nothing of how well a planner drives; what it shows is
/// that nobody is touched by the ego's fault.
///
/// | towards                                     | a driver                                               |
/// |---------------------------------------------|--------------------------------------------------------|
/// | each other                                  | drives as in the built-in traffic, never distracted    |
/// | the ego ahead since long                    | keeps the RSS gap to the centimetre (D4)               |
/// | the ego that has just come into the lane    | answers after the whole reaction time, with the duty's |
/// |                                             | braking (D2), or not at all where that does not do     |
/// | the ego on a zone by right, or bound for it | the same before the zone (D2), having let it, or come  |
/// |                                             | into the world since                                   |
/// | the ego on a zone, gone in without          | drives on                                              |
/// | a zone where the ego has priority           | goes in by licence (D1), and takes every one; in its   |
/// |                                             | group already, stops before it where it still can      |
/// | a zone where the first comes                | goes in unless the ego is there                        |
/// | a lane beside the ego                       | changes into it where RSS gaps are left (D3)           |
///
/// What a driver does within these bounds: driver_choice.hpp.
/// LAW-043 Nobody comes into the world where that leaves less than the RSS gap behind an ego, in whatever lane beside.

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>

#include "sim_host/world/adversary/driver_choice.hpp"
#include "sim_host/world/adversary/lawful.hpp"
#include "sim_host/world/judge/standing.hpp"
#include "sim_host/world/traffic/traffic.hpp"

namespace s4tp::adversary {

/// The judge's law, with what the ECU counts on as the most that others gain and drive (docs/safety.md).
[[nodiscard]] judge::Law promised_law();

class Traffic final : public traffic::Traffic {
 public:
  Traffic(const scenario::Scenario& scenario, std::uint64_t episode, std::uint64_t seed,
          const judge::Law& law = promised_law());
  [[nodiscard]] std::unique_ptr<traffic::TrafficEngine> clone() const override;

 private:
  /// What one driver keeps in mind from one decision to the next.
  struct Mind {
    double stood_s = 0.0;
    double ego_ahead_s = -1.0;  ///< since when the ego has been the one ahead; < 0: it is not
    bool owes_ahead = false;    ///< and is bound to brake for it
    bool owes_zone = false;     ///< is bound to keep off the zones that the ego takes
    double owes_since_s = 0.0;
    Mood mood;
  };
  /// The ego on its own way.
  struct Watched {
    traffic::Actor actor;  ///< with its way
    std::vector<judge::ZoneGroup> groups;
    int inside = -1;  ///< which of them the ego is on; < 0: none
    int taken = -1;   ///< the first that it is on, or cannot stop before as D1 asks any more (LAW-005)
  };

  void decide(const traffic::Actor* ego) override;
  [[nodiscard]] bool may_change(const traffic::Car& car, const traffic::WayPart& beside) const override;
  [[nodiscard]] bool may_come_in(const traffic::Car& car) const override;
  /// Whether one leaves the ego what it owes in all lanes where that may be by then: it may come over, and a change begun is not
  /// given up. \param leaves  asked of the two alone on the road, the ego first
  [[nodiscard]] bool leaves_wherever(const traffic::Actor& self,
                                     const std::function<bool(const traffic::TrafficView&)>& leaves) const;

  void watch(const traffic::Actor& ego, const traffic::TrafficView& others);
  /// Who is bound by the ego's taking a group: whose licence it has, until it is on it.
  void bind(const judge::ZoneGroup& group, const traffic::TrafficView& others);
  [[nodiscard]] bool ego_is_licensed(const judge::ZoneOnWay& zone, const traffic::Actor& other,
                                     const Mind& mind) const;
  [[nodiscard]] std::vector<Obstacle> obstacles_of(const traffic::Car& car, const traffic::Actor& self,
                                                   Mind& mind) const;
  void ego_ahead(const traffic::Car& car, const traffic::Actor& self, Mind& mind,
                 std::vector<Obstacle>& all) const;
  void zones_ahead(const traffic::Car& car, const traffic::Actor& self, const Mind& mind,
                   std::vector<Obstacle>& all) const;
  [[nodiscard]] bool may_enter(const traffic::Actor& self, const Mind& mind, double to_group_m,
                               const judge::ZoneOnWay& zone, double ego_entry_m, double ego_exit_m) const;
  [[nodiscard]] double limit_mps(map::LaneId lane) const { return this->lane(lane).speed_limit_mps; }

  judge::Law law_;
  std::map<int, Mind> minds_;
  std::optional<Watched> ego_;
  double ego_shown_s_ = 0.0;  ///< its nose has been near the group ahead
  double ego_stood_s_ = 0.0;
  double ego_driven_m_ = 0.0;
  double taken_until_m_ = 0.0;  ///< of that way: where the group taken last ends
  bool taken_entered_ = false;
};

}  // namespace s4tp::adversary
