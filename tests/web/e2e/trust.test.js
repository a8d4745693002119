import assert from 'node:assert/strict';
import { after, before, describe, test } from 'node:test';
import { assertTurned, pose } from './camera.js';
import { Server } from './program.js';
import { Tablet, browserIsMissing, launchBrowser } from './tablet.js';

const TABLET = { width: 1180, height: 820, pixelRatio: 1 };
const PHONE = { width: 390, height: 844, pixelRatio: 1 };
/** A drag over this turns by 180°. */
const SHORTER_SIDE = 820;
const ASKS_AFTER_MS = 5000;
const GIVES_UP_AFTER_MS = 10_000;

/** What a page may send that steers nothing. */
const HARMLESS = new Set(['hello', 'resize', 'frame', 'tree']);

describe('what can go wrong', { skip: browserIsMissing }, () => {
  let server;
  let browser;
  let tablet;
  let page;

  before(async () => {
    server = await Server.start();
    browser = await launchBrowser();
    tablet = await Tablet.open(browser, server.address, TABLET, { reducedMotion: 'reduce' });
    ({ page } = tablet);
  });

  after(async () => {
    await browser?.close();
    await server?.stop('SIGKILL');
  });

  const unfolded = () => page.locator('details[open]').evaluateAll((all) => all.map(({ dataset }) => dataset.section));
  const corner = (words, on = page) => on.locator('#presence', { hasText: words }).waitFor();
  const greys = (on = page) => on.waitForFunction(() => document.querySelector('#view').classList.contains('stale'));
  const glows = (on = page) => on.waitForFunction(() => !document.querySelector('#view').classList.contains('stale'));

  test('the server dies in mid-drag and comes back, and the menu is open', async () => {
    await page.locator('#menu-button').tap();
    await page.locator('[data-section="views"] summary').tap();
    await page.locator('[data-section="presentation"] summary').tap();
    const before = await unfolded();
    assert.deepEqual(before, ['views', 'presentation']);
    await tablet.settings('renderer');
    await tablet.closeSettings();
    await tablet.wire.still();
    const mark = tablet.wire.sent.length;
    await tablet.finger('touchStart', [{ x: 300, y: 400 }]);
    await tablet.finger('touchMove', [{ x: 330, y: 410 }]);
    const move = await tablet.wire.until('a move', () => tablet.wire.sent.slice(mark).find(({ type }) => type === 'pointermove'));
    await tablet.wire.until('a picture of it', () => tablet.wire.frames.at(-1).handled >= move.id);

    tablet.serverAway = true;
    await server.stop('SIGKILL');
    await greys();
    await corner('Not connected');
    await page.waitForFunction(() => /connection to the server is lost|does not answer/.test(document.querySelector('#lines').textContent));
    await tablet.finger('touchMove', [{ x: 360, y: 420 }]);
    await page.locator('#menu > button').click();
    const wireframe = page.locator('[data-section="renderer"]').getByRole('switch', { name: 'Wireframe' });
    await wireframe.click();
    await page.locator('dialog #lines').getByText('There is no connection to the server: nothing was changed.').waitFor();
    await page.waitForFunction((input) => !input.checked, await wireframe.elementHandle());
    await tablet.closeSettings();
    const { connections } = tablet.wire;
    server = await Server.start(server.port);
    await glows();
    tablet.serverAway = false;
    assert.ok(tablet.wire.connections > connections);
    await corner('Connected · You are in control ·');
    await page.waitForFunction(() => document.querySelector('#lines').textContent === '');

    // The finger is still there, and means nothing any more.
    await tablet.finger('touchMove', [{ x: 390, y: 430 }]);
    await tablet.finger('touchEnd', []);
    const { view } = await tablet.wire.until('the size of the page', () =>
      tablet.wire.frames.find((header) => header.view.width === TABLET.width && header.quality.level === 'still'));
    assert.deepEqual(view, TABLET);
    assert.equal(await page.locator('#menu.open').count(), 1);
    assert.deepEqual(await unfolded(), before);
    const drag = await tablet.touch([{ from: [300, 400], to: [382, 400] }]);
    assertTurned(drag, { right: (82 / SHORTER_SIDE) * 180, down: 0 });
    const types = tablet.wire.sent.map(({ type }) => type);
    assert.equal(types.filter((type) => type === 'pointerdown').length, 1);
    assert.ok(types.indexOf('pointermove') > types.indexOf('pointerdown'), types.join(' '));
  });

  test('two who look at once see the same, and one steers', async () => {
    const phone = await Tablet.open(browser, server.address, PHONE);
    const watcher = await Tablet.open(browser, `${server.address}#watch`, PHONE);
    for (const other of [phone, watcher]) {
      await other.shows((await other.wire.still()).frame);
      await corner(/^Connected · .+ is in control/, other.page);
      assert.deepEqual(other.wire.frames.at(-1).view, TABLET);
      assert.deepEqual(pose(other.wire.frames.at(-1).camera), pose(tablet.wire.frames.at(-1).camera));
      // As a whole, in the middle, between bars.
      assert.deepEqual(await other.page.evaluate(() => {
        const canvas = document.querySelector('#view');
        return [canvas.classList.contains('fills'), getComputedStyle(canvas).objectFit];
      }), [false, 'contain']);
    }
    assert.equal(await phone.page.locator('#menu-button').isVisible(), true);
    assert.equal(await watcher.page.locator('#menu-button').isVisible(), false);

    await watcher.stroke([{ from: [200, 400], to: [260, 430] }]);
    await watcher.page.touchscreen.tap(200, 420);
    await watcher.page.keyboard.press('w');
    const drag = await tablet.touch([{ from: [300, 400], to: [382, 400] }]);
    assertTurned(drag, { right: (82 / SHORTER_SIDE) * 180, down: 0 });
    for (const other of [phone, watcher]) {
      const followed = await other.wire.until('the turned camera', () =>
        other.wire.frames.at(-1).revision >= tablet.wire.frames.at(-1).revision && other.wire.frames.at(-1));
      assert.deepEqual(pose(followed.camera), pose(drag.after));
      await other.shows(followed.frame);
    }
    await phone.screenshot('trust-phone');
    await watcher.screenshot('trust-watcher');
    const sent = watcher.wire.sent.map(({ type }) => type);
    assert.deepEqual(sent.filter((type) => !HARMLESS.has(type)), []);
    assert.equal(watcher.wire.sent[0].role, 'view');
    for (const other of [phone, watcher]) {
      assert.deepEqual(other.complaints, []);
      await other.page.context().close();
    }
  });

  test('the server falls silent, which is noticed within 15 s', async () => {
    await page.context().close();
    const patient = await Tablet.open(browser, 'about:blank', PHONE);
    await patient.page.clock.install();
    await patient.page.goto(server.address);
    await patient.wire.still();
    await patient.wire.finest();
    const mark = patient.wire.sent.length;
    server.signal('SIGSTOP');
    patient.serverAway = true;
    try {
      await patient.page.clock.fastForward(ASKS_AFTER_MS);
      await patient.wire.until('a question', () => patient.wire.sent.slice(mark).some(({ type }) => type === 'tree'));
      assert.equal((await patient.look()).stale, false);
      await patient.page.clock.fastForward(GIVES_UP_AFTER_MS);
      await greys(patient.page);
      await corner('Not connected', patient.page);
    } finally {
      server.signal('SIGCONT');
    }
    await glows(patient.page);
    await corner('Connected', patient.page);
    assert.deepEqual(patient.complaints, []);
  });

  test('in all this the browser had nothing to complain of', () => {
    assert.deepEqual(tablet.complaints, []);
  });
});
