import assert from 'node:assert/strict';
import { test } from 'node:test';
import { inView, labelPlaces } from '../../../web-client/stage/labels.js';
import { viewMapping } from '../../../web-client/stage/picture.js';

const view = { width: 200, height: 100, pixelRatio: 2 };
// The eye at (0, 0, 10) looks along −z: 90° high, near 1, far 100.
const camera = {
  viewMatrix: [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, -10, 0, 0, 0, 1],
  projectionMatrix: [0.5, 0, 0, 0, 0, 1, 0, 0, 0, 0, -101 / 99, -200 / 99, 0, 0, -1, 0],
};
const header = { camera, view };

test('a point of the world is projected into the view', () => {
  assert.deepEqual(inView(header, [0, 0, 0]), { x: 100, y: 50 });
  assert.deepEqual(inView(header, [10, 5, 0]), { x: 150, y: 25 });
  assert.deepEqual(inView(header, [-20, -10, 0]), { x: 0, y: 100 });
});

test('one behind the camera, in its plane or outside the picture is not', () => {
  for (const point of [[0, 0, 20], [0, 0, 10], [21, 0, 0], [0, -11, 0], [NaN, 0, 0]]) assert.equal(inView(header, point), null);
});

test('labels stand where the picture stands, which may be smaller than the window', () => {
  const markers = { a: { text: 'Gap' }, b: { text: 'Behind' }, c: { text: '' }, d: { text: 'Elsewhere' } };
  const seen = { ...header, markers: { a: [10, 5, 0], b: [0, 0, 20], c: [0, 0, 0], gone: [0, 0, 0] } };
  const mapping = viewMapping({ left: 0, top: 0, width: 400, height: 400 }, view);
  assert.deepEqual(labelPlaces(seen, markers, mapping), [{ text: 'Gap', x: 300, y: 150 }]);
});

test('labels go with a picture that is moved', () => {
  const seen = { ...header, markers: { a: [10, 5, 0] } };
  const mapping = viewMapping({ left: 0, top: 0, width: 400, height: 200 }, view);
  const [moved] = labelPlaces(seen, { a: { text: 'Gap' } }, mapping, { scale: 1.5, x: -20, y: 4 });
  // (150, 25) is (50, −25) from the middle; the window shows the view at twice its size.
  assert.deepEqual(moved, { text: 'Gap', x: 2 * (100 + 75 - 20), y: 2 * (50 - 37.5 + 4) });
});

test('there are none before a picture, and without markers', () => {
  const mapping = (x, y) => ({ x, y });
  assert.equal(labelPlaces(null, undefined, mapping).length, 0);
  assert.equal(labelPlaces(header, { a: { text: 'Gap' } }, mapping).length, 0);
});
