import assert from 'node:assert/strict';
import { after, before, describe, test } from 'node:test';
import { fileURLToPath } from 'node:url';
import { Server } from './program.js';
import { Tablet, browserIsMissing, launchBrowser } from './tablet.js';

const SIZES = {
  tablet: { width: 1180, height: 820, pixelRatio: 2 },
  phone: { width: 390, height: 844, pixelRatio: 3 },
  desktop: { width: 1440, height: 900, pixelRatio: 1 },
};
const SCENES = fileURLToPath(new URL('../../../scenes/teaching', import.meta.url));

for (const [name, size] of Object.entries(SIZES)) {
  describe(`scenes in the menu of a ${name}`, { skip: browserIsMissing }, () => {
    let server;
    let browser;
    let tablet;
    let page;
    let section;

    before(async () => {
      server = await Server.start(0, ['--scenes', SCENES]);
      browser = await launchBrowser();
      tablet = await Tablet.open(browser, server.address, size, { reducedMotion: 'reduce' });
      ({ page } = tablet);
      await tablet.shows((await tablet.wire.still()).frame);
      await page.locator('#menu-button').tap();
      section = page.locator('[data-section="presentation"]');
      await section.locator('summary').tap();
    });

    after(async () => {
      await browser?.close();
      await server?.stop();
    });

    const state = () => tablet.wire.state;
    const until = (what, get) => tablet.wire.until(what, get);
    const list = () => section.getByRole('combobox', { name: 'Another scene' });
    const line = (label) => page.locator('#lines').getByRole('button', { name: label });
    const asInFile = () => section.getByRole('button', { name: 'Give back what the file says' });

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

    test('what differs from the file is given back, and that is undone', async () => {
      await asInFile().waitFor({ state: 'hidden' });
      await tablet.say({ type: 'patch', patch: {
        nodes: { 100: { active: false } }, views: { Left: {}, home: { fov: 30 } }, markers: { a: { point: [0, 0, 0], text: 'Gap' } },
      } });
      await until('a view', () => state().views.Left);
      const { views, markers, nodes } = structuredClone(state());
      await asInFile().tap();
      await until('the file', () => !state().views.Left);
      assert.deepEqual([state().markers, state().nodes, Object.keys(state().views)], [{}, {}, ['home']]);
      assert.notEqual(state().views.home.fov, 30);
      await asInFile().waitFor({ state: 'hidden' });
      await tablet.screenshot(`scenes-${name}-file`);
      await line('Undo').tap();
      await until('all as before', () => state().views.Left);
      assert.deepEqual({ views: state().views, markers: state().markers, nodes: state().nodes }, { views, markers, nodes });
      await asInFile().waitFor();
    });

    test('in all this the browser had nothing to complain of', () => {
      assert.deepEqual(tablet.complaints, []);
    });
  });
}
