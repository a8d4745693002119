import assert from 'node:assert/strict';
import { test } from 'node:test';
import { behindWords, hasWalls } from '../../../web-client/panels/comfort.js';

const walls = (behindDegrees, behindMetres) => /** @type {*} */ ({ behindDegrees, behindMetres });

test('walls are behind by degrees, or else by metres', () => {
  assert.equal(behindWords(walls(12.4, 1)), '12° behind');
  assert.equal(behindWords(walls(0.4, 1.26)), '1.3\u00a0m behind');
});

test('what nobody would see is not shown', () => {
  assert.equal(behindWords(walls(0.4, 0.01)), '');
  assert.equal(behindWords(undefined), '');
});

test('there are walls where a host is here', () => {
  assert.equal(hasWalls({ c1: { role: 'control' }, v1: { role: 'view' } }), false);
  assert.equal(hasWalls({ c1: { role: 'control' }, h1: { role: 'host' } }), true);
});
