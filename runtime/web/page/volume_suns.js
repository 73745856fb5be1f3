"use strict";
// How much of suns' light reaches the points of volumes: the steps of runtime/volumes/sun_light.cpp.
const VolumeSuns = (() => {
  const kNone = 0xffffffff, kSlack = 1e-3;  // of a step, which rounding may add
  const kDarkest = 12;  // optical depth at which a march ends

  // Boxes between points along a brick's edge.
  const boxesOf = volume => Math.min(16 / volume.spacing, 8);

  const brickAt = (volumes, volume, [x, y, z]) => {
    const [nx, ny, nz] = volume.extent;
    if (x < 0 || y < 0 || z < 0 || x >= nx || y >= ny || z >= nz) return kNone;
    return volumes.table[volume.firstCell + (z * ny + y) * nx + x];
  };

  // The density of each brick at 9 x 9 x 9 voxels, those of neighbours among them.
  function padDensity(volumes, volume, cells) {
    const padded = new Float32Array(729 * volume.bricks), base = volume.firstBrickNumber;
    cells.forEach((cell, brick) => {
      for (let i = 0; cell && i < 729; ++i) {
        const at = [i % 9, Math.floor(i / 9) % 9, Math.floor(i / 81)];
        const other = brickAt(volumes, volume, cell.map((c, a) => c + (at[a] >> 3)));
        if (other === kNone) continue;
        padded[729 * brick + i] = volumes.scale[base + other] *
            volumes.density[512 * (base + other) + ((at[2] & 7) * 8 + (at[1] & 7)) * 8 + (at[0] & 7)];
      }
    });
    return padded;
  }

  // What does not depend on the light, found once.
  function prepare(volumes) {
    volumes.sunPoints ??= volumes.list.map(volume => {
      const [nx, ny, nz] = volume.extent, cells = new Array(volume.bricks);
      for (let at = 0; at < nx * ny * nz; ++at) {
        const brick = volumes.table[volume.firstCell + at];
        if (brick !== kNone) cells[brick] = [at % nx, Math.floor(at / nx) % ny, Math.floor(at / nx / ny)];
      }
      return { cells, padded: padDensity(volumes, volume, cells), inverse: Volumes.inverseOf(volume.toWorld) };
    });
    return volumes.sunPoints;
  }

  function density(padded, first, x, y, z) {
    const i = Math.min(Math.floor(x), 7), j = Math.min(Math.floor(y), 7), k = Math.min(Math.floor(z), 7);
    const u = x - i, v = y - j, w = z - k, at = first + (k * 9 + j) * 9 + i;
    const row = a => padded[a] + u * (padded[a + 1] - padded[a]);
    const low = row(at), high = row(at + 81);
    return (1 - w) * (low + v * (row(at + 9) - low)) + w * (high + v * (row(at + 90) - high));
  }

  // Density times way [m] from `from` out of the volume, or to where nothing is left; places in bricks from the table's corner.
  function column(volumes, volume, padded, from, direction) {
    const { extent } = volume, cell = [0, 0, 0];
    let t = 0, end = Infinity;
    for (let a = 0; a < 3; ++a) {
      if (direction[a] === 0) {
        if (from[a] < 0 || from[a] > extent[a]) return 0;
        continue;
      }
      const low = -from[a] / direction[a], high = (extent[a] - from[a]) / direction[a];
      t = Math.max(t, Math.min(low, high));
      end = Math.min(end, Math.max(low, high));
    }
    if (!(t < end)) return 0;
    for (let a = 0; a < 3; ++a) {
      cell[a] = Math.min(Math.max(Math.floor(from[a] + t * direction[a]), 0), extent[a] - 1);
    }
    const boxes = boxesOf(volume), steps = boxes * Vector.norm(direction), place = x => Math.min(Math.max(8 * x, 0), 8);
    const most = kDarkest / Math.min(...volume.extinction);
    let sum = 0;
    while (t < end && sum <= most) {
      let leaves = Infinity, axis = 0;
      for (let a = 0; a < 3; ++a) {
        if (direction[a] === 0) continue;
        const face = (cell[a] + (direction[a] > 0 ? 1 : 0) - from[a]) / direction[a];
        if (face < leaves) [leaves, axis] = [face, a];
      }
      const to = Math.min(leaves, end), brick = t < to ? brickAt(volumes, volume, cell) : kNone;
      if (brick !== kNone) {
        const count = Math.min(Math.max(Math.ceil((to - t) * steps - kSlack), 1), 2 * boxes), h = (to - t) / count;
        let own = 0;
        for (let i = 0; i < count; ++i) {
          const s = t + (i + 0.5) * h;
          own += density(padded, 729 * brick, place(from[0] + s * direction[0] - cell[0]),
                         place(from[1] + s * direction[1] - cell[1]), place(from[2] + s * direction[2] - cell[2]));
        }
        sum += h * own;
      }
      t = Math.max(t, to);
      cell[axis] += direction[axis] > 0 ? 1 : -1;
      if (cell[axis] < 0 || cell[axis] >= extent[axis]) break;
    }
    return sum;
  }

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

  // Sets the coefficients of suns of volume v. `reach`: three shares of each sun at each node; `part`, `values`
  // as relight makes them.
  function light(volumes, v, suns, reach, part, values) {
    const volume = volumes.list[v], prepared = prepare(volumes), { cells, inverse } = prepared[v];
    if (inverse === null) return;
    const boxes = boxesOf(volume), side = boxes + 1, stride = part.suns * part.sunTerms, m = volume.toWorld;
    const ways = prepared.map((other, w) => other.inverse && {
      volume: volumes.list[w], padded: other.padded,
      from: p => other.inverse.map((row, a) =>
          (row[0] * p[0] + row[1] * p[1] + row[2] * p[2] + row[3]) / 8 - volumes.list[w].firstBrick[a]),
      directions: suns.map(sun => other.inverse.map(row => (row[0] * sun[0] + row[1] * sun[1] + row[2] * sun[2]) / 8)),
    }).filter(way => way);
    const firstOf = brick => part.first - part.suns - (brick + 1) * side ** 3 * stride;
    const pointAt = ([x, y, z]) => (z * side + y) * side + x;

    function lightPoint(brick, cell, place) {
      const at = place.map(x => x * 8 / boxes), index = at.map((x, a) => 8 * (volume.firstBrick[a] + cell[a]) + x);
      const world = [0, 4, 8].map(row => m[row] * index[0] + m[row + 1] * index[1] + m[row + 2] * index[2] + m[row + 3]);
      const starts = ways.map(way => way.from(world)), to = 4 * (firstOf(brick) + pointAt(place) * stride);
      for (let s = 0; s < part.suns; ++s) {
        const depth = [0, 0, 0], rows = reachAt(volumes, volume, brick, at, reach, part.suns, s);
        ways.forEach((way, w) => {
          const c = column(volumes, way.volume, way.padded, starts[w], way.directions[s]);
          for (let b = 0; b < 3; ++b) depth[b] += c * way.volume.extinction[b];
        });
        for (let b = 0; b < 3; ++b) {
          const share = Math.min(Math.exp(-depth[b]), (volume.bands === 1 ? 2 : 1) * rows[b]), sent = values[4 * (part.first - part.suns + s) + b];
          for (let j = 0; j < part.sunTerms; ++j) {
            const power = part.sunPower[j] * volume.albedo[b];
            values[to + 4 * (j * part.suns + s) + b] = sent * share * (power === 0 ? 1 : share ** power);
          }
        }
      }
    }

    // Points on upper faces stand in the next brick, if there is one: copied from it.
    for (const copies of [false, true]) {
      for (let brick = 0; brick < volume.bricks; ++brick) {
        for (let point = 0; cells[brick] && point < side ** 3; ++point) {
          const place = [point % side, Math.floor(point / side) % side, Math.floor(point / side / side)];
          const owner = brickAt(volumes, volume, cells[brick].map((c, a) => c + (place[a] === boxes ? 1 : 0)));
          const isOwn = owner === brick || owner === kNone;
          if (isOwn === copies) continue;
          if (isOwn) {
            lightPoint(brick, cells[brick], place);
          } else {
            const from = 4 * (firstOf(owner) + pointAt(place.map(x => x % boxes)) * stride);
            values.copyWithin(4 * (firstOf(brick) + point * stride), from, from + 4 * stride);
          }
        }
      }
    }
  }

  return { boxesOf, light };
})();
