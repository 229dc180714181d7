// Plays a replay: time, keys, and what stands beside the picture. #t=12.3 in the address shows that second; #t=12.3&play plays on.
'use strict';

(async () => {
  const bytes = Uint8Array.from(atob(document.getElementById('data').textContent), (digit) => digit.charCodeAt(0));
  const data = await new Response(new Blob([bytes]).stream().pipeThrough(new DecompressionStream('deflate'))).json();
  const element = (id) => document.getElementById(id);
  const scene = makeScene(element('scene'), data);
  const first = data.frames[0].t, last = data.frames[data.frames.length - 1].t;
  const kStep = 100;  // ms, of a frame and of a plan
  let time = first, playing = false, before = 0;
  const style = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

  // Words hold until others are said; a click on them shows the moment they begin.
  const story = data.cycles.filter((cycle) => cycle.words).map((cycle) => {
    const button = document.createElement('button');
    for (const text of [`${(cycle.t / 1000).toFixed(1)} s`, cycle.words]) {
      button.appendChild(document.createElement('span')).textContent = text;
    }
    button.addEventListener('click', () => { play(false); show(cycle.t); });
    element('story').appendChild(document.createElement('li')).appendChild(button);
    return { t: cycle.t, button };
  });
  element('told').hidden = story.length < 2;
  for (let i = 1; i < data.cycles.length; ++i) data.cycles[i].words ??= data.cycles[i - 1].words;
  const peak = (cycle, parts) => (cycle.risk ? Math.max(0, ...parts.flatMap((part) => cycle.risk[part])) : 0);
  const big = (value) => (Math.abs(value) >= 1000 ? `${(value / 1000).toFixed(1)}k` : value.toFixed(0));

  const canvasOf = (id) => {
    const canvas = element(id), ratio = window.devicePixelRatio || 1;
    canvas.width = Math.round(canvas.clientWidth * ratio);
    canvas.height = Math.round(canvas.clientHeight * ratio);
    const draw = canvas.getContext('2d');
    draw.setTransform(ratio, 0, 0, ratio, 0, 0);
    draw.clearRect(0, 0, canvas.clientWidth, canvas.clientHeight);
    draw.font = '12px system-ui, sans-serif';
    return { draw, width: canvas.clientWidth, height: canvas.clientHeight };
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

  // Over the whole episode: speed, gap, risk.
  const strips = [
    { name: 'speed', unit: 'm/s', colour: '--ego', points: data.frames.map((f) => [f.t, f.ego[3] / 100]) },
    { name: 'gap to the nearest car', unit: 'm', colour: '--other', cap: 20,
      points: data.frames.map((f) => [f.t, f.gap_cm < 0 ? 20 : f.gap_cm / 100]) },
    { name: 'largest risk in the plan, ours and theirs', unit: '', colour: '--haze',
      points: data.cycles.map((c) => [c.t, peak(c, [0, 2])]) },
  ].filter((strip) => strip.points.some(([, value]) => value > 0));
  const kLeft = 8;
  const drawStrips = () => {
    const { draw, width, height } = canvasOf('strip');
    const x = (t) => kLeft + ((width - 2 * kLeft) * Math.min(1, (t - first) / Math.max(1, last - first)));
    const each = (height - 16) / strips.length;
    draw.fillStyle = style('--soft');
    draw.textAlign = 'center';
    const every = last - first > 30000 ? 10000 : 2000;
    for (let t = Math.ceil(first / every) * every; t <= last; t += every) {
      curve(draw, [[x(t), 0], [x(t), height]], style('--stripe'), 1);
      if (t > first && t < last - every / 3) draw.fillText(`${t / 1000} s`, x(t), height - 3);
    }
    draw.textAlign = 'left';
    strips.forEach((strip, row) => {
      const top = row * each + 18, bottom = (row + 1) * each - 4;
      const most = strip.cap || Math.max(...strip.points.map(([, value]) => value), 1e-9);
      const colour = strip.colour === '--haze' ? `rgb(${style('--haze')})` : style(strip.colour);
      curve(draw, [[kLeft, bottom], [width - kLeft, bottom]], style('--line'), 1);
      curve(draw, strip.points.map(([t, value]) => [x(t), bottom - (bottom - top) * Math.min(1, value / most)]), colour);
      draw.fillStyle = style('--soft');
      const unit = strip.unit && ` ${strip.unit}`;
      draw.fillText(`${strip.name}, 0 to ${big(most) + unit}${strip.cap ? ' and more' : ''}`, kLeft, top - 6);
    });
    for (const contact of data.contacts) curve(draw, [[x(contact.t), 0], [x(contact.t), height]], style('--bad'), 1.5, [4, 3]);
    curve(draw, [[x(time), 0], [x(time), height]], style('--ink'), 1.2);
  };

  // Over the 3 s of the plan in force.
  const drawProfile = (cycle) => {
    const { draw, width, height } = canvasOf('profile');
    if (!cycle || !cycle.risk) return;
    const most = Math.max(1, ...cycle.risk.flat());
    const names = ['ours on cars', 'on the road’s edge', 'theirs on us'];
    const colours = [style('--ego'), style('--soft'), `rgb(${style('--haze')})`];
    const x = (i) => 4 + ((width - 8) * (i + 1)) / 15;
    curve(draw, [[4, height - 16], [width - 4, height - 16]], style('--line'), 1);
    let left = 4;
    cycle.risk.forEach((series, part) => {
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
  const row = (cells, tag = 'td') => `<tr>${cells.map((cell) => `<${tag}>${cell}</${tag}>`).join('')}</tr>`;
  const number = (tenths) => (tenths / 10).toFixed(1);
  const tell = (now) => {
    const cycle = now.cycle >= 0 ? data.cycles[now.cycle] : null;
    const frame = data.frames[now.index];
    const mode = (data.ecu_modes || []).filter(([t]) => t <= time).pop();
    const contact = data.contacts.find((one) => one.t <= time);
    element('words').textContent = contact ? `Collision: ${contact.cause}, car ${contact.car}.`
      : (cycle && cycle.words) || (cycle && cycle.kind === 2 ? 'Stopping at the least risk: the guard let no plan pass.'
        : 'This driver gives no reasons.');
    element('words').className = contact ? 'bad' : '';
    element('figures').innerHTML = [
      [`${(frame.ego[3] / 100).toFixed(1)} m/s`, 'speed'], [`${(frame.ego[4] / 100).toFixed(1)} m/s²`, 'acceleration'],
      [`${((frame.ego[5] / 1000) * 180 / Math.PI).toFixed(1)}°`, 'steering'],
      [frame.gap_cm < 0 ? 'alone' : `${(frame.gap_cm / 100).toFixed(1)} m`, 'gap'], [mode ? mode[1] : '–', 'ECU'],
    ].map(([value, name]) => `<div><b>${value}</b>${name}</div>`).join('');
    drawProfile(cycle);
    const current = story.filter(({ t }) => t <= time).pop();
    for (const one of story) one.button.classList.toggle('now', one === current);
    const list = element('story'), top = current ? current.button.offsetTop : 0;
    if (top < list.scrollTop || top > list.scrollTop + list.clientHeight - 40) list.scrollTop = top - 40;
    const explained = cycle && cycle.cost;
    element('reasons').hidden = !explained;
    if (!explained) return;
    const [count, infeasible, refused] = cycle.candidates;
    const sum = (costs) => costs.reduce((a, b) => a + b, 0);
    const other = sum(cycle.runner_up.map(Math.abs)) > 0;
    element('costs').innerHTML = row(['cost', 'this plan', 'next best'], 'th') +
      kTerms.map((name, i) => row([name, number(cycle.cost[i]), other ? number(cycle.runner_up[i]) : '–'])).join('') +
      row(['sum', number(sum(cycle.cost)), other ? number(sum(cycle.runner_up)) : '–'], 'th');
    const who = (id) => (id >= 0 ? `car ${id}` : 'nobody');
    element('numbers').textContent = cycle.numbers.replace(/^ {2}/gm, '');
    element('counts').textContent = `${count} candidates; rejected: ${infeasible} beyond the car's limits, ` +
      `${refused} refused by the guard. Most risk from ${who(cycle.riskiest)}; held up by ${who(cycle.held_up_by)}.`;
  };

  const show = (t) => {
    time = Math.min(last, Math.max(first, t));
    const now = scene.show(time);
    element('time').value = time;
    element('clock').textContent = `${(time / 1000).toFixed(2)} s of ${(last / 1000).toFixed(2)} s`;
    document.documentElement.dataset.end = (data.end_ms / 1000).toFixed(2);
    document.documentElement.dataset.time = (time / 1000).toFixed(2);
    drawStrips();
    tell(now);
  };
  const tick = (stamp) => {
    if (!playing) return;
    const passed = before ? stamp - before : 0;
    before = stamp;
    show(time + passed * Number(element('speed').value));
    if (time >= last) play(false); else requestAnimationFrame(tick);
  };
  const play = (on) => {
    if (on && time >= last) time = first;
    playing = on;
    before = 0;
    element('play').textContent = on ? '❚❚ pause' : '▶ play';
    if (on) requestAnimationFrame(tick);
  };
  const step = (by) => {
    play(false);
    show(Math.round(time / kStep + by) * kStep);
  };

  element('seen').hidden = !data.cycles.some((cycle) => cycle.seen);
  element('time').min = first;
  element('time').max = last;
  element('time').addEventListener('input', (event) => { play(false); show(Number(event.target.value)); });
  element('play').addEventListener('click', () => play(!playing));
  element('back').addEventListener('click', () => step(-1));
  element('forth').addEventListener('click', () => step(1));
  const seek = (event) => {
    if (event.type === 'pointermove' && !event.buttons) return;
    const area = element('strip').getBoundingClientRect();
    play(false);
    show(first + ((event.clientX - area.left - kLeft) / (area.width - 2 * kLeft)) * (last - first));
  };
  element('strip').addEventListener('pointerdown', seek);
  element('strip').addEventListener('pointermove', seek);
  const zoom = (by) => {
    scene.camera.reach_m = Math.min(150, Math.max(12, scene.camera.reach_m * by));
    show(time);
  };
  element('scene').addEventListener('wheel', (event) => { event.preventDefault(); zoom(event.deltaY > 0 ? 1.15 : 1 / 1.15); },
    { passive: false });
  for (const input of document.querySelectorAll('[data-layer]')) {
    input.addEventListener('change', () => { scene.layers[input.dataset.layer] = input.checked; show(time); });
  }
  document.addEventListener('keydown', (event) => {
    const speeds = [...element('speed').options].length;
    const keys = {
      ' ': () => play(!playing), ArrowLeft: () => step(event.shiftKey ? -10 : -1), ArrowRight: () => step(event.shiftKey ? 10 : 1),
      Home: () => show(first), End: () => show(last), '+': () => zoom(1 / 1.15), '-': () => zoom(1.15),
      ArrowUp: () => { element('speed').selectedIndex = Math.min(speeds - 1, element('speed').selectedIndex + 1); },
      ArrowDown: () => { element('speed').selectedIndex = Math.max(0, element('speed').selectedIndex - 1); },
    };
    const busy = ['BUTTON', 'SELECT'].includes(event.target.tagName) && (event.key === ' ' || event.key.startsWith('Arrow'));
    if (!keys[event.key] || busy || event.ctrlKey || event.altKey || event.metaKey) return;
    event.preventDefault();
    keys[event.key]();
  });
  window.addEventListener('resize', () => show(time));
  matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => show(time));

  const fromAddress = () => {
    const wanted = /t=([\d.]+)/.exec(location.hash);
    // Else shortly before what went wrong, or the beginning.
    show(wanted ? 1000 * Number(wanted[1]) : data.contacts.length ? data.contacts[0].t - 4000 : first);
    if (/\bplay\b/.test(location.hash)) play(true);
  };
  window.addEventListener('hashchange', fromAddress);
  fromAddress();
})();
