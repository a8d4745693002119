import assert from 'node:assert/strict';
import { beforeEach, test } from 'node:test';
import { PlaneHandle } from '../../../web-client/stage/plane-handle.js';
import { fakeEvent } from './fakes.js';

/** As much of an element as the handle uses. */
class Part extends EventTarget {
  attributes = {};

  constructor(grip) {
    super();
    this.dataset = { grip };
  }

  setAttribute(name, value) {
    this.attributes[name] = value;
  }

  setPointerCapture() {}
}

const camera = { eye: [0, 0, 10], focus: [0, 0, 0], up: [0, 1, 0], center: [0, 0, 0], fov: 90 };
const view = { width: 1000, height: 1000 }; // 50 pixels for 1 in the scene's middle
const shown = (plane) => ({
  lens: { camera, ...view }, onWindow: (place) => place, perPixel: 1, name: 'Section 1', plane,
  free: { left: 0, top: 0, right: 1000, bottom: 1000 }, bounds: { min: [-3, -3, -3], max: [3, 3, 3] },
});

let parts;
let frames;
let changes;
let handle;
let hidden;

beforeEach(() => {
  parts = { 'g': new Part(), 'path': new Part(), '[data-grip="move"]': new Part('move'), '[data-grip="turn"]': new Part('turn') };
  frames = [];
  changes = [];
  const svg = {
    querySelector: (name) => parts[name],
    querySelectorAll: (name) => (name === 'line' ? [] : Object.values(parts).filter(({ dataset }) => dataset.grip)),
    toggleAttribute: (_, isSet) => { hidden = isSet; },
  };
  const change = (_, plane) => new Promise((answer) => changes.push({ plane, answer }));
  handle = new PlaneHandle(svg, { change, soon: (action) => frames.push(action) });
  handle.show(shown({ normal: [1, 0, 0], distance: 0 }));
});

const displayFrame = () => {
  for (const action of frames.splice(0)) action();
};
const touch = (type, clientX, clientY = 500, grip = 'move', pointerId = 1) => {
  const part = parts[`[data-grip="${grip}"]`];
  part.dispatchEvent(fakeEvent(`pointer${type}`, { pointerId, clientX, clientY, button: 0 }));
};
const place = () => parts.g.attributes.transform;
const settled = () => new Promise(setImmediate);

test('a drag sends its last plane once a display frame, and the last of all after its end', () => {
  touch('down', 500);
  for (const x of [510, 520, 530]) touch('move', x);
  assert.equal(changes.length, 0);
  displayFrame();
  assert.deepEqual(changes.map(({ plane }) => plane.distance.toFixed(9)), ['0.600000000']);
  displayFrame();
  assert.equal(changes.length, 1);
  touch('move', 540);
  touch('move', 550);
  touch('up', 550);
  displayFrame();
  assert.deepEqual(changes.map(({ plane }) => plane.distance.toFixed(9)), ['0.600000000', '1.000000000']);
});

test('it stays with the finger until the server has answered, and then is where the state says', async () => {
  touch('down', 500);
  touch('move', 550);
  assert.equal(place(), 'translate(550.0 500.0) rotate(0.00)');
  touch('up', 550);
  displayFrame();
  handle.show(shown({ normal: [1, 0, 0], distance: 0.5 }));
  assert.equal(place(), 'translate(550.0 500.0) rotate(0.00)');
  changes[0].answer();
  await settled();
  displayFrame();
  await settled();
  assert.equal(place(), 'translate(525.0 500.0) rotate(0.00)');
});

test('another finger does nothing meanwhile', () => {
  touch('down', 500);
  touch('down', 620, 500, 'turn', 2);
  touch('move', 620, 560, 'turn', 2);
  touch('up', 620, 560, 'turn', 2);
  assert.equal(frames.length, 0);
  touch('move', 510);
  assert.equal(place(), 'translate(510.0 500.0) rotate(0.00)');
});

test('the knob turns the plane about its foot', () => {
  touch('down', 620, 500, 'turn');
  touch('move', 620, 620, 'turn');
  displayFrame();
  const [{ plane: { normal, distance } }] = changes;
  assert.deepEqual([...normal, distance].map((x) => x.toFixed(3).replace('-0.000', '0.000')), ['0.707', '-0.707', '0.000', '0.000']);
  assert.equal(place(), 'translate(500.0 500.0) rotate(45.00)');
});

test('a plane that goes takes the drag with it', () => {
  touch('down', 500);
  handle.show(null);
  assert.equal(hidden, true);
  touch('move', 550);
  displayFrame();
  assert.equal(changes.length, 0);
});
