// The bird's-eye view of a replay. Lengths in m, network directions, y up.
'use strict';

function makeScene(canvas, data) {
  const draw = canvas.getContext('2d');
  const unit = data.unit_m;
  const camera = { reach_m: 54 };  // half of what is seen from left to right
  const layers = { plan: true, futures: true, haze: true, way: true, labels: true, seen: true };
  const style = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

  // From each point's distance to the one before, in units.
  const line = (steps) => {
    const points = [];
    let x = 0, y = 0;
    for (let i = 0; i < steps.length; i += 2) points.push([(x += steps[i]) * unit, (y += steps[i + 1]) * unit]);
    return points;
  };
  const road = data.road.map((lane) => ({ width: lane.width_mm / 1000, junction: lane.junction, line: line(lane.line) }));
  for (const cycle of data.cycles) {
    cycle.planLine = line(cycle.plan);
    cycle.futures = cycle.modes.map(([car, percent, yields, steps]) => ({ car, percent, yields, line: line(steps) }));
  }
  const mix = (a, b, f) => a + (b - a) * f;
  const car = (id, raw, at) => {
    const [length, width] = data.sizes_mm[id].map((mm) => mm / 1000);
    return { id, x: raw[at] * unit, y: raw[at + 1] * unit, heading: raw[at + 2] / 1000, speed: raw[at + 3] / 100, length, width };
  };
  const frames = data.frames.map((frame) => {
    const others = new Map();
    for (let i = 0; i < frame.cars.length; i += 5) others.set(frame.cars[i], car(frame.cars[i], frame.cars, i + 1));
    return { t: frame.t, ego: car(0, frame.ego, 0), others };
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

  // What there is at a time, between two frames where it falls there.
  const at = (t) => {
    const index = lastAt(frames, t);
    const now = frames[index], next = frames[Math.min(index + 1, frames.length - 1)];
    const f = next.t > now.t ? Math.min(1, Math.max(0, (t - now.t) / (next.t - now.t))) : 0;
    const others = [];
    for (const [id, one] of now.others) others.push(next.others.has(id) ? between(one, next.others.get(id), f) : one);
    const cycle = data.cycles.length && data.cycles[0].t <= t ? lastAt(data.cycles, t) : -1;
    return { index, ego: between(now.ego, next.ego, f), others, cycle };
  };

  const hazeImage = document.createElement('canvas');
  let hazeOf = null;
  const paintHaze = (index) => {
    const frame = data.frames[index];
    if (!frame.haze) return;
    const columns = data.haze_columns, size = data.haze_cell * unit;
    if (hazeOf !== frame) {
      const colour = style('--haze').split(',').map(Number);
      const depths = [];
      for (const [, count, letter] of frame.haze.matchAll(/(\d*)([a-p])/g)) {
        const depth = letter.charCodeAt(0) - 97;
        for (let i = Number(count || 1); i > 0; --i) depths.push(depth);
      }
      const rows = depths.length / columns;
      hazeImage.width = columns;
      hazeImage.height = rows;
      const pixels = new ImageData(columns, rows);
      depths.forEach((depth, i) => pixels.data.set([...colour, Math.round(13 * depth)], 4 * i));
      hazeImage.getContext('2d').putImageData(pixels, 0, 0);
      hazeOf = frame;
    }
    // Its rows run upwards, as y does here.
    draw.imageSmoothingQuality = 'high';
    draw.drawImage(hazeImage, frame.haze_at[0] * unit, frame.haze_at[1] * unit, columns * size, hazeImage.height * size);
  };

  const stroke = (points, colour, width, dash = []) => {
    draw.strokeStyle = colour;
    draw.lineWidth = width;
    draw.setLineDash(dash);
    draw.beginPath();
    points.forEach(([x, y], i) => (i ? draw.lineTo(x, y) : draw.moveTo(x, y)));
    draw.stroke();
    draw.setLineDash([]);
  };
  const dots = (points, begin, colour, radius) => {  // a second apart
    draw.fillStyle = colour;
    for (let i = begin; i < points.length; i += 5) {
      draw.beginPath();
      draw.arc(points[i][0], points[i][1], radius, 0, 7);
      draw.fill();
    }
  };
  const box = (one, colour, ring) => {
    draw.save();
    draw.translate(one.x, one.y);
    draw.rotate(one.heading);
    draw.fillStyle = colour;
    draw.beginPath();
    draw.roundRect(-one.length / 2, -one.width / 2, one.length, one.width, one.width / 4);
    draw.fill();
    draw.fillStyle = style('--glass');
    draw.fillRect(one.length * 0.12, -0.38 * one.width, one.length * 0.13, 0.76 * one.width);
    if (ring) {
      draw.strokeStyle = ring.colour;
      draw.lineWidth = 0.4;
      draw.setLineDash(ring.dash);
      draw.strokeRect(-one.length / 2 - 0.7, -one.width / 2 - 0.7, one.length + 1.4, one.width + 1.4);
      draw.setLineDash([]);
    }
    draw.restore();
  };

  const show = (t) => {
    const ratio = window.devicePixelRatio || 1;
    const width = canvas.clientWidth, height = canvas.clientHeight;
    if (canvas.width !== Math.round(width * ratio) || canvas.height !== Math.round(height * ratio)) {
      canvas.width = Math.round(width * ratio);
      canvas.height = Math.round(height * ratio);
    }
    const now = at(t);
    const cycle = now.cycle >= 0 ? data.cycles[now.cycle] : null;
    const scale = width / (2 * camera.reach_m);
    const toMetres = () => draw.setTransform(scale * ratio, 0, 0, -scale * ratio,
      (width / 2 - now.ego.x * scale) * ratio, (height / 2 + now.ego.y * scale) * ratio);
    draw.setTransform(1, 0, 0, 1, 0, 0);
    draw.fillStyle = style('--ground');
    draw.fillRect(0, 0, canvas.width, canvas.height);
    toMetres();
    draw.lineJoin = 'round';
    for (const lane of road) stroke(lane.line, style('--edge'), lane.width + 0.3);
    for (const lane of road) stroke(lane.line, style('--road'), lane.width - (lane.junction ? -0.1 : 0.15));
    const [goalX, goalY] = data.goal.map((value) => value * unit);
    for (const radius of [2.4, 1.2]) {
      draw.strokeStyle = style('--good');
      draw.lineWidth = 0.4;
      draw.beginPath();
      draw.arc(goalX, goalY, radius, 0, 7);
      draw.stroke();
    }

    if (layers.haze) paintHaze(now.index);
    if (layers.way) {
      const way = frames.slice(0, now.index + 1).map((frame) => [frame.ego.x, frame.ego.y]);
      stroke([...way, [now.ego.x, now.ego.y]], style('--ego'), 0.25);
    }
    if (layers.futures && cycle) {
      for (const future of cycle.futures) {
        draw.globalAlpha = 0.3 + 0.007 * future.percent;
        stroke(future.line, style('--future'), 0.25 + 0.006 * future.percent, future.yields ? [0.9, 0.7] : []);
        dots(future.line, 4, style('--future'), 0.45);
      }
      draw.globalAlpha = 1;
    }
    if (layers.plan && cycle) {
      stroke(cycle.planLine, style('--plan'), 0.7);
      dots(cycle.planLine, 5, style('--plan'), 0.6);
    }
    for (const one of now.others) {
      let ring = null;
      if (cycle && one.id === cycle.riskiest) ring = { colour: `rgb(${style('--haze')})`, dash: [] };
      if (cycle && one.id === cycle.held_up_by) ring = { colour: style('--plan'), dash: [1, 0.6] };
      box(one, style('--other'), ring);
    }
    if (layers.seen && cycle && cycle.seen) {
      draw.strokeStyle = style('--ink');
      draw.lineWidth = 0.18;
      draw.setLineDash([0.6, 0.4]);
      for (const [x, y, heading, length, wide] of cycle.seen) {
        draw.save();
        draw.translate(x * unit, y * unit);
        draw.rotate(heading / 1000);
        draw.strokeRect(-length / 2000, -wide / 2000, length / 1000, wide / 1000);
        draw.restore();
      }
      draw.setLineDash([]);
    }
    box(now.ego, style('--ego'));
    for (const contact of data.contacts) {
      if (t < contact.t) continue;
      const touched = now.others.find((one) => one.id === contact.car) || now.ego;
      draw.strokeStyle = style('--bad');
      draw.lineWidth = 0.5;
      draw.beginPath();
      draw.arc((touched.x + now.ego.x) / 2, (touched.y + now.ego.y) / 2, 4.2, 0, 7);
      draw.stroke();
    }

    draw.setTransform(ratio, 0, 0, ratio, 0, 0);
    const label = (text, x, y, colour, halo) => {
      if (halo) {
        draw.strokeStyle = style('--halo');
        draw.lineWidth = 3;
        draw.strokeText(text, x, y);
      }
      draw.fillStyle = colour;
      draw.fillText(text, x, y);
    };
    draw.textAlign = 'center';
    draw.textBaseline = 'middle';
    const toPixels = (one) => [width / 2 + (one.x - now.ego.x) * scale, height / 2 - (one.y - now.ego.y) * scale];
    if (layers.labels) {
      for (const one of now.others) {
        const [x, y] = toPixels(one);
        draw.font = '600 11px system-ui, sans-serif';
        draw.textAlign = 'center';
        label(String(one.id), x, y, style('--card'));
        draw.font = '11px system-ui, sans-serif';
        const upright = Math.abs(Math.sin(one.heading)) > 0.6;  // then beside it, else above
        if (upright) draw.textAlign = 'left';
        label(`${one.speed.toFixed(1)} m/s`, x + (upright ? 2.2 * scale : 0), y - (upright ? 0 : 2 * scale + 6), style('--soft'), true);
      }
    }
    // Who matters and is out of sight: where, and how far.
    draw.font = '600 12px system-ui, sans-serif';
    draw.textAlign = 'center';
    for (const one of now.others.filter(({ id }) => cycle && (id === cycle.riskiest || id === cycle.held_up_by))) {
      const [x, y] = toPixels(one);
      if (x > 0 && x < width && y > 0 && y < height) continue;
      const dx = x - width / 2, dy = y - height / 2;
      const f = Math.min((width / 2 - 60) / Math.max(Math.abs(dx), 1), (height / 2 - 24) / Math.max(Math.abs(dy), 1));
      const arrow = Math.abs(dx) > Math.abs(dy) ? (dx > 0 ? '→' : '←') : dy > 0 ? '↓' : '↑';
      label(`${arrow} car ${one.id}, ${(Math.hypot(dx, dy) / scale).toFixed(0)} m`, width / 2 + f * dx, height / 2 + f * dy,
        style('--other'), true);
    }
    const bar = 10 * scale;  // 10 m
    draw.strokeStyle = style('--ink');
    draw.lineWidth = 2;
    draw.beginPath();
    draw.moveTo(14, height - 14);
    draw.lineTo(14 + bar, height - 14);
    draw.stroke();
    draw.font = '12px system-ui, sans-serif';
    draw.textAlign = 'center';
    label('10 m', 14 + bar / 2, height - 24, style('--ink'), true);
    return now;
  };
  return { show, at, layers, camera };
}
