/**
 * @import { Area } from '../navigation/plane-drags.js'
 * @import { Place } from '../navigation/drags.js'
 *
 * A chip that is to lie at a place, as large as it is; `isBeside`: it would hide its measure.
 *
 * @typedef {{name: string, at: Place, width: number, height: number, isBeside?: boolean}} Wanted
 *
 * Where its middle is, and in which of the places about the wanted one.
 *
 * @typedef {{name: string, at: Place, x: number, y: number, slot: number}} Laid
 */

/** Pixels between chips. */
const GAP = 4;
const RINGS = 10;
/** Ways from the wanted place, those first that leave a line most free: rows of text lie well above each other. */
const WAYS = [[0, -1], [0, 1], [1, 0], [-1, 0], [0.75, -1], [-0.75, 1], [-0.75, -1], [0.75, 1]];
/** From the wanted place, in heights of a chip: the place itself, and rings about it. */
const SLOTS = [[0, 0], ...Array.from({ length: RINGS }, (_, ring) => WAYS.map(([x, y]) => [x * (ring + 1), y * (ring + 1)])).flat()];

/**
 * Lays chips out so that none covers another and all lie in the area: each where it is wanted, or else near to it. One
 * that was laid out before stays in its slot while that is free; one for which nothing is free is left out.
 *
 * @param {Wanted[]} wanted
 * @param {Area} area
 * @param {Map<string, number>} before the slots of the last time, by name
 * @returns {Laid[]} in the order in which they were laid
 */
export function layOut(wanted, area, before) {
  /** @type {Laid[]} */
  const laid = [];
  /** @type {Area[]} */
  const taken = [];
  const lay = (chip, slots) => {
    for (const slot of slots) {
      const place = placeAt(chip, slot, area);
      const box = place && boxOf(place, chip);
      if (!box || taken.some((other) => overlap(box, other))) continue;
      taken.push(box);
      laid.push({ name: chip.name, at: chip.at, ...place, slot });
      return true;
    }
    return false;
  };
  const first = [...SLOTS.keys()];
  const others = [...first.slice(1), 0];
  /** @param {Wanted} one */
  const stays = ({ name, isBeside }) => before.has(name) && !(isBeside && before.get(name) === 0);
  const moved = wanted.filter(stays).filter((chip) => !lay(chip, [before.get(chip.name)]));
  for (const chip of [...moved, ...wanted.filter((one) => !stays(one))]) lay(chip, chip.isBeside ? others : first);
  return laid;
}

/** The middle of a chip in a slot, moved into the area; null where it has no room, or where that is another slot's. */
function placeAt({ at, width, height }, slot, area) {
  const [right, down] = SLOTS[slot];
  const step = height + GAP;
  // Sideways a chip is to clear the place by its width.
  const wanted = { x: at.x + Math.sign(right) * (width / 2) + right * step, y: at.y + down * step };
  const x = within(wanted.x, area.left + width / 2, area.right - width / 2);
  const y = within(wanted.y, area.top + height / 2, area.bottom - height / 2);
  const isMoved = Math.abs(y - wanted.y) > step / 2 || Math.abs(x - wanted.x) > width;
  return area.right - area.left < width || area.bottom - area.top < height || (slot > 0 && isMoved) ? null : { x, y };
}

const within = (value, min, max) => Math.min(Math.max(value, min), max);

/** @returns {Area} with half of the gap around it */
function boxOf({ x, y }, { width, height }) {
  const [half, tall] = [(width + GAP) / 2, (height + GAP) / 2];
  return { left: x - half, top: y - tall, right: x + half, bottom: y + tall };
}

/** @param {Area} a @param {Area} b */
const overlap = (a, b) => a.left < b.right && b.left < a.right && a.top < b.bottom && b.top < a.bottom;

/**
 * The lines from a chip's edge to its wanted place: none where the chip lies there, or else one.
 *
 * @param {Laid} laid
 * @param {{width: number, height: number}} size
 */
export function leaderOf({ at, x, y }, { width, height }) {
  const [right, down] = [at.x - x, at.y - y];
  const out = Math.max(Math.abs(right) / (width / 2), Math.abs(down) / (height / 2));
  return out <= 1 ? [] : [[{ x: x + right / out, y: y + down / out }, at]];
}
