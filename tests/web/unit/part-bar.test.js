import assert from 'node:assert/strict';
import { describe, test } from 'node:test';
import { Hidden, besides, levels } from '../../../web-client/stage/part-bar.js';

describe('the path of the selected part', () => {
  test('has its levels, and leaves out the scene', () => {
    const selection = { node: 7, name: 'Red', path: ['Car', 'Body', '', 'Red'], pathIds: [0, 3, 5, 7] };
    assert.deepEqual(levels(selection), [{ id: 3, name: 'Body' }, { id: 5, name: '#5' }, { id: 7, name: 'Red' }]);
  });

  test('of the scene is its name, or number, and without a part there is none', () => {
    assert.deepEqual(levels({ node: 0, name: 'Car', path: ['Car'], pathIds: [0] }), [{ id: 0, name: 'Car' }]);
    assert.deepEqual(levels({ node: 0, name: '', path: [''], pathIds: [0] }), [{ id: 0, name: '#0' }]);
    assert.deepEqual(levels({}), []);
  });
});

describe('what is beside what is kept', () => {
  const node = (id, members = {}) => ({ id, name: '', type: 'transform', active: true, children: 0, triangles: 0, ...members });
  const children = [node(2), node(3), node(4, { active: false }), node(5), node(6, { type: 'light' })];

  test('is what is shown of its parent\'s others', () => {
    assert.deepEqual(besides(new Set([3, 2]), [node(1), ...children], {}), [5]);
    assert.deepEqual(besides(new Set([3]), [node(1), ...children], {}), [2, 5]);
  });

  test('is nothing where they stand for one another', () => {
    const chooses = node(1, { type: 'switch', activeChild: 1 });
    assert.deepEqual(besides(new Set([3]), [chooses, ...children], {}), []);
    assert.deepEqual(besides(new Set([3]), [node(1, { type: 'lod' }), ...children], {}), []);
    assert.deepEqual(besides(new Set([3]), [chooses, ...children], { 1: { activeChild: -2 } }), [2, 5]);
  });
});

describe('what is hidden', () => {
  test('is shown again as it was', () => {
    const hidden = new Hidden();
    hidden.add([1, 2], { 2: { active: true }, 3: { active: false } });
    assert.deepEqual(hidden.back({ 1: { active: false }, 3: { active: false } }), { 1: { active: null }, 2: { active: true } });
    hidden.add([4, 1], { 1: { active: false } });
    assert.deepEqual(hidden.back({ 1: { active: false }, 2: { active: true }, 4: { active: false } }),
      { 1: { active: null }, 4: { active: null } });
  });

  test('is left alone where somebody has shown it', () => {
    const hidden = new Hidden();
    hidden.add([1], {});
    assert.deepEqual(hidden.back({}), {});
    assert.deepEqual(hidden.back({ 1: { activeChild: 2 } }), {});
  });
});
