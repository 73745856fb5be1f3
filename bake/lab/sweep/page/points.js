// What the page knows: the data, its numbers for people, and elements to put them in.
'use strict';

const data = JSON.parse(document.getElementById('data').textContent);
const pictures = JSON.parse(document.getElementById('picture-data').textContent);

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
const isCompared = p => points[p.finest] !== p;
const isPreset = p => 'preset' in p.ladders;
// Of the truth's choices: only such bakes differ in numbers alone.
const alike = points.filter(p => p.choices === truth.choices);
// Nothing but a cloud layer: nothing is relit.
const ofLayer = points.every(p => 'layer_error' in p) && data.lights.length === 0;
const isJoint = p => 'grid' in p.ladders || 'diagonal' in p.ladders;
const named = line => line.choices || 'bakes';
const presets = points.filter(isPreset).sort((a, b) => a.ladders.preset - b.ladders.preset);

function interval(error) {
  return `${percent(error.rms_relative)} (${percent(error.ci95[0])} to ${percent(error.ci95[1])})`;
}
function knobLines(point) {
  const k = point.knobs;
  const lines = ofLayer ? [] : [`N = ${k.cubemap}, M = ${k.coefficients}, ${k.code_bits}-bit codes`];
  for (const [name, value] of Object.entries(k)) {
    if (data.knobs.includes(name)) {
      lines.push(`${name.replaceAll('_', ' ')} ${value}`);
    }
  }
  if (point.choices) {
    lines.push(`by ${point.choices}`);
  }
  if (k.exact_rays) {
    lines.push('rays instead of light maps');
  }
  return lines;
}
