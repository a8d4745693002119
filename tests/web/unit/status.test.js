import assert from 'node:assert/strict';
import { describe, test } from 'node:test';
import { Status, connectionSentence } from '../../../web-client/status.js';
import { FakeClock } from './fakes.js';

function setUp() {
  const element = { textContent: '' };
  const clock = new FakeClock();
  return { element, clock, status: new Status(element, clock) };
}

test('a passing sentence passes', () => {
  const { element, clock, status } = setUp();
  status.pass('Software drawing.', 6000);
  assert.equal(element.textContent, 'Software drawing.');
  clock.advance(5000);
  status.pass('Another steers.', 6000);
  clock.advance(5999);
  assert.equal(element.textContent, 'Another steers.');
  clock.advance(1);
  assert.equal(element.textContent, '');
});

test('a lasting one stays, and goes before it', () => {
  const { element, clock, status } = setUp();
  status.pass('Software drawing.', 6000);
  status.hold('The server does not answer.');
  assert.equal(element.textContent, 'The server does not answer.');
  status.hold('');
  assert.equal(element.textContent, 'Software drawing.');
  status.hold('The server does not answer.');
  clock.advance(6000);
  assert.equal(element.textContent, 'The server does not answer.');
});

describe('of the connection', () => {
  const say = (phase, { hasPicture = false, hasToken = false } = {}) => connectionSentence(phase, hasPicture, hasToken);

  test('nothing is said while all is well', () => {
    assert.equal(say({ name: 'open' }, { hasPicture: true }), '');
    assert.equal(say({ name: 'open' }), 'Waiting for the picture…');
  });

  test('an attempt changes nothing that was said', () => {
    assert.equal(say({ name: 'connecting' }), null);
  });

  test('a loss, and how long the wait will be', () => {
    assert.equal(say({ name: 'waiting', retryMs: 250, hadOpened: true }), 'The connection to the server is lost. Trying again…');
    assert.equal(say({ name: 'waiting', retryMs: 250 }), 'The server does not answer. Trying again…');
    assert.equal(say({ name: 'waiting', retryMs: 1900 }), 'The server does not answer. Trying again in 2 s.');
    assert.equal(say({ name: 'waiting', retryMs: 4000, reason: 'The server has no room' }), 'The server has no room. Trying again in 4 s.');
  });

  test('a refusal, and what to do', () => {
    const remedy = 'Open the address that the server printed, or scan its code.';
    assert.equal(say({ name: 'refused' }), `The server asks for a token. ${remedy}`);
    assert.equal(say({ name: 'refused' }, { hasToken: true }), `The server does not accept the token in this address. ${remedy}`);
    assert.equal(say({ name: 'refused', reason: 'The token is wrong' }), `The token is wrong. ${remedy}`);
  });
});
