/**
 * @import { Snap } from '../base/measures.js'
 * @import { Place } from '../navigation/drags.js'
 */

/** What is drawn about a place, by what a pick has snapped to there. @type {Record<Snap, string>} */
export const SIGNS = {
  point: 'M-6-6L6 6M6-6L-6 6',
  vertex: 'M-6-6H6V6H-6z',
  midpoint: 'M0-8L8 6H-8z',
  center: 'M-8 0a8 8 0 1 0 16 0a8 8 0 1 0-16 0M-3 0h6M0-3v6',
  edge: 'M0-8L8 0 0 8-8 0z',
  loop: 'M0-8L8 0 0 8-8 0z',
  plane: 'M-9 5L-4-5H9L4 5z',
};

const inWords = (number) => number.toFixed(1);

/** Lines as the `d` of an SVG path. @param {Place[][]} lines */
export function pathData(lines) {
  return lines.map((line) => `M${line.map(({ x, y }) => `${inWords(x)} ${inWords(y)}`).join('L')}`).join('');
}

/** Dots, for a path with round ends. @param {Place[]} places */
export function dotData(places) {
  return places.map(({ x, y }) => `M${inWords(x)} ${inWords(y)}h0`).join('');
}

/**
 * Shows in an SVG what a pick would snap to: its line, and the sign of its kind.
 *
 * @param {Element} svg with a `.line` and a `.sign`
 * @param {?{snap: Snap, at: ?Place, lines: Place[][]}} snapped
 */
export function showSign(svg, snapped) {
  const line = svg.querySelector('.line');
  const sign = svg.querySelector('.sign');
  line?.setAttribute('d', pathData(snapped?.lines ?? []));
  sign?.toggleAttribute('hidden', !snapped?.at);
  if (!snapped?.at) return;
  sign?.setAttribute('d', SIGNS[snapped.snap]);
  sign?.setAttribute('transform', `translate(${inWords(snapped.at.x)} ${inWords(snapped.at.y)})`);
}
