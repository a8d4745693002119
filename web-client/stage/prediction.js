/** @import { FrameHeader, ServerWelcome, StateDocument } from '../base/protocol.js' */

/** What moves the camera otherwise: drags begin anew there. */
const OTHER_MOVES = new Set(['keydown', 'patch', 'fit', 'fly']);

/**
 * @typedef {{scale: number, x: number, y: number}} Similarity a point p of the picture, measured from the view's
 *   middle in its CSS pixels, goes to scale · p + (x, y)
 */
const NONE = { scale: 1, x: 0, y: 0 };

/**
 * What messages will do to the picture that does not show them yet: two fingers, the wheel, and drags that pan
 * or zoom by a button alone, by the server's rules of input but without limits. It is exact at the depth of what is
 * touched. All else waits for the next picture.
 */
export class Prediction {
  /** @type {Partial<StateDocument['navigation']>} */
  #navigation = {};
  /** @type {ServerWelcome['input']|undefined} */
  #rules;
  #steers = false;
  /** @type {?FrameHeader} of the picture shown */
  #shown = null;
  /** From the picture shown to what the last message makes of it, and where the drag began. */
  #now = NONE;
  #start = NONE;
  /** Where the messages lead that the picture does not show: {id, now}. */
  #pending = [];
  /** The pressed pointers: {touches, buttons, start, place}. */
  #pressed = new Map();
  #lastId = 0;
  /** Nothing is told before a picture shows this message. */
  #blindUntil = 0;

  /** @returns {?Similarity} where the picture shown is to be moved; null: it is in its place */
  get transform() {
    const { scale, x, y } = this.#now;
    const isMoved = scale !== 1 || x !== 0 || y !== 0;
    const isTold = this.#steers && this.#shown !== null && this.#shown.handled >= this.#blindUntil;
    return isMoved && isTold ? this.#now : null;
  }

  /** The state document as last heard, whether this page steers, and the welcome's `input`. */
  follow({ navigation = {} }, steers, rules) {
    this.#navigation = navigation;
    this.#rules = rules;
    if (this.#steers && !steers) this.forget();
    this.#steers = steers;
  }

  sent(message) {
    const { id, type, deltaY, deltaMode, x, y } = message;
    this.#lastId = id;
    const before = this.#now;
    if (type.startsWith('pointer')) this.#pointer(message);
    if (type === 'wheel' && this.#rules) {
      const { wheelZoom, wheelSteps } = this.#rules;
      this.#now = this.#zoomed(before, wheelZoom ** (-deltaY / wheelSteps[deltaMode]), { x, y });
    }
    if (type === 'wheel' || OTHER_MOVES.has(type)) this.#restart();
    if (this.#now !== before) this.#pending.push({ id, now: this.#now });
  }

  /** @param {FrameHeader} header */
  drawn(header) {
    const before = this.#shown;
    this.#shown = header;
    const { handled, view } = header;
    const isOtherView = view.width !== before?.view.width || view.height !== before.view.height;
    if (!before || isOtherView || (handled === before.handled && poseOf(header) !== poseOf(before))) {
      this.#giveUp();
      return;
    }
    const base = this.#pending.findLast(({ id }) => id <= handled)?.now ?? NONE;
    this.#pending = this.#pending.filter(({ id }) => id > handled);
    for (const step of this.#pending) step.now = since(base, step.now);
    this.#now = since(base, this.#now);
    this.#start = since(base, this.#start);
  }

  /** The connection is lost, or the server does not take this page's input. */
  forget() {
    this.#pressed.clear();
    this.#giveUp();
  }

  /** What is not shown yet is left to the pictures. */
  #giveUp() {
    this.#pending = [];
    this.#now = NONE;
    this.#blindUntil = this.#lastId;
    this.#restart();
  }

  #restart() {
    this.#start = this.#now;
    for (const held of this.#pressed.values()) held.start = held.place;
  }

  #pointer({ type, pointerId, pointerType, x, y, buttons }) {
    const pressed = this.#pressed;
    const place = { x, y };
    if (type === 'pointerdown') {
      pressed.delete(pointerId);
      if (pressed.size === 2) return; // a third finger
      pressed.set(pointerId, { touches: pointerType === 'touch', buttons, place });
      this.#restart();
      return;
    }
    const held = pressed.get(pointerId);
    if (!held) return;
    if (type !== 'pointercancel') {
      held.place = place;
      this.#now = this.#dragged();
    }
    if (type !== 'pointermove' || buttons === 0) pressed.delete(pointerId);
    else if (buttons === held.buttons) return;
    held.buttons = buttons;
    this.#restart();
  }

  #dragged() {
    const { panSpeed, style } = this.#navigation;
    const [a, b] = this.#pressed.values();
    const x = a.place.x - a.start.x;
    const y = a.place.y - a.start.y;
    if (a.touches && b?.touches) {
      const middle = { x: (a.start.x + b.start.x) / 2, y: (a.start.y + b.start.y) / 2 };
      const pinched = this.#zoomed(this.#start, span(a.place, b.place) / span(a.start, b.start), middle);
      return panned(pinched, (x + b.place.x - b.start.x) / 2, (y + b.place.y - b.start.y) / 2, panSpeed);
    }
    const { drags = {}, dragZoom = 1 } = this.#rules ?? {};
    const drag = b || style === undefined ? undefined : drags[style]?.[a.buttons];
    if (drag === 'pan') return panned(this.#start, x, y, panSpeed);
    if (drag === 'zoom') return this.#zoomed(this.#start, dragZoom ** (-y / this.#view.height));
    return this.#start;
  }

  /** Before the first picture nothing is told. */
  get #view() {
    return this.#shown?.view ?? { width: 1, height: 1 };
  }

  /**
   * About a place of the view, from its top left; the view's middle where it is left out.
   *
   * @param {Similarity} from
   * @param {number} ratio
   * @param {{x: number, y: number}} [about]
   */
  #zoomed({ scale, x, y }, ratio, about) {
    const factor = ratio ** (this.#navigation.zoomSpeed ?? 1);
    const { width, height } = this.#view;
    const fixed = about ? { x: about.x - width / 2, y: about.y - height / 2 } : { x: 0, y: 0 };
    return { scale: scale * factor, x: fixed.x + factor * (x - fixed.x), y: fixed.y + factor * (y - fixed.y) };
  }
}

function panned({ scale, x, y }, right, down, speed) {
  return { scale, x: x + right * speed, y: y + down * speed };
}

/** From where `base` leads to where `now` does. */
function since(base, now) {
  const scale = now.scale / base.scale;
  return { scale, x: now.x - scale * base.x, y: now.y - scale * base.y };
}

/** Fingers on the same pixel would divide by zero. */
function span(a, b) {
  return Math.max(Math.hypot(a.x - b.x, a.y - b.y), 1);
}

function poseOf({ camera: { eye, focus, up, fov } }) {
  return String([eye, focus, up, fov]);
}
