"use strict";
// How much of suns' light reaches the points of volumes: the steps of runtime/volumes/sun_light.cpp and sun_point.cpp.
const VolumeSuns = (() => {
  const { kNone, boxesOf, brickAt, prepare } = VolumeColumns;
  const kMostDepth = 1e15, tame = (x, most) => x > 0 ? Math.min(x, most) : 0;

  // Shares of suns' light at a point of a brick as rows have them: linear between nodes.
  function reachAt(volumes, volume, brick, at, reach, suns, sun) {
    const cells = 8 / volume.spacing, side = cells + 1, sum = [0, 0, 0];
    const base = at.map(x => Math.min(Math.floor(x / volume.spacing), cells - 1));
    let whole = 0;
    for (let i = 0; i < 8; ++i) {
      const bit = [i & 1, i >> 1 & 1, i >> 2], [x, y, z] = base.map((b, a) => b + bit[a]);
      const node = volumes.corners[volume.firstCorner + ((brick * side + z) * side + y) * side + x];
      if (node === kNone) continue;
      const weight = bit.reduce((w, upper, a) => {
        const u = at[a] / volume.spacing - base[a];
        return w * (upper ? u : 1 - u);
      }, 1);
      whole += weight;
      for (let b = 0; b < 3; ++b) sum[b] += weight * reach[3 * (node * suns + sun) + b];
    }
    return whole > 0 ? sum.map(x => x / whole) : [1, 1, 1];
  }

  // A point's column less those of the points next to it, where there are any; `own`: its place in `column`, `first`,
  // `below`: those of the first points of its brick and of the bricks below along each axis, or null.
  function risesAt(column, first, place, boxes, own, below) {
    const rises = [];
    for (let a = 0, stride = 1; a < 3; ++a, stride *= boxes + 1) {
      if (place[a] < boxes) rises.push(column[own] - column[own + stride]);
      if (place[a] > 0) {
        rises.push(column[own] - column[own - stride]);
      } else if (below[a] !== null) {
        rises.push(column[own] - column[below[a] + own - first + (boxes - 1) * stride]);
      }
    }
    return rises;
  }

  // So that lines between points have the mean of an exponential (find_lowering of runtime/volumes/sun_point.h).
  function loweringOf(rises, power) {
    let sum = 0;
    for (const rise of rises) {
      const x = Math.abs(power * rise), size = 1 + x + 0.5 * x * x;
      sum += (power * rise > 0 ? size : 1 / size) - 1;
    }
    return 1 / (1 + tame(sum / 12, 1e6));
  }

  const luminance = c => 0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2];

  // [volume][sun] What VolumeColumns.find says.
  const findColumns = (volumes, suns) => volumes.list.map((_, v) => suns.map(sun => VolumeColumns.find(volumes, v, sun)));

  // Sets the coefficients of suns of volume v. `reach`: three shares of each sun at each node; `columns`: of all
  // volumes; `part`, `values` as relight makes them.
  function light(volumes, v, suns, columns, reach, part, values) {
    const volume = volumes.list[v], { cells, blocks, inverse } = prepare(volumes)[v];
    if (inverse === null) return;
    const boxes = boxesOf(volume), side = boxes + 1, points = side ** 3, stride = part.suns * part.sunTerms, m = volume.toWorld;
    const firstOf = brick => part.first - part.suns - (brick + 1) * points * stride;
    const albedo = luminance(volume.albedo);

    // `isCommon`: bricks that meet there have other neighbours each, and must agree.
    function lightPoint(brick, place, point, below, isCommon) {
      const at = place.map(x => x * 8 / boxes), index = at.map((x, a) => 8 * (volume.firstBrick[a] + cells[brick][a]) + x);
      const world = [0, 4, 8].map(row => m[row] * index[0] + m[row + 1] * index[1] + m[row + 2] * index[2] + m[row + 3]);
      const own = brick * points + point, to = 4 * (firstOf(brick) + point * stride);
      for (let s = 0; s < part.suns; ++s) {
        const depth = [0, 0, 0], rows = reachAt(volumes, volume, brick, at, reach, part.suns, s);
        columns.forEach((ofSun, w) => {
          if (ofSun[s] === null) return;
          const c = w === v ? ofSun[s][own] : VolumeColumns.from(volumes, w, ofSun[s], suns[s], world);
          for (let b = 0; b < 3; ++b) depth[b] += tame(c * volumes.list[w].extinction[b], kMostDepth);
        });
        const rises = columns[v][s] === null || isCommon ? [] : risesAt(columns[v][s], brick * points, place, boxes, own, below);
        for (let b = 0; b < 3; ++b) {
          const share = Math.min(Math.exp(-depth[b]), (volume.bands === 1 ? 2 : 1) * rows[b]);
          const sent = values[4 * (part.first - part.suns + s) + b];
          for (let j = 0; j < part.sunTerms; ++j) {
            const power = part.sunPower[j] * volume.albedo[b];
            const lowered = loweringOf(rises, volume.extinction[b] * (1 + part.sunPower[j] * albedo));
            values[to + 4 * (j * part.suns + s) + b] =
                tame(lowered * sent * share * (power === 0 ? 1 : share ** power), 3.4e38);
          }
        }
      }
    }

    // Points on upper faces stand in the next brick, if there is one: copied from it.
    for (const copies of [false, true]) {
      blocks.forEach((block, brick) => {
        const below = [0, 1, 2].map(axis => {
          const next = brickAt(volumes, volume, cells[brick].map((c, a) => c - (a === axis ? 1 : 0)));
          return next === kNone ? null : next * points;
        });
        for (let point = 0; point < points; ++point) {
          const place = [point % side, Math.floor(point / side) % side, Math.floor(point / side / side)];
          const [owner, there] = VolumeColumns.ownerOf(block, brick, place, boxes);
          if ((owner !== brick) !== copies) continue;
          if (copies) {
            const from = 4 * (firstOf(owner) + there * stride);
            values.copyWithin(4 * (firstOf(brick) + point * stride), from, from + 4 * stride);
          } else {
            const isCommon = place.includes(boxes) && place.filter(x => x % boxes === 0).length > 1;
            lightPoint(brick, place, point, below, isCommon);
          }
        }
      });
    }
  }

  return { boxesOf, findColumns, light };
})();
