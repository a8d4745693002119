import assert from 'node:assert/strict';
import { test } from 'node:test';
import { stopAt, stopFrom, stops } from '../../../web-client/panels/bar.js';

const pose = (x) => ({ eye: [x, 0, 5], focus: [0, 0, 0], up: [0, 1, 0], center: [0, 0, 0], fov: 40 });
const state = { views: { home: pose(0), 'View 10': pose(10), 'View 9': pose(9) }, cameras: { 3: { name: 'Outside' }, 5: { name: '' } } };
const all = stops(state);

test('a presentation stops at the saved views, by name, and at the cameras', () => {
  assert.deepEqual(all.map(([, { text }]) => text), ['View 9', 'View 10', 'Outside', '#5']);
  assert.deepEqual(all.map(([, { camera }]) => camera), [pose(9), pose(10), { node: 3 }, { node: 5 }]);
});

test('the views stand in their order, and those without one behind', () => {
  const views = { ...state.views, A: pose(1), 'View 10': { ...pose(10), order: 2 }, B: { ...pose(2), order: -1 } };
  assert.deepEqual(stops({ views, cameras: {} }).map(([, { text }]) => text), ['B', 'View 10', 'A', 'View 9']);
});

test('it knows at which of them the camera stands', () => {
  assert.equal(stopAt(all, { ...pose(10), near: 1, far: 2 }), 'view View 10');
  assert.equal(stopAt(all, { ...pose(1), node: 5, near: 1, far: 2 }), 'camera 5');
  assert.equal(stopAt(all, { ...pose(1), near: 1, far: 2 }), undefined);
});

test('it goes on and back, and around the end', () => {
  const from = (key, by) => stopFrom(all, key, by)?.[0];
  assert.equal(from('view View 9', 1), 'view View 10');
  assert.equal(from('view View 10', -1), 'view View 9');
  assert.equal(from('camera 5', 1), 'view View 9');
  assert.equal(from('view View 9', -1), 'camera 5');
  assert.equal(from('view gone', 1), 'view View 9');
  assert.equal(from(undefined, -1), 'camera 5');
  assert.equal(stopFrom([], undefined, 1), undefined);
});
