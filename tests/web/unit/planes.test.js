import assert from 'node:assert/strict';
import { describe, test } from 'node:test';
import {
  centerOf, flipped, movedCorner, nearestPoint, planeAcross, planeFacing, planeThrough, sweep,
} from '../../../web-client/base/planes.js';
import { add, distance, dot, length, normalize, scale, subtract } from '../../../web-client/base/vectors.js';
import { ARROW, arrowOf, draggedBy, footOf, turnedBy } from '../../../web-client/navigation/plane-drags.js';
import { lengthWords } from '../../../web-client/panels/sections-section.js';
import { moved, turned } from '../../../web-client/stage/plane-handle.js';
import { freeOf } from '../../../web-client/stage/view-size.js';
import { axes, focalLength, project } from '../projection.js';

const bounds = { min: [-1, 0, -2], max: [3, 2, 2] };
const camera = { eye: [6, 3, 9], focus: [0, 1, 0], up: [0, 1, 0], center: [0, 1, 0], fov: 40 };
const view = { width: 1000, height: 800 };
const lens = { camera, ...view };
const scene = { center: [1, 1, 0], radius: 3 };
const whole = freeOf(view, { top: 0, right: 0, bottom: 0, left: 0 });

const near = (actual, expected, tolerance = 1e-9) =>
  assert.ok(Math.hypot(...actual.map((x, i) => x - expected[i])) <= tolerance, `${actual} instead of ${expected}`);
/** From the view's top left corner. */
const seen = (point) => add([...project(camera, point, view), 0], [view.width / 2, view.height / 2, 0]).slice(0, 2);

describe('a plane', () => {
  test('sweeps the scene from one end to the other, and a fiftieth of its diagonal beyond', () => {
    const beyond = 0.02 * 6;
    near(Object.values(sweep([1, 0, 0], bounds)), [-1 - beyond, 3 + beyond]);
    near(Object.values(sweep([0, -1, 0], bounds)), [-2 - beyond, 0 + beyond]);
    const { min, max } = sweep(normalize([1, 1, -1]), bounds);
    near([min, max], [(-1 + 0 - 2) / Math.sqrt(3) - beyond, (3 + 2 + 2) / Math.sqrt(3) + beyond]);
  });

  test('through a point is made of a direction of any length', () => {
    assert.deepEqual(planeThrough([5, 1, 2], [0, 0, -4]), { normal: [0, 0, -1], distance: -2 });
  });

  test('turned round it is the same plane, and twice the same in all', () => {
    const plane = { normal: [0, 0.6, 0.8], distance: 2 };
    assert.deepEqual(flipped(plane), { normal: [0, -0.6, -0.8], distance: -2 });
    assert.deepEqual(flipped(flipped(plane)), plane);
    assert.deepEqual(flipped({ ...plane, distance: 0 }).distance, 0);
  });

  test('across an axis takes the half with the eye away', () => {
    assert.deepEqual(planeAcross(0, bounds, camera), { normal: [1, 0, 0], distance: 1 });
    assert.deepEqual(planeAcross(0, bounds, { eye: [0, 0, 0] }), { normal: [-1, 0, 0], distance: -1 });
    assert.deepEqual(planeAcross(2, bounds, camera), { normal: [0, 0, 1], distance: 0 });
  });

  test('like the view goes through the focus, and takes away what is nearer', () => {
    const { normal, distance: away } = planeFacing(camera);
    near([dot(normal, camera.focus)], [away]);
    assert.ok(dot(normal, camera.eye) > away);
  });

  test('has a point that is nearest to another', () => {
    const plane = { normal: [0, 0.6, 0.8], distance: 2 };
    const point = nearestPoint(plane, [7, 1, -3]);
    near([dot(plane.normal, point)], [2]);
    near(subtract(point, [7, 1, -3]), scale(plane.normal, dot(plane.normal, subtract(point, [7, 1, -3]))));
    near(centerOf(bounds), [1, 1, 0]);
  });
});

test('a side of a box stops before the opposite one', () => {
  const limits = { min: -2, max: 2 };
  const box = { min: [0, 0, 0], max: [1, 1, 1] };
  assert.deepEqual(movedCorner(box, 'max', 1, 0.25, limits), [1, 0.25, 1]);
  assert.deepEqual(movedCorner(box, 'min', 2, 1.5, limits), [0, 0, 1 - 0.02]);
  assert.deepEqual(movedCorner(box, 'max', 0, -1, limits), [0.02, 1, 1]);
});

test('a length is told to a thousandth of the scene', () => {
  assert.deepEqual([lengthWords(1.23456, 4), lengthWords(12.3456, 4000), lengthWords(0.00012345, 0.002)], ['1.235', '12', '0.000123']);
  assert.equal(lengthWords(1, 0), '1');
});

describe('the handle of a plane', () => {
  const plane = planeAcross(0, bounds, camera);

  test('stands where the plane is nearest to the middle of the scene', () => {
    near(footOf(lens, plane, scene, whole), [1, 1, 0]);
    near(footOf(lens, { ...plane, distance: 2 }, scene, whole), [2, 1, 0]);
  });

  test('where that is covered, in the middle of what is free, if the scene is there', () => {
    const free = freeOf(view, { top: 0, right: 0, bottom: 420, left: 0 });
    const foot = footOf(lens, planeAcross(2, bounds, camera), scene, free);
    near(seen(foot), [500, 190], 1e-6);
    near([foot[2]], [0]);
    const corner = freeOf(view, { top: 0, right: 900, bottom: 700, left: 0 });
    assert.equal(footOf(lens, planeAcross(2, bounds, camera), scene, corner), null);
    assert.equal(footOf(lens, { normal: [0, 0, 1], distance: 20 }, scene, whole), null);
  });

  test('stays where it was while that is on the plane and free', () => {
    const before = [1, 0.5, 1];
    assert.equal(footOf(lens, plane, scene, whole, before), before);
    near(footOf(lens, { ...plane, distance: 1.1 }, scene, whole, before), [1.1, 1, 0]);
    const free = freeOf(view, { top: 0, right: 0, bottom: 0, left: 1.2 * seen(before)[0] });
    assert.notEqual(footOf(lens, plane, scene, free, before), before);
  });

  test('its arrow lies along the normal as the camera sees that', () => {
    const foot = [1, 1, 0];
    const arrow = arrowOf(lens, foot, plane.normal);
    near([arrow.x, arrow.y], seen(foot), 1e-6);
    const [right, down] = subtract([...seen([1.01, 1, 0]), 0], [...seen(foot), 0]);
    near([arrow.degrees], [Math.atan2(down, right) * 180 / Math.PI], 0.01);
    assert.ok(arrow.length > 76 && arrow.length < 120, arrow.length);
    assert.equal(arrowOf(lens, [12, 5, 18], plane.normal), null);
  });

  test('its arrow points up where the normal points at the viewer', () => {
    const { normal, distance: away } = planeFacing(camera);
    const { degrees, length: long } = arrowOf(lens, scale(normal, away), normal);
    assert.deepEqual([degrees, long], [-90, 76]);
  });

  for (const [name, normal] of Object.entries({ x: [1, 0, 0], y: [0, 1, 0], z: [0, 0, -1], slanted: normalize([1, -2, 0.5]) })) {
    test(`its foot follows the finger as far as that goes along the arrow: ${name}`, () => {
      const foot = [1, 1, 0];
      const { degrees } = arrowOf(lens, foot, normal);
      const along = [Math.cos(degrees * Math.PI / 180), Math.sin(degrees * Math.PI / 180)];
      for (const pixels of [-90, 3, 70]) {
        const by = { x: along[0] * pixels - along[1] * 25, y: along[1] * pixels + along[0] * 25 };
        const after = add(foot, scale(normal, draggedBy(lens, foot, normal, by)));
        near(subtract([...seen(after), 0], [...seen(foot), 0]), [along[0] * pixels, along[1] * pixels, 0], 1e-6);
      }
    });
  }

  test('a drag upwards pulls it nearer where the normal points at the viewer', () => {
    const { forward } = axes(camera);
    const by = draggedBy(lens, camera.focus, scale(forward, -1), { x: 40, y: -50 });
    near([by], [50 * distance(camera.eye, camera.focus) / focalLength(camera, view)]);
  });

  test('a drag beyond the horizon does not move it', () => {
    const normal = [0, 0, -1];
    const { degrees } = arrowOf(lens, [1, 1, 0], normal);
    const far = { x: 5000 * Math.cos(degrees * Math.PI / 180), y: 5000 * Math.sin(degrees * Math.PI / 180) };
    assert.equal(draggedBy(lens, [1, 1, 0], normal, far), null);
    assert.equal(moved({ lens, plane: planeThrough([1, 1, 0], normal), bounds }, [1, 1, 0], far), null);
  });

  test('it stays within the scene, and where it was beyond that, it comes back', () => {
    const start = { lens, plane, bounds };
    const { min, max } = sweep(plane.normal, bounds);
    const { degrees } = arrowOf(lens, [1, 1, 0], plane.normal);
    const drag = (pixels) => ({ x: pixels * Math.cos(degrees * Math.PI / 180), y: pixels * Math.sin(degrees * Math.PI / 180) });
    const far = moved(start, [1, 1, 0], drag(400));
    assert.equal(far.plane.distance, max);
    near(far.foot, [max, 1, 0]);
    assert.equal(moved(start, [1, 1, 0], drag(-500)).plane.distance, min);
    const beyond = { ...start, plane: { normal: [1, 0, 0], distance: 4 } };
    assert.ok(moved(beyond, [4, 1, 0], drag(-20)).plane.distance < 4);
    assert.equal(moved(beyond, [4, 1, 0], drag(20)).plane.distance, 4);
  });

  test('its knob goes with the finger on a ball, and stays on its side', () => {
    const { right, up, forward } = axes(camera);
    const towards = scale(forward, -1);
    const turn = turnedBy(lens, towards, { x: ARROW / 2, y: 0 });
    near([dot(turn, right), dot(turn, up), length(turn)], [0.5, 0, 1]);
    assert.ok(dot(turn, towards) > 0);
    assert.ok(dot(turnedBy(lens, forward, { x: 0, y: 30 }), forward) > 0);
    near(turnedBy(lens, towards, { x: 0, y: -900 }), up);
    // Around the rim, where the finger is outside of it.
    near(turnedBy(lens, right, { x: 0, y: ARROW }), normalize(subtract(right, up)));
  });

  test('a turned plane goes through its foot', () => {
    const foot = [1, 0.5, 1];
    const { plane: { normal, distance: away }, foot: after } = turned({ lens, plane }, foot, { x: 30, y: -50 });
    near([dot(normal, foot), length(normal)], [away, 1]);
    assert.equal(after, foot);
  });
});
