import assert from 'node:assert/strict';
import { test } from 'node:test';
import { mergePatch } from '../../../web-client/base/merge-patch.js';
import { patchParts } from '../../../web-client/base/patch-parts.js';
import { byteLength, cutToBytes } from '../../../web-client/base/utf8.js';

const text = 'é'.repeat(10_000);

test('a short patch is one part', () => {
  for (const patch of [{}, { cues: {} }, { cues: { b: { text: 'x' }, a: null }, unit: 'mm', nodes: null }]) {
    assert.deepEqual(patchParts(patch), [patch]);
  }
});

test('a long one goes in parts of at most 60,000 bytes, which do the same', () => {
  const nodes = Object.fromEntries(Array.from({ length: 5000 }, (_, id) => [id, { active: false, activeChild: null }]));
  const cues = Object.fromEntries(['a', 'b', 'c', '__proto__', 'e'].map((name) => [name, { text }]));
  const patch = { cues, unit: 'mm', markers: {}, measures: null, nodes };
  const parts = patchParts(patch);
  assert.ok(parts.every((part) => byteLength(JSON.stringify(part)) <= 60_000));
  assert.deepEqual(parts.reduce((all, part) => mergePatch(all, part, true), {}), patch);
  assert.equal(parts.filter(({ cues: some }) => some).length, 3);
  assert.ok(parts.length < 10, String(parts.length));
});

test('what goes makes room for what comes', () => {
  const [first, ...others] = patchParts({ cues: { new: { text }, newer: { text }, newest: { text }, old: null } });
  assert.equal(first.cues.old, null);
  assert.ok(others.every(({ cues }) => !('old' in cues)));
});

test('an entry that is too long by itself is a part', () => {
  const cues = { a: { text: 'x' }, b: { text: text.repeat(4) }, c: { text: 'x' } };
  assert.deepEqual(patchParts({ cues }).map((part) => Object.keys(part.cues)), [['a'], ['b'], ['c']]);
});

test('a text is cut between characters', () => {
  assert.equal(cutToBytes('abc', 3), 'abc');
  assert.equal(cutToBytes('aéb', 3), 'aé');
  assert.equal(cutToBytes('aéb', 2), 'a');
  assert.equal(cutToBytes('a🚗', 4), 'a');
  assert.equal(cutToBytes('a🚗', 5), 'a🚗');
  assert.equal(byteLength('a🚗é'), 7);
});
