import { say, written } from './texts.js';

/**
 * @import { StateDocument } from './protocol.js'
 *
 * What a pick has snapped to, in the space of its node; how many points, and which, is the protocol's.
 *
 * @typedef {'point'|'vertex'|'midpoint'|'center'|'edge'|'loop'|'plane'} Snap
 * @typedef {{node: number, snap: Snap, points: number[][]}} Feature
 *
 * The same with where it is in the world.
 *
 * @typedef {{feature: Feature, point: number[], line: number[][]}} Snapped
 *
 * @typedef {'distance'|'parallel'|'angle'|'radius'|'length'} Kind
 *
 * What is measured, and what that comes to: `value` is in units of the scene, or in degrees.
 *
 * @typedef {{kind: Kind, picks: Feature[], value?: number, components?: number[], line?: number[][], problem?: string}} Measure
 *
 * Metres per unit of the scene, and what lengths are shown in.
 *
 * @typedef {{metres: number, shown: string}} Unit
 */

/** The tools with their names, in the order in which they are shown. @type {Record<Kind, string>} */
export const TOOLS = {
  distance: 'measures.distance',
  parallel: 'measures.parallel',
  angle: 'measures.angle',
  radius: 'measures.radius',
  length: 'measures.length',
};

/** What a pick has snapped to, in words. @type {Record<Snap, string>} */
export const SNAPS = {
  point: 'snap.point',
  vertex: 'snap.vertex',
  midpoint: 'snap.midpoint',
  center: 'snap.center',
  edge: 'snap.edge',
  loop: 'snap.loop',
  plane: 'snap.plane',
};

/** What has a direction: two of them make an angle. @type {Snap[]} */
const DIRECTED = ['edge', 'plane', 'center'];
/** What points of a circle are, where it is not known as one. @type {Snap[]} */
const POINTS = ['vertex', 'midpoint', 'edge', 'point'];

/** @param {Feature} pick */
const isDirected = ({ snap }) => DIRECTED.includes(snap);

/**
 * What a tool asks for next: in words, and what a pick may snap to, all but loops where that is left out. Null: the picks
 * are enough.
 *
 * @param {Kind} kind
 * @param {Feature[]} picks so far
 * @param {{isLoop?: boolean, isByPoints?: boolean}} [options] whether the length of an edge is that of all its loop, and
 *   whether three of its points define a circle
 * @returns {?{ask: string, to?: Snap[]}}
 */
export function nextPick(kind, picks, { isLoop = false, isByPoints = false } = {}) {
  switch (kind) {
    case 'distance':
      return [{ ask: 'measures.firstPoint' }, { ask: 'measures.secondPoint' }][picks.length] ?? null;
    case 'parallel':
      return [{ ask: 'measures.base', to: DIRECTED }, { ask: 'measures.to' }][picks.length] ?? null;
    case 'angle':
      return nextOfAngle(picks);
    case 'radius':
      if (isByPoints) return nextOfCircle(picks);
      return picks.length === 0 ? { ask: 'measures.circle', to: ['center'] } : null;
    default:
      if (picks.length > 0) return null;
      return isLoop ? { ask: 'measures.anyOfLoop', to: ['loop'] } : { ask: 'measures.edge', to: ['edge'] };
  }
}

/** Of two directions, or of three points. @param {Feature[]} picks */
function nextOfAngle(picks) {
  if (picks.length === 0) return { ask: 'measures.firstSide' };
  if (picks.length === 1) return { ask: isDirected(picks[0]) ? 'measures.secondSide' : 'measures.corner' };
  return picks.length === 2 && !picks.every(isDirected) ? { ask: 'measures.thirdPoint' } : null;
}

/** Of three of its points. @param {Feature[]} picks */
function nextOfCircle(picks) {
  const ask = ['measures.firstPoint', 'measures.secondPoint', 'measures.thirdPoint'][picks.length];
  return ask ? { ask, to: POINTS } : null;
}

/** Metres of each unit in which lengths are shown. @type {Record<string, number>} */
const METRES = { mm: 0.001, cm: 0.01, m: 1, in: 0.0254 };

/** The units in which lengths are shown. */
export const UNITS = Object.keys(METRES);

/** Metres to which a length is shown: [below, to]. */
const EXACT = [[1e-5, 1e-7], [0.1, 1e-5], [1, 1e-4], [100, 1e-3], [Infinity, 1e-2]];

/**
 * A length of so many units of the scene, in the unit that is shown: a gap to 0.01 mm, what is larger less exactly.
 *
 * @param {number} value
 * @param {Unit} unit
 * @param {number} [whole] the length that it is a part of, with as many digits
 */
export function lengthIn(value, { metres, shown }, whole = value) {
  const one = METRES[shown];
  const size = Math.abs(whole * metres);
  // Zero has no more digits.
  const [, exact] = size === 0 ? [0, 1] : /** @type {number[]} */ (EXACT.find(([below]) => size < below));
  const digits = Math.max(Math.floor(Math.log10(one / exact) + 1e-9), 0);
  const rounded = Math.round(value * metres / one * 10 ** digits);
  // Not the minus of a zero.
  return written(rounded / 10 ** digits + 0, digits, shown);
}

/**
 * The value of a measure in words; '' where it has none.
 *
 * @param {Measure} measure
 * @param {Unit} unit
 */
export function valueWords({ kind, value }, unit) {
  if (value === undefined) return '';
  return kind === 'angle' ? say('measures.degrees', { degrees: written(value, 1) }) : lengthIn(value, unit);
}

/**
 * How far the second point of a distance lies from the first along each axis, in words; null where that is unknown.
 *
 * @param {Measure} measure
 * @param {Unit} unit
 * @returns {?Record<string, string>}
 */
export function componentWords({ components, value }, unit) {
  if (!components) return null;
  const [x, y, z] = components.map((along) => lengthIn(along, unit, value));
  return { x, y, z };
}

/**
 * The measures of the state by name, each with what it comes to.
 *
 * @param {Pick<StateDocument, 'measures'|'measured'>} state
 * @returns {Record<string, Measure>}
 */
export function measuresOf({ measures, measured }) {
  return Object.fromEntries(Object.entries(measures).map(([name, measure]) => [name, { ...measure, ...measured[name] }]));
}
