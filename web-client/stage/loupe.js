import { showSign } from './snap-signs.js';

/**
 * @import { Snap } from '../base/measures.js'
 * @import { Place } from '../navigation/drags.js'
 * @import { Area } from '../navigation/plane-drags.js'
 */

/** How many times as large the picture is in it. */
export const MAGNIFIED = 3;
const SIDE = 120;
/** From a finger's middle to the loupe's: a fingertip hides some 30 px on each side of it. */
const AWAY = 108;

/** Shows what is around the finger, enlarged, and what a pick there would snap to. */
export class Loupe {
  #element;
  #canvas;
  #svg;
  #word;
  #magnify;

  /**
   * @param {HTMLElement} element of index.html
   * @param {(canvas: HTMLCanvasElement, place: Place, factor: number) => void} magnify draws the picture there
   */
  constructor(element, magnify) {
    this.#element = element;
    this.#canvas = /** @type {HTMLCanvasElement} */ (element.querySelector('canvas'));
    this.#svg = /** @type {Element} */ (element.querySelector('svg'));
    this.#word = /** @type {HTMLElement} */ (element.querySelector('p'));
    this.#magnify = magnify;
  }

  hide() {
    this.#element.hidden = true;
  }

  /**
   * @param {Place} finger on the window
   * @param {Area} area in which it has to be
   * @param {?{snap: Snap, at: ?Place, lines: Place[][]}} snapped on the window
   * @param {string} word what that is
   */
  show(finger, area, snapped, word) {
    const { x, y } = loupePlace(finger, area);
    this.#element.style.transform = `translate(${(x - SIDE / 2).toFixed(1)}px, ${(y - SIDE / 2).toFixed(1)}px)`;
    this.#element.hidden = false;
    const pixels = Math.round(SIDE * globalThis.devicePixelRatio);
    if (this.#canvas.width !== pixels) this.#canvas.width = this.#canvas.height = pixels;
    this.#magnify(this.#canvas, finger, MAGNIFIED);
    const inside = (place) => inLoupe(place, finger);
    showSign(this.#svg, snapped && {
      ...snapped, at: snapped.at && inside(snapped.at), lines: snapped.lines.map((line) => line.map(inside)),
    });
    if (this.#word.textContent !== word) this.#word.textContent = word;
  }
}

/** Where a place of the window is in the loupe of a finger. @param {Place} place @param {Place} finger @returns {Place} */
export function inLoupe({ x, y }, finger) {
  return { x: (x - finger.x) * MAGNIFIED + SIDE / 2, y: (y - finger.y) * MAGNIFIED + SIDE / 2 };
}

/**
 * The loupe's middle: above the finger, or beside it where there is no room above; always in the area, and clear of the
 * finger.
 *
 * @param {Place} finger
 * @param {Area} area
 * @returns {Place}
 */
export function loupePlace({ x, y }, { left, top, right, bottom }) {
  const half = SIDE / 2;
  const within = (value, min, max) => Math.max(Math.min(value, max), min);
  const across = within(x, left + half, right - half);
  if (y - AWAY >= top + half) return { x: across, y: Math.min(y - AWAY, bottom - half) };
  // On the side that has more room; the hand comes from the right more often.
  const isLeft = x - AWAY >= left + half || x > (left + right) / 2;
  return { x: within(isLeft ? x - AWAY : x + AWAY, left + half, right - half), y: within(y, top + half, bottom - half) };
}
