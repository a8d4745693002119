/** @import { StateDocument } from './protocol.js' */

/**
 * Whether a node with a hinge is open, or on its way there.
 *
 * @param {number} id
 * @param {Pick<StateDocument, 'nodes'|'swings'>} state
 */
export function isOpen(id, { nodes, swings }) {
  return swings[id] ? swings[id].to > 0 : Boolean(nodes[id]?.matrix);
}
