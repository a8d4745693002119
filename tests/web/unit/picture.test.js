import assert from 'node:assert/strict';
import { test } from 'node:test';
import { Picture, viewMapping } from '../../../web-client/stage/picture.js';
import { replaceGlobals } from './fakes.js';

function setUp() {
  const page = { drawn: [], closed: [], decoding: [], classes: new Set(), box: { left: 0, top: 0, width: 100, height: 50 } };
  page.canvas = {
    style: {},
    width: 1,
    height: 1,
    dataset: {},
    classList: { toggle: (name, on) => (on ? page.classes.add(name) : page.classes.delete(name)) },
    // Without WebGL 2; e2e/warp.test.js has it.
    getContext: (kind) => (kind === '2d' ? { drawImage: (bitmap) => page.drawn.push(bitmap.name) } : null),
    get offsetLeft() { return page.box.left; },
    get offsetTop() { return page.box.top; },
    get offsetWidth() { return page.box.width; },
    get offsetHeight() { return page.box.height; },
  };
  page.picture = new Picture(page.canvas, () => new Promise((resolve, reject) => page.decoding.push({ resolve, reject })));
  page.decoded = (index, name) =>
    page.decoding[index].resolve({ name, width: 200, height: 100, close: () => page.closed.push(name) });
  return page;
}

const CAMERA = { eye: [0, 0, 10], focus: [0, 0, 0], up: [0, 1, 0], center: [0, 0, 0], fov: 90 };
const frame = (number, view = { width: 100, height: 50, pixelRatio: 2 }) => ({
  header: { frame: number, revision: number + 100, camera: CAMERA, view, quality: { level: 'still' } },
  data: new ArrayBuffer(1),
});

test('a frame is drawn pixel by pixel, and the canvas says which', async () => {
  const page = setUp();
  const shown = page.picture.show(frame(1));
  page.decoded(0, 'one');
  assert.equal(await shown, 'drawn');
  assert.deepEqual([page.canvas.width, page.canvas.height], [200, 100]);
  assert.deepEqual(page.canvas.dataset, { frame: 1, level: 'still', revision: 101 });
  assert.deepEqual(page.drawn, ['one']);
  assert.deepEqual(page.closed, ['one']);
  assert.equal(page.picture.header.frame, 1);
});

test('a frame that is decoded behind a newer one is dropped', async () => {
  const page = setUp();
  const first = page.picture.show(frame(1));
  const second = page.picture.show(frame(2));
  page.decoded(1, 'two');
  assert.equal(await second, 'drawn');
  page.decoded(0, 'one');
  assert.equal(await first, 'late');
  assert.deepEqual(page.drawn, ['two']);
  assert.deepEqual(page.closed, ['two', 'one']);
});

test('frames of a restarted server count as newer, whatever their number', async () => {
  const page = setUp();
  const old = page.picture.show(frame(900));
  page.decoded(0, 'old');
  await old;
  const young = page.picture.show(frame(1));
  page.decoded(1, 'young');
  assert.equal(await young, 'drawn');
  assert.equal(page.canvas.dataset.frame, 1);
});

test('what cannot be read leaves the picture as it is', async () => {
  const page = setUp();
  assert.equal(await page.picture.show({ header: null, data: new ArrayBuffer(1) }), 'failed');
  const shown = page.picture.show(frame(1));
  page.decoding[0].reject(new Error('no JPEG'));
  assert.equal(await shown, 'failed');
  assert.deepEqual(page.drawn, []);
  assert.equal(page.picture.header, null);
});

test('the picture fills a page of its own size, and is fitted into any other', async () => {
  const page = setUp();
  const shown = page.picture.show(frame(1));
  page.decoded(0, 'one');
  await shown;
  assert.ok(page.classes.has('fills'));
  page.box = { left: 0, top: 0, width: 50, height: 100 };
  page.picture.layout();
  assert.ok(!page.classes.has('fills'));
  assert.deepEqual(page.picture.mapping()(25, 50), { x: 50, y: 25 });
});

test('before the first picture the view is the page', () => {
  const page = setUp();
  page.box = { left: 10, top: 20, width: 100, height: 50 };
  assert.deepEqual(page.picture.mapping()(15, 30), { x: 5, y: 10 });
});

/** A camera that the fingers have moved by so many pixels of a view that is 100 high, and nearer by a factor. */
function moved(right, down, nearer = 1) {
  const shift = [-right * 0.2 / nearer, down * 0.2 / nearer, 0];
  const add = (point) => point.map((x, i) => x + shift[i]);
  return { ...CAMERA, eye: add([0, 0, 10 / nearer]), focus: add([0, 0, 0]) };
}

/** "translate(15px, -4px) scale(2)" as [15, -4, 2], rounded. */
const numbersOf = ({ style }) => (style.transform.match(/-?[\d.]+(e-\d+)?/g) ?? []).map((x) => Math.round(x * 1e6) / 1e6 + 0);

test('a picture is moved in the pixels of the view that it shows, and goes back', async () => {
  const page = setUp();
  const shown = page.picture.show(frame(1, { width: 200, height: 100, pixelRatio: 2 }));
  page.decoded(0, 'one');
  await shown;
  page.picture.look(null);
  assert.equal(page.canvas.style.transform, '');
  page.picture.look(moved(30, -8, 2));
  assert.deepEqual(numbersOf(page.canvas), [15, -4, 2]);
  page.picture.look(moved(0, 10, 0.5));
  assert.deepEqual(numbersOf(page.canvas), [0, 5, 0.5]);
  // A turn waits for its frame.
  page.picture.look({ ...CAMERA, eye: [1, 0, 10] });
  assert.equal(page.canvas.style.transform, '');
  page.picture.look(CAMERA);
  assert.equal(page.canvas.style.transform, '');
});

test('wherever it is moved, coordinates are those of its place', async () => {
  const page = setUp();
  page.box = { left: 10, top: 20, width: 100, height: 200 };
  const shown = page.picture.show(frame(1, { width: 200, height: 100, pixelRatio: 2 }));
  page.decoded(0, 'one');
  await shown;
  page.picture.look(moved(300, -50, 0.25));
  assert.deepEqual(page.picture.mapping()(60, 120), { x: 100, y: 50 });
  assert.deepEqual(page.picture.mapping()(10, 95), { x: 0, y: 0 });
  assert.ok(!page.classes.has('fills'));
  // The page is turned, and so is the way that the picture is moved by.
  page.box = { left: 0, top: 0, width: 200, height: 100 };
  page.picture.layout();
  assert.ok(page.classes.has('fills'));
  page.box = { left: 0, top: 0, width: 50, height: 100 };
  page.picture.layout();
  assert.deepEqual(numbersOf(page.canvas), [75, -12.5, 0.25]);
});

test('a point of the world is seen where the picture shows it, also while that is moved', async () => {
  const page = setUp();
  assert.equal(page.picture.placeOf([0, 0, 0]), null);
  const shown = page.picture.show(frame(1, { width: 200, height: 100, pixelRatio: 2 }));
  page.decoded(0, 'one');
  await shown;
  const near = (point, x, y) => {
    const place = page.picture.placeOf(point);
    assert.ok(Math.hypot(place.x - x, place.y - y) < 1e-9, JSON.stringify(place));
  };
  near([0, 0, 0], 100, 50);
  near([10, 5, 0], 150, 25);
  near([-19, -9.5, 0], 5, 97.5);
  for (const point of [[0, 0, 20], [0, 0, 10], [21, 0, 0], [0, -11, 0], [NaN, 0, 0]]) {
    assert.equal(page.picture.placeOf(point), null);
  }
  page.picture.look(moved(-20, 4, 1.5));
  near([10, 5, 0], 100 + 75 - 20, 50 - 37.5 + 4);
});

test('lines are seen where the picture shows them, within it', async () => {
  const page = setUp();
  assert.deepEqual(page.picture.paths([[[0, 0, 0], [1, 0, 0]]]), [[]]);
  const shown = page.picture.show(frame(1, { width: 200, height: 100, pixelRatio: 2 }));
  page.decoded(0, 'one');
  await shown;
  page.box = { left: 10, top: 20, width: 100, height: 200 };
  const rounded = () => page.picture.paths([[[0, 0, 0], [10, 5, 0], [40, 5, 0]], [[0, 0, 20], [0, 0, 30]]])
    .map((pieces) => pieces.map((piece) => piece.map(({ x, y }) => [Math.round(x), Math.round(y)])));
  assert.deepEqual(rounded(), [[[[60, 120], [85, 108], [110, 108]]], []]);
  page.picture.look(moved(-20, 4, 1.5));
  assert.deepEqual(rounded(), [[[[50, 122], [88, 103], [110, 103]]], []]);
});

test('what is around a place is drawn larger', async () => {
  const page = setUp();
  const calls = [];
  const target = {
    width: 240, height: 240,
    getContext: () => ({ clearRect: () => {}, drawImage: (_, ...numbers) => calls.push(numbers.map(Math.round)) }),
  };
  const replaced = replaceGlobals({ devicePixelRatio: 2 });
  try {
    page.picture.magnify(target, { x: 0, y: 0 }, 3);
    assert.deepEqual(calls, []);
    const shown = page.picture.show(frame(1));
    page.decoded(0, 'one');
    await shown;
    page.picture.magnify(target, { x: 50, y: 20 }, 3);
    // 240 pixels are 120 of the window and 40 of the view, which is drawn with two pixels for each.
    assert.deepEqual(calls, [[60, 0, 80, 80, 0, 0, 240, 240]]);
    page.picture.look(moved(10, 0, 2));
    page.picture.magnify(target, { x: 50, y: 20 }, 3);
    assert.ok(calls[1][2] === 40);
  } finally {
    replaced();
  }
});

test('coordinates go through the bars beside a fitted picture', () => {
  const wide = viewMapping({ left: 0, top: 0, width: 400, height: 800 }, { width: 800, height: 400 });
  assert.deepEqual(wide(200, 400), { x: 400, y: 200 });
  assert.deepEqual(wide(0, 400), { x: 0, y: 200 });
  assert.ok(wide(200, 0).y < 0);
  const tall = viewMapping({ left: 100, top: 50, width: 800, height: 400 }, { width: 400, height: 800 });
  assert.deepEqual(tall(500, 250), { x: 200, y: 400 });
  assert.deepEqual(tall(600, 450), { x: 400, y: 800 });
});

test('a frame that is drawn ahead is shown as from the camera that its header names', async () => {
  const page = setUp();
  const ahead = { ...frame(1), data: new ArrayBuffer(1) };
  ahead.header.depth = { bytes: 0, camera: { ...CAMERA, eye: [1, 0, 10], focus: [1, 0, 0] } };
  const shown = page.picture.show(ahead);
  page.decoded(0, 'one');
  await shown;
  // A step to the right moves what is 10 away, where 20 fill the height of 50 pixels, to the left.
  assert.match(page.canvas.style.transform, /^translate\(2\.50*\d?px, 0px\) scale\(1\)$/);
  assert.deepEqual(page.picture.placeOf([0, 0, 0]), { x: 50, y: 25 });
});
