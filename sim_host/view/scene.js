// The bird's-eye view of a moment, for replay and live view. Lengths in m, y up, around our car:
//   road [{width, junction, line}], goal [x, y], ego, others [{id, x, y, heading, speed, length, width}], way, plan, failSafe,
//   futures [{car, percent, yields, line}], candidates [{part 0 cheapest .. 1 dearest or null, chosen, line}],
//   haze {grid, columns, cell, x, y, heading: of its lowest left corner}, riskiest, blockedBy, picked: ids,
//   seen [[x, y, heading, length, width]], touch [x, y]. All but road, ego and others may be missing.
'use strict';

function makeScene(canvas) {
  const draw = canvas.getContext('2d');
  const camera = { reach_m: 54 };  // half of what is seen from left to right
  const layers = { plan: true, futures: true, candidates: true, haze: true, way: true, labels: true, seen: true };
  let toPixels = null, shown = null;

  const hazeImage = document.createElement('canvas');
  let hazeOf = null;
  const paintHaze = (haze) => {
    if (hazeOf !== haze.grid) {
      const colour = style('--haze').split(',').map(Number);
      const depths = [];
      for (const [, count, letter] of haze.grid.matchAll(/(\d*)([a-p])/g)) {
        const depth = letter.charCodeAt(0) - 97;
        for (let i = Number(count || 1); i > 0; --i) depths.push(depth);
      }
      const rows = depths.length / haze.columns;
      hazeImage.width = haze.columns;
      hazeImage.height = rows;
      const pixels = new ImageData(haze.columns, rows);
      depths.forEach((depth, i) => pixels.data.set([...colour, Math.round(13 * depth)], 4 * i));
      hazeImage.getContext('2d').putImageData(pixels, 0, 0);
      hazeOf = haze.grid;
    }
    // Its rows run upwards, as y does here.
    draw.save();
    draw.translate(haze.x, haze.y);
    draw.rotate(haze.heading || 0);
    draw.drawImage(hazeImage, 0, 0, haze.columns * haze.cell, hazeImage.height * haze.cell);
    draw.restore();
  };

  const stroke = (points, colour, width, dash) => curve(draw, points, colour, width, dash);
  const dots = (points, begin, colour, radius) => {  // a second apart
    draw.fillStyle = colour;
    for (let i = begin; i < points.length; i += 5) {
      draw.beginPath();
      draw.arc(points[i][0], points[i][1], radius, 0, 7);
      draw.fill();
    }
  };
  const ring = (x, y, radius, colour, width) => {
    draw.strokeStyle = colour;
    draw.lineWidth = width;
    draw.beginPath();
    draw.arc(x, y, radius, 0, 7);
    draw.stroke();
  };
  const box = (one, colour, frames = []) => {
    draw.save();
    draw.translate(one.x, one.y);
    draw.rotate(one.heading);
    draw.fillStyle = colour;
    draw.beginPath();
    draw.roundRect(-one.length / 2, -one.width / 2, one.length, one.width, one.width / 4);
    draw.fill();
    draw.fillStyle = style('--glass');
    draw.fillRect(one.length * 0.12, -0.38 * one.width, one.length * 0.13, 0.76 * one.width);
    for (const frame of frames) {
      draw.strokeStyle = frame.colour;
      draw.lineWidth = 0.4;
      draw.setLineDash(frame.dash);
      const by = frame.by;
      draw.strokeRect(-one.length / 2 - by, -one.width / 2 - by, one.length + 2 * by, one.width + 2 * by);
      draw.setLineDash([]);
    }
    draw.restore();
  };

  const paintWays = (moment) => {
    if (layers.candidates) {
      const dearestFirst = [...(moment.candidates || [])].sort((a, b) => (b.part ?? 2) - (a.part ?? 2));
      for (const one of dearestFirst) {
        draw.globalAlpha = one.part === null ? 0.35 : 0.85;
        // From cheap to dear through the colours of viridis: told apart by colour-blind eyes, and by brightness.
        const colour = one.part === null ? style('--soft') : `hsl(${48 + 230 * one.part}, 75%, ${58 - 28 * one.part}%)`;
        stroke(one.line, colour, one.part === null ? 0.12 : 0.3);
      }
      draw.globalAlpha = 1;
    }
    if (layers.futures) {
      for (const future of moment.futures || []) {
        const aside = moment.picked >= 0 && future.car !== moment.picked;
        draw.globalAlpha = (0.3 + 0.007 * future.percent) * (aside ? 0.25 : 1);
        stroke(future.line, style('--future'), 0.25 + 0.006 * future.percent, future.yields ? [0.9, 0.7] : []);
        dots(future.line, 4, style('--future'), 0.45);
      }
      draw.globalAlpha = 1;
    }
    if (layers.plan && moment.failSafe) stroke(moment.failSafe, style('--bad'), 0.3, [0.5, 0.5]);
    if (layers.plan && moment.plan) {
      stroke(moment.plan, style('--plan'), 0.7);
      dots(moment.plan, 5, style('--plan'), 0.6);
    }
  };

  const paintOthers = (moment) => {
    for (const one of moment.others) {
      const frames = [];
      if (one.id === moment.riskiest) frames.push({ colour: `rgb(${style('--haze')})`, dash: [], by: 0.7 });
      if (one.id === moment.blockedBy) frames.push({ colour: style('--plan'), dash: [1, 0.6], by: 0.7 });
      if (one.id === moment.picked) frames.push({ colour: style('--ink'), dash: [], by: 1.3 });
      box(one, style('--other'), frames);
    }
    if (!layers.seen || !moment.seen) return;
    draw.strokeStyle = style('--ink');
    draw.lineWidth = 0.18;
    draw.setLineDash([0.6, 0.4]);
    for (const [x, y, heading, length, wide] of moment.seen) {
      draw.save();
      draw.translate(x, y);
      draw.rotate(heading);
      draw.strokeRect(-length / 2, -wide / 2, length, wide);
      draw.restore();
    }
    draw.setLineDash([]);
  };

  const label = (text, x, y, colour, halo) => {
    if (halo) {
      draw.strokeStyle = style('--halo');
      draw.lineWidth = 3;
      draw.strokeText(text, x, y);
    }
    draw.fillStyle = colour;
    draw.fillText(text, x, y);
  };
  const paintWords = (moment, scale, width, height) => {
    draw.textAlign = 'center';
    draw.textBaseline = 'middle';
    if (layers.labels) {
      for (const one of moment.others) {
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
    for (const one of moment.others.filter(({ id }) => [moment.riskiest, moment.blockedBy, moment.picked].includes(id))) {
      const [x, y] = toPixels(one);
      if (x > 0 && x < width && y > 0 && y < height) continue;
      const dx = x - width / 2, dy = y - height / 2;
      const f = Math.min((width / 2 - 60) / Math.max(Math.abs(dx), 1), (height / 2 - 24) / Math.max(Math.abs(dy), 1));
      const arrow = Math.abs(dx) > Math.abs(dy) ? (dx > 0 ? '→' : '←') : dy > 0 ? '↓' : '↑';
      label(`${arrow} car ${one.id}, ${(Math.hypot(dx, dy) / scale).toFixed(0)} m`, width / 2 + f * dx, height / 2 + f * dy,
        style('--other'), true);
    }
    const bar = 10 * scale;  // 10 m
    stroke([[14, height - 14], [14 + bar, height - 14]], style('--ink'), 2);
    draw.font = '12px system-ui, sans-serif';
    draw.textAlign = 'center';
    label('10 m', 14 + bar / 2, height - 24, style('--ink'), true);
  };

  const show = (moment) => {
    shown = moment;
    const { width, height, ratio } = fit(canvas);
    const ego = moment.ego, scale = width / (2 * camera.reach_m);
    toPixels = (one) => [width / 2 + (one.x - ego.x) * scale, height / 2 - (one.y - ego.y) * scale];
    draw.setTransform(1, 0, 0, 1, 0, 0);
    draw.fillStyle = style('--ground');
    draw.fillRect(0, 0, canvas.width, canvas.height);
    draw.setTransform(scale * ratio, 0, 0, -scale * ratio,
      (width / 2 - ego.x * scale) * ratio, (height / 2 + ego.y * scale) * ratio);
    draw.lineJoin = 'round';
    for (const lane of moment.road) stroke(lane.line, style('--edge'), lane.width + 0.3);
    for (const lane of moment.road) stroke(lane.line, style('--road'), lane.width - (lane.junction ? -0.1 : 0.15));
    if (moment.goal) for (const radius of [2.4, 1.2]) ring(...moment.goal, radius, style('--good'), 0.4);
    if (layers.haze && moment.haze && moment.haze.grid) paintHaze(moment.haze);
    if (layers.way && moment.way) stroke([...moment.way, [ego.x, ego.y]], style('--ego'), 0.25);
    paintWays(moment);
    paintOthers(moment);
    box(ego, style('--ego'));
    if (moment.touch) ring(...moment.touch, 4.2, style('--bad'), 0.5);
    draw.setTransform(ratio, 0, 0, ratio, 0, 0);
    paintWords(moment, scale, width, height);
  };

  // Who stands at this place of the canvas, in CSS pixels; -1: nobody.
  const vehicleAt = (x, y) => {
    if (!shown) return -1;
    const scale = canvas.clientWidth / (2 * camera.reach_m);
    for (const one of shown.others) {
      const [atX, atY] = toPixels(one);
      if (Math.hypot(atX - x, atY - y) < Math.max(14, 0.5 * one.length * scale)) return one.id;
    }
    return -1;
  };
  const zoom = (by) => { camera.reach_m = Math.min(150, Math.max(12, camera.reach_m * by)); };
  return { show, vehicleAt, zoom, layers };
}
