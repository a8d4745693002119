/** @import { ClientHello, FrameHeader, ServerError, ServerStats, StateDocument } from './protocol.js' */

/**
 * Where the connection stands; `reason`: why the server refused it.
 *
 * @typedef {{name: 'starting'|'connecting'|'open'|'waiting'|'refused', retryMs?: number, hadOpened?: boolean,
 *   reason?: {code?: string, message: string}}} Phase
 *
 * What the page knows: what the server made it while connected, the state as last heard, the header last drawn, whether
 * that frame is of this connection, whether what was asked of the server has waited long for its answer, what covers the view's sides, what the server measures, which of the sections has
 * a handle in the picture, whether a finger points, and the cue that is prepared, with its camera where that is another.
 *
 * @typedef {{phase: Phase, role?: ClientHello['role'], client?: string, steers: boolean, state: ?StateDocument,
 *   revision: number, header: ?FrameHeader, hasPicture: boolean, isLate: boolean,
 *   inset: {top: number, right: number, bottom: number, left: number}, stats: ?ServerStats, language: string,
 *   handled: ?string, points: boolean, prepares: ?string, preparedCamera?: StateDocument['cues'][string]['camera']}} Now
 */

/**
 * Gives a function that calls `show` with what `select` picks, if one of that is another than the last time.
 *
 * @template T
 * @param {(now: T) => *[]} select of always the same length
 * @param {(...picked: *[]) => void} show
 * @returns {(now: T) => void}
 */
export function onChange(select, show) {
  let last;
  return (now) => {
    const picked = select(now);
    if (last?.every((value, i) => Object.is(value, picked[i]))) return;
    last = picked;
    show(...picked);
  };
}

/** One place for what the page knows. What is shown of it follows in the next display frame. */
export class Store {
  /** @type {Now} */
  now = {
    phase: { name: 'starting' }, steers: false, state: null, revision: 0, header: null, hasPicture: false, isLate: false,
    inset: { top: 0, right: 0, bottom: 0, left: 0 }, stats: null,
    language: 'en', handled: null, points: false, prepares: null,
  };
  /** @type {((now: Now) => void)[]} */
  #subscribers = [];
  #waits = false;

  /** @param {Partial<Now>} members */
  set(members) {
    this.now = { ...this.now, ...members };
    if (this.#waits) return;
    this.#waits = true;
    requestAnimationFrame(() => {
      this.#waits = false;
      for (const show of this.#subscribers) show(this.now);
    });
  }

  /**
   * As onChange().
   *
   * @param {(now: Now) => *[]} select
   * @param {(...picked: *[]) => void} show
   */
  subscribe(select, show) {
    this.#subscribers.push(onChange(select, show));
  }
  /** Promises the next value of `select` that is another than `last`, and not undefined. */
  next(select, last) {
    return new Promise((resolve) => {
      const look = (now) => {
        const value = select(now);
        if (value === last || value === undefined) return;
        this.#subscribers = this.#subscribers.filter((other) => other !== look);
        resolve(value);
      };
      this.#subscribers.push(look);
    });
  }
}
