import { distance, dot, mix, subtract } from '../base/vectors.js';
import { placeOf, viewDirection } from './camera.js';

/**
 * @import { Place } from './drags.js'
 * @import { Area, Lens } from './plane-drags.js'
 */

/** What is nearer to the eye is not seen, in parts of the way to the focus. */
const NEAREST = 1e-6;

/**
 * Where a line through points of the world is seen in a view, in pieces: what lies behind the eye is left out.
 *
 * @param {Lens} lens
 * @param {number[][]} points
 * @returns {Place[][]}
 */
export function seenPath({ camera, width, height }, points) {
  const ahead = viewDirection(camera);
  const nearest = NEAREST * distance(camera.eye, camera.focus);
  const depthOf = (point) => dot(subtract(point, camera.eye), ahead) - nearest;
  const seen = (point) => {
    const { x, y } = placeOf(camera, width / height, point);
    return { x: (x + 1) * width / 2, y: (y + 1) * height / 2 };
  };
  const cut = (a, b) => mix(a, b, depthOf(a) / (depthOf(a) - depthOf(b)));
  return pieces(points, (a, b) => {
    const isBefore = depthOf(a) > 0;
    const ends = depthOf(b) > 0;
    if (!isBefore && !ends) return null;
    return [seen(isBefore ? a : cut(a, b)), seen(ends ? b : cut(a, b))];
  });
}

/**
 * What of a line is in an area, in pieces.
 *
 * @param {Place[]} line
 * @param {Area} area
 * @returns {Place[][]}
 */
export function clippedPath(line, area) {
  return pieces(line, (a, b) => clipped(a, b, area));
}

/** The pieces of a line, each of whose parts becomes another, or none. */
function pieces(points, part) {
  /** @type {Place[][]} */
  const all = [];
  for (let i = 1; i < points.length; i += 1) {
    const ends = part(points[i - 1], points[i]);
    if (!ends) continue;
    const last = all.at(-1)?.at(-1);
    if (last && last.x === ends[0].x && last.y === ends[0].y) all.at(-1)?.push(ends[1]);
    else all.push(ends);
  }
  return all;
}

/** As Liang and Barsky clip lines. @returns {?Place[]} */
function clipped(a, b, { left, top, right, bottom }) {
  const along = { x: b.x - a.x, y: b.y - a.y };
  let [from, to] = [0, 1];
  for (const [way, room] of [
    [-along.x, a.x - left], [along.x, right - a.x], [-along.y, a.y - top], [along.y, bottom - a.y],
  ]) {
    if (way === 0 && room < 0) return null;
    if (way < 0) from = Math.max(from, room / way);
    if (way > 0) to = Math.min(to, room / way);
  }
  if (from > to) return null;
  const at = (part) => ({ x: a.x + part * along.x, y: a.y + part * along.y });
  return [from === 0 ? a : at(from), to === 1 ? b : at(to)];
}

/** The place in the middle of the longest of some lines; null without any. @param {Place[][]} lines @returns {?Place} */
export function middleOfPaths(lines) {
  const lengths = lines.map(lengthOf);
  const longest = lines[lengths.indexOf(Math.max(...lengths))];
  if (!longest) return null;
  let left = lengthOf(longest) / 2;
  for (let i = 1; i < longest.length; i += 1) {
    const [a, b] = [longest[i - 1], longest[i]];
    const length = Math.hypot(b.x - a.x, b.y - a.y);
    if (length >= left && length > 0) return { x: a.x + (b.x - a.x) * left / length, y: a.y + (b.y - a.y) * left / length };
    left -= length;
  }
  return longest[0];
}

/** @param {Place[]} line */
function lengthOf(line) {
  return line.slice(1).reduce((sum, { x, y }, i) => sum + Math.hypot(x - line[i].x, y - line[i].y), 0);
}
