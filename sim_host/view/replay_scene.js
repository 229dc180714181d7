// What a replay shows at a time: its data as moments of scene.js. Lengths in m, network directions.
'use strict';

function makeReplay(data) {
  const unit = data.unit_m;
  // From each point's distance to the one before, in units.
  const line = (steps) => {
    const points = [];
    let x = 0, y = 0;
    for (let i = 0; i < steps.length; i += 2) points.push([(x += steps[i]) * unit, (y += steps[i + 1]) * unit]);
    return points;
  };
  const road = data.road.map((lane) => ({ width: lane.width_mm / 1000, junction: lane.junction, line: line(lane.line) }));
  const goal = data.goal.map((value) => value * unit);
  for (const cycle of data.cycles) {
    cycle.planLine = line(cycle.plan);
    cycle.futures = cycle.modes.map(([car, percent, yields, steps]) => ({ car, percent, yields, line: line(steps) }));
    cycle.boxes = cycle.seen && cycle.seen.map(([x, y, heading, length, width]) =>
      [x * unit, y * unit, heading / 1000, length / 1000, width / 1000]);
  }
  const mix = (a, b, f) => a + (b - a) * f;
  const car = (id, raw, at) => {
    const [length, width] = data.sizes_mm[id].map((mm) => mm / 1000);
    return { id, x: raw[at] * unit, y: raw[at + 1] * unit, heading: raw[at + 2] / 1000, speed: raw[at + 3] / 100, length, width };
  };
  const frames = data.frames.map((frame) => {
    const others = new Map();
    for (let i = 0; i < frame.cars.length; i += 5) others.set(frame.cars[i], car(frame.cars[i], frame.cars, i + 1));
    const haze = frame.haze && { grid: frame.haze, columns: data.haze_columns, cell: data.haze_cell * unit,
      x: frame.haze_at[0] * unit, y: frame.haze_at[1] * unit };
    return { t: frame.t, ego: car(0, frame.ego, 0), others, haze };
  });

  const between = (a, b, f) => {
    const turn = Math.atan2(Math.sin(b.heading - a.heading), Math.cos(b.heading - a.heading));
    return { ...a, x: mix(a.x, b.x, f), y: mix(a.y, b.y, f), heading: a.heading + turn * f, speed: mix(a.speed, b.speed, f) };
  };
  const lastAt = (list, t) => {  // the last that has begun
    let low = 0, high = list.length - 1;
    while (low < high) {
      const middle = (low + high + 1) >> 1;
      if (list[middle].t <= t) low = middle; else high = middle - 1;
    }
    return low;
  };

  // What there is at a time, between two frames where it falls there: the moment, its frame's index and its cycle's.
  return (t) => {
    const index = lastAt(frames, t);
    const now = frames[index], next = frames[Math.min(index + 1, frames.length - 1)];
    const f = next.t > now.t ? Math.min(1, Math.max(0, (t - now.t) / (next.t - now.t))) : 0;
    const others = [];
    for (const [id, one] of now.others) others.push(next.others.has(id) ? between(one, next.others.get(id), f) : one);
    const number = data.cycles.length && data.cycles[0].t <= t ? lastAt(data.cycles, t) : -1;
    const cycle = number >= 0 ? data.cycles[number] : {};
    const ego = between(now.ego, next.ego, f);
    const contact = data.contacts.filter((one) => one.t <= t).pop();
    const touched = contact && (others.find((one) => one.id === contact.car) || ego);
    const moment = {
      road, goal, ego, others, haze: now.haze, way: frames.slice(0, index + 1).map((frame) => [frame.ego.x, frame.ego.y]),
      plan: cycle.planLine, futures: cycle.futures, riskiest: cycle.riskiest, blockedBy: cycle.blocked_by, seen: cycle.boxes,
      touch: touched && [(touched.x + ego.x) / 2, (touched.y + ego.y) / 2],
    };
    return { moment, index, cycle: number };
  };
}
