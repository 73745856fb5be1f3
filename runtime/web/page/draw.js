"use strict";
// WebGL 2: an asset before its light, a sample of every pixel at a time. Programs are specialised as
// those of runtime/gl/gl_surfaces.cpp.
const Draw = (() => {
  const { kColumns, makeProgram, setUniforms, bind, makeTexture, makeTable, makeLines, makeTarget,
          addColors, freeTarget } = Gl;

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
      HOLE_VERTICES: hole && hasAlpha, HAS_TEXCOORD: hasImage, HAS_VIEW: isTranslucent || gloss || normalMap,
      NORMAL_MAP: normalMap, TURNED: normalMap && (shading === "diffuse" || isTurnedSheet(primitive)),
      TWO_SIDES: isTurnedSheet(primitive),
      HAS_OPENNESS: mirrors || gloss, SHEET: shading === "sheet", OPAQUE: shading === "diffuse",
      SEPARATE: primitive.isSeparate };
    const defines = Object.entries(words).filter(([, wanted]) => wanted).map(([word]) => [word, ""]);
    defines.push(["RADIANCE_OF_ROWS", ""], ["FORWARD_DEPTH", ""], ["TERMS", terms],
                 ["HARMONICS", harmonics], ["WRAP_CLAMP", 1], ["WRAP_MIRROR", 2],
                 ["SPREAD_SAMPLES", ""]);
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
                     ["BRICK_WORDS", Volumes.kBrickWords], ["LAYER", hasLayer ? 1 : 0], ["SHEET_TOLERANCE", "0.03125"],
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
    const program = makeProgram(
        gl, [...Layer.defines(layer), ["SHEET", hasSheet ? 1 : 0]], ["screen.vert.glsl"],
        ["cube_map.glsl", "arc_tangent.glsl", "environment.glsl", "layer_tables.glsl", "layer_march.glsl",
         "layer_see.glsl", "layers.frag.glsl"]);
    const around = !looksAround ? null : makeProgram(
        gl, Layer.defines(layer), ["screen.vert.glsl"],
        ["cube_map.glsl", "arc_tangent.glsl", "environment.glsl", "layer_tables.glsl", "layer_march.glsl",
         "layer_see.glsl", "around.frag.glsl"]);
    for (const { name } of around === null ? [program] : [program, around]) {
      gl.uniformBlockBinding(name, gl.getUniformBlockIndex(name, "Layer"), 0);
    }
    return { program, around, block: gl.createBuffer(), tables: makeLines(gl, kFloatLines(gl), layer.tables),
             albedo: makePictures(gl, layer.albedo), radiosity: Radiosity.make(gl, layer),
             thickness: null, time: NaN, record: null, lit: null };
  }

  // What surfaces mirror: `blurred` maps by level of roughness; for gloss a cube map, cells and suns.
  function makeMirrored(gl, { blurred, cube, cells, suns }) {
    return { blurred, suns: suns.length / 8, sunTable: makePairs(gl, suns), cells: makePairs(gl, cells),
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

  // Interface: setLight(light), project(turn, time), relight(projected, colors), resize(width, height),
  // drawSample(...), present(...), readPixels(...).
  function make(canvas, asset) {
    const gl = canvas.getContext("webgl2", { alpha: false, antialias: false, depth: false });
    if (gl === null) throw new Error("this browser has no WebGL 2: use a current one, or allow it " +
                                     "to use the graphics of this device");
    if (gl.getExtension("EXT_color_buffer_float") === null) {
      throw new Error("the graphics of this device draw no numbers beyond 8 bits");
    }
    // Where floats cannot be added up, halves can.
    const sumFormat = gl.getExtension("EXT_float_blend") === null ? gl.RGBA16F : gl.RGBA32F;
    const objects = makeAssetObjects(gl, asset);
    const background = makeProgram(gl, [], ["screen.vert.glsl"],
                                   ["cube_map.glsl", "arc_tangent.glsl", "environment.glsl", "background.frag.glsl"]);
    const adding = makeProgram(gl, [], ["screen.vert.glsl"], ["add_sample.frag.glsl"]);
    const presenting = makeProgram(gl, [], ["screen.vert.glsl"], ["present.frag.glsl"]);
    const looksAround = asset.layer !== null && (asset.primitives.length > 0 || asset.volumes !== null);
    const mirrors = { levels: [...new Set(asset.primitives.filter(p => p.roughness >= 0).map(p => levelOf(p.roughness)))],
                      hasGloss: asset.primitives.some(p => p.gloss !== null) };
    const mirrorsLayer = looksAround && (mirrors.hasGloss || mirrors.levels.length > 0) ? Mirrors.make(gl) : null;
    const layer = asset.layer === null ? null
        : makeLayerObjects(gl, asset.layer, asset.volumes !== null, looksAround);
    const volumes = asset.volumes === null ? null : makeVolumeObjects(gl, asset.volumes, layer !== null);
    let size = [0, 0], sampled = null, clouded = null, marched = null, sum = null, light = null, lightObjects = null;
    let mirrored = null;
    let turnedOf = new Map();  // uniforms, of primitives with normal maps

    function setLight(next) {
      if (lightObjects !== null) freeLightObjects(gl, lightObjects);
      light = next;
      lightObjects = makeLightObjects(gl, light);
      if (layer === null) setMirrored(mirroredOf(gl, light, mirrors));
    }

    function setMirrored(next) {
      if (mirrored !== null) freeMirrored(gl, mirrored);
      mirrored = next;
    }

    // The light turned by `turn` [radians], as Light.project gives it, for each primitive and for volumes; with a
    // cloud layer what that leaves of it at a time [s] where they are, and null where it lights no bodies.
    function project(turn, time) {
      if (layer === null) {
        const one = Light.project(light, asset.cubemap, turn);
        return { primitives: asset.primitives.map(() => one), volumes: one };
      }
      moveLayer(time);
      lightLayer(turn);
      if (!looksAround) return null;
      const { centre, at, ofPrimitive, ofVolumes } = asset.layer.points;
      const around = at.map(point => lookAround(turn, point));
      if (mirrorsLayer !== null) {
        const all = at.length > 1 ? lookAround(turn, centre) : around[0];
        setMirrored(makeMirrored(gl, mirrorsLayer.of(all, mirrors.levels, mirrors.hasGloss)));
      }
      const lights = around.map(seen => Light.project(seen, asset.cubemap, 0));
      return { primitives: Array.from(ofPrimitive, number => lights[number]), volumes: lights[ofVolumes] };
    }

    function moveLayer(time) {
      if (layer.time === time) return;
      gl.deleteTexture(layer.thickness);
      layer.thickness = makeLines(gl, kFloatLines(gl), Layer.thicknessAt(asset.layer, time));
      layer.time = time;
    }

    // Light between ground and base too.
    function lightLayer(turn) {
      layer.record = Layer.turned(light.layer, turn);
      bindLayer(Layer.cornerAt(asset.layer, light.layer, layer.time));
      layer.lit = layer.radiosity.solve(Layer.openGround(asset.layer, light.layer));
    }

    // What lights bodies at a point with a cloud layer around them, as a light that is not to be turned.
    function lookAround(turn, point) {
      const side = Light.kSide, target = makeTarget(gl, side, 6 * side + 1, gl.RGBA32F, false);
      gl.disable(gl.BLEND);
      gl.disable(gl.DEPTH_TEST);
      gl.viewport(0, 0, side, 6 * side + 1);
      gl.useProgram(layer.around.name);
      bindLayer(Layer.bodiesAt(light.layer, point));
      setUniforms(gl, layer.around, { ...skyUniforms(turn), side });
      gl.drawArrays(gl.TRIANGLES, 0, 3);
      const seen = new Float32Array(4 * side * (6 * side + 1));
      gl.readPixels(0, 0, side, 6 * side + 1, gl.RGBA, gl.FLOAT, seen);
      freeTarget(gl, target);
      const cube = new Float32Array(18 * side * side);
      for (let i = 0; i < cube.length; ++i) cube[i] = seen[4 * Math.floor(i / 3) + i % 3];
      return { cube, padded: Light.padCube(cube), points: new Float32Array(0),
               suns: Layer.sunsBelow(layer.record, light.discs, seen.subarray(24 * side * side), turn) };
    }

    // `projected`: of project.
    function relight(projected, colors) {
      if (projected === null) return;
      Rows.multiply(asset, projected.primitives.map(one => one.coefficients), colors, objects.values);
      bind(gl, "products", objects.products);
      gl.texSubImage2D(gl.TEXTURE_2D, 0, 0, 0, kColumns, objects.lines, gl.RGBA, gl.FLOAT,
                       objects.values);
      turnLight(projected.primitives);
      if (volumes === null) return;
      if (volumes.litBy !== projected) {
        volumes.lit = Volumes.relight(asset.volumes, projected.volumes, asset.cubemap);
        volumes.litBy = projected;
      }
      gl.deleteTexture(volumes.light);
      volumes.light = makeLines(gl, [gl.RGBA32F, gl.RGBA, gl.FLOAT],
                                Volumes.withGlow(asset.volumes, volumes.lit, colors), 4);
    }

    // For normal maps.
    function turnLight(lights) {
      const made = new Map();  // by light
      turnedOf = new Map();
      asset.primitives.forEach((primitive, p) => {
        if (primitive.normalMap === null) return;
        if (!made.has(lights[p])) made.set(lights[p], TurnedLight.make(lights[p], asset.cubemap));
        const own = made.get(lights[p]);
        turnedOf.set(primitive, TurnedLight.uniforms(
            isTurnedSheet(primitive) ? TurnedLight.ofSheet(own, primitive.normalMap.shares) : own));
      });
    }

    function resize(width, height) {
      if (size[0] === width && size[1] === height) return;
      if (sum !== null) [sampled, clouded, marched, sum].forEach(target => target && freeTarget(gl, target));
      size = [width, height];
      sampled = makeTarget(gl, width, height, gl.RGBA32F, true);
      if (layer !== null) {
        clouded = makeTarget(gl, width, height, gl.RGBA32F, false);
        if (volumes !== null) addColors(gl, clouded, 2, width, height);  // LayerSheet of clouds/layer_sheet.h
      }
      if (volumes !== null) marched = makeTarget(gl, width, height, gl.RGBA32F, false);
      sum = makeTarget(gl, width, height, sumFormat, false);
    }

    // From the world to the light, which is turned about +Y; column by column.
    function lightFromWorld(turn) {
      const c = Math.cos(turn), s = Math.sin(turn);
      return [c, 0, s, 0, 1, 0, -s, 0, c];
    }

    // Of rays through the samples at `place` in each pixel.
    function rayUniforms(frame, place) {
      return { tile_origin: place.map(offset => offset - 0.5), to_plane: [2 / size[0], 2 / size[1]],
               right: Vector.times(frame.tangent[0], frame.right),
               down: Vector.times(-frame.tangent[1], frame.up), forward: frame.forward };
    }

    // For what shows the sky; binds its map.
    function skyUniforms(turn) {
      bind(gl, "map", lightObjects.map, gl.TEXTURE_2D_ARRAY);
      bind(gl, "disc_table", lightObjects.discTable);
      return { light_from_world: lightFromWorld(turn), layout_kind: light.background.layout,
               u_offset_sign: light.background.turn, rows_include_poles: light.background.includesPoles,
               discs: lightObjects.discs };
    }

    function drawBackground(frame, turn, place) {
      gl.useProgram(background.name);
      setUniforms(gl, background, { ...rayUniforms(frame, place), ...skyUniforms(turn) });
      gl.disable(gl.DEPTH_TEST);
      gl.drawArrays(gl.TRIANGLES, 0, 3);
    }

    // Of the primitive alone.
    function surfaceUniforms(primitive, colors) {
      const { gloss, hole, normalMap, own } = primitive, level = levelOf(Math.max(primitive.roughness, 0));
      const bindImage = (unit, number) => {
        if (number != null) bind(gl, unit, objects.images[number]);
      };
      bindImage("base_color_image", primitive.image);
      bindImage("gloss_image", gloss?.image);
      bindImage("own_image", own?.image);
      bindImage("hole_image", hole?.image);
      bindImage("normal_image", normalMap?.image);
      bind(gl, "mirrored_light", mirrored?.blurred.get(level) ?? null, gl.TEXTURE_2D_ARRAY);
      return {
        first_row: (primitive.firstRow - primitive.firstVertex * primitive.terms) >>> 0,
        shown: 1, wrap: primitive.wrap, eta: primitive.eta,
        is_double_sided: primitive.isDoubleSided ? 1 : 0, has_specular: 1, lobe: lobeOf(level),
        f0_f90: gloss?.f0f90 ?? [0, 0, 0, 0],
        metallic_roughness: [gloss?.metallic ?? 0, gloss?.roughness ?? 0],
        gloss_wrap: gloss?.wrap ?? [0, 0],
        own_light: own ? own.radiance.map((x, k) => x * colors[own.emitter][k]) : [0, 0, 0],
        own_wrap: own?.wrap ?? [0, 0],
        hole: hole ? [hole.alpha, hole.cutoff, hole.mode] : [1, 0, 1],
        hole_wrap: hole?.wrap ?? [0, 0],
        normal_wrap: normalMap?.wrap ?? [0, 0], normal_scale: normalMap?.scale ?? 1 };
    }

    function drawSurfaces(frame, turn, colors, place, across, number) {
      bind(gl, "products", objects.products);
      bind(gl, "srgb_table", objects.srgb);
      bind(gl, "albedo", objects.albedo);
      bind(gl, "cells", mirrored?.cells ?? null);
      bind(gl, "sun_table", mirrored?.sunTable ?? null);
      bind(gl, "light_maps", mirrored?.maps ?? null, gl.TEXTURE_2D_ARRAY);
      const shared = {
        eye: frame.eye, right: Vector.times(1 / frame.tangent[0], frame.right),
        down: Vector.times(-1 / frame.tangent[1], frame.up), forward: frame.forward,
        unit: frame.unit, near_plane: frame.unit * frame.near,
        tile: [1, 1, (1 - 2 * place[0]) / size[0], (1 - 2 * place[1]) / size[1]],
        light_from_world: lightFromWorld(layer === null ? turn : 0), suns: mirrored?.suns ?? 0,
        first_sample: number, sample_step: across };
      gl.enable(gl.DEPTH_TEST);
      gl.bindVertexArray(objects.array);
      for (const { primitive, program } of objects.surfaces) {
        gl.useProgram(program.name);
        setUniforms(gl, program, { ...shared, ...turnedOf.get(primitive), ...surfaceUniforms(primitive, colors) });
        gl.drawElements(gl.TRIANGLES, primitive.indices, gl.UNSIGNED_INT, 4 * primitive.firstIndex);
      }
      gl.bindVertexArray(null);
    }

    // What programs read of a cloud layer, seen from there.
    function bindLayer(eye) {
      const block = Layer.block(asset.layer, light.layer, layer.record, eye, layer.time);
      gl.bindBufferBase(gl.UNIFORM_BUFFER, 0, layer.block);
      gl.bufferData(gl.UNIFORM_BUFFER, block, gl.DYNAMIC_DRAW);
      bind(gl, "table_values", layer.tables);
      bind(gl, "sun_values", lightObjects.layerSuns);
      bind(gl, "thickness_values", layer.thickness);
      bind(gl, "albedo_map", layer.albedo);
      bind(gl, "ground_light", layer.lit?.ground ?? null);
      bind(gl, "base_light", layer.lit?.base ?? null);
    }

    // Layer, ground and sky before and behind surfaces, from `sampled` to `clouded`.
    function drawLayer(frame, turn, place) {
      gl.bindFramebuffer(gl.FRAMEBUFFER, clouded.frame);
      gl.useProgram(layer.program.name);
      bindLayer(frame.eye);
      bind(gl, "samples", sampled.color);
      bind(gl, "depth", sampled.depth);
      setUniforms(gl, layer.program, {
        ...rayUniforms(frame, place), ...skyUniforms(turn), near_plane: frame.near, supersampling: 1,
        sees_corners: 0, shows_sky: 1, spread: 2 * frame.tangent[1] / size[1] });
      gl.drawArrays(gl.TRIANGLES, 0, 3);
    }

    // What is seen through volumes, of one sample a pixel, from `sampled` to `marched`.
    function drawVolumes(frame, colors, place) {
      const { program, lit } = volumes;
      gl.bindFramebuffer(gl.FRAMEBUFFER, marched.frame);
      gl.useProgram(program.name);
      bind(gl, "samples", (clouded ?? sampled).color);
      bind(gl, "depth", sampled.depth);
      bind(gl, "brick_numbers", volumes.table);
      bind(gl, "density_codes", volumes.density);
      bind(gl, "corner_numbers", volumes.corners);
      bind(gl, "node_light", volumes.light);
      bind(gl, "phase_entries", volumes.phase);
      bind(gl, "glow_words", volumes.glow);
      setUniforms(gl, program, {
        ...rayUniforms(frame, place), ...Volumes.uniforms(asset.volumes, volumes.inverses, lit.parts, frame, colors),
        supersampling: 1, near_plane: frame.unit * frame.near });
      if (layer !== null) {
        bind(gl, "sheet_light", clouded.more[0]);
        bind(gl, "sheet_through", clouded.more[1]);
        setUniforms(gl, program, { units_of_metre: frame.unit,
                                   eye_above_ground: frame.unit * Layer.eyeAboveGround(light.layer, frame.eye) });
      }
      if (lit.suns.length > 0) setUniforms(gl, program, { "suns[0]": lit.suns.flat() });
      gl.drawArrays(gl.TRIANGLES, 0, 3);
    }

    // Sample (i, j) of across x across in each pixel; `isFirst` begins a new sum.
    function drawSample(frame, { turn, exposure, colors }, [i, j], across, isFirst) {
      const place = [(i + 0.5) / across, (j + 0.5) / across];
      gl.disable(gl.BLEND);
      gl.viewport(0, 0, ...size);
      gl.bindFramebuffer(gl.FRAMEBUFFER, sampled.frame);
      gl.clear(gl.DEPTH_BUFFER_BIT);
      drawBackground(frame, turn, place);
      drawSurfaces(frame, turn, colors, place, across, [i, j]);
      gl.disable(gl.DEPTH_TEST);
      if (layer !== null) drawLayer(frame, turn, place);
      if (volumes !== null) drawVolumes(frame, colors, place);
      gl.bindFramebuffer(gl.FRAMEBUFFER, sum.frame);
      gl.useProgram(adding.name);
      bind(gl, "sampled", (marched ?? clouded ?? sampled).color);
      setUniforms(gl, adding, { gain: 2 ** exposure });
      if (!isFirst) gl.enable(gl.BLEND);
      gl.blendFunc(gl.ONE, gl.ONE);
      gl.drawArrays(gl.TRIANGLES, 0, 3);
      gl.disable(gl.BLEND);
    }

    // The mean of so many samples to the canvas, or to `target` of the sum's size.
    function present(samples, target = null) {
      const [width, height] = target === null ? [canvas.width, canvas.height] : size;
      gl.bindFramebuffer(gl.FRAMEBUFFER, target);
      gl.viewport(0, 0, width, height);
      gl.useProgram(presenting.name);
      bind(gl, "sum", sum.color);
      setUniforms(gl, presenting, { share: 1 / samples, scale: [size[0] / width, size[1] / height],
                                    rows: target === null ? height : 0 });
      gl.drawArrays(gl.TRIANGLES, 0, 3);
    }

    // Bytes of the picture, four a pixel, the top row first.
    function readPixels(samples) {
      const target = makeTarget(gl, ...size, gl.RGBA8, false);
      present(samples, target.frame);
      const pixels = new Uint8ClampedArray(4 * size[0] * size[1]);
      gl.readPixels(0, 0, ...size, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
      freeTarget(gl, target);
      return pixels;
    }

    return { setLight, project, relight, resize, drawSample, present, readPixels };
  }

  return { make };
})();
