import { isObject } from './merge-patch.js';
import { byteLength } from './utf8.js';

/**
 * @import { StatePatch } from './protocol.js'
 *
 * Of a section, an entry that it has by name, or all of it.
 *
 * @typedef {{section: string, name?: string, value: *}} Piece
 */

/** So many bytes of a message are left for its own members; see the server's limits. */
const MOST_BYTES = 60_000;

/**
 * A patch as patches that messages may hold, one after the other; at least one. A long one is divided between the
 * entries of its sections, and what is removed comes first: it makes room for what is added.
 *
 * @param {StatePatch} patch
 * @returns {StatePatch[]}
 */
export function patchParts(patch) {
  if (byteLength(JSON.stringify(patch)) <= MOST_BYTES) return [patch];
  const parts = [/** @type {Piece[]} */ ([])];
  let bytes = 0;
  for (const piece of piecesOf(patch).sort((a, b) => Number(b.value === null) - Number(a.value === null))) {
    const size = byteLength(JSON.stringify(joined([piece])));
    if (bytes > 0 && bytes + size > MOST_BYTES) {
      parts.push([]);
      bytes = 0;
    }
    parts[parts.length - 1].push(piece);
    bytes += size;
  }
  return parts.map(joined);
}

/** @param {StatePatch} patch @returns {Piece[]} */
function piecesOf(patch) {
  return Object.entries(/** @type {object} */ (patch)).flatMap(([section, all]) => {
    const entries = isObject(all) ? Object.entries(all) : [];
    return entries.length > 0 ? entries.map(([name, value]) => ({ section, name, value })) : [{ section, value: all }];
  });
}

/** @param {Piece[]} pieces @returns {StatePatch} */
function joined(pieces) {
  const values = new Map();
  const entries = new Map();
  for (const { section, name, value } of pieces) {
    if (name === undefined) values.set(section, value);
    else if (entries.has(section)) entries.get(section).push([name, value]);
    else entries.set(section, [[name, value]]);
  }
  // As with any name, there may be an entry called "__proto__".
  return Object.fromEntries([...values, ...[...entries].map(([section, all]) => [section, Object.fromEntries(all)])]);
}
