import assert from 'node:assert/strict';
import { test } from 'node:test';
import { Presence, presence } from '../../../web-client/presence.js';

const OPEN = { phase: { name: 'open' }, role: 'control', client: 'a', header: { quality: { level: 'still' } } };
const held = (control) => ({ ...OPEN, state: { control } });

test('while there is no connection only that is told', () => {
  for (const name of ['starting', 'connecting', 'waiting', 'refused']) {
    assert.deepEqual(presence({ ...held({ holder: 'a' }), phase: { name } }), { connection: name });
  }
});

test('who steers', () => {
  const steering = (control, role = 'control') => presence({ ...held(control), role }).steering;
  assert.equal(steering({ holder: 'a', kept: false }), 'steering');
  assert.equal(steering({ holder: 'a', kept: true }), 'kept');
  assert.equal(steering({ holder: 'b', kept: true }), 'watching');
  assert.equal(steering({ kept: false }), 'free');
  assert.equal(steering({ kept: false }, 'view'), 'watching');
});

test('which kind of picture is seen, once there is one', () => {
  assert.equal(presence(held({})).level, 'still');
  assert.equal(presence({ ...held({}), header: null }).level, undefined);
});

test('all is said in a few words, for eyes and for scripts, and only when it changes', () => {
  let writes = 0;
  const element = {
    dataset: {},
    get textContent() {
      return this.text;
    },
    set textContent(text) {
      writes += 1;
      this.text = text;
    },
  };
  const corner = new Presence(element);
  corner.show(held({ holder: 'a', kept: true }));
  assert.equal(element.text, 'Connected · Steering, kept · Still');
  assert.deepEqual(element.dataset, { connection: 'open', steering: 'kept', level: 'still' });
  corner.show(held({ holder: 'a', kept: true }));
  assert.equal(writes, 1);
  corner.show({ phase: { name: 'waiting' } });
  assert.equal(element.text, 'Not connected');
  assert.deepEqual(element.dataset, { connection: 'waiting', steering: '', level: '' });
});

test('every phase of a connection has a word', () => {
  const element = { dataset: {} };
  const corner = new Presence(element);
  for (const name of ['starting', 'connecting', 'waiting', 'refused']) {
    corner.show({ phase: { name } });
    assert.notEqual(element.textContent, '');
  }
});
