"use strict";
// WebGL 2: tiles of a picture, as runtime/gl/gl_draw.cpp has it: samples of surfaces with their depth, a cloud
// layer, volumes or a box filter.
const Draw = (() => {
  const { setUniforms, bind, makeTarget, freeTarget } = Gl;

  const whole = (width, height) => ({ x: 0, y: 0, width, height, across: 1 });

  // `tile`: { x, y, width, height } of pixels of across x across samples; so in samples, in a picture of that size.
  function gridOf({ x, y, width, height, across }, size) {
    return { columns: size[0] * across, rows: size[1] * across, firstColumn: x * across, firstRow: y * across,
             tileColumns: width * across, tileRows: height * across };
  }

  // Interface: setLight(light), project(turn, time), relight(projected, colors), resize(width, height),
  // drawTile(...), chooseExposure(...), present(...), readPixels(...).
  function make(canvas, asset) {
    const gl = canvas.getContext("webgl2", { alpha: false, antialias: false, depth: false });
    if (gl === null) throw new Error("this browser has no WebGL 2: use a current one, or allow it " +
                                     "to use the graphics of this device");
    if (gl.getExtension("EXT_color_buffer_float") === null) {
      throw new Error("the graphics of this device draw no numbers beyond 8 bits");
    }
    const objects = Objects.make(gl, asset), lit = SceneLight.make(gl, asset, objects);
    const { layer, volumes, resolving, presenting } = objects;
    let size = [0, 0], targets = null;

    // For tiles of up to so many pixels of a picture of that size.
    function resize(width, height, tileWidth, tileHeight, across) {
      const wanted = [width, height, tileWidth, tileHeight, across].join();
      if (targets !== null && targets.made === wanted) return;
      if (targets !== null) Targets.free(gl, targets);
      targets = null;
      size = [width, height];
      targets = { ...Targets.make(gl, size, [tileWidth, tileHeight], across, layer !== null, volumes !== null),
                  made: wanted };
    }

    // Of rays through samples.
    function rayUniforms(frame, grid) {
      return { tile_origin: [grid.firstColumn, grid.firstRow], to_plane: [2 / grid.columns, 2 / grid.rows],
               right: Vector.times(frame.tangent[0], frame.right),
               down: Vector.times(-frame.tangent[1], frame.up), forward: frame.forward };
    }

    const viewSamples = grid => gl.viewport(0, 0, grid.tileColumns, grid.tileRows);

    function drawBackground(frame, turn, grid) {
      gl.useProgram(objects.background.name);
      setUniforms(gl, objects.background, { ...rayUniforms(frame, grid), ...lit.skyUniforms(turn) });
      gl.disable(gl.DEPTH_TEST);
      gl.drawArrays(gl.TRIANGLES, 0, 3);
    }

    // Of the primitive alone.
    function surfaceUniforms(primitive, colors) {
      const { gloss, hole, normalMap, own } = primitive, level = Objects.levelOf(Math.max(primitive.roughness, 0));
      const bindImage = (unit, number) => {
        if (number != null) bind(gl, unit, objects.images[number]);
      };
      bindImage("base_color_image", primitive.image);
      bindImage("gloss_image", gloss?.image);
      bindImage("own_image", own?.image);
      bindImage("hole_image", hole?.image);
      bindImage("normal_image", normalMap?.image);
      bind(gl, "mirrored_light", lit.mirrored()?.blurred.get(level) ?? null, gl.TEXTURE_2D_ARRAY);
      return {
        first_row: (primitive.firstRow - primitive.firstSlot * primitive.terms) >>> 0,
        shown: 1, wrap: primitive.wrap, eta: primitive.eta,
        is_double_sided: primitive.isDoubleSided ? 1 : 0, has_specular: 1, lobe: Objects.lobeOf(level),
        f0_f90: gloss?.f0f90 ?? [0, 0, 0, 0],
        metallic_roughness: [gloss?.metallic ?? 0, gloss?.roughness ?? 0],
        gloss_wrap: gloss?.wrap ?? [0, 0],
        own_light: own ? own.radiance.map((x, k) => x * colors[own.emitter][k]) : [0, 0, 0],
        own_wrap: own?.wrap ?? [0, 0],
        hole: hole ? [hole.alpha, hole.cutoff, hole.mode] : [1, 0, 1],
        hole_wrap: hole?.wrap ?? [0, 0], hole_clear: hole?.clear ?? [0, 0],
        normal_wrap: normalMap?.wrap ?? [0, 0], normal_scale: normalMap?.scale ?? 1 };
    }

    function drawSurfaces(frame, turn, colors, grid) {
      const mirrored = lit.mirrored();
      bind(gl, "products", objects.products);
      bind(gl, "srgb_table", objects.srgb);
      bind(gl, "albedo", objects.albedo);
      bind(gl, "cells", mirrored?.cells ?? null);
      bind(gl, "sun_table", mirrored?.sunTable ?? null);
      bind(gl, "light_maps", mirrored?.maps ?? null, gl.TEXTURE_2D_ARRAY);
      const scale = [grid.columns / grid.tileColumns, grid.rows / grid.tileRows];
      const shared = {
        eye: frame.eye, right: Vector.times(1 / frame.tangent[0], frame.right),
        down: Vector.times(-1 / frame.tangent[1], frame.up), forward: frame.forward,
        unit: frame.unit, near_plane: frame.unit * frame.near,
        tile: [...scale, scale[0] - 2 * grid.firstColumn / grid.tileColumns - 1,
               scale[1] - 2 * grid.firstRow / grid.tileRows - 1],
        light_from_world: SceneLight.lightFromWorld(layer === null ? turn : 0),
        first_sample: [grid.firstColumn, grid.firstRow] };
      gl.enable(gl.DEPTH_TEST);
      gl.bindVertexArray(objects.array);
      gl.frontFace(gl.CW);  // y points down
      for (const { primitive, program } of objects.surfaces) {
        (primitive.showsBack ? gl.disable : gl.enable).call(gl, gl.CULL_FACE);
        gl.useProgram(program.name);
        setUniforms(gl, program, { ...shared, ...lit.turnedOf(primitive), ...surfaceUniforms(primitive, colors) });
        gl.drawElements(gl.TRIANGLES, primitive.indices, gl.UNSIGNED_INT, 4 * primitive.firstIndex);
      }
      gl.disable(gl.CULL_FACE);
      gl.bindVertexArray(null);
      gl.disable(gl.DEPTH_TEST);
    }

    // Layer, ground and sky along samples, or through the corners of pixels, to the frame that is bound.
    function seeLayer(frame, turn, grid, across, seesCorners) {
      const { program } = layer;
      gl.useProgram(program.name);
      lit.bindLayer(frame.eye);
      bind(gl, "samples", targets.samples.color);
      bind(gl, "depth", targets.samples.depth);
      setUniforms(gl, program, {
        ...rayUniforms(frame, grid), ...lit.skyUniforms(turn), near_plane: frame.near, supersampling: across,
        sees_corners: seesCorners ? 1 : 0, shows_sky: 1, spread: 2 * frame.tangent[1] / size[1] });
      gl.drawArrays(gl.TRIANGLES, 0, 3);
    }

    function bindMeans({ color, more }) {
      bind(gl, "means", color);
      bind(gl, "mean_light", more[0] ?? null);
      bind(gl, "mean_through", more[1] ?? null);
    }

    // The means of corners to the samples of pixels where they do, which get depth 1.
    function drawSmooth(frame, turn, grid, { width, height, across }) {
      const { corners, means, clouded } = targets, { smooth, spread } = layer;
      gl.bindFramebuffer(gl.FRAMEBUFFER, corners.frame);
      gl.viewport(0, 0, width + 1, height + 1);
      seeLayer(frame, turn, grid, across, true);
      gl.bindFramebuffer(gl.FRAMEBUFFER, means.frame);
      gl.viewport(0, 0, width, height);
      gl.useProgram(smooth.name);
      bindMeans(corners);
      setUniforms(gl, smooth, { ...rayUniforms(frame, grid), supersampling: across,
                                tolerance: opaline.constants.CORNER_TOLERANCE,
                                "suns[0]": lit.nearSuns(2 * frame.tangent[1] / size[1]) });
      gl.drawArrays(gl.TRIANGLES, 0, 3);
      gl.bindFramebuffer(gl.FRAMEBUFFER, clouded.frame);
      viewSamples(grid);
      gl.useProgram(spread.name);
      bindMeans(means);
      setUniforms(gl, spread, { supersampling: across });
      gl.drawArrays(gl.TRIANGLES, 0, 3);
    }

    // From `samples` to `clouded`. The test of depth leaves out what is done: software renderers execute both sides
    // of a branch.
    function drawLayer(frame, turn, grid, tile) {
      gl.bindFramebuffer(gl.FRAMEBUFFER, targets.clouded.frame);
      gl.clearBufferfv(gl.DEPTH, 0, [0]);  // screen.vert.glsl draws at 0.5
      gl.enable(gl.DEPTH_TEST);
      gl.depthFunc(gl.ALWAYS);
      if (tile.across > 1) drawSmooth(frame, turn, grid, tile);
      gl.depthFunc(gl.GREATER);
      gl.depthMask(false);
      viewSamples(grid);
      seeLayer(frame, turn, grid, tile.across, false);
      gl.depthMask(true);
      gl.depthFunc(gl.LESS);
      gl.disable(gl.DEPTH_TEST);
    }

    // Pixels as seen through volumes, to the frame that is bound.
    function drawVolumes(frame, colors, grid, across) {
      const { program } = volumes, { clouded, samples } = targets, light = volumes.lit;
      gl.useProgram(program.name);
      bind(gl, "samples", (clouded ?? samples).color);
      bind(gl, "depth", samples.depth);
      bind(gl, "brick_numbers", volumes.table);
      bind(gl, "density_codes", volumes.density);
      bind(gl, "corner_numbers", volumes.corners);
      bind(gl, "node_light", volumes.light);
      bind(gl, "phase_entries", volumes.phase);
      bind(gl, "glow_words", volumes.glow);
      setUniforms(gl, program, {
        ...rayUniforms(frame, grid), ...Volumes.uniforms(asset.volumes, volumes.inverses, light.parts, frame, colors),
        supersampling: across, near_plane: frame.unit * frame.near });
      if (layer !== null) {
        bind(gl, "sheet_light", clouded.more[0]);
        bind(gl, "sheet_through", clouded.more[1]);
        setUniforms(gl, program, { units_of_metre: frame.unit,
                                   eye_above_ground: frame.unit * lit.eyeAboveGround(frame.eye) });
      }
      if (light.suns.length > 0) setUniforms(gl, program, { "suns[0]": light.suns.flat() });
      gl.drawArrays(gl.TRIANGLES, 0, 3);
    }

    function filter(across) {
      gl.useProgram(resolving.name);
      bind(gl, "samples", (targets.clouded ?? targets.samples).color);
      setUniforms(gl, resolving, { supersampling: across });
      gl.drawArrays(gl.TRIANGLES, 0, 3);
    }

    // A tile of the picture; black behind the asset, but for a cloud layer, where nothing stands behind it.
    function drawTile(frame, { turn, colors }, tile, behind = true) {
      const { x, y, width, height, across } = tile, grid = gridOf(tile, size);
      gl.bindFramebuffer(gl.FRAMEBUFFER, targets.samples.frame);
      viewSamples(grid);
      gl.clear(gl.DEPTH_BUFFER_BIT);
      if (!behind) gl.clearBufferfv(gl.COLOR, 0, [0, 0, 0, 1]);
      else if (layer === null) drawBackground(frame, turn, grid);
      drawSurfaces(frame, turn, colors, grid);
      if (layer !== null) drawLayer(frame, turn, grid, tile);
      gl.bindFramebuffer(gl.FRAMEBUFFER, targets.filtered.frame);
      gl.viewport(0, 0, width, height);
      if (volumes !== null) drawVolumes(frame, colors, grid, across);
      else filter(across);
      gl.bindFramebuffer(gl.READ_FRAMEBUFFER, targets.filtered.frame);
      gl.bindFramebuffer(gl.DRAW_FRAMEBUFFER, targets.picture.frame);
      gl.blitFramebuffer(0, 0, width, height, x, y, x + width, y + height, gl.COLOR_BUFFER_BIT, gl.NEAREST);
    }

    // That a picture of that size asks for. The next one needs resize().
    function chooseExposure(frame, seen, width, height) {
      const [columns, rows] = Exposure.sizeOf(width, height);
      resize(columns, rows, columns, rows, 1);
      drawTile(frame, seen, whole(columns, rows), layer !== null);
      const pixels = new Float32Array(4 * columns * rows);
      gl.bindFramebuffer(gl.FRAMEBUFFER, targets.filtered.frame);
      gl.readPixels(0, 0, columns, rows, gl.RGBA, gl.FLOAT, pixels);
      return Exposure.choose(pixels);
    }

    // The picture to the canvas, or to `target` of the picture's size.
    function present(exposure, target = null) {
      const [width, height] = target === null ? [canvas.width, canvas.height] : size;
      gl.bindFramebuffer(gl.FRAMEBUFFER, target);
      gl.viewport(0, 0, width, height);
      gl.useProgram(presenting.name);
      bind(gl, "picture", targets.picture.color);
      setUniforms(gl, presenting, { gain: 2 ** exposure, scale: [size[0] / width, size[1] / height],
                                    rows: target === null ? height : 0 });
      gl.drawArrays(gl.TRIANGLES, 0, 3);
    }

    // Bytes of the picture, four a pixel, the top row first.
    function readPixels(exposure) {
      const target = makeTarget(gl, ...size, gl.RGBA8, false);
      present(exposure, target.frame);
      const pixels = new Uint8ClampedArray(4 * size[0] * size[1]);
      gl.readPixels(0, 0, ...size, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
      freeTarget(gl, target);
      return pixels;
    }

    const { setLight, project, relight } = lit;
    return { setLight, project, relight, resize, drawTile, chooseExposure, present, readPixels };
  }

  return { make, whole };
})();
