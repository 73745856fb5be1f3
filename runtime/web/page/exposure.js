"use strict";
// The exposure of a picture where none is given, as runtime/picture/auto_exposure.cpp.
const Exposure = (() => {
  const kMost = 96;  // pixels along a side of the picture that is metered
  const kDim = 1 / 64, kBright = 1.5, kShown = 0.35, kMostRaised = 10, kToShown = 3;

  function sizeOf(width, height) {
    const scale = Math.min(1, kMost / Math.max(width, height));
    return [width, height].map(pixels => Math.max(1, Math.round(scale * pixels)));
  }

  // Of pixels of four floats [EV].
  function choose(pixels) {
    let stops = [];
    for (let i = 0; i < pixels.length; i += 4) {
      const luminance = 0.2126 * pixels[i] + 0.7152 * pixels[i + 1] + 0.0722 * pixels[i + 2];
      if (luminance > 0 && luminance < Infinity) stops.push(Math.log2(luminance));
    }
    if (stops.length === 0) return 0;
    stops = stops.sort((a, b) => b - a).slice(0, Math.ceil(stops.length / 2));
    const mean = stops.reduce((sum, stop) => sum + stop, 0) / stops.length;
    const over = mean - Math.log2(kBright), under = Math.log2(kDim) - mean;
    const exposure = over > 0 ? Math.log2(kShown / kBright) * Math.min(1, over / kToShown) - over
                   : under > 0 ? Math.min(under, kMostRaised) : 0;
    return Math.round(100 * exposure) / 100;
  }

  return { sizeOf, choose };
})();
