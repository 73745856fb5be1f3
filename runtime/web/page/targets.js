"use strict";
// What a picture is drawn to, tile by tile: samples with depth, those with a cloud layer before and behind them,
// pixels of a tile, the picture.
const Targets = (() => {
  const { makeTarget, addColors, freeTarget } = Gl;

  // For tiles of up to so many pixels of across x across samples, and for the whole picture at one sample a pixel.
  function make(gl, size, tile, across, hasLayer, hasVolumes) {
    const [columns, rows] = [0, 1].map(k => Math.max(size[k], across * tile[k]));
    const target = (width, height, hasDepth) => makeTarget(gl, width, height, gl.RGBA32F, hasDepth);
    // With LayerSheet of clouds/layer_sheet.h, where volumes are seen with the layer.
    const withSheet = (width, height, hasDepth) => {
      const made = target(width, height, hasDepth);
      return hasVolumes ? addColors(gl, made, 2, width, height) : made;
    };
    return { samples: target(columns, rows, true), filtered: target(...size, false), picture: target(...size, false),
             corners: hasLayer ? withSheet(tile[0] + 1, tile[1] + 1, false) : null,
             means: hasLayer ? withSheet(...tile, false) : null,
             clouded: hasLayer ? withSheet(columns, rows, true) : null };
  }

  function free(gl, { samples, filtered, picture, corners, means, clouded }) {
    [samples, filtered, picture, corners, means, clouded].forEach(target => target && freeTarget(gl, target));
  }

  return { make, free };
})();
