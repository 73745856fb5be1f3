"use strict";
// <T_k, L> of all rows: the dot products of formats/README.md, `TRAN`.
const Rows = (() => {
  // A row of one band stands for all three. `decoded`: what each code stands for.
  function addGrey(rows, primitive, light, out) {
    const { offset, index, code, squares, averageCode, averageScale, detailScale } = rows;
    const face = 3 * rows.cubemap * rows.cubemap, first = offset[primitive.firstRow];
    const count = primitive.slots * primitive.terms, shift = primitive.firstCode - first;
    for (let r = 0; r < count; ++r) {
      const row = primitive.firstRow + r, band = primitive.firstBandRow + r;
      let red = 0, green = 0, blue = 0;
      for (let i = offset[row], end = offset[row + 1]; i < end; ++i) {
        const value = code[shift + i], weight = squares ? value * Math.abs(value) : value;
        const at = 3 * index[i];
        red += weight * light[at];
        green += weight * light[at + 1];
        blue += weight * light[at + 2];
      }
      const scale = detailScale[band];
      red *= scale; green *= scale; blue *= scale;
      for (let f = 0; f < 6; ++f) {
        const weight = averageCode[6 * band + f] * averageScale[band];
        red += weight * light[f * face];
        green += weight * light[f * face + 1];
        blue += weight * light[f * face + 2];
      }
      out[4 * row] = red;
      out[4 * row + 1] = green;
      out[4 * row + 2] = blue;
    }
  }

  function addColored(rows, primitive, light, out) {
    const { offset, index, code, squares, averageCode, averageScale, detailScale } = rows;
    const face = 3 * rows.cubemap * rows.cubemap, first = offset[primitive.firstRow];
    const count = primitive.slots * primitive.terms;
    for (let r = 0; r < count; ++r) {
      const row = primitive.firstRow + r, band = primitive.firstBandRow + 3 * r;
      let red = 0, green = 0, blue = 0;
      let at = primitive.firstCode + 3 * (offset[row] - first);
      for (let i = offset[row], end = offset[row + 1]; i < end; ++i, at += 3) {
        const from = 3 * index[i], a = code[at], b = code[at + 1], c = code[at + 2];
        red += (squares ? a * Math.abs(a) : a) * light[from];
        green += (squares ? b * Math.abs(b) : b) * light[from + 1];
        blue += (squares ? c * Math.abs(c) : c) * light[from + 2];
      }
      const sums = [red, green, blue];
      for (let k = 0; k < 3; ++k) {
        let average = 0;
        for (let f = 0; f < 6; ++f) average += averageCode[6 * (band + k) + f] * light[f * face + k];
        out[4 * row + k] = sums[k] * detailScale[band + k] + average * averageScale[band + k];
      }
    }
  }

  // Row `r` of a part times several lights, coefficients of which stand after each other: adds
  // factor[k] <T, L_k> to out[to + 4 k ...].
  function addRow(rows, part, r, lights, factors, out, to) {
    const { offset, index, code, squares, averageCode, averageScale, detailScale } = rows;
    const size = 18 * rows.cubemap * rows.cubemap, face = size / 6, bands = part.bands;
    const row = part.firstRow + r, first = part.firstCode - bands * offset[part.firstRow];
    for (let k = 0; k < factors.length; ++k) {
      const light = k * size;
      for (let b = 0; b < 3; ++b) {
        const own = Math.min(b, bands - 1), band = part.firstBandRow + bands * r + own;
        let sum = 0, average = 0;
        for (let i = offset[row], end = offset[row + 1]; i < end; ++i) {
          const value = code[first + bands * i + own];
          sum += (squares ? value * Math.abs(value) : value) * lights[light + 3 * index[i] + b];
        }
        for (let f = 0; f < 6; ++f) average += averageCode[6 * band + f] * lights[light + f * face + b];
        out[to + 4 * k + b] += factors[k] * (sum * detailScale[band] + average * averageScale[band]);
      }
    }
  }

  function addEmitters(asset, primitive, colors, out) {
    const halves = asset.emitterValues;
    for (const block of primitive.blocks) {
      const color = colors[block.emitter].map(c => c * block.scale);
      if (color.every(c => c === 0)) continue;
      let from = block.firstValue, to = 4 * primitive.firstRow;
      for (let r = primitive.slots * primitive.terms; r > 0; --r, from += 3, to += 4) {
        for (let k = 0; k < 3; ++k) out[to + k] += color[k] * Light.kFloats[halves[from + k]];
      }
    }
  }

  // Into `out`, four values a row; lights: coefficients for each primitive; colors: of each emitter, times
  // what it was authored as.
  function multiply(asset, lights, colors, out) {
    asset.primitives.forEach((primitive, p) => {
      (primitive.bands === 1 ? addGrey : addColored)(asset.rows, primitive, lights[p], out);
      addEmitters(asset, primitive, colors, out);
    });
  }

  return { multiply, addRow };
})();
