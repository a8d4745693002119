/** @import { ClientMessage, StateDocument } from '../base/protocol.js' */

/** So long a camera does not change until it is taken for still. */
const STILL_MS = 600;
const MOST = 50;
const MOVES = /^(pointer|wheel|keydown|navigate|fit|fly)/;

/** Where the camera was before each of this page's own moves, once they are over. */
export class Trail {
  #changed;
  #poses = [];
  #rest;
  #now;
  #isOwn = false;
  #pressed = new Set();
  #timer;

  /** @param {() => void} changed is told that there may be another `isEmpty` */
  constructor(changed) {
    this.#changed = changed;
  }

  get isEmpty() {
    return this.#poses.length === 0;
  }

  /** What was sent by who steers. @param {ClientMessage} message */
  sent(message) {
    const { type } = message;
    if (type === 'pointerdown') this.#pressed.add(message.pointerId);
    else if (type === 'pointerup' || type === 'pointercancel') this.#pressed.delete(message.pointerId);
    if (!MOVES.test(type) && !(type === 'patch' && message.patch.camera) && !(type === 'pick' && message.then)) return;
    this.#isOwn = true;
    this.#wait();
  }

  /** @param {StateDocument['camera']} camera */
  follow({ eye, focus, up, center, fov }) {
    const pose = { eye, focus, up, center, fov };
    this.#rest ??= pose;
    if (this.#now && isSame(pose, this.#now)) return;
    this.#now = pose;
    this.#wait();
  }

  /** The pose to fly to, which is no move of its own; undefined where there is none. */
  back() {
    this.#settle();
    let pose;
    do pose = this.#poses.pop(); while (pose && isSame(pose, this.#now));
    this.#rest = pose ?? this.#rest;
    this.#changed();
    return pose;
  }

  /** Another scene has other places. */
  forget() {
    clearTimeout(this.#timer);
    this.#poses = [];
    this.#rest = this.#now = undefined;
    this.#isOwn = false;
    this.#pressed.clear();
    this.#changed();
  }

  #wait() {
    clearTimeout(this.#timer);
    this.#timer = setTimeout(() => (this.#pressed.size > 0 ? this.#wait() : this.#settle()), STILL_MS);
  }

  #settle() {
    clearTimeout(this.#timer);
    if (this.#isOwn && this.#rest && !isSame(this.#rest, this.#now)) this.#poses = [...this.#poses, this.#rest].slice(-MOST);
    this.#rest = this.#now;
    this.#isOwn = false;
    this.#changed();
  }
}

/** `up` is made unit anew, which may change its last digits. */
function isSame(a, b) {
  const text = ({ eye, focus, up, center, fov }) => String([eye, focus, up.map((x) => x.toFixed(9)), center, fov]);
  return text(a) === text(b);
}
