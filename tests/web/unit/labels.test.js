import assert from 'node:assert/strict';
import { test } from 'node:test';
import { labelPlaces } from '../../../web-client/stage/labels.js';
import { viewMapping } from '../../../web-client/stage/picture.js';

const view = { width: 200, height: 100, pixelRatio: 2 };

/** Whose points' places are their first two coordinates; those behind have a third. */
function pictureOf(markers, box = { left: 0, top: 0, ...view }) {
  const placeOf = ([x, y, behind]) => (behind ? null : { x, y });
  return { header: { view, markers }, mapping: () => viewMapping(box, view), placeOf };
}

test('labels stand where the picture stands, which may be smaller than the window', () => {
  const markers = { a: { text: 'Gap' }, b: { text: 'Behind' }, c: { text: '' }, d: { text: 'Elsewhere' } };
  const points = { a: [150, 25], b: [0, 0, 1], c: [0, 0], gone: [0, 0] };
  const picture = pictureOf(points, { left: 0, top: 0, width: 400, height: 400 });
  assert.deepEqual(labelPlaces(picture, markers), [{ text: 'Gap', x: 300, y: 150 }]);
});

test('there are none before a picture, and without markers', () => {
  assert.deepEqual(labelPlaces({ ...pictureOf({}), header: null }, undefined), []);
  assert.deepEqual(labelPlaces(pictureOf(undefined), { a: { text: 'Gap' } }), []);
});
