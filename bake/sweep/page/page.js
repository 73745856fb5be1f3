'use strict';
const data = JSON.parse(document.getElementById('data').textContent);
const pictures = JSON.parse(document.getElementById('picture-data').textContent);

// Okabe and Ito's set: told apart by every colour vision. Shapes say the same once more.
const colours = {
  black: '#000000', orange: '#e69f00', sky: '#56b4e9', green: '#009e73',
  yellow: '#f0e442', blue: '#0072b2', vermilion: '#d55e00', purple: '#cc79a7',
};
const presetNames = ['draft', 'preview', 'production', 'reference'];
const groupColours = ['#b8b8bd', colours.sky, colours.orange, colours.green, colours.blue,
  colours.purple, colours.yellow];

// ---- numbers for people

function significant(value, digits) {
  return value === 0 ? '0' : Number(value.toPrecision(digits)).toLocaleString('en', {
    maximumSignificantDigits: digits, useGrouping: false });
}
function percent(value, digits = 2) {
  return significant(100 * value, digits) + '\u00a0%';
}
function seconds(value) {
  return value >= 120 ? significant(value / 60, 3) + '\u00a0min' : significant(value, 3) + '\u00a0s';
}
function bytes(value) {
  const units = [['GB', 1e9], ['MB', 1e6], ['kB', 1e3]];
  const [unit, size] = units.find(([, s]) => value >= s) || ['bytes', 1];
  return significant(value / size, 3) + '\u00a0' + unit;
}
function times(value, onFront) {
  return onFront ? 'on the front' : significant(value, 3) + '\u00a0\u00d7';
}

// ---- elements

function element(name, text, ...children) {
  const made = document.createElement(name);
  if (text !== undefined && text !== null) made.textContent = text;
  made.append(...children);
  return made;
}
function fill(id, text) {
  document.getElementById(id).textContent = text;
}
function table(id, head, rows) {
  const made = document.getElementById(id);
  made.append(element('thead', null, element('tr', null, ...head.map(h => element('th', h)))));
  const body = element('tbody');
  for (const { cells, preset } of rows) {
    const row = element('tr', null, ...cells.map(c => element('td', c)));
    if (preset) row.className = 'preset';
    body.append(row);
  }
  made.append(body);
}

// ---- points

const points = data.points.map((point, index) => ({ ...point, index }));
const truth = points[data.truth];
const compared = points.filter(p => p !== truth);
const isPreset = p => 'preset' in p.ladders;
const isJoint = p => 'grid' in p.ladders || 'diagonal' in p.ladders;
const presets = points.filter(isPreset).sort((a, b) => a.ladders.preset - b.ladders.preset);

function interval(error) {
  return `${percent(error.rms_relative)} (${percent(error.ci95[0])} to ${percent(error.ci95[1])})`;
}
function knobLines(point) {
  const k = point.knobs;
  const lines = [`N = ${k.cubemap}, M = ${k.coefficients}, ${k.code_bits}-bit codes`];
  const effects = new Set(data.plan.filter(e => e.decision === 'on').map(e => e.effect));
  if (effects.has('multiple')) {
    lines.push(`${k.exact_samples ? '' : 'up to '}${k.samples} samples, \u03b5 = ${k.epsilon}`);
  }
  if (effects.has('single')) {
    lines.push(`${k.depth_samples} depths, ${k.phase_terms === 'auto' ? 'K chosen' : 'K = ' + k.phase_terms}, ` +
      (k.exact_rays ? 'rays' : `light maps at N = ${k.single_cubemap}`));
  }
  return lines;
}

// ---- charts

Chart.defaults.animation = false;
Chart.defaults.maintainAspectRatio = false;
Chart.defaults.font.family = getComputedStyle(document.body).fontFamily;
Chart.defaults.font.size = 13;
Chart.defaults.color = '#1d1d1f';
Chart.defaults.plugins.legend.labels.usePointStyle = true;
Chart.defaults.plugins.legend.labels.boxWidth = 10;

// 1, 2 and 5 times powers of ten; other digits too where an axis spans less than a decade.
function logTick(format) {
  return function (value) {
    const digit = Number(value.toExponential().split('e')[0]);
    const { min, max } = this.chart.scales[this.axis === 'x' ? 'x' : 'y'];
    const span = max / min;
    const shown = span > 2000 ? [1] : span > 6 ? [1, 2, 5] : [1, 1.5, 2, 3, 4, 5, 6, 8];
    return shown.some(s => Math.abs(s - digit) < 1e-6) ? format(value) : '';
  };
}
function logAxis(axis, title, format, values) {
  const low = Math.min(...values), high = Math.max(...values);
  return {
    type: 'logarithmic', axis, min: low / 1.25, max: high * 1.25,
    title: { display: true, text: title },
    ticks: { callback: logTick(format), maxRotation: 0, autoSkip: false },
    grid: { color: c => (c.tick && c.tick.label ? '#d8d8dc' : '#f2f2f4') },
  };
}

// Names beside the marks of datasets that ask for them.
const nameMarks = {
  id: 'nameMarks',
  afterDatasetsDraw(chart) {
    const { ctx, chartArea } = chart;
    ctx.save();
    ctx.font = `600 13px ${Chart.defaults.font.family}`;
    ctx.textBaseline = 'bottom';
    chart.data.datasets.forEach((dataset, d) => {
      if (!dataset.named || !chart.isDatasetVisible(d)) return;
      chart.getDatasetMeta(d).data.forEach((mark, i) => {
        const name = dataset.data[i].name;
        const right = mark.x + 12 + ctx.measureText(name).width < chartArea.right;
        ctx.textAlign = right ? 'left' : 'right';
        const x = mark.x + (right ? 10 : -10), y = mark.y - 6;
        ctx.lineWidth = 4;
        ctx.strokeStyle = '#ffffff';
        ctx.strokeText(name, x, y);
        ctx.fillStyle = dataset.borderColor;
        ctx.fillText(name, x, y);
      });
    });
    ctx.restore();
  },
};

function frontChart(id, key, title, format, onFront) {
  const at = p => ({ x: p[key], y: p.error.rms_relative, point: p, name: p.label });
  const front = points.filter(p => p[onFront]).sort((a, b) => a[key] - b[key]);
  const mark = (label, list, colour, pointStyle, extra) => ({
    label, data: list.map(at), backgroundColor: colour + 'cc', borderColor: colour, pointStyle,
    radius: 5, hoverRadius: 8, borderWidth: 1, ...extra });
  const datasets = [
    mark('truth, by its own check', [truth], colours.green, 'rectRot',
      { radius: 9, borderWidth: 2, backgroundColor: '#ffffff', named: true }),
    mark('presets', compared.filter(isPreset), colours.vermilion, 'rectRot', { radius: 9, named: true }),
    mark('one knob changed', compared.filter(p => !isPreset(p) && !isJoint(p)), colours.blue, 'circle'),
    mark('several knobs changed', compared.filter(p => !isPreset(p) && isJoint(p)), colours.orange, 'triangle',
      { radius: 6 }),
    { label: 'front', data: front.map(at), type: 'line', borderColor: colours.black, borderWidth: 1.5,
      pointRadius: 0, pointHitRadius: 0, pointStyle: 'line', tension: 0, fill: false },
    { label: 'by the bakes\u2019 own checks', hidden: true, pointStyle: 'crossRot', borderColor: colours.purple,
      backgroundColor: colours.purple, radius: 5, borderWidth: 2,
      data: points.map(p => ({ x: p[key], y: p.self_check.rms_relative, point: p, own: true }))
        .filter(p => p.y > 0) },
  ].filter(d => d.data.length > 0);
  const shown = points.filter(p => p.error.rms_relative > 0);
  if (shown.length === 0) return;
  new Chart(document.getElementById(id), {
    type: 'scatter', data: { datasets }, plugins: [nameMarks],
    options: {
      scales: {
        x: logAxis('x', title, format, shown.map(p => p[key])),
        y: logAxis('y', 'relative RMS error', v => percent(v), shown.map(p => p.error.rms_relative)),
      },
      plugins: { tooltip: {
        filter: item => item.dataset.label !== 'front',
        callbacks: {
          title: items => items.length ? items[0].raw.point.label : '',
          label: ({ raw: { point, own } }) => [
            (own ? 'own check ' + interval(point.self_check) : 'error ' + interval(point.error)),
            `${seconds(point.seconds)}, ${bytes(point.bytes)}`, ...knobLines(point)],
        } } },
    },
  });
}

function groupsChart() {
  const used = data.groups.map((name, g) => ({ name, g }))
    .filter(({ g }) => presets.some(p => p.seconds_by_group[g] > 0.002 * p.seconds));
  document.getElementById('groups-box').style.height = `${110 + 48 * presets.length}px`;
  new Chart(document.getElementById('groups'), {
    type: 'bar',
    data: {
      labels: presets.map(p => `${p.label}: ${seconds(p.seconds)}`),
      datasets: used.map(({ name, g }) => ({
        label: name, backgroundColor: groupColours[g], borderColor: '#ffffff', borderWidth: 1,
        data: presets.map(p => 100 * p.seconds_by_group[g] / p.seconds),
        taken: presets.map(p => p.seconds_by_group[g]),
      })),
    },
    options: {
      indexAxis: 'y',
      scales: {
        x: { stacked: true, min: 0, max: 100, title: { display: true, text: 'share of the seconds [%]' } },
        y: { stacked: true, grid: { display: false } },
      },
      plugins: {
        legend: { labels: { pointStyle: 'rect' } },
        tooltip: { callbacks: { label: c =>
          `${c.dataset.label}: ${seconds(c.dataset.taken[c.dataIndex])}, ${significant(c.raw, 2)}\u00a0%` } },
      },
    },
  });
}

function slopeChart(box, slope) {
  const rungs = slope.rungs.filter(r => r.error > 0 && (slope.semi_log || r.value > 0));
  if (rungs.length === 0) return;
  const fitted = rungs.filter(r => r.fitted), left = rungs.filter(r => !r.fitted);
  const values = rungs.map(r => r.value), errors = rungs.map(r => r.error);
  const low = Math.min(...values), high = Math.max(...values);
  const at = r => ({ x: r.value, y: r.error });
  const line = law => [low, high].map(x => ({ x, y: law(x) }));
  const power = slope.semi_log ? (rate, x, x0) => Math.exp(rate * (x - x0)) : (rate, x, x0) => (x / x0) ** rate;
  const first = rungs[0];
  const datasets = [
    { label: 'fitted', data: fitted.map(at), backgroundColor: colours.blue, borderColor: colours.blue, radius: 5 },
    { label: 'left out', data: left.map(at), backgroundColor: '#ffffff', borderColor: colours.blue, radius: 5,
      borderWidth: 1.5 },
    { label: 'theory', type: 'line', borderColor: colours.vermilion, borderDash: [6, 4], borderWidth: 2,
      pointRadius: 0, pointStyle: 'line', data: line(x => first.error * power(slope.theory.rate, x, first.value)) },
  ];
  if (slope.measured) {
    datasets.push({ label: 'measured', type: 'line', borderColor: colours.blue, borderWidth: 1.5, pointRadius: 0,
      pointStyle: 'line',
      data: line(x => Math.exp(slope.measured.intercept) * power(slope.measured.rate, x, slope.semi_log ? 0 : 1)) });
  }
  const canvas = element('canvas');
  const plot = element('div', null, canvas);
  plot.className = 'plot';
  const name = slope.knob.charAt(0).toUpperCase() + slope.knob.slice(1);
  const unit = slope.semi_log ? ' per degree' : '';
  const spread = slope.measured && slope.measured.standard_error > 0
    ? ` \u00b1 ${significant(slope.measured.standard_error, 1)}` : '';
  const rate = v => significant(v, 2).replace('-', '\u2212');
  const text = (slope.measured ? `Measured rate ${rate(slope.measured.rate)}${spread}${unit}; ` :
    'Too few points to fit; ') + `theory ${rate(slope.theory.rate)}${unit}: ${slope.theory.words}. ` +
    `Against \u201c${slope.against}\u201d.`;
  const note = element('p', text);
  note.className = 'note';
  box.append(element('div', null, element('h3', name), plot, note));
  const plain = v => v >= 1e4 ? significant(v / 1000, 2) + 'k' : significant(v, 2);
  const x = slope.semi_log
    ? { type: 'linear', min: low - 0.3, max: high + 0.3, ticks: { stepSize: 1 }, title: { display: true, text: slope.knob } }
    : logAxis('x', slope.knob, plain, values);
  new Chart(canvas, {
    type: 'scatter', data: { datasets: datasets.filter(d => d.data.length) },
    options: {
      scales: { x, y: logAxis('y', 'difference', v => percent(v), errors) },
      plugins: { legend: { display: false }, tooltip: { callbacks: {
        label: c => `${slope.knob}: ${plain(c.raw.x)}; ${percent(c.raw.y)}` } } },
    },
  });
}

function lightsChart() {
  const styles = [['circle', colours.sky], ['rectRot', colours.vermilion], ['triangle', colours.green],
    ['rect', colours.black]];
  const list = presets;
  const datasets = list.map(p => {
    const [pointStyle, colour] = styles[p.ladders.preset];
    return { label: p.label, pointStyle, borderColor: colour, backgroundColor: colour, radius: 7, showLine: false,
      data: data.lights.map(light => p.error.by_light[light] > 0 ? p.error.by_light[light] : null) };
  });
  const values = datasets.flatMap(d => d.data).filter(v => v > 0);
  if (values.length === 0) return;
  new Chart(document.getElementById('lights'), {
    type: 'line', data: { labels: data.lights, datasets },
    options: {
      scales: {
        x: { offset: true, title: { display: true, text: 'light (sun:AZIMUTH,ELEVATION and sky:TURBIDITY,ELEVATION in degrees)' } },
        y: logAxis('y', 'relative RMS error', v => percent(v), values),
      },
      plugins: { tooltip: { callbacks: { label: c => `${c.dataset.label}: ${percent(c.raw)}` } } },
    },
  });
}

// ---- text and tables

function introduce() {
  fill('scene', data.scene.name);
  document.title = `What accuracy costs: ${data.scene.name}`;
  const answer = data.answer;
  fill('answer', answer
    ? `An error of ${percent(answer.error)} costs ${seconds(answer.seconds)} and ${bytes(answer.bytes)}` +
      (answer.times_for_half > 0
        ? `; halving it takes ${significant(answer.times_for_half, 2)} times as long.`
        : '; no setting of this sweep halves it.')
    : 'Too few settings were baked to say what an error costs.');
  fill('facts', `${data.scene.receivers} receivers, ${data.scene.triangles} triangles; ${points.length} bakes ` +
    `in ${seconds(data.seconds_total)} on ${data.threads} thread${data.threads === 1 ? '' : 's'}; ` +
    `error: relative RMS of relit luminance over ${data.lights.length} lights, against \u201c${truth.label}\u201d.`);
  fill('method', `Each setting was baked and relit at up to 2000 receivers under ${data.lights.join(', ')}, and ` +
    `compared with the most accurate bake that the time allowed: \u201c${truth.label}\u201d ` +
    `(${knobLines(truth).join('; ')}; ${seconds(truth.seconds)}, ${bytes(truth.bytes)}; by its own check it errs by ` +
    `${interval(truth.self_check)}). Intervals are 95\u00a0% bootstrap intervals over receivers. The interval that ` +
    `a bake states of itself meets the one measured here for ${data.self_checks.agreeing} of ${data.self_checks.of} ` +
    'bakes. Seconds are wall time of whole bakes with their self-checks, once each; CPU is that of all threads. ' +
    'Where CPU is far below the seconds times the threads, something else kept the machine busy. All of this is numerical error: the same physical model with coarser numbers.');
  if (data.model_error) {
    document.getElementById('model').hidden = false;
    fill('model-text', `Against ${data.model_error.reference}, at ${data.model_error.receivers_checked} receivers: ` +
      `${interval(data.model_error)}. No knob changes it.`);
  }
}

function presetTable() {
  const effects = [...new Set(compared.flatMap(p => Object.keys(p.error.by_effect)))];
  const perEffect = effects.length > 1 ? effects : [];
  table('preset-table', ['preset', 'seconds', 'bytes', 'memory', 'error', ...perEffect, 'self-check',
    'time \u00f7 front', 'bytes \u00f7 front'],
  presets.map(p => ({ cells: [
    p.label, seconds(p.seconds), bytes(p.bytes), bytes(p.peak_rss_bytes),
    p === truth ? 'truth' : interval(p.error),
    ...perEffect.map(e => e in p.error.by_effect ? percent(p.error.by_effect[e]) : ''),
    interval(p.self_check),
    times(p.times_front_time, p.on_front_time), times(p.times_front_bytes, p.on_front_bytes)] })));
}

function allTable() {
  const rows = [...points].sort((a, b) => a.seconds - b.seconds);
  table('all', ['setting', 'seconds', 'CPU', 'bytes', 'error', 'self-check', 'time \u00f7 front', 'bytes \u00f7 front', 'knobs'],
  rows.map(p => ({ preset: isPreset(p), cells: [
    p.label, seconds(p.seconds), seconds(p.cpu_seconds), bytes(p.bytes), p === truth ? 'truth' : percent(p.error.rms_relative),
    percent(p.self_check.rms_relative), times(p.times_front_time, p.on_front_time),
    times(p.times_front_bytes, p.on_front_bytes), knobLines(p).join('; ')] })));
  if (data.skipped.length > 0) {
    const box = document.getElementById('skipped');
    box.append(element('h3', 'Left out'), element('ul', null, ...data.skipped.map(s =>
      element('li', `${s.label}: ${s.reason}`))));
  }
}

function figure(source, alt, caption) {
  const image = element('img');
  image.src = source;
  image.alt = alt;
  return element('figure', null, image, element('figcaption', caption));
}

function showPair(box, key, title, words) {
  const pair = data.pairs[key], shown = pictures[key];
  box.append(element('h3', title));
  if (!pair) {
    const none = element('p', 'No two bakes of this sweep differ enough to show.');
    none.className = 'note';
    box.append(none);
    return;
  }
  const both = [points[pair.better], points[pair.other]];
  const note = element('p', words(...both));
  note.className = 'note';
  const grid = element('div', null,
    ...both.map((p, i) => figure(shown.pictures[i], `picture: ${p.label}`,
      `${p.label}: ${percent(p.error.rms_relative)}, ${seconds(p.seconds)}, ${bytes(p.bytes)}`)),
    ...both.map((p, i) => figure(shown.differences[i], `difference: ${p.label}`, `${p.label} minus the truth`)));
  grid.className = 'pair';
  const bar = element('span');
  bar.className = 'scale';
  const scale = significant(shown.scale, 1);
  const legend = element('p', null, `darker by ${scale}`, bar, `brighter by ${scale} (luminance; 1 is display white)`);
  legend.className = 'note';
  box.append(note, grid, legend);
}

function picturesSection() {
  const box = document.getElementById('pairs');
  const whole = figure(pictures.truth, `picture: ${truth.label}`,
    `\u201c${truth.label}\u201d under ${data.picture_light}: what the others are compared with`);
  whole.className = 'truth';
  box.append(whole);
  showPair(box, 'equal_time', 'In the same time', (a, b) =>
    `${seconds(a.seconds)} and ${seconds(b.seconds)}: \u201c${b.label}\u201d errs ` +
    `${significant(b.error.rms_relative / a.error.rms_relative, 2)} times as much as \u201c${a.label}\u201d.`);
  showPair(box, 'equal_error', 'With the same error', (a, b) =>
    `${percent(a.error.rms_relative)} and ${percent(b.error.rms_relative)}: \u201c${b.label}\u201d takes ` +
    `${significant(b.seconds / a.seconds, 2)} times as long as \u201c${a.label}\u201d.`);
}

introduce();
presetTable();
frontChart('front-time', 'seconds', 'seconds to bake [s]', v => significant(v, 2), 'on_front_time');
frontChart('front-bytes', 'bytes', 'size of the file', bytes, 'on_front_bytes');
groupsChart();
data.slopes.forEach(slope => slopeChart(document.getElementById('slopes'), slope));
document.getElementById('convergence').hidden = data.slopes.length === 0;
fill('base', data.base);
picturesSection();
lightsChart();
allTable();
