/** @import { DepthMap, Layers } from './depth-map.js' */
import { BITS, isStep } from './depth-map.js';

/** A place in a block is a whole number of these parts of its side: the block's middle, or the middle of a part. */
export const PLACES = 2 * BITS;
/** Of a number of 32 bits. */
export const PLACE_BITS = 12;

/** Triangles of the grid, three corners each, in an array that serves again. */
export class Triangles {
  /** @type {Uint16Array|Uint32Array} */
  indices = new Uint16Array(0);
  length = 0;

  /** Forgets all. 0xffff would begin a new primitive (OpenGL ES 3.0, section 2.8.1). */
  clear(corners, most) {
    const Indices = corners <= 0xffff ? Uint16Array : Uint32Array;
    if (this.indices.length < most || !(this.indices instanceof Indices)) this.indices = new Indices(most);
    this.length = 0;
  }

  add(a, b, c) {
    this.indices[this.length] = a;
    this.indices[this.length + 1] = b;
    this.indices[this.length + 2] = c;
    this.length += 3;
  }
}

/**
 * The triangles of each layer. The grid's corners are the blocks' centres, and a row and a column beyond each side, row
 * by row. No triangle of the layers near and far spans a step, and where these are the same, it is in `smooth` instead.
 * In the layer hidden all do, and the farthest of their corners is the last.
 *
 * @param {DepthMap} map
 * @param {Layers} layers
 * @param {{smooth: Triangles, near: Triangles, far: Triangles, hidden: Triangles}} triangles
 */
export function buildTriangles({ columns, rows, far }, layers, triangles) {
  const width = columns + 2;
  const cells = (columns + 1) * (rows + 1);
  for (const list of Object.values(triangles)) list.clear(width * (rows + 2), 6 * cells);
  for (let row = 0; row <= rows; row += 1) {
    const upper = Math.max(row - 1, 0) * columns;
    const lower = Math.min(row, rows - 1) * columns;
    for (let column = 0; column <= columns; column += 1) {
      const left = Math.max(column - 1, 0);
      const right = Math.min(column, columns - 1);
      const a = upper + left;
      const b = upper + right;
      const c = lower + left;
      const d = lower + right;
      const corner = row * width + column;
      if (hasTwo(layers, a) || hasTwo(layers, b) || hasTwo(layers, c) || hasTwo(layers, d)) {
        addSurface(triangles.near, layers.near, layers.nearSlope, corner, width, a, b, c, d);
        addSurface(triangles.far, layers.far, layers.farSlope, corner, width, a, b, c, d);
      } else {
        addSurface(triangles.smooth, layers.near, layers.nearSlope, corner, width, a, b, c, d);
      }
      if (!isStep(Math.min(far[a], far[b], far[c], far[d]), Math.max(far[a], far[b], far[c], far[d]))) continue;
      addHidden(triangles.hidden, far, layers.farSlope, [corner, corner + 1, corner + width], [a, b, c]);
      addHidden(triangles.hidden, far, layers.farSlope, [corner + width, corner + 1, corner + width + 1], [c, b, d]);
    }
  }
}

function hasTwo({ near, far }, block) {
  return near[block] !== far[block];
}

function addSurface(list, steps, slopes, corner, width, a, b, c, d) {
  const low = Math.min(steps[b], steps[c]);
  const high = Math.max(steps[b], steps[c]);
  const slope = Math.min(slopes[b], slopes[c]);
  const below = corner + width;
  const isUpper = !isStep(Math.min(steps[a], low), Math.max(steps[a], high), Math.min(slopes[a], slope));
  if (isUpper) list.add(corner, corner + 1, below);
  const isLower = !isStep(Math.min(steps[d], low), Math.max(steps[d], high), Math.min(slopes[d], slope));
  if (isLower) list.add(below, corner + 1, below + 1);
}

/** Of three corners, with their blocks. */
function addHidden(list, far, slopes, [first, second, third], [a, b, c]) {
  const least = Math.min(far[a], far[b], far[c]);
  if (!isStep(least, Math.max(far[a], far[b], far[c]), Math.min(slopes[a], slopes[b], slopes[c]))) return;
  if (far[a] === least) list.add(second, third, first);
  else if (far[b] === least) list.add(third, first, second);
  else list.add(first, second, third);
}

/**
 * What the shaders read of each block, two numbers of 32 bits. The first: `near` and `far` of the layers in 8 bits
 * each, and `mask`. The second: `far` of the map in 8 bits, and where the frame shows what lies behind the block, in
 * PLACES parts of a block, from the left in PLACE_BITS and from the top in as many.
 *
 * @param {DepthMap} map
 * @param {Layers} layers
 * @param {Uint32Array} into
 */
export function packBlocks(map, { near, far, mask, farthest }, into) {
  const { columns } = map;
  for (let i = 0; i < near.length; i += 1) {
    into[2 * i] = near[i] | (far[i] << 8) | (mask[i] << 16);
    const behind = farthest[i];
    const row = Math.floor(behind / columns);
    // Of a block, or of a part of it that shows what is farther.
    let x = PLACES / 2;
    let y = PLACES / 2;
    if (map.near[behind] !== map.far[behind]) {
      const bit = Math.min(countOnes(map.mask[behind]), BITS * BITS - 1);
      x = 2 * (bit % BITS) + 1;
      y = 2 * Math.floor(bit / BITS) + 1;
    }
    x += PLACES * (behind - row * columns);
    y += PLACES * row;
    into[2 * i + 1] = map.far[i] | (x << 8) | (y << (8 + PLACE_BITS));
  }
}

/** Of the bits from the lowest, until one is not set. */
function countOnes(mask) {
  return 31 - Math.clz32(~mask & (mask + 1));
}
