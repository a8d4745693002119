/**
 * Entries that have an `order`, or none.
 *
 * @typedef {Object<string, {order?: number}>} Ordered
 */

/** @param {string} a @param {string} b */
const byCodeUnits = (a, b) => Number(a > b) - Number(a < b);

/**
 * The names: those with an `order` first, by that, then the others, by name.
 *
 * @param {Ordered} entries
 * @param {(a: string, b: string) => number} [byName]
 */
export function namesInOrder(entries, byName = byCodeUnits) {
  const orderOf = (name) => entries[name].order ?? Infinity;
  // Two without an order differ by NaN.
  return Object.keys(entries).sort((a, b) => (orderOf(a) - orderOf(b)) || byName(a, b));
}

/**
 * What of entries is to be changed for one to change places with the one before or after it; null at the ends.
 *
 * @param {Ordered} entries
 * @param {string[]} names in their order
 * @param {string} name
 * @param {1|-1} by
 */
export function moved(entries, names, name, by) {
  const at = names.indexOf(name);
  const other = names[at + by];
  if (other === undefined) return null;
  const after = [...names];
  [after[at], after[at + by]] = [other, name];
  const changed = after.map((one, order) => ({ one, order }))
    .filter(({ one, order }) => entries[one].order !== order);
  return Object.fromEntries(changed.map(({ one, order }) => [one, { order }]));
}

/** A word with the first number that none of the names has. */
export function unusedName(word, names) {
  let number = 1;
  while (names.includes(`${word} ${number}`)) number += 1;
  return `${word} ${number}`;
}

/** A name, or where that is taken the first free one of a word. */
export function freeName(name, names, word = name) {
  return names.includes(name) ? unusedName(word, names) : name;
}
