import assert from 'node:assert/strict';
import { after, before, describe, test } from 'node:test';
import { depthOf, pointAt, project } from '../projection.js';
import { Server } from './program.js';
import { HeldLink } from './held-link.js';
import { Tablet, browserIsMissing, launchBrowser } from './tablet.js';

const TABLET = { width: 1180, height: 820, pixelRatio: 2 };
const MIDDLE = [TABLET.width / 2, TABLET.height / 2];
const WITHIN_PX = 2;
const FADED_WITHIN_MS = 2000;

const apart = (a, b) => Math.hypot(a[0] - b[0], a[1] - b[1]);
const grid = [-0.4, -0.2, 0, 0.3, 0.45].flatMap((x) => [-0.4, 0, 0.35].map((y) => [x * TABLET.width, y * TABLET.height]));

/** Where what is drawn at a place, measured from the view's middle, is seen while the picture is moved. */
const moved = ({ a: scale, e: x, f: y }, place) => [scale * place[0] + x, scale * place[1] + y];

let browser;

before(async () => {
  if (!browserIsMissing) browser = await launchBrowser();
});

after(() => browser?.close());

describe('hands on a tablet without WebGL 2 whose pictures are late', { skip: browserIsMissing }, () => {
  let server;
  let link;
  let tablet;

  before(async () => {
    server = await Server.start();
    link = await HeldLink.open(server.port);
    tablet = await Tablet.open(browser, link.address, TABLET);
    await tablet.wire.until('control', () => tablet.wire.state?.control.holder);
    await tablet.page.evaluate(() => {
      // Where the latest messages say that the fingers are.
      globalThis.fingers = {};
      const { send } = WebSocket.prototype;
      WebSocket.prototype.send = function listening(text) {
        const { type, pointerId, x, y, id } = JSON.parse(text);
        if (type.startsWith('pointer')) globalThis.fingers[pointerId] = [x, y];
        if (id) globalThis.lastId = id;
        send.call(this, text);
      };
    });
  });

  after(async () => {
    for (const context of browser?.contexts() ?? []) await context.close();
    link?.close();
    await server?.stop();
  });

  const touch = (type, ...places) =>
    tablet.devtools.send('Input.dispatchTouchEvent', { type, touchPoints: places.map(([x, y], id) => ({ id, x, y })) });

  /** What a display frame shows, and what was sent until then. */
  const look = () =>
    tablet.page.evaluate(() => new Promise((resolve) => {
      requestAnimationFrame(() => requestAnimationFrame(() => {
        const canvas = document.querySelector('#view');
        const { a, e, f } = new DOMMatrix(getComputedStyle(canvas).transform);
        const places = Object.values(globalThis.fingers).slice(-2);
        resolve({ frame: Number(canvas.dataset.frame), transform: { a, e, f }, places, lastId: globalThis.lastId });
      }));
    }));

  const marks = () =>
    tablet.page.evaluate(() => [...document.querySelectorAll('.finger-mark.pressed')].map((mark) => {
      const { x, y, width, height } = mark.getBoundingClientRect();
      return [x + width / 2, y + height / 2];
    }));

  const header = ({ frame }) => tablet.wire.frames.find((candidate) => candidate.frame === frame);

  /** Until no frame comes any more: that which shows all, at its finest. */
  async function settled() {
    const { lastId } = await look();
    await tablet.wire.still(lastId);
    await tablet.wire.finest();
    await tablet.shows(tablet.wire.frames.at(-1).frame);
  }

  test('a mark goes with each finger and away with it', async () => {
    await settled();
    assert.deepEqual(await marks(), []);
    await touch('touchStart', [300, 500]);
    await touch('touchStart', [300, 500], [700, 300]);
    assert.deepEqual(await marks(), [[300, 500], [700, 300]]);
    await touch('touchMove', [320, 540], [760, 280]);
    await look();
    assert.deepEqual(await marks(), [[320, 540], [760, 280]]);
    await tablet.screenshot('finger-marks');
    await touch('touchMove', [-40, 540], [760, 280]);
    await look();
    assert.deepEqual(await marks(), [[-40, 540], [760, 280]]);
    await touch('touchCancel');
    assert.deepEqual(await marks(), []);
    await tablet.page.waitForFunction(() =>
      [...document.querySelectorAll('.finger-mark')].every((mark) => getComputedStyle(mark).opacity === '0'),
    undefined, { timeout: FADED_WITHIN_MS });
  });

  test('two fingers take the picture along at once, and the next one lies where it was taken to', async () => {
    await settled();
    await tablet.screenshot('hands-before');
    const start = await look();
    assert.deepEqual(start.transform, { a: 1, e: 0, f: 0 });
    const { point: touched } = await tablet.pick([600, 425]);
    link.hold();
    await touch('touchStart', [500, 400]);
    await touch('touchStart', [500, 400], [700, 450]);
    await touch('touchMove', [520, 390], [720, 440]);
    const panned = await look();
    assert.equal(panned.frame, start.frame);
    assert.ok(apart([panned.transform.e, panned.transform.f], [20, -10]) < 0.01, JSON.stringify(panned.transform));
    assert.ok(Math.abs(panned.transform.a - 1) < 1e-9);

    await touch('touchMove', [470, 380], [760, 450]);
    await touch('touchEnd');
    const late = await look();
    assert.equal(late.frame, start.frame);
    assert.ok(late.transform.a > 1.3, JSON.stringify(late.transform));
    await tablet.screenshot('hands-late');

    link.release();
    const drawn = await tablet.wire.still(late.lastId);
    await tablet.shows(drawn.frame);
    assert.deepEqual((await look()).transform, { a: 1, e: 0, f: 0 });
    await tablet.screenshot('hands-drawn');

    const old = header(start).camera;
    for (const place of grid) {
      const point = pointAt(drawn.camera, place, TABLET, depthOf(drawn.camera, touched));
      const predicted = moved(late.transform, project(old, point, TABLET));
      assert.ok(apart(predicted, place) <= WITHIN_PX, `${predicted} instead of ${place}`);
    }
  });

  test('while pictures trickle in, what was touched stays under the finger', async () => {
    await settled();
    const start = await look();
    const [x, y] = [500, 600];
    const { camera: old } = header(start);
    // What the first finger touches, as deep as what lies between the two.
    const depth = depthOf(old, (await tablet.pick([x + 100, y])).point ?? old.focus);
    const touched = pointAt(old, [x - MIDDLE[0], y - MIDDLE[1]], TABLET, depth);
    const frames = new Set();
    let movedAhead = 0;
    link.hold();
    await touch('touchStart', [x, y]);
    await touch('touchStart', [x, y], [x + 200, y]);
    for (let step = 1; step <= 24; step += 1) {
      const by = [12 * step, -9 * step];
      await touch('touchMove', [x + by[0], y + by[1]], [x + 200 + by[0], y + by[1]]);
      const seen = await look();
      const { camera, view } = header(seen);
      assert.deepEqual(view, TABLET);
      const at = moved(seen.transform, project(camera, touched, TABLET));
      const [finger] = seen.places;
      assert.deepEqual(finger, [x + by[0], y + by[1]]);
      const beside = apart([at[0] + MIDDLE[0], at[1] + MIDDLE[1]], finger);
      assert.ok(beside <= WITHIN_PX, `step ${step}: ${beside} pixels beside the finger`);
      frames.add(seen.frame);
      if (apart([seen.transform.e, seen.transform.f], [0, 0]) > 5) movedAhead += 1;
      if (step % 4 === 0) link.pass();
    }
    await touch('touchEnd');
    link.release();
    await settled();
    assert.ok(frames.size >= 3, `${frames.size} pictures`);
    assert.ok(movedAhead >= 10, `${movedAhead} of 24 steps ahead of the picture`);
  });

  test('a turn waits for the picture', async () => {
    await settled();
    link.hold();
    await touch('touchStart', [500, 400]);
    await touch('touchMove', [600, 420]);
    assert.deepEqual((await look()).transform, { a: 1, e: 0, f: 0 });
    await touch('touchEnd');
    link.release();
    await settled();
  });

  test('a lost connection puts the picture back', async () => {
    await settled();
    link.hold();
    await touch('touchStart', [500, 400]);
    await touch('touchStart', [500, 400], [700, 400]);
    await touch('touchMove', [550, 400], [750, 400]);
    assert.notEqual((await look()).transform.e, 0);
    tablet.serverAway = true;
    link.close();
    await tablet.page.waitForFunction(() => document.querySelector('#view').classList.contains('stale'));
    assert.deepEqual((await look()).transform, { a: 1, e: 0, f: 0 });
    assert.deepEqual(await marks(), []);
    await touch('touchEnd');
  });

  test('in all this the browser had nothing to complain of', () => {
    assert.deepEqual(tablet.complaints, []);
  });
});

describe('hands on a tablet with WebGL 2 whose pictures are late', { skip: browserIsMissing }, () => {
  const SIZE = { width: 800, height: 600, pixelRatio: 1 };
  let server;
  let link;
  let tablet;

  before(async () => {
    server = await Server.start();
    link = await HeldLink.open(server.port);
    tablet = await Tablet.open(browser, link.address, SIZE, { hasWebGl: true });
    await tablet.wire.until('control', () => tablet.wire.state?.control.holder);
    await tablet.page.evaluate(countRefreshes);
  });

  after(async () => {
    for (const context of browser?.contexts() ?? []) await context.close();
    link?.close();
    await server?.stop();
  });

  /** Runs in the page: counts refreshes, and keeps at which of them input came, and at which the picture was drawn. */
  function countRefreshes() {
    globalThis.refreshes = { now: 0, input: [], drawn: [] };
    const count = () => {
      globalThis.refreshes.now += 1;
      requestAnimationFrame(count);
    };
    requestAnimationFrame(count);
    for (const type of ['pointermove', 'keydown', 'wheel', 'click']) {
      window.addEventListener(type, () => globalThis.refreshes.input.push(globalThis.refreshes.now), { capture: true });
    }
    const { drawElements } = WebGL2RenderingContext.prototype;
    WebGL2RenderingContext.prototype.drawElements = function counting(...about) {
      globalThis.refreshes.drawn.push(globalThis.refreshes.now);
      return drawElements.apply(this, about);
    };
  }

  const touch = (type, ...places) =>
    tablet.devtools.send('Input.dispatchTouchEvent', { type, touchPoints: places.map(([x, y], id) => ({ id, x, y })) });

  const nextRefreshes = () =>
    tablet.page.evaluate(() => new Promise((resolve) => {
      requestAnimationFrame(() => requestAnimationFrame(() => requestAnimationFrame(resolve)));
    }));

  /** The page's pixels, far away: what hides small errors at edges. */
  const pixels = () => tablet.page.evaluate(() => {
    const context = new OffscreenCanvas(160, 120).getContext('2d', { willReadFrequently: true });
    context.imageSmoothingQuality = 'high';
    context.drawImage(document.querySelector('#view'), 0, 0, 160, 120);
    return [...context.getImageData(0, 0, 160, 120).data];
  });
  const meanDifference = (a, b) => a.reduce((sum, x, i) => sum + Math.abs(x - b[i]), 0) / a.length;

  const labelAt = () => tablet.page.evaluate(() => {
    const { e, f } = new DOMMatrix(getComputedStyle(document.querySelector('#labels p')).transform);
    return [e, f];
  });

  async function settled() {
    await nextRefreshes();
    const { id } = tablet.wire.sent.filter((message) => message.id).at(-1);
    const { frame } = await tablet.wire.still(id);
    await tablet.shows(frame);
    await nextRefreshes();
  }

  /** Does something while no picture comes, and checks what the page makes of the last one. */
  async function foretold(name, act) {
    await settled();
    const before = await pixels();
    link.hold();
    await tablet.page.evaluate(() => Object.assign(globalThis.refreshes, { input: [], drawn: [] }));
    await act();
    await nextRefreshes();
    const { input, drawn } = await tablet.page.evaluate(() => globalThis.refreshes);
    for (const at of input) assert.ok(drawn.some((refresh) => refresh === at || refresh === at + 1), `${name}: ${input} ${drawn}`);
    assert.ok(input.length > 0, `${name}: no input`);
    const late = await pixels();
    const lateLabel = await labelAt();
    await tablet.screenshot(`warped-${name}`);
    link.release();
    await settled();
    await tablet.screenshot(`warped-${name}-truth`);
    const truth = await pixels();
    const [told, none] = [meanDifference(late, truth), meanDifference(before, truth)];
    assert.ok(none > 1, `${name}: the picture changes`);
    assert.ok(told < 0.5 * none, `${name}: ${told} with a warp, ${none} without`);
    const jump = apart(lateLabel, await labelAt());
    assert.ok(jump <= WITHIN_PX, `${name}: a marker jumps by ${jump} pixels`);
  }

  test('its frames hold depth', async () => {
    await settled();
    assert.equal(tablet.wire.sent[0].depth, true);
    assert.ok(tablet.wire.frames.at(-1).depth);
    const { point } = await tablet.pick([420, 330]);
    await tablet.say({ type: 'patch', patch: { markers: { Here: { text: 'Here', point } } } });
    await tablet.wire.until('the marker', () => tablet.wire.frames.at(-1)?.markers?.Here);
    await nextRefreshes();
  });

  test('a turn is on the glass at the next refresh', () =>
    foretold('turn', async () => {
      await touch('touchStart', [400, 300]);
      for (let step = 1; step <= 4; step += 1) {
        await touch('touchMove', [400 + 5 * step, 300 + 2 * step]);
        await nextRefreshes();
      }
      await touch('touchEnd');
    }));

  test('so are a pan and a pinch', () =>
    foretold('pinch', async () => {
      await touch('touchStart', [380, 330]);
      await touch('touchStart', [380, 330], [460, 330]);
      for (let step = 1; step <= 4; step += 1) {
        await touch('touchMove', [380 - 4 * step, 330 + 6 * step], [460 + 12 * step, 330 + 6 * step]);
        await nextRefreshes();
      }
      await touch('touchEnd');
    }));

  test('so is a pan that begins on the floor, where the server finds nothing', async () => {
    const [a, b] = [[610, 480], [690, 480]];
    await settled();
    assert.equal((await tablet.pick([650, 480])).point, undefined);
    await foretold('floor', async () => {
      await touch('touchStart', a);
      await touch('touchStart', a, b);
      for (let step = 1; step <= 4; step += 1) {
        await touch('touchMove', [a[0] - 15 * step, a[1] - 8 * step], [b[0] - 15 * step, b[1] - 8 * step]);
        await nextRefreshes();
      }
      await touch('touchEnd');
    });
    const moves = tablet.wire.sent.filter(({ type, touched }) => type === 'pointermove' && touched);
    assert.ok(Math.abs(moves.at(-1).touched[1]) < 0.05, 'on the floor');
  });

  test('so are keys', () =>
    foretold('keys', async () => {
      await tablet.page.keyboard.press('ArrowLeft');
      await nextRefreshes();
      await tablet.page.keyboard.press('Shift+ArrowDown');
    }));

  test('so is the wheel', async () => {
    await tablet.page.mouse.move(420, 330);
    await foretold('wheel', () => tablet.page.mouse.wheel(0, 300));
  });

  test('so is a flight', async () => {
    await settled();
    const before = await pixels();
    link.hold();
    await tablet.page.evaluate(() => Object.assign(globalThis.refreshes, { drawn: [] }));
    await tablet.page.locator('#bar button').first().tap();
    // It draws at each refresh until it is at its end.
    await tablet.page.waitForFunction(() => {
      const { now, drawn } = globalThis.refreshes;
      return drawn.length > 0 && now > drawn.at(-1) + 15;
    });
    const late = await pixels();
    link.release();
    const there = ({ eye, focus }) => JSON.stringify([eye, focus]);
    await tablet.wire.until('the end of the flight', () => there(tablet.wire.state.camera) === there(tablet.wire.state.views.home));
    await tablet.shows((await tablet.wire.stillOf(tablet.wire.revision)).frame);
    await nextRefreshes();
    const truth = await pixels();
    assert.ok(meanDifference(late, truth) < 0.5 * meanDifference(before, truth));
  });

  test('where its drawing is lost, it comes back', async () => {
    await settled();
    const before = await pixels();
    await tablet.page.evaluate(async () => {
      const canvas = document.querySelector('#view');
      const lose = canvas.getContext('webgl2').getExtension('WEBGL_lose_context');
      const happens = (type) => new Promise((resolve) => { canvas.addEventListener(type, resolve, { once: true }); });
      const [lost, restored] = [happens('webglcontextlost'), happens('webglcontextrestored')];
      lose.loseContext();
      await lost;
      await new Promise((resolve) => { setTimeout(resolve); }); // the event is over, and whether it was prevented is known
      lose.restoreContext();
      await restored;
    });
    await nextRefreshes();
    assert.ok(meanDifference(await pixels(), before) < 0.5);
  });

  test('in all this the browser had nothing to complain of', () => {
    assert.deepEqual(tablet.complaints, []);
  });
});
