import assert from 'node:assert/strict';
import { describe, test } from 'node:test';
import { Presence, presence } from '../../../web-client/stage/presence.js';
import { FakeClock, replaceGlobals } from './fakes.js';

const OPEN = { phase: { name: 'open' }, role: 'control', client: 'a', header: { quality: { level: 'still' } } };
const held = (control) => ({ ...OPEN, state: { control } });

test('while there is no connection only that is told', () => {
  for (const name of ['starting', 'connecting', 'waiting', 'refused']) {
    assert.deepEqual(presence({ ...held({ holder: 'a' }), phase: { name } }), { connection: name });
  }
});

test('who is in control', () => {
  const steering = (control) => presence(held(control)).steering;
  assert.equal(steering({ holder: 'a' }), 'own');
  assert.equal(steering({ holder: 'b' }), 'other');
  assert.equal(steering({ holder: 'b', absent: true }), 'absent');
  assert.equal(steering({}), 'nobody');
});

test('which kind of picture is seen, once there is one', () => {
  assert.equal(presence(held({})).level, 'still');
  assert.equal(presence({ ...held({}), header: null }).level, undefined);
});

/** A pill whose words are counted. */
function pill() {
  return {
    dataset: {},
    title: '',
    writes: 0,
    classList: { add() {}, remove() {} },
    get textContent() {
      return this.text;
    },
    set textContent(text) {
      this.writes += 1;
      this.text = text;
    },
  };
}

test('all is said in a few words, for eyes and for scripts, and only when it changes', () => {
  const element = pill();
  const corner = new Presence(element, {});
  corner.show(held({ holder: 'a' }));
  assert.equal(element.text, 'Connected · You are in control · Still');
  assert.deepEqual(element.dataset, { connection: 'open', steering: 'own', level: 'still' });
  corner.show(held({ holder: 'a' }));
  assert.equal(element.writes, 1);
  corner.show(held({ holder: 'b', name: 'Eva’s iPad' }));
  assert.equal(element.text, 'Connected · Eva’s iPad is in control · Still');
  corner.show({ ...held({ holder: 'b' }), isLate: true });
  assert.equal(element.text, 'Waiting for the server…');
  assert.deepEqual(element.dataset, { connection: 'late', steering: 'other', level: '' });
  corner.show({ phase: { name: 'waiting' }, isLate: true });
  assert.equal(element.text, 'Not connected');
  assert.deepEqual(element.dataset, { connection: 'waiting', steering: '', level: '' });
});

describe('the pill', () => {
  const setUp = (page) => {
    const clock = new FakeClock();
    const restore = replaceGlobals({ setTimeout: clock.setTimeout, clearTimeout: clock.clearTimeout });
    const done = [];
    const element = pill();
    const corner = new Presence(element, { ask: () => done.push('ask'), take: () => done.push('take') });
    corner.show(page);
    return {
      element, done, restore,
      press(ms) {
        element.onpointerdown();
        clock.advance(ms);
        element.onpointerup();
        element.onclick();
      },
    };
  };

  test('tapped asks for control, held takes it', () => {
    for (const isLate of [false, true]) {
      const { press, done, element, restore } = setUp({ ...held({ holder: 'b' }), isLate });
      assert.equal(element.ariaDisabled, false);
      press(300);
      assert.deepEqual(done, ['ask']);
      press(900);
      assert.deepEqual(done, ['ask', 'take']);
      restore();
    }
  });

  test('does nothing for who has control, and for who only watches', () => {
    for (const page of [held({ holder: 'a' }), { ...held({ holder: 'b' }), role: 'view' }, { phase: { name: 'waiting' } }]) {
      const { press, done, element, restore } = setUp(page);
      assert.equal(element.ariaDisabled, true);
      press(300);
      press(900);
      assert.deepEqual(done, []);
      restore();
    }
  });
});

test('every phase of a connection has a word', () => {
  const element = pill();
  const corner = new Presence(element, {});
  for (const name of ['starting', 'connecting', 'waiting', 'refused']) {
    corner.show({ phase: { name } });
    assert.notEqual(element.textContent, '');
  }
});
