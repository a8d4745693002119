/**
 * @typedef {{columns: number, rows: number, scale: number}} DepthMapSize in blocks; `scale` is the reciprocal distance
 *   of the nearest surface along the view, in 1/scene unit
 *
 * @typedef {DepthMapSize & {near: Uint8Array, far: Uint8Array, mask: Uint16Array}} DepthMap
 *   How far away the surfaces of a frame are, in blocks of its pixels, rows from the top down. A reciprocal distance of
 *   STEPS is that of `scale`. Where an edge goes through a block, `near` is that of the nearer side, and `far` that of
 *   the farther one; elsewhere they are equal. Bit BITS · row + column of its `mask`, from its top left, is set where that part of it shows what is
 *   nearer.
 *
 * @typedef {{
 *   near: Uint8Array, far: Uint8Array, mask: Uint16Array, farthest: Uint32Array, nearSlope: Uint8Array,
 *   farSlope: Uint8Array,
 * }} Layers
 *   The blocks as the two layers of the grid have them: where an edge goes through a block or beside it, the one has
 *   what is nearer, and the other what is farther. There a part of a block belongs to the first layer if its bit in
 *   `mask` is set; elsewhere both layers are the same, and blocks belong to both. `farthest` is the one of those up to
 *   two blocks beside it, or itself, that shows what is farthest. A slope is by how much the layer rises from a block to
 *   the next beside and below it, together: on the side where that is less.
 */

/** The nearest surface of a frame; 0: infinitely far. */
export const STEPS = 255;
/** Of a block's mask, in each direction. */
export const BITS = 4;

const MOST_BLOCKS = 160;
/** A triangle of the grid that spans more steps, beside twice its slope, is no surface, nor one that reaches infinity. */
const GAP = 16;
/** An inflater keeps all that it makes of a piece: of a small one not much. */
const PIECE_BYTES = 1024;

/** @returns {boolean} whether no surface goes from one reciprocal distance to the other, in steps */
export function isStep(low, high, slope = 0) {
  return high - low > GAP + 2 * slope || (low === 0 && high > 0);
}

/**
 * Of the format that `warp::encode` writes (render/warp/depth_map.hpp).
 *
 * @param {Uint8Array<ArrayBuffer>} bytes
 * @param {DepthMapSize} size
 * @returns {Promise<?DepthMap>} null where the bytes are not those of a map of this size
 */
export async function decodeDepthMap(bytes, { columns, rows, scale }) {
  const isSize = [columns, rows].every((count) => Number.isInteger(count) && count >= 1 && count <= MOST_BLOCKS);
  if (!isSize || !Number.isFinite(scale)) return null;
  const blocks = columns * rows;
  const nearerAt = blocks + Math.ceil(blocks / 8);
  const plain = await inflated(bytes, nearerAt + 3 * blocks);
  if (!plain || plain.length < nearerAt || (plain.length - nearerAt) % 3 !== 0) return null;
  const edges = (plain.length - nearerAt) / 3;
  const masksAt = nearerAt + edges;

  const near = new Uint8Array(blocks);
  const far = new Uint8Array(blocks);
  const mask = new Uint16Array(blocks).fill(0xffff);
  let edge = 0;
  for (let row = 0, i = 0; row < rows; row += 1) {
    for (let column = 0; column < columns; column += 1, i += 1) {
      far[i] = predictedFar(far, columns, column, row) + unfolded(plain[i]);
      near[i] = far[i];
      if (((plain[blocks + (i >> 3)] >> (i & 7)) & 1) === 0) continue;
      if (edge === edges) return null;
      const left = column > 0 ? near[i - 1] : 0;
      const upper = row > 0 ? near[i - columns] : 0;
      near[i] = Math.max(left, upper) + unfolded(plain[nearerAt + edge]);
      mask[i] = plain[masksAt + 2 * edge] | (plain[masksAt + 2 * edge + 1] << 8);
      if (near[i] <= far[i]) return null;
      edge += 1;
    }
  }
  return edge === edges ? { columns, rows, scale, near, far, mask } : null;
}

/** Median of left, upper, and the plane through left, upper and upper left (Weinberger et al., "LOCO-I", 1996). */
function predictedFar(far, columns, column, row) {
  const i = row * columns + column;
  if (row === 0) return column === 0 ? 0 : far[i - 1];
  if (column === 0) return far[i - columns];
  const left = far[i - 1];
  const upper = far[i - columns];
  const plane = left + upper - far[i - columns - 1];
  return Math.max(Math.min(left, upper), Math.min(Math.max(left, upper), plane));
}

/** A difference of either sign, of one without. */
function unfolded(difference) {
  return difference & 1 ? -(difference >> 1) - 1 : difference >> 1;
}

/**
 * @param {Uint8Array<ArrayBuffer>} bytes in the format of zlib (RFC 1950)
 * @param {number} most
 * @returns {Promise<?Uint8Array>} null where they are damaged, or would be more than `most`
 */
async function inflated(bytes, most) {
  let at = 0;
  const pieces = new ReadableStream({
    pull(controller) {
      if (at >= bytes.length) controller.close();
      else controller.enqueue(bytes.subarray(at, at + PIECE_BYTES));
      at += PIECE_BYTES;
    },
  });
  const plain = new Uint8Array(most);
  let length = 0;
  const reader = pieces.pipeThrough(new DecompressionStream('deflate')).getReader();
  try {
    for (;;) {
      const { done, value } = await reader.read();
      if (done) return plain.subarray(0, length);
      if (length + value.length > most) {
        reader.cancel().catch(() => {});
        return null;
      }
      plain.set(value, length);
      length += value.length;
    }
  } catch {
    return null;
  }
}

/** So many blocks beside each are looked at for what is farthest. */
const REACH = 2;

/**
 * What each block has beside it is gathered first from its row, then from the rows.
 *
 * @param {DepthMap} map
 * @returns {Layers}
 */
export function layersOf({ columns, rows, near, far, mask }) {
  const blocks = columns * rows;
  const layers = {
    near: near.slice(),
    far: far.slice(),
    mask: mask.slice(),
    farthest: new Uint32Array(blocks),
    nearSlope: slopesOf(near, columns, rows),
    farSlope: slopesOf(far, columns, rows),
  };
  const { nearSlope, farSlope } = layers;
  const nearest = new Uint32Array(blocks);
  const lowest = new Uint32Array(blocks);
  const farthest = new Uint32Array(blocks);
  for (let row = 0, i = 0; row < rows; row += 1) {
    for (let column = 0; column < columns; column += 1, i += 1) {
      const left = column > 0 ? i - 1 : i;
      const right = column < columns - 1 ? i + 1 : i;
      nearest[i] = higher(near, higher(near, left, i), right);
      lowest[i] = lower(far, lower(far, left, i), right);
      farthest[i] = i - Math.min(column, REACH);
      for (let k = farthest[i] + 1; k <= i + Math.min(columns - 1 - column, REACH); k += 1) {
        farthest[i] = farther(near, far, farthest[i], k);
      }
    }
  }
  for (let row = 0, i = 0; row < rows; row += 1) {
    const above = row > 0 ? columns : 0;
    const below = row < rows - 1 ? columns : 0;
    for (let column = 0; column < columns; column += 1, i += 1) {
      let beside = farthest[i - columns * Math.min(row, REACH)];
      for (let k = -Math.min(row, REACH) + 1; k <= Math.min(rows - 1 - row, REACH); k += 1) {
        beside = farther(near, far, beside, farthest[i + columns * k]);
      }
      layers.farthest[i] = farther(near, far, i, beside);
      if (near[i] !== far[i]) continue;
      const high = higher(near, i, higher(near, higher(near, nearest[i - above], nearest[i]), nearest[i + below]));
      const low = lower(far, i, lower(far, lower(far, lowest[i - above], lowest[i]), lowest[i + below]));
      if (isStep(near[i], near[high], Math.min(nearSlope[i], nearSlope[high]))) {
        layers.near[i] = near[high];
        layers.mask[i] = 0; // it belongs to the other layer
      } else if (isStep(far[low], far[i], Math.min(farSlope[i], farSlope[low]))) {
        layers.far[i] = far[low];
      }
    }
  }
  return layers;
}

/** Of two blocks; the first where they are the same. */
const higher = (steps, a, b) => (steps[b] > steps[a] ? b : a);
const lower = (steps, a, b) => (steps[b] < steps[a] ? b : a);

/** Reciprocal distances are linear in the frame where a surface is a plane: it rises on both sides alike. */
function slopesOf(steps, columns, rows) {
  const slopes = new Uint8Array(steps.length);
  const step = columns > 1 ? 1 : 0;
  const line = rows > 1 ? columns : 0;
  for (let row = 0, i = 0; row < rows; row += 1) {
    for (let column = 0; column < columns; column += 1, i += 1) {
      // At a side of the frame the other one counts.
      const left = Math.abs(steps[i] - steps[column > 0 ? i - step : i + step]);
      const right = Math.abs(steps[i] - steps[column + 1 < columns ? i + step : i - step]);
      const above = Math.abs(steps[i] - steps[row > 0 ? i - line : i + line]);
      const below = Math.abs(steps[i] - steps[row + 1 < rows ? i + line : i - line]);
      slopes[i] = Math.min(Math.min(left, right) + Math.min(above, below), STEPS);
    }
  }
  return slopes;
}

/** Of two blocks; the first where they are as far. */
function farther(near, far, a, b) {
  return reach(near[b], far[b]) < reach(near[a], far[a]) ? b : a;
}

/** The middle of a block with an edge has maybe the colour of what is nearer. */
function reach(near, far) {
  return near === far ? far : far + GAP;
}

/**
 * Interpolated among the centres of blocks where no edge and no step lies between them, else that of the block.
 *
 * @param {DepthMap} map
 * @param {number} x of the frame, from 0 (left) to 1 (right)
 * @param {number} y from 0 (top) to 1 (bottom)
 * @returns {number} 1 / distance along the view, in 1/scene unit; 0: infinitely far
 */
export function reciprocalDistanceAt({ columns, rows, scale, near, far, mask }, x, y) {
  const within = (value, count) => Math.min(Math.max(value, 0), count - 1);
  const u = within(x * columns - 0.5, columns);
  const v = within(y * rows - 0.5, rows);
  const [left, top] = [Math.floor(u), Math.floor(v)];
  const [right, bottom] = [within(left + 1, columns), within(top + 1, rows)];
  const four = [top * columns + left, top * columns + right, bottom * columns + left, bottom * columns + right];
  const [a, b, c, d] = four.map((block) => near[block]);
  const hasEdge = four.some((block) => near[block] !== far[block]);
  if (!hasEdge && !isStep(Math.min(a, b, c, d), Math.max(a, b, c, d))) {
    const mixed = (from, to, part) => from + (to - from) * part;
    return (scale / STEPS) * mixed(mixed(a, b, u - left), mixed(c, d, u - left), v - top);
  }
  const column = within(Math.floor(x * columns * BITS), columns * BITS);
  const row = within(Math.floor(y * rows * BITS), rows * BITS);
  const block = Math.floor(row / BITS) * columns + Math.floor(column / BITS);
  const isNear = (mask[block] >> (BITS * (row % BITS) + (column % BITS))) & 1;
  return (scale / STEPS) * (isNear ? near : far)[block];
}
