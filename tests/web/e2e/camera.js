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

/** What lies as deep as `point`, or the focus, stays under the finger, which moved by [x, y] pixels. */
export function assertPanned({ before, after }, [x, y], viewHeight, point = before.focus) {
  const forward = unit(subtract(before.focus, before.eye));
  const depth = dot(subtract(point, before.eye), forward);
  const right = unit(cross(forward, before.up));
  const up = cross(right, forward);
  const pixel = (2 * depth * Math.tan((before.fov * Math.PI) / 360)) / viewHeight;
  const move = add(times(right, -x * pixel), times(up, y * pixel));
  for (const end of ['eye', 'focus']) {
    nearPoint(after[end], add(before[end], move), 1e-4 * depth, end);
  }
}

/** Eye and focus are nearer to `point`, or the eye to the focus, by a factor. */
export function assertZoomed({ before, after }, factor, point = before.focus) {
  const tolerance = 1e-4 * distance(before.eye, before.focus);
  for (const end of ['eye', 'focus']) {
    nearPoint(after[end], add(point, times(subtract(before[end], point), 1 / factor)), tolerance, end);
  }
}

/** The pose alone: what a state document and a frame's header have in common. */
export function pose({ eye, focus, up, fov }) {
  return { eye, focus, up, fov };
}
