import { add, dot, scale, subtract } from '../base/vectors.js';
import { directionThrough, placeOf, viewDirection } from '../navigation/camera.js';
import { reciprocalDistanceAt } from './depth-map.js';

/**
 * @import { Camera } from '../navigation/camera.js'
 * @import { DepthMap } from './depth-map.js'
 */

const STEPS = 8;

/**
 * The point of a frame's surface that another camera sees; null where nothing is, or where its eye has passed it.
 *
 * @param {DepthMap} map
 * @param {Camera} from of the frame
 * @param {Camera} camera
 * @param {number} aspect of both, width / height
 * @param {{x: number, y: number}} place of the other image, each from -1 (left, top) to 1
 */
export function surfaceSeen(map, from, camera, aspect, { x, y }) {
  const view = viewDirection(camera);
  const ray = directionThrough(camera, aspect, x, y);
  const pointAt = (depth) => add(camera.eye, scale(ray, depth / dot(ray, view)));
  // As deep as what the frame shows there, to begin with.
  let reciprocal = reciprocalDistanceAt(map, (1 + x) / 2, (1 + y) / 2);
  let point = pointAt(1 / reciprocal);
  for (let step = 0; step < STEPS && reciprocal > 0; step += 1) {
    const seen = placeOf(from, aspect, point);
    reciprocal = reciprocalDistanceAt(map, (1 + seen.x) / 2, (1 + seen.y) / 2);
    const there = directionThrough(from, aspect, seen.x, seen.y);
    const surface = add(from.eye, scale(there, 1 / (reciprocal * dot(there, viewDirection(from)))));
    point = pointAt(dot(subtract(surface, camera.eye), view));
  }
  return reciprocal > 0 && dot(subtract(point, camera.eye), view) > 0 ? point : null;
}
