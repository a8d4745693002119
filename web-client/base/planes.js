import { add, distance as distanceOf, dot, normalize, scale, subtract } from './vectors.js';

/**
 * @import { Camera, StateDocument } from './protocol.js'
 *
 * What lies farther along `normal`, which is unit, than `distance` is cut away.
 *
 * @typedef {{normal: number[], distance: number}} Plane
 *
 * @typedef {StateDocument['scene']['bounds']} Bounds
 *
 * @typedef {{min: number, max: number}} Limits
 */

/** Beyond the scene at either end, in parts of its diagonal. */
const MARGIN = 0.02;
/** Between opposite sides of a box, in parts of how far they may go. */
const GAP = 0.005;

/** @param {Bounds} bounds */
export const centerOf = ({ min, max }) => scale(add(min, max), 0.5);

/**
 * Between which distances a plane sweeps all of the scene, and a little more.
 *
 * @param {number[]} normal
 * @param {Bounds} bounds
 * @returns {Limits}
 */
export function sweep(normal, { min, max }) {
  const middle = dot(normal, centerOf({ min, max }));
  const reach = dot(normal.map(Math.abs), subtract(max, min)) / 2 + MARGIN * distanceOf(min, max);
  return { min: middle - reach, max: middle + reach };
}

/**
 * @param {number[]} point
 * @param {number[]} direction of any length but 0
 * @returns {Plane}
 */
export function planeThrough(point, direction) {
  const normal = normalize(direction);
  return { normal, distance: dot(normal, point) };
}

/** The other half is cut away. @param {Plane} plane @returns {Plane} */
export function flipped({ normal, distance }) {
  return { normal: normal.map((x) => 0 - x), distance: 0 - distance };
}

/**
 * Through the scene's middle and across an axis; the half with the eye is cut away.
 *
 * @param {number} axis 0 to 2
 * @param {Bounds} bounds
 * @param {Pick<Camera, 'eye'>} camera
 */
export function planeAcross(axis, bounds, { eye }) {
  const center = centerOf(bounds);
  const sign = eye[axis] < center[axis] ? -1 : 1;
  return planeThrough(center, [0, 1, 2].map((i) => (i === axis ? sign : 0)));
}

/** Through what a camera looks at, facing it. @param {Pick<Camera, 'eye'|'focus'>} camera */
export function planeFacing({ eye, focus }) {
  return planeThrough(focus, subtract(eye, focus));
}

/** The point of a plane that is nearest to another. @param {Plane} plane @param {number[]} point */
export function nearestPoint({ normal, distance }, point) {
  return add(point, scale(normal, distance - dot(normal, point)));
}

/**
 * A corner of a box after one of its sides has moved, which stops before the opposite one.
 *
 * @param {Bounds} box
 * @param {'min'|'max'} corner
 * @param {number} axis
 * @param {number} value
 * @param {Limits} limits how far the sides may go
 */
export function movedCorner(box, corner, axis, value, limits) {
  const gap = GAP * (limits.max - limits.min);
  const kept = corner === 'min' ? Math.min(value, box.max[axis] - gap) : Math.max(value, box.min[axis] + gap);
  return box[corner].map((x, i) => (i === axis ? kept : x));
}
