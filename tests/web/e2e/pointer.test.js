import assert from 'node:assert/strict';
import { after, before, describe, test } from 'node:test';
import { assertClean } from './axe.js';
import { pose } from './camera.js';
import { Server } from './program.js';
import { Tablet, browserIsMissing, launchBrowser } from './tablet.js';

const SIZE = { width: 1180, height: 820, pixelRatio: 1 };
/** On the car. */
const PLACES = [[590, 430], [640, 470]];

describe('pointing', { skip: browserIsMissing }, () => {
  let server;
  let browser;
  let presenter;
  let watcher;

  before(async () => {
    server = await Server.start();
    browser = await launchBrowser();
    const open = async (address, name) => {
      const tablet = await Tablet.open(browser, address, SIZE, { userAgent: `${name} (${name})`, reducedMotion: 'reduce' });
      await tablet.shows((await tablet.wire.still()).frame);
      await tablet.pictures(false);
      return tablet;
    };
    presenter = await open(server.address, 'Windows');
    watcher = await open(`${server.address}#watch`, 'Android');
  });

  after(async () => {
    await browser?.close();
    await server?.stop();
  });

  const point = (tablet, where) => tablet.page.locator(where).getByRole('button', { name: 'Point', exact: true });
  const line = (tablet) => tablet.page.locator('#lines').getByText('Touch the picture: others see where.');
  const dot = (tablet, name) => tablet.page.locator('#pointed p', { hasText: name });
  const touch = (tablet, type, place) => tablet.finger(type, place ? [{ id: 0, x: place[0], y: place[1] }] : []);
  /** Waits until a dot is at a place of the window. */
  const isAt = (tablet, name, [x, y]) => tablet.page.waitForFunction(([words, left, top]) =>
    [...document.querySelectorAll('#pointed p')].some((one) => {
      const at = one.getBoundingClientRect();
      return one.textContent === words && !one.hidden && Math.hypot(at.left - left, at.top - top) < 2;
    }), [name, x, y]);
  const none = (tablet) => tablet.page.waitForFunction(() => !document.querySelector('#pointed p'));

  test('a watcher points by a finger, all see the dot and the name, and nothing else happens', async () => {
    await presenter.wire.until('the watcher', () => Object.keys(presenter.wire.state.clients).length === 2);
    const { revision } = presenter.wire;
    const before = structuredClone(presenter.wire.state.camera);
    await point(watcher, '#watching').tap();
    await line(watcher).waitFor();
    await watcher.page.locator('#watching').getByRole('button', { name: 'Point', pressed: true }).waitFor();
    await touch(watcher, 'touchStart', PLACES[0]);
    for (const tablet of [watcher, presenter]) await isAt(tablet, 'Android', PLACES[0]);
    await touch(watcher, 'touchMove', PLACES[1]);
    for (const tablet of [watcher, presenter]) await isAt(tablet, 'Android', PLACES[1]);
    assert.equal(await dot(presenter, 'Android').evaluate((one) => one.style.getPropertyValue('--color')),
      await dot(watcher, 'Android').evaluate((one) => one.style.getPropertyValue('--color')));
    await presenter.screenshot('pointer-presenter');
    await watcher.screenshot('pointer-watcher');
    assert.deepEqual([presenter.wire.revision, pose(presenter.wire.state.camera)], [revision, pose(before)]);
  });

  test('in a frame that is forgotten, it is an error, and all keep what they had', async () => {
    await watcher.say({ type: 'point', x: 5, y: 5, frame: 987654 });
    const { code, message } = await watcher.wire.until('the error', () => watcher.wire.errors.at(-1));
    assert.equal(code, 'unknown-frame');
    assert.match(message, /frame 987654 is not among the last 64/);
    for (const tablet of [watcher, presenter]) await isAt(tablet, 'Android', PLACES[1]);
    for (const tablet of [watcher, presenter]) await assertClean(tablet.page);
  });

  test('when the finger leaves, the dot does', async () => {
    await touch(watcher, 'touchEnd');
    for (const tablet of [watcher, presenter]) await none(tablet);
  });

  test('who presents points, and a finger turns nothing meanwhile', async () => {
    const before = structuredClone(presenter.wire.state.camera);
    const mark = presenter.wire.sent.length;
    await point(presenter, '#bar').tap();
    await line(presenter).waitFor();
    await touch(presenter, 'touchStart', PLACES[0]);
    await touch(presenter, 'touchMove', PLACES[1]);
    for (const tablet of [watcher, presenter]) await isAt(tablet, 'Windows', PLACES[1]);
    await touch(presenter, 'touchEnd');
    for (const tablet of [watcher, presenter]) await none(tablet);
    await presenter.page.keyboard.press('Escape');
    await line(presenter).waitFor({ state: 'detached' });
    await presenter.page.locator('#bar').getByRole('button', { name: 'Point', pressed: false }).waitFor();
    assert.deepEqual(pose(presenter.wire.state.camera), pose(before));
    assert.deepEqual([...new Set(presenter.wire.sent.slice(mark).map(({ type }) => type))], ['point']);
  });

  test('who presents forbids it to watchers: their dots go, and their buttons', async () => {
    await touch(watcher, 'touchStart', PLACES[0]);
    await isAt(presenter, 'Android', PLACES[0]);
    const { page } = presenter;
    await page.locator('#menu-button').tap();
    const section = page.locator('[data-section="presentation"]');
    await section.evaluate((details) => Object.assign(details, { open: true }));
    const may = section.getByRole('switch', { name: 'Watchers may point' });
    assert.equal(await may.isChecked(), true);
    await may.tap();
    for (const tablet of [watcher, presenter]) await none(tablet);
    await line(watcher).waitFor({ state: 'detached' });
    await point(watcher, '#watching').waitFor({ state: 'hidden' });
    assert.equal(watcher.wire.state.pointing.watchers, false);
    await presenter.screenshot('pointer-menu');
    await may.tap();
    await point(watcher, '#watching').waitFor();
    await touch(watcher, 'touchEnd');
  });

  test('in all this the browsers had nothing to complain of', () => {
    for (const tablet of [presenter, watcher]) assert.deepEqual(tablet.complaints, []);
    assert.deepEqual(presenter.wire.errors, []);
    assert.deepEqual(watcher.wire.errors.map(({ code }) => code), ['unknown-frame']);
  });
});
