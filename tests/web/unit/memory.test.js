import assert from 'node:assert/strict';
import { afterEach, beforeEach, test } from 'node:test';
import { recall, remember } from '../../../web-client/memory.js';
import { FakeStorage } from './fakes.js';

beforeEach(() => {
  globalThis.localStorage = new FakeStorage();
});

afterEach(() => {
  delete globalThis.localStorage;
});

test('what was remembered is recalled, until it is forgotten', () => {
  assert.equal(recall('language'), null);
  remember('language', 'cs');
  assert.equal(recall('language'), 'cs');
  remember('language', null);
  assert.equal(recall('language'), null);
});

test('names do not meet those of other pages of the same server', () => {
  remember('language', 'cs');
  assert.deepEqual([...globalThis.localStorage.items.keys()], ['vrut-preview.language']);
});

test('a browser that keeps nothing does no harm', () => {
  globalThis.localStorage.isOff = true;
  remember('language', 'cs');
  remember('language', null);
  assert.equal(recall('language'), null);
});
