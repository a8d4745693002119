import { cross, distance, dot, scale, subtract } from '../base/vectors.js';
import { focusDistance, rightDirection, tangentHeight, viewDirection } from '../navigation/camera.js';
import { CameraPath } from '../navigation/flight.js';

/** @import { Camera } from '../navigation/camera.js' */

/**
 * @typedef {{scale: number, x: number, y: number}} Similarity a point p of the picture, measured from the view's
 *   middle in its CSS pixels, goes to scale · p + (x, y)
 */

/** Up to here a warp is drawn as it is asked for, and never farther than the other; radians. */
const FREE = (20 * Math.PI) / 180;
const MOST = (35 * Math.PI) / 180;

/**
 * What is moved or zoomed, without a turn, at the depth of the focus; null where the camera turns.
 *
 * @param {Camera} from
 * @param {Camera} to
 * @param {{height: number}} view CSS pixels
 * @returns {?Similarity}
 */
export function similarity(from, to, view) {
  const forward = viewDirection(from);
  const turned = distance(viewDirection(to), forward) + distance(to.up, from.up) + Math.abs(to.fov - from.fov);
  if (turned > 1e-6) return null;
  const right = rightDirection(from);
  const way = subtract(to.eye, from.eye);
  const depth = focusDistance(from);
  const left = depth - dot(way, forward);
  if (left <= 0) return null;
  const pixels = view.height / (tangentHeight(from) * left);
  return { scale: depth / left, x: -dot(way, right) * pixels, y: dot(way, cross(right, forward)) * pixels };
}

/**
 * Where a warp of what `from` sees can show what `to` asks for. Beyond 20 degrees the way becomes shorter than what is
 * asked for, and ends at 35, from where on the frame as it is would be nearer (tests/stability/warps.cpp).
 *
 * @param {Camera} from
 * @param {Camera} to
 */
export function withinReach(from, to) {
  const asked = angleBetween(from, to);
  if (asked <= FREE) return to;
  const reached = FREE + (MOST - FREE) * Math.tanh((asked - FREE) / (MOST - FREE));
  const path = new CameraPath(from, [{ at: 1, camera: to }], 'linear');
  // An angle need not rise evenly along the path.
  let [low, high] = [0, 1];
  for (let step = 0; step < 30; step += 1) {
    const middle = (low + high) / 2;
    if (angleBetween(from, path.at(middle)) < reached) low = middle;
    else high = middle;
  }
  return path.at(low);
}

/** Between the directions of view or of what is up, or by which the eye has moved aside, seen from the focus; radians. */
function angleBetween(from, to) {
  const forward = viewDirection(from);
  const way = subtract(to.eye, from.eye);
  const aside = subtract(way, scale(forward, dot(way, forward)));
  return Math.max(
    angleOf(forward, viewDirection(to)),
    angleOf(from.up, to.up),
    Math.atan(Math.hypot(...aside) / focusDistance(from)),
  );
}

const angleOf = (a, b) => 2 * Math.asin(Math.min(1, distance(a, b) / 2));
