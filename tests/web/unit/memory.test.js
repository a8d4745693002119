import assert from 'node:assert/strict';
import { webcrypto } from 'node:crypto';
import { afterEach, beforeEach, test } from 'node:test';
import { recall, remember, resumeKey } from '../../../web-client/base/memory.js';
import { FakeStorage, replaceGlobals } from './fakes.js';

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

test('a tab has one resume key, of 128 bits, that no other tab has; without a storage, one a page', () => {
  const key = (sessionStorage) => {
    const restore = replaceGlobals({ sessionStorage, crypto: webcrypto });
    const made = resumeKey();
    restore();
    return made;
  };
  const tab = new FakeStorage();
  const first = key(tab);
  assert.match(first, /^[0-9a-f]{32}$/);
  assert.equal(key(tab), first);
  assert.notEqual(key(new FakeStorage()), first);
  tab.isOff = true;
  assert.match(key(tab), /^[0-9a-f]{32}$/);
  assert.notEqual(key(tab), key(tab));
});
