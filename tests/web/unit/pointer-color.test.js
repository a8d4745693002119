import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { test } from 'node:test';
import { pointerColor } from '../../../web-client/base/pointer-color.js';

const css = readFileSync(new URL('../../../web-client/style.css', import.meta.url), 'utf8');
const clients = Array.from({ length: 40 }, (_, i) => `c${i + 1}`);

/** As WCAG 2 has it. */
function luminance(rgb) {
  const [r, g, b] = rgb.map((part) => (part / 255 <= 0.04045 ? part / 255 / 12.92 : ((part / 255 + 0.055) / 1.055) ** 2.4));
  return 0.2126 * r + 0.7152 * g + 0.0722 * b;
}
const contrast = (a, b) => {
  const [less, more] = [luminance(a), luminance(b)].sort((x, y) => x - y);
  return (more + 0.05) / (less + 0.05);
};
const rgbOf = (color) => [1, 3, 5].map((at) => parseInt(color.slice(at, at + 2), 16));

test('a client has the same colour everywhere and always', () => {
  for (const client of [...clients, 'c3.e1f9', 'odd', '']) assert.equal(pointerColor(client), pointerColor(`${client}`));
  assert.match(pointerColor('c1'), /^#[0-9a-f]{6}$/);
  for (const client of ['c99999999999999999999', 'c', 'odd', '', 'c1.ž']) assert.match(pointerColor(client), /^#[0-9a-f]{6}$/);
});

test('who comes next has another one, at an edge, too', () => {
  for (const suffix of ['', '.e1f9', '.ab']) {
    const some = clients.slice(0, 7).map((client) => pointerColor(client + suffix));
    assert.equal(new Set(some).size, 7);
  }
  assert.equal(new Set(['', '.a', '.b', '.c'].map((edge) => pointerColor(`c1${edge}`))).size, 4);
});

test('a name is read on its chip, over a light picture and a dark one', () => {
  // The chip's colour, as much of which covers what is behind it.
  const [, red, green, blue, alpha] = /background: rgb\((\d+) (\d+) (\d+) \/ (0\.\d+)\);\n  color: #f2f7f4/.exec(css) ?? [];
  for (const behind of [0, 255]) {
    const chip = [red, green, blue].map((part) => part * alpha + behind * (1 - alpha));
    for (const client of clients) {
      const ratio = contrast(rgbOf(pointerColor(client)), chip);
      assert.ok(ratio >= 4.5, `${client}: ${pointerColor(client)} has ${ratio.toFixed(2)}`);
    }
  }
});
