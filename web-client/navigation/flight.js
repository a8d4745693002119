import { add, mix, scale, subtract } from '../base/vectors.js';
import { VERTICAL, focusDistance, isValidPose, rightDirection, viewDirection, withOrthogonalUp } from './camera.js';
import { orientation, rotate, slerp } from './quaternions.js';

/** @import { Camera } from './camera.js' */

/** @typedef {{at: number, camera: Camera}} Keyframe `at`: ms since the start */

/**
 * A path through cameras in time, as the server's class of this name has it.
 *
 * From one to the next focus, centre and fov go straight, the distance eye-focus by equal factors in equal parts of the
 * way, and the direction around the focus by azimuth (the shorter way) and elevation where both stand level and
 * upright, so that the horizon stays level, else by the shortest turn of the whole frame.
 */
export class CameraPath {
  /** The start and the keyframes. */
  #path;
  #easing;

  /**
   * The path starts at `from`. The keyframes' times rise from 0 or above; their poses are valid. A keyframe at 0
   * replaces `from`. `smooth` starts and ends softly, and passes the keyframes between without a stop; `linear`: equal
   * steps in equal times from each to the next.
   *
   * @param {Camera} from
   * @param {Keyframe[]} keyframes
   * @param {'smooth'|'linear'} [easing]
   */
  constructor(from, keyframes, easing = 'smooth') {
    const startsThere = keyframes.length > 0 && keyframes[0].at <= 0;
    this.#path = startsThere ? keyframes : [{ at: 0, camera: from }, ...keyframes];
    this.#easing = easing;
  }

  /** In ms. */
  get duration() {
    return this.#path[this.#path.length - 1].at;
  }

  /**
   * Returns a keyframe's camera at its time; the first before the start, the last after the end.
   *
   * @param {number} ms since the start
   * @returns {Camera}
   */
  at(ms) {
    const path = this.#path;
    const next = path.findIndex(({ at }) => ms < at);
    if (next === 0) return path[0].camera;
    const last = (next < 0 ? path.length : next) - 1;
    if (next < 0 || path[last].at === ms) return path[last].camera;
    return between(path[last].camera, path[next].camera, this.#progress(last, ms));
  }

  /**
   * From `index` to the next keyframe, 0 to 1. The way through the keyframes, counted in keyframes, is a monotone cubic
   * of time: Fritsch and Butland, A method for constructing local monotone piecewise cubic interpolants (1984).
   */
  #progress(index, ms) {
    const step = this.#path[index + 1].at - this.#path[index].at;
    const t = (ms - this.#path[index].at) / step;
    if (this.#easing === 'linear') return t;
    const start = this.#slope(index) * step;
    const end = this.#slope(index + 1) * step;
    return t * t * (3 - 2 * t) + t * (1 - t) * (start * (1 - t) - end * t);
  }

  /** Keyframes per ms while passing one: the harmonic mean of those before and after it. */
  #slope(index) {
    const isAtAnEnd = index === 0 || index + 1 === this.#path.length;
    return isAtAnEnd ? 0 : 2 / (this.#path[index + 1].at - this.#path[index - 1].at);
  }
}

/**
 * @param {Camera} a
 * @param {Camera} b
 * @param {number} part
 * @returns {Camera}
 */
function between(a, b, part) {
  if (part <= 0 || areEqual(a, b)) return a;
  if (part >= 1) return b;
  const { view, up } = isLevel(a) && isLevel(b) ? betweenLevel(a, b, part) : betweenAny(a, b, part);
  const distance = focusDistance(a) * (focusDistance(b) / focusDistance(a)) ** part;
  const focus = mix(a.focus, b.focus, part);
  const result = {
    eye: subtract(focus, scale(view, distance)),
    focus,
    up,
    center: mix(a.center, b.center, part),
    fov: a.fov + (b.fov - a.fov) * part,
  };
  // Very near to something very far off the way is finer than double tells.
  if (!isValidPose(result, 0)) return part < 0.5 ? a : b;
  return withOrthogonalUp(result);
}

const areEqual = (a, b) => a.fov === b.fov &&
  ['eye', 'focus', 'up', 'center'].every((member) => a[member].every((x, i) => x === b[member][i]));

/** The horizon is level, and the scene does not stand on its head. Straight up and down count, too. */
const isLevel = (camera) => Math.abs(rightDirection(camera)[1]) < 1e-9 && camera.up[1] > -1e-9;

/** Radians: of the right vector around the vertical, which tells more than the view where that is vertical. */
function azimuth(camera) {
  const right = rightDirection(camera);
  return Math.atan2(-right[2], right[0]);
}

/** Radians of the eye above the focus, −π/2 to π/2. */
const elevation = (camera) => Math.atan2(-viewDirection(camera)[1], camera.up[1]);

function betweenLevel(a, b, part) {
  const from = azimuth(a);
  const around = from + shorterWay(azimuth(b) - from) * part;
  const above = elevation(a) + (elevation(b) - elevation(a)) * part;
  const ahead = [-Math.sin(around), 0, -Math.cos(around)];
  const c = Math.cos(above);
  const s = Math.sin(above);
  return {
    view: subtract(scale(ahead, c), scale(VERTICAL, s)),
    up: add(scale(ahead, s), scale(VERTICAL, c)),
  };
}

/** Of a turn by up to 2π either way; half a turn stays as it is. */
const shorterWay = (turn) => (Math.abs(turn) > Math.PI ? turn - Math.sign(turn) * 2 * Math.PI : turn);

function betweenAny(a, b, part) {
  const turned = slerp(orientation(a), orientation(b), part);
  return { view: rotate(turned, [0, 0, -1]), up: rotate(turned, VERTICAL) };
}
