/** Where a camera of the protocol sees what; pixels are CSS pixels from the view's middle, right and down. */

const add = (a, b) => a.map((x, i) => x + b[i]);
const subtract = (a, b) => a.map((x, i) => x - b[i]);
const times = (a, factor) => a.map((x) => x * factor);
const dot = (a, b) => a.reduce((sum, x, i) => sum + x * b[i], 0);
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const unit = (a) => times(a, 1 / Math.hypot(...a));

/** Pixels of a length at distance 1. */
export const focalLength = ({ fov }, view) => view.height / 2 / Math.tan((fov * Math.PI) / 360);

/** From the eye to the focus. */
export const distance = ({ eye, focus }) => Math.hypot(...subtract(eye, focus));

export function axes({ eye, focus, up }) {
  const forward = unit(subtract(focus, eye));
  const right = unit(cross(forward, up));
  return { forward, right, up: cross(right, forward) };
}

/** Where a point of the world is seen. */
export function project(camera, point, view) {
  const { forward, right, up } = axes(camera);
  const way = subtract(point, camera.eye);
  const scale = focalLength(camera, view) / dot(way, forward);
  return [dot(way, right) * scale, -dot(way, up) * scale];
}

/** How deep a point lies before a camera. */
export const depthOf = (camera, point) => dot(subtract(point, camera.eye), axes(camera).forward);

/** The point at a depth, or else at that of the focus, which is seen at a place. */
export function pointAt(camera, [x, y], view, depth = distance(camera)) {
  const { forward, right, up } = axes(camera);
  const scale = depth / focalLength(camera, view);
  return add(add(camera.eye, times(forward, depth)), add(times(right, x * scale), times(up, -y * scale)));
}
