/** Where a camera of the protocol sees what; pixels are CSS pixels from the view's middle, right and down. */

const add = (a, b) => a.map((x, i) => x + b[i]);
const subtract = (a, b) => a.map((x, i) => x - b[i]);
const times = (a, factor) => a.map((x) => x * factor);
const dot = (a, b) => a.reduce((sum, x, i) => sum + x * b[i], 0);
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const unit = (a) => times(a, 1 / Math.hypot(...a));

/** Pixels of a length at distance 1. */
const focalLength = ({ fov }, view) => view.height / 2 / Math.tan((fov * Math.PI) / 360);

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

/** The point at the focus' depth that is seen at a place. */
export function pointAt(camera, [x, y], view) {
  const { right, up } = axes(camera);
  const scale = distance(camera) / focalLength(camera, view);
  return add(camera.focus, add(times(right, x * scale), times(up, -y * scale)));
}
