import assert from 'node:assert/strict';
import { test } from 'node:test';
import { distance, dot } from '../../../web-client/base/vectors.js';
import { lookedAround, panned, rotated, zoomed } from '../../../web-client/navigation/camera-moves.js';
import { viewDirection } from '../../../web-client/navigation/camera.js';
import { withinReach } from '../../../web-client/stage/reach.js';

const CAMERA = { eye: [4, 2, 6], focus: [0, 0.5, 0], up: [0, 1, 0], center: [0, 0.5, 0], fov: 40 };
const from = rotated(CAMERA, 1, 1, true);
const degreesBetween = (a, b) => (Math.acos(Math.min(1, dot(viewDirection(a), viewDirection(b)))) * 180) / Math.PI;

test('what is near is drawn as it is asked for', () => {
  for (const to of [from, rotated(from, 12, 8, true), zoomed(from, 5, 3), panned(from, 0.2, 0.3), lookedAround(from, 15, 0, true)]) {
    assert.equal(withinReach(from, to), to);
  }
});

test('beyond, it lags behind more and more, without a jump', () => {
  let before = 0;
  for (let degrees = 1; degrees <= 170; degrees += 1) {
    const reached = degreesBetween(from, withinReach(from, rotated(from, degrees, 0, true)));
    assert.ok(reached >= before - 1e-6, `${degrees} degrees: back to ${reached}`);
    assert.ok(reached - before < 1.5, `${degrees} degrees: from ${before} to ${reached}`);
    assert.ok(reached < 35.1, `${degrees} degrees: ${reached}`);
    before = reached;
  }
  assert.ok(before > 30, `${before}`);
});

test('so it does aside', () => {
  let before = 0;
  for (let part = 0.1; part <= 5; part += 0.1) {
    const reached = distance(withinReach(from, panned(from, part, 0)).eye, from.eye);
    assert.ok(reached >= before - 1e-6, `${part}: ${reached}`);
    before = reached;
  }
  assert.ok(before <= Math.tan((35.1 * Math.PI) / 180) * distance(from.eye, from.focus));
});
