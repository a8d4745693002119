import { nearestPoint } from '../base/planes.js';
import { add, cross, distance, dot, scale, subtract } from '../base/vectors.js';
import { directionThrough, placeOf, rightDirection, tangentHeight, viewDirection } from './camera.js';

/**
 * @import { Plane } from '../base/planes.js'
 * @import { Camera } from './camera.js'
 * @import { Place } from './drags.js'
 *
 * A camera, and the size of its view in CSS pixels.
 *
 * @typedef {{camera: Camera, width: number, height: number}} Lens
 *
 * @typedef {{left: number, top: number, right: number, bottom: number}} Area of a view, in CSS pixels
 */

/** Pixels from an arrow's foot to its end, where it lies across the view, and at least. */
export const ARROW = 120;
const SHORTEST = 76;
/** A normal that is seen shorter than this part of its length points at the viewer, or away: its drags go upwards. */
const FLATTEST = 0.2;
/** From an area's edge, in pixels, for a finger to have room about the foot. */
const EDGE = 60;
/** From a plane on which a point lies, in the scene's radius. */
const SAME_PLANE = 1e-6;
/** As far from the scene's middle, in its radius, as a plane may be taken hold of. */
const FARTHEST = 1.5;

/** The camera's axes in the view: to the right, downwards and ahead; and its pixels at distance 1. @param {Lens} lens */
function axesOf({ camera, height }) {
  const ahead = viewDirection(camera);
  const right = rightDirection(camera);
  return { right, down: cross(ahead, right), ahead, focal: height / tangentHeight(camera) };
}

/** Where a point is seen; null where it does not lie before the eye. @param {Lens} lens @returns {?Place} */
function placeIn({ camera, width, height }, point) {
  const { x, y, depth } = placeOf(camera, width / height, point);
  return depth > 0 ? { x: (x + 1) * width / 2, y: (y + 1) * height / 2 } : null;
}

/**
 * Where a plane is taken hold of: where it was before, as long as that lies on it, or at its point nearest to the scene's
 * middle, or, where these are not seen in `free`, at the one in the middle of that; null where there is none of them.
 *
 * @param {Lens} lens
 * @param {Plane} plane
 * @param {{center: number[], radius: number}} scene
 * @param {Area} free
 * @param {?number[]} [before]
 * @returns {?number[]}
 */
export function footOf(lens, plane, { center, radius }, free, before) {
  const isSeen = (point) => {
    const place = placeIn(lens, point);
    return place !== null && isWithin(place, free);
  };
  if (before && Math.abs(dot(plane.normal, before) - plane.distance) < SAME_PLANE * radius && isSeen(before)) return before;
  const nearest = nearestPoint(plane, center);
  if (isSeen(nearest)) return nearest;
  const { camera, width, height } = lens;
  const x = (free.left + free.right) / width - 1;
  const y = (free.top + free.bottom) / height - 1;
  const ray = directionThrough(camera, width / height, x, y);
  const away = (plane.distance - dot(plane.normal, camera.eye)) / dot(plane.normal, ray);
  const seen = add(camera.eye, scale(ray, away));
  return away > 0 && distance(seen, center) <= FARTHEST * radius ? seen : null;
}

const isWithin = ({ x, y }, { left, top, right, bottom }) =>
  x >= left + EDGE && x <= right - EDGE && y >= top + EDGE && y <= bottom - EDGE;

/**
 * Which way in the view, as a unit vector, a point before the eye moves along a normal; `isFlat`: that is not to be
 * seen, and it is upwards.
 *
 * @param {Lens} lens
 * @param {number[]} point
 * @param {number[]} normal
 */
function slopeAt(lens, point, normal) {
  const { right, down, ahead } = axesOf(lens);
  const way = subtract(point, lens.camera.eye);
  const recedes = dot(normal, ahead) / dot(way, ahead);
  const x = dot(normal, right) - dot(way, right) * recedes;
  const y = dot(normal, down) - dot(way, down) * recedes;
  const length = Math.hypot(x, y);
  return length < FLATTEST ? { x: 0, y: -1, isFlat: true } : { x: x / length, y: y / length, isFlat: false };
}

/**
 * The arrow from a plane's foot along its normal; null where that is not seen.
 *
 * @param {Lens} lens
 * @param {number[]} foot
 * @param {number[]} normal
 * @returns {?{x: number, y: number, degrees: number, length: number}} its foot in the view, clockwise from the right, px
 */
export function arrowOf(lens, foot, normal) {
  const place = placeIn(lens, foot);
  if (!place) return null;
  const { ahead, focal } = axesOf(lens);
  const slope = slopeAt(lens, foot, normal);
  const depth = dot(subtract(foot, lens.camera.eye), ahead);
  const end = placeIn(lens, add(foot, scale(normal, ARROW * depth / focal)));
  const seen = end && !slope.isFlat ? Math.hypot(end.x - place.x, end.y - place.y) : 0;
  const length = Math.min(Math.max(seen, SHORTEST), 2 * ARROW);
  return { ...place, degrees: Math.atan2(slope.y, slope.x) * 180 / Math.PI, length };
}

/**
 * How far along its normal a plane is dragged by pixels: what lies at its foot moves with the finger, as far as that goes
 * along the arrow. Null where that is beyond the horizon.
 *
 * @param {Lens} lens
 * @param {number[]} foot
 * @param {number[]} normal
 * @param {Place} by
 * @returns {?number}
 */
export function draggedBy(lens, foot, normal, by) {
  const { right, down, ahead, focal } = axesOf(lens);
  const way = subtract(foot, lens.camera.eye);
  const depth = dot(way, ahead);
  const slope = slopeAt(lens, foot, normal);
  const drag = slope.x * by.x + slope.y * by.y;
  if (slope.isFlat) return drag * depth / focal;
  // The pixels along the slope are a quotient of functions of the way that are linear, the second one its depth.
  const along = (v) => focal * (slope.x * dot(v, right) + slope.y * dot(v, down));
  const wanted = along(way) / depth + drag;
  const recedes = dot(normal, ahead);
  const moved = (along(way) - wanted * depth) / (wanted * recedes - along(normal));
  return depth + moved * recedes > 0 && Number.isFinite(moved) ? moved : null;
}

/**
 * A normal after its arrow's end was dragged by pixels, as on a ball about the foot; it stays on its side of the ball.
 *
 * @param {Lens} lens
 * @param {number[]} normal
 * @param {Place} by
 */
export function turnedBy(lens, normal, by) {
  const { right, down, ahead } = axesOf(lens);
  const x = dot(normal, right) + by.x / ARROW;
  const y = dot(normal, down) + by.y / ARROW;
  const out = Math.max(Math.hypot(x, y), 1);
  const side = dot(normal, ahead) > 1e-9 ? 1 : -1;
  const z = side * Math.sqrt(Math.max(1 - x * x - y * y, 0));
  return add(add(scale(right, x / out), scale(down, y / out)), scale(ahead, z));
}
