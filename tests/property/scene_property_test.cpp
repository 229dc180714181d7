#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <cmath>
#include <cstring>
#include <random>

#include "algo/satp/predictor.hpp"
#include "algo/scene/scene_builder.hpp"
#include "tests/support/lane_maps.hpp"
#include "tests/support/scene_support.hpp"

namespace s4tp::satp {
namespace {

float uniform(std::mt19937& random, float low, float high) {
  return low + (high - low) * static_cast<float>(random() % 100001U) / 100000.0F;
}

/// A lane index that is often nonsense.
LaneIndex any_index(std::mt19937& random) {
  return static_cast<LaneIndex>(static_cast<int>(random() % 80U) - 8);
}

float any_float(std::mt19937& random, float usual) {
  switch (random() % 12U) {
    case 0:
      return std::numeric_limits<float>::quiet_NaN();
    case 1:
      return std::numeric_limits<float>::infinity();
    case 2:
      return -3.0e38F;
    default:
      return uniform(random, -usual, usual);
  }
}

/// Lanes of all lengths and shapes, cycles, bad indices, repeated vertices, and now and then bad numbers.
LaneMap garbage_map(std::mt19937& random) {
  LaneMap map;
  const bool wild = random() % 4U == 0;
  const unsigned lanes = 1U + random() % 64U;
  for (unsigned i = 0; i < lanes; ++i) {
    Lane& lane = map.lanes[i];
    lane.present = random() % 8U != 0;
    lane.kind = static_cast<LaneKind>(random() % 3U);
    lane.in_junction = random() % 2U == 0;
    lane.on_route = random() % 2U == 0;
    lane.changes_needed = static_cast<std::int8_t>(random() % 256U);
    for (LaneIndex& successor : lane.successors) successor = any_index(random);
    lane.left = any_index(random);
    lane.right = any_index(random);
    lane.point_count = static_cast<std::uint8_t>(random() % 8U == 0 ? random() % 256U : 2U + random() % 11U);
    float x_m = uniform(random, -40.0F, 40.0F);
    float y_m = uniform(random, -40.0F, 40.0F);
    for (Point& point : lane.points) {
      point = {x_m, y_m};
      x_m += uniform(random, -2.0F, 15.0F);
      y_m += uniform(random, -5.0F, 5.0F);
      if (random() % 10U == 0) x_m = point.x_m;
      if (wild && random() % 20U == 0) x_m = any_float(random, 1e4F);
    }
    lane.width_m = wild ? any_float(random, 5.0F) : 3.2F;
    lane.speed_limit_mps = wild ? any_float(random, 20.0F) : uniform(random, 0.0F, 30.0F);
    lane.route_remaining_m = wild ? any_float(random, 200.0F) : uniform(random, -10.0F, 500.0F);
    lane.goal_distance_m = wild ? any_float(random, 200.0F) : uniform(random, -10.0F, 500.0F);
    lane.stop_line_m = wild ? any_float(random, 50.0F) : uniform(random, -10.0F, 50.0F);
  }
  const unsigned conflicts = random() % 129U;
  for (unsigned i = 0; i < conflicts; ++i) {
    Conflict conflict;
    conflict.first = any_index(random);
    conflict.second = any_index(random);
    conflict.priority = static_cast<Priority>(random() % 5U);
    conflict.first_entry_m = wild ? any_float(random, 50.0F) : uniform(random, 0.0F, 40.0F);
    conflict.first_exit_m = conflict.first_entry_m + uniform(random, -2.0F, 10.0F);
    conflict.second_entry_m = uniform(random, 0.0F, 40.0F);
    conflict.second_exit_m = conflict.second_entry_m + uniform(random, -2.0F, 10.0F);
    (void)map.conflicts.push(conflict);
  }
  return map;
}

TrackList garbage_tracks(std::mt19937& random) {
  TrackList tracks;
  const bool wild = random() % 4U == 0;
  const unsigned count = random() % 17U;
  for (unsigned i = 0; i < count; ++i) {
    Track track = test::car(static_cast<int>(random() % 24U), uniform(random, -50.0F, 80.0F),
                            uniform(random, -50.0F, 50.0F), uniform(random, -3.15F, 3.15F),
                            uniform(random, 0.0F, 25.0F));
    track.acceleration_mps2 = uniform(random, -8.0F, 4.0F);
    track.yaw_rate_radps = uniform(random, -1.3F, 1.3F);
    if (wild) track.speed_mps = any_float(random, 100.0F);
    if (wild) track.centre.y_m = any_float(random, 100.0F);
    if (wild) track.length_m = any_float(random, 30.0F);
    (void)tracks.push(track);
  }
  return tracks;
}

void check_finite(const Pose& pose) {
  RC_ASSERT(std::isfinite(pose.x_m));
  RC_ASSERT(std::isfinite(pose.y_m));
  RC_ASSERT(std::isfinite(pose.heading_rad));
}

void check_path(const LaneMap& map, const scene::LanePath& path) {
  RC_ASSERT(!path.lanes.empty());
  RC_ASSERT(std::isfinite(path.length_m));
  for (const scene::PathLane& part : path.lanes) {
    RC_ASSERT(part.lane >= 0 && part.lane < kMaxLanes);
    RC_ASSERT(scene::usable(map.lanes[part.lane]));
  }
}

void check_scene(const scene::Scene& scene) {
  RC_ASSERT(scene.watched <= kMaxAgents && scene.watched <= scene.agents.size());
  for (const scene::EgoPath& ego_path : scene.ego_paths) {
    check_path(*scene.map, ego_path.path);
    RC_ASSERT(std::isfinite(ego_path.frenet.s_m) && std::isfinite(ego_path.frenet.d_m));
    RC_ASSERT(std::isfinite(ego_path.route_end_s_m) && std::isfinite(ego_path.goal_s_m));
    float last_m = -1e9F;
    for (const scene::ConflictZone& zone : ego_path.zones) {
      RC_ASSERT(std::isfinite(zone.stop_s_m) && std::isfinite(zone.other_entry_m));
      RC_ASSERT(zone.entry_s_m >= last_m && zone.entry_s_m <= zone.exit_s_m + 10.0F);
      RC_ASSERT(zone.other_lane >= 0 && zone.other_lane < kMaxLanes);
      last_m = zone.entry_s_m;
    }
  }
  for (const scene::Agent& agent : scene.agents) {
    check_finite(agent.track.centre);
    RC_ASSERT(agent.age_ms <= 1000);
    float sum = 0.0F;
    for (int i = 0; i < agent.paths.size(); ++i) {
      check_path(*scene.map, agent.paths[i]);
      RC_ASSERT(std::isfinite(agent.frenet[i].s_m) && std::isfinite(agent.frenet[i].d_m));
      RC_ASSERT(agent.path_probability[i] >= 0.0F);
      sum += agent.path_probability[i];
    }
    RC_ASSERT(agent.paths.empty() || std::fabs(sum - 1.0F) < 1e-4F);
    for (const scene::History::Sample& sample : agent.history.samples) check_finite(sample.pose);
  }
}

void check_predictions(const scene::Scene& scene, const PredictionSet& set,
                       const KinematicSet& constant_velocity) {
  RC_ASSERT(set.agents.size() == scene.watched);
  for (const AgentPrediction& agent : set.agents) {
    float sum = 0.0F;
    RC_ASSERT(!agent.modes.empty());
    for (const Mode& mode : agent.modes) {
      sum += mode.probability;
      RC_ASSERT(mode.probability > 0.0F && mode.probability <= agent.modes[0].probability);
      for (const Pose& pose : mode.steps) check_finite(pose);
    }
    RC_ASSERT(std::fabs(sum - 1.0F) < 1e-4F);
  }
  RC_ASSERT(constant_velocity.agents.size() == scene.agents.size());
  for (const Mode& mode : constant_velocity.agents) {
    for (const Pose& pose : mode.steps) check_finite(pose);
  }
}

/// A few cycles over changing garbage; what comes out at the end.
struct Outcome {
  scene::Scene scene;
  PredictionSet set;
  KinematicSet constant_velocity;
};

void run_garbage(unsigned seed, Outcome& run) {
  std::mt19937 random(seed);
  const Parameters parameters;
  scene::SceneBuilder builder;
  Predictor predictor;
  std::uint32_t now_ms = random();
  static LaneMap map;
  for (int cycle = 0; cycle < 4; ++cycle) {
    if (cycle == 0 || random() % 3U == 0) map = garbage_map(random);
    const bool has_map = random() % 8U != 0;
    EgoState ego = test::ego_at(uniform(random, -30.0F, 30.0F), uniform(random, -30.0F, 30.0F),
                                uniform(random, -3.1F, 3.1F), uniform(random, 0.0F, 20.0F));
    if (has_map && map.lanes[0].present && random() % 2U == 0) {
      const Point on_lane = map.lanes[0].points[0];
      if (std::fabs(on_lane.x_m) < 1e3F && std::fabs(on_lane.y_m) < 1e3F) {
        ego.rear_axle = {on_lane.x_m, on_lane.y_m, 0.0F};
      }
    }
    now_ms += random() % 10U == 0 ? random() : 100U;
    const Status status = builder.build(now_ms, ego, garbage_tracks(random), now_ms - random() % 800U,
                                        has_map ? &map : nullptr, parameters, run.scene);
    RC_ASSERT((status == Status::kOk) == !run.scene.ego_paths.empty());
    check_scene(run.scene);
    predictor.encode(run.scene, parameters, now_ms + 100);
    predictor.decode(nullptr, kMaxPredictionWork, run.set);
    predictor.constant_velocity(run.constant_velocity);
    check_predictions(run.scene, run.set, run.constant_velocity);
    const Trajectory plan = test::plan_of(ego, uniform(random, -4.0F, 2.0F), uniform(random, -4.0F, 4.0F));
    predictor.decode(&plan, kMaxPredictionWork, run.set);
    check_predictions(run.scene, run.set, run.constant_velocity);
    RC_ASSERT(predictor.work() <= (2 * kMaxAgents * 2 * kPathsPerAgent + kMaxTracks) * kHorizonSteps);
  }
}

// CORE-032, CORE-040 Whatever the map, the tracks and the time: nothing asserts, every value is finite, every
// index in range, chances add up to 1.
TEST(SceneProperty, GarbageDoesNoHarm) {
  EXPECT_TRUE(rc::check("garbage in, a sound scene out", [](unsigned seed) {
    static Outcome run;
    run_garbage(seed, run);
  }));
}

// CORE-031 The same calls give the same bits.
TEST(SceneProperty, IsDeterministic) {
  EXPECT_TRUE(rc::check("twice the same", [](unsigned seed) {
    static Outcome first;
    static Outcome second;
    run_garbage(seed, first);
    run_garbage(seed, second);
    RC_ASSERT(first.scene.agents.size() == second.scene.agents.size());
    for (int i = 0; i < first.scene.agents.size(); ++i) {
      const scene::Agent& a = first.scene.agents[i];
      const scene::Agent& b = second.scene.agents[i];
      RC_ASSERT(a.track.id == b.track.id);
      RC_ASSERT(std::memcmp(&a.track.centre, &b.track.centre, sizeof(Pose)) == 0);
      RC_ASSERT(std::memcmp(a.frenet, b.frenet, sizeof a.frenet) == 0);
    }
    for (int i = 0; i < first.set.agents.size(); ++i) {
      for (int k = 0; k < first.set.agents[i].modes.size(); ++k) {
        RC_ASSERT(std::memcmp(first.set.agents[i].modes[k].steps, second.set.agents[i].modes[k].steps,
                              sizeof(Mode::steps)) == 0);
      }
    }
  }));
}

// A point d metres beside the centre line at s comes back as (s, d): straights, curves both ways, joints.
TEST(LanePathProperty, ProjectUndoesPathPoint) {
  EXPECT_TRUE(rc::check("project(path_point(s) + d) = (s, d)", [] {
    const float radius_m = static_cast<float>(*rc::gen::inRange(80, 600)) * 0.1F;
    const float angle = static_cast<float>(*rc::gen::inRange(-25, 26)) * 0.1F;
    const LaneMap map = test::curved_road(radius_m, angle == 0.0F ? 0.05F : angle);
    const scene::LanePath path = test::path_along(map, {0, 1, 2});
    const float s_m = path.length_m * static_cast<float>(*rc::gen::inRange(0, 1001)) * 0.001F;
    const float d_m = static_cast<float>(*rc::gen::inRange(-40, 41)) * 0.05F;
    const Point point = offset_point(scene::path_point(map, path, s_m).pose, 0.0F, d_m);
    const scene::Frenet frenet = scene::project(map, path, point, s_m + 3.0F, 12.0F);
    RC_ASSERT(std::fabs(frenet.s_m - s_m) < 0.05F);
    RC_ASSERT(std::fabs(frenet.d_m - d_m) < 0.02F);
  }));
}

// The cursor gives the same bits as path_point, in whatever order it is asked.
TEST(LanePathProperty, CursorEqualsPathPoint) {
  EXPECT_TRUE(rc::check("cursor = path_point", [](unsigned seed) {
    std::mt19937 random(seed);
    const LaneMap map = test::curved_road(uniform(random, 8.0F, 50.0F), uniform(random, -3.0F, 3.0F));
    const scene::LanePath path = test::path_along(map, {0, 1, 2});
    scene::PathCursor cursor(map, path);
    for (int i = 0; i < 20; ++i) {
      const float s_m = uniform(random, -20.0F, path.length_m + 20.0F);
      const scene::PathPoint a = cursor.at(s_m);
      const scene::PathPoint b = scene::path_point(map, path, s_m);
      RC_ASSERT(std::memcmp(&a.pose, &b.pose, sizeof(Pose)) == 0);
      RC_ASSERT(a.curvature_1pm == b.curvature_1pm && a.lane == b.lane);
    }
  }));
}

// On a sound road every predicted vehicle stays within its lane's width of some lane's centre line, at any speed that tyres
// can hold in the lane's bend: v^2 / r <= 8 m/s^2, with r = length / turn, so 8.8 m/s in the left turn of 9.6 m.
TEST(PredictorProperty, StaysOnTheRoad) {
  const test::CrossJunction cross = test::cross_junction();
  const auto holdable_mps = [](const Lane& lane) {
    const float turn_rad = std::fabs(
        wrap_angle(test::on_lane(lane, lane.length_m).heading_rad - test::on_lane(lane, 0.0F).heading_rad));
    return std::sqrt(8.0F * lane.length_m / std::fmax(turn_rad, 1e-3F));
  };
  EXPECT_TRUE(rc::check("predicted vehicles stay on lanes", [&](unsigned seed) {
    std::mt19937 random(seed);
    std::vector<Track> tracks;
    for (int id = 0; id < 5; ++id) {
      const Lane& lane = cross.map.lanes[random() % 20U];
      const Pose pose = test::on_lane(lane, uniform(random, 0.0F, lane.length_m));
      Track track = test::car(id, pose.x_m, pose.y_m, pose.heading_rad,
                              uniform(random, 0.0F, std::fmin(14.0F, holdable_mps(lane))));
      track.acceleration_mps2 = uniform(random, -3.0F, 2.0F);
      tracks.push_back(track);
    }
    const Parameters parameters;
    const scene::Scene scene = test::scene_of(cross.map, test::ego_at(-40.0F, -1.6F, 0.0F, 8.0F), tracks);
    static PredictionSet set;
    Predictor predictor;
    predictor.encode(scene, parameters, scene.time_ms + 100);
    predictor.decode(nullptr, kMaxPredictionWork, set);
    for (const AgentPrediction& agent : set.agents) {
      const scene::Agent& seen = scene.agents[agent.agent];
      for (const Mode& mode : agent.modes) {
        for (const Pose& pose : mode.steps) {
          if (std::fabs(pose.x_m) > 60.0F || std::fabs(pose.y_m) > 60.0F) continue;  // beyond the map
          float nearest_m = 1e9F;
          for (const scene::LanePath& path : seen.paths) {
            nearest_m = std::min(nearest_m,
                                 std::fabs(scene::project(cross.map, path, position(pose), 0.0F, -1.0F).d_m));
          }
          RC_ASSERT(nearest_m < 1.6F);
        }
      }
    }
  }));
}

}  // namespace
}  // namespace s4tp::satp
