import { isSamePose, withOrthogonalUp } from '../navigation/camera.js';
import { CameraPath } from '../navigation/flight.js';
import { Gestures } from '../navigation/gestures.js';
import { contextOf, movedBy } from '../navigation/input.js';

/**
 * @import { FrameHeader, StateDocument } from '../base/protocol.js'
 * @import { Camera } from '../navigation/camera.js'
 * @import { NavigationContext, Place } from '../navigation/drags.js'
 */

/**
 * @typedef {{id: number, message: *, from?: Camera, gestures: Gestures, camera: Camera}} Step what a message made of the
 *   camera, and where drags are since; `from`: where a flight was that it ended
 */

/** The oldest of more count as shown: some messages bring no frame. */
const MOST_PENDING = 500;
/** A flight that frames do not end by then was ended by something else. */
const FLIGHT_IS_OVER_MS = 2000;

/**
 * The camera that the hands ask for: what the messages lead to that the last frame does not show. It follows the
 * server's rules, and is corrected by each frame. What the server alone knows, as a fit, waits for the next frame.
 */
export class Prediction {
  #surfaceAt;
  #clock;
  /** @type {?StateDocument} */
  #state = null;
  #steers = false;
  /** @type {?FrameHeader} of the frame shown */
  #shown = null;
  /** @type {Step} the last that the frame shows */
  #known = nothing();
  /** @type {Step[]} those that it does not show */
  #pending = [];
  /** @type {Map<number, *>} the last move of each pointer that is not sent yet */
  #unsent = new Map();
  /** @type {?{path: CameraPath, begun: number}} that this page has asked for */
  #flight = null;

  /**
   * @param {{surfaceAt?: (camera: Camera, place: Place) => ?number[], clock?: () => number}} [page] the point of a
   *   surface that a camera sees at a place of the view, as far as frames tell; ms
   */
  constructor({ surfaceAt, clock = () => performance.now() } = {}) {
    this.#surfaceAt = surfaceAt;
    this.#clock = clock;
  }

  /** @returns {?Camera} null before the first frame */
  get camera() {
    if (!this.#shown) return null;
    if (this.#flight) return this.#flightCamera();
    const { gestures, camera } = this.#last;
    if (this.#unsent.size > 0) {
      const copy = gestures.copy();
      return [...this.#unsent.values()].reduce((moved, message) => this.#applied(copy, message, moved), camera);
    }
    // Between two frames it is the state's, which may fly.
    return this.#pending.length === 0 ? this.#state?.camera ?? camera : camera;
  }

  /** Whether the camera changes as time passes. */
  get flies() {
    return this.#flight !== null;
  }

  /** The state document as last heard, and whether this page steers. @param {StateDocument} state */
  follow(state, steers) {
    this.#state = state;
    if (this.#steers && !steers) this.release();
    this.#steers = steers;
  }

  /** A pointer has moved; the message may not be sent. */
  moved(message) {
    if (this.#shown && this.#steers) this.#unsent.set(message.pointerId, message);
  }

  /**
   * A message that is about to be sent, with the point of a surface that it is about, if any, as this page shows it: so
   * the server finds the same.
   */
  withTouched(message) {
    if (!this.#shown || !this.#steers || !isInput(message)) return message;
    const touching = { ...message };
    this.#applied(this.#last.gestures.copy(), touching, /** @type {Camera} */ (this.camera));
    return touching;
  }

  sent(message) {
    this.#unsent.delete(message.pointerId);
    if (!this.#shown || !this.#steers) return;
    if (message.type === 'fly') this.#fly(message);
    else if (isInput(message)) this.#push(message);
    // Other moves of the camera, from where drags start again.
    else if (message.type === 'fit' || message.patch?.camera) this.#push({ id: message.id });
  }

  /** @param {FrameHeader} header */
  drawn(header) {
    const before = this.#shown;
    this.#shown = header;
    if (!before || sizeOf(before) !== sizeOf(header)) {
      this.#begin(this.#last.gestures, header.camera);
      return;
    }
    let known = this.#known;
    while (this.#pending[0]?.id <= header.handled) known = /** @type {Step} */ (this.#pending.shift());
    const isRight = isSamePose(known.camera, header.camera);
    const gestures = isRight ? known.gestures : known.gestures.copy();
    if (!isRight) gestures.correct(known.camera, header.camera, this.#context());
    this.#known = { ...known, gestures, camera: header.camera };
    if (!isRight) this.#applyPending();
    this.#endFlight(header.camera);
  }

  /** The server does not take this page's input: nothing is pressed any more. */
  release() {
    this.#begin(new Gestures(), this.#shown?.camera);
  }

  /** The connection is lost. */
  forget() {
    this.#shown = null;
    this.release();
  }

  /** @param {Camera} [camera] of the frame shown */
  #begin(gestures, camera = nothing().camera) {
    gestures.restart(camera);
    this.#known = { ...nothing(), gestures, camera };
    this.#pending = [];
    this.#unsent.clear();
    this.#flight = null;
  }

  get #last() {
    return this.#pending.at(-1) ?? this.#known;
  }

  #push(message) {
    const from = this.#flight ? this.#flightCamera() : undefined;
    this.#flight = null;
    const before = this.#last;
    const gestures = before.gestures.copy();
    const camera = this.#applied(gestures, message, from ?? before.camera);
    this.#pending.push({ id: message.id, message, from, gestures, camera });
    if (this.#pending.length > MOST_PENDING) this.#known = /** @type {Step} */ (this.#pending.shift());
  }

  #applyPending() {
    let before = this.#known;
    for (const step of this.#pending) {
      step.gestures = before.gestures.copy();
      step.camera = this.#applied(step.gestures, step.message, step.from ?? before.camera);
      before = step;
    }
  }

  /** Where a message leads, which learns what it touches; `gestures` take it. @param {Gestures} gestures @returns {Camera} */
  #applied(gestures, message, camera) {
    const context = {
      ...this.#context(),
      surfaceAt: (from, place) => (message.touched ??= this.#surfaceAt?.(from, place) ?? undefined) ?? null,
    };
    return movedBy(gestures, message, camera, context);
  }

  #fly({ id, keyframes, easing }) {
    const from = /** @type {Camera} */ (this.camera);
    let laid = from;
    const path = [];
    for (const { at, camera = {} } of keyframes) {
      laid = withOrthogonalUp({ ...laid, ...camera });
      path.push({ at, camera: laid });
    }
    this.#push({ id });
    // Where a camera node stands, the server alone knows.
    if (keyframes.some(({ camera }) => camera?.node !== undefined)) return;
    this.#flight = { path: new CameraPath(from, path, easing), begun: this.#clock() };
  }

  #flightCamera() {
    const { path, begun } = /** @type {{path: CameraPath, begun: number}} */ (this.#flight);
    return path.at(this.#clock() - begun);
  }

  /** Frames lag behind a flight: it is over where they have come to its end. */
  #endFlight(camera) {
    if (!this.#flight) return;
    const { path, begun } = this.#flight;
    const past = this.#clock() - begun - path.duration;
    if (past >= 0 && (past > FLIGHT_IS_OVER_MS || isSamePose(path.at(path.duration), camera))) this.#flight = null;
  }

  /** @returns {NavigationContext} */
  #context() {
    return contextOf(/** @type {StateDocument} */ (this.#state), /** @type {FrameHeader} */ (this.#shown).view, this.#surfaceAt);
  }
}

/** @returns {Step} */
function nothing() {
  const camera = { eye: [0, 0, 1], focus: [0, 0, 0], up: [0, 1, 0], center: [0, 0, 0], fov: 40 };
  return { id: 0, message: {}, gestures: new Gestures(), camera };
}

const isInput = ({ type }) => type.startsWith('pointer') || type === 'wheel' || type.startsWith('key');

/** @param {FrameHeader} header */
const sizeOf = ({ view: { width, height } }) => `${width} x ${height}`;
