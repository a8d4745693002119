import { listenOnLayer } from './layer-events.js';

/**
 * @import { Place } from '../navigation/drags.js'
 *
 * @typedef {{x: number, y: number, frame?: number}} Pointed a place of the view, and the frame that shows it
 */

/** As many are passed on to others. */
const APART_MS = 1000 / 30;
/** A finger that rests says so, or its dot would go. */
const AGAIN_MS = 500;

/** While it is in use, a finger on the picture points others to what it touches, and steers nothing. */
export class Pointer {
  #layer;
  #page;
  #isOn = false;
  /** Ends what listens while it is in use. */
  #listening = new AbortController();
  /** @type {?{pointerId: number, at: Place}} */
  #finger = null;
  #sentAt = -Infinity;
  /** Of the next message. @type {ReturnType<typeof setTimeout>|undefined} */
  #timer;

  /**
   * @param {HTMLElement} layer of index.html, over the picture
   * @param {{
   *   send: (pointed: Pointed|{}) => void, mapping: () => (x: number, y: number) => Place, frame: () => number|undefined,
   *   turned: (isOn: boolean) => void, wheel: (event: WheelEvent) => void, clock?: () => number,
   * }} page `send`: what is pointed at, or nothing; `turned` is called when it begins and when it ends
   */
  constructor(layer, page) {
    this.#layer = layer;
    this.#page = { clock: () => performance.now(), ...page };
  }

  begin() {
    if (this.#isOn) return;
    this.#isOn = true;
    this.#layer.hidden = false;
    this.#listening = new AbortController();
    listenOnLayer(this.#layer, this, {
      pointerdown: this.#down,
      pointermove: this.#move,
      pointerup: this.#up,
      pointercancel: this.#up,
      lostpointercapture: this.#up,
      wheel: this.#wheel,
    }, this.#listening.signal);
    this.#page.turned(true);
  }

  end() {
    if (!this.#isOn) return;
    this.#release();
    this.#isOn = false;
    this.#listening.abort();
    this.#layer.hidden = true;
    this.#page.turned(false);
  }

  #down(event) {
    event.preventDefault();
    const { pointerId, button } = event;
    if (this.#finger || button !== 0) return;
    this.#layer.setPointerCapture(pointerId);
    this.#finger = { pointerId, at: placeOf(event) };
    this.#soon();
  }

  #move(event) {
    const finger = this.#finger;
    if (!finger || finger.pointerId !== event.pointerId) return;
    finger.at = placeOf(event);
    this.#soon();
  }

  #up({ pointerId }) {
    if (this.#finger?.pointerId === pointerId) this.#release();
  }

  #release() {
    if (!this.#finger) return;
    this.#finger = null;
    clearTimeout(this.#timer);
    this.#page.send({});
  }

  /** Sends where the finger is when it is time for that. */
  #soon() {
    this.#in(this.#sentAt + APART_MS - this.#page.clock());
  }

  #in(ms) {
    clearTimeout(this.#timer);
    if (ms > 0) this.#timer = setTimeout(() => this.#send(), ms);
    else this.#send();
  }

  #send() {
    if (!this.#finger) return;
    const { x, y } = this.#finger.at;
    this.#sentAt = this.#page.clock();
    this.#page.send({ ...this.#page.mapping()(x, y), frame: this.#page.frame() });
    this.#in(AGAIN_MS);
  }

  #wheel(event) {
    event.preventDefault();
    if (!this.#finger) this.#page.wheel(event);
  }
}

/** @returns {Place} */
const placeOf = ({ clientX, clientY }) => ({ x: clientX, y: clientY });
