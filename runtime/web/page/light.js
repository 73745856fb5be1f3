"use strict";
// Distant light: from a cube map and suns to the coefficients that rows are multiplied with. The
// conventions are those of the .opal file (formats/README.md): faces, Haar basis, pairing.
const Light = (() => {
  const kSide = 128;      // texels of the map's faces
  const kSamples = 256;   // across a face, at least two a texel
  const kPadded = kSide + 2;

  function cubePosition(face, u, v) {
    switch (face) {
      case 0: return [1, -v, -u];
      case 1: return [-1, -v, u];
      case 2: return [u, 1, v];
      case 3: return [u, -1, -v];
      case 4: return [u, -v, 1];
      default: return [-u, -v, -1];
    }
  }

  // [face, u, v]
  function cubePoint(x, y, z) {
    const a = Math.abs(x), b = Math.abs(y), c = Math.abs(z);
    if (a >= b && a >= c) return [x > 0 ? 0 : 1, (x > 0 ? -z : z) / a, -y / a];
    if (b >= c) return [y > 0 ? 2 : 3, x / b, (y > 0 ? z : -z) / b];
    return [z > 0 ? 4 : 5, (z > 0 ? x : -x) / c, -y / c];
  }

  function texelOf(n, x, y, z) {
    const [face, u, v] = cubePoint(x, y, z);
    const at = t => Math.min(n - 1, Math.max(0, Math.floor((t * 0.5 + 0.5) * n)));
    return (face * n + at(v)) * n + at(u);
  }

  function floatOfHalf(half) {
    const sign = half & 0x8000 ? -1 : 1, exponent = half >> 10 & 31, fraction = half & 1023;
    return sign * (exponent === 0 ? fraction * 2 ** -24 : (1024 + fraction) * 2 ** (exponent - 25));
  }
  const kFloats = Float32Array.from({ length: 65536 }, (_, half) => floatOfHalf(half));

  function decode(halves, scale) {
    const values = new Float32Array(halves.length);
    for (let i = 0; i < values.length; ++i) values[i] = scale * kFloats[halves[i]];
    return values;
  }

  // Each face with a border of the texels that lie beyond its edges.
  function padCube(cube) {
    const padded = new Float32Array(6 * kPadded * kPadded * 3);
    for (let face = 0, to = 0; face < 6; ++face) {
      for (let row = -1; row <= kSide; ++row) {
        for (let column = -1; column <= kSide; ++column, to += 3) {
          const inside = Math.min(row, column) >= 0 && Math.max(row, column) < kSide;
          const texel = inside ? (face * kSide + row) * kSide + column
              : texelOf(kSide, ...cubePosition(face, 2 * (column + 0.5) / kSide - 1,
                                               2 * (row + 0.5) / kSide - 1));
          padded.set(cube.subarray(3 * texel, 3 * texel + 3), to);
        }
      }
    }
    return padded;
  }

  // Solid angles of the cells of one face, side x side; all faces are alike.
  const solidAngles = new Map();
  function solidAnglesOf(side) {
    if (!solidAngles.has(side)) {
      const corner = (i, j) => {
        const u = 2 * i / side - 1, v = 2 * j / side - 1;
        return Math.atan2(u * v, Math.sqrt(u * u + v * v + 1));
      };
      const angles = new Float64Array(side * side);
      for (let j = 0; j < side; ++j) {
        for (let i = 0; i < side; ++i) {
          angles[j * side + i] = corner(i + 1, j + 1) - corner(i, j + 1) - corner(i + 1, j) +
                                 corner(i, j);
        }
      }
      solidAngles.set(side, angles);
    }
    return solidAngles.get(side);
  }

  // Half as many texels a side: mean radiance, by solid angle.
  function halveCube(cube, side) {
    const half = side / 2, angles = solidAnglesOf(side);
    const coarse = new Float32Array(6 * half * half * 3), sums = new Float64Array(6 * half * half * 4);
    for (let texel = 0; texel < 6 * side * side; ++texel) {
      const row = Math.floor(texel / side), column = texel % side;
      const to = 4 * ((row >> 1) * half + (column >> 1)), angle = angles[texel % (side * side)];
      for (let b = 0; b < 3; ++b) sums[to + b] += angle * cube[3 * texel + b];
      sums[to + 3] += angle;
    }
    for (let i = 0; i < coarse.length; ++i) {
      coarse[i] = sums[4 * Math.floor(i / 3) + i % 3] / sums[4 * Math.floor(i / 3) + 3];
    }
    return coarse;
  }

  // Adds the flux of the map, turned by the angle whose cosine and sine are given, to each of the
  // 6 n n texels.
  function addMap(padded, n, c, s, integral) {
    const side = Math.max(2 * n, kSamples), per = side / n, angles = solidAnglesOf(side);
    const half = 0.5 * kSide;
    for (let face = 0; face < 6; ++face) {
      const [x0, y0, z0] = cubePosition(face, 0, 0);
      const [xu, yu, zu] = Vector.minus(cubePosition(face, 1, 0), [x0, y0, z0]);
      const [xv, yv, zv] = Vector.minus(cubePosition(face, 0, 1), [x0, y0, z0]);
      for (let row = 0, i = 0; row < side; ++row) {
        const v = 2 * (row + 0.5) / side - 1;
        const texels = (face * n + Math.floor(row / per)) * n;
        for (let column = 0; column < side; ++column, ++i) {
          const u = 2 * (column + 0.5) / side - 1;
          const wx = x0 + u * xu + v * xv, y = y0 + u * yu + v * yv, wz = z0 + u * zu + v * zv;
          const x = c * wx - s * wz, z = s * wx + c * wz;  // in the light's frame
          const ax = Math.abs(x), ay = Math.abs(y), az = Math.abs(z);
          let from, p, q;
          if (ax >= ay && ax >= az) {
            from = x > 0 ? 0 : 1; p = (x > 0 ? -z : z) / ax; q = -y / ax;
          } else if (ay >= az) {
            from = y > 0 ? 2 : 3; p = x / ay; q = (y > 0 ? z : -z) / ay;
          } else {
            from = z > 0 ? 4 : 5; p = (z > 0 ? x : -x) / az; q = -y / az;
          }
          const px = (p + 1) * half + 0.5, py = (q + 1) * half + 0.5;  // of the padded face
          const left = px | 0, up = py | 0, t = px - left, r = py - up;
          const at = 3 * ((from * kPadded + up) * kPadded + left), below = at + 3 * kPadded;
          const angle = angles[i];
          const w0 = angle * (1 - t) * (1 - r), w1 = angle * t * (1 - r);
          const w2 = angle * (1 - t) * r, w3 = angle * t * r;
          const to = 3 * (texels + (column / per | 0));
          integral[to] += w0 * padded[at] + w1 * padded[at + 3] + w2 * padded[below] +
                          w3 * padded[below + 3];
          integral[to + 1] += w0 * padded[at + 1] + w1 * padded[at + 4] + w2 * padded[below + 1] +
                              w3 * padded[below + 4];
          integral[to + 2] += w0 * padded[at + 2] + w1 * padded[at + 5] + w2 * padded[below + 2] +
                              w3 * padded[below + 5];
        }
      }
    }
  }

  // Adds the flux of points (divide_light.h) to the texels that they lie in.
  function addPoints(points, n, c, s, integral) {
    for (let at = 0; at < points.length; at += 6) {
      const x = points[at], z = points[at + 2];
      const to = 3 * texelOf(n, c * x + s * z, points[at + 1], -s * x + c * z);
      for (let band = 0; band < 3; ++band) integral[to + band] += points[at + 3 + band];
    }
  }

  // Mean radiance of the cube map's texels, points among them: what mirrors see.
  function wholeCube(light) {
    const angles = solidAnglesOf(kSide), flux = new Float64Array(light.cube.length);
    addPoints(light.points, kSide, 1, 0, flux);
    return light.cube.map((radiance, i) => radiance + flux[i] / angles[Math.floor(i / 3) % (kSide * kSide)]);
  }

  // The four texels whose centres are around a direction, with bilinear shares.
  function shareAmongTexels(n, x, y, z, weight, cover) {
    const [face, u, v] = cubePoint(x, y, z), half = 0.5 * n;
    const px = (u + 1) * half - 0.5, py = (v + 1) * half - 0.5;
    const left = Math.floor(px), up = Math.floor(py);
    for (let k = 0; k < 4; ++k) {
      const column = left + (k & 1), row = up + (k >> 1);
      const texel = texelOf(n, ...cubePosition(face, (column + 0.5) / half - 1, (row + 0.5) / half - 1));
      cover[texel] += weight * (1 - Math.abs(px - column)) * (1 - Math.abs(py - row));
    }
  }

  // Points of a sunflower over the disc of each sun; its flux is exact.
  function addSuns(suns, n, c, s, integral) {
    const kPoints = 1024, golden = Math.PI * (3 - Math.sqrt(5));
    for (let at = 0; at < suns.length; at += 8) {
      const [lx, y, lz, radius] = suns.subarray(at, at + 4);
      const axis = [c * lx + s * lz, y, -s * lx + c * lz];  // in the world
      const helper = Math.abs(axis[1]) < 0.9 ? [0, 1, 0] : [1, 0, 0];
      let across = Vector.cross(helper, axis);
      across = Vector.times(1 / Vector.norm(across), across);
      const along = Vector.cross(axis, across);
      const cover = new Float64Array(6 * n * n), most = Math.sin(0.5 * radius);
      for (let i = 0; i < kPoints; ++i) {
        const h = most * Math.sqrt((i + 0.5) / kPoints), sine = 2 * h * Math.sqrt(1 - h * h);
        const a = sine * Math.cos(golden * i), b = sine * Math.sin(golden * i), d = 1 - 2 * h * h;
        shareAmongTexels(n, a * across[0] + b * along[0] + d * axis[0],
                         a * across[1] + b * along[1] + d * axis[1],
                         a * across[2] + b * along[2] + d * axis[2], 1 / kPoints, cover);
      }
      for (let j = 0; j < cover.length; ++j) {
        for (let band = 0; band < 3; ++band) {
          integral[3 * j + band] += cover[j] * suns[at + 7] * suns[at + 4 + band];
        }
      }
    }
  }

  // The orthonormal Haar transform of each face, in place; three bands interleaved.
  function transform(values, n) {
    const scratch = new Float64Array(n * n * 3);
    for (let face = 0; face < 6; ++face) {
      const base = face * n * n * 3;
      for (let size = n; size > 1; size /= 2) {
        const half = size / 2;
        for (let row = 0; row < half; ++row) {
          for (let column = 0; column < half; ++column) {
            const top = base + 3 * (2 * row * n + 2 * column), bottom = top + 3 * n;
            const to = 3 * (row * size + column), low = to + 3 * half * size;
            for (let band = 0; band < 3; ++band) {
              const a = values[top + band], b = values[top + 3 + band];
              const c = values[bottom + band], d = values[bottom + 3 + band];
              scratch[to + band] = (a + b + c + d) / 2;
              scratch[to + 3 * half + band] = (a - b + c - d) / 2;
              scratch[low + band] = (a + b - c - d) / 2;
              scratch[low + 3 * half + band] = (a - b - c + d) / 2;
            }
          }
        }
        for (let row = 0; row < size; ++row) {
          values.set(scratch.subarray(3 * row * size, 3 * (row + 1) * size), base + 3 * row * n);
        }
      }
    }
    return values;
  }

  // What a light's script has handed over.
  function read(arrays) {
    const radiance = name => decode(arrays.get(name), arrays.get(`${name}.scale`)[0]);
    const cube = radiance("cube");
    const [layout, width, height, includesPoles] = arrays.get("background.shape");
    return {
      cube, padded: cube.length > 0 ? padCube(cube) : null, points: arrays.get("points"), suns: arrays.get("suns"), discs: arrays.get("discs"),
      cells: arrays.get("cells"),
      background: { layout, width, height, includesPoles, turn: arrays.get("background.turn"),
                    pixels: radiance("background") },
      layer: Layer.readLight(arrays),
      // Of a level of roughness; nothing where the asset has none of it.
      mirrored: level => arrays.has(`mirrored.${level}`) ? radiance(`mirrored.${level}`) : null,
    };
  }

  // The light turned by `turn` [radians] from +Z toward +X: its flux over each texel, three bands
  // each, and coefficients.
  function project(light, n, turn) {
    const c = Math.cos(turn), s = Math.sin(turn), integral = new Float64Array(6 * n * n * 3);
    addMap(light.padded, n, c, s, integral);
    addPoints(light.points, n, c, s, integral);
    addSuns(light.suns, n, c, s, integral);
    return { integral, coefficients: coefficientsOf(integral, n) };
  }

  function coefficientsOf(integral, n) {
    return Float32Array.from(transform(integral.slice(), n));
  }

  // Unit direction of a texel's centre.
  function texelDirection(n, texel) {
    const row = Math.floor(texel / n) % n, column = texel % n;
    const d = cubePosition(Math.floor(texel / (n * n)), 2 * (column + 0.5) / n - 1,
                           2 * (row + 0.5) / n - 1);
    return Vector.times(1 / Vector.norm(d), d);
  }

  return { read, padCube, addSuns, solidAnglesOf, project, coefficientsOf, texelDirection, wholeCube, halveCube, kFloats, kSide };
})();
