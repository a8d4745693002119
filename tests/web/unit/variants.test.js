import assert from 'node:assert/strict';
import { afterEach, describe, test } from 'node:test';
import { variants } from '../../../web-client/panels/variants.js';
import { setLanguage } from '../../../web-client/base/texts.js';

afterEach(() => setLanguage('en'));

const paints = ['Red', 'Silver', 'Green'];
const switchOf = (id, name, choices) => ({ id, name, choices, activeChild: 0 });
const found = (switches) => variants(switches).map((variant) => [variant.title, variant.switches.map(({ id }) => id)]);

describe('variants', () => {
  test('switches with the same choices are one, called like all of them, or by their number', async () => {
    const rims = ['Five', 'Ten'];
    const car = [
      switchOf(1, 'Panel', paints), switchOf(2, 'Rim', rims), switchOf(3, 'Mirror', paints), switchOf(4, 'Rim', rims),
    ];
    assert.deepEqual(found(car), [['2 parts', [1, 3]], ['Rim', [2, 4]]]);
    await setLanguage('cs');
    assert.deepEqual(found(car), [['2 díly', [1, 3]], ['Rim', [2, 4]]]);
  });

  test('another order is another choice, and nothing is taken for the same that has no name', () => {
    const switches = [
      switchOf(1, 'a', ['x', 'y']), switchOf(2, 'b', ['y', 'x']), switchOf(3, 'c', ['', '']), switchOf(4, '', ['', '']),
    ];
    assert.deepEqual(found(switches), [['a', [1]], ['b', [2]], ['c', [3]], ['#4', [4]]]);
  });

  test('one with nothing to choose from, and one that does not tell its choices, are left out', () => {
    assert.deepEqual(found([switchOf(1, 'One', ['a']), switchOf(2, 'Many', undefined), switchOf(3, 'None', [])]), []);
  });
});
