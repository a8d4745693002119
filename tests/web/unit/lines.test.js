import assert from 'node:assert/strict';
import { afterEach, beforeEach, describe, test } from 'node:test';
import { Lines, connectionSentence } from '../../../web-client/stage/lines.js';
import { setLanguage } from '../../../web-client/base/texts.js';
import { FakeClock, FakeElement, fakeDocument, replaceGlobals } from './fakes.js';

let clock;
let restore;

beforeEach(() => {
  clock = new FakeClock();
  restore = replaceGlobals({ document: fakeDocument, setTimeout: clock.setTimeout });
});

afterEach(() => restore());

function setUp() {
  const element = new FakeElement('div');
  const said = () => element.children.map(({ textContent }) => textContent);
  const bars = () => element.children.map((line) => line.querySelector('progress')?.value);
  return { element, clock, lines: new Lines(element), said, bars };
}

test('a passing sentence passes', () => {
  const { said, clock, lines } = setUp();
  lines.pass('Software drawing.');
  clock.advance(5000);
  lines.pass('Another steers.');
  assert.deepEqual(said(), ['Software drawing.', 'Another steers.']);
  clock.advance(1000);
  assert.deepEqual(said(), ['Another steers.']);
  clock.advance(5000);
  assert.deepEqual(said(), []);
});

test('said again, it stands once and stays longer', () => {
  const { said, clock, lines } = setUp();
  lines.pass('Another steers.');
  clock.advance(5000);
  lines.pass('Another steers.');
  assert.deepEqual(said(), ['Another steers.']);
  clock.advance(5999);
  assert.deepEqual(said(), ['Another steers.']);
  clock.advance(1);
  assert.deepEqual(said(), []);
});

test('what the server says small is said as a sentence', () => {
  const { lines, said } = setUp();
  lines.pass('this server has no folder for recordings');
  assert.deepEqual(said(), ['This server has no folder for recordings.']);
});

test('of four the oldest goes at once, and its time takes no other away', () => {
  const { said, clock, lines } = setUp();
  for (const sentence of ['One.', 'Two.', 'Three.', 'Four.']) {
    lines.pass(sentence);
    clock.advance(1000);
  }
  assert.deepEqual(said(), ['Two.', 'Three.', 'Four.']);
  clock.advance(2999);
  assert.deepEqual(said(), ['Two.', 'Three.', 'Four.']);
  clock.advance(1);
  assert.deepEqual(said(), ['Three.', 'Four.']);
});

test('a lasting one stays, and goes before it; there is one of each matter', () => {
  const { said, clock, lines } = setUp();
  lines.pass('Software drawing.');
  lines.hold('connection', 'The server does not answer.');
  lines.hold('loading', 'Loading car…');
  assert.deepEqual(said(), ['The server does not answer.', 'Loading car…', 'Software drawing.']);
  lines.hold('connection', 'Trying again…');
  clock.advance(6000);
  assert.deepEqual(said(), ['Trying again…', 'Loading car…']);
  lines.hold('connection', '');
  lines.hold('other', '');
  assert.deepEqual(said(), ['Loading car…']);
});

test('what can be done about it has a button, and stays longer', () => {
  const { element, clock, lines, said } = setUp();
  const done = [];
  const offer = () => lines.pass('Deleted', { label: 'Undo', act: () => done.push('undone') });
  const buttons = () => element.children.map((line) => line.querySelector('button')?.textContent);
  offer();
  lines.pass('Another steers.');
  assert.deepEqual(buttons(), ['Undo', undefined]);
  clock.advance(6000);
  assert.deepEqual(said(), ['Deleted.Undo']);
  element.children[0].querySelector('button').onclick();
  assert.deepEqual([done, said()], [['undone'], []]);
  offer();
  clock.advance(14_999);
  assert.deepEqual(said(), ['Deleted.Undo']);
  clock.advance(1);
  assert.deepEqual(said(), []);
  assert.deepEqual(done, ['undone']);
});

test('what goes on has a bar of its own', () => {
  const { element, bars, lines } = setUp();
  lines.hold('loading', 'Loading car…', 0);
  assert.deepEqual(bars(), [0]);
  lines.pass('Another steers.');
  lines.hold('loading', 'Loading house…', 0.5);
  assert.deepEqual(bars(), [0.5, undefined]);
  assert.equal(element.children[0].querySelector('progress').ariaLabel, 'Loading house…');
  lines.hold('loading', '');
  assert.deepEqual(bars(), [undefined]);
});

test('words that stay are not written again, which a screen reader would read again', () => {
  const { element, clock, lines } = setUp();
  lines.hold('loading', 'Loading car…', 0);
  const [line] = element.children;
  const { writes } = line.firstChild;
  lines.hold('loading', 'Loading car…', 0.5);
  lines.pass('Another steers.');
  clock.advance(6000);
  assert.equal(element.children[0], line);
  assert.equal(line.firstChild.writes, writes);
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
    assert.equal(say({ name: 'waiting', retryMs: 1900 }), 'The server does not answer. Trying again in 2\u00a0s.');
    assert.equal(say({ name: 'waiting', retryMs: 4000, reason: { code: 'too-many', message: 'the server has no room' } }),
      'The server has no room. Trying again in 4\u00a0s.');
  });

  test('a refusal, and what to do', () => {
    const remedy = 'Open the address that the server printed.';
    assert.equal(say({ name: 'refused' }), `The server asks for a token. ${remedy}`);
    assert.equal(say({ name: 'refused' }, { hasToken: true }), `The server does not accept the token in this address. ${remedy}`);
    assert.equal(say({ name: 'refused', reason: { message: 'closed by a proxy' } }), `Closed by a proxy. ${remedy}`);
    const refused = { name: 'refused', reason: { code: 'not-allowed', message: 'the token is wrong' } };
    assert.equal(say(refused, { hasToken: true }), `The server does not accept the token in this address. ${remedy}`);
    assert.equal(say(refused), `The server asks for a token. ${remedy}`);
  });

  test('in Czech, too', async () => {
    await setLanguage('cs');
    try {
      assert.equal(say({ name: 'waiting', retryMs: 1900 }), 'Server neodpovídá. Nový pokus za 2\u00a0s.');
      assert.equal(say({ name: 'waiting', retryMs: 0, reason: { code: 'too-many', message: 'the server is full' } }),
        'Nejvyšší povolený počet je překročen (the server is full). Nový pokus…');
    } finally {
      await setLanguage('en');
    }
  });
});
