// Plays a replay: time, keys, and what stands beside the picture. #t=12.3 in the address shows that second; #t=12.3&play plays on.
'use strict';

(async () => {
  const bytes = Uint8Array.from(atob(document.getElementById('data').textContent), (digit) => digit.charCodeAt(0));
  const data = await new Response(new Blob([bytes]).stream().pipeThrough(new DecompressionStream('deflate'))).json();
  const replay = makeReplay(data);
  const scene = makeScene(element('scene'));
  const first = data.frames[0].t, last = data.frames[data.frames.length - 1].t;
  const kStep = 100;  // ms, of a frame and of a plan
  let time = first, playing = false, before = 0;

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
    drawProfile('profile', cycle && cycle.risk);
    const current = story.filter(({ t }) => t <= time).pop();
    for (const one of story) one.button.classList.toggle('now', one === current);
    const list = element('story'), top = current ? current.button.offsetTop : 0;
    if (top < list.scrollTop || top > list.scrollTop + list.clientHeight - 40) list.scrollTop = top - 40;
    const explained = cycle && cycle.cost;
    element('reasons').hidden = !explained;
    if (!explained) return;
    const [count, infeasible, refused] = cycle.candidates;
    element('costs').innerHTML = costTable(cycle.cost, cycle.runner_up);
    const who = (id) => (id >= 0 ? `car ${id}` : 'nobody');
    element('numbers').textContent = cycle.numbers.replace(/^ {2}/gm, '');
    element('counts').textContent = `${count} candidates; rejected: ${infeasible} beyond the car's limits, ` +
      `${refused} refused by the guard. Most risk from ${who(cycle.riskiest)}; blocked by ${who(cycle.blocked_by)}.`;
  };

  const show = (t) => {
    time = Math.min(last, Math.max(first, t));
    const now = replay(time);
    scene.show(now.moment);
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
    scene.zoom(by);
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
