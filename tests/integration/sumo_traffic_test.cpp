// These need Debian's sumo and fail without it.
#include "sim_host/sumo/sumo_traffic.hpp"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <set>
#include <thread>

#include "sim_host/campaign/campaign.hpp"
#include "sim_host/campaign/episode.hpp"
#include "sim_host/sumo/coupling_floor.hpp"
#include "sim_host/world/engine_factory.hpp"
#include "sim_host/world/traffic/box.hpp"
#include "sim_host/world/world.hpp"

namespace s4tp::world {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

Scenario shipped(const std::string& name) {
  return load_scenario(fs::path(S4TP_SOURCE_DIR) / "sim_host/scenarios" / name);
}

EngineOptions without_ego(std::uint64_t seed) {
  EngineOptions options;
  options.engine = Engine::kSumo;
  options.seed = options.episode = seed;
  options.ego = DrivenBy::kNobody;
  return options;
}

void advance(TrafficEngine& traffic, double until_s, const EgoSeen* ego = nullptr) {
  while (traffic.time_s() < until_s - 1e-6) traffic.step(ego);
}

EgoSeen standing_at(const Scenario& scenario, LaneId lane, double s_m) {
  const PolylinePose pose = scenario.network.lanes[static_cast<std::size_t>(lane)].centre.at(s_m);
  EgoSeen ego;
  ego.car.centre = pose.point;
  ego.car.heading_rad = pose.heading_rad;
  return ego;
}

/// From the mission's start through the junction: the lanes of the way that ends on the goal's edge.
std::vector<LaneId> way_through(const Scenario& scenario) {
  const auto lane_of = [&](LaneId id) { return scenario.network.lanes[static_cast<std::size_t>(id)]; };
  for (const LaneId turn : lane_of(scenario.mission.start_lane).successors) {
    std::vector<LaneId> way{scenario.mission.start_lane, turn};
    while (lane_of(way.back()).in_junction) way.push_back(lane_of(way.back()).successors.front());
    if (lane_of(way.back()).edge == lane_of(scenario.mission.goal_lane).edge) return way;
  }
  return {};
}

bool same(const std::vector<CarState>& a, const std::vector<CarState>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const CarState& x, const CarState& y) {
    return x.id == y.id && x.centre.x == y.centre.x && x.centre.y == y.centre.y &&
           x.speed_mps == y.speed_mps && x.heading_rad == y.heading_rad && x.lane == y.lane;
  });
}

std::string what_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const std::exception& error) {
    return error.what();
  }
  return "nothing";
}

/// A folder with a program called sumo, first along PATH while this lives.
class FakeSumo {
 public:
  explicit FakeSumo(const std::string& script) : before_(std::getenv("PATH")) {
    fs::create_directories(folder_);
    const fs::path program = folder_ / "sumo";
    std::ofstream(program) << "#!/bin/sh\n" << script << '\n';
    fs::permissions(program, fs::perms::owner_all);
    setenv("PATH", (folder_.string() + ":" + before_).c_str(), 1);
  }
  ~FakeSumo() {
    setenv("PATH", before_.c_str(), 1);
    fs::remove_all(folder_);
  }

 private:
  fs::path folder_ = fs::temp_directory_path() / ("s4tp_fake_sumo_" + std::to_string(getpid()));
  std::string before_;
};

/// Running or a zombie whose parent has not looked yet: only the first counts.
bool runs(pid_t process) {
  std::ifstream stat("/proc/" + std::to_string(process) + "/stat");
  std::string id;
  std::string name;
  std::string state;
  return stat >> id >> name >> state && state != "Z" && state != "X";
}

bool ends_soon(pid_t process) {
  const auto end = std::chrono::steady_clock::now() + 20s;
  while (runs(process) && std::chrono::steady_clock::now() < end) std::this_thread::sleep_for(5ms);
  return !runs(process);
}

// WORLD-040 One seed, the same cars to the bit; another seed, others.
TEST(SumoTraffic, IsDeterministicInItsSeed) {
  const Scenario scenario = shipped("left_turn");
  SumoTraffic one(scenario, without_ego(11));
  SumoTraffic again(scenario, without_ego(11));
  SumoTraffic other(scenario, without_ego(12));
  bool differs = false;
  for (int i = 0; i < 2500; ++i) {
    one.step(nullptr);
    again.step(nullptr);
    other.step(nullptr);
    ASSERT_TRUE(same(one.cars(), again.cars())) << i;
    differs = differs || !same(one.cars(), other.cars());
  }
  EXPECT_TRUE(differs);
  EXPECT_GT(one.finished(), 0);
}

// SUMO-002 On an empty straight road drivers who want 10 m/s at most drive as our plan drew them: never
// faster.
TEST(SumoTraffic, DrivesThePlansDrivers) {
  SumoTraffic traffic(shipped("overtake"), without_ego(4));
  std::size_t most = 0;
  while (traffic.time_s() < 20.0) {
    traffic.step(nullptr);
    most = std::max(most, traffic.cars().size());
    for (const CarState& car : traffic.cars()) EXPECT_LE(car.speed_mps, 10.0 + 1e-9);
  }
  EXPECT_GE(most, 2U);
}

// SUMO says the lane of the front bumper, we that of the box centre: it lies within that lane.
TEST(SumoTraffic, SaysTheLaneOfTheCentre) {
  const Scenario scenario = shipped("left_turn");
  SumoTraffic traffic(scenario, without_ego(3));
  int in_junction = 0;
  while (traffic.time_s() < 40.0 - 1e-6) {
    advance(traffic, traffic.time_s() + 0.1);
    for (const CarState& car : traffic.cars()) {
      ASSERT_NE(car.lane, kNoLane);
      const NetworkLane& lane = scenario.network.lanes[static_cast<std::size_t>(car.lane)];
      const double s_m = lane.centre.project(car.centre).s_m;
      EXPECT_GE(s_m, -0.01) << lane.name << " at " << traffic.time_s() << " s";
      EXPECT_LE(s_m, lane.centre.length_m() + 0.5) << lane.name << " at " << traffic.time_s() << " s";
      in_junction += lane.in_junction ? 1 : 0;
    }
  }
  EXPECT_GT(in_junction, 20);
}

// Between two steps cars move evenly: no 10 ms step is longer than 20 m/s would make it.
TEST(SumoTraffic, MovesSmoothlyBetweenSteps) {
  SumoTraffic traffic(shipped("merge"), without_ego(3));
  std::map<int, Vec2> before;
  for (int i = 0; i < 2000; ++i) {
    traffic.step(nullptr);
    for (const CarState& car : traffic.cars()) {
      if (before.count(car.id) != 0) {
        EXPECT_LT(std::hypot(car.centre.x - before[car.id].x, car.centre.y - before[car.id].y), 0.2);
      }
      before[car.id] = car.centre;
    }
  }
  EXPECT_FALSE(before.empty());
}

// Whoever comes along behind a standing ego stops: boxes never touch, and somebody does come to a stand.
TEST(SumoTraffic, StopsBehindAStandingEgo) {
  const Scenario scenario = shipped("overtake");
  EngineOptions options = without_ego(4);
  options.ego = DrivenBy::kUs;
  SumoTraffic traffic(scenario, options, {.early = false});
  const EgoSeen ego = standing_at(scenario, scenario.mission.start_lane, 120.0);
  bool stood = false;
  while (traffic.time_s() < 40.0) {
    traffic.step(&ego);
    for (const CarState& car : traffic.cars()) EXPECT_FALSE(overlap(box_of(ego.car), box_of(car)));
    for (const CarFlags& flags : traffic.flags()) stood = stood || flags.waiting;
  }
  EXPECT_TRUE(stood);
}

// SUMO has the ego where we said, to a millimetre: 13 m/s, turning with 0.1 rad/s, told 0.1 s ahead.
TEST(SumoTraffic, PlacesTheEgoAtTheStepsEnd) {
  const Scenario scenario = shipped("cruise");
  EngineOptions options = without_ego(4);
  options.ego = DrivenBy::kUs;
  SumoTraffic traffic(scenario, options, {.early = false});
  EgoSeen ego = standing_at(scenario, scenario.mission.start_lane, 20.0);
  ego.car.speed_mps = 13.0;
  for (int i = 0; i < 30; ++i) {
    traffic.step(&ego);
    ego.car.centre.x += 0.13;  // the road leads east
  }
  const CarState seen = traffic.ego_seen().value();
  EXPECT_NEAR(seen.centre.x, ego.car.centre.x, 1e-3);
  EXPECT_NEAR(seen.centre.y, ego.car.centre.y, 1e-3);
  EXPECT_NEAR(seen.speed_mps, 13.0, 1e-6);
}

// Half a metre beside the centre of our left turn, where six other ways cross it: SUMO has us on our route's
// lanes all the way. Without on_route it takes the nearest lane, and that is another one on the way.
TEST(SumoTraffic, KeepsTheEgoOnItsRoute) {
  const Scenario scenario = shipped("left_turn");
  const std::vector<LaneId> way = way_through(scenario);
  ASSERT_FALSE(way.empty());
  for (const bool on_route : {true, false}) {
    EngineOptions options = without_ego(4);
    options.ego = DrivenBy::kUs;
    SumoTraffic traffic(scenario, options, {.early = false, .on_route = on_route});
    int elsewhere = 0;
    for (const LaneId id : way) {
      const Polyline& centre = scenario.network.lanes[static_cast<std::size_t>(id)].centre;
      for (double s_m = 3.0; s_m < std::min(centre.length_m(), 30.0); s_m += 0.3) {
        EgoSeen ego = standing_at(scenario, id, s_m);
        ego.car.centre.x += 0.5 * std::sin(ego.car.heading_rad);
        ego.car.centre.y -= 0.5 * std::cos(ego.car.heading_rad);
        for (int i = 0; i < 20; ++i) traffic.step(&ego);
        const LaneId seen = traffic.ego_seen().value().lane;
        elsewhere += std::find(way.begin(), way.end(), seen) == way.end() ? 1 : 0;
      }
    }
    if (on_route) {
      EXPECT_EQ(elsewhere, 0);
    } else {
      EXPECT_GT(elsewhere, 0);
    }
  }
}

// An ego that has left its route is seen where it is: whoever comes along there stops behind it.
TEST(SumoTraffic, StopsBehindAnEgoOffItsRoute) {
  const Scenario scenario = shipped("left_turn");
  const LaneId oncoming = scenario.network.find("north_in_0");
  EngineOptions options = without_ego(4);
  options.ego = DrivenBy::kUs;
  SumoTraffic traffic(scenario, options, {.early = false});
  const EgoSeen ego = standing_at(scenario, oncoming, 60.0);
  bool stood = false;
  while (traffic.time_s() < 60.0) {
    traffic.step(&ego);
    for (const CarState& car : traffic.cars()) {
      if (traffic.time_s() > 1.0) {
        EXPECT_FALSE(overlap(box_of(ego.car), box_of(car)));
      }
      stood = stood || (car.lane == oncoming && car.speed_mps < 0.1);
    }
  }
  EXPECT_TRUE(stood);
}

// Emptying a stretch takes those whose box reaches into it, for SUMO too, and nobody else.
TEST(SumoTraffic, ClearsAStretch) {
  const Scenario scenario = shipped("cruise");
  SumoTraffic traffic(scenario, without_ego(5));
  advance(traffic, 20.0);
  const std::size_t before = traffic.cars().size();
  const int finished = traffic.finished();
  ASSERT_GT(before, 0U);
  const LaneId lane = traffic.cars().front().lane;
  traffic.clear(lane, -10.0, 210.0);
  const std::size_t after = traffic.cars().size();
  EXPECT_LT(after, before);
  for (const CarState& car : traffic.cars()) EXPECT_NE(car.lane, lane);
  traffic.step(nullptr);
  EXPECT_LE(traffic.cars().size(), after + 3);
  EXPECT_EQ(traffic.finished(), finished);
}

// A user's own route files: the episode takes its number modulo theirs; ids and types are his.
TEST(SumoTraffic, TakesRouteFilesByEpisode) {
  Scenario scenario = shipped("cruise");
  const fs::path folder = fs::temp_directory_path() / ("s4tp_routes_" + std::to_string(getpid()));
  fs::create_directories(folder);
  for (int i = 0; i < 2; ++i) {
    const fs::path file = folder / ("traffic-" + std::to_string(i) + ".rou.xml");
    std::ofstream(file) << "<routes><vType id=\"lorry\" length=\"" << 8 + i << "\" width=\"2.4\"/>"
                        << "<vehicle id=\"his:" << i << "\" type=\"lorry\" depart=\"0\" departLane=\"" << i
                        << "\"><route edges=\"" << scenario.mission.edges.front()
                        << "\"/></vehicle></routes>";
    scenario.route_files.push_back(file);
  }
  for (const std::uint64_t episode : {0U, 3U}) {
    SumoTraffic traffic(scenario, without_ego(episode));
    advance(traffic, 2.0);
    ASSERT_EQ(traffic.cars().size(), 1U);
    EXPECT_DOUBLE_EQ(traffic.cars().front().length_m, episode == 0 ? 8.0 : 9.0);
    EXPECT_EQ(scenario.network.lanes[static_cast<std::size_t>(traffic.cars().front().lane)].index,
              episode == 0 ? 0 : 1);
  }
  fs::remove_all(folder);
}

// SUMO dies in the middle of an episode: the next step says so at once.
TEST(SumoTraffic, SaysThatSumoHasDied) {
  const Scenario scenario = shipped("cruise");
  SumoTraffic traffic(scenario, without_ego(5));
  advance(traffic, 1.0);
  kill(traffic.process(), SIGKILL);
  const std::string what = what_of([&] { advance(traffic, 2.0); });
  EXPECT_NE(what.find("closed the connection"), std::string::npos) << what;
  EXPECT_NE(what.find("it has ended"), std::string::npos) << what;
}

// SUMO-003 A SUMO that cannot load its network, cannot have its port, or is not there, is an error in its
// words.
TEST(SumoTraffic, SaysWhySumoDoesNotComeUp) {
  Scenario scenario = shipped("cruise");
  scenario.network_file = "/nowhere.net.xml";
  const std::string no_network = what_of([&] { SumoTraffic traffic(scenario, without_ego(5)); });
  EXPECT_NE(no_network.find("nowhere.net.xml"), std::string::npos) << no_network;
  {
    const FakeSumo refused("echo 'Error: Address already in use' >&2; exit 1");
    const std::string what = what_of([&] { SumoTraffic traffic(scenario, without_ego(5)); });
    EXPECT_NE(what.find("Address already in use"), std::string::npos) << what;
  }
  const std::string missing = what_of([] { SumoProcess("no-such-sumo", {}, ""); });
  EXPECT_NE(missing.find("apt-get install sumo"), std::string::npos) << missing;
}

// SUMO-001 The child ends with its object, and when whoever started it is killed.
TEST(SumoProcess, NeverOutlivesUs) {
  pid_t child = 0;
  {
    const SumoProcess process("sleep", {"1000"}, "");
    child = process.id();
    EXPECT_TRUE(runs(child));
  }
  EXPECT_FALSE(runs(child));

  int ids[2];
  ASSERT_EQ(pipe(ids), 0);
  const pid_t starter = fork();
  if (starter == 0) {
    const SumoProcess process("sleep", {"1000"}, "");
    const pid_t id = process.id();
    (void)!write(ids[1], &id, sizeof id);
    pause();
  }
  ASSERT_EQ(read(ids[0], &child, sizeof child), static_cast<ssize_t>(sizeof child));
  EXPECT_TRUE(runs(child));
  kill(starter, SIGKILL);
  waitpid(starter, nullptr, 0);
  EXPECT_TRUE(ends_soon(child));
}

// SUMO-001 It outlives the thread that made it: the kernel's signal of a parent's death follows the thread
// that forked.
TEST(SumoProcess, OutlivesTheThreadThatMadeIt) {
  std::unique_ptr<SumoProcess> process;
  std::thread([&] {
    process = std::make_unique<SumoProcess>("sleep", std::vector<std::string>{"1000"}, "");
  }).join();
  std::this_thread::sleep_for(100ms);
  EXPECT_TRUE(process->lives());
  const pid_t child = process->id();
  process.reset();
  EXPECT_FALSE(runs(child));
}

/// The programs called sumo whose parent is `process`.
std::set<pid_t> sumos_of(pid_t process) {
  std::set<pid_t> found;
  for (const auto& entry : fs::directory_iterator("/proc")) {
    std::ifstream stat(entry.path() / "stat");
    pid_t id = 0;
    std::string name;
    std::string state;
    pid_t parent = 0;
    if (stat >> id >> name >> state >> parent && parent == process && name == "(sumo)") found.insert(id);
  }
  return found;
}

// SUMO-001 A campaign of two episodes at a time is interrupted, ended or killed while SUMOs run: none is
// left.
TEST(SumoProcess, NoneIsLeftOfAnInterruptedCampaign) {
  const fs::path folder = fs::temp_directory_path() / ("s4tp_sumo_eval_" + std::to_string(getpid()));
  for (const int signal : {SIGINT, SIGTERM, SIGKILL}) {
    fs::remove_all(folder);
    fs::create_directories(folder);
    const pid_t campaign = fork();
    if (campaign == 0) {
      const std::string tool = fs::path(S4TP_BINARY_DIR) / "sim_host" / "s4tp_tool";
      const std::string out = folder / "out";
      (void)!freopen((folder / "said").c_str(), "w", stdout);
      (void)!freopen((folder / "said").c_str(), "w", stderr);
      execl(tool.c_str(), tool.c_str(), "eval", "--planner", "constant_speed", "--scenarios", "cruise",
            "--traffic", "sumo", "--episodes", "1000", "--jobs", "2", "--out", out.c_str(), nullptr);
      _exit(127);
    }
    std::set<pid_t> sumos;
    const auto end = std::chrono::steady_clock::now() + 60s;
    while (sumos.size() < 2 && runs(campaign) && std::chrono::steady_clock::now() < end) {
      sumos = sumos_of(campaign);
    }
    EXPECT_EQ(sumos.size(), 2U);
    kill(campaign, signal);
    int status = 0;
    waitpid(campaign, &status, 0);
    if (signal == SIGKILL) {
      EXPECT_TRUE(WIFSIGNALED(status));
    } else {
      EXPECT_EQ(WEXITSTATUS(status), 130);
    }
    for (const pid_t sumo : sumos) EXPECT_TRUE(ends_soon(sumo)) << "signal " << signal;
  }
  fs::remove_all(folder);
}

// An episode over CAN frames with SUMO's traffic reaches its goal, twice the same to the bit.
TEST(SumoTraffic, DrivesAnEpisode) {
  campaign::EpisodeOptions options;
  options.seed = 3;
  options.engine = Engine::kSumo;
  const Scenario scenario = shipped("left_turn");
  const Recording one = campaign::run_episode(scenario, options).recording;
  const Recording again = campaign::run_episode(scenario, options).recording;
  EXPECT_EQ(one.ending, Ending::kGoal);
  ASSERT_EQ(one.snapshots.size(), again.snapshots.size());
  for (std::size_t i = 0; i < one.snapshots.size(); ++i) {
    EXPECT_TRUE(same(one.snapshots[i].others, again.snapshots[i].others)) << i;
    EXPECT_TRUE(same({one.snapshots[i].ego}, {again.snapshots[i].ego})) << i;
  }
}

// WORLD-041 SUMO's own driver takes the ego from the mission's start at entry speed to its goal; no ECU
// answers.
TEST(SumoTraffic, LetsSumoDriveTheEgo) {
  const Scenario scenario = shipped("merge");
  WorldOptions options;
  options.seed = 3;
  options.engine = Engine::kSumo;
  options.ego_by_traffic = true;
  World world(scenario, options);
  std::vector<wire::Frame> frames;
  while (!world.finished()) {
    frames.clear();
    world.tick(frames);
    if (world.time_s() >= 0.0 && world.time_s() < 0.005) {
      EXPECT_DOUBLE_EQ(world.recording().snapshots.back().ego.speed_mps, scenario.mission.start_speed_mps);
    }
  }
  EXPECT_EQ(world.recording().ending, Ending::kGoal);
  const std::vector<Snapshot>& shots = world.recording().snapshots;
  for (std::size_t i = 1; i < shots.size(); ++i) {  // no jump: 20 m/s for 0.1 s at most
    EXPECT_LT(std::hypot(shots[i].ego.centre.x - shots[i - 1].ego.centre.x,
                         shots[i].ego.centre.y - shots[i - 1].ego.centre.y),
              2.0);
  }
}

// The planner sumo_driver is that driver, from the same start, through the same recording and figures; bare
// and guarded he is the same, so he has one cell. Nobody drives against SUMO's will: elsewhere he is refused.
TEST(SumoDriver, IsAPlannerOfTheCampaign) {
  campaign::CampaignPlan plan;
  plan.planners = {"constant_speed", "sumo_driver"};
  plan.scenarios = {"merge", "cruise"};
  plan.guards = {true, false};
  plan.episodes = 2;
  const fs::path scenarios = fs::path(S4TP_SOURCE_DIR) / "sim_host/scenarios";
  const std::string refused = what_of([&] { (void)campaign::load_campaign(plan, scenarios); });
  EXPECT_NE(refused.find("sumo_driver drives in SUMO's traffic only: --traffic sumo"), std::string::npos)
      << refused;

  plan.traffic = {"builtin", "sumo"};
  campaign::Campaign all = campaign::load_campaign(plan, scenarios);
  EXPECT_EQ(all.cells.size(), 2U * 2U * 2U + 2U);
  std::vector<campaign::Job> jobs = campaign::jobs_of(all);
  std::erase_if(jobs,
                [&](const campaign::Job& job) { return all.cells[job.cell].cell.planner != "sumo_driver"; });
  ASSERT_EQ(jobs.size(), 4U);
  campaign::CampaignOptions options;
  options.threads = 2;
  for (const campaign::EpisodeRow& row : campaign::run_campaign(all, jobs, options)) {
    EXPECT_FALSE(row.cell.guarded);
    EXPECT_EQ(row.cell.traffic, "sumo");
    EXPECT_EQ(row.metrics.ending, Ending::kGoal) << row.cell.scenario << " " << row.metrics.seed;
    EXPECT_GT(row.metrics.duration_s, 5.0);
    EXPECT_GT(row.metrics.distance_m, 50.0);
  }
}

// The built-in traffic drives no ego, and says so.
TEST(TrafficEngine, OnlySumoDrivesTheEgo) {
  EngineOptions options;
  options.ego = DrivenBy::kEngine;
  EXPECT_THROW((void)make_engine(shipped("cruise"), options), std::invalid_argument);
  EXPECT_EQ(engine_of("sumo"), Engine::kSumo);
  EXPECT_THROW((void)engine_of("vissim"), std::invalid_argument);
}

// One of SUMO's own drives, replayed through the coupling: on an unchanged course nobody touches the ego.
TEST(SumoCoupling, ReplaysADriveUntouched) {
  const Scenario scenario = shipped("left_turn");
  const SumoDrive drive = sumo_drive(scenario, 3);
  ASSERT_TRUE(drive.arrived && !drive.touched);
  EXPECT_FALSE(replay(scenario, 3, drive, {}).touched);
}

}  // namespace
}  // namespace s4tp::world
