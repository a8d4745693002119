import assert from 'node:assert/strict';
import { test } from 'node:test';
import { partTitle } from '../../../web-client/stage/stage.js';

test('the chosen part is called by its name and its parent\'s; the scene itself is left out', () => {
  const path = ['Car', 'Body', 'Front', 'Door', 'Red'];
  assert.deepEqual(partTitle({ node: 7, name: 'Red', path }), { title: 'Door › Red', above: 'Body › Front' });
  assert.deepEqual(partTitle({ node: 7, name: 'Body', path: ['Car', 'Body'] }), { title: 'Body', above: '' });
});

test('without a path it has its name or number, and without a part it is empty', () => {
  assert.deepEqual(partTitle({ node: 0, name: 'Car', path: ['Car'] }), { title: 'Car', above: '' });
  assert.deepEqual(partTitle({ node: 0 }), { title: '#0', above: '' });
  assert.deepEqual(partTitle({}), { title: '', above: '' });
});
