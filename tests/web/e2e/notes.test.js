import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { writeFile } from 'node:fs/promises';
import path from 'node:path';
import { after, before, describe, test } from 'node:test';
import { assertClean } from './axe.js';
import { Server, temporaryFolder } from './program.js';
import { Tablet, browserIsMissing, launchBrowser } from './tablet.js';

const SIZES = {
  tablet: { width: 1180, height: 820, pixelRatio: 1 },
  phone: { width: 390, height: 844, pixelRatio: 1 },
};
const pose = ({ eye, focus, up, center, fov }) => ({ eye, focus, up, center, fov });
const TOKEN = 'let-this-tablet-steer';

let browser;

before(async () => {
  if (!browserIsMissing) browser = await launchBrowser();
});

after(() => browser?.close());

for (const [name, size] of Object.entries(SIZES)) {
  describe(`notes on a ${name}`, { skip: browserIsMissing }, () => {
    const testOnTablet = name === 'tablet' ? test : () => {};
    let server;
    let presenter;
    let watcher;
    let page;
    let menu;

    before(async () => {
      const file = path.join(temporaryFolder(), 'tokens.json');
      await writeFile(file, JSON.stringify({ control: TOKEN, view: 'let-this-tablet-see' }), { mode: 0o600 });
      server = await Server.start(0, ['--token-file', file]);
      const { origin } = new URL(server.address);
      const open = async (hash) => {
        const tablet = await Tablet.open(browser, `${origin}/#${hash}`, size, { reducedMotion: 'reduce' });
        await tablet.shows((await tablet.wire.still()).frame);
        return tablet;
      };
      presenter = await open(`token=${TOKEN}`);
      watcher = await open('watch&token=let-this-tablet-see');
      ({ page } = presenter);
      menu = page.locator('[data-section="notes"]');
      await page.locator('#menu-button').tap();
      await menu.locator('summary').tap();
      await field().waitFor();
      await until('the menu in the inset', () => (size.width > 600 ? inset().right > 380 : inset().bottom > 0.6 * size.height));
      // The view is measured after the layout of a display frame.
      await page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
      await isShown();
      // With another angle of view it is fitted from another distance, also where that was fitted before.
      const { eye, fov } = state().camera;
      await presenter.say({ type: 'patch', patch: { camera: { fov: fov + 5 } } });
      await presenter.say({ type: 'fit' }); // into what the menu leaves free
      await until('the fit', () => state().camera.fov !== fov && String(state().camera.eye) !== String(eye));
      await isShown();
    });

    after(async () => {
      for (const context of browser?.contexts() ?? []) await context.close();
      await server?.stop();
    });

    const state = () => presenter.wire.state;
    const until = (what, get) => presenter.wire.until(what, get);
    /** Waits for a still picture of the state that is here. */
    const isShown = async () => presenter.shows((await presenter.wire.stillOf(presenter.wire.revision)).frame);
    const button = (label) => menu.getByRole('button', { name: label, exact: true });
    const lines = (text) => page.locator('#lines').getByText(text);
    const undo = () => page.locator('#lines').getByRole('button', { name: 'Undo' }).tap();
    const field = () => menu.getByRole('textbox', { name: 'Text of the note', exact: true });
    const add = async (text) => {
      const before = Object.keys(state().markers).length;
      await field().fill(text);
      // No tap: while the server draws on the same machine, that may take as long as a long press, which is none.
      await button('Note at the middle').click();
      await until(text, () => Object.keys(state().markers).length > before);
    };
    const inset = () => presenter.wire.sent.findLast(({ type }) => type === 'resize').inset;
    /** Of what the menu leaves free. */
    const middle = () => {
      const { top, right, bottom, left } = inset();
      return [(left + size.width - right) / 2, (top + size.height - bottom) / 2];
    };
    const labelIsAt = ([x, y]) => page.waitForFunction(([wantedX, wantedY]) => {
      const box = document.querySelector('#labels p')?.getBoundingClientRect();
      return box && Math.hypot(box.x - wantedX, box.y - wantedY) < 0.5;
    }, [x, y]);
    const hasPictures = (count) => page.waitForFunction((wanted) => {
      const images = [...document.querySelectorAll('.notes img')].filter(({ naturalWidth }) => naturalWidth === 240);
      return images.length === wanted;
    }, count);

    test('one is put on what is in the middle, with its text beside it, a picture, who and when', async () => {
      const before = Date.now();
      await add('Gap too wide');
      const note = state().markers['note 1'];
      assert.equal(note.text, 'Gap too wide');
      assert.equal(note.author, state().clients[state().control.holder].name);
      assert.ok(note.time >= before && note.time <= Date.now());
      assert.deepEqual(note.view, pose(state().camera));
      assert.equal(note.done, false);
      assert.ok(note.node !== undefined);
      await page.waitForFunction((input) => input.value === '', await field().elementHandle());
      await labelIsAt(middle());
      await hasPictures(1);
      await menu.getByText(`${note.author} · `).waitFor();
      await watcher.page.locator('#labels p', { hasText: 'Gap too wide' }).locator('span').waitFor();
    });

    test('a tap flies to where it was made from, to the bit', async () => {
      const { view } = state().markers['note 1'];
      await presenter.say({ type: 'patch', patch: { camera: { eye: [5, 2, 0], fov: 30 } } });
      await presenter.say({ type: 'fit' });
      await until('the other view, fitted', () => state().camera.fov === 30 && String(state().camera.eye) !== '5,2,0');
      await isShown();
      await add('Dent');
      assert.equal(state().markers['note 2'].view.fov, 30);
      await menu.getByRole('button', { name: /^Gap too wide/ }).tap();
      await until('the view', () => JSON.stringify(pose(state().camera)) === JSON.stringify(pose(view)));
    });

    test('it is done or open, and its text changes', async () => {
      const done = menu.getByRole('switch', { name: 'Done: Gap too wide' });
      await done.tap();
      await until('done', () => state().markers['note 1'].done);
      await button('Change Dent').tap();
      const words = menu.getByRole('textbox', { name: 'Text of Dent' });
      await words.pressSequentially('? Why');
      assert.match(await words.inputValue(), /\? Why/);
      assert.equal(await page.locator('dialog').count(), 0);
      await words.fill('Dent in the\ndoor <b>');
      await words.blur();
      await until('the text', () => state().markers['note 2'].text === 'Dent in the\ndoor <b>');
      await hasPictures(2);
      await presenter.screenshot(`notes-${name}`);
      await assertClean(page, 'notes in the menu');
      await menu.getByRole('button', { name: /^Change Dent/ }).tap();
    });

    testOnTablet('it is deleted, and that is undone', async () => {
      const before = structuredClone(state().markers);
      await button('Delete Gap too wide').tap();
      await until('one less', () => !state().markers['note 1']);
      await undo();
      await until('it again', () => state().markers['note 1']);
      assert.deepEqual(state().markers, before);
    });

    testOnTablet('two that are added in haste are two', async () => {
      const before = structuredClone(state().markers);
      await isShown();
      await field().evaluate((input) => {
        for (const text of ['Scratch', 'Stain']) {
          input.value = text;
          input.form.requestSubmit();
        }
      });
      const added = () => Object.entries(state().markers).filter(([one]) => !before[one]);
      await until('both', () => added().some(([, { text }]) => text === 'Stain'));
      assert.deepEqual(added().map(([, { text }]) => text), ['Scratch', 'Stain']);
      await presenter.say({ type: 'patch', patch: { markers: Object.fromEntries(added().map(([one]) => [one, null])) } });
      await until('those before', () => added().length === 0);
    });

    test('the report is saved, with pictures; and the table', async () => {
      // Those would be refined before the report's are drawn.
      for (const tablet of [presenter, watcher]) await tablet.pictures(false);
      const saved = async (label) => {
        const coming = page.waitForEvent('download');
        await button(label).tap();
        const file = await coming;
        return { name: file.suggestedFilename(), file: await file.path(), text: readFileSync(await file.path(), 'utf8') };
      };
      const report = await saved('Report');
      assert.match(report.name, /-report\.html$/);
      assert.equal(report.text.match(/<img /g).length, 3);
      const shown = await browser.newPage({ viewport: { width: size.width, height: size.height } });
      await shown.setContent(report.text);
      await shown.getByText('door <b>').waitFor();
      await shown.waitForFunction(() => [...document.images].every(({ naturalWidth }) => naturalWidth === 640));
      const sideways = await shown.evaluate(() => document.documentElement.scrollWidth - innerWidth);
      assert.ok(sideways <= 0, `it is ${sideways} too wide`);
      if (process.env.VRUT_SCREENSHOTS) await shown.screenshot({ path: path.join(process.env.VRUT_SCREENSHOTS, `report-${name}.png`), fullPage: true });
      await shown.close();
      await button('Report').waitFor();
      const table = await saved('Table (CSV)');
      assert.match(table.text, /^\ufeffname,text,author,time,done,x,y,z,node\r\nnote 1,Gap too wide,/);
      assert.match(table.text, /\r\nnote 2,"Dent in the\ndoor <b>",/);
      for (const tablet of [presenter, watcher]) await tablet.pictures(true);
    });

    testOnTablet('one from before there were notes is looked at, and goes', async () => {
      await presenter.say({ type: 'patch', patch: { markers: { 'note 1': null, 'note 2': null, old: { point: state().markers['note 1'].point, node: state().markers['note 1'].node, text: 'Old', author: null, view: null } } } });
      await until('it alone', () => Object.keys(state().markers).length === 1);
      await until('its place', () => presenter.wire.frames.at(-1)?.markers?.old);
      const place = presenter.wire.frames.at(-1).markers.old;
      await button('Old').tap();
      await until('it in the middle', () => JSON.stringify(state().camera.center) === JSON.stringify(place));
      await labelIsAt(middle());
      await button('Delete Old').tap();
      await menu.getByText('There is no note yet.').waitFor();
      await page.waitForFunction(() => !document.querySelector('#labels p'));
    });

    testOnTablet('where there is no part, there is no note, and its text is kept', async () => {
      await presenter.say({ type: 'patch', patch: { camera: { eye: [0, 50, 0], focus: [0, 60, 0], up: [0, 0, 1] } } });
      await until('the sky', () => state().camera.focus[1] === 60);
      await isShown();
      await field().fill('Nothing');
      await button('Note at the middle').click();
      await lines('There is no part in the middle of the view.').waitFor();
      assert.equal(await field().inputValue(), 'Nothing');
      assert.deepEqual(state().markers, {});
    });

    test('in all this the browser had nothing to complain of', () => {
      assert.deepEqual(presenter.complaints, []);
      assert.deepEqual(watcher.complaints, []);
    });
  });
}
