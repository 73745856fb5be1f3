"use strict";
// Light as it is turned to the normals of maps: the numbers of runtime/normal_maps/turned_light.h.
const TurnedLight = (() => {
  const kLeastShare = 1 / 64;
  // Irradiance over pi of degree l, times the factor of Y_k before its polynomial.
  const kFactors = [0.2820947918, ...new Array(3).fill(2 / 3 * 0.4886025119),
                    0.25 * 1.0925484306, 0.25 * 1.0925484306, 0.25 * 0.3153915653,
                    0.25 * 1.0925484306, 0.25 * 0.5462742153];

  // Of what Light.project returns: { harmonics, suns, least }.
  function make({ integral }, n) {
    const { suns, rest } = Volumes.splitSuns(integral, n);
    const sums = kFactors.map(() => [0, 0, 0]);
    for (let j = 0; j < rest.length / 3; ++j) {
      const harmonic = Volumes.harmonics(Light.texelDirection(n, j));
      for (let k = 0; k < sums.length; ++k) {
        for (let band = 0; band < 3; ++band) sums[k][band] += harmonic[k] * rest[3 * j + band];
      }
    }
    const harmonics = sums.map((sum, k) => Vector.times(kFactors[k], sum));
    const lights = suns.map(sun => ({ direction: sun.direction, light: Vector.times(1 / Math.PI, sun.light) }));
    const mean = lights.reduce((sum, { light }) => Vector.add(sum, Vector.times(0.25, light)), harmonics[0]);
    return { harmonics, suns: lights, least: mean.map(x => kLeastShare * Math.max(x, 0)) };
  }

  const product = (a, b) => a.map((x, band) => x * b[band]);
  const total = color => color[0] + color[1] + color[2];

  // turned_light_of_sheet; `shares`: red, green and blue reflected, then transmitted.
  function ofSheet(turned, shares) {
    const kSame = 0.9999;
    const reflect = shares.slice(0, 3), transmit = shares.slice(3);
    const both = Vector.add(reflect, transmit), odd = Vector.add(reflect, Vector.times(-1, transmit));
    const joined = [];
    for (const { direction, light } of turned.suns) {
      const found = joined.find(other => Vector.dot(other.direction, direction) > kSame);
      if (found === undefined) joined.push({ direction, light });
      else found.light = Vector.add(found.light, light);
    }
    joined.sort((a, b) => total(b.light) - total(a.light));
    let harmonics = turned.harmonics;
    for (const { direction, light } of joined.splice(Volumes.kMostSuns / 2)) {
      const value = Volumes.harmonics(direction);
      harmonics = harmonics.map((sum, k) => Vector.add(sum, Vector.times(Math.PI * kFactors[k] * value[k], light)));
    }
    return { harmonics: harmonics.map((sum, k) => product(k >= 1 && k <= 3 ? odd : both, sum)),
             suns: [...joined.map(sun => ({ direction: sun.direction, light: product(reflect, sun.light) })),
                    ...joined.map(sun => ({ direction: Vector.times(-1, sun.direction),
                                            light: product(transmit, sun.light) }))],
             least: product(both, turned.least) };
  }

  // Of OpalineTurnedLight.
  function uniforms({ harmonics, suns, least }) {
    const padded = vectors => [...vectors, ...new Array(Volumes.kMostSuns - vectors.length).fill([0, 0, 0])].flat();
    return { "turned_light.harmonics[0]": harmonics.flat(), "turned_light.suns": suns.length,
             "turned_light.least": least,
             "turned_light.sun_direction[0]": padded(suns.map(sun => sun.direction)),
             "turned_light.sun_light[0]": padded(suns.map(sun => sun.light)) };
  }

  return { make, ofSheet, uniforms };
})();
