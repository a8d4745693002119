import { add, dot, scale, subtract } from '../base/vectors.js';
import { RADIANS_PER_DEGREE, directionThrough, focusDistance, tangentHeight, viewDirection } from './camera.js';
import { lookedAround, panned, rotated, zoomed } from './camera-moves.js';

/** @import { Camera } from './camera.js' */
/** @import { Style } from './styles.js' */

/** @typedef {{x: number, y: number}} Place in the view, CSS pixels from its top left; or a way there */

/**
 * @typedef {object} NavigationContext what a move depends on besides the input
 * @property {number} width of the view, CSS pixels
 * @property {number} height
 * @property {number} radius of the scene: half the diagonal of its bounds
 * @property {boolean} keepUpright
 * @property {number} rotateSpeed
 * @property {number} panSpeed
 * @property {number} zoomSpeed
 * @property {Style} style
 * @property {boolean} turnAboutTouched turns about what is touched, where something is, instead of `center`, which
 *   stays
 * @property {(camera: Camera, place: Place) => ?number[]} [surfaceAt] the point of a surface that a camera sees; null
 *   if nothing is there
 * @property {(eye: number[]) => boolean} [looksAroundFrom] whether drags look around from an eye, instead of turning
 *   the scene
 * @property {Camera} [home] the view "home"
 */

/** A wheel's step away from the user divides the distance by it. */
const WHEEL_ZOOM = 1.1;
/** A zooming drag of the view's height upwards divides the distance by it. */
const DRAG_ZOOM = 4;
/** What is one step of a wheel, by `deltaMode`: pixels, lines, pages. */
const WHEEL_STEPS = [100, 3, 1 / 3];

/**
 * @param {Camera} camera
 * @param {NavigationContext} context
 */
export const looksAround = ({ eye }, { looksAroundFrom }) => looksAroundFrom?.(eye) ?? false;

/**
 * The scene turns about what is touched or the centre, or the view about the eye, where drags look around.
 *
 * @param {Camera} start
 * @param {Place} way
 * @param {() => ?number[]} touched asked for only where it counts
 * @param {NavigationContext} context
 * @returns {Camera}
 */
export function turnedBy(start, way, touched, context) {
  const { width, height, rotateSpeed, keepUpright } = context;
  if (looksAround(start, context)) {
    const degrees = tangentHeight(start) * rotateSpeed / (height * RADIANS_PER_DEGREE);
    return lookedAround(start, -way.x * degrees, -way.y * degrees, keepUpright);
  }
  const center = (context.turnAboutTouched ? touched() : null) ?? start.center;
  const about = { ...start, center };
  const degrees = 180 * rotateSpeed / Math.min(width, height);
  const result = rotated(about, way.x * degrees, way.y * degrees, keepUpright);
  return result === about ? start : { ...result, center: start.center };
}

/**
 * `point` moves with the image.
 *
 * @param {Camera} camera
 * @param {Place} way
 * @param {number[]} point
 * @param {NavigationContext} context
 * @returns {Camera}
 */
export function pannedBy(camera, way, point, { height, panSpeed }) {
  const part = panSpeed / height;
  return panned(camera, way.x * part, way.y * part, dot(subtract(point, camera.eye), viewDirection(camera)));
}

/**
 * `point` stays where it is seen.
 *
 * @param {Camera} camera
 * @param {number} factor
 * @param {number[]} point
 * @param {NavigationContext} context
 * @returns {Camera}
 */
function zoomedBy(camera, factor, point, { zoomSpeed, radius }) {
  return zoomed(camera, factor ** zoomSpeed, radius, point);
}

/**
 * By two fingers, which began about `point`. The pan comes second, so that it is measured in the image as the fingers
 * leave it.
 *
 * @param {Camera} start
 * @param {{start: Place, now: Place}} a
 * @param {{start: Place, now: Place}} b
 * @param {number[]} point
 * @param {NavigationContext} context
 * @returns {Camera}
 */
export function pinched(start, a, b, point, context) {
  const zoom = zoomedBy(start, span(a.now, b.now) / span(a.start, b.start), point, context);
  const way = {
    x: (a.now.x + b.now.x - a.start.x - b.start.x) * 0.5,
    y: (a.now.y + b.now.y - a.start.y - b.start.y) * 0.5,
  };
  return pannedBy(zoom, way, point, context);
}

/** Fingers that touch the same pixel would divide by zero. */
const span = (a, b) => Math.max(Math.hypot(a.x - b.x, a.y - b.y), 1);

/**
 * By a drag of `down` pixels.
 *
 * @param {Camera} camera
 * @param {number} down
 * @param {NavigationContext} context
 * @returns {Camera}
 */
export function dollied(camera, down, context) {
  return zoomedBy(camera, DRAG_ZOOM ** (-down / context.height), camera.focus, context);
}

/**
 * The camera after a wheel event. What lies under the pointer stays there.
 *
 * @param {{deltaY: number, deltaMode: number, x: number, y: number}} message
 * @param {Camera} camera
 * @param {NavigationContext} context
 * @returns {Camera}
 */
export function wheeled({ deltaY, deltaMode, x, y }, camera, context) {
  const point = context.surfaceAt?.(camera, { x, y }) ?? pointAt(camera, { x, y }, context);
  return zoomedBy(camera, WHEEL_ZOOM ** (-deltaY / WHEEL_STEPS[deltaMode]), point, context);
}

/**
 * The point at the focus' depth.
 *
 * @param {Camera} camera
 * @param {Place} place
 * @param {NavigationContext} context
 */
export function pointAt(camera, { x, y }, { width, height }) {
  const ray = directionThrough(camera, width / height, 2 * x / width - 1, 2 * y / height - 1);
  return add(camera.eye, scale(ray, focusDistance(camera) / dot(ray, viewDirection(camera))));
}
