/** Their hues can be distinguished, and each is read on a dark chip. */
const COLORS = ['#ffd54d', '#7cc8ff', '#ff9bcb', '#8fe66f', '#cdb0ff', '#ffa866', '#5fe3d3'];

/**
 * The colour of a client's dot, by the client's id: who comes next has the next one.
 *
 * @param {string} client
 */
export function pointerColor(client) {
  const [, number = '0', edge = ''] = /^c(\d+)(.*)$/.exec(client) ?? [null, '0', client];
  const shift = [...edge].reduce((sum, character) => (sum * 31 + /** @type {number} */ (character.codePointAt(0))) % COLORS.length, 0);
  return COLORS[(Number(number) + shift) % COLORS.length];
}
