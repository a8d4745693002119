import assert from 'node:assert/strict';
import { afterEach, beforeEach, test } from 'node:test';
import { recall, remember } from '../../../web-client/base/memory.js';
import { Token } from '../../../web-client/connection/hello.js';
import { FakeStorage, replaceGlobals } from './fakes.js';

let storage;
let restore;

beforeEach(() => {
  storage = new FakeStorage();
  restore = replaceGlobals({ localStorage: storage });
});

afterEach(() => restore());

test('there may be none', () => {
  const token = new Token('');
  assert.equal(token.value, undefined);
  assert.equal(token.inAddress, false);
  token.accepted();
  assert.equal(storage.items.size, 0);
});

test('the address\'s is remembered once the server has accepted it', () => {
  remember('token', 'old');
  const token = new Token('#token=new');
  assert.equal(token.value, 'new');
  assert.equal(token.inAddress, true);
  assert.equal(recall('token'), 'old');
  token.accepted();
  assert.equal(new Token('').value, 'new');
  assert.equal(new Token('#watch').value, 'new');
});

test('without one in the address the remembered one is said', () => {
  remember('token', 'old');
  const token = new Token('');
  assert.equal(token.value, 'old');
  assert.equal(token.inAddress, false);
});

test('a wrong one in the address does not cost the good one', () => {
  remember('token', 'good');
  assert.equal(new Token('#token=wrong').value, 'wrong');
  assert.equal(new Token('').value, 'good');
});
