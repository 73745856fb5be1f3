"use strict";
// Light between the ground and the base of a cloud layer, by cell, on the GPU: the steps of
// runtime/clouds/ground_cells.cpp, radiosity.cpp and plane_gather.cpp, after the plan of page_radiosity.h.
const Radiosity = (() => {
  const kGhosts = 2;
  const kMostQuotient = 0.9999;

  // The plan of an asset's layer.
  function read(arrays) {
    const words = arrays.get("plan steps"), levels = [];
    const [columns, rows, wraps, passes] = words.subarray(0, 4);
    for (let at = 4; at < words.length;) {
      const [width, height, gaussians, ...mixes] = words.subarray(at, at + 7);
      at += 7;
      const level = { size: [width, height], gaussians: [], reduce: mixes.slice(0, 2), spread: mixes.slice(2) };
      for (let i = 0; i < gaussians; ++i, at += 6) {
        const axis = k => ({ first: words[at + 3 * k] | 0, count: words[at + 3 * k + 1], at: words[at + 3 * k + 2] });
        level.gaussians.push([axis(0), axis(1)]);
      }
      levels.push(level);
    }
    return { columns, rows, wraps, passes, levels, values: arrays.get("plan values"), step: arrays.get("plan step") };
  }

  const sum = (a, b) => a.map((x, k) => x + b[k]);
  const product = (a, b) => a.map((x, k) => x * b[k]);

  // 1 + q + q^2 + ... for the quotients of energy: what a last pass stands for.
  const series = (before, after) => before.map((x, band) => {
    return 1 / (1 - (x > 0 ? Math.min(Math.max(after[band] / x, 0), kMostQuotient) : 0));
  });

  // Interface: solve(open).
  function make(gl, layer) {
    const { plan } = layer, { columns, rows, wraps, levels } = plan, inner = [columns, rows];
    const programOf = step => Gl.makeProgram(gl, [[step, ""]], ["screen.vert.glsl"], ["plane_light.frag.glsl"]);
    const summing = programOf("LINES"), shine = programOf("SHINE"), adding = programOf("ADD");
    const cutting = Gl.makeProgram(gl, Layer.defines(layer), ["screen.vert.glsl"],
        ["cube_map.glsl", "arc_tangent.glsl", "environment.glsl", "layer_tables.glsl", "layer_march.glsl",
         "layer_see.glsl", "ground_cells.frag.glsl"]);
    gl.uniformBlockBinding(cutting.name, gl.getUniformBlockIndex(cutting.name, "Layer"), 0);
    const values = Gl.makeLines(gl, [gl.R32F, gl.RED, gl.FLOAT], plan.values);
    const cells = Gl.addColors(gl, Gl.makeTarget(gl, columns, rows, gl.RGBA32F, false), 3, columns, rows);
    const [direct, albedo, reflectance] = cells.more, emission = cells.color;
    const targets = new Map();

    // One of that name and size, made when it is first asked for.
    function targetOf(name, [width, height]) {
      const key = `${name} ${width} ${height}`;
      if (!targets.has(key)) targets.set(key, { ...Gl.makeTarget(gl, width, height, gl.RGBA32F, false), width, height });
      return targets.get(key);
    }

    function draw(program, target, textures, uniforms) {
      gl.bindFramebuffer(gl.FRAMEBUFFER, target.frame);
      gl.viewport(0, 0, target.width, target.height);
      gl.useProgram(program.name);
      for (const [unit, texture] of Object.entries(textures)) Gl.bind(gl, unit, texture);
      Gl.setUniforms(gl, program, uniforms);
      gl.drawArrays(gl.TRIANGLES, 0, 3);
      return target;
    }

    const withGhosts = size => size.map(count => count + 2 * kGhosts);

    // Sums along an axis of the cells of `from`, which has `size` of them, to cells of `to`.
    function addLines(axis, from, size, to, { mixes = -1, taps = null, before = null }) {
      return draw(summing, to, { plane: from.color, plan: values, before: before?.color ?? values }, {
        axis: axis === 0 ? [1, 0] : [0, 1], cells_along: size[axis], wraps, mixes,
        taps: taps === null ? [0, 0, 0] : [taps.first, taps.count, taps.at], adds_before: before === null ? 0 : 1 });
    }

    // mix_cells: from cells of one level to those of the next.
    function mix(from, size, toSize, [mixesX, mixesZ], name) {
      const along = addLines(1, from, size, targetOf("along", withGhosts([size[0], toSize[1]])), { mixes: mixesZ });
      return addLines(0, along, [size[0], toSize[1]], targetOf(name, withGhosts(toSize)), { mixes: mixesX });
    }

    // The light that a plane gathers from `shining`, with ghosts and without what is outside; stays until
    // the next one of that name.
    function gather(shining, name) {
      const planes = [shining];
      for (let l = 1; l < levels.length; ++l) {
        planes.push(mix(planes[l - 1], levels[l - 1].size, levels[l].size, levels[l].reduce, `plane ${l}`));
      }
      let all = null, turn = 0;
      for (let l = levels.length - 1; l >= 0; --l) {
        const { size, gaussians } = levels[l];
        for (const [x, z] of gaussians) {
          const across = addLines(0, planes[l], size, targetOf("across", withGhosts(size)), { taps: x });
          all = addLines(1, across, size, targetOf(`${name} ${turn ^= 1}`, withGhosts(size)), { taps: z, before: all });
        }
        if (l > 0) all = mix(all, size, levels[l - 1].size, levels[l].spread, `${name} ${turn ^= 1}`);
      }
      return all;
    }

    // Of each band, of the whole plane.
    function totalsOf(shining, outside) {
      const [width, height] = withGhosts(inner), read = new Float32Array(4 * width * height);
      gl.bindFramebuffer(gl.FRAMEBUFFER, shining.frame);
      gl.readPixels(0, 0, width, height, gl.RGBA, gl.FLOAT, read);
      const totals = outside.map(x => x * columns * rows);
      for (let i = 0; i < read.length; ++i) if (i % 4 < 3) totals[i % 4] += read[i];
      return totals;
    }

    // The plane that shines: `reflecting` of what it gathered, `direct` light included where wanted;
    // less what is outside, so that nothing is beyond the edges.
    function shineFrom(gathered, gatheredOutside, reflecting, shining, outside) {
      return draw(shine, targetOf("plane 0", withGhosts(inner)),
                  { plane: gathered?.color ?? values, reflecting: reflecting ?? values, shining: shining ?? values },
                  { reflects: reflecting === null ? 0 : 1, shines: shining === null ? 0 : 1,
                    gathered_outside: gatheredOutside, outside, inner_size: inner });
    }

    // `before` (null: nothing) and gathered light times `share`.
    function add(name, before, gathered, gatheredOutside, share) {
      const names = [`${name} even`, `${name} odd`].map(key => targetOf(key, inner));
      return draw(adding, names.find(target => target !== before),
                  { plane: gathered.color, before: before?.color ?? values },
                  { adds_before: before === null ? 0 : 1, gathered_outside: gatheredOutside, share });
    }

    // Textures of the light on the ground and on the base, for what the uniform block Layer holds, seen
    // from the grid's first corner; what else programs read of the layer is bound. `open`: where there is
    // no layer above the ground, the light of the sky and of suns on it, and its albedo.
    function solve(open) {
      const none = [0, 0, 0], one = [1, 1, 1], [sky, suns, ground] = wraps ? [none, none, none] : open;
      gl.disable(gl.BLEND);
      gl.disable(gl.DEPTH_TEST);
      draw(cutting, { frame: cells.frame, width: columns, height: rows }, {}, {
        sample_step: plan.step, sample_count: 16, mean_first: layer.tableFirst[3],
        has_radiosity: plan.passes > 0 ? 1 : 0 });
      const first = gather(shineFrom(null, none, null, emission, sky), "ground sum");
      let onGround = add("ground", null, first, sky, one), onBase = add("base", null, first, none, none);
      let outside = product(ground, sum(suns, sky));  // beyond the edges, of the plane that shines
      let shining = shineFrom(first, sky, albedo, direct, outside);
      for (let pass = 1; pass <= plan.passes; ++pass) {
        const isLast = pass === plan.passes, before = isLast ? totalsOf(shining, outside) : null;
        const base = gather(shining, "base sum"), baseOutside = outside;
        outside = none;  // no layer there
        const back = gather(shineFrom(base, baseOutside, reflectance, null, none), "ground sum");
        shining = shineFrom(back, none, albedo, null, none);
        const share = isLast ? series(before, totalsOf(shining, none)) : one;
        onBase = add("base", onBase, base, baseOutside, share);
        onGround = add("ground", onGround, back, none, share);
      }
      return { ground: onGround.color, base: onBase.color };
    }

    return { solve };
  }

  return { read, make };
})();
