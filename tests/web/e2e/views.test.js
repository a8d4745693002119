import assert from 'node:assert/strict';
import { access, mkdtemp, readFile, rm, writeFile } from 'node:fs/promises';
import { tmpdir } from 'node:os';
import path from 'node:path';
import { after, before, describe, test } from 'node:test';
import { fileURLToPath } from 'node:url';
import { frameHeader } from '../../../web-client/connection/frame-header.js';
import { Server } from './program.js';
import { Tablet, browserIsMissing, launchBrowser } from './tablet.js';

const TABLET = { width: 1180, height: 820, pixelRatio: 1 };
const PHONE = { width: 390, height: 844, pixelRatio: 1 };
const SCENES = fileURLToPath(new URL('../../../scenes/teaching', import.meta.url));

const saved = ({ eye, focus, up, center, fov }) => ({ eye, focus, up, center, fov });
const distance = ({ eye, focus }) => Math.hypot(...eye.map((x, i) => x - focus[i]));

describe('views and connection on a tablet', { skip: browserIsMissing }, () => {
  let folder;
  let server;
  let browser;
  let tablet;
  let phone;
  let views;
  let presentation;

  /** Opens the menu with one section, and gives it. */
  async function unfold({ page }, name) {
    if (!(await page.locator('#menu.open').count())) await page.locator('#menu-button').tap();
    const section = page.locator(`[data-section="${name}"]`);
    if (!(await section.evaluate((details) => details.open))) await section.locator('summary').tap();
    return section;
  }

  const button = (section, name) => section.getByRole('button', { name, exact: true });
  const state = () => tablet.wire.state;
  const until = (what, get) => tablet.wire.until(what, get);
  const cameraIs = (view) => until('the camera of the view', () => {
    const now = saved(state().camera);
    return JSON.stringify(now) === JSON.stringify(saved(view)) && now;
  });
  const says = (sentence, { page } = tablet) => page.locator('#lines').getByText(sentence).waitFor();
  const fact = (section, name, text) => section.locator(`[data-fact="${name}"]`).getByText(text, { exact: true }).waitFor();

  before(async () => {
    folder = await mkdtemp(path.join(tmpdir(), 'vrut-preview-'));
    server = await Server.start(0, ['--scenes', SCENES, '--record', folder]);
    browser = await launchBrowser();
    tablet = await Tablet.open(browser, server.address, TABLET);
    await tablet.wire.still();
    views = await unfold(tablet, 'views');
    presentation = await unfold(tablet, 'presentation');
  });

  after(async () => {
    await browser?.close();
    await server?.stop();
    await rm(folder, { recursive: true });
  });

  test('a view is saved, and gone back to to the bit', async () => {
    await tablet.touch([{ from: [300, 400], to: [371, 433] }]);
    const there = saved(state().camera);
    await views.getByRole('textbox', { name: 'Name of the view' }).fill('Left lamp');
    await button(views, 'Save view').tap();
    await until('the view', () => state().views['Left lamp']);
    assert.deepEqual(state().views['Left lamp'], there);

    await tablet.touch([{ from: [500, 400], to: [380, 320] }]);
    assert.notDeepEqual(saved(state().camera), there);
    await button(views, 'Left lamp').tap();
    await cameraIs(there);
    const { frame } = await until('its picture', () => {
      const last = tablet.wire.frames.at(-1);
      return last.quality.level === 'still' && JSON.stringify(saved(last.camera)) === JSON.stringify(there) && last;
    });
    await tablet.shows(frame);
  });

  test('one without a name is given one, and a name is not taken twice', async () => {
    await button(views, 'Save view').tap();
    await until('the view', () => state().views['View 1']);
    const before = structuredClone(state().views);
    for (const name of ['View 1', 'home']) {
      await views.getByRole('textbox', { name: 'Name of the view' }).fill(name);
      await button(views, 'Save view').tap();
      await says(`There is a view “${name}” already.`);
    }
    await views.getByRole('textbox', { name: 'Name of the view' }).fill('é'.repeat(60));
    await button(views, 'Save view').tap();
    await says(/100 bytes/);
    assert.deepEqual(state().views, before);
    assert.equal(await views.getByRole('button', { name: 'home', exact: true }).count(), 0);
    await views.getByRole('textbox', { name: 'Name of the view' }).fill('');
  });

  test('a view is deleted, and the focus stays near', async () => {
    await button(views, 'Delete Left lamp').tap();
    await until('no view', () => !state().views['Left lamp']);
    await button(views, 'Left lamp').waitFor({ state: 'detached' });
    await tablet.page.waitForFunction(() => document.activeElement.textContent === 'View 1');
    await button(views, 'Delete View 1').tap();
    await views.getByText('No view is saved yet.').waitFor();
    assert.deepEqual(Object.keys(state().views), ['home']);
  });

  test('home is one tap away, and so is the whole scene', async () => {
    await button(views, 'Home').tap();
    await cameraIs(state().views.home);
    await tablet.wire.still();
    await tablet.wheel(2000);
    const { after: far } = await tablet.wheel(2000);
    await button(views, 'Fit the scene').tap();
    await until('the scene to fill the view', () => distance(state().camera) < 0.7 * distance(far));
  });

  test('the cameras of the scene are there, and the one in use is marked', async () => {
    for (const name of ['Driver\'s seat', 'Outside']) {
      await button(views, name).tap();
      await until(`the camera ${name}`, () => state().camera.name === name && state().camera.node !== undefined);
      await views.getByRole('button', { name, exact: true, pressed: true }).waitFor();
      assert.equal(await views.getByRole('list', { name: 'Cameras of the scene' }).getByRole('button', { pressed: true }).count(), 1);
    }
  });

  test('the page measures, and measures nothing when nothing comes', async () => {
    await tablet.touch([{ from: [500, 400], to: [420, 400] }]);
    const connection = await tablet.settings('connection');
    await connection.locator('[data-fact="latency"]').getByText(/^[\d,]+\sms, [\d,]+\sms$/).waitFor();
    await connection.locator('[data-fact="level"]').getByText(/^Still · \d+ samples · full size · JPEG \d+$/).waitFor();
    await fact(connection, 'frames', '0');
    await fact(connection, 'data', '0\u00a0kB/s');
    await tablet.closeSettings();
  });

  test('control is taken and given away in the menu', async () => {
    phone = await Tablet.open(browser, server.address, PHONE);
    await phone.wire.still();
    const onPhone = await unfold(phone, 'presentation');
    await fact(presentation, 'clients', '2');
    await fact(presentation, 'holder', 'You');
    const { holder, name } = state().control;
    assert.ok(name);
    await fact(onPhone, 'holder', name);
    assert.ok(await button(onPhone, 'Give control away').isDisabled());

    await button(onPhone, 'Take control').tap();
    await fact(onPhone, 'holder', 'You');
    await until('the phone in control', () => state().control.holder !== holder);
    await fact(presentation, 'holder', state().control.name);
    await button(views, 'Home').tap();
    await says(/in control|steers/);

    await phone.screenshot('phone-presentation');
    await button(onPhone, 'Give control away').tap();
    await fact(presentation, 'holder', 'You');
    await fact(onPhone, 'holder', name);
    await phone.page.close();
  });

  test('speed and accuracy', async () => {
    const quality = await tablet.settings('quality');
    await quality.getByRole('slider', { name: 'Speed or accuracy' }).fill('0.9');
    await until('the preference', () => state().quality.preference === 0.9);
    await quality.getByText('90 % accuracy').waitFor();
  });

  test('a session is recorded', async () => {
    const recording = await tablet.settings('recording');
    const dot = tablet.page.locator('#recording', { hasText: 'Recording' });
    await button(recording, 'Record').tap();
    const name = await until('a recording', () => state().recording?.name);
    await fact(recording, 'recording', name);
    await dot.waitFor();
    await tablet.screenshot('recording');
    await button(recording, 'Stop recording').tap();
    await until('the recording to end', () => !state().recording);
    await dot.waitFor({ state: 'detached' });
    await button(recording, 'Record').waitFor();
    await tablet.closeSettings();
    await access(path.join(folder, `${name}.jsonl`));
  });

  test('the picture is saved with all its pixels', async () => {
    const resized = async (view) => {
      await tablet.say({ type: 'resize', ...view });
      const last = () => tablet.wire.frames.at(-1);
      await tablet.shows((await until('a picture of that size', () => last().view.width === view.width && last())).frame);
    };
    await resized({ width: 400, height: 300, pixelRatio: 2 });
    await tablet.pictures(false); // they would be refined before it is drawn
    const download = tablet.page.waitForEvent('download');
    // No tap: while the server draws on the same machine, that may take as long as a long press, which is none.
    await button(presentation, 'Save picture').click();
    const file = await download;
    assert.match(file.suggestedFilename(), /^scene-\d{8}-\d{6}\.jpg$/);
    const header = frameHeader(Uint8Array.from(await readFile(await file.path())).buffer);
    const { view } = tablet.wire.frames.at(-1);
    assert.equal(header.width, 800);
    assert.equal(header.width, Math.round(view.width * view.pixelRatio));
    assert.equal(header.height, Math.round(view.height * view.pixelRatio));
    assert.equal(header.quality.jpegQuality, 95);
    assert.deepEqual(header.camera.eye, state().camera.eye);
    await button(presentation, 'Save picture').waitFor();
    await tablet.pictures(true);
    await resized(TABLET);
  });

  test('another scene is opened', async () => {
    await presentation.getByRole('combobox', { name: 'Another scene' }).selectOption('glass.vrut');
    const { name } = state().scene;
    await button(presentation, 'Open').tap();
    await until('the other scene', () => state().scene.name !== name && state().scene);
    await tablet.wire.still();
    await button(views, 'Home').tap();
    await cameraIs(state().views.home);
  });

  test('a server without folders says what it cannot do', async () => {
    const bare = await Server.start();
    try {
      const page = await Tablet.open(browser, bare.address, TABLET);
      await page.wire.still();
      const section = await unfold(page, 'presentation');
      await section.getByText('The server has no other scenes to offer.').waitFor();
      await button(await page.settings('recording'), 'Record').tap();
      await says(/no folder for recordings/, page);
      assert.equal(page.wire.state.recording, undefined);
      await page.page.close();
    } finally {
      await bare.stop();
    }
  });

  test('a page without a token in its address goes on with the one that was accepted', async () => {
    const file = path.join(folder, 'tokens.json');
    await writeFile(file, JSON.stringify({ control: 'let-this-tablet-steer', view: 'let-this-tablet-see' }), { mode: 0o600 });
    const guarded = await Server.start(0, ['--token-file', file]);
    try {
      const { origin } = new URL(guarded.address);
      const { page, wire } = await Tablet.open(browser, `${origin}/#token=let-this-tablet-steer`, TABLET);
      await wire.still();
      await page.goto('about:blank');
      await page.goto(origin);
      await page.locator('#presence').getByText('Connected').waitFor();
      await page.evaluate(() => localStorage.setItem('vrut-preview.token', 'wrong'));
      await page.reload();
      await says(/token/, { page });
      const remembered = () => page.evaluate(() => localStorage.getItem('vrut-preview.token'));
      for (const settings of ['#token=let-this-tablet-steer', '#watch&token=let-this-tablet-see']) {
        await page.goto('about:blank');
        await page.goto(`${origin}/${settings}`);
        await page.locator('#presence').getByText('Connected').waitFor();
        // The presenter's own is put right by his address, and not lost by a link to watch.
        assert.equal(await remembered(), 'let-this-tablet-steer');
      }
      await page.close();
    } finally {
      await guarded.stop();
    }
  });

  test('in all this the browser had nothing to complain of', () => {
    assert.deepEqual(tablet.complaints, []);
    assert.deepEqual(phone?.complaints, []);
  });
});
