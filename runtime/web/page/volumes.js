"use strict";
// Volumes: their density and own light as shaders read them, and the light of their nodes: the steps
// of runtime/volumes and runtime/embed_gl/volume_tables.cpp.
const Volumes = (() => {
  const kNone = 0xffffffff, kPhaseEntries = 257, kMostSunTerms = 3, kMostSuns = 8, kBrickWords = 1 + 81 * 8;

  // Of 9 x 9 x 9 voxels, those of neighbours among them, pairs along x.
  function packBrick(volumes, volume, cell, number, words) {
    const [nx, ny, nz] = volume.extent, values = new Float64Array(729);
    const [x0, y0, z0] = cell, base = volume.firstBrickNumber;
    for (let i = 0; i < 729; ++i) {
      const x = i % 9, y = Math.floor(i / 9) % 9, z = Math.floor(i / 81);
      const at = [x0 + (x >> 3), y0 + (y >> 3), z0 + (z >> 3)];
      if (at[0] >= nx || at[1] >= ny || at[2] >= nz) continue;
      const brick = volumes.table[volume.firstCell + (at[2] * ny + at[1]) * nx + at[0]];
      if (brick === kNone) continue;
      values[i] = volumes.scale[base + brick] *
          volumes.density[512 * (base + brick) + ((z & 7) * 8 + (y & 7)) * 8 + (x & 7)];
    }
    const full = values.reduce((a, b) => Math.max(a, b), volumes.scale[base + number] * 65535);
    const codes = values.map(value => full > 0 ? Math.round(value / full * 65535) : 0);
    const first = kBrickWords * (base + number);
    new Float32Array(words.buffer)[first] = full;
    for (let row = 0; row < 81; ++row) {
      for (let x = 0; x < 8; ++x) {
        words[first + 1 + 8 * row + x] = codes[9 * row + x] | codes[9 * row + x + 1] << 16;
      }
    }
  }

  function packDensity(volumes) {
    const words = new Uint32Array(kBrickWords * volumes.scale.length);
    for (const volume of volumes.list) {
      const [nx, ny, nz] = volume.extent;
      for (let at = 0; at < nx * ny * nz; ++at) {
        const number = volumes.table[volume.firstCell + at];
        if (number === kNone) continue;
        packBrick(volumes, volume, [at % nx, Math.floor(at / nx) % ny, Math.floor(at / nx / ny)],
                  number, words);
      }
    }
    return words;
  }

  // Codes of a brick's own light at 9 x 9 x 9 voxels, those of neighbours among them; null where all
  // are 0. `places`: of each brick of the volume, its number among codes or kNone.
  function padGlow(volumes, volume, cell, places) {
    const [nx, ny, nz] = volume.extent, [x0, y0, z0] = cell, words = new Uint32Array(729);
    for (let i = 0; i < 729; ++i) {
      const x = i % 9, y = Math.floor(i / 9) % 9, z = Math.floor(i / 81);
      const at = [x0 + (x >> 3), y0 + (y >> 3), z0 + (z >> 3)];
      if (at[0] >= nx || at[1] >= ny || at[2] >= nz) continue;
      const brick = volumes.table[volume.firstCell + (at[2] * ny + at[1]) * nx + at[0]];
      const place = brick === kNone ? kNone : places[brick];
      if (place !== kNone) words[i] = volumes.glowCodes[512 * place + ((z & 7) * 8 + (y & 7)) * 8 + (x & 7)];
    }
    return words.some(word => word !== 0) ? words : null;
  }

  // Of each brick of all volumes the first of its words, or kNone; then those of bricks that glow.
  function packGlow(volumes) {
    const firsts = new Uint32Array(volumes.scale.length).fill(kNone), parts = [firsts];
    let size = firsts.length;
    for (const volume of volumes.list.filter(volume => volume.own !== null)) {
      const [nx, ny, nz] = volume.extent, places = new Uint32Array(volume.bricks).fill(kNone);
      for (let i = volume.own.firstBrick; i < volume.own.firstBrick + volume.own.bricks; ++i) {
        places[volumes.glowBricks[i]] = i;
      }
      for (let at = 0; at < nx * ny * nz; ++at) {
        const number = volumes.table[volume.firstCell + at];
        if (number === kNone) continue;
        const cell = [at % nx, Math.floor(at / nx) % ny, Math.floor(at / nx / ny)];
        const words = padGlow(volumes, volume, cell, places);
        if (words === null) continue;
        firsts[volume.firstBrickNumber + number] = size;
        parts.push(words);
        size += words.length;
      }
    }
    const all = new Uint32Array(size);
    let to = 0;
    for (const part of parts) {
      all.set(part, to);
      to += part.length;
    }
    return all;
  }

  // Rows of a 3 x 4 matrix, world to index coordinates; null where there is no inverse.
  function inverseOf(m) {
    const column = c => [m[c], m[4 + c], m[8 + c]];
    const [a, b, c, origin] = [0, 1, 2, 3].map(column);
    const rows = [Vector.cross(b, c), Vector.cross(c, a), Vector.cross(a, b)];
    const determinant = Vector.dot(a, rows[0]);
    if (!(Math.abs(determinant) > 0)) return null;
    return rows.map(row => {
      const unit = Vector.times(1 / determinant, row);
      return [...unit, -Vector.dot(unit, origin)];
    });
  }

  // Real spherical harmonics up to degree 4 (formats/README.md, `PRIM`).
  function harmonics([x, y, z]) {
    const xx = x * x, yy = y * y, zz = z * z;
    return [0.2820947918, 0.4886025119 * y, 0.4886025119 * z, 0.4886025119 * x,
            1.0925484306 * x * y, 1.0925484306 * y * z, 0.3153915653 * (3 * zz - 1),
            1.0925484306 * x * z, 0.5462742153 * (xx - yy), 0.5900435899 * y * (3 * xx - yy),
            2.8906114426 * x * y * z, 0.4570457995 * y * (5 * zz - 1),
            0.3731763326 * z * (5 * zz - 3), 0.4570457995 * x * (5 * zz - 1),
            1.4453057213 * z * (xx - yy), 0.5900435899 * x * (xx - 3 * yy),
            2.5033429418 * x * y * (xx - yy), 1.7701307698 * y * z * (3 * xx - yy),
            0.9461746958 * x * y * (7 * zz - 1), 0.6690465436 * y * z * (7 * zz - 3),
            0.1057855469 * (zz * (35 * zz - 30) + 3), 0.6690465436 * x * z * (7 * zz - 3),
            0.4730873479 * (xx - yy) * (7 * zz - 1), 1.7701307698 * x * z * (xx - 3 * yy),
            0.6258357354 * (xx * (xx - 3 * yy) - yy * (3 * xx - yy))];
  }

  const luminance = (values, j) =>
      0.2126 * values[3 * j] + 0.7152 * values[3 * j + 1] + 0.0722 * values[3 * j + 2];

  // Whether moments miss the phase function somewhere (needs_suns of runtime/volumes/suns.h).
  function needsSuns(volume, phase) {
    const moment = c => {
      let sum = 0, before = 0, legendre = 1;
      for (let l = 0; l < 5 && l * l < volume.single; ++l) {
        sum += (2 * l + 1) * volume.moments[l] * legendre;
        [before, legendre] = [legendre, ((2 * l + 1) * c * legendre - l * before) / (l + 1)];
      }
      return sum;
    };
    return volume.single > 0 && phase.some((p, i) => {
      const end = (i < 128 ? i : 256 - i) / 128, cosine = i < 128 ? end * end - 1 : 1 - end * end;
      return Math.abs(4 * Math.PI * p - moment(cosine)) > 0.01;
    });
  }

  // Small bright lights and the rest (split_suns of runtime/volumes/suns.h).
  function splitSuns(integral, n) {
    const rest = integral.slice(), bright = new Float64Array(integral.length / 3);
    for (let j = 0; j < bright.length; ++j) bright[j] = Math.max(0, luminance(integral, j));
    const whole = bright.reduce((a, b) => a + b, 0);
    const threshold = Math.max(whole / 128, bright.slice().sort()[bright.length - 1 - kMostSuns]);
    const suns = [];
    bright.forEach((y, texel) => {
      if (!(y > threshold)) return;
      const share = Math.min(1, y / threshold - 1), light = [0, 1, 2].map(b => share * integral[3 * texel + b]);
      light.forEach((x, b) => { rest[3 * texel + b] -= x; });
      suns.push({ texel, light, centre: Light.texelDirection(n, texel) });
    });
    const reach = Math.cos(3 / n);
    for (const sun of suns) {
      let sum = [0, 0, 0];
      for (const other of suns) {
        if (Vector.dot(sun.centre, other.centre) <= reach) continue;
        sum = Vector.add(sum, Vector.times(luminance(other.light, 0), other.centre));
      }
      sun.direction = Vector.norm(sum) > 0 ? Vector.times(1 / Vector.norm(sum), sum) : sun.centre;
    }
    return { suns, rest };
  }

  // Light vectors after each other in one array.
  function joined(lights) {
    const size = lights.length > 0 ? lights[0].length : 0, all = new Float32Array(size * lights.length);
    lights.forEach((light, k) => all.set(light, k * size));
    return all;
  }

  function momentLights(integral, n, count) {
    const harmonic = Array.from({ length: integral.length / 3 },
                                (_, j) => harmonics(Light.texelDirection(n, j)));
    return Array.from({ length: count }, (_, k) =>
        Light.coefficientsOf(integral.map((x, i) => x * harmonic[Math.floor(i / 3)][k]), n));
  }

  // Shares of suns' light that reach a node, as its rows have them (find_reach of
  // runtime/volumes/relight_volumes.cpp); `sent`: by each sun, four values.
  function findReach(volumes, volume, node, lights, part, sent, reach) {
    const { parts } = lights, met = new Float32Array(4 * parts.length), to = 3 * node * part.suns;
    Rows.addRow(volumes.rows, volume, node * (1 + volume.multiple), lights.suns, new Array(parts.length).fill(1), met, 0);
    parts.forEach(({ joint }, s) => {
      for (let b = 0; b < 3; ++b) {
        if (sent[4 * joint + b] > 0) reach[to + 3 * joint + b] += met[4 * s + b] / sent[4 * joint + b];
      }
    });
    for (let i = to; i < to + 3 * part.suns; ++i) reach[i] = Math.min(Math.max(reach[i], 0), 2);
  }

  function lightVolume(volumes, v, lights, part, values) {
    const { rows } = volumes, volume = volumes.list[v], reach = new Float32Array(3 * part.suns * volume.nodes);
    const sent = values.subarray(4 * (part.first - part.suns), 4 * part.first);
    const degree = k => Math.floor(Math.sqrt(k));
    const factors = Array.from({ length: volume.single }, (_, k) =>
        (degree(k) % 2 === 0 ? 1 : -1) * volume.moments[degree(k)]);
    const moments = part.suns > 0 ? lights.momentsOfRest : lights.moments;
    const scale = [volume.multiple === 1 ? Math.sqrt(4 * Math.PI) : 1];
    for (let node = 0; node < volume.nodes; ++node) {
      const row = node * (1 + volume.multiple), to = 4 * (part.first + node * part.terms);
      Rows.addRow(rows, volume, row, moments, factors, values, to);
      if (part.suns > 0) findReach(volumes, volume, node, lights, part, sent, reach);
      for (let k = 0; k < volume.multiple; ++k) {
        Rows.addRow(rows, volume, row + 1 + k, lights.whole, scale, values, to + 4 * k);
      }
    }
    if (part.suns > 0) VolumeSuns.light(volumes, v, lights.directions, lights.columns, reach, part, values);
  }

  // The most terms of a node, suns left out.
  const termsOf = volume => Math.max(volume.single, volume.multiple, ...volume.glow.map(g => g.terms));

  // What nodes scatter of distant light: four values a coefficient (VolumeLight of
  // runtime/volumes/relight_volumes.h); suns: their directions.
  function relight(volumes, { integral, coefficients }, n) {
    const wants = volumes.list.map((volume, v) =>
        needsSuns(volume, volumes.phase.subarray(kPhaseEntries * v, kPhaseEntries * (v + 1))));
    const split = wants.some(x => x) ? splitSuns(integral, n) : { suns: [], rest: integral };
    // Parts of a small light between texels have one direction.
    const { rest } = split, suns = [];
    const parts = split.suns.map(({ texel, light, direction }) => {
      const same = suns.findIndex(other => other.every((x, i) => x === direction[i]));
      if (same < 0) suns.push(direction);
      return { texel, light, joint: same < 0 ? suns.length - 1 : same };
    });
    const most = wanted => volumes.list.reduce(
        (a, volume, v) => wants[v] === wanted || suns.length === 0 ? Math.max(a, volume.single) : a, 0);
    const sunLights = parts.map(part => {
      const alone = new Float64Array(integral.length);
      alone.set(part.light, 3 * part.texel);
      return Light.coefficientsOf(alone, n);
    });
    const lights = { whole: coefficients, parts, directions: suns, suns: joined(sunLights),
                     columns: VolumeSuns.findColumns(volumes, suns),
                     moments: joined(momentLights(integral, n, most(false))),
                     momentsOfRest: suns.length > 0 ? joined(momentLights(rest, n, most(true))) : null };
    let first = 0;
    const shown = volumes.list.map((volume, v) => {
      const part = { terms: termsOf(volume), suns: wants[v] ? suns.length : 0,
                     sunTerms: volumes.sunTerms[v], first,
                     sunPower: volumes.sunPowers.subarray(kMostSunTerms * v, kMostSunTerms * (v + 1)) };
      // Before nodes: what each sun sends; before that the points of suns, brick after brick downward.
      const points = (VolumeSuns.boxesOf(volume) + 1) ** 3;
      part.first += part.suns * (1 + volume.bricks * points * part.sunTerms);
      first = part.first + volume.nodes * part.terms;
      return part;
    });
    const values = new Float32Array(4 * first);
    for (const part of shown.filter(part => part.suns > 0)) {
      for (const { light, joint } of parts) {
        light.forEach((x, b) => { values[4 * (part.first - part.suns + joint) + b] += x; });
      }
    }
    volumes.list.forEach((_, v) => lightVolume(volumes, v, lights, shown[v], values));
    return { parts: shown, values, suns };
  }

  // The same with what nodes scatter of emitters; `colors`: times which these shine.
  function withGlow(volumes, { parts, values }, colors) {
    if (volumes.glowValues.length === 0) return values;
    const sum = values.slice();
    volumes.list.forEach((volume, v) => {
      const { first, terms } = parts[v];
      for (const glow of volume.glow) {
        const color = colors[glow.emitter].map(c => c * glow.valueScale);
        if (color.every(c => c === 0)) continue;
        for (let node = 0, from = glow.firstValue; node < volume.nodes; ++node) {
          const to = 4 * (first + node * terms);
          for (let k = 0; k < glow.terms; ++k, from += 3) {
            for (let b = 0; b < 3; ++b) {
              sum[to + 4 * k + b] += color[b] * Light.kFloats[volumes.glowValues[from + b]];
            }
          }
        }
      }
    });
    return sum;
  }

  // What the shader knows of each volume, seen from there.
  function uniforms(volumes, inverses, parts, frame, colors) {
    const values = { "glow_colors[0]": volumes.list.flatMap(({ own }) => own === null ? [0, 0, 0, 0]
        : [...colors[own.emitter].map(c => Math.min(c * own.codeScale / frame.unit, 1e30)), 0]) };
    volumes.list.forEach((volume, v) => {
      const inverse = inverses[v], set = (name, value) => { values[`volumes[${v}].${name}`] = value; };
      if (inverse === null) {
        set("extent_first", [0, 0, 0, 0]);
        return;
      }
      set("to_bricks[0]", inverse.flatMap((row, a) => [
        ...row.slice(0, 3).map(x => x / 8 / frame.unit),
        (Vector.dot(row, frame.eye) + row[3]) / 8 - volume.firstBrick[a]]));
      set("extent_first", [...volume.extent, volume.firstCell]);
      set("numbers", [volume.firstBrickNumber, volume.firstCorner, 8 / volume.spacing, parts[v].terms]);
      set("extinction", [...volume.extinction.map(s => Math.min(s / frame.unit, 1e30)),
                         parts[v].sunPower[1]]);
      set("albedo", [...volume.albedo, parts[v].sunPower[2]]);
      set("coefficient", [3 * parts[v].first, parts[v].suns, kMostSunTerms * kPhaseEntries * v,
                          parts[v].sunTerms]);
    });
    return values;
  }

  return { packDensity, packGlow, inverseOf, termsOf, relight, withGlow, uniforms, splitSuns, harmonics,
           kBrickWords, kMostSuns };
})();
