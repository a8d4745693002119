import assert from 'node:assert/strict';
import { test } from 'node:test';
import { mergePatch } from '../../../web-client/base/merge-patch.js';

// The table of RFC 7396, appendix A.
const table = [
  [{ a: 'b' }, { a: 'c' }, { a: 'c' }],
  [{ a: 'b' }, { b: 'c' }, { a: 'b', b: 'c' }],
  [{ a: 'b' }, { a: null }, {}],
  [{ a: 'b', b: 'c' }, { a: null }, { b: 'c' }],
  [{ a: ['b'] }, { a: 'c' }, { a: 'c' }],
  [{ a: 'c' }, { a: ['b'] }, { a: ['b'] }],
  [{ a: { b: 'c' } }, { a: { b: 'd', c: null } }, { a: { b: 'd' } }],
  [{ a: [{ b: 'c' }] }, { a: [1] }, { a: [1] }],
  [['a', 'b'], ['c', 'd'], ['c', 'd']],
  [{ a: 'b' }, ['c'], ['c']],
  [{ a: 'foo' }, null, null],
  [{ a: 'foo' }, 'bar', 'bar'],
  [{ e: null }, { a: 1 }, { e: null, a: 1 }],
  [[1, 2], { a: 'b', c: null }, { a: 'b' }],
  [{}, { a: { bb: { ccc: null } } }, { a: { bb: {} } }],
];

for (const [target, patch, result] of table) {
  test(`${JSON.stringify(target)} with ${JSON.stringify(patch)}`, () => {
    assert.deepEqual(mergePatch(target, patch), result);
  });
}

test('both arguments stay as they are, and what is untouched is shared', () => {
  const target = { camera: { fov: 40 }, scene: { name: 'car' } };
  const merged = mergePatch(target, { camera: { fov: 50 } });
  assert.deepEqual(target, { camera: { fov: 40 }, scene: { name: 'car' } });
  assert.equal(merged.scene, target.scene);
});

test('two patches become one that does what both do', () => {
  const first = { camera: { fov: 40 }, views: { side: { fov: 30 }, top: null } };
  const both = mergePatch(first, { camera: { fov: 50 }, views: { side: null }, selection: { node: null } }, true);
  assert.deepEqual(both, { camera: { fov: 50 }, views: { side: null, top: null }, selection: { node: null } });
});

test('a member may have any name', () => {
  const merged = mergePatch({}, JSON.parse('{"__proto__": {"text": "here"}, "toString": {"text": "there"}}'));
  assert.deepEqual(Object.keys(merged), ['__proto__', 'toString']);
  assert.equal({}.text, undefined);
  assert.deepEqual(Object.keys(mergePatch(merged, JSON.parse('{"__proto__": null}'))), ['toString']);
});
