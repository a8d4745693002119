import assert from 'node:assert/strict';
import { test } from 'node:test';
import { watchViewSize } from '../../../web-client/stage/view-size.js';
import { FakeWindow } from './fakes.js';

function setUp(clientWidth = 1180, clientHeight = 820, devicePixelRatio = 2) {
  const window = Object.assign(new FakeWindow(), { devicePixelRatio });
  const element = { clientWidth, clientHeight };
  const told = [];
  watchViewSize(element, ({ width, height, pixelRatio }) => told.push([width, height, pixelRatio]), window);
  return { window, element, take: () => told.splice(0) };
}

test('the size is told at once', () => {
  assert.deepEqual(setUp().take(), [[1180, 820, 2]]);
});

test('a change is told', () => {
  const page = setUp();
  page.take();
  Object.assign(page.element, { clientWidth: 820, clientHeight: 1180 });
  page.window.elementResized();
  assert.deepEqual(page.take(), [[820, 1180, 2]]);
});

test('the same size is not told again', () => {
  const page = setUp();
  page.take();
  page.window.elementResized();
  assert.deepEqual(page.take(), []);
});

test('every change of the pixel ratio is told, within the limits of the protocol', () => {
  const page = setUp();
  page.take();
  for (const ratio of [1.5, 9, 0.1]) {
    page.window.setPixelRatio(ratio);
  }
  assert.deepEqual(page.take(), [[1180, 820, 1.5], [1180, 820, 4], [1180, 820, 0.25]]);
});

test('a view that is not to be seen has no size', () => {
  const page = setUp(0, 0);
  assert.deepEqual(page.take(), []);
  Object.assign(page.element, { clientWidth: 20000, clientHeight: 10 });
  page.window.elementResized();
  assert.deepEqual(page.take(), [[8192, 10, 2]]);
});
