import assert from 'node:assert/strict';
import { afterEach, beforeEach, test } from 'node:test';
import { Pointer } from '../../../web-client/stage/pointer.js';
import { FakeClock, fakeEvent, replaceGlobals } from './fakes.js';

class Layer extends EventTarget {
  hidden = true;
  setPointerCapture() {}
}

let clock;
let now;
let layer;
let sent;
let turns;
let wheels;
let frame;
let pointer;
let restore;

beforeEach(() => {
  clock = new FakeClock();
  const { setTimeout, clearTimeout } = clock;
  restore = replaceGlobals({ document: new EventTarget(), setTimeout, clearTimeout });
  [now, frame, layer] = [1000, 7, new Layer()];
  [sent, turns, wheels] = [[], [], []];
  pointer = new Pointer(layer, {
    send: (what) => sent.push(what),
    mapping: () => (x, y) => ({ x: x / 2, y: y / 2 }),
    frame: () => frame,
    turned: (isOn) => turns.push(isOn),
    wheel: (event) => wheels.push(event),
    clock: () => now,
  });
  pointer.begin();
});

afterEach(() => restore());

const pass = (ms) => {
  now += ms;
  clock.advance(ms);
};
const finger = (type, clientX, members = {}) =>
  layer.dispatchEvent(fakeEvent(`pointer${type}`, { pointerId: 1, button: 0, clientX, clientY: 40, ...members }));

test('a finger points at once, by the frame that is shown, and at nothing when it leaves', () => {
  finger('down', 100);
  assert.deepEqual(sent, [{ x: 50, y: 20, frame: 7 }]);
  finger('up', 100);
  assert.deepEqual(sent.slice(1), [{}]);
  pass(5000);
  assert.equal(sent.length, 2);
});

test('30 places a second are sent at most, the newest each time', () => {
  finger('down', 0);
  for (let ms = 1; ms <= 1000; ms += 1) {
    pass(1);
    finger('move', 2 * ms);
  }
  assert.ok(sent.length >= 28 && sent.length <= 31, sent.length);
  sent.length = 0;
  pass(40);
  assert.deepEqual(sent, [{ x: 1000, y: 20, frame: 7 }]);
  finger('move', 10);
  finger('move', 20);
  assert.equal(sent.length, 1);
  pass(20);
  finger('move', 30);
  pass(14);
  assert.deepEqual(sent.slice(1), [{ x: 15, y: 20, frame: 7 }]);
});

test('a finger that rests says so now and then, by the frame of then', () => {
  finger('down', 100);
  frame = 9;
  pass(499);
  assert.equal(sent.length, 1);
  pass(1);
  pass(500);
  assert.deepEqual(sent.slice(1), [{ x: 50, y: 20, frame: 9 }, { x: 50, y: 20, frame: 9 }]);
});

test('a second finger, another button and a mouse without a button point at nothing', () => {
  finger('move', 100);
  finger('down', 100, { button: 2 });
  assert.deepEqual(sent, []);
  finger('down', 100);
  finger('down', 200, { pointerId: 2 });
  pass(100);
  finger('move', 300, { pointerId: 2 });
  finger('up', 300, { pointerId: 2 });
  assert.equal(sent.length, 1);
  finger('cancel', 100);
  assert.deepEqual(sent.slice(1), [{}]);
});

test('Escape ends it, which lifts the finger, and the picture has the fingers again', () => {
  assert.deepEqual([turns, layer.hidden], [[true], false]);
  finger('down', 100);
  document.dispatchEvent(fakeEvent('keydown', { key: 'Escape' }));
  assert.deepEqual([turns, layer.hidden, sent.at(-1)], [[true, false], true, {}]);
  finger('down', 100);
  pass(1000);
  pointer.end();
  assert.deepEqual([turns, sent.length], [[true, false], 2]);
});

test('the wheel goes on to the picture, but not under a finger', () => {
  layer.dispatchEvent(fakeEvent('wheel'));
  finger('down', 100);
  layer.dispatchEvent(fakeEvent('wheel'));
  assert.equal(wheels.length, 1);
});
