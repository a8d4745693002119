import { add, cross, scale } from '../base/vectors.js';
import { rightDirection, viewDirection } from './camera.js';

/** @import { Camera } from './camera.js' */

/** @typedef {number[]} Quaternion [w, x, y, z] */

const times = (a, factor) => a.map((x) => x * factor);
const sum = (a, b) => a.map((x, i) => x + b[i]);
const product = (a, b) => a.reduce((total, x, i) => total + x * b[i], 0);
const unit = (a) => times(a, 1 / Math.sqrt(product(a, a)));

/**
 * The turn from the axes of the world to those of a camera: right, up, back.
 *
 * @param {Camera} camera
 * @returns {Quaternion}
 */
export function orientation(camera) {
  const back = scale(viewDirection(camera), -1);
  const right = rightDirection(camera);
  return quaternionOf(right, cross(back, right), back);
}

/** Of a matrix by its columns. The largest component is a root, the others follow from it. */
function quaternionOf(x, y, z) {
  const diagonal = [
    x[0] + y[1] + z[2],
    x[0] - y[1] - z[2],
    y[1] - x[0] - z[2],
    z[2] - x[0] - y[1],
  ];
  const largest = diagonal.indexOf(Math.max(...diagonal));
  const root = Math.sqrt(diagonal[largest] + 1) / 2;
  const [a, b, c] = [y[2] - z[1], z[0] - x[2], x[1] - y[0]];
  const [d, e, f] = [x[1] + y[0], z[0] + x[2], y[2] + z[1]];
  const rows = [
    [0, a, b, c],
    [a, 0, d, e],
    [b, d, 0, f],
    [c, e, f, 0],
  ];
  return unit(rows[largest].map((value, i) => (i === largest ? root : value / (4 * root))));
}

/**
 * The shorter way, at a constant speed.
 *
 * @param {Quaternion} from
 * @param {Quaternion} to
 * @param {number} part
 * @returns {Quaternion}
 */
export function slerp(from, to, part) {
  const isLonger = product(from, to) < 0;
  const end = isLonger ? times(to, -1) : to;
  const cosine = Math.abs(product(from, to));
  // Near 1 the sine would be too small to divide by.
  if (cosine > 1 - Number.EPSILON) return unit(sum(times(from, 1 - part), times(end, part)));
  const angle = Math.acos(cosine);
  const [start, share] = [Math.sin((1 - part) * angle), Math.sin(part * angle)];
  return unit(times(sum(times(from, start), times(end, share)), 1 / Math.sin(angle)));
}

/**
 * @param {Quaternion} quaternion
 * @param {number[]} v
 */
export function rotate([w, x, y, z], v) {
  const axis = [x, y, z];
  const across = cross(axis, v);
  return add(v, scale(add(scale(across, w), cross(axis, across)), 2));
}
