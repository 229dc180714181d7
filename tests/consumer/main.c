/* Plans a few cycles behind a slow car, with somebody oncoming, and prints a checksum over every bit of every
   plan and of what it costs. One argument: the slow car stands 1 mm elsewhere, so that the checksum must be
   another one. */

#include <s4tp.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>

static s4tp_block planner;
static s4tp_lane_map map;
static s4tp_tracks tracks;
static s4tp_plan plan; /* zeroed: none in force yet */

void s4tp_on_assertion(const char* expression, const char* file, int line) {
  printf("fault of the library: %s in %s:%d\n", expression, file, line);
  exit(3);
}

static uint32_t crc32(uint32_t crc, const void* data, size_t size) {
  const unsigned char* byte = data;
  size_t i;
  int bit;
  crc = ~crc;
  for (i = 0; i < size; ++i) {
    crc ^= byte[i];
    for (bit = 0; bit < 8; ++bit) crc = (crc >> 1) ^ ((crc & 1U) != 0U ? 0xEDB88320U : 0U);
  }
  return ~crc;
}

static s4tp_track vehicle(uint8_t id, float x_m, float y_m, float heading_rad, float speed_mps) {
  s4tp_track track = {0};
  track.id = id;
  track.x_m = x_m;
  track.y_m = y_m;
  track.heading_rad = heading_rad;
  track.speed_mps = speed_mps;
  track.length_m = 4.6f;
  track.width_m = 1.8f;
  return track;
}

enum { OUTER, INNER, ONCOMING, OUTER_BEND, INNER_BEND, ONCOMING_BEND };

static s4tp_lane* add_lane(int slot, uint8_t kind, int successor) {
  s4tp_lane* lane = &map.lanes[slot];
  lane->present = 1;
  lane->kind = kind;
  lane->on_route = kind == S4TP_LANE_OURS;
  lane->successors[0] = (int8_t)successor;
  return lane;
}

static void add_point(s4tp_lane* lane, float x_m, float y_m) {
  lane->x_m[lane->point_count] = x_m;
  lane->y_m[lane->point_count] = y_m;
  ++lane->point_count;
}

/* Two lanes of ours and an oncoming one: 60 m straight along x, then 60 m bending to the left on 100 m. */
static void make_road(void) {
  static const float bend_x_m[3][4] = {
      {60.0f, 79.9f, 98.9f, 116.5f}, {60.0f, 79.2f, 97.7f, 114.7f}, {60.0f, 78.6f, 96.4f, 112.9f}};
  static const float bend_y_m[3][4] = {
      {0.0f, 2.0f, 7.9f, 17.5f}, {3.2f, 5.1f, 10.8f, 20.1f}, {6.4f, 8.3f, 13.8f, 22.7f}};
  s4tp_lane* lane;
  int i;
  int k;
  s4tp_clear_map(&map);
  for (i = OUTER; i <= INNER; ++i) {
    lane = add_lane(i, S4TP_LANE_OURS, i + OUTER_BEND);
    add_point(lane, 0.0f, bend_y_m[i][0]);
    add_point(lane, 60.0f, bend_y_m[i][0]);
    lane->route_remaining_m = lane->goal_distance_m = 120.0f;
    lane = add_lane(i + OUTER_BEND, S4TP_LANE_OURS, S4TP_NO_LANE_INDEX);
    for (k = 0; k < 4; ++k) add_point(lane, bend_x_m[i][k], bend_y_m[i][k]);
    lane->route_remaining_m = lane->goal_distance_m = 60.0f;
  }
  map.lanes[OUTER].left = INNER;
  map.lanes[INNER].right = OUTER;
  map.lanes[OUTER_BEND].left = INNER_BEND;
  map.lanes[INNER_BEND].right = OUTER_BEND;
  lane = add_lane(ONCOMING, S4TP_LANE_OPPOSITE, S4TP_NO_LANE_INDEX);
  add_point(lane, 60.0f, bend_y_m[ONCOMING][0]);
  add_point(lane, 0.0f, bend_y_m[ONCOMING][0]);
  lane = add_lane(ONCOMING_BEND, S4TP_LANE_OPPOSITE, ONCOMING);
  for (k = 3; k >= 0; --k) add_point(lane, bend_x_m[ONCOMING][k], bend_y_m[ONCOMING][k]);
}

int main(int argc, char** argv) {
  const s4tp_versions versions = s4tp_get_versions();
  s4tp_parameters parameters;
  s4tp_input input = {0};
  uint32_t crc = 0;
  int cycle;
  s4tp_status status;
  const size_t kCosts = offsetof(s4tp_choice, acceleration_mps2); /* from here on no padding */
  (void)argv;

  if (versions.api != S4TP_API_VERSION) return 2;
  s4tp_default_parameters(&parameters);
  status = s4tp_set_parameter(&parameters, "comfort.headway_s", 1.5f);
  if (status == S4TP_OK) status = s4tp_init(&planner, &parameters, NULL);
  printf("init: %s, parameters %08lX\n", s4tp_status_name(status),
         (unsigned long)s4tp_parameters_crc(&parameters));
  if (status != S4TP_OK) return 1;

  make_road();
  tracks.count = 2;
  tracks.items[0] = vehicle(7, argc > 1 ? 70.001f : 70.0f, 0.5f, 0.1f, 6.0f);
  tracks.items[1] = vehicle(9, 58.0f, 6.4f, -3.1415925f, 10.0f);
  input.ego.x_m = 45.0f;
  input.ego.speed_mps = 10.0f;
  input.tracks = &tracks;
  input.map = &map;
  input.running = &plan;
  for (cycle = 0; cycle < 5; ++cycle) {
    s4tp_explanation why;
    s4tp_plan_point now;
    input.start_ms = input.now_ms + S4TP_PLAN_STEP_MS;
    status = s4tp_make_plan(&planner, &input, &plan, &why);
    crc = crc32(crc, &plan, sizeof plan);
    crc = crc32(crc, (const char*)&why.chosen + kCosts, sizeof why.chosen - kCosts);
    printf("cycle %d: %s, kind %lu, %d candidates, intent %d, watches %d, crc %08lX\n", cycle,
           s4tp_status_name(status), (unsigned long)plan.kind, why.candidates, why.chosen.intent,
           why.dominating_track, (unsigned long)crc);
    if (status != S4TP_OK) return 1;

    /* A perfect car, and others that keep their speed. */
    input.now_ms += S4TP_PLAN_STEP_MS;
    s4tp_sample(&plan, input.now_ms, &now);
    input.ego.x_m = now.x_m;
    input.ego.y_m = now.y_m;
    input.ego.heading_rad = now.heading_rad;
    input.ego.speed_mps = now.speed_mps;
    input.ego.acceleration_mps2 = now.acceleration_mps2;
    tracks.time_ms = input.now_ms;
    tracks.items[0].x_m += 0.6f;
    tracks.items[1].x_m -= 1.0f;
  }
  return 0;
}
