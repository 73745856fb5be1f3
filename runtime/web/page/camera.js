"use strict";
// The camera of runtime/picture/camera.cpp. Vectors are arrays of three; lengths in metres.
const Vector = {
  add: (a, b) => [a[0] + b[0], a[1] + b[1], a[2] + b[2]],
  minus: (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]],
  times: (s, a) => [s * a[0], s * a[1], s * a[2]],
  dot: (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2],
  cross: (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]],
  norm: a => Math.hypot(a[0], a[1], a[2]),
};

const Camera = (() => {
  const { add, minus, times, cross, norm } = Vector;
  const radians = degrees => degrees * Math.PI / 180;

  // From a target to the eye: azimuth from +Z toward +X, elevation above the horizon [degrees].
  function direction(azimuth, elevation) {
    const a = radians(azimuth), e = radians(elevation);
    return [Math.sin(a) * Math.cos(e), Math.sin(e), Math.cos(a) * Math.cos(e)];
  }

  // A view is { target, azimuth, elevation, distance, fov }.
  function eyeOf(view) {
    return add(view.target, times(view.distance, direction(view.azimuth, view.elevation)));
  }

  function withEye(view, eye) {
    const away = minus(eye, view.target), distance = norm(away);
    if (!(distance > 0)) return view;
    return { ...view, distance, azimuth: Math.atan2(away[0], away[2]) * 180 / Math.PI,
             elevation: Math.atan2(away[1], Math.hypot(away[0], away[2])) * 180 / Math.PI };
  }

  // Where the asset wants to be seen from, in a picture of that aspect, width by height.
  function framing(camera, aspect) {
    const view = { target: Array.from(camera.subarray(3, 6)), azimuth: 0, elevation: 0, distance: 1,
                   fov: 32 };
    const square = withEye(view, Array.from(camera.subarray(0, 3)));
    const half = Math.tan(radians(16));
    const narrow = Math.sin(Math.atan(half * Math.min(aspect, 1)));
    const [ball, radius, height] = camera.subarray(11, 14);
    if (!(ball > 0)) return { ...square, distance: square.distance * Math.sin(radians(16)) / narrow };
    let least = 0;  // at which the object's cylinder is in frame
    const c = Math.cos(radians(square.elevation)), s = Math.sin(radians(square.elevation));
    for (let i = 0; i < 64; ++i) {
      const x = radius * Math.sin(i * Math.PI / 32), toward = radius * Math.cos(i * Math.PI / 32);
      for (const h of [height, -height]) {
        const y = h * c - toward * s, z = h * s + toward * c;
        least = Math.max(least, z + Math.abs(x) / (half * aspect), z + Math.abs(y) / half);
      }
    }
    return { ...square, distance: 1.04 * Math.min(Math.max(least, ball), ball / narrow) };
  }

  function nearPlane(camera, eye) {
    if (camera[10] > 0) return camera[10];  // beneath a cloud layer
    const centre = camera.subarray(6, 9);
    const away = Math.max(...centre.map(Math.abs));
    const radius = camera[9] > 0 ? Math.max(camera[9], 1e-6 * away, 1e-30)
                                 : Math.max(1e-2 * away, 1);
    const distance = norm(minus(eye, centre));
    return Math.max(0.5 * (distance - radius), 1e-3 * radius);
  }

  // What shaders draw with.
  function frame(view, camera, aspect) {
    const eye = eyeOf(view);
    const back = direction(view.azimuth, view.elevation);
    let right = cross([0, 1, 0], back);
    if (norm(right) < 1e-6) right = cross([0, 0, -1], back);
    right = times(1 / norm(right), right);
    const y = Math.tan(radians(view.fov / 2)), x = y * aspect;
    return { eye, right, up: cross(back, right), forward: times(-1, back), tangent: [x, y],
             unit: 1 / view.distance, near: nearPlane(camera, eye) };
  }

  return { eyeOf, withEye, framing, frame };
})();
