import { SNAPS } from '../base/measures.js';
import { say } from '../base/texts.js';
import { Latest } from './latest.js';
import { listenOnLayer } from './layer-events.js';
import { Loupe } from './loupe.js';
import { dotData, pathData, showSign } from './snap-signs.js';

/**
 * @import { Snap, Snapped } from '../base/measures.js'
 * @import { Place } from '../navigation/drags.js'
 * @import { Area } from '../navigation/plane-drags.js'
 *
 * Gets what each pick has snapped to, undefined where that is nothing, and a call when there are no more.
 *
 * @typedef {{take: (snapped?: Snapped) => void, ended: () => void}} Session
 *
 * What is asked of a pick: in words, what it may snap to, and what those before have.
 *
 * @typedef {{text: string, to?: Snap[], taken: Snapped[]}} Asked
 *
 * A place of the view and of the window, and what a pick there may snap to.
 *
 * @typedef {{x: number, y: number, frame?: number, snap: {within: number, to?: Snap[]}, at: Place}} Question
 */

/** CSS pixels from a finger's middle to what it snaps to. */
const WITHIN = 16;

/**
 * While it is in use, a finger on the picture picks what it touches, and steers nothing: a loupe shows what that is. The
 * mouse sees it without a button, too. Two fingers and other buttons of a mouse go on to the picture and steer.
 */
export class Snapper {
  #layer;
  #mark;
  #loupe;
  #page;
  /** @type {?Session} */
  #session = null;
  /** @type {Asked} */
  #asked = { text: '', taken: [] };
  /** Ends what listens during a session. */
  #listening = new AbortController();
  /** With its press. @type {?{pointerId: number, at: Place, pressed: PointerEvent}} */
  #finger = null;
  /** How many fingers have left whose picks are not answered yet. */
  #takes = 0;
  /** The answer to the last of them. @type {Promise<void>} */
  #taking = Promise.resolve();
  /** @type {?Question} */
  #wanted = null;
  /** @type {Latest<Question, *>} */
  #latest;

  /**
   * @param {{layer: HTMLElement, mark: HTMLElement, loupe: HTMLElement}} elements of index.html
   * @param {{
   *   pick: (question: Omit<Question, 'at'>) => Promise<*>, mapping: () => (x: number, y: number) => Place,
   *   frame: () => number|undefined, paths: (lines: number[][][]) => Place[][][], free: () => Area,
   *   magnify: (canvas: HTMLCanvasElement, place: Place, factor: number) => void,
   *   say: (text: string) => void, wheel: (event: WheelEvent) => void, press: (event: PointerEvent) => void,
   * }} page `paths`: where lines of the world are seen on the window, in pieces; `free`: what no panel covers of that
   */
  constructor({ layer, mark, loupe }, page) {
    this.#layer = layer;
    this.#mark = mark;
    this.#page = page;
    this.#loupe = new Loupe(loupe, page.magnify);
    this.#latest = new Latest(({ at, ...place }) => page.pick(place), () => this.look());
  }

  /** @param {Session} session ask() must follow at once */
  begin(session) {
    this.end();
    this.#session = session;
    this.#layer.hidden = false;
    this.#listening = new AbortController();
    listenOnLayer(this.#layer, this, {
      pointerdown: this.#down,
      pointermove: this.#move,
      pointerup: this.#up,
      pointercancel: this.#cancel,
      lostpointercapture: this.#cancel,
      pointerleave: this.#leave,
      wheel: this.#wheel,
    }, this.#listening.signal);
  }

  /** @param {Asked} asked */
  ask(asked) {
    this.#asked = asked;
    this.#forgetAnswers();
    this.#page.say(asked.text);
    this.look();
  }

  end() {
    const session = this.#session;
    if (!session) return;
    this.#session = null;
    this.#finger = null;
    this.#takes = 0;
    this.#listening.abort();
    this.#forgetAnswers();
    this.#layer.hidden = this.#mark.hidden = true;
    this.#loupe.hide();
    this.#page.say('');
    session.ended();
  }

  /** Shows what would be taken as the picture shows it now. */
  look() {
    if (!this.#session) return;
    const { taken } = this.#asked;
    const snapped = this.#latest.last?.answer?.snapped;
    this.#mark.hidden = !snapped && taken.length === 0;
    // A point as a line of no length, which is left out where it is not seen.
    const points = [...taken, ...(snapped ? [snapped] : [])].map(({ point }) => [point, point]);
    const [rubber, line, ...dots] = this.#page.paths([
      points.map(([point]) => point), snapped?.line ?? [], ...points,
    ]);
    const places = dots.map(([piece]) => piece?.[0] ?? null);
    const sign = snapped ? { snap: snapped.feature.snap, at: places.at(-1) ?? null, lines: line } : null;
    const word = sign ? say(SNAPS[sign.snap]) : '';
    if (!this.#mark.hidden) this.#show(places.slice(0, taken.length), taken.length > 0 ? rubber : [], sign, word);
    if (this.#finger) this.#loupe.show(this.#finger.at, this.#page.free(), sign, word);
    else this.#loupe.hide();
  }

  #show(taken, rubber, sign, word) {
    const svg = /** @type {Element} */ (this.#mark.querySelector('svg'));
    svg.querySelector('.taken')?.setAttribute('d', dotData(taken.filter(Boolean)));
    svg.querySelector('.rubber')?.setAttribute('d', pathData(rubber));
    showSign(svg, sign);
    const name = /** @type {HTMLElement} */ (this.#mark.querySelector('p'));
    // The loupe says it, too.
    name.hidden = !sign?.at || this.#finger !== null;
    if (name.hidden) return;
    name.textContent = word;
    name.style.transform = `translate(${sign.at.x.toFixed(1)}px, ${sign.at.y.toFixed(1)}px)`;
  }

  #down(event) {
    event.preventDefault();
    const { pointerId, pointerType, button } = event;
    if (this.#finger || button !== 0) {
      this.#handOver(event);
      return;
    }
    this.#layer.setPointerCapture(pointerId);
    this.#finger = { pointerId, at: placeOf(event), pressed: event };
    // What was under the finger before is elsewhere, and so may be what was under a mouse in another picture.
    const isOld = pointerType !== 'mouse' || this.#wanted?.frame !== this.#page.frame();
    if (isOld && this.#takes === 0) this.#forgetAnswers();
    this.#want(placeOf(event));
  }

  /** The picture gets a press, and that of the finger that is down already: it captures both. */
  #handOver(event) {
    const before = this.#finger?.pressed;
    this.#forget();
    if (before) this.#page.press(before);
    this.#page.press(event);
  }

  #move(event) {
    const hovers = !this.#finger && event.pointerType === 'mouse';
    if (this.#finger?.pointerId === event.pointerId || hovers) this.#want(placeOf(event));
  }

  /** @param {Place} at */
  #want(at) {
    if (this.#finger) this.#finger.at = at;
    if (this.#takes === 0) this.#latest.want(this.#question(at));
    this.look();
  }

  /** The same one for the same place. @param {Place} at @returns {Question} */
  #question(at) {
    if (this.#wanted?.at.x === at.x && this.#wanted.at.y === at.y) return this.#wanted;
    const { to } = this.#asked;
    const snap = { within: WITHIN, ...(to ? { to } : {}) };
    this.#wanted = { ...this.#page.mapping()(at.x, at.y), frame: this.#page.frame(), snap, at };
    return this.#wanted;
  }

  #up(event) {
    const session = this.#session;
    if (this.#finger?.pointerId !== event.pointerId || !session) return;
    const at = placeOf(event);
    this.#finger = null;
    this.#takes += 1;
    this.look();
    this.#taking = this.#taking.then(() => this.#take(at, session));
  }

  /** Tells what is at a place, once it is known. @param {Place} at @param {Session} session */
  async #take(at, session) {
    if (session !== this.#session) return;
    const answer = await this.#latest.answerTo(this.#question(at));
    if (session !== this.#session) return;
    this.#takes -= 1;
    this.#forgetAnswers();
    if (answer) session.take(answer.snapped);
    if (this.#finger) this.#want(this.#finger.at);
    else this.look();
  }

  #cancel({ pointerId }) {
    if (this.#finger?.pointerId === pointerId) this.#forget();
  }

  #leave() {
    if (!this.#finger && this.#takes === 0) this.#forget();
  }

  #forget() {
    this.#finger = null;
    if (this.#takes === 0) this.#forgetAnswers();
    this.look();
  }

  #forgetAnswers() {
    this.#wanted = null;
    this.#latest.forget();
  }

  #wheel(event) {
    event.preventDefault();
    if (!this.#finger) this.#page.wheel(event);
  }
}

/** @returns {Place} */
const placeOf = ({ clientX, clientY }) => ({ x: clientX, y: clientY });
