import assert from 'node:assert/strict';
import { readFileSync, readdirSync } from 'node:fs';
import { describe, test } from 'node:test';
import { add, cross, distance, dot, length, scale, subtract } from '../../../web-client/base/vectors.js';
import { directionThrough, isValidPose, withOrthogonalUp } from '../../../web-client/navigation/camera.js';
import { lookedAround, panned, rotated, zoomed } from '../../../web-client/navigation/camera-moves.js';
import { CameraPath } from '../../../web-client/navigation/flight.js';
import { Gestures } from '../../../web-client/navigation/gestures.js';
import { keyOperation } from '../../../web-client/navigation/keys.js';
import { contextOf, gestures } from './gestures.js';

/** Of a vector's length: the server's arithmetic is the same but for rounding. */
const WITHIN = 1e-9;
const CAMERA = { eye: [4, 2.5, 6], focus: [0.25, 0.75, -0.125], up: [0, 1, 0], center: [0, 0.5, 0], fov: 40 };

function assertNear(actual, expected, what) {
  const error = distance(actual, expected);
  assert.ok(error <= WITHIN * Math.max(length(expected), 1), `${what}: ${actual} instead of ${expected}`);
}

function after(fed, message, camera, context) {
  switch (message.type) {
    case 'keydown':
      return fed.keyDown(message, camera, context);
    case 'keyup':
      fed.keyUp(message);
      return camera;
    case 'wheel':
      return fed.wheel(message, camera, context);
    default:
      return fed.pointer(message, camera, context);
  }
}

describe('each gesture moves the camera as the server does', () => {
  for (const gesture of gestures) {
    test(gesture.name, () => {
      const context = contextOf(gesture);
      const fed = new Gestures();
      let camera = withOrthogonalUp(gesture.camera);
      for (const [i, message] of gesture.messages.entries()) {
        camera = after(fed, message, camera, context);
        for (const member of ['eye', 'focus', 'up']) {
          assertNear(camera[member], gesture.cameras[i][member], `${member} after message ${i}`);
        }
      }
    });
  }
});

test('a copy goes on by itself, from any message on', () => {
  for (const gesture of gestures) {
    const context = contextOf(gesture);
    const { messages } = gesture;
    for (let fork = 0; fork < messages.length; fork += 1) {
      const fed = new Gestures();
      let camera = withOrthogonalUp(gesture.camera);
      for (const message of messages.slice(0, fork)) camera = after(fed, message, camera, context);
      const copy = fed.copy();
      const rest = messages.slice(fork);
      const end = (one) => rest.reduce((before, message) => after(one, message, before, context), camera);
      assert.deepEqual(end(copy), end(fed), `${gesture.name} from ${fork}`);
    }
  }
});

// --- what no file holds

const CONTEXT = contextOf({
  view: { width: 1180, height: 820 },
  bounds: { min: [-2, 0, -1], max: [2, 1.5, 1] },
  navigation: { style: 'vrut', keepUpright: true, rotateSpeed: 1, panSpeed: 1, zoomSpeed: 1 },
});
const START = withOrthogonalUp(CAMERA);
const finger = (what, pointerId, x, y) => ({
  type: `pointer${what}`, pointerId, pointerType: 'touch', x, y, button: what === 'move' ? -1 : 0,
  buttons: what === 'up' ? 0 : 1,
});
const key = (name) => ({ type: 'keydown', key: name, code: name });

test('drags begin anew where another camera is set, about what is found there or what was touched before', () => {
  const context = { ...CONTEXT, turnAboutTouched: true };
  const places = [];
  const other = panned(START, 0.01, 0, 5);
  const turn = (keepsTouched) => {
    const found = [[0, 1, 0], [1, 0, 0]];
    const surfaceAt = (camera, place) => {
      places.push([camera, place]);
      return found.shift();
    };
    const fed = new Gestures();
    fed.pointer(finger('down', 1, 500, 400), START, context);
    fed.pointer(finger('move', 1, 550, 400), START, { ...context, surfaceAt });
    const copy = fed.copy();
    copy.restart(other, keepsTouched);
    return copy.pointer(finger('move', 1, 600, 400), other, { ...context, surfaceAt });
  };
  const about = (center) => ({ ...rotated({ ...other, center }, 50 * 180 / 820, 0, true), center: other.center });
  assert.deepEqual(turn(false), about([1, 0, 0]));
  assert.deepEqual(places.splice(0), [[START, { x: 500, y: 400 }], [other, { x: 550, y: 400 }]]);
  assert.deepEqual(turn(true), about([0, 1, 0]));
  assert.deepEqual(places, [[START, { x: 500, y: 400 }]]);
});

test('keys: Home goes to the view of that name, what the server alone knows is null', () => {
  const fed = new Gestures();
  const home = { ...START, eye: [9, 9, 9] };
  assert.equal(fed.keyDown(key('Home'), START, { ...CONTEXT, home }), home);
  assert.equal(fed.keyDown(key('Home'), START, CONTEXT), null);
  assert.equal(fed.keyDown(key('f'), START, CONTEXT), null);
  for (const name of ['w', 's', 'Escape', '1']) assert.equal(fed.keyDown(key(name), START, CONTEXT), START, name);
  assert.equal(keyOperation(key('f')), null);
  assert.equal(keyOperation(key('x')), null);
  assert.deepEqual(keyOperation({ key: 'ArrowUp', shiftKey: true }), { kind: 'pan', by: [0, -0.05] });
});

test('what hovers does nothing', () => {
  const fed = new Gestures();
  const mouse = { ...finger('move', 1, 500, 400), pointerType: 'mouse', buttons: 0 };
  assert.equal(fed.pointer(mouse, START, CONTEXT), START);
  assert.equal(fed.pointer(finger('up', 1, 500, 400), START, CONTEXT), START);
});

test('of more pointers than the server knows the further ones do nothing', () => {
  const fed = new Gestures();
  const pan = (what, pointerId, x) => ({
    ...finger(what, pointerId, x, 400), pointerType: 'mouse', button: what === 'move' ? -1 : 2, buttons: 2,
  });
  for (let id = 1; id <= 17; id += 1) fed.pointer(pan('down', id, 500), START, CONTEXT);
  assert.equal(fed.pointer(pan('move', 17, 600), START, CONTEXT), START);
  assert.notEqual(fed.pointer(pan('move', 16, 600), START, CONTEXT), START);
});

test('a move of nothing, or to where no number is, leaves the camera itself', () => {
  for (const keepUpright of [true, false]) {
    assert.equal(rotated(START, 0, 0, keepUpright), START);
    assert.equal(rotated(START, NaN, 1, keepUpright), START);
    assert.equal(lookedAround(START, 0, 0, keepUpright), START);
    assert.equal(lookedAround(START, Infinity, 1, keepUpright), START);
  }
  assert.equal(panned(START, 0, 0), START);
  assert.equal(panned(START, 1e300, 0, 1e300), START);
  assert.equal(zoomed(START, 1, 3), START);
  assert.equal(zoomed(START, NaN, 3), START);
  assert.notEqual(zoomed(START, 2, 3), START);
});

test('a pose without a direction is not valid', () => {
  assert.ok(isValidPose(START, 3));
  assert.ok(!isValidPose({ ...START, eye: START.focus }, 3));
  assert.ok(!isValidPose(START, 1e11));
  assert.ok(!isValidPose({ ...START, up: [0, 0, 0] }, 3));
  assert.ok(!isValidPose({ ...START, up: subtract(START.focus, START.eye) }, 3));
  assert.ok(!isValidPose({ ...START, center: [0, NaN, 0] }, 3));
});

// --- flights

const FLIGHTS = new URL('../../data/flights/', import.meta.url);

describe('each flight passes the cameras that the server passes', () => {
  for (const name of readdirSync(FLIGHTS)) {
    test(name, () => {
      const { from, keyframes, easing, at, cameras } = JSON.parse(readFileSync(new URL(name, FLIGHTS), 'utf8'));
      const poses = keyframes.map(({ at: time, camera }) => ({ at: time, camera: withOrthogonalUp(camera) }));
      const path = new CameraPath(withOrthogonalUp(from), poses, easing);
      assert.equal(path.duration, keyframes.at(-1).at);
      assert.equal(path.at(path.duration), poses.at(-1).camera);
      for (const [i, ms] of at.entries()) {
        const camera = path.at(ms);
        for (const member of ['eye', 'focus', 'up', 'center']) {
          assertNear(camera[member], cameras[i][member], `${member} at ${ms} ms`);
        }
        assertNear([camera.fov, 0, 0], [cameras[i].fov, 0, 0], `fov at ${ms} ms`);
      }
    });
  }
});

test('a flight is smooth where it is not told', () => {
  const keyframes = [{ at: 100, camera: rotated(START, 40, 10, true) }];
  assert.deepEqual(new CameraPath(START, keyframes).at(30), new CameraPath(START, keyframes, 'smooth').at(30));
});
