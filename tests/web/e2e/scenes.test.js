import assert from 'node:assert/strict';
import { copyFile, mkdtemp, rm, writeFile } from 'node:fs/promises';
import { tmpdir } from 'node:os';
import path from 'node:path';
import { after, before, describe, test } from 'node:test';
import { fileURLToPath } from 'node:url';
import { assertClean } from './axe.js';
import { Server } from './program.js';
import { Tablet, browserIsMissing, launchBrowser } from './tablet.js';

const SIZES = {
  tablet: { width: 1180, height: 820, pixelRatio: 1 },
};
const GLASS = fileURLToPath(new URL('../../../scenes/teaching/glass.vrut', import.meta.url));
/** Files do not tell which axis is up in this format; it stands on z = 0. */
const TOWER = ['v -1 -0.5 0', 'v 1 -0.5 0', 'v 1 0.5 0', 'v -1 0.5 0', 'v 0 0 9', 'f 4 3 2 1', 'f 1 2 5', 'f 2 3 5', 'f 3 4 5', 'f 4 1 5'];

for (const [name, size] of Object.entries(SIZES)) {
  describe(`scenes in the menu of a ${name}`, { skip: browserIsMissing }, () => {
    let folder;
    let server;
    let browser;
    let tablet;
    let page;
    let section;

    before(async () => {
      folder = await mkdtemp(path.join(tmpdir(), 'vrut-preview-'));
      await copyFile(GLASS, path.join(folder, 'glass.vrut'));
      await writeFile(path.join(folder, 'tower.obj'), TOWER.join('\n'));
      server = await Server.start(0, ['--scenes', folder]);
      browser = await launchBrowser();
      tablet = await Tablet.open(browser, server.address, size, { reducedMotion: 'reduce' });
      ({ page } = tablet);
      await tablet.shows((await tablet.wire.still()).frame);
      await tablet.pictures(false);
      await page.locator('#menu-button').tap();
      section = page.locator('[data-section="presentation"]');
      await section.locator('summary').tap();
    });

    after(async () => {
      await browser?.close();
      await server?.stop();
      await rm(folder, { recursive: true });
    });

    const state = () => tablet.wire.state;
    const until = (what, get) => tablet.wire.until(what, get);
    const list = () => section.getByRole('combobox', { name: 'Another scene' });
    const line = (label) => page.locator('#lines').getByRole('button', { name: label });
    const asInFile = () => section.getByRole('button', { name: 'Give back what the file says' });
    const deletion = () => section.getByRole('button', { name: 'Delete cues, notes, measures and views…' });

    test('the list marks the one that is shown', async () => {
      const { file } = state().scene;
      await list().waitFor();
      assert.equal(await list().locator('option', { hasText: '(shown)' }).textContent(), `${file} (shown)`);
      assert.equal(await list().inputValue(), file);
    });

    test('after another was opened, the one before is a tap away', async () => {
      const { file } = state().scene;
      await list().selectOption('glass.vrut');
      await section.getByRole('button', { name: 'Open' }).tap();
      await until('the other scene', () => state().scene.file === 'glass.vrut');
      await page.locator('#lines').getByText('Opened glass.vrut.').waitFor();
      await page.evaluate(() => Promise.allSettled(document.getAnimations().map((animation) => animation.finished)));
      await tablet.screenshot(`scenes-${name}-opened`);
      await list().locator('option', { hasText: 'glass.vrut (shown)' }).waitFor({ state: 'attached' });
      await line('Back').tap();
      await until('the scene before', () => state().scene.file === file);
      await page.locator('#lines').getByText(`Opened ${file}.`).waitFor();
    });

    test('parts and variants are given back as in the file, and nothing else, and that is undone', async () => {
      await asInFile().waitFor({ state: 'hidden' });
      await deletion().waitFor({ state: 'hidden' });
      await tablet.say({ type: 'patch', patch: {
        nodes: { 100: { active: false } }, views: { Left: {}, home: { fov: 30 } }, markers: { a: { point: [0, 0, 0], text: 'Gap' } },
        measures: { Wide: { picks: [[0, 0, 0], [1, 0, 0]].map((point) => ({ node: 100, snap: 'point', points: [point] })) } },
        cues: { Arrival: { text: 'Welcome' } }, unit: { shown: 'cm' },
      } });
      await until('a view', () => state().views.Left);
      const before = structuredClone(state());
      const kept = ({ markers, measures, cues, unit, views: { home, ...views } }) => ({ markers, measures, cues, unit, views });
      await asInFile().tap();
      await until('the file', () => Object.keys(state().nodes).length === 0);
      assert.deepEqual(kept(state()), kept(before));
      assert.notEqual(state().views.home.fov, 30);
      await asInFile().waitFor({ state: 'hidden' });
      await tablet.screenshot(`scenes-${name}-file`);
      await line('Undo').tap();
      await until('all as before', () => state().nodes[100]);
      assert.deepEqual([kept(state()), state().nodes, state().views], [kept(before), before.nodes, before.views]);
      await asInFile().waitFor();
    });

    test('cues, notes, measures and views are deleted after a question that counts them, and that is undone', async () => {
      const dialog = page.locator('dialog.deletion');
      const answer = (label) => dialog.getByRole('button', { name: label, exact: true });
      const gone = () => dialog.waitFor({ state: 'detached' });
      await deletion().tap();
      await dialog.getByText('Delete 1 cue, 1 note, 1 measure and 1 view?').waitFor();
      await page.evaluate(() => Promise.allSettled(document.getAnimations().map((animation) => animation.finished)));
      await tablet.screenshot(`scenes-${name}-deletion`);
      await assertClean(page, 'the question');
      const sent = tablet.wire.sent.length;
      await answer('Keep').tap();
      await gone();
      assert.deepEqual(tablet.wire.sent.slice(sent).filter(({ type }) => type === 'patch'), []);
      await deletion().tap();
      await tablet.say({ type: 'patch', patch: { views: { Right: {} } } });
      await dialog.getByText('Delete 1 cue, 1 note, 1 measure and 2 views?').waitFor();
      const { cues, markers, measures, views, nodes, unit } = structuredClone(state());
      await answer('Delete').tap();
      await gone();
      await until('nothing', () => !state().views.Left);
      assert.deepEqual([state().cues, state().markers, state().measures, Object.keys(state().views)], [{}, {}, {}, ['home']]);
      assert.deepEqual([state().nodes, state().unit], [nodes, unit]);
      await deletion().waitFor({ state: 'hidden' });
      await tablet.screenshot(`scenes-${name}-deleted`);
      await line('Undo').tap();
      await until('all as before', () => state().views.Left);
      assert.deepEqual([state().cues, state().markers, state().measures, state().views], [cues, markers, measures, views]);
      await deletion().waitFor();
    });

    test('what lies on its side is turned upright, and that is undone', async () => {
      const axis = (name) => section.getByRole('group', { name: 'Up axis' }).getByText(name, { exact: true });
      await axis('Z').waitFor({ state: 'hidden' });
      await tablet.say({ type: 'open', scene: 'tower.obj' });
      await page.locator('#lines').getByText('it seems to lie on its side').waitFor();
      assert.equal(state().scene.bounds.max[1], 0.5);
      await axis('Z').tap();
      await until('the tower upright', () => state().scene.bounds.max[1] === 9);
      await page.locator('#lines').getByText('The up axis is Z now.').waitFor();
      assert.ok(await axis('Z').getByRole('radio').isChecked());
      await tablet.glance(tablet.wire.revision);
      await tablet.screenshot(`scenes-${name}-upright`);
      // Undo is about the tower, whatever is shown by then.
      await tablet.say({ type: 'open', scene: 'glass.vrut' });
      await until('another scene', () => state().scene.file === 'glass.vrut');
      await line('Undo').tap();
      await until('the tower on its side', () => state().scene.file === 'tower.obj' && state().scene.bounds.max[1] === 0.5);
    });

    test('in all this the browser had nothing to complain of', () => {
      assert.deepEqual(tablet.complaints, []);
    });
  });
}
