// The little geometry that the tests compute their own expectations with. Vectors are arrays of 3, angles degrees.
import assert from 'node:assert/strict';

export const add = (a, b) => a.map((x, i) => x + b[i]);
export const sub = (a, b) => a.map((x, i) => x - b[i]);
export const scale = (a, s) => a.map((x) => x * s);
export const dot = (a, b) => a.reduce((sum, x, i) => sum + x * b[i], 0);
export const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
export const length = (a) => Math.hypot(...a);
export const unit = (a) => scale(a, 1 / length(a));
export const radians = (degrees) => (degrees * Math.PI) / 180;

/** `v` turned about the unit vector `axis` by the right-hand rule (Rodrigues). */
export function turned(v, axis, degrees) {
  const c = Math.cos(radians(degrees));
  const s = Math.sin(radians(degrees));
  return add(add(scale(v, c), scale(cross(axis, v), s)), scale(axis, dot(axis, v) * (1 - c)));
}

/** `point` turned about the line through `center` along `axis`. */
export const turnedAbout = (point, center, axis, degrees) => add(turned(sub(point, center), axis, degrees), center);

/** The camera's axes in the world. */
export function axes({ eye, focus, up }) {
  const view = unit(sub(focus, eye));
  const right = unit(cross(view, up));
  return { view, right, up: cross(right, view) };
}

/** Where a world point is in the view, in CSS pixels from the top left. */
export function projected(camera, { width, height }, point) {
  const { view, right, up } = axes(camera);
  const d = sub(point, camera.eye);
  const pixels = height / 2 / Math.tan(radians(camera.fov) / 2) / dot(d, view);
  return [width / 2 + dot(d, right) * pixels, height / 2 - dot(d, up) * pixels];
}

/** World length of one CSS pixel at the depth of `focus`. */
export const pixelAtFocus = ({ eye, focus, fov }, { height }) =>
  (2 * length(sub(focus, eye)) * Math.tan(radians(fov) / 2)) / height;

/** 4x4, row by row, times column vector. */
export const transformed = (m, v) => [0, 1, 2, 3].map((row) => [0, 1, 2, 3].reduce((sum, i) => sum + m[4 * row + i] * v[i], 0));
export const product = (a, b) =>
  Array.from({ length: 16 }, (_, i) => [0, 1, 2, 3].reduce((sum, k) => sum + a[4 * (i >> 2) + k] * b[4 * k + (i & 3)], 0));

/** Numbers, or arrays of them, equal to 1e-9 of `size` (of themselves, but at least 1). */
export function near(actual, expected, what, tolerance = 1e-9) {
  const a = [actual].flat();
  const e = [expected].flat();
  const size = Math.max(1, ...e.map(Math.abs));
  const same = a.length === e.length && a.every((x, i) => typeof x === 'number' && Math.abs(x - e[i]) <= tolerance * size);
  assert.ok(same, `${what}: ${JSON.stringify(actual)} is not ${JSON.stringify(expected)}`);
}

/** The pose is where it is expected; only members that `expected` names are looked at. */
export function nearCamera(camera, expected, what) {
  for (const [member, value] of Object.entries(expected)) near(camera[member], value, `${what}: ${member}`);
}
