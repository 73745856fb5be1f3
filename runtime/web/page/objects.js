"use strict";
// WebGL 2: what never changes of an asset, and what a light alone changes. Programs are specialised as
// those of runtime/gl/gl_surfaces.cpp.
const Objects = (() => {
  const { kColumns, makeProgram, makeTexture, makeTable, makeLines } = Gl;

  // A cube's faces, or one map, as layers; cube maps with all of their levels, if wanted.
  function makeLayers(gl, width, height, layers, pixels, levels = 1) {
    const texture = makeTexture(gl, gl.TEXTURE_2D_ARRAY, levels, gl.RGB32F, width, height, layers);
    for (let level = 0; level < levels; ++level) {
      gl.texSubImage3D(gl.TEXTURE_2D_ARRAY, level, 0, 0, 0, width >> level, height >> level, layers,
                       gl.RGB, gl.FLOAT, pixels);
      if (level + 1 < levels) pixels = Light.halveCube(pixels, width >> level);
    }
    return texture;
  }

  function makeVertexArray(gl, asset) {
    const array = gl.createVertexArray();
    gl.bindVertexArray(array);
    const attribute = (place, values, size, type = gl.FLOAT, stride = 0, offset = 0) => {
      if (values.length === 0) return;
      gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
      gl.bufferData(gl.ARRAY_BUFFER, values, gl.STATIC_DRAW);
      gl.enableVertexAttribArray(place);
      gl.vertexAttribPointer(place, size, type, type !== gl.FLOAT, stride, offset);
    };
    attribute(0, asset.position, 3);
    attribute(2, asset.baseColor, 3);
    attribute(3, asset.texcoord, 2);
    attribute(4, asset.normal, 3);
    attribute(5, asset.openness, 2, gl.BYTE, 4, 0);
    attribute(6, asset.openness, 1, gl.UNSIGNED_BYTE, 4, 2);
    attribute(7, asset.alpha, 1);
    attribute(8, asset.tangents, 3, gl.SHORT, 8, 0);
    if (asset.slots.length > 0) {
      const isMixed = asset.mixes.length > 0;
      gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
      gl.bufferData(gl.ARRAY_BUFFER, isMixed ? asset.mixes : asset.slots, gl.STATIC_DRAW);
      gl.enableVertexAttribArray(1);
      gl.vertexAttribIPointer(1, isMixed ? 4 : 1, gl.UNSIGNED_INT, 0, 0);
    }
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, gl.createBuffer());
    gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, asset.triangles, gl.STATIC_DRAW);
    gl.bindVertexArray(null);
    return array;
  }

  // Whether its file says how to turn the light of a thin-walled surface.
  const isTurnedSheet = ({ shading, normalMap }) =>
    shading === "sheet" && normalMap !== null && normalMap.shares.some(share => share > 0);

  // [defines, files before the fragment shader] of a primitive.
  function kindOf(primitive, hasAlpha) {
    const { shading, terms, gloss, hole, normalMap, own } = primitive, c = opaline.constants;
    const isTranslucent = shading === "translucent", mirrors = primitive.roughness >= 0;
    const harmonics = isTranslucent ? terms - (primitive.isSeparate ? 1 : 0) : 0;
    const hasImage = primitive.image !== null || gloss?.image != null || own?.image != null ||
                     hole?.image != null || normalMap !== null;
    const words = {
      TEXTURED: primitive.image !== null, TRANSLUCENT: isTranslucent, MIRRORING: mirrors,
      GLOSS: gloss, GLOSS_TEXTURED: gloss?.image != null, GLOWS: own,
      OWN_TEXTURED: own?.image != null, HOLES: hole, HOLE_IMAGE: hole?.image != null,
      HOLE_VERTICES: hole && hasAlpha, HAS_TEXCOORD: hasImage, 
      HAS_VIEW: isTranslucent || gloss || normalMap || hole?.clear, CLEAR_HOLE: hole?.clear,
      NORMAL_MAP: normalMap, TURNED: normalMap && (shading === "diffuse" || isTurnedSheet(primitive)),
      TWO_SIDES: isTurnedSheet(primitive),
      HAS_OPENNESS: mirrors || gloss, SHEET: shading === "sheet", OPAQUE: shading === "diffuse",
      SEPARATE: primitive.isSeparate };
    const defines = Object.entries(words).filter(([, wanted]) => wanted).map(([word]) => [word, ""]);
    defines.push(["RADIANCE_OF_ROWS", ""], ["FORWARD_DEPTH", ""], ["TERMS", terms],
                 ["HARMONICS", harmonics], ["WRAP_CLAMP", 1], ["WRAP_MIRROR", 2], ["WRAP_NEAREST", 4]);
    for (const word of ["LOBE_TAPS", "ALBEDO_ROWS", "ALBEDO_COLUMNS", "NARROW_ROUGHNESS",
                        "WIDE_ROUGHNESS"]) {
      defines.push([word, c[word]]);
    }
    const files = [];
    if (hasImage) files.push("image.glsl");
    files.push("cube_map.glsl", "surface.glsl");
    if (gloss) files.push("gloss.glsl");
    if (hole) files.push("covers.glsl", "holes.glsl");
    return [defines, files];
  }

  // Cosine and sine of the half angle of a lobe, as lobe_of_alpha of runtime/specular.cpp.
  function lobeOf(level) {
    const roughness = level / opaline.constants.roughnessSteps;
    const a = Math.max(roughness * roughness, 0.05);
    return [(1 - a * a) / (1 + a * a), 2 * a / (1 + a * a)];
  }

  const levelOf = roughness => Math.round(roughness * opaline.constants.roughnessSteps);

  // What never changes: geometry, images, programs.
  function makeAssetObjects(gl, asset) {
    const rows = asset.rows.offset.length - 1, lines = Math.max(1, Math.ceil(rows / kColumns));
    const programs = new Map();
    const surfaces = asset.primitives.map(primitive => {
      const [defines, files] = kindOf(primitive, asset.alpha.length > 0);
      if (asset.slots.length > 0) defines.push(["SHARED_ROWS", ""]);
      if (asset.mixes.length > 0) defines.push(["MIXED_ROWS", ""]);
      const key = JSON.stringify(defines);
      if (!programs.has(key)) {
        programs.set(key, makeProgram(
            gl, defines, ["view_terms.glsl", "radiance_of_rows.glsl", "openness.glsl", "surface.vert.glsl"],
            [...files, "surface.frag.glsl"]));
      }
      return { primitive, program: programs.get(key) };
    });
    const srgb = Float32Array.from({ length: 256 }, (_, code) => {
      const x = code / 255;
      return x <= 0.04045 ? x / 12.92 : ((x + 0.055) / 1.055) ** 2.4;
    });
    gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
    return {
      surfaces, array: makeVertexArray(gl, asset), lines,
      values: new Float32Array(4 * kColumns * lines),
      products: makeTexture(gl, gl.TEXTURE_2D, 1, gl.RGBA32F, kColumns, lines),
      images: asset.images.map(image => makeTable(
          gl, [gl.RGB8UI, gl.RGB_INTEGER, gl.UNSIGNED_BYTE], image.width, image.height, image.pixels)),
      srgb: makeTable(gl, [gl.R32F, gl.RED, gl.FLOAT], 256, 1, srgb),
      albedo: makeTable(gl, [gl.RG32F, gl.RG, gl.FLOAT], opaline.constants.ALBEDO_COLUMNS,
                        asset.albedo.length > 0 ? opaline.constants.ALBEDO_ROWS : 0, asset.albedo),
    };
  }

  // What never changes of volumes.
  function makeVolumeObjects(gl, volumes, hasLayer) {
    const numbers = [gl.R32UI, gl.RED_INTEGER, gl.UNSIGNED_INT];
    const most = Math.max(1, ...volumes.list.map(Volumes.termsOf));
    const glows = volumes.list.some(volume => volume.own !== null);
    const defines = [["VOLUMES", volumes.list.length], ["HARMONICS", most], ["SUNS", Volumes.kMostSuns],
                     ["BRICK_WORDS", Volumes.kBrickWords], ["LAYER", hasLayer ? 1 : 0], ["SHEET_TOLERANCE", opaline.constants.SHEET_TOLERANCE],
                     ["FORWARD_DEPTH", ""], ["GLOW", glows ? 1 : 0]];
    return {
      program: makeProgram(gl, defines, ["screen.vert.glsl"],
                           ["volume_march.glsl", "harmonics.glsl", "volumes.frag.glsl"]),
      inverses: volumes.list.map(volume => Volumes.inverseOf(volume.toWorld)),
      table: makeLines(gl, numbers, volumes.table),
      density: makeLines(gl, numbers, Volumes.packDensity(volumes)),
      corners: makeLines(gl, numbers, volumes.corners),
      phase: makeLines(gl, [gl.R32F, gl.RED, gl.FLOAT], volumes.sunTables),
      glow: glows ? makeLines(gl, numbers, Volumes.packGlow(volumes)) : null,
      light: null, lit: null, litBy: null,
    };
  }

  function makePictures(gl, levels) {
    const texture = makeTexture(gl, gl.TEXTURE_2D, levels.length, gl.RGB32F, levels[0].width, levels[0].height);
    levels.forEach(({ width, height, pixels }, level) => {
      gl.texSubImage2D(gl.TEXTURE_2D, level, 0, 0, width, height, gl.RGB, gl.FLOAT, pixels);
    });
    return texture;
  }

  const kFloatLines = gl => [gl.R32F, gl.RED, gl.FLOAT];

  // What never changes of a cloud layer; `hasSheet`: volumes are seen with it; `looksAround`: it lights
  // bodies.
  function makeLayerObjects(gl, layer, hasSheet, looksAround) {
    const defines = [...Layer.defines(layer), ["SHEET", hasSheet ? 1 : 0]];
    const program = makeProgram(
        gl, defines, ["screen.vert.glsl"],
        ["cube_map.glsl", "arc_tangent.glsl", "environment.glsl", "layer_tables.glsl", "layer_march.glsl",
         "layer_see.glsl", "layers.frag.glsl"]);
    const [smooth, spread] = ["layer_smooth.frag.glsl", "layer_spread.frag.glsl"].map(
        file => makeProgram(gl, defines, ["screen.vert.glsl"], [file]));
    const around = !looksAround ? null : makeProgram(
        gl, Layer.defines(layer), ["screen.vert.glsl"],
        ["cube_map.glsl", "arc_tangent.glsl", "environment.glsl", "layer_tables.glsl", "layer_march.glsl",
         "layer_see.glsl", "around.frag.glsl"]);
    for (const { name } of around === null ? [program] : [program, around]) {
      gl.uniformBlockBinding(name, gl.getUniformBlockIndex(name, "Layer"), 0);
    }
    return { program, smooth, spread, around, block: gl.createBuffer(), tables: makeLines(gl, kFloatLines(gl), layer.tables),
             albedo: makePictures(gl, layer.albedo), radiosity: Radiosity.make(gl, layer),
             thickness: null, time: NaN, record: null, lit: null };
  }

  // What surfaces mirror: `blurred` maps by level of roughness; for gloss a cube map, cells and suns.
  function makeMirrored(gl, { blurred, cube, cells, suns }) {
    return { blurred, sunTable: makePairs(gl, suns), cells: makePairs(gl, cells),
             maps: cube === null ? null : makeLayers(gl, Light.kSide, Light.kSide, 6, cube, 8) };
  }

  function freeMirrored(gl, { blurred, sunTable, cells, maps }) {
    [...blurred.values(), sunTable, cells, maps].forEach(texture => gl.deleteTexture(texture));
  }

  // Two texels each.
  const makePairs = (gl, values) =>
      makeTable(gl, [gl.RGBA32F, gl.RGBA, gl.FLOAT], 2, values.length / 8, values);

  // Of a light as its script has it.
  function mirroredOf(gl, light, { levels, hasGloss }) {
    const blurred = new Map(levels.map(level => {
      const pixels = light.mirrored(level), side = Math.round(Math.sqrt(pixels.length / 18));
      return [level, makeLayers(gl, side, side, 6, pixels)];
    }));
    return makeMirrored(gl, { blurred, cube: hasGloss ? Light.wholeCube(light) : null, cells: light.cells,
                              suns: light.suns });
  }

  // Of one light, for all of its turns.
  function makeLightObjects(gl, light) {
    const { background } = light;
    return {
      discs: light.discs.length / 8, discTable: makePairs(gl, light.discs),
      map: background.layout === 0 ? null
          : makeLayers(gl, background.width, background.height, background.layout === 2 ? 6 : 1,
                       background.pixels),
      layerSuns: light.layer && makeLines(gl, kFloatLines(gl), light.layer.suns),
    };
  }

  function freeLightObjects(gl, objects) {
    [objects.discTable, objects.map, objects.layerSuns].forEach(texture => gl.deleteTexture(texture));
  }

  // All of an asset; null what it has not. `looksAround`: a cloud layer lights bodies.
  function make(gl, asset) {
    const looksAround = asset.layer !== null && (asset.primitives.length > 0 || asset.volumes !== null);
    const mirrors = { levels: [...new Set(asset.primitives.filter(p => p.roughness >= 0).map(p => levelOf(p.roughness)))],
                      hasGloss: asset.primitives.some(p => p.gloss !== null) };
    const mirrorsLayer = looksAround && (mirrors.hasGloss || mirrors.levels.length > 0) ? Mirrors.make(gl) : null;
    return { ...makeAssetObjects(gl, asset), looksAround, mirrors, mirrorsLayer,
             layer: asset.layer === null ? null : makeLayerObjects(gl, asset.layer, asset.volumes !== null, looksAround),
             volumes: asset.volumes === null ? null : makeVolumeObjects(gl, asset.volumes, asset.layer !== null),
             background: makeProgram(gl, [], ["screen.vert.glsl"],
                                     ["cube_map.glsl", "arc_tangent.glsl", "environment.glsl", "background.frag.glsl"]),
             resolving: makeProgram(gl, [], ["screen.vert.glsl"], ["resolve.frag.glsl"]),
             presenting: makeProgram(gl, [], ["screen.vert.glsl"], ["present.frag.glsl"]) };
  }

  return { make, isTurnedSheet, lobeOf, levelOf, kFloatLines, makeMirrored, freeMirrored, mirroredOf, makeLightObjects,
           freeLightObjects };
})();
