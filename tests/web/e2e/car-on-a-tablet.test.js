import assert from 'node:assert/strict';
import { after, before, describe, test } from 'node:test';
import { assertTurned, assertZoomed, pose } from './camera.js';
import { Server, render } from './program.js';
import { Tablet, browserIsMissing, launchBrowser } from './tablet.js';

const TABLET = { width: 1180, height: 820, pixelRatio: 2 };
const PHONE = { width: 390, height: 844, pixelRatio: 3 };
/** A drag over this turns by 180°. */
const SHORTER_SIDE = 820;
const LEAST_PSNR_DB = 35;
const IDLE_MS = 2000;

describe('a car on a tablet', { skip: browserIsMissing }, () => {
  let server;
  let browser;
  let tablet;
  let phone;

  before(async () => {
    server = await Server.start();
    browser = await launchBrowser();
    tablet = await Tablet.open(browser, server.address, TABLET);
  });

  after(async () => {
    await browser?.close();
    await server?.stop();
  });

  test('the page opens and shows a picture of its own size', async () => {
    const header = await tablet.wire.until('a still frame of the size of the page', () =>
      tablet.wire.frames.find(({ view, quality }) => view.width === TABLET.width && quality.level === 'still'));
    await tablet.shows(header.frame);
    assert.deepEqual(header.view, TABLET);
    assert.equal(header.width, Math.round(TABLET.width * TABLET.pixelRatio * header.quality.scale));
    assert.equal(header.height, Math.round(TABLET.height * TABLET.pixelRatio * header.quality.scale));
    assert.equal((await tablet.look()).stale, false);
  });

  test('which is the picture that render makes from the same camera', async () => {
    const { frame, camera, width, height, quality } = await tablet.wire.finest();
    await tablet.shows(frame);
    const png = await render({ camera, width, height, samples: quality.samples });
    const { frame: compared, psnr, drawn } = await tablet.compare(png);
    assert.equal(compared, frame);
    assert.ok(psnr >= LEAST_PSNR_DB, `peak signal to noise ratio ${psnr} dB`);
    assert.ok(drawn > 0.03, `the car covers ${drawn} of the picture`);
    await tablet.screenshot('tablet');
  });

  test('opened again, the page is not sent again', async () => {
    const visitor = await Tablet.open(browser, `${server.address}#watch`, TABLET);
    await visitor.wire.still();
    const received = new Map();
    const pathOf = new Map();
    visitor.devtools.on('Network.requestWillBeSent', ({ requestId, request }) => pathOf.set(requestId, new URL(request.url).pathname));
    visitor.devtools.on('Network.loadingFinished', ({ requestId, encodedDataLength }) =>
      received.set(pathOf.get(requestId), encodedDataLength));
    await visitor.devtools.send('Network.enable');
    await visitor.page.reload();
    await visitor.wire.until('the modules of the page', () => [...received.keys()].filter((path) => path?.endsWith('.js')).length > 1);
    const sent = [...received].filter(([, bytes]) => bytes > 0).map(([path]) => path);
    assert.deepEqual(sent, ['/']);
    assert.ok(received.get('/') < 2000, `${received.get('/')} bytes`);
    await visitor.page.close();
  });

  test('one finger turns it', async () => {
    const drag = await tablet.touch([{ from: [500, 400], to: [664, 441] }]);
    assertTurned(drag, { right: (164 / SHORTER_SIDE) * 180, down: (41 / SHORTER_SIDE) * 180 });
    assert.deepEqual(pose(tablet.wire.state.camera), pose(drag.after));
    await tablet.screenshot('tablet-turned');
  });

  test('two fingers pinch', async () => {
    const { point } = await tablet.pick([590, 410]);
    const spread = await tablet.touch([
      { from: [490, 410], to: [440, 410] },
      { from: [690, 410], to: [740, 410] },
    ]);
    assertZoomed(spread, 300 / 200, point);
    const pinch = await tablet.touch([
      { from: [440, 410], to: [490, 410] },
      { from: [740, 410], to: [690, 410] },
    ]);
    assertZoomed(pinch, 200 / 300, point);
  });

  test('the wheel zooms', async () => {
    for (const turned of [-100, 200]) {
      const { point } = await tablet.pick([TABLET.width / 2, TABLET.height / 2]);
      const wheel = await tablet.wheel(turned);
      // An emulated pixel ratio makes the browser's own numbers smaller than what was turned.
      const { deltaY } = wheel.last;
      assert.equal(Math.sign(deltaY), Math.sign(turned));
      assertZoomed(wheel, 1.1 ** (-deltaY / 100), point);
    }
  });

  test('while nothing changes, no frame comes', async () => {
    await tablet.wire.finest();
    const frames = tablet.wire.frames.length;
    await tablet.wire.quiet(IDLE_MS);
    assert.equal(tablet.wire.frames.length, frames);
  });

  test('a phone beside it sees what the tablet shows', async () => {
    phone = await Tablet.open(browser, server.address, PHONE);
    const seen = await phone.wire.still();
    const shown = tablet.wire.frames.at(-1);
    assert.deepEqual(seen.camera, shown.camera);
    assert.deepEqual(seen.view, TABLET);
    await phone.shows(seen.frame);
    await phone.screenshot('phone-watching');

    const drag = await tablet.touch([{ from: [500, 400], to: [582, 400] }]);
    const followed = await phone.wire.until('the turned camera', () => {
      const last = phone.wire.frames.at(-1);
      return last.revision >= tablet.wire.frames.at(-1).revision && last;
    });
    assert.deepEqual(pose(followed.camera), pose(drag.after));
    assert.deepEqual(pose(phone.wire.state.camera), pose(tablet.wire.state.camera));
    await phone.page.close();
  });

  test('the tablet is turned upright, and the picture with it', async () => {
    const upright = { width: TABLET.height, height: TABLET.width, pixelRatio: TABLET.pixelRatio };
    await tablet.page.setViewportSize(upright);
    const header = await tablet.wire.until('a still frame that is upright', () =>
      tablet.wire.frames.find(({ view, quality }) => view.width === upright.width && quality.level === 'still'));
    await tablet.shows(header.frame);
    assert.deepEqual(header.view, upright);
    const { width, height } = await tablet.look();
    assert.deepEqual([width, height], [header.width, header.height]);
    assert.equal(width, Math.round(upright.width * upright.pixelRatio * header.quality.scale));
    await tablet.screenshot('tablet-upright');
    assertTurned(await tablet.touch([{ from: [400, 600], to: [318, 600] }]), { right: (-82 / SHORTER_SIDE) * 180, down: 0 });
  });

  test('the server dies and comes back, and so does the page', async () => {
    const { connections } = tablet.wire;
    tablet.serverAway = true;
    await server.stop('SIGKILL');
    await tablet.page.waitForFunction(() =>
      document.querySelector('#view').classList.contains('stale') &&
      document.querySelector('#lines').textContent.includes('does not answer'));
    await tablet.page.locator('#lines p').first().evaluate((line) =>
      Promise.all(line.getAnimations().map((animation) => animation.finished)));
    await tablet.screenshot('tablet-server-away');

    server = await Server.start(server.port);
    await tablet.page.waitForFunction(() => !document.querySelector('#view').classList.contains('stale'));
    tablet.serverAway = false;
    assert.ok(tablet.wire.connections > connections);
    const drawn = await tablet.wire.still();
    await tablet.shows(drawn.frame);
    const upright = { width: TABLET.height, height: TABLET.width, pixelRatio: TABLET.pixelRatio };
    await tablet.wire.until('the size of the page', () => {
      const last = tablet.wire.frames.at(-1);
      return last.view.width === upright.width && last.quality.level === 'still';
    });
    assertTurned(await tablet.touch([{ from: [400, 600], to: [482, 600] }]), { right: (82 / SHORTER_SIDE) * 180, down: 0 });
    await tablet.page.waitForFunction(() => document.querySelector('#lines').textContent === '');
  });

  test('in all this the browser had nothing to complain of', () => {
    assert.deepEqual(tablet.complaints, []);
    assert.deepEqual(phone?.complaints, []);
  });
});
