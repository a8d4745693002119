import { lookedAround, panned, rotated, zoomed } from './camera-moves.js';
import { looksAround } from './drags.js';

/** @import { Camera } from './camera.js' */
/** @import { NavigationContext } from './drags.js' */

/**
 * @typedef {object} KeyOperation
 * @property {'rotate'|'pan'|'zoom'|'home'|'none'} kind
 * @property {number[]} by rotate: degrees to the right and down; pan: parts of the view's height; zoom: the first
 *   divides the distance
 */

/** `key`: `KeyboardEvent.key`. Where `shift` is left out, it does not matter whether Shift is held. */
const KEYS = [
  { key: 'ArrowLeft', shift: false, kind: 'rotate', by: [-5, 0] },
  { key: 'ArrowRight', shift: false, kind: 'rotate', by: [5, 0] },
  { key: 'ArrowUp', shift: false, kind: 'rotate', by: [0, -5] },
  { key: 'ArrowDown', shift: false, kind: 'rotate', by: [0, 5] },
  { key: 'ArrowLeft', shift: true, kind: 'pan', by: [-0.05, 0] },
  { key: 'ArrowRight', shift: true, kind: 'pan', by: [0.05, 0] },
  { key: 'ArrowUp', shift: true, kind: 'pan', by: [0, -0.05] },
  { key: 'ArrowDown', shift: true, kind: 'pan', by: [0, 0.05] },
  { key: '+', kind: 'zoom', by: [1.1] }, // which on many keyboards is typed with Shift
  { key: '-', kind: 'zoom', by: [1 / 1.1] },
  { key: 'Home', kind: 'home', by: [] },
  { key: 'w', kind: 'none', by: [] },
  { key: 's', kind: 'none', by: [] },
  { key: 'Escape', kind: 'none', by: [] },
];

/**
 * Returns what a pressed key does to the camera; null for `f`, which fits what the server alone knows, and for keys
 * without a binding. The number keys of the styles have none.
 *
 * @param {{key: string, shiftKey?: boolean}} message
 * @returns {?KeyOperation}
 */
export function keyOperation({ key, shiftKey = false }) {
  const row = KEYS.find((candidate) => candidate.key === key &&
    (candidate.shift === undefined || candidate.shift === shiftKey));
  return row ? { kind: /** @type {KeyOperation['kind']} */ (row.kind), by: row.by } : null;
}

/**
 * Returns the camera after an operation. Speeds do not apply. Null for Home without a `context.home`.
 *
 * @param {KeyOperation} operation
 * @param {Camera} camera
 * @param {NavigationContext} context
 * @returns {?Camera}
 */
export function applyKeyOperation({ kind, by: [x, y] }, camera, context) {
  switch (kind) {
    case 'rotate':
      return (looksAround(camera, context) ? lookedAround : rotated)(camera, x, y, context.keepUpright);
    case 'pan':
      return panned(camera, x, y);
    case 'zoom':
      return zoomed(camera, x, context.radius);
    case 'home':
      return context.home ?? null;
    default:
      return camera;
  }
}

/**
 * The digit 1 to 9 that a key types, else the one that is printed on it: with Shift, or on a French keyboard, it types
 * another sign. 0 for other keys.
 *
 * @param {{key: string, code: string}} message
 */
export function numberOf({ key, code }) {
  const digit = /^[1-9]$/.exec(key)?.[0] ?? /^Digit([1-9])$/.exec(code)?.[1];
  return Number(digit ?? 0);
}
