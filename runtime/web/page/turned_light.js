"use strict";
// Light as it is turned to the normals of maps: the numbers of runtime/normal_maps/turned_light.h.
const TurnedLight = (() => {
  const kLeastShare = 1 / 64;
  // Irradiance over pi of degree l, times the factor of Y_k before its polynomial.
  const kFactors = [0.2820947918, ...new Array(3).fill(2 / 3 * 0.4886025119),
                    0.25 * 1.0925484306, 0.25 * 1.0925484306, 0.25 * 0.3153915653,
                    0.25 * 1.0925484306, 0.25 * 0.5462742153];

  // Uniforms of OpalineTurnedLight from what Light.project returns.
  function uniforms({ integral }, n) {
    const { suns, rest } = Volumes.splitSuns(integral, n);
    const sums = kFactors.map(() => [0, 0, 0]);
    for (let j = 0; j < rest.length / 3; ++j) {
      const harmonic = Volumes.harmonics(Light.texelDirection(n, j));
      for (let k = 0; k < sums.length; ++k) {
        for (let band = 0; band < 3; ++band) sums[k][band] += harmonic[k] * rest[3 * j + band];
      }
    }
    const coefficients = sums.map((sum, k) => Vector.times(kFactors[k], sum));
    const lights = suns.map(sun => Vector.times(1 / Math.PI, sun.light));
    const mean = lights.reduce((sum, light) => Vector.add(sum, Vector.times(0.25, light)),
                               coefficients[0]);
    const padded = vectors => [...vectors, ...new Array(Volumes.kMostSuns - vectors.length).fill([0, 0, 0])].flat();
    return { "turned_light.harmonics[0]": coefficients.flat(), "turned_light.suns": suns.length,
             "turned_light.least": mean.map(x => kLeastShare * Math.max(x, 0)),
             "turned_light.sun_direction[0]": padded(suns.map(sun => sun.direction)),
             "turned_light.sun_light[0]": padded(lights) };
  }

  return { uniforms };
})();
