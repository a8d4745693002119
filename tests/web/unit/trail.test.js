import assert from 'node:assert/strict';
import { afterEach, beforeEach, test } from 'node:test';
import { Trail } from '../../../web-client/panels/trail.js';
import { FakeClock, replaceGlobals } from './fakes.js';

let clock;
let restore;

beforeEach(() => {
  clock = new FakeClock();
  restore = replaceGlobals({ setTimeout: clock.setTimeout, clearTimeout: clock.clearTimeout });
});

afterEach(() => restore());

const camera = (x) => ({ eye: [x, 0, 5], focus: [0, 0, 0], up: [0, 1, 0], center: [0, 0, 0], fov: 40, near: 1, far: 9 });
const STILL_MS = 600;

function setUp() {
  const told = [];
  const trail = new Trail(() => told.push(trail.isEmpty));
  trail.follow(camera(0));
  clock.advance(STILL_MS);
  const fly = (...xs) => {
    trail.sent({ type: 'fly' });
    for (const x of xs) {
      trail.follow(camera(x));
      clock.advance(100);
    }
    clock.advance(STILL_MS);
  };
  return { trail, told, fly };
}

test('a flight is one step, and Back leads to where it began', () => {
  const { trail, told, fly } = setUp();
  assert.equal(trail.isEmpty, true);
  fly(1, 2, 3);
  assert.equal(told.at(-1), false);
  fly(4, 5);
  assert.equal(trail.back().eye[0], 3);
  fly(4, 3);
  assert.equal(trail.back().eye[0], 0);
  assert.equal(told.at(-1), true);
  fly(0);
  assert.equal(trail.back(), undefined);
});

test('a drag is a step once the finger has left, however long it rests', () => {
  const { trail } = setUp();
  trail.sent({ type: 'pointerdown', pointerId: 1 });
  trail.follow(camera(1));
  clock.advance(STILL_MS);
  clock.advance(STILL_MS);
  assert.equal(trail.isEmpty, true);
  trail.sent({ type: 'pointermove', pointerId: 1 });
  trail.follow(camera(2));
  trail.sent({ type: 'pointerup', pointerId: 1 });
  clock.advance(STILL_MS);
  assert.equal(trail.back().eye[0], 0);
  assert.equal(trail.isEmpty, true);
});

test('Back at once leads to before the move that has just been made', () => {
  const { trail } = setUp();
  trail.sent({ type: 'fit' });
  trail.follow(camera(7));
  assert.equal(trail.back().eye[0], 0);
});

test('a move during the flight back is another step', () => {
  const { trail, fly } = setUp();
  fly(1);
  trail.back();
  trail.sent({ type: 'fly' });
  trail.follow(camera(0.5));
  fly(8);
  assert.equal(trail.back().eye[0], 0);
});

test('what moves nothing is no step, and what another moves is none, either', () => {
  const { trail } = setUp();
  trail.sent({ type: 'keydown' });
  trail.sent({ type: 'patch', patch: { selection: { node: 1 } } });
  clock.advance(STILL_MS);
  assert.equal(trail.isEmpty, true);
  trail.follow(camera(3));
  clock.advance(STILL_MS);
  assert.equal(trail.isEmpty, true);
  trail.sent({ type: 'patch', patch: { camera: { node: 1 } } });
  trail.follow(camera(4));
  clock.advance(STILL_MS);
  assert.equal(trail.back().eye[0], 3);
});

test('digits that `up` loses are no move', () => {
  const { trail } = setUp();
  trail.sent({ type: 'fly' });
  trail.follow({ ...camera(0), up: [1e-15, 1, 0] });
  clock.advance(STILL_MS);
  assert.equal(trail.isEmpty, true);
});

test('it keeps many steps, and none of another scene', () => {
  const { trail, fly } = setUp();
  for (let x = 1; x <= 60; x += 1) fly(x);
  for (let x = 59; x >= 10; x -= 1) {
    assert.equal(trail.back().eye[0], x);
    fly(x);
  }
  assert.equal(trail.isEmpty, true);
  fly(70);
  trail.forget();
  assert.equal(trail.isEmpty, true);
  trail.follow(camera(9));
  clock.advance(STILL_MS);
  assert.equal(trail.isEmpty, true);
});
