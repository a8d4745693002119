import assert from 'node:assert/strict';
import { after, before, beforeEach, test } from 'node:test';
import { Preparation } from '../../../web-client/stage/preparation.js';
import { FakeClock, FakeWindow, replaceGlobals } from './fakes.js';

const CAMERA = { eye: [0, 0, 5], focus: [0, 0, 0], up: [0, 1, 0], center: [0, 0, 0], fov: 40 };
const STATE = {
  scene: { bounds: { min: [-1, -1, -1], max: [1, 1, 1] }, seats: [] },
  navigation: { style: 'vrut', panSpeed: 1, zoomSpeed: 1, rotateSpeed: 1, keepUpright: true, turnAbout: 'center' },
  views: { home: CAMERA },
  cues: { Door: { camera: CAMERA }, Wide: { camera: { ...CAMERA, fov: 70 } } },
};
const settled = () => new Promise(setImmediate);

let giveBack;
let window;
let clock;
let page;

before(() => {
  giveBack = replaceGlobals({
    window: new FakeWindow(), requestAnimationFrame: (action) => window.requestAnimationFrame(action),
    setTimeout: (...timer) => clock.setTimeout(...timer), clearTimeout: (timer) => clock.clearTimeout(timer),
  });
});
after(() => giveBack());

beforeEach(() => {
  window = globalThis.window;
  clock = new FakeClock();
  const image = { removeAttribute: () => delete image.src };
  const layer = Object.assign(new EventTarget(), { hidden: true, querySelector: () => image, setPointerCapture() {} });
  page = { layer, image, asked: [], moved: [], state: structuredClone(STATE) };
  page.preparation = new Preparation(layer, {
    draw: (wanted) => new Promise((resolve) => { page.asked.push({ wanted, resolve }); }),
    state: () => page.state,
    view: () => ({ width: 400, height: 300, pixelRatio: 2 }),
    mapping: () => (x, y) => ({ x, y }),
    rules: () => ({}),
    moved: (camera) => page.moved.push(camera),
  });
  page.draw = async () => {
    page.asked.at(-1).resolve({ data: new Uint8Array(1) });
    await settled();
  };
  page.pointer = (type, clientX, more = {}) => layer.dispatchEvent(Object.assign(new Event(type, { cancelable: true }), {
    pointerId: 1, pointerType: 'touch', clientX, clientY: 100, button: type === 'pointermove' ? -1 : 0, buttons: 1,
    altKey: false, ctrlKey: false, metaKey: false, shiftKey: false, ...more,
  }));
});

test('a cue is drawn coarsely at once, and well when nothing moves', async () => {
  page.preparation.show('Door');
  assert.equal(page.layer.hidden, false);
  assert.deepEqual(page.asked.map(({ wanted }) => wanted), [{ width: 200, height: 150, cue: 'Door', samples: 1, jpegQuality: 75 }]);
  await page.draw();
  assert.ok(page.image.src);
  assert.equal(page.asked.length, 1);
  clock.advance(150);
  assert.deepEqual(page.asked[1].wanted, { width: 800, height: 600, cue: 'Door', jpegQuality: 90 });
  await page.draw();
  clock.advance(1000);
  assert.equal(page.asked.length, 2);
});

test('hands turn it, one picture is on its way at a time, and the newest camera is drawn', async () => {
  page.preparation.show('Door');
  page.pointer('pointerdown', 100);
  for (const x of [110, 120, 130]) {
    page.pointer('pointermove', x);
    window.displayFrame();
  }
  assert.equal(page.asked.length, 1);
  await page.draw();
  assert.equal(page.asked.length, 2);
  const { camera, samples } = page.asked[1].wanted;
  assert.equal(samples, 1);
  assert.deepEqual(camera.eye, page.moved.at(-1).eye);
  assert.notDeepEqual(camera.eye, CAMERA.eye);
  page.pointer('pointerup', 130, { buttons: 0 });
  await page.draw();
  clock.advance(150);
  assert.deepEqual(page.asked.at(-1).wanted.camera, camera);
});

test('another cue begins at its own camera, and what was on its way is not shown', async () => {
  page.preparation.show('Door');
  page.pointer('pointerdown', 100);
  page.pointer('pointermove', 150);
  window.displayFrame();
  page.pointer('pointerup', 150, { buttons: 0 });
  page.preparation.show('Wide');
  assert.equal(page.moved.at(-1), undefined);
  await page.draw();
  assert.equal(page.image.src, undefined);
  assert.deepEqual(page.asked.at(-1).wanted, { width: 200, height: 150, cue: 'Wide', samples: 1, jpegQuality: 75 });
  page.preparation.show(null);
  assert.equal(page.layer.hidden, true);
  assert.equal(page.preparation.isOn, false);
  await page.draw();
  assert.equal(page.image.src, undefined);
  assert.equal(clock.next, undefined);
});

test('a picture that is not drawn is no end of it, and a cue that is gone is', async () => {
  page.preparation.show('Door');
  page.asked[0].resolve(undefined);
  await settled();
  clock.advance(150);
  assert.equal(page.asked.length, 2);
  delete page.state.cues.Door;
  page.preparation.show('Door');
  assert.equal(page.layer.hidden, true);
  page.pointer('pointerdown', 100);
  page.pointer('pointermove', 150);
  window.displayFrame();
  assert.deepEqual(page.moved.filter(Boolean), []);
});

test('while it rests no hand turns it, and then it goes on from the camera it had', async () => {
  page.preparation.show('Door');
  await page.draw();
  page.pointer('pointerdown', 100);
  page.pointer('pointermove', 150);
  window.displayFrame();
  await page.draw();
  const turned = page.moved.at(-1);
  const { src } = page.image;
  const { length } = page.asked;
  page.preparation.rest();
  page.pointer('pointermove', 180);
  page.pointer('pointerup', 180, { buttons: 0 });
  window.displayFrame();
  clock.advance(1000);
  assert.equal(page.asked.length, length);
  assert.deepEqual([page.moved.at(-1), page.image.src, page.layer.hidden, page.preparation.isOn], [turned, src, false, true]);
  page.preparation.show('Door');
  const { camera, samples } = page.asked.at(-1).wanted;
  assert.deepEqual([camera.eye, samples], [turned.eye, undefined]);
  await page.draw();
  page.pointer('pointerdown', 100);
  page.pointer('pointermove', 101);
  window.displayFrame();
  const [from, to] = [turned, page.moved.at(-1)].map(({ eye }) => eye);
  assert.ok(to !== from && Math.hypot(...to.map((x, i) => x - from[i])) < 0.5, String([from, to]));
});
