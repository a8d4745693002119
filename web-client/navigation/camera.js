import { add, cross, distance, dot, isFinite, length, normalize, scale, subtract } from '../base/vectors.js';

/** @import { Camera as CameraState } from '../base/protocol.js' */

/**
 * @typedef {Pick<CameraState, 'eye'|'focus'|'up'|'center'|'fov'>} Camera `up` is unit and at right angles to the view;
 *   `fov` is vertical, in degrees
 */

export const RADIANS_PER_DEGREE = Math.PI / 180;
/** The scene's vertical. */
export const VERTICAL = [0, 1, 0];

/** @param {Camera} camera */
export const focusDistance = ({ eye, focus }) => distance(eye, focus);

/** @param {Camera} camera */
export const viewDirection = ({ eye, focus }) => normalize(subtract(focus, eye));

/** @param {Camera} camera */
export const rightDirection = (camera) => normalize(cross(viewDirection(camera), camera.up));

/** Of what a camera sees in the plane one unit before the eye. */
export const tangentHeight = ({ fov }) => 2 * Math.tan((fov * RADIANS_PER_DEGREE) / 2);

/**
 * False where eye and focus are closer than 10⁻⁹ of `sceneRadius`, `up` is zero or lies along the view, or anything is
 * not finite.
 *
 * @param {Camera} camera
 * @param {number} sceneRadius
 */
export function isValidPose(camera, sceneRadius) {
  const { eye, focus, up, center } = camera;
  if (![eye, focus, up, center].every(isFinite)) return false;
  const away = focusDistance(camera);
  if (!Number.isFinite(away) || away === 0 || away < 1e-9 * sceneRadius) return false;
  const upLength = length(up);
  if (!Number.isFinite(upLength) || upLength === 0) return false;
  return length(cross(viewDirection(camera), scale(up, 1 / upLength))) > 1e-9;
}

/**
 * The same camera with `up` at right angles to the view and unit; the pose must be valid.
 *
 * @template {Camera} T
 * @param {T} camera
 * @returns {T}
 */
export function withOrthogonalUp(camera) {
  const view = viewDirection(camera);
  const up = normalize(camera.up);
  if (Math.abs(dot(view, up)) < 1e-15 && Math.abs(length(camera.up) - 1) < 1e-15) return camera;
  // Two products stay orthogonal where up lies close to the view and a difference would not.
  return { ...camera, up: normalize(cross(cross(view, up), view)) };
}

/**
 * Unit direction from the eye, in world space, through a point of a view of `aspect`, its width / height: x and y from
 * −1 (left, top) to 1 (right, bottom).
 *
 * @param {Camera} camera
 * @param {number} aspect
 * @param {number} x
 * @param {number} y
 */
export function directionThrough(camera, aspect, x, y) {
  const top = tangentHeight(camera) / 2;
  const view = viewDirection(camera);
  const right = rightDirection(camera);
  return normalize(add(add(view, scale(right, x * top * aspect)), scale(cross(right, view), -y * top)));
}

/** What two ways to compute the same pose may differ by, in parts of its size, and of its coordinates. */
const SAME = 1e-9;
const ROUNDED = 1e-13;

/**
 * Whether two cameras see the same, but for rounding.
 *
 * @param {Camera} a
 * @param {Camera} b
 */
export function isSamePose(a, b) {
  if (a === b) return true;
  const within = SAME * focusDistance(a) + ROUNDED * Math.max(length(a.eye), length(a.focus));
  return distance(a.eye, b.eye) <= within && distance(a.focus, b.focus) <= within &&
    distance(a.up, b.up) <= SAME && Math.abs(a.fov - b.fov) <= SAME * a.fov;
}

/**
 * Where a point of the world is seen, from −1 (left, top) to 1 (right, bottom), and how deep it lies along the view.
 *
 * @param {Camera} camera
 * @param {number} aspect width / height
 * @param {number[]} point
 * @returns {{x: number, y: number, depth: number}}
 */
export function placeOf(camera, aspect, point) {
  const view = viewDirection(camera);
  const right = rightDirection(camera);
  const way = subtract(point, camera.eye);
  const depth = dot(way, view);
  const top = tangentHeight(camera) / 2;
  return { x: dot(way, right) / (depth * top * aspect), y: -dot(way, cross(right, view)) / (depth * top), depth };
}
