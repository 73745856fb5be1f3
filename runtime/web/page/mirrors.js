"use strict";
// What glossy surfaces mirror of a light that the page itself has found, in the world's frame: the steps of
// runtime/light_quadtree.cpp, gloss_light.cpp and prefilter.cpp.
const Mirrors = (() => {
  const kCells = 2048, kBlock = 8, kDarkShare = 0.05, kLargestSun = 0.02;  // the last one in radians
  const kSums = 10;  // of a cell: flux, first moment, that of its light, solid angle

  const luminance = (r, g, b) => 0.2126 * r + 0.7152 * g + 0.0722 * b;

  // Sums over the cells of a quadtree on each face, coarsest level first, from the flux over its n x n texels.
  function makeTree(integral, n) {
    const angles = Light.solidAnglesOf(n), count = 6 * n * n;
    let sums = new Float64Array(kSums * count);
    for (let texel = 0; texel < count; ++texel) {
      const d = Light.texelDirection(n, texel), angle = angles[texel % (n * n)], at = kSums * texel;
      const [r, g, b] = integral.subarray(3 * texel, 3 * texel + 3), light = luminance(r, g, b);
      sums.set([r, g, b, angle * d[0], angle * d[1], angle * d[2], light * d[0], light * d[1], light * d[2], angle], at);
    }
    const levels = [sums];
    for (let side = n; side > 1; side /= 2) {
      const coarse = new Float64Array(sums.length / 4);
      for (let cell = 0; 10 * cell < sums.length; ++cell) {
        const row = Math.floor(cell / side), to = kSums * ((row >> 1) * (side / 2) + (cell % side >> 1));
        for (let k = 0; k < kSums; ++k) coarse[to + k] += sums[kSums * cell + k];
      }
      levels.unshift(sums = coarse);
    }
    return levels;
  }

  function unit(sums, at, otherwise) {
    const v = [sums[at], sums[at + 1], sums[at + 2]], norm = Vector.norm(v);
    return norm > 0 && Number.isFinite(norm) ? Vector.times(1 / norm, v) : otherwise;
  }

  // 1 - |moment / weight|^2; 0 where there is no weight.
  function spreadOf(sums, at, weight) {
    if (!(weight > 0)) return 0;
    const mean = Vector.norm([sums[at], sums[at + 1], sums[at + 2]]) / weight;
    return Math.min(Math.max(1 - mean * mean, 0), 1);
  }

  // At most kCells cells for wide lobes, small where there is much light: eight values each, as the shader of
  // gloss reads them.
  function makeCells(tree) {
    const brightness = (sums, at) => sums[at] + sums[at + 1] + sums[at + 2];
    let total = 0;
    for (let face = 0; face < 6; ++face) total += brightness(tree[0], kSums * face);
    const floor = (total > 0 ? kDarkShare * total : 1) / (4 * Math.PI), open = [];
    const push = (level, number) => {
      const sums = tree[level], at = kSums * number, angle = sums[at + 9];
      const error = (brightness(sums, at) + floor * angle) * spreadOf(sums, at + 3, angle);
      open.push({ level, number, error: level + 1 === tree.length ? -1 : error });
    };
    for (let face = 0; face < 6; ++face) push(0, face);
    while (open.length + 3 <= kCells) {
      let most = 0;
      for (let i = 1; i < open.length; ++i) if (open[i].error > open[most].error) most = i;
      const { level, number, error } = open[most];
      if (error < 0) break;
      open[most] = open[open.length - 1];
      open.pop();
      const n = 2 ** level, row = Math.floor(number / n), column = number % n;
      for (let i = 0; i < 4; ++i) push(level + 1, (2 * row + (i >> 1)) * 2 * n + 2 * column + (i & 1));
    }
    const cells = new Float32Array(8 * kBlock * Math.ceil(open.length / kBlock));
    open.forEach(({ level, number }, i) => {
      const sums = tree[level], at = kSums * number, angle = sums[at + 9], hasLight = brightness(sums, at) > 0;
      const [r, g, b] = sums.subarray(at, at + 3), centre = unit(sums, at + 3, [0, 0, 1]);
      const spread = hasLight ? spreadOf(sums, at + 6, luminance(r, g, b)) : spreadOf(sums, at + 3, angle);
      cells.set([...(hasLight ? unit(sums, at + 6, centre) : centre), angle, r, g, b, 0.125 * spread], 8 * i);
    });
    for (let i = open.length; 8 * i < cells.length; ++i) cells[8 * i + 2] = 1;  // of no light
    return cells;
  }

  const alphaOf = level => (level / opaline.constants.roughnessSteps) ** 2;

  // Of the sharpest lobe.
  function texelsFor(levels) {
    const sharpest = alphaOf(Math.min(...levels));
    return sharpest < 0.03 ? 128 : sharpest < 0.12 ? 64 : 32;
  }

  // The tree's cells as the shader reads them: twelve values each.
  function packTree(tree) {
    const values = new Float32Array(tree.reduce((sum, level) => sum + 12 * level.length / kSums, 0));
    let to = 0;
    for (const sums of tree) {
      for (let at = 0; at < sums.length; at += kSums, to += 12) {
        const centre = unit(sums, at + 3, [0, 0, 1]);
        values.set([...centre, sums[at + 9], ...unit(sums, at + 6, centre), 0, ...sums.subarray(at, at + 3), 0], to);
      }
    }
    return values;
  }

  // Sums over coarser texels of a flux over n x n texels a face.
  function coarsen(flux, n, coarse) {
    const share = n / coarse, sums = new Float64Array(18 * coarse * coarse);
    for (let i = 0; i < flux.length; ++i) {
      const texel = Math.floor(i / 3), row = Math.floor(texel / n), column = texel % n;
      sums[3 * (Math.floor(row / share) * coarse + Math.floor(column / share)) + i % 3] += flux[i];
    }
    return sums;
  }

  function withSuns(flux, n, suns) {
    const sum = Float64Array.from(flux);
    Light.addSuns(suns, n, 1, 0, sum);
    return sum;
  }

  // Of suns, eight values each, those that are wanted.
  function sunsThat(suns, isWanted) {
    const list = [];
    for (let at = 0; at < suns.length; at += 8) {
      if (isWanted(suns[at + 3])) list.push(...suns.subarray(at, at + 8));
    }
    return new Float32Array(list);
  }

  // Interface: of(...).
  function make(gl) {
    const program = Gl.makeProgram(gl, [], ["screen.vert.glsl"], ["cube_map.glsl", "mirrored.frag.glsl"]);

    function convolveTo(level, n) {
      const alpha = Math.max(alphaOf(level), 1 / n);  // no lobe narrower than a texel
      let side = 16;                                  // two texels across half the lobe's width
      while (side < n && side < 2 / alpha) side *= 2;
      const texture = Gl.makeTexture(gl, gl.TEXTURE_2D_ARRAY, 1, gl.RGBA32F, side, side, 6);
      const frame = gl.createFramebuffer();
      gl.bindFramebuffer(gl.FRAMEBUFFER, frame);
      gl.viewport(0, 0, side, side);
      for (let face = 0; face < 6; ++face) {
        gl.framebufferTextureLayer(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, texture, 0, face);
        Gl.setUniforms(gl, program, { face, side, levels: 1 + Math.log2(n), alpha_squared: alpha * alpha });
        gl.drawArrays(gl.TRIANGLES, 0, 3);
      }
      gl.deleteFramebuffer(frame);
      return texture;
    }

    // Textures by level of roughness, of the flux over faces of texelsFor(levels) texels a side.
    function convolve(integral, levels) {
      const n = texelsFor(levels);
      const cells = Gl.makeLines(gl, [gl.RGBA32F, gl.RGBA, gl.FLOAT], packTree(makeTree(integral, n)), 4);
      gl.disable(gl.BLEND);
      gl.disable(gl.DEPTH_TEST);
      gl.useProgram(program.name);
      Gl.bind(gl, "tree_cells", cells);
      const textures = new Map(levels.map(level => [level, convolveTo(level, n)]));
      gl.deleteTexture(cells);
      return textures;
    }

    // What surfaces mirror of a light, a cube map of mean radiance and suns: `blurred` for each of the levels of
    // roughness; what gloss sums, where there is any.
    function of({ cube, suns }, levels, hasGloss) {
      const side = Light.kSide, angles = Light.solidAnglesOf(side), none = new Float32Array(0);
      const angleOf = i => angles[Math.floor(i / 3) % (side * side)];
      const flux = Float64Array.from(cube, (radiance, i) => radiance * angleOf(i)), n = texelsFor(levels);
      const blurred = levels.length === 0 ? new Map() : convolve(withSuns(coarsen(flux, side, n), n, suns), levels);
      if (!hasGloss) return { blurred, cube: null, cells: none, suns: none };
      const all = withSuns(flux, side, sunsThat(suns, radius => radius > kLargestSun));
      return { blurred, cube: Float32Array.from(all, (value, i) => value / angleOf(i)),
               cells: makeCells(makeTree(all, side)), suns: sunsThat(suns, radius => radius <= kLargestSun) };
    }

    return { of };
  }

  return { make };
})();
