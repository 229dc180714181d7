// The live view: takes a message a planning cycle, keeps the last minutes, shows one of them.
'use strict';

(() => {
  const kKept = 1800, kCycleMs = 100, kWayCycles = 400, kToldMost = 60;
  const cycles = [];
  let state = { present: false, absence: 'not connected yet' };
  let connected = false, asked = false;
  let held = null;    // number of the cycle shown; null: always the newest
  let picked = -1;
  const scene = makeScene(element('scene'));
  const root = document.documentElement;
  const escaped = (text) => String(text).replace(/[&<>"]/g, (c) => ({ '&': '&amp;', '<': '&lt;', '>': '&gt;', '"': '&quot;' })[c]);

  const pairs = (flat) => {
    const points = [];
    for (let i = 0; i < flat.length; i += 2) points.push([flat[i], flat[i + 1]]);
    return points;
  };
  const lines = (list) => list.map((one) => ({ ...one, line: pairs(one.line) }));

  // Which of the cycles kept.
  const indexShown = () => {
    if (held === null || !cycles.length) return cycles.length - 1;
    return Math.min(cycles.length - 1, Math.max(0, held - cycles[0].number));
  };
  const momentOf = (index) => {
    const cycle = cycles[index], way = [];
    for (let i = Math.max(0, index - kWayCycles); i <= index; ++i) {
      if (cycles[i].ecu_number === cycle.ecu_number) way.push([cycles[i].ego.x, cycles[i].ego.y]);
    }
    return {
      road: lines(cycle.road), ego: cycle.ego, others: cycle.vehicles, way, plan: pairs(cycle.plan),
      failSafe: pairs(cycle.fail_safe), futures: lines(cycle.futures), candidates: lines(cycle.candidates), haze: cycle.haze,
      riskiest: cycle.riskiest, blockedBy: cycle.who.blocks ? cycle.who.id : -1, picked,
    };
  };

  // Speed, risk and time of planning over what is kept.
  const planningMs = (cycle) => cycle.stages.reduce((sum, stage) => sum + stage.us, 0) / 1000;
  const peakRisk = (cycle) => Math.max(0, ...cycle.risk[0], ...cycle.risk[2]);
  const kStrips = [
    { name: 'speed', unit: ' m/s', colour: () => style('--ego'), value: (cycle) => cycle.ego.speed, least: 5 },
    { name: 'largest risk in the plan', unit: '', colour: () => `rgb(${style('--haze')})`, value: peakRisk, least: 100 },
    { name: 'planning', unit: ' ms of 100', colour: () => style('--soft'), value: planningMs, least: 5 },
  ];
  const kLeft = 8;
  const span = () => Math.max(600, cycles.length - 1);
  const stripX = (index, width) => kLeft + ((width - 2 * kLeft) * (index + span() - (cycles.length - 1))) / span();
  const drawStrips = (shown) => {
    const { draw, width, height } = canvasOf('strip');
    if (!cycles.length) return;
    const newest = cycles.length - 1, each = (height - 16) / kStrips.length;
    draw.textAlign = 'center';
    for (let ago = 0; ago <= span(); ago += 150) {
      const x = stripX(newest - ago, width);
      curve(draw, [[x, 0], [x, height]], style('--stripe'), 1);
      draw.fillStyle = style('--soft');
      if (ago && x > 20) draw.fillText(`${(-ago * kCycleMs) / 1000} s`, x, height - 3);
    }
    draw.textAlign = 'left';
    const every = Math.max(1, Math.floor(cycles.length / 600));
    kStrips.forEach((strip, row) => {
      const top = row * each + 18, bottom = (row + 1) * each - 4;
      const points = [];
      let most = strip.least, peak = 0;
      for (let i = 0; i < cycles.length; ++i) {
        peak = Math.max(peak, strip.value(cycles[i]));
        if (i % every && i !== newest) continue;
        points.push([stripX(i, width), peak]);
        most = Math.max(most, peak);
        peak = 0;
      }
      curve(draw, [[kLeft, bottom], [width - kLeft, bottom]], style('--line'), 1);
      curve(draw, points.map(([x, value]) => [x, bottom - ((bottom - top) * value) / most]), strip.colour());
      draw.fillStyle = style('--soft');
      draw.fillText(`${strip.name}, 0 to ${big(most)}${strip.unit}`, kLeft, top - 6);
    });
    for (let i = 1; i < cycles.length; ++i) {  // another ECU from here on
      if (cycles[i].ecu_number === cycles[i - 1].ecu_number) continue;
      curve(draw, [[stripX(i, width), 0], [stripX(i, width), height]], style('--bad'), 1.5, [4, 3]);
    }
    curve(draw, [[stripX(shown, width), 0], [stripX(shown, width), height]], style('--ink'), 1.2);
  };

  const whither = (future, line) => {
    const [[x0, y0], [x1, y1]] = line.slice(0, 2), [[x2, y2], [x3, y3]] = line.slice(-2);
    const begin = [x1 - x0, y1 - y0], end = [x3 - x2, y3 - y2];
    const turn = Math.atan2(begin[0] * end[1] - begin[1] * end[0], begin[0] * end[0] + begin[1] * end[1]);
    const way = Math.abs(turn) < 0.4 ? 'straight on' : turn > 0 ? 'turning left' : 'turning right';
    return `${way}${future.yields ? ', letting us go first' : ''}`;
  };
  const share = (percent, colour) => `<span class="bar"><i style="width: ${Math.min(100, percent)}%; background: ${colour}"></i></span>`;
  const tellWhy = (cycle) => {
    const who = cycle.who, it = who.id >= 0 ? `${who.name} (car ${who.id})` : 'nobody';
    element('words').textContent = cycle.words;
    element('blocker').textContent = who.blocks || who.id < 0 ? it : `nobody; to watch: ${it}`;
    element('belief').textContent = who.belief ? `it ${who.belief}` : who.id >= 0 ? 'whether it lets us go first is no question' : '–';
    element('claim').textContent = who.claim ? `it ${who.claim}` : who.id >= 0 ? 'none: it drives where we drive, or our ways do not meet' : '–';
  };
  const tellVehicles = (cycle) => {
    const rows = [...cycle.vehicles].sort((a, b) => b.risk - a.risk);
    element('vehicles').innerHTML = tableRow(['car', 'speed', 'lets us<br>go first', 'share of<br>our risk'], 'th') + rows.map((one) =>
      `<tr data-car="${one.id}" class="${one.id === picked ? 'now' : ''}"><td>${one.id}: ${escaped(one.name)}</td>` +
      `<td>${one.speed.toFixed(1)} m/s</td><td>${one.gives_way === null ? '–' : `${one.gives_way} %`}</td>` +
      `<td>${share(one.risk, 'rgb(var(--haze))')} ${one.risk} %</td></tr>`).join('');
    const one = cycle.vehicles.find(({ id }) => id === picked);
    if (picked < 0) {
      element('picked').textContent = 'Click a vehicle: its prediction, and its share of our risk.';
    } else if (!one) {
      element('picked').textContent = `Car ${picked} is out of sight.`;
    } else {
      const futures = cycle.futures.filter(({ car }) => car === picked)
        .map((one) => `${one.percent} % ${whither(one, pairs(one.line))}`);
      element('picked').textContent = `Car ${picked}, ${one.name}: ` +
        `${futures.length ? `expected: ${futures.join(', ')}` : 'expected to keep lane and speed'}. ` +
        `Its share of our risk: ${one.risk} %.${one.claim ? ` It ${one.claim}.` : ''}`;
    }
  };
  const tellUnit = (cycle) => {
    const ecu = cycle.ecu, total = planningMs(cycle);
    element('stages').innerHTML = tableRow(['stage', 'time', '', 'work', ''], 'th') + cycle.stages.map((stage) =>
      tableRow([stage.name, `${(stage.us / 1000).toFixed(2)} ms`, share(total ? stage.us / total / 10 : 0, 'var(--accent)'),
        stage.most ? `${stage.work} of ${stage.most}` : stage.work || '–',
        stage.most ? share((100 * stage.work) / stage.most, 'var(--good)') : ''])).join('') +
      tableRow(['all', `${total.toFixed(1)} ms`, 'of 100 ms', '', ''], 'th');
    element('bus').innerHTML = [
      ['bus', `${escaped(ecu.bus)}, ${ecu.state}`], ['frames received, sent', `${ecu.received}, ${ecu.sent}`],
      ['taken, not believed', `${ecu.accepted}, ${ecu.rejected}`], ['dropped, errors', `${ecu.dropped}, ${ecu.errors}`],
      ['planning cycles, late', `${ecu.cycles}, ${ecu.late}`], ['gate', ecu.gate ? `limits: ${ecu.gate}` : 'nothing limited'],
    ].map((row) => tableRow(row)).join('');
  };
  let told = 0;  // number of the cycle that the tables below show
  const tell = (cycle) => {
    tellWhy(cycle);
    element('mode').textContent = cycle.ecu.mode;
    element('mode').className = `pill ${cycle.ecu.faults.length ? 'bad' : ''}`;
    element('faults').textContent = cycle.ecu.faults.join(', ');
    element('figures').innerHTML = [
      [`${cycle.ego.speed.toFixed(1)} m/s`, 'speed'], [`${cycle.acceleration.toFixed(1)} m/s²`, 'acceleration'],
      [`${((cycle.steering * 180) / Math.PI).toFixed(1)}°`, 'steering'], [`${cycle.waited_s.toFixed(0)} s`, 'waited here'],
    ].map(([value, name]) => `<div><b>${value}</b>${name}</div>`).join('');
    tellVehicles(cycle);
    // Tables of numbers could not be read ten times a second.
    if (held === null && cycle.number < told + 5 && told <= cycle.number) return;
    told = cycle.number;
    element('costs').innerHTML = costTable(cycle.cost, cycle.runner_up);
    const [count, infeasible, refused] = cycle.counts;
    element('counts').textContent = `${count} candidates: ${infeasible} beyond the car’s limits, ${refused} refused by the guard.`;
    tellUnit(cycle);
    element('numbers').textContent = cycle.numbers.replace(/^ {2}/gm, '');
  };

  // Passages with the same reason: what is said, without its numbers.
  const story = [];
  const addToStory = (cycle) => {
    const reason = `${cycle.ecu_number} ${cycle.words.replace(/[\d.]+/g, '')}`;
    if (story.length && story[story.length - 1].reason === reason) return;
    const button = document.createElement('button');
    for (const text of [`${(cycle.t / 1000).toFixed(1)} s`, cycle.words]) {
      button.appendChild(document.createElement('span')).textContent = text;
    }
    button.addEventListener('click', () => hold(cycle.number));
    const item = document.createElement('li');
    item.appendChild(button);
    element('story').prepend(item);
    story.push({ reason, item });
    if (story.length > kToldMost) story.shift().item.remove();
  };

  // How smooth it is: times between newest cycles shown, and how old they were by then.
  const intervals = [], costs = [], ages = [];
  let before = null;
  const quantile95 = (list) => [...list].sort((a, b) => a - b)[Math.ceil(0.95 * list.length) - 1] ?? 0;
  const keep = (list, value) => { list.push(value); if (list.length > 150) list.shift(); };
  const measure = (cycle, began) => {
    keep(costs, performance.now() - began);
    if (before && cycle.number === before.number) return;
    const age = Date.now() - cycle.at;
    const follows = before && before.ecu === cycle.ecu_number && held === null && before.fresh && age < 1000;
    if (follows) { keep(intervals, began - before.began); keep(ages, age); }
    before = { number: cycle.number, ecu: cycle.ecu_number, began, fresh: held === null && age < 1000 };
    root.dataset.frames = intervals.length;
    root.dataset.frameP95 = quantile95(intervals).toFixed(1);
    root.dataset.drawP95 = quantile95(costs).toFixed(1);
    root.dataset.ageP95 = quantile95(ages).toFixed(1);
    element('pace').textContent = `95 of 100 frames within ${root.dataset.frameP95} ms of the one before, drawn in ` +
      `${root.dataset.drawP95} ms, ${root.dataset.ageP95} ms after the plan was read.`;
  };

  const tellLink = () => {
    const absent = !connected ? 'The view’s server does not answer: is ./s4tp view still running? Trying again …'
      : !state.present ? `Waiting for an ECU: ${state.absence}. Start one in another terminal: ` +
        './s4tp run --scenario left_turn --traffic sumo --live' : '';
    element('absent').textContent = absent;
    element('absent').hidden = !absent;
    element('link').textContent = !connected ? 'no connection' : !state.present ? 'waiting for an ECU'
      : `planner ${state.ecu.planner}, process ${state.process}, ${state.ecu.bus}`;
    if (state.present && held === null && state.ecu.mode !== element('mode').textContent) {
      element('mode').textContent = state.ecu.mode;
      element('faults').textContent = state.ecu.faults.join(', ');
    }
    root.dataset.link = !connected ? 'closed' : state.present ? 'ecu' : 'waiting';
  };

  const show = () => {
    asked = false;
    tellLink();
    const shown = indexShown();
    element('pause').textContent = held === null ? '❚❚ pause' : '▶ live';
    element('time').max = Math.max(0, cycles.length - 1);
    element('time').value = Math.max(0, shown);
    if (shown < 0) return;
    const began = performance.now(), cycle = cycles[shown];
    const ago = cycles[cycles.length - 1].number - cycle.number;
    scene.show(momentOf(shown));
    drawStrips(shown);
    drawProfile('profile', cycle.risk);  // before the words move anything
    tell(cycle);
    element('clock').textContent = `${(cycle.t / 1000).toFixed(1)} s` +
      (held === null ? ', now' : `, ${((ago * kCycleMs) / 1000).toFixed(1)} s ago`);
    root.dataset.frame = cycle.number;
    root.dataset.newest = cycles[cycles.length - 1].number;
    measure(cycle, began);
  };
  const redraw = () => {  // once a frame at most, and not when nothing has changed
    if (!asked) requestAnimationFrame(show);
    asked = true;
  };
  const hold = (number) => { held = number; redraw(); };
  const pause = () => hold(held === null && cycles.length ? cycles[cycles.length - 1].number : null);
  const step = (by) => {
    if (!cycles.length) return;
    const index = Math.min(cycles.length - 1, Math.max(0, indexShown() + by));
    hold(cycles[index].number);
  };
  const pick = (car) => { picked = car === picked ? -1 : car; redraw(); };

  const connect = () => {
    const socket = new WebSocket(`ws://${location.host}/`, 's4tp-live');
    socket.onopen = () => {
      connected = true;
      redraw();
      cycles.length = 0;  // all that is kept comes again
      for (const { item } of story.splice(0)) item.remove();
    };
    socket.onmessage = (event) => {
      const message = JSON.parse(event.data);
      redraw();
      if (message.kind === 'state') { state = message; return; }
      cycles.push(message);
      if (cycles.length > kKept) cycles.shift();
      addToStory(message);
    };
    socket.onclose = () => {
      connected = false;
      redraw();
      setTimeout(connect, 500);
    };
  };

  element('pause').addEventListener('click', pause);
  element('back').addEventListener('click', () => step(-1));
  element('forth').addEventListener('click', () => step(1));
  element('time').addEventListener('input', (event) => { if (cycles.length) hold(cycles[Number(event.target.value)].number); });
  const seek = (event) => {
    if ((event.type === 'pointermove' && !event.buttons) || !cycles.length) return;
    const area = element('strip').getBoundingClientRect();
    const part = (event.clientX - area.left - kLeft) / (area.width - 2 * kLeft);
    const index = Math.round(cycles.length - 1 - span() * (1 - part));
    hold(cycles[Math.min(cycles.length - 1, Math.max(0, index))].number);
  };
  element('strip').addEventListener('pointerdown', seek);
  element('strip').addEventListener('pointermove', seek);
  element('scene').addEventListener('click', (event) => {
    const area = element('scene').getBoundingClientRect();
    const car = scene.vehicleAt(event.clientX - area.left, event.clientY - area.top);
    if (car >= 0 || picked >= 0) pick(car >= 0 ? car : picked);
  });
  element('vehicles').addEventListener('pointerdown', (event) => {
    const row = event.target.closest('[data-car]');
    if (row) pick(Number(row.dataset.car));
  });
  const zoom = (by) => { scene.zoom(by); redraw(); };
  element('scene').addEventListener('wheel', (event) => { event.preventDefault(); zoom(event.deltaY > 0 ? 1.15 : 1 / 1.15); },
    { passive: false });
  for (const input of document.querySelectorAll('[data-layer]')) {
    input.addEventListener('change', () => { scene.layers[input.dataset.layer] = input.checked; redraw(); });
  }
  document.addEventListener('keydown', (event) => {
    const keys = {
      ' ': pause, ArrowLeft: () => step(event.shiftKey ? -10 : -1), ArrowRight: () => step(event.shiftKey ? 10 : 1),
      End: () => hold(null), '+': () => zoom(1 / 1.15), '-': () => zoom(1.15),
    };
    const busy = event.target.tagName === 'BUTTON' && event.key === ' ';
    if (!keys[event.key] || busy || event.ctrlKey || event.altKey || event.metaKey) return;
    event.preventDefault();
    keys[event.key]();
  });
  window.addEventListener('resize', redraw);
  matchMedia('(prefers-color-scheme: dark)').addEventListener('change', redraw);
  connect();
  redraw();
})();
