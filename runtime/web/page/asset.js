"use strict";
// The asset's records, as formats/README.md has them.
const Asset = (() => {
  const kNoImage = 0xffffffff;
  const floats = words => new Float32Array(words.buffer, words.byteOffset, words.length);
  const image = number => number === kNoImage ? null : number;
  const large = (words, at) => words[at] + words[at + 1] * 2 ** 32;

  // Calls make(words, floats) for each record of `size` words.
  function records(words, size, make) {
    const list = [];
    for (let at = 0; at < words.length; at += size) {
      const record = words.subarray(at, at + size);
      list.push(make(record, floats(record)));
    }
    return list;
  }

  function readPrimitives(words) {
    return records(words, 20, (w, f) => ({
      firstVertex: w[4], vertices: w[5], firstIndex: w[6], indices: w[7], terms: w[8], bands: w[9],
      firstRow: w[10], firstBandRow: w[11], firstCode: large(w, 12),
      shading: ["", "diffuse", "translucent", "sheet"][w[14]], image: image(w[15]),
      wrap: [w[16], w[17]], isDoubleSided: (w[18] & 1) !== 0, isSeparate: (w[18] & 2) !== 0,
      showsBack: w[14] !== 1 || (w[18] & 1) !== 0,
      eta: f[19], roughness: -1, gloss: null, hole: null, normalMap: null, own: null, blocks: [] }));
  }

  function readGloss(words) {
    return records(words, 10, (w, f) => f[1] < 0 ? null : {
      metallic: f[0], roughness: f[1], f0f90: Array.from(f.subarray(2, 6)), image: image(w[6]),
      wrap: [w[7], w[8]] });
  }

  // Triangles count vertices of the whole asset.
  function absoluteTriangles(triangles, primitives) {
    const absolute = new Uint32Array(triangles.length);
    for (const p of primitives) {
      for (let i = p.firstIndex; i < p.firstIndex + p.indices; ++i) {
        absolute[i] = triangles[i] + p.firstVertex;
      }
    }
    return absolute;
  }

  // `of`: what begins the names.
  function readRows(arrays, of, cubemap) {
    return { cubemap, squares: arrays.get(`${of}code bits`)[0] === 8,
             offset: arrays.get(`${of}row offset`),
             averageScale: arrays.get(`${of}average scale`),
             detailScale: arrays.get(`${of}detail scale`),
             averageCode: arrays.get(`${of}average code`), index: arrays.get(`${of}index`),
             code: arrays.get(`${of}code`) };
  }

  // What volumes send out, and scatter of emitters (`GLOW`).
  function readGlow(arrays) {
    return records(arrays.get("glow"), 12, (w, f) => ({
      volume: w[0], emitter: w[1], firstValue: large(w, 2), valueScale: f[4], terms: w[5],
      firstBrick: w[6], bricks: w[7], codeScale: f[8] }));
  }

  function readVolumes(arrays, cubemap) {
    const list = records(arrays.get("volumes"), 48, (w, f) => ({
      toWorld: Array.from(f.subarray(0, 12)), extinction: Array.from(f.subarray(12, 15)),
      albedo: Array.from(f.subarray(15, 18)),
      firstBrick: Array.from(new Int32Array(w.buffer, w.byteOffset + 72, 3)),
      extent: Array.from(w.subarray(21, 24)), firstBrickNumber: w[24], bricks: w[25],
      firstCell: large(w, 26), firstCorner: large(w, 28), spacing: w[30], nodes: w[32],
      single: w[33], multiple: w[34], bands: w[35], firstRow: w[36], firstBandRow: w[37],
      firstCode: large(w, 38), moments: Array.from(f.subarray(40, 45)) }));
    if (list.length === 0) return null;
    const glow = readGlow(arrays);
    list.forEach((volume, v) => {
      volume.glow = glow.filter(record => record.volume === v);
      volume.own = volume.glow.find(record => record.bricks > 0) ?? null;
    });
    return { list, table: arrays.get("brick table"), scale: arrays.get("density scale"),
             density: arrays.get("density"), corners: arrays.get("corners"),
             glowBricks: arrays.get("glow bricks"), glowCodes: arrays.get("glow codes"),
             glowValues: arrays.get("glow values"),
             phase: arrays.get("phase"), sunTerms: arrays.get("sun terms"),
             sunPowers: arrays.get("sun powers"), sunTables: arrays.get("sun tables"),
             rows: readRows(arrays, "volume ", cubemap) };
  }

  function read(arrays) {
    const primitives = readPrimitives(arrays.get("primitives"));
    const offset = arrays.get("slot offset"), shares = offset.length > 0;
    primitives.forEach((primitive, p) => {
      primitive.firstSlot = shares ? offset[p] : primitive.firstVertex;
      primitive.slots = shares ? offset[p + 1] - offset[p] : primitive.vertices;
    });
    arrays.get("roughness").forEach((roughness, p) => { primitives[p].roughness = roughness; });
    readGloss(arrays.get("gloss")).forEach((gloss, p) => { primitives[p].gloss = gloss; });
    records(arrays.get("holes"), 8, (w, f) => {
      primitives[w[0]].hole = { image: image(w[1]), wrap: [w[2], w[3]], alpha: f[4], cutoff: f[5],
                                mode: w[6],
                                clear: w[7] === 0 ? null : [Light.kFloats[w[7] & 0xffff], Light.kFloats[w[7] >>> 16]] };
    });
    records(arrays.get("normal maps"), 8, (w, f) => {
      const halves = [w[5], w[5] >>> 16, w[6], w[6] >>> 16, w[7], w[7] >>> 16].map(x => x & 0xffff);
      primitives[w[0]].normalMap = { image: image(w[1]), wrap: [w[2], w[3]], scale: f[4],
                                     shares: halves.map(half => Light.kFloats[half]) };
    });
    records(arrays.get("own lights"), 8, (w, f) => {
      primitives[w[0]].own = { emitter: w[1], radiance: Array.from(f.subarray(2, 5)),
                               image: image(w[5]), wrap: [w[6], w[7]] };
    });
    records(arrays.get("emitter blocks"), 6, (w, f) => {
      primitives[w[1]].blocks.push({ emitter: w[0], firstValue: large(w, 2), scale: f[4] });
    });
    const sizes = arrays.get("image sizes"), [cubemap] = arrays.get("cubemap");
    return {
      primitives, camera: arrays.get("camera"),
      position: arrays.get("position"), normal: arrays.get("normal"),
      baseColor: arrays.get("base color"), texcoord: arrays.get("texcoord"),
      slots: arrays.get("slots"), mixes: arrays.get("slot mixes"), openness: arrays.get("openness"), alpha: arrays.get("alpha"),
      tangents: arrays.get("tangents"), albedo: arrays.get("albedo"),
      triangles: absoluteTriangles(arrays.get("triangles"), primitives),
      images: Array.from({ length: sizes.length / 2 }, (_, i) => ({
        width: sizes[2 * i], height: sizes[2 * i + 1], pixels: arrays.get(`image ${i}`) })),
      emitterValues: arrays.get("emitter values"),
      cubemap, rows: readRows(arrays, "", cubemap), volumes: readVolumes(arrays, cubemap),
      layer: Layer.read(arrays),
    };
  }

  return { read };
})();
