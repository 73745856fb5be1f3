"use strict";
// A cloud layer: arrays as layer_tables.glsl and what follows it read them.
const Layer = (() => {
  // Of the layer alone; null where there is none.
  function read(arrays) {
    if (!arrays.has("layer kind")) return null;
    const [repeats, modes, glows] = arrays.get("layer kind");
    return { repeats, modes, glows, thickness: arrays.get("layer thickness"),
             tables: arrays.get("layer tables"), tableFirst: arrays.get("layer tables first"),
             albedo: levels(arrays, "layer albedo") };
  }

  function readLight(arrays) {
    if (!arrays.has("layer record")) return null;
    return { record: arrays.get("layer record"), suns: arrays.get("layer suns"),
             sunFirst: arrays.get("layer suns first"), places: arrays.get("layer places"),
             ground: levels(arrays, "layer ground light"), base: levels(arrays, "layer base light") };
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

  // The uniform block Layer of a light, seen from there.
  function block(layer, light, eye) {
    const bytes = new ArrayBuffer(4 * light.record.length + 48);
    new Uint32Array(bytes).set(light.record);
    const tail = 4 * light.record.length, heights = light.places.subarray(12);
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

  return { read, readLight, defines, block, eyeAboveGround };
})();
