"use strict";
// A cloud layer: arrays as layer_tables.glsl and what follows it read them.
const Layer = (() => {
  // Of the layer alone; null where there is none.
  function read(arrays) {
    if (!arrays.has("layer kind")) return null;
    const [repeats, modes, glows] = arrays.get("layer kind");
    const [columns, rows, frames, loops] = arrays.get("layer frames");
    const [highest, frameSeconds, ...wind] = arrays.get("layer motion");
    return { repeats, modes, glows, columns, rows, frames, loops, highest, frameSeconds, wind,
             codes: arrays.get("layer codes"), tables: arrays.get("layer tables"),
             tableFirst: arrays.get("layer tables first"), albedo: levels(arrays, "layer albedo"),
             plan: Radiosity.read(arrays), points: readPoints(arrays) };
  }

  // Where its bodies are lit, and mirror light, all of them at `centre`.
  function readPoints(arrays) {
    const places = arrays.get("light points"), at = [];
    for (let i = 0; i < places.length; i += 3) at.push(Array.from(places.subarray(i, i + 3)));
    return { centre: at[0], at: at.slice(1), ofPrimitive: arrays.get("light point of primitives"),
             ofVolumes: arrays.get("light point of volumes")[0] };
  }

  function readLight(arrays) {
    if (!arrays.has("layer record")) return null;
    return { record: arrays.get("layer record"), suns: arrays.get("layer suns"),
             sunFirst: arrays.get("layer suns first"), places: arrays.get("layer places") };
  }

  // What is seen of the frames at a time [s] (blend_frames of runtime/clouds/layer_field.h).
  function blendAt({ frames, loops, frameSeconds }, time) {
    const last = frames - 1;
    if (last === 0) return { first: 0, second: 0, share: 0 };
    const period = frameSeconds * frames;
    const within = loops ? time - period * Math.floor(time / period)
                         : Math.min(Math.max(time, 0), last * frameSeconds);
    const at = within / frameSeconds, first = Math.min(Math.floor(at), last);
    const second = first < last ? first + 1 : loops ? 0 : last;
    return { first, second, share: second === first ? 0 : Math.min(Math.max(at - first, 0), 1) };
  }

  // Means over max(1, count / 2) equal parts of the middle index of [outer][count][inner] values.
  function halve(values, outer, count, inner) {
    const half = Math.max(1, count >> 1), length = count / half, means = new Float32Array(outer * half * inner);
    for (let i = 0; i < half; ++i) {
      const begin = i * length, end = Math.min(begin + length, count);
      for (let k = Math.floor(begin); k < end; ++k) {
        const share = (Math.min(k + 1, end) - Math.max(k, begin)) / length;
        for (let o = 0; o < outer; ++o) {
          const from = (o * count + k) * inner, to = (o * half + i) * inner;
          for (let j = 0; j < inner; ++j) means[to + j] += share * values[from + j];
        }
      }
    }
    return means;
  }

  // The thickness at a time [m] and its means over larger squares, one level after the other.
  function thicknessAt({ columns, rows, highest, codes, ...layer }, time) {
    const { first, second, share } = blendAt(layer, time), count = columns * rows;
    let level = new Float32Array(count);
    for (let i = 0; i < count; ++i) {
      const now = codes[first * count + i];
      level[i] = highest / 65535 * (now + share * (codes[second * count + i] - now));
    }
    const values = [level];
    for (let width = columns, height = rows; width > 1 || height > 1;) {
      level = halve(level, height, width, 1);
      width = Math.max(1, width >> 1);
      level = halve(level, 1, height, width);
      height = Math.max(1, height >> 1);
      values.push(level);
    }
    const all = new Float32Array(values.reduce((sum, part) => sum + part.length, 0));
    values.reduce((at, part) => { all.set(part, at); return at + part.length; }, 0);
    return all;
  }

  // For a slider [s]: from the first frame to the last one, or an hour of wind.
  function spanOf({ frames, loops, frameSeconds }) {
    return frames > 1 ? frameSeconds * (loops ? frames : frames - 1) : 3600;
  }

  const isStill = layer => layer.frames === 1 && layer.wind.every(speed => speed === 0);

  // Places in a light's record (ShaderLayer of runtime/clouds/shader_layer.h), in words; of what turns
  // with the light, those of x and z.
  const kSky = 24, kPeak = 32, kSunDiscs = 36, kSunCount = 54, kSuns = 72, kSunSize = 12;
  const kTurned = [[kPeak, kPeak + 2]];
  for (const at of [kSuns, kSuns + kSunSize]) kTurned.push([at, at + 2], [at + 8, at + 9]);

  // The record of a light turned by `turn` [radians] from +Z toward +X.
  function turned(light, turn) {
    const record = Uint32Array.from(light.record), floats = new Float32Array(record.buffer);
    const c = Math.cos(turn), s = Math.sin(turn);
    for (const [i, j] of kTurned) {
      const x = floats[i], z = floats[j];
      floats[i] = c * x + s * z;
      floats[j] = c * z - s * x;
    }
    return record;
  }

  // Direction of each of a record's suns, and the chord within which it may matter to a pixel of that spread [rad].
  function nearSuns(record, spread) {
    const floats = new Float32Array(record.buffer), list = new Float32Array(8);  // a chord of 0 is never reached
    for (let i = 0, at = kSuns; i < record[kSunCount]; ++i, at += kSunSize) {
      list.set([...floats.subarray(at, at + 3), 1.1 * floats[at + 7] + 2 * spread], 4 * i);
    }
    return list;
  }

  // Of the first corner of the grid that Radiosity cuts ground and base into, at a time.
  function cornerAt(layer, light, time) {
    const [lowX, lowZ] = light.places.subarray(8, 10);
    return [lowX + layer.wind[0] * time, light.places[13], lowZ + layer.wind[1] * time];
  }

  // Where no layer is above the ground: the light of the sky and of suns on it, and its albedo.
  function openGround(layer, light) {
    const floats = new Float32Array(Uint32Array.from(light.record).buffer), suns = [0, 0, 0];
    for (let i = 0; i < light.record[kSunCount]; ++i) {
      const sun = floats.subarray(kSuns + kSunSize * i, kSuns + kSunSize * (i + 1));
      for (let b = 0; b < 3; ++b) suns[b] += sun[1] * sun[4 + b];
    }
    const albedo = layer.plan.passes > 0 ? layer.albedo[layer.albedo.length - 1].pixels : [0, 0, 0];
    return [Array.from(floats.subarray(kSky, kSky + 3)), suns, Array.from(albedo)];
  }

  // Its suns and the sky's other discs beneath it, as Light.project takes them: `shares` of each that
  // the layer leaves, four values each; `discs`: of the sky, in the light's frame.
  function sunsBelow(record, discs, shares, turn) {
    const floats = new Float32Array(record.buffer), numbers = new Int32Array(record.buffer), list = [];
    const count = numbers[kSunCount], c = Math.cos(turn), s = Math.sin(turn);
    const put = (direction, radius, radiance, angle, i) => {
      if (direction[1] > 0) list.push(...direction, radius, ...radiance.map((x, b) => x * shares[4 * i + b]), angle);
    };
    for (let i = 0; i < count; ++i) {
      const sun = floats.subarray(kSuns + kSunSize * i, kSuns + kSunSize * (i + 1)), radius = sun[7];
      const facing = Math.PI * Math.sin(radius) ** 2;
      put(Array.from(sun.subarray(0, 3)), radius, Array.from(sun.subarray(4, 7), x => x / facing),
          4 * Math.PI * Math.sin(radius / 2) ** 2, i);
    }
    const ofLayer = numbers.subarray(kSunDiscs, kSunDiscs + 2);
    for (let i = 0; i < discs.length / 8; ++i) {
      if (ofLayer.includes(i)) continue;
      const [x, y, z, chord, r, g, b, angle] = discs.subarray(8 * i, 8 * i + 8);
      put([c * x + s * z, y, c * z - s * x], 2 * Math.asin(chord / 2), [r, g, b], angle, count + i);
    }
    return new Float32Array(list);
  }

  function levels(arrays, name) {
    const sizes = arrays.get(`${name} sizes`), pixels = arrays.get(name), list = [];
    for (let i = 0, at = 0; i < sizes.length; i += 2) {
      const [width, height] = [sizes[i], sizes[i + 1]];
      list.push({ width, height, pixels: pixels.subarray(at, at + 3 * width * height) });
      at += 3 * width * height;
    }
    return list;
  }

  const defines = layer => [["REPEAT", layer.repeats], ["MODES", layer.modes], ["GLOW", layer.glows], ["FORWARD_DEPTH", ""]];

  // The uniform block Layer of a light, turned as its `record` is, seen from there at a time.
  function block(layer, light, record, eye, time) {
    const bytes = new ArrayBuffer(4 * record.length + 48);
    new Uint32Array(bytes).set(record);
    const tail = 4 * record.length, heights = light.places.subarray(12);
    new Int32Array(bytes, tail, 4).set([layer.tableFirst[1], layer.tableFirst[2], light.sunFirst[1], 0]);
    const floats = new Float32Array(bytes, tail + 16, 8);
    for (let grid = 0; grid < 3; ++grid) {
      const places = light.places.subarray(4 * grid, 4 * grid + 4), seconds = grid === 1 ? 0 : time;  // the ground stays
      [eye[0], eye[2]].forEach((at, k) => {
        const share = (at - places[k] - layer.wind[k] * seconds) / places[2 + k];
        floats[2 * grid + k] = layer.repeats ? share - Math.floor(share) : share;
      });
    }
    floats.set([eye[1] - heights[0], eye[1] - heights[1]], 6);
    return bytes;
  }

  const eyeAboveGround = (light, eye) => eye[1] - light.places[13];

  // Where bodies at a point are lit: lifted onto the ground.
  function bodiesAt(light, point) {
    const [base, ground] = light.places.subarray(12);
    return [point[0], Math.max(point[1], ground + 1e-4 * (base - ground)), point[2]];
  }

  return { read, readLight, thicknessAt, spanOf, isStill, turned, nearSuns, cornerAt, openGround, sunsBelow, defines, block, bodiesAt,
           eyeAboveGround };
})();
