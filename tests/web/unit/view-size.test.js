import assert from 'node:assert/strict';
import { test } from 'node:test';
import { insetOf, watchViewSize } from '../../../web-client/stage/view-size.js';
import { FakeWindow } from './fakes.js';

function setUp(clientWidth = 1180, clientHeight = 820, devicePixelRatio = 2) {
  const window = Object.assign(new FakeWindow(), { devicePixelRatio });
  const element = { clientWidth, clientHeight };
  const box = (left, top, right, bottom) => ({ getBoundingClientRect: () => ({ left, top, right, bottom, height: bottom - top }) });
  const covers = { over: box(0, 0, clientWidth, clientHeight), rows: [] };
  const told = [];
  watchViewSize(element, covers, ({ width, height, pixelRatio }) => told.push([width, height, pixelRatio]), window);
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

test('what lies beside the column on the view, and its lower rows, are the inset', () => {
  const view = { width: 1180, height: 820 };
  const column = { left: 12, top: 12, right: 768, bottom: 808 };
  assert.deepEqual(insetOf(view, column, []), { top: 12, right: 412, bottom: 12, left: 12 });
  const rows = [{ top: 690.4, height: 50 }, { top: 748, height: 60 }, { top: 0, height: 0 }];
  assert.deepEqual(insetOf(view, column, rows), { top: 12, right: 412, bottom: 130, left: 12 });
  const beyond = { left: -3, top: 0, right: 1200, bottom: 900 };
  assert.deepEqual(insetOf(view, beyond, []), { top: 0, right: 0, bottom: 0, left: 0 });
});

test('a change of the inset alone is told', () => {
  const window = Object.assign(new FakeWindow(), { devicePixelRatio: 1 });
  let top = 100;
  const box = (rect) => ({ getBoundingClientRect: () => ({ left: 0, top: 0, right: 200, bottom: 100, ...rect() }) });
  const told = [];
  const row = box(() => ({ top, height: 100 - top }));
  watchViewSize({ clientWidth: 200, clientHeight: 100 }, { over: box(() => ({})), rows: [row] }, ({ inset }) => told.push(inset.bottom), window);
  window.elementResized();
  top = 60;
  window.elementResized();
  assert.deepEqual(told, [0, 40]);
});
