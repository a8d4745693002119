import { add, cross, dot, scale, subtract } from '../base/vectors.js';
import {
  RADIANS_PER_DEGREE, VERTICAL, focusDistance, isValidPose, rightDirection, tangentHeight, viewDirection,
  withOrthogonalUp,
} from './camera.js';

/** @import { Camera } from './camera.js' */

// The server's moves, to the same numbers but for rounding. Each returns the camera itself if the move is zero or its
// result is not finite.

/** Eye and focus closer than this part of their coordinates would no longer say a direction. */
const RESOLUTION = 1e-12;

/**
 * The scene turns by `right` and `down` degrees, as if dragged there, around `camera.center`. With `keepUpright` about
 * the scene's vertical, and `down` stops at the poles, so that the scene never stands on its head; else about the
 * camera's own up.
 *
 * @param {Camera} camera
 * @param {number} right
 * @param {number} down
 * @param {boolean} keepUpright
 * @returns {Camera}
 */
export function rotated(camera, right, down, keepUpright) {
  // The scene turns one way, the camera the other.
  const yaw = -right * RADIANS_PER_DEGREE;
  let pitch = -down * RADIANS_PER_DEGREE;
  if (keepUpright) pitch = clampedPitch(camera, pitch);
  if (yaw === 0 && pitch === 0) return camera;

  const { eye, focus, up, center } = camera;
  const across = rightDirection(camera);
  const upright = hangsUpsideDown(camera) ? scale(VERTICAL, -1) : VERTICAL;
  const axis = keepUpright ? upright : up;
  const turn = (v) => turned(turned(v, across, pitch), axis, yaw);
  const result = {
    ...camera,
    eye: add(center, turn(subtract(eye, center))),
    focus: add(center, turn(subtract(focus, center))),
    up: turn(up),
  };
  return ifValid(withOrthogonalUp(result), camera);
}

/**
 * The view turns by `right` and `down` degrees about the eye.
 *
 * @param {Camera} camera
 * @param {number} right
 * @param {number} down
 * @param {boolean} keepUpright
 * @returns {Camera}
 */
export function lookedAround(camera, right, down, keepUpright) {
  const { eye, center } = camera;
  // The scene turns about it, the other way.
  const aboutEye = { ...camera, center: eye };
  const result = rotated(aboutEye, right, down, keepUpright);
  return result === aboutEye ? camera : { ...result, eye, center };
}

/**
 * The image moves right and down by fractions of the view's height in the plane at `depth`, or through `focus`.
 *
 * @param {Camera} camera
 * @param {number} right
 * @param {number} down
 * @param {number} [depth]
 * @returns {Camera}
 */
export function panned(camera, right, down, depth = focusDistance(camera)) {
  if (right === 0 && down === 0) return camera;
  const height = depth * tangentHeight(camera);
  const shift = scale(subtract(scale(camera.up, down), scale(rightDirection(camera), right)), height);
  return ifValid({ ...camera, eye: add(camera.eye, shift), focus: add(camera.focus, shift) }, camera);
}

/**
 * Eye and focus come nearer to `point`, or the eye to `focus`: the distance between them is divided by `factor` (above
 * 0), and stays within 10⁻⁶ and 10⁶ of `sceneRadius`. The point stays where it is seen.
 *
 * @param {Camera} camera
 * @param {number} factor
 * @param {number} sceneRadius
 * @param {number[]} [point]
 * @returns {Camera}
 */
export function zoomed(camera, factor, sceneRadius, point = camera.focus) {
  if (factor === 1) return camera;
  const away = focusDistance(camera);
  const radius = sceneRadius > 0 ? sceneRadius : 1;
  const closest = Math.max(radius * 1e-6, RESOLUTION * Math.max(...camera.focus.map(Math.abs)));
  // A pose given from outside may lie beyond the limits; then they are where it stands.
  const wanted = clamp(away / factor, Math.min(away, closest), Math.max(away, radius * 1e6));
  if (Math.abs(wanted - away) < 1e-14 * away) return camera; // at a limit
  const focus = add(point, scale(subtract(camera.focus, point), wanted / away));
  return ifValid({ ...camera, focus, eye: subtract(focus, scale(viewDirection(camera), wanted)) }, camera);
}

/** Rodrigues' formula; `axis` is unit. */
function turned(v, axis, radians) {
  const c = Math.cos(radians);
  const s = Math.sin(radians);
  return add(add(scale(v, c), scale(cross(axis, v), s)), scale(axis, dot(axis, v) * (1 - c)));
}

/** A camera that looks straight up or down does not: either side of it may be up. */
const hangsUpsideDown = ({ up }) => up[1] < -1e-12;

const ifValid = (moved, camera) => (isValidPose(moved, 0) ? moved : camera);

const clamp = (x, low, high) => Math.min(Math.max(x, low), high);

/**
 * A pitch about the right axis by which up · vertical keeps its sign. As a function of the angle that product is a
 * cosine: the allowed range is half a turn around its peak.
 */
function clampedPitch(camera, radians) {
  const up = camera.up[1];
  const back = -viewDirection(camera)[1];
  if (Math.hypot(up, back) < 1e-12) return radians; // the right axis is vertical: nothing can tip over
  const sign = hangsUpsideDown(camera) ? -1 : 1;
  // up(a) · vertical = up cos a + back sin a, greatest at a = atan2(back, up).
  const peak = Math.atan2(sign * back, sign * up);
  const quarter = Math.PI / 2;
  return clamp(radians, Math.min(peak - quarter, 0), Math.max(peak + quarter, 0));
}
