"use strict";
// Density between points of volumes and suns: the steps of runtime/volumes/sun_columns.cpp and column_sweep.cpp.
const VolumeColumns = (() => {
  // Of a code of density: sums over any table stay finite, and everything is opaque.
  const kMostScale = 1e20;
  const kNone = 0xffffffff, kVoxelStride = [1, 8, 64];

  // Boxes between points along a brick's edge.
  const boxesOf = volume => Math.min(16 / volume.spacing, 8);

  const brickAt = (volumes, volume, [x, y, z]) => {
    const [nx, ny, nz] = volume.extent;
    if (x < 0 || y < 0 || z < 0 || x >= nx || y >= ny || z >= nz) return kNone;
    return volumes.table[volume.firstCell + (z * ny + y) * nx + x];
  };

  // What does not depend on the light, found once: of each brick its cell, itself and its seven upper neighbours.
  function prepare(volumes) {
    volumes.sunPoints ??= volumes.list.map(volume => {
      const [nx, ny, nz] = volume.extent, cells = new Array(volume.bricks);
      for (let at = 0; at < nx * ny * nz; ++at) {
        const brick = volumes.table[volume.firstCell + at];
        if (brick !== kNone) cells[brick] = [at % nx, Math.floor(at / nx) % ny, Math.floor(at / nx / ny)];
      }
      const blocks = cells.map(cell => [0, 1, 2, 3, 4, 5, 6, 7].map(i =>
          brickAt(volumes, volume, cell.map((c, a) => c + (i >> a & 1)))));
      return { cells, blocks, inverse: Volumes.inverseOf(volume.toWorld) };
    });
    return volumes.sunPoints;
  }

  const floorAt = (slope, height) => {
    const all = slope * height, whole = Math.floor(all);
    return { whole, part: Math.fround(all - whole) };
  };

  // How columns lean toward a sun; `d`: voxels for a metre toward it.
  function frameOf(d) {
    let along = 0;
    for (const a of [1, 2]) if (Math.abs(d[a]) > Math.abs(d[along])) along = a;
    if (!d.every(Number.isFinite) || d[along] === 0) return null;
    const u = along === 0 ? 1 : 0, v = along === 2 ? 1 : 2;
    return { along, u, v, slopes: [d[u] / d[along], d[v] / d[along]], metres: 1 / Math.abs(d[along]), ascends: d[along] > 0 };
  }

  // 9 x 9 densities of a brick's layer of voxels, 0 to 8, times `weight`.
  function setPlane(volumes, volume, frame, block, layer, weight, plane) {
    plane.fill(0);
    const { along, u, v } = frame, above = layer === 8 ? 1 << along : 0;
    const add = (neighbour, first, countU, countV) => {
      const brick = block[neighbour | above];
      if (brick === kNone) return;
      const number = volume.firstBrickNumber + brick, scale = Math.min(weight * volumes.scale[number], kMostScale);
      const code = 512 * number + layer % 8 * kVoxelStride[along];
      for (let j = 0; j < countV; ++j) {
        for (let i = 0; i < countU; ++i) {
          plane[first + 9 * j + i] = scale * volumes.density[code + j * kVoxelStride[v] + i * kVoxelStride[u]];
        }
      }
    };
    add(0, 0, 8, 8);
    add(1 << u, 8, 1, 8);
    add(1 << v, 72, 8, 1);
    add(1 << u | 1 << v, 80, 1, 1);
  }

  // The columns of all bricks of volume v toward a sun. All columns of it stand in one table.
  function sweep(volumes, v, frame) {
    const volume = volumes.list[v], { cells, blocks } = prepare(volumes)[v], boxes = boxesOf(volume);
    const apart = 8 / boxes, side = boxes + 1, points = side ** 3, stride = [1, side, side * side];
    const column = new Float32Array(volume.bricks * points), axes = [frame.u, frame.v];
    if (cells.length === 0) return column;
    const top = 8 * volume.extent[frame.along];
    const [first, count] = [0, 1].map(a => {
      const lean = [0, floorAt(frame.slopes[a], top).whole];
      return [-Math.max(...lean) - 1, 8 * volume.extent[axes[a]] + Math.abs(lean[1]) + 10];
    }).reduce(([f, c], [from, many]) => [[...f, from], [...c, many]], [[], []]);
    const sum = new Float32Array(count[0] * count[1]), plane = new Float32Array(81), mixed = new Float32Array(72);
    const layers = new Map();
    cells.forEach((cell, brick) => {
      const at = cell[frame.along];
      if (!layers.has(at)) layers.set(at, []);
      layers.get(at).push(brick);
    });

    const placeOf = (brick, lean) => (8 * cells[brick][frame.v] - lean[1].whole - first[1]) * count[0] +
        8 * cells[brick][frame.u] - lean[0].whole - first[0];
    function addPlane(brick, layer, weight, lean) {
      setPlane(volumes, volume, frame, blocks[brick], layer, weight, plane);
      for (let j = 0; j < 9; ++j) {
        for (let i = 0; i < 8; ++i) {
          mixed[8 * j + i] = plane[9 * j + i] + lean[0].part * (plane[9 * j + i + 1] - plane[9 * j + i]);
        }
      }
      const to = placeOf(brick, lean);
      for (let j = 0; j < 8; ++j) {
        for (let i = 0; i < 8; ++i) {
          const low = mixed[8 * j + i];
          sum[to + j * count[0] + i] += low + lean[1].part * (mixed[8 * j + i + 8] - low);
        }
      }
    }
    function readPoints(brick, layer, lean) {
      const from = placeOf(brick, lean) - count[0] - 1, above = layer === boxes ? 1 << frame.along : 0;
      for (let j = 0; j <= boxes; ++j) {
        for (let i = 0; i <= boxes; ++i) {
          const owner = blocks[brick][above | (i === boxes ? 1 << frame.u : 0) | (j === boxes ? 1 << frame.v : 0)];
          if (owner !== brick && owner !== kNone) continue;
          const s = from + j * apart * count[0] + i * apart, next = s + count[0];
          const low = sum[s + 1] + lean[0].part * (sum[s] - sum[s + 1]);
          const high = sum[next + 1] + lean[0].part * (sum[next] - sum[next + 1]);
          column[brick * points + layer * stride[frame.along] + i * stride[frame.u] + j * stride[frame.v]] =
              frame.metres * (high + lean[1].part * (low - high));
        }
      }
    }

    for (const at of [...layers.keys()].sort((a, b) => frame.ascends ? b - a : a - b)) {
      for (let step = 0; step <= 8; ++step) {
        const layer = frame.ascends ? 8 - step : step, hasPoints = layer % apart === 0;
        const lean = frame.slopes.map(slope => floorAt(slope, 8 * at + layer));
        const add = weight => layers.get(at).forEach(brick => addPlane(brick, layer, weight, lean));
        if (step > 0) add(hasPoints ? 0.5 : 1);
        if (!hasPoints) continue;
        layers.get(at).forEach(brick => readPoints(brick, layer / apart, lean));
        if (step < 8) add(0.5);
      }
    }
    return column;
  }

  // Where a brick's point is known: in the next brick, if it stands on an upper face and there is one.
  function ownerOf(block, brick, place, boxes) {
    const owner = block[place.reduce((n, x, a) => n | (x === boxes ? 1 << a : 0), 0)], side = boxes + 1;
    const number = ([x, y, z]) => (z * side + y) * side + x;
    if (owner === brick || owner === kNone) return [brick, number(place)];
    return [owner, number(place.map(x => x % boxes))];
  }

  // [m] Density times way from each point of each brick of volume v out of it, toward the sun; null: no ray meets it.
  function find(volumes, v, sun) {
    const { blocks, inverse } = prepare(volumes)[v], volume = volumes.list[v], boxes = boxesOf(volume), side = boxes + 1;
    const frame = inverse && frameOf(inverse.map(row => row[0] * sun[0] + row[1] * sun[1] + row[2] * sun[2]));
    if (!frame) return null;
    const column = sweep(volumes, v, frame), points = side ** 3;
    blocks.forEach((block, brick) => {
      for (let point = 0; point < points; ++point) {
        const place = [point % side, Math.floor(point / side) % side, Math.floor(point / side / side)];
        if (!place.includes(boxes)) continue;
        const [owner, there] = ownerOf(block, brick, place, boxes);
        column[brick * points + point] = column[owner * points + there];
      }
    });
    return column;
  }

  // The same from a place of the world: where the ray comes into a brick, between its points.
  function from(volumes, v, column, sun, place) {
    const volume = volumes.list[v], { inverse } = prepare(volumes)[v], { extent } = volume, cell = [0, 0, 0];
    const origin = inverse.map((row, a) => (row[0] * place[0] + row[1] * place[1] + row[2] * place[2] + row[3]) / 8 - volume.firstBrick[a]);
    const direction = inverse.map(row => (row[0] * sun[0] + row[1] * sun[1] + row[2] * sun[2]) / 8);
    let t = 0, end = Infinity;
    for (let a = 0; a < 3; ++a) {
      if (direction[a] === 0) {
        if (origin[a] < 0 || origin[a] > extent[a]) return 0;
        continue;
      }
      const low = -origin[a] / direction[a], high = (extent[a] - origin[a]) / direction[a];
      t = Math.max(t, Math.min(low, high));
      end = Math.min(end, Math.max(low, high));
    }
    if (!(t < end)) return 0;
    for (let a = 0; a < 3; ++a) {
      cell[a] = Math.min(Math.max(Math.floor(origin[a] + t * direction[a]), 0), extent[a] - 1);
    }
    while (t < end) {
      let leaves = Infinity, axis = 0;
      for (let a = 0; a < 3; ++a) {
        if (direction[a] === 0) continue;
        const face = (cell[a] + (direction[a] > 0 ? 1 : 0) - origin[a]) / direction[a];
        if (face < leaves) [leaves, axis] = [face, a];
      }
      const to = Math.min(leaves, end), brick = t < to ? brickAt(volumes, volume, cell) : kNone;
      if (brick !== kNone) return between(volume, column, brick, cell.map((c, a) => origin[a] + t * direction[a] - c));
      t = Math.max(t, to);
      cell[axis] += direction[axis] > 0 ? 1 : -1;
      if (cell[axis] < 0 || cell[axis] >= extent[axis]) break;
    }
    return 0;
  }

  // Linear between the points of a brick; `at` in bricks.
  function between(volume, column, brick, at) {
    const boxes = boxesOf(volume), side = boxes + 1, scaled = at.map(x => boxes * Math.min(Math.max(x, 0), 1));
    const base = scaled.map(x => Math.min(Math.floor(x), boxes - 1));
    let sum = 0;
    for (let i = 0; i < 8; ++i) {
      const [x, y, z] = base.map((b, a) => b + (i >> a & 1));
      const weight = scaled.reduce((w, s, a) => w * ((i >> a & 1) ? s - base[a] : 1 - s + base[a]), 1);
      sum += weight * column[brick * side ** 3 + (z * side + y) * side + x];
    }
    return sum;
  }

  return { kNone, boxesOf, brickAt, prepare, ownerOf, find, from };
})();
