import assert from 'node:assert/strict';

/** What gestures do to a camera, in the words of the protocol. */

const add = (a, b) => a.map((x, i) => x + b[i]);
const subtract = (a, b) => a.map((x, i) => x - b[i]);
const times = (a, factor) => a.map((x) => x * factor);
const dot = (a, b) => a.reduce((sum, x, i) => sum + x * b[i], 0);
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const length = (a) => Math.hypot(...a);
const unit = (a) => times(a, 1 / length(a));
const distance = (a, b) => length(subtract(a, b));
const degrees = (radians) => (radians * 180) / Math.PI;

function near(actual, expected, tolerance, what) {
  assert.ok(Math.abs(actual - expected) <= tolerance, `${what}: ${actual} instead of ${expected}`);
}

function nearPoint(actual, expected, tolerance, what) {
  assert.ok(distance(actual, expected) <= tolerance, `${what}: ${actual} instead of ${expected}`);
}

/** The scene's own upward direction: the axis that is nearest to the camera's. */
function vertical({ up }) {
  const largest = Math.max(...up.map(Math.abs));
  return up.map((x) => (Math.abs(x) === largest ? Math.sign(x) : 0));
}

/** Where the viewer stands: degrees around the scene's vertical and above the horizon. */
function standpoint({ eye, focus }, axis) {
  const back = unit(subtract(eye, focus));
  const height = dot(back, axis);
  return { elevation: degrees(Math.asin(height)), ground: subtract(back, times(axis, height)) };
}

/**
 * A drag to the right turns the scene to the right, so the viewer walks to the left; a drag down tips the scene's
 * top towards the viewer, who climbs.
 */
export function assertTurned({ before, after }, { right, down }) {
  const axis = vertical(before);
  const old = standpoint(before, axis);
  const young = standpoint(after, axis);
  const walked = degrees(Math.atan2(dot(axis, cross(old.ground, young.ground)), dot(old.ground, young.ground)));
  near(walked, -right, 0.01, 'degrees around the vertical');
  near(young.elevation - old.elevation, down, 0.01, 'degrees of climb');
  for (const point of ['eye', 'focus']) {
    const kept = distance(before[point], before.center);
    near(distance(after[point], after.center), kept, 1e-9 * distance(before.eye, before.focus), `distance of ${point} from the centre`);
  }
}

/** The point at the focus stays under the finger, which moved by [x, y] pixels of a view of this height. */
export function assertPanned({ before, after }, [x, y], viewHeight) {
  const depth = distance(before.eye, before.focus);
  const forward = unit(subtract(before.focus, before.eye));
  const right = unit(cross(forward, before.up));
  const up = cross(right, forward);
  const pixel = (2 * depth * Math.tan((before.fov * Math.PI) / 360)) / viewHeight;
  const move = add(times(right, -x * pixel), times(up, y * pixel));
  for (const point of ['eye', 'focus']) {
    nearPoint(after[point], add(before[point], move), 1e-4 * depth, point);
  }
}

/** The distance to the focus is divided by a factor, along the view. */
export function assertZoomed({ before, after }, factor) {
  const depth = distance(before.eye, before.focus);
  nearPoint(after.focus, before.focus, 1e-4 * depth, 'focus');
  const eye = add(before.focus, times(subtract(before.eye, before.focus), 1 / factor));
  nearPoint(after.eye, eye, 1e-4 * depth, 'eye');
}

/** The pose alone: what a state document and a frame's header have in common. */
export function pose({ eye, focus, up, fov }) {
  return { eye, focus, up, fov };
}
