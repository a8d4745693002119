import { add, distance, dot, scale, subtract } from '../base/vectors.js';
import { placeOf, viewDirection } from './camera.js';
import { dollied, pannedBy, pinched, pointAt, turnedBy, wheeled } from './drags.js';
import { applyKeyOperation, keyOperation, numberOf } from './keys.js';
import { changedGrip, dragOperation, pressedGrip } from './styles.js';

/**
 * @import {
 *   ClientKeydown, ClientKeyup, ClientPointercancel, ClientPointerdown, ClientPointermove, ClientPointerup,
 *   ClientWheel,
 * } from '../base/protocol.js'
 */
/** @import { Camera } from './camera.js' */
/** @import { NavigationContext, Place } from './drags.js' */
/** @import { Grip } from './styles.js' */

/** @typedef {{pointerId: number, touches: boolean, start: Place, now: Place, grip: Grip}} Pressed */

/** The server ignores further ones, of all clients together. */
const MOST_PRESSED = 16;

/**
 * Drags by mouse, pen and touch, the wheel and the keys of one client, by the rules of the server's class of this name.
 * The camera is computed from the camera at the start of the drag and the pointers' places since, so that lost or
 * merged moves give the same camera. What was touched at the start stays under the pointer, or between two fingers,
 * while they pan and zoom.
 */
export class Gestures {
  /** @type {Pressed[]} in the order of pressing */
  #pressed = [];
  /** @type {number[]} the number keys held, in the order of pressing */
  #numbers = [];
  /** @type {Camera} where the drags began */
  #start = { eye: [0, 0, 5], focus: [0, 0, 0], up: [0, 1, 0], center: [0, 0, 0], fov: 40 };
  /** @type {?number[]|undefined} the surface point at the start; null: none is there, undefined: not looked for yet */
  #touched;
  /** @type {?number[]} the point at the focus' depth that counts where none is there */
  #instead = null;

  /** An independent copy: what one is fed does not change the other. */
  copy() {
    const copy = new Gestures();
    copy.#pressed = this.#pressed.map((pressed) => ({ ...pressed }));
    copy.#numbers = [...this.#numbers];
    copy.#start = this.#start;
    copy.#touched = this.#touched;
    copy.#instead = this.#instead;
    return copy;
  }

  /**
   * The camera changed by anything but these messages: drags restart there. With `keepTouched` about the same surface
   * point.
   *
   * @param {Camera} camera
   * @param {boolean} [keepTouched]
   */
  restart(camera, keepTouched = false) {
    this.#start = camera;
    if (!keepTouched) this.#forgetTouched();
    for (const pressed of this.#pressed) pressed.start = pressed.now;
  }

  /**
   * Drags restart at `actual`, where the server has come to by the messages that lead to `expected` here. Where pans and
   * zooms have gone farther or less far, what is touched lies as much deeper or less deep: both are in proportion.
   *
   * @param {Camera} expected
   * @param {Camera} actual
   * @param {NavigationContext} context
   */
  correct(expected, actual, context) {
    const { eye } = this.#start;
    const predicted = subtract(expected.eye, eye);
    const part = dot(subtract(actual.eye, eye), predicted) / dot(predicted, predicted);
    if (!looksAlike(actual, this.#start)) {
      this.#forgetTouched();
    } else if (this.#touched) {
      if (part > 0) this.#touched = add(eye, scale(subtract(this.#touched, eye), part));
    } else if (this.#instead) {
      // At the depth of what is touched the images are the same.
      const { x, y } = placeOf(expected, context.width / context.height, this.#instead);
      const place = { x: (x + 1) * context.width / 2, y: (y + 1) * context.height / 2 };
      this.#instead = pointAt(actual, place, context);
    }
    this.restart(actual, true);
  }

  /**
   * Returns the camera after a message, given the `camera` before it; that one itself where it does not move.
   *
   * @param {ClientPointerdown|ClientPointermove|ClientPointerup|ClientPointercancel} message
   * @param {Camera} camera
   * @param {NavigationContext} context
   * @returns {Camera}
   */
  pointer(message, camera, context) {
    const { type, pointerId, x, y, button, buttons } = message;
    const pressed = this.#pressed.find((held) => held.pointerId === pointerId);
    if (type === 'pointerdown') {
      if (pressed) this.#remove(pressed);
      if (this.#pressed.length === MOST_PRESSED) return camera;
      if (message.pointerType === 'touch' && this.#fingers.length === 2) return camera; // a third one
      this.#press(message);
      this.restart(camera);
      return camera;
    }
    if (!pressed) return camera; // hovering

    // A move without buttons is hovering: the release was not seen, and where it was is not known.
    const isLost = type === 'pointercancel' || (type === 'pointermove' && buttons === 0);
    if (!isLost && type === 'pointermove' && button < 0 && buttons !== pressed.grip.buttons) {
      pressed.grip = changedGrip(pressed.grip, message); // unseen, too: the whole way since is the new drag's
      this.restart(camera);
    }
    let result = camera;
    if (!isLost) {
      pressed.now = { x, y };
      result = this.#dragged(context);
    }
    if (isLost || type === 'pointerup') {
      this.#remove(pressed);
      this.restart(result);
    } else if (buttons !== pressed.grip.buttons) { // a chord
      const { altKey = false } = message;
      pressed.grip = { ...changedGrip(pressed.grip, message), alt: altKey, number: this.#number };
      this.restart(result);
    }
    return result;
  }

  /**
   * @param {ClientWheel} message
   * @param {Camera} camera
   * @param {NavigationContext} context
   * @returns {Camera} after it
   */
  wheel(message, camera, context) {
    const result = wheeled(message, camera, context);
    this.restart(result);
    return result;
  }

  /**
   * @param {ClientKeydown} message
   * @param {Camera} camera
   * @param {NavigationContext} context
   * @returns {?Camera} after it; null where the server alone knows it, as for `f`
   */
  keyDown(message, camera, context) {
    const number = numberOf(message);
    // A held key repeats itself.
    if (number && !this.#numbers.includes(number)) this.#numbers.push(number);
    const operation = keyOperation(message);
    if (!operation && number) return camera;
    const result = operation && applyKeyOperation(operation, camera, context);
    this.restart(result ?? camera);
    return result;
  }

  /** @param {ClientKeyup} message */
  keyUp(message) {
    const released = numberOf(message);
    this.#numbers = this.#numbers.filter((number) => number !== released);
  }

  #forgetTouched() {
    this.#touched = undefined;
    this.#instead = null;
  }

  #remove(pressed) {
    this.#pressed.splice(this.#pressed.indexOf(pressed), 1);
  }

  #press(message) {
    const { pointerId, pointerType, x, y } = message;
    const place = { x, y };
    const grip = pressedGrip(message, this.#number);
    this.#pressed.push({ pointerId, touches: pointerType === 'touch', start: place, now: place, grip });
  }

  get #number() {
    return this.#numbers.at(-1) ?? 0;
  }

  /** Two at most: a third is ignored until it is lifted. */
  get #fingers() {
    return this.#pressed.filter(({ touches }) => touches);
  }

  /** @returns {?number[]} */
  #touchedAt(place, { surfaceAt }) {
    const touched = this.#touched === undefined ? surfaceAt?.(this.#start, place) ?? null : this.#touched;
    this.#touched = touched;
    return touched;
  }

  #pointAt(place, context) {
    const touched = this.#touchedAt(place, context);
    if (touched) return touched;
    this.#instead ??= pointAt(this.#start, place, context);
    return this.#instead;
  }

  /** @param {NavigationContext} context */
  #dragged(context) {
    const fingers = this.#fingers;
    if (fingers.length === 1) return this.#turned(fingers[0], context);
    if (fingers.length === 2) return this.#pinched(fingers[0], fingers[1], context);
    const pressed = this.#pressed[this.#pressed.length - 1];
    switch (dragOperation(context.style, pressed.grip)) {
      case 'rotate':
        return this.#turned(pressed, context);
      case 'pan':
        return pannedBy(this.#start, wayOf(pressed), this.#pointAt(pressed.start, context), context);
      case 'zoom':
        return dollied(this.#start, wayOf(pressed).y, context);
      default:
        return this.#start;
    }
  }

  #turned(pressed, context) {
    const touched = () => this.#touchedAt(pressed.start, context);
    return turnedBy(this.#start, wayOf(pressed), touched, context);
  }

  #pinched(a, b, context) {
    const middle = { x: (a.start.x + b.start.x) * 0.5, y: (a.start.y + b.start.y) * 0.5 };
    return pinched(this.#start, a, b, this.#pointAt(middle, context), context);
  }
}

/** @param {Camera} a @param {Camera} b */
const looksAlike = (a, b) => distance(viewDirection(a), viewDirection(b)) < 1e-9 && distance(a.up, b.up) < 1e-9;

const wayOf = ({ start, now }) => ({ x: now.x - start.x, y: now.y - start.y });
