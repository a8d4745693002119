import assert from 'node:assert/strict';
import { after, before, describe, test } from 'node:test';
import { pose } from './camera.js';
import { Server } from './program.js';
import { Tablet, browserIsMissing, launchBrowser } from './tablet.js';

const SIZE = { width: 1180, height: 820, pixelRatio: 1 };
/** Two corners of the number plate, which no panel covers. */
const CORNERS = [[110, 500], [213, 553]];

describe('measures on a tablet', { skip: browserIsMissing }, () => {
  let server;
  let browser;
  let tablet;
  let page;

  before(async () => {
    server = await Server.start();
    browser = await launchBrowser();
    tablet = await Tablet.open(browser, server.address, SIZE, { reducedMotion: 'reduce' });
    ({ page } = tablet);
    await tablet.shows((await tablet.wire.still()).frame);
    await tablet.pictures(false);
  });

  after(async () => {
    await browser?.close();
    await server?.stop();
  });

  const state = () => tablet.wire.state;
  const until = (what, get) => tablet.wire.until(what, get);
  const panel = (of = page) => of.locator('[data-section="measures"]');
  const button = (label) => panel().getByRole('button', { name: label, exact: true });
  const line = (text) => page.locator('#lines').getByText(text);
  const number = (name, of = page) => of.locator(`#measures [data-measure="${name}"]`);
  /** Touches a place until something is seen in the loupe, and lets go. */
  const pick = async ([x, y], word) => {
    await tablet.finger('touchStart', [{ id: 0, x, y }]);
    await page.locator('#loupe p').getByText(word, { exact: true }).waitFor();
    await tablet.finger('touchEnd', []);
  };

  test('a distance between two corners, by a loupe, while nothing else moves', async () => {
    const before = structuredClone(state().camera);
    const mark = tablet.wire.sent.length;
    await page.locator('#bar').getByRole('button', { name: 'Measure' }).tap();
    await panel().getByText('Nothing is measured yet.').waitFor();
    await button('Distance').tap();
    await line('Touch the first point.').waitFor();
    const [x, y] = CORNERS[0];
    await tablet.finger('touchStart', [{ id: 0, x: x + 20, y: y - 20 }]);
    await page.locator('#loupe').waitFor();
    await tablet.finger('touchMove', [{ id: 0, x, y }]);
    await page.locator('#loupe p').getByText('corner', { exact: true }).waitFor();
    await tablet.screenshot('measures-loupe');
    await tablet.finger('touchEnd', []);
    await page.locator('#loupe').waitFor({ state: 'hidden' });
    await line('Touch the second point.').waitFor();
    await pick(CORNERS[1], 'corner');
    const { kind, picks } = await until('the measure', () => state().measures['Distance 1']);
    const { value, components } = await until('what it comes to', () => state().measured['Distance 1']);
    assert.deepEqual([kind, picks.map(({ snap }) => snap)], ['distance', ['vertex', 'vertex']]);
    assert.ok(Math.abs(Math.hypot(...components) - value) < 1e-9 * value);
    await line('Touch the first point.').waitFor();
    await number('Distance 1').waitFor();
    await page.keyboard.press('Escape');
    await line('Touch the first point.').waitFor({ state: 'detached' });
    assert.deepEqual(pose(state().camera), pose(before));
    assert.deepEqual(tablet.wire.sent.slice(mark).filter(({ type }) => type.startsWith('pointer')), []);
  });

  test('its number is in the list, too, and unfolds how far it goes along the axes', async () => {
    const words = await number('Distance 1').textContent();
    await panel().getByRole('button', { name: `Distance 1 ${words}` }).waitFor();
    await number('Distance 1').tap();
    for (const axis of ['X', 'Y', 'Z']) await number('Distance 1').getByText(new RegExp(`^${axis} .*mm$`)).waitFor();
    await tablet.screenshot('measures-distance');
    await number('Distance 1').tap();
    await panel().getByText('cm', { exact: true }).tap();
    await until('the unit', () => state().unit.shown === 'cm');
    await number('Distance 1').getByText(/cm$/).waitFor();
  });

  test('it is removed, which is undone, and gets another name', async () => {
    const { picks } = structuredClone(state().measures['Distance 1']);
    const { value } = state().measured['Distance 1'];
    await button('Remove Distance 1').tap();
    await until('none', () => !state().measures['Distance 1']);
    await number('Distance 1').waitFor({ state: 'detached' });
    await page.locator('#lines').getByRole('button', { name: 'Undo' }).tap();
    await until('the measure', () => state().measured['Distance 1']?.value === value);
    assert.deepEqual(state().measures['Distance 1'].picks, picks);
    await panel().getByRole('button', { name: /^Distance 1/ }).tap();
    await panel().getByRole('textbox', { name: 'New name of Distance 1' }).fill('Plate');
    await page.keyboard.press('Enter');
    await until('the name', () => state().measures.Plate && !state().measures['Distance 1']);
    await number('Plate').waitFor();
  });

  test('numbers of one place do not cover each other', async () => {
    const { kind, picks } = state().measures.Plate;
    await tablet.say({ type: 'patch', patch: { measures: { A: { kind, picks }, B: { kind, picks } } } });
    for (const name of ['A', 'B', 'Plate']) await number(name).waitFor();
    const boxes = await Promise.all(['A', 'B', 'Plate'].map((name) => number(name).boundingBox()));
    for (const [i, a] of boxes.entries()) {
      for (const b of boxes.slice(0, i)) {
        assert.ok(a.x + a.width <= b.x || b.x + b.width <= a.x || a.y + a.height <= b.y || b.y + b.height <= a.y,
          JSON.stringify([a, b]));
      }
    }
    await tablet.screenshot('measures-three');
  });

  test('two fingers zoom while a tool is on, and pick nothing', async () => {
    const before = structuredClone(state().camera);
    const count = Object.keys(state().measures).length;
    await button('Distance').tap();
    await line('Touch the first point.').waitFor();
    const fingers = (distance) => [-1, 1].map((side, id) => ({ id, x: 400 + side * distance, y: 300 }));
    await tablet.finger('touchStart', fingers(60).slice(0, 1));
    await page.locator('#loupe').waitFor();
    await tablet.finger('touchStart', fingers(60));
    await page.locator('#loupe').waitFor({ state: 'hidden' });
    for (const distance of [70, 85, 100, 120]) await tablet.finger('touchMove', fingers(distance));
    await tablet.finger('touchEnd', []);
    await until('the camera nearer', () => {
      const [was, is] = [before, state().camera].map(({ eye, focus }) => Math.hypot(...eye.map((x, i) => x - focus[i])));
      return is < 0.7 * was;
    });
    await line('Touch the first point.').waitFor();
    await page.keyboard.press('Escape');
    assert.equal(Object.keys(state().measures).length, count);
    await tablet.say({ type: 'patch', patch: { camera: pose(before) } });
  });

  test('what has no value says why', async () => {
    const { node } = state().measures.A.picks[0];
    const edge = (...to) => ({ node, snap: 'edge', points: [[0, 0, 0], [0, 0, 0], to] });
    const picks = [edge(1, 0, 0), edge(0, 1, 0)];
    await tablet.say({ type: 'patch', patch: { measures: { A: null, B: null, Odd: { kind: 'parallel', picks } } } });
    await panel().getByRole('button', { name: /^Odd the two are not parallel/ }).waitFor();
    await number('A').waitFor({ state: 'detached' });
    assert.equal(await number('Odd').count(), 0);
    await tablet.say({ type: 'patch', patch: { measures: { Odd: null } } });
  });

  test('who only watches sees the numbers, and no tools', async () => {
    const watcher = await Tablet.open(browser, `${server.address}#watch`, SIZE, { reducedMotion: 'reduce' });
    await watcher.shows((await watcher.wire.still()).frame);
    await number('Plate', watcher.page).waitFor();
    assert.equal(await number('Plate', watcher.page).textContent(), await number('Plate').textContent());
    assert.equal(await watcher.page.locator('#menu-button:visible, #bar:visible').count(), 0);
    assert.ok(await watcher.page.locator('#measure-lines .line').first().getAttribute('d'));
    await watcher.screenshot('measures-watcher');
    assert.deepEqual(watcher.complaints, []);
    await watcher.page.context().close();
  });

  test('in all this the browser had nothing to complain of', () => {
    assert.deepEqual(tablet.complaints, []);
    assert.deepEqual(tablet.wire.errors, []);
  });
});
