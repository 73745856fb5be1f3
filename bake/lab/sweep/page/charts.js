// Every plot of the page.
'use strict';

// Okabe and Ito's set: told apart by every colour vision. Shapes say the same once more.
const colours = {
  black: '#000000', orange: '#e69f00', sky: '#56b4e9', green: '#009e73',
  yellow: '#f0e442', blue: '#0072b2', vermilion: '#d55e00', purple: '#cc79a7',
};
const groupColours = ['#b8b8bd', colours.sky, colours.orange, colours.green, colours.blue,
  colours.purple, colours.yellow];

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
    const shown = span > 200 ? [1] : span > 6 ? [1, 2, 5] : [1, 1.5, 2, 3, 4, 5, 6, 8];
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

// Names beside the marks of datasets that ask for them: below where another name stands above.
const nameMarks = {
  id: 'nameMarks',
  afterDatasetsDraw(chart) {
    const { ctx, chartArea } = chart;
    ctx.save();
    ctx.font = `600 13px ${Chart.defaults.font.family}`;
    ctx.textBaseline = 'bottom';
    const height = 16, taken = [];
    chart.data.datasets.forEach((dataset, d) => {
      if (!dataset.named || !chart.isDatasetVisible(d)) return;
      chart.getDatasetMeta(d).data.forEach((mark, i) => {
        const name = dataset.data[i].name;
        if (!name) return;
        const { width } = ctx.measureText(name);
        const x = mark.x + 12 + width < chartArea.right ? mark.x + 10 : mark.x - 10 - width;
        const meets = y => taken.some(t => x < t.x + t.width && t.x < x + width && Math.abs(y - t.y) < height);
        const y = [-6, 6 + height, -6 - height].map(step => mark.y + step).find(at => !meets(at)) ?? mark.y - 6;
        taken.push({ x, y, width });
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
  const front = alike.filter(p => p[onFront]).sort((a, b) => a[key] - b[key]);
  const compared = points.filter(p => p !== truth), own = compared.filter(p => alike.includes(p));
  const mark = (label, list, colour, pointStyle, extra) => ({
    label, data: list.map(at), backgroundColor: colour + 'cc', borderColor: colour, pointStyle,
    radius: 5, hoverRadius: 8, borderWidth: 1, ...extra });
  const datasets = [
    mark('finest', [truth], colours.green, 'rectRot',
      { radius: 9, borderWidth: 2, backgroundColor: '#ffffff', named: true }),
    mark('presets', compared.filter(isPreset), colours.vermilion, 'rectRot', { radius: 9, named: true }),
    mark('one knob changed', own.filter(p => !isPreset(p) && !isJoint(p)), colours.blue, 'circle'),
    mark('several knobs changed', own.filter(p => !isPreset(p) && isJoint(p)), colours.orange, 'triangle',
      { radius: 6 }),
    mark('other models', compared.filter(p => !isPreset(p) && !alike.includes(p)), colours.black, 'crossRot',
      { borderWidth: 2 }),
    { label: 'front', data: front.map(at), type: 'line', borderColor: colours.black, borderWidth: 1.5,
      pointRadius: 0, pointHitRadius: 0, pointStyle: 'line', tension: 0, fill: false },
    { label: 'against the finest bake', hidden: true, pointStyle: 'crossRot', borderColor: colours.purple,
      backgroundColor: colours.purple, radius: 5, borderWidth: 2,
      data: points.filter(isCompared).map(p => ({ x: p[key], y: p.against_finest.rms_relative, point: p, own: true }))
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
            (own ? 'against the finest ' + interval(point.against_finest) : 'error ' + interval(point.error)),
            `${seconds(point.seconds)}, ${bytes(point.bytes)}`, ...knobLines(point)],
        } } },
    },
  });
}

// Total error: one line for each way to compute, through the bakes that no other of its kind beats.
function totalChart() {
  const y = p => p.total_error.rms_relative;
  const shown = points.filter(p => p.total_error && y(p) > 0);
  const box = document.getElementById('total');
  box.hidden = shown.length === 0;
  if (box.hidden) return;
  const styles = [['circle', colours.blue], ['rectRot', colours.vermilion], ['triangle', colours.green],
    ['rect', colours.purple], ['star', colours.orange]];
  const at = p => ({ x: p.seconds, y: y(p), point: p, name: isPreset(p) ? p.label : '' });
  const datasets = data.lines.flatMap((line, l) => {
    const [pointStyle, colour] = styles[l % styles.length];
    const own = shown.filter(p => p.choices === line.choices);
    return [
      { label: named(line), data: own.map(at), pointStyle, backgroundColor: colour + '99', borderColor: colour,
        radius: own.map(p => isPreset(p) ? 8 : 5), hoverRadius: 9, borderWidth: 1, named: true },
      { label: 'front', data: line.points.map(i => points[i]).filter(p => shown.includes(p)).map(at), type: 'line',
        borderColor: colour, borderWidth: 2, pointRadius: 0, pointHitRadius: 0, tension: 0, fill: false },
    ].filter(d => d.data.length > 0);
  });
  new Chart(document.getElementById('total-time'), {
    type: 'scatter', data: { datasets }, plugins: [nameMarks],
    options: {
      scales: {
        x: logAxis('x', 'seconds to bake [s]', v => significant(v, 2), shown.map(p => p.seconds)),
        y: logAxis('y', 'relative RMS error against path tracing', v => percent(v), shown.map(y)),
      },
      plugins: {
        legend: { labels: { filter: item => item.text !== 'front' } },
        tooltip: {
          filter: item => item.dataset.label !== 'front',
          callbacks: {
            title: items => items.length ? items[0].raw.point.label : '',
            label: ({ raw: { point } }) => [
              'total error ' + interval(point.total_error), 'of the numbers ' + interval(point.error),
              `${seconds(point.seconds)}, ${bytes(point.bytes)}`, ...knobLines(point)],
          },
        },
      },
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
  const at = r => ({ x: r.value, y: r.error, seconds: r.seconds });
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
    `Against \u201c${slope.against}\u201d, in ${seconds(rungs[0].seconds)} to ` +
    `${seconds(rungs[rungs.length - 1].seconds)}.`;
  const note = element('p', text);
  note.className = 'note';
  box.append(element('div', null, element('h3', name), plot, note));
  const plain = v => v >= 1e4 ? significant(v / 1000, 2) + 'k' : v < 1e-3 ? v.toExponential(0) : significant(v, 2);
  const x = slope.semi_log
    ? { type: 'linear', min: low - 0.3, max: high + 0.3, ticks: { stepSize: 1 }, title: { display: true, text: slope.knob } }
    : logAxis('x', slope.knob, plain, values);
  new Chart(canvas, {
    type: 'scatter', data: { datasets: datasets.filter(d => d.data.length) },
    options: {
      scales: { x, y: logAxis('y', 'difference', v => percent(v), errors) },
      plugins: { legend: { display: false }, tooltip: { callbacks: {
        label: c => `${slope.knob}: ${plain(c.raw.x)}; ${percent(c.raw.y)}` +
          (c.raw.seconds > 0 ? ` in ${seconds(c.raw.seconds)}` : '') } } },
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
