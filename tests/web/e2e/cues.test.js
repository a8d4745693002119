import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { after, before, describe, test } from 'node:test';
import { assertClean } from './axe.js';
import { pose } from './camera.js';
import { HeldLink } from './held-link.js';
import { Server } from './program.js';
import { Tablet, browserIsMissing, launchBrowser } from './tablet.js';

const SIZES = {
  tablet: { width: 1180, height: 820, pixelRatio: 1 },
  phone: { width: 390, height: 844, pixelRatio: 1 },
};

let browser;

before(async () => {
  if (!browserIsMissing) browser = await launchBrowser();
});

after(() => browser?.close());

for (const [name, size] of Object.entries(SIZES)) {
  describe(`cues on a ${name}`, { skip: browserIsMissing }, () => {
    const testOnTablet = name === 'tablet' ? test : () => {};
    let server;
    let presenter;
    let watchers;
    let colleague;
    let page;
    let menu;

    before(async () => {
      server = await Server.start();
      const open = async (address) => {
        const tablet = await Tablet.open(browser, address, size, { reducedMotion: 'reduce' });
        await tablet.shows((await tablet.wire.still()).frame);
        await tablet.pictures(false);
        return tablet;
      };
      presenter = await open(server.address);
      watchers = [];
      for (let i = 0; i < (name === 'tablet' ? 3 : 1); ++i) watchers.push(await open(`${server.address}#watch`));
      colleague = await open(server.address);
      ({ page } = presenter);
      menu = page.locator('[data-section="cues"]');
      await page.locator('#menu-button').tap();
      await menu.locator('summary').tap();
    });

    after(async () => {
      for (const context of browser?.contexts() ?? []) await context.close();
      await server?.stop();
    });

    const state = () => presenter.wire.state;
    const until = (what, get) => presenter.wire.until(what, get);
    const button = (label, where = menu) => where.getByRole('button', { name: label, exact: true });
    const strip = () => page.locator('#strip');
    const chip = (label, pressed) => strip().getByRole('button', { name: label, exact: true, pressed });
    const line = (text) => page.locator('#lines').getByText(text);
    const add = async (cue) => {
      await menu.getByRole('textbox', { name: 'Name of the cue' }).fill(cue);
      await button('Add what is shown').tap();
      await until(cue, () => state().cues[cue]);
    };

    test('one tap makes a cue of what is shown, with words and its time', async () => {
      await add('Arrival');
      await presenter.say({ type: 'patch', patch: { camera: { fov: 20 }, nodes: { 101: { active: false } } } });
      await add('Close');
      await presenter.say({ type: 'patch', patch: { camera: { fov: 60 }, nodes: null } });
      await add('Far');
      assert.deepEqual(state().cues.Close.nodes, { 101: { active: false } });
      await button('Change Close').tap();
      const words = menu.getByRole('textbox', { name: 'What to say at Close' });
      await words.pressSequentially('New? See');
      assert.equal(await words.inputValue(), 'New? See');
      assert.equal(await page.locator('dialog').count(), 0);
      await words.fill('See the lamp.\nIt is new.');
      await menu.getByRole('slider', { name: 'The way there takes' }).fill('0.2');
      await until('the words', () => state().cues.Close.text === 'See the lamp.\nIt is new.');
      await until('the time', () => state().cues.Close.ms === 200);
      await presenter.screenshot(`cues-${name}-menu`);
      await assertClean(page, 'cues in the menu');
      await button('Change Close').tap();
    });

    test('cues change places, are renamed, overwritten and deleted, and that is undone', async () => {
      await button('Change Far').tap();
      await button('Move up').tap();
      await until('the order', () => state().cues.Far.order === 1 && state().cues.Close.order === 2);
      await button('Move down').tap();
      await until('the order', () => state().cues.Far.order === 2);
      const before = state().cues.Far;
      await presenter.say({ type: 'patch', patch: { camera: { fov: 70 }, sections: { cut: { normal: [1, 0, 0] } } } });
      await button('Save what is shown here').tap();
      await until('the new look', () => state().cues.Far.camera.fov === 70 && state().cues.Far.sections.cut);
      await presenter.say({ type: 'patch', patch: { sections: null } });
      await page.locator('#lines').getByRole('button', { name: 'Undo' }).tap();
      await until('the look before', () => state().cues.Far.camera.fov === before.camera.fov);
      assert.deepEqual(state().cues.Far, before);
      await menu.getByRole('textbox', { name: 'New name of Far' }).fill('Wide');
      await button('Rename').tap();
      await until('the new name', () => state().cues.Wide && !state().cues.Far);
      await button('Delete Wide').tap();
      await until('nothing', () => !state().cues.Wide);
      await page.locator('#lines').getByRole('button', { name: 'Undo' }).tap();
      await until('it again', () => state().cues.Wide);
      assert.deepEqual(state().cues.Wide, before);
    });

    test('a presenter sees words and pictures, and goes on by button, clicker and picture', async () => {
      await button('Present').tap();
      await page.waitForFunction(() => [...document.querySelectorAll('#strip .cues img')].every((image) => image.naturalWidth === 240));
      await button('Next cue', strip()).tap();
      await chip('Arrival', true).waitFor();
      await page.keyboard.press('PageDown');
      await chip('Close', true).waitFor();
      await until('the cue', () => state().cue.name === 'Close' && state().camera.fov === 20);
      await strip().getByText('It is new.').waitFor();
      await strip().getByText('Next: Wide').waitFor();
      const { x, width } = await strip().boundingBox();
      assert.ok(x >= 0 && x + width <= size.width, `the strip is ${width} wide from ${x}`);
      assert.equal(await page.evaluate(() => document.querySelector('#stage').scrollLeft), 0);
      await presenter.screenshot(`cues-${name}-strip`);
      await assertClean(page, 'cues in the strip');
      await page.keyboard.press('PageDown');
      await chip('Wide', true).waitFor();
      await page.keyboard.press('PageDown');
      await line('This is the last cue.').waitFor();
      await page.keyboard.press('PageUp');
      await chip('Close', true).waitFor();
      await chip('Arrival', false).tap();
      await chip('Arrival', true).waitFor();
      await page.keyboard.press('PageUp');
      await line('There is no cue before this one.').waitFor();
      for (const watcher of watchers) {
        await watcher.wire.until('the first cue', () => watcher.wire.state.cue?.name === 'Arrival');
        assert.equal(await watcher.page.getByText('See the lamp.').count(), 0);
        assert.equal(await watcher.page.locator('#strip').isVisible(), false);
      }
    });

    testOnTablet('after a lost connection, the presenter goes on where they were', async () => {
      const { connections } = presenter.wire;
      await page.evaluate(() => window.sockets.at(-1).close());
      await until('another connection', () => presenter.wire.connections > connections && state()?.cue);
      await presenter.glance();
      await chip('Arrival', true).waitFor();
      await page.keyboard.press('PageDown');
      await chip('Close', true).waitFor();
      await presenter.screenshot(`cues-${name}-again`);
      await page.keyboard.press('PageUp');
      await chip('Arrival', true).waitFor();
    });

    test('a cue is prepared on a picture that nobody else sees, and taken', async () => {
      const seen = structuredClone(state());
      const image = page.locator('#prepare img');
      await chip('Arrival', false).or(chip('Arrival', true)).tap();
      await until('the first cue', () => state().cue.name === 'Arrival' && state().camera.fov === state().cues.Arrival.camera.fov);
      for (const { wire } of watchers) await wire.until('the same', () => wire.revision === presenter.wire.revision);
      const revisions = watchers.map(({ wire }) => wire.revision);
      const before = pose(state().camera);
      await button('Prepare', strip()).tap();
      await line('Only you see “Close” until you take it.').waitFor();
      await page.waitForFunction(() => document.querySelector('#prepare img').naturalWidth === innerWidth);
      await strip().getByText('It is new.').waitFor();
      await presenter.screenshot(`cues-${name}-prepare`);
      await assertClean(page, 'a cue that is prepared');
      const first = await image.getAttribute('src');
      const touch = (type, at) => presenter.finger(type, at ? [{ id: 0, x: at[0], y: at[1] }] : []);
      await touch('touchStart', [200, 300]);
      await touch('touchMove', [230, 310]);
      await touch('touchMove', [260, 320]);
      await touch('touchEnd');
      await page.waitForFunction((address) => {
        const shown = document.querySelector('#prepare img');
        return shown.src !== address && shown.naturalWidth === innerWidth;
      }, first);
      assert.deepEqual(pose(state().camera), before);
      assert.deepEqual(watchers.map(({ wire }) => wire.revision), revisions);
      await button('Take', strip()).tap();
      await until('the cue', () => state().cue.name === 'Close' && state().camera.fov === seen.cues.Close.camera.fov);
      assert.notDeepEqual(state().camera.eye, state().cues.Close.camera.eye);
      for (const { wire } of watchers) await wire.until('the cue', () => wire.state.cue.name === 'Close');
      await line('Only you see “Wide” until you take it.').waitFor();
      await button('Keep this view', strip()).waitFor({ state: 'hidden' });
      await button('Prepare', strip()).tap();
      await page.locator('#prepare').waitFor({ state: 'hidden' });
      await button('Previous cue', strip()).tap();
      await until('the first cue', () => state().cue.name === 'Arrival');
    });

    test('what is prepared stays through a lost connection, and ends where the picture of all is moved', async () => {
      const image = page.locator('#prepare img');
      const sharp = (other) => page.waitForFunction((address) => {
        const shown = document.querySelector('#prepare img');
        return shown.src !== address && shown.naturalWidth === innerWidth;
      }, other);
      await button('Prepare', strip()).tap();
      await sharp('');
      await presenter.finger('touchStart', [{ id: 0, x: 200, y: 300 }]);
      await presenter.finger('touchMove', [{ id: 0, x: 230, y: 310 }]);
      await presenter.finger('touchMove', [{ id: 0, x: 260, y: 320 }]);
      await presenter.finger('touchEnd', []);
      await button('Keep this view', strip()).waitFor();
      const before = await image.getAttribute('src');
      const { connections } = presenter.wire;
      await page.evaluate(() => window.sockets.at(-1).close());
      await until('another connection', () => presenter.wire.connections > connections && state()?.cue);
      await presenter.glance();
      await sharp(before);
      await button('Keep this view', strip()).waitFor();
      await line('Only you see “Close” until you take it.').waitFor();
      assert.equal(state().cue.name, 'Arrival');
      await presenter.screenshot(`cues-${name}-prepare-again`);
      await page.locator('#bar').getByRole('button', { name: 'Fit all' }).tap();
      await page.locator('#prepare').waitFor({ state: 'hidden' });
      const lastButton = await page.locator('#bar button:visible').last().boundingBox();
      assert.ok(lastButton.x + lastButton.width <= size.width, `the bar ends at ${lastButton.x + lastButton.width}`);
      await page.locator('#bar').getByRole('button', { name: 'Cues' }).tap();
      await strip().waitFor({ state: 'hidden' });
      await page.locator('#menu-button').tap();
      await button('Present').tap();
      await chip('Arrival', true).waitFor();
    });

    testOnTablet('one who steers meanwhile stops the way, and the next cue begins there', async () => {
      await presenter.say({ type: 'patch', patch: { cues: { Close: { ms: 60_000 } } } });
      await page.keyboard.press('PageDown');
      await until('the cue', () => state().cue.name === 'Close');
      await presenter.say({ type: 'navigate', pan: [0, 0.1] });
      const changed = async (ms) => {
        await presenter.say({ type: 'patch', patch: { cues: { Close: { ms } } } });
        await until('the change', () => state().cues.Close.ms === ms);
      };
      await changed(300);
      const stopped = pose(state().camera);
      await changed(200);
      assert.deepEqual(pose(state().camera), stopped);
      await page.keyboard.press('PageDown');
      await until('the next cue', () => state().cue.name === 'Wide');
    });

    testOnTablet('the list is a file, and comes back from it, but for what does not go with the scene', async () => {
      await page.locator('#menu-button').tap();
      const coming = page.waitForEvent('download');
      await button('Save the list').tap();
      const file = await coming;
      assert.match(file.suggestedFilename(), /-cues\.json$/);
      const list = JSON.parse(readFileSync(await file.path(), 'utf8'));
      assert.deepEqual(list.cues, state().cues);
      await presenter.say({ type: 'patch', patch: { cues: null } });
      await until('no cues', () => Object.keys(state().cues).length === 0);
      const open = async (given) => {
        const text = typeof given === 'string' ? given : JSON.stringify(given);
        await menu.locator('input[type=file]').setInputFiles({ name: 'cues.json', mimeType: 'application/json', buffer: Buffer.from(text) });
      };
      const { Close, ...others } = list.cues;
      await open({ ...list, cues: { ...others, Close: { ...Close, selection: { node: 9_999_999 } } } });
      await menu.getByText('there is no node 9999999').waitFor();
      await until('the others', () => Object.keys(state().cues).length === 2);
      assert.deepEqual(state().cues, others);
      await presenter.screenshot(`cues-${name}-problem`);
      await open(list);
      await until('all', () => Object.keys(state().cues).length === 3);
      assert.deepEqual(state().cues, list.cues);
      await open({ ...list, version: 2 });
      await menu.getByText('use a newer program').waitFor();
      await open('no list');
      await line('This file is no list of cues.').waitFor();
      assert.deepEqual(state().cues, list.cues);
    });

    testOnTablet('the presenter is lost while they prepare: all keep what they have, and a colleague goes on', async () => {
      await button('Arrival').tap();
      await until('the first cue', () => state().cue?.name === 'Arrival' && state().camera.fov === state().cues.Arrival.camera.fov);
      await button('Present').tap();
      await button('Prepare', strip()).tap();
      await line('Only you see “Close” until you take it.').waitFor();
      const { holder } = state().control;
      const shown = pose(state().camera);
      await page.close();
      for (const { wire } of [...watchers, colleague]) {
        await wire.until('nobody there', () => wire.state.control.absent);
        assert.equal(wire.state.cue.name, 'Arrival');
        assert.deepEqual(pose(wire.state.camera), shown);
      }
      await colleague.say({ type: 'control', action: 'take' });
      await colleague.wire.until('control', () => colleague.wire.state.control.holder !== holder && !colleague.wire.state.control.absent);
      await colleague.page.locator('#view').focus();
      await colleague.page.keyboard.press('PageDown');
      for (const { wire } of [...watchers, colleague]) await wire.until('the next cue', () => wire.state.cue.name === 'Close');
    });
  });
}

describe('cues on a link that pauses', { skip: browserIsMissing }, () => {
  let server;
  let link;
  let browser;
  let presenter;
  let page;

  before(async () => {
    server = await Server.start();
    link = await HeldLink.open(server.port);
    browser = await launchBrowser();
    presenter = await Tablet.open(browser, link.address, SIZES.tablet, { reducedMotion: 'reduce' });
    ({ page } = presenter);
    await presenter.shows((await presenter.wire.still()).frame);
    await presenter.pictures(false);
    const cues = Object.fromEntries(['Arrival', 'Green', 'Inside', 'Section'].map((name, order) => [name, { order, ms: 0 }]));
    await presenter.say({ type: 'patch', patch: { cues } });
    await page.locator('#bar').getByRole('button', { name: 'Cues' }).tap();
  });

  after(async () => {
    await browser?.close();
    link?.close();
    await server?.stop();
  });

  const button = (name) => page.locator('#strip').getByRole('button', { name, exact: true });
  const pill = (connection, words) => page.locator(`#presence[data-connection="${connection}"]`, { hasText: words }).waitFor();
  let asked = 0;
  /** Waits until the server has done all that it was sent. */
  const answered = async () => {
    asked += 1;
    await presenter.say({ type: 'patch', patch: { cues: { Arrival: { ms: asked } } } });
    await presenter.wire.until('the answers', () => presenter.wire.state.cues.Arrival.ms === asked);
  };

  /** Does it twice in a pause of the link: after the pause all see the cue of that name, and not the one after it. */
  const twice = async (act, name) => {
    link.hold();
    await act();
    await act();
    await pill('late', 'Waiting for the server…');
    await presenter.screenshot('cues-late');
    link.release();
    await pill('open', 'Connected');
    await answered();
    assert.equal(presenter.wire.state.cue.name, name);
    await page.locator('#strip').getByRole('button', { name, exact: true, pressed: true }).waitFor();
  };

  test('a tap and another before the answer show the cue that was named, and the pill says that the page waits', async () => {
    await button('Next: Arrival').tap();
    await button('Next: Green').waitFor();
    await twice(() => button('Next: Green').tap(), 'Green');
    await button('Next: Inside').tap();
    await button('Next: Section').waitFor();
  });

  test('so do a clicker, and the buttons for the next cue and the one before', async () => {
    await twice(() => page.keyboard.press('PageUp'), 'Green');
    await twice(() => page.keyboard.press('PageDown'), 'Inside');
    await twice(() => button('Previous cue').tap(), 'Green');
    await twice(() => button('Next cue').tap(), 'Inside');
  });

  test('in all this the browser had nothing to complain of', () => {
    assert.deepEqual(presenter.complaints, []);
  });
});
