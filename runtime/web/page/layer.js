"use strict";
// A cloud layer: arrays as layer_tables.glsl and what follows it read them.
const Layer = (() => {
  // Of the layer alone; null where there is none.
  function read(arrays) {
    if (!arrays.has("layer kind")) return null;
    const [repeats, modes, glows, turns] = arrays.get("layer kind");
    return { repeats, modes, glows, turns: turns !== 0, thickness: arrays.get("layer thickness"),
             tables: arrays.get("layer tables"), tableFirst: arrays.get("layer tables first"),
             albedo: levels(arrays, "layer albedo") };
  }

  // `radiance`: reads an array of that name.
  function readLight(arrays, radiance) {
    if (!arrays.has("layer record")) return null;
    const [width, height] = arrays.get("layer light size");
    return { record: arrays.get("layer record"), suns: arrays.get("layer suns"),
             sunFirst: arrays.get("layer suns first"), places: arrays.get("layer places"),
             width, height, ground: radiance("layer ground light"), base: radiance("layer base light") };
  }

  // Places in a light's record (ShaderLayer of runtime/clouds/shader_layer.h), in words; of what turns
  // with the light, those of x and z.
  const kPeak = 32, kSunDiscs = 36, kSunCount = 54, kSuns = 72, kSunSize = 12;
  const kTurned = [[kPeak, kPeak + 2]];
  for (const at of [kSuns, kSuns + kSunSize]) kTurned.push([at, at + 2], [at + 8, at + 9]);

  // The light turned by `turn` [radians] from +Z toward +X: its record, and light of the ground and
  // of the base, between the two turns nearest that the light has.
  function turned(light, turn) {
    const record = Uint32Array.from(light.record), floats = new Float32Array(record.buffer);
    const c = Math.cos(turn), s = Math.sin(turn);
    for (const [i, j] of kTurned) {
      const x = floats[i], z = floats[j];
      floats[i] = c * x + s * z;
      floats[j] = c * z - s * x;
    }
    const size = 3 * light.width * light.height, turns = light.ground.length / size;
    const place = (turn / (2 * Math.PI) - Math.floor(turn / (2 * Math.PI))) * turns;
    const first = Math.min(Math.floor(place), turns - 1), share = place - first;
    const mix = grids => {
      const part = i => grids.subarray(i % turns * size, (i % turns + 1) * size);
      const next = part(first + 1);
      return part(first).map((value, i) => value + share * (next[i] - value));
    };
    return { record, ground: mix(light.ground), base: mix(light.base) };
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

  const defines = layer => [["REPEAT", layer.repeats], ["MODES", layer.modes], ["GLOW", layer.glows],
                            ["SUNS", "radiance_counts.z"], ["FORWARD_DEPTH", ""]];

  // The uniform block Layer of a light, turned as its `record` is, seen from there.
  function block(layer, light, record, eye) {
    const bytes = new ArrayBuffer(4 * record.length + 48);
    new Uint32Array(bytes).set(record);
    const tail = 4 * record.length, heights = light.places.subarray(12);
    new Int32Array(bytes, tail, 4).set([layer.tableFirst[1], layer.tableFirst[2], light.sunFirst[1], 0]);
    const floats = new Float32Array(bytes, tail + 16, 8);
    for (let grid = 0; grid < 3; ++grid) {
      const [lowX, lowZ, sizeX, sizeZ] = light.places.subarray(4 * grid, 4 * grid + 4);
      [(eye[0] - lowX) / sizeX, (eye[2] - lowZ) / sizeZ].forEach((share, k) => {
        floats[2 * grid + k] = layer.repeats ? share - Math.floor(share) : share;
      });
    }
    floats.set([eye[1] - heights[0], eye[1] - heights[1]], 6);
    return bytes;
  }

  const eyeAboveGround = (light, eye) => eye[1] - light.places[13];

  // Where all bodies are lit from: `centre`, lifted onto the ground.
  function bodiesAt(light, centre) {
    const [base, ground] = light.places.subarray(12);
    return [centre[0], Math.max(centre[1], ground + 1e-4 * (base - ground)), centre[2]];
  }

  return { read, readLight, turned, sunsBelow, defines, block, bodiesAt, eyeAboveGround };
})();
