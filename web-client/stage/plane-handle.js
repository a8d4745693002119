import { centerOf, sweep } from '../base/planes.js';
import { add, distance, dot, scale } from '../base/vectors.js';
import { arrowOf, draggedBy, footOf, turnedBy } from '../navigation/plane-drags.js';

/**
 * @import { Bounds, Plane } from '../base/planes.js'
 * @import { Area, Lens } from '../navigation/plane-drags.js'
 * @import { Place } from '../navigation/drags.js'
 *
 * What the handle is shown by: a view, the window's place of one of the view, how many of its pixels are one of the
 * window, what is not covered of it, the scene, and the plane with its name.
 *
 * @typedef {{lens: Lens, onWindow: (place: Place) => Place, perPixel: number, free: Area, bounds: Bounds, name: string,
 *   plane: Plane}} Shown
 */

/** The arrow on a plane, by which a finger moves it, and the knob at the arrow's end, by which it turns the plane. */
export class PlaneHandle {
  #svg;
  #change;
  #soon;
  /** @type {?Shown} */
  #shown = null;
  /** @type {?{pointerId: number, from: Place, grip: string, start: Shown, foot: number[]}} */
  #drag = null;
  /** What a drag made of the plane, until the state says so. @type {?{plane: Plane, foot: number[]}} */
  #dragged = null;
  /** Where the plane was taken hold of last. @type {?number[]} */
  #foot = null;
  /** What waits to be sent. @type {?{name: string, plane: Plane}} */
  #next = null;
  /** The answer to the last change. @type {Promise<*>} */
  #answered = Promise.resolve();

  /**
   * @param {SVGElement} svg of index.html, as large as the window
   * @param {{change: (name: string, plane: Partial<Plane>) => Promise<void>, soon?: (action: (time: *) => void) => void}} page
   */
  constructor(svg, { change, soon = (action) => requestAnimationFrame(action) }) {
    this.#svg = svg;
    this.#change = change;
    this.#soon = soon;
    for (const grip of svg.querySelectorAll('[data-grip]')) {
      grip.addEventListener('pointerdown', (event) => this.#begin(/** @type {PointerEvent} */ (event)));
      grip.addEventListener('pointermove', (event) => this.#move(/** @type {PointerEvent} */ (event)));
      // Or Chromium drops a tap soon after a flick.
      grip.addEventListener('touchmove', (event) => event.preventDefault(), { passive: false });
      for (const end of ['pointerup', 'pointercancel', 'lostpointercapture']) {
        grip.addEventListener(end, (event) => this.#end(/** @type {PointerEvent} */ (event)));
      }
    }
  }

  /** Null: none. @param {?Shown} shown */
  show(shown) {
    if (shown?.name !== this.#shown?.name) this.#drag = this.#dragged = this.#foot = null;
    this.#shown = shown;
    this.#draw();
  }

  #draw() {
    const arrow = this.#arrow();
    this.#svg.toggleAttribute('hidden', !arrow);
    if (!arrow) return;
    const { x, y, degrees, length } = arrow;
    const part = (name) => /** @type {SVGElement} */ (this.#svg.querySelector(name));
    part('g').setAttribute('transform', `translate(${x.toFixed(1)} ${y.toFixed(1)}) rotate(${degrees.toFixed(2)})`);
    for (const line of this.#svg.querySelectorAll('line')) line.setAttribute('x2', String(length - 30));
    part('path').setAttribute('transform', `translate(${length - 30})`);
    part('[data-grip="turn"]').setAttribute('transform', `translate(${length})`);
  }

  #arrow() {
    if (!this.#shown) return null;
    const { lens, onWindow } = this.#shown;
    const { plane, foot } = this.#dragged ?? this.#present(this.#shown);
    const arrow = foot && arrowOf(lens, foot, plane.normal);
    return arrow && { ...arrow, ...onWindow(arrow) };
  }

  /** @param {Shown} shown */
  #present({ lens, plane, bounds, free }) {
    const scene = { center: centerOf(bounds), radius: distance(bounds.min, bounds.max) / 2 };
    this.#foot = footOf(lens, plane, scene, free, this.#foot);
    return { plane, foot: this.#foot };
  }

  #begin(event) {
    event.preventDefault();
    if (this.#drag || !this.#shown || event.button !== 0) return;
    const { plane, foot } = this.#dragged ?? this.#present(this.#shown);
    if (!foot) return;
    const start = { ...this.#shown, plane };
    const { currentTarget, pointerId, clientX: x, clientY: y } = event;
    currentTarget.setPointerCapture(pointerId);
    this.#drag = { pointerId, from: { x, y }, grip: currentTarget.dataset.grip, start, foot };
  }

  #move({ pointerId, clientX, clientY }) {
    const drag = this.#drag;
    if (!drag || drag.pointerId !== pointerId) return;
    const { from, grip, start, foot } = drag;
    const by = { x: (clientX - from.x) * start.perPixel, y: (clientY - from.y) * start.perPixel };
    const dragged = grip === 'turn' ? turned(start, foot, by) : moved(start, foot, by);
    if (!dragged) return;
    this.#dragged = dragged;
    this.#foot = dragged.foot;
    this.#send(start.name, dragged.plane);
    this.#draw();
  }

  /** The last plane of each display frame. */
  #send(name, plane) {
    const waits = this.#next !== null;
    this.#next = { name, plane };
    if (waits) return;
    this.#answered = new Promise((resolve) => this.#soon(() => {
      const next = /** @type {{name: string, plane: Plane}} */ (this.#next);
      this.#next = null;
      resolve(this.#change(next.name, next.plane));
    }));
  }

  /** What was dragged stays where it is until the server has answered. */
  async #end({ pointerId }) {
    if (this.#drag?.pointerId !== pointerId) return;
    this.#drag = null;
    await this.#answered;
    await new Promise(this.#soon);
    if (this.#drag) return;
    this.#dragged = null;
    this.#draw();
  }
}

/**
 * A plane and its foot after a drag along its normal, within the scene; null where it does not say how far.
 *
 * @param {Pick<Shown, 'lens'|'plane'|'bounds'>} start
 * @param {number[]} foot
 * @param {Place} by
 */
export function moved({ lens, plane: { normal, distance: before }, bounds }, foot, by) {
  const wanted = draggedBy(lens, foot, normal, by);
  if (wanted === null) return null;
  const { min, max } = sweep(normal, bounds);
  const after = Math.min(Math.max(before + wanted, Math.min(min, before)), Math.max(max, before));
  return { plane: { normal, distance: after }, foot: add(foot, scale(normal, after - before)) };
}

/**
 * The same after a drag of the knob, which leaves the foot where it is.
 *
 * @param {Pick<Shown, 'lens'|'plane'>} start
 * @param {number[]} foot
 * @param {Place} by
 */
export function turned({ lens, plane }, foot, by) {
  const normal = turnedBy(lens, plane.normal, by);
  return { plane: { normal, distance: dot(normal, foot) }, foot };
}
