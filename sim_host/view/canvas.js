// What every drawing here is made with.
'use strict';

const element = (id) => document.getElementById(id);

// A colour of the style sheet; looked up once, as that is slow.
const colours = new Map();
const style = (name) => {
  if (!colours.has(name)) colours.set(name, getComputedStyle(document.documentElement).getPropertyValue(name).trim());
  return colours.get(name);
};
matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => colours.clear());

// Gives a canvas the pixels it is shown with. \return its size in CSS pixels, and how many pixels one of these is
const fit = (canvas) => {
  const ratio = window.devicePixelRatio || 1, width = canvas.clientWidth, height = canvas.clientHeight;
  if (canvas.width !== Math.round(width * ratio) || canvas.height !== Math.round(height * ratio)) {
    canvas.width = Math.round(width * ratio);
    canvas.height = Math.round(height * ratio);
  }
  return { width, height, ratio };
};
// A canvas of this id, cleared; one unit is a CSS pixel.
const canvasOf = (id) => {
  const { width, height, ratio } = fit(element(id));
  const draw = element(id).getContext('2d');
  draw.setTransform(ratio, 0, 0, ratio, 0, 0);
  draw.clearRect(0, 0, width, height);
  draw.font = '12px system-ui, sans-serif';
  draw.textAlign = 'left';
  return { draw, width, height };
};
const curve = (draw, points, colour, width = 1.8, dash = []) => {
  draw.strokeStyle = colour;
  draw.lineWidth = width;
  draw.setLineDash(dash);
  draw.beginPath();
  points.forEach(([x, y], i) => (i ? draw.lineTo(x, y) : draw.moveTo(x, y)));
  draw.stroke();
  draw.setLineDash([]);
};
const big = (value) => (Math.abs(value) >= 1000 ? `${(value / 1000).toFixed(1)}k` : value.toFixed(0));

// Risk over the 3 s of a plan. \param risk  three series of 15 values: ours on cars, on the road's edge, theirs on us
const drawProfile = (id, risk) => {
  const { draw, width, height } = canvasOf(id);
  if (!risk) return;
  const most = Math.max(1, ...risk.flat());
  const names = ['ours on cars', 'on the road’s edge', 'theirs on us'];
  const colours = [style('--ego'), style('--soft'), `rgb(${style('--haze')})`];
  const x = (i) => 4 + ((width - 8) * (i + 1)) / 15;
  curve(draw, [[4, height - 16], [width - 4, height - 16]], style('--line'), 1);
  let left = 4;
  risk.forEach((series, part) => {
    curve(draw, series.map((value, i) => [x(i), height - 16 - ((height - 50) * value) / most]), colours[part], 2,
      [[], [2, 3], [7, 3]][part]);
    curve(draw, [[left, 20], [left + 18, 20]], colours[part], 2, [[], [2, 3], [7, 3]][part]);
    draw.fillStyle = style('--ink');
    draw.fillText(names[part], left + 22, 24);
    left += 36 + draw.measureText(names[part]).width;
  });
  draw.fillStyle = style('--soft');
  draw.fillText('now', 4, height - 3);
  draw.textAlign = 'right';
  draw.fillText(`in 3 s; highest ${big(most)}`, width - 4, height - 3);
  draw.textAlign = 'left';
};

const kTerms = ['progress', 'speed', 'jerk', 'sideways', 'lane', 'risk'];
const tableRow = (cells, tag = 'td') => `<tr>${cells.map((cell) => `<${tag}>${cell}</${tag}>`).join('')}</tr>`;
// Costs of a plan and of the next best one, by kTerms, in tenths.
const costTable = (cost, runnerUp) => {
  const number = (tenths) => (tenths / 10).toFixed(1);
  const sum = (costs) => costs.reduce((a, b) => a + b, 0);
  const other = sum(runnerUp.map(Math.abs)) > 0;
  return tableRow(['cost', 'this plan', 'next best'], 'th') +
    kTerms.map((name, i) => tableRow([name, number(cost[i]), other ? number(runnerUp[i]) : '–'])).join('') +
    tableRow(['sum', number(sum(cost)), other ? number(sum(runnerUp)) : '–'], 'th');
};
