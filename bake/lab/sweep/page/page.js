// Text, tables and pictures, and what is drawn where.
'use strict';

function introduce() {
  fill('scene', data.scene.name);
  document.title = `What accuracy costs: ${data.scene.name}`;
  const answer = data.answer;
  fill('answer', answer
    ? `An error of the numbers of ${percent(answer.error)} costs ${seconds(answer.seconds)} and ${bytes(answer.bytes)}` +
      (answer.times_for_half > 0
        ? `; halving it takes ${significant(answer.times_for_half, 2)} times as long.`
        : '; no setting of this sweep halves it.')
    : 'Too few settings were baked to say what an error costs.');
  fill('facts', (ofLayer ? 'A cloud layer; ' : `${data.scene.receivers} receivers, ${data.scene.triangles} triangles; `) +
    `${points.length} bakes ` +
    `in ${seconds(data.seconds_total)} on ${data.threads} thread${data.threads === 1 ? '' : 's'}; ` +
    (ofLayer ? 'errors: relative RMS of the radiance that its tables give.'
      : `errors: relative RMS of relit luminance over ${data.lights.length} lights.`));
  const reference = points[0].error.reference;
  fill('method', (ofLayer
    ? `Each bake measured its own error at optical depths, suns and views of its own choice, against ${reference}. ` +
      'Intervals are 95\u00a0% intervals over these. Besides, the radiance at places that are the same for all bakes was compared'
    : `Each bake measured its own error at receivers of its own choice under ${data.lights.join(', ')}, ` +
      `against ${reference.split(';')[0].replace(/^[^:]*: /, '')}. Intervals are 95\u00a0% bootstrap intervals over receivers. ` +
      'Besides, up to 2000 receivers were compared') +
    ` with the finest bake of the same model that the time allowed: \u201c${truth.label}\u201d ` +
    `(${knobLines(truth).join('; ')}; ${seconds(truth.seconds)}, ${bytes(truth.bytes)}; it errs by ` +
    `${interval(truth.error)}, which is added in squares). The two intervals meet for ${data.agreement.agreeing} of ${data.agreement.of} ` +
    'bakes. Seconds are wall time of whole bakes with their self-checks, once each; CPU is that of all threads. ' +
    'Where CPU is far below the seconds times the threads, something else kept the machine busy. All but the total error is error of the numbers: the same physical model, coarser.');
}

// What each way to compute comes to at best, and in what time it is within a tenth of that.
function totalText() {
  const model = data.model_error;
  if (!points.some(p => p.total_error)) {
    fill('total-text', 'Not measured: no receiver could be compared with path tracing.');
    return;
  }
  const best = data.lines.map(line => {
    const front = line.points.map(i => points[i]);
    const least = front[front.length - 1];
    const soon = front.find(p => p.total_error.rms_relative <= 1.1 * least.total_error.rms_relative);
    return `${named(line)}: ${interval(least.total_error)} at best, within a tenth of that in ${seconds(soon.seconds)}`;
  });
  fill('total-text', best.join('; ') + '.');
  const noise = Math.max(...Object.values(model.by_light).map(l => l.noise));
  fill('total-note', `Errors of model and numbers together, against ${model.reference}: at ${model.receivers_checked} ` +
    `receivers under ${Object.keys(model.by_light).join(', ')}. The noise of path tracing, at most ${percent(noise)}, is ` +
    'subtracted; where a line becomes level, finer numbers are wasted on what the model leaves out.' +
    (model.left_out.length > 0 ? ` Left out, as no path finds a sun through a refracting surface: the suns of ${model.left_out.join(', ')}.` : '') +
    (model.missing > 0.001 ? ` Of all light, ${percent(model.missing)} is in no file: it met several surfaces or crossed a body unscattered.` : ''));
}

function presetTable() {
  const effects = [...new Set(points.flatMap(p => Object.keys(p.error.by_effect)))];
  const perEffect = effects.length > 1 ? effects : [];
  const ways = points.some(p => p.choices) ? ['by'] : [];
  table('preset-table', ['preset', ...ways, 'seconds', 'bytes', 'memory', 'total error', 'error of the numbers', ...perEffect, 'against finest',
    'time \u00f7 front', 'bytes \u00f7 front'],
  presets.map(p => ({ cells: [
    p.label, ...ways.map(() => p.choices), seconds(p.seconds), bytes(p.bytes), bytes(p.peak_rss_bytes),
    p.total_error ? interval(p.total_error) : '', interval(p.error),
    ...perEffect.map(e => e in p.error.by_effect ? percent(p.error.by_effect[e]) : ''),
    isCompared(p) ? interval(p.against_finest) : '',
    times(p.times_front_time, p.on_front_time), times(p.times_front_bytes, p.on_front_bytes)] })));
}

function allTable() {
  const rows = [...points].sort((a, b) => a.seconds - b.seconds);
  table('all', ['setting', 'seconds', 'CPU', 'bytes', 'total error', 'error of the numbers', 'against finest', 'time \u00f7 front', 'bytes \u00f7 front', 'knobs'],
  rows.map(p => ({ preset: isPreset(p), cells: [
    p.label, seconds(p.seconds), seconds(p.cpu_seconds), bytes(p.bytes), p.total_error ? percent(p.total_error.rms_relative) : '', percent(p.error.rms_relative),
    isCompared(p) ? percent(p.against_finest.rms_relative) : '', times(p.times_front_time, p.on_front_time),
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
    ...both.map((p, i) => figure(shown.differences[i], `difference: ${p.label}`, `${p.label} minus the finest`)));
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
    `\u201c${truth.label}\u201d under ${data.picture_light}: the finest bake`);
  whole.className = 'truth';
  box.append(whole);
  showPair(box, 'equal_time', 'In the same time', (a, b) =>
    `${seconds(a.seconds)} and ${seconds(b.seconds)}: \u201c${b.label}\u201d errs ` +
    `${significant(b.error.rms_relative / a.error.rms_relative, 2)} times as much as \u201c${a.label}\u201d.`);
  showPair(box, 'equal_error', 'With the same error', (a, b) =>
    `${percent(a.error.rms_relative)} and ${percent(b.error.rms_relative)}: \u201c${b.label}\u201d takes ` +
    `${significant(b.seconds / a.seconds, 2)} times as long as \u201c${a.label}\u201d.`);
}

// Wall time tells nothing where other programs took the cores: CPU over wall differs from bake to bake.
function warnIfBusy() {
  const share = points.map(p => p.cpu_seconds / p.seconds);
  const most = Math.max(...share);
  const disturbed = points.filter((p, i) => p.seconds > 1 && share[i] < 0.7 * most).length;
  if (disturbed > 0.1 * points.length) {
    const box = document.getElementById('busy');
    box.hidden = false;
    box.textContent = `Something else kept the machine busy during ${disturbed} of ${points.length} bakes: compare ` +
      'seconds with care, look at CPU seconds in the last table, or sweep again on a quiet machine.';
  }
}

introduce();
totalText();
totalChart();
document.querySelectorAll('.of-truth').forEach(e => { e.textContent = truth.choices ? ` by ${truth.choices}` : ''; });
warnIfBusy();
presetTable();
frontChart('front-time', 'seconds', 'seconds to bake [s]', v => significant(v, 2), 'on_front_time');
frontChart('front-bytes', 'bytes', 'size of the file', bytes, 'on_front_bytes');
groupsChart();
data.slopes.forEach(slope => slopeChart(document.getElementById('slopes'), slope));
document.getElementById('convergence').hidden = data.slopes.length === 0;
fill('base', data.base);
picturesSection();
document.getElementById('by-light').hidden = ofLayer;
lightsChart();
allTable();
