import assert from 'node:assert/strict';
import { after, before, describe, test } from 'node:test';
import { Colleague } from './colleague.js';
import { Server } from './program.js';
import { Tablet, browserIsMissing, launchBrowser } from './tablet.js';

const SIZES = {
  tablet: { width: 1180, height: 820, pixelRatio: 1 },
  phone: { width: 390, height: 844, pixelRatio: 1 },
};
const LEAST_TARGET = 44;

let browser;

before(async () => {
  if (!browserIsMissing) browser = await launchBrowser();
});

after(() => browser?.close());

for (const [name, size] of Object.entries(SIZES)) {
  describe(`the bar of the selected part on a ${name}`, { skip: browserIsMissing }, () => {
    const testOnTablet = name === 'tablet' ? test : () => {};
    let server;
    let tablet;
    let page;
    let other;
    const ids = {};

    before(async () => {
      server = await Server.start();
      tablet = await Tablet.open(browser, server.address, size, { reducedMotion: 'reduce' });
      ({ page } = tablet);
      await tablet.shows((await tablet.wire.still()).frame);
      await tablet.pictures(false);
      other = await Colleague.join(server.address);
      for (const part of ['Body', 'Interior', 'Wheels', 'Presentation', 'Floor shadow', 'Bonnet', 'Spoiler', 'Boot lid']) {
        const { nodes } = await other.ask({ type: 'tree', search: part });
        ids[part] = nodes.find((node) => node.name === part)?.id;
      }
    });

    after(async () => {
      await other?.leave();
      for (const context of browser?.contexts() ?? []) await context.close();
      await server?.stop();
    });

    const bar = () => page.locator('#selection');
    const button = (label) => bar().getByRole('button', { name: label, exact: true });
    const state = () => tablet.wire.state;
    const until = (what, get) => tablet.wire.until(what, get);
    const select = async (part) => {
      await tablet.say({ type: 'patch', patch: { selection: { node: ids[part] } } });
      await until(part, () => state().selection.node === ids[part]);
      await page.locator('#part').getByText(part, { exact: true }).waitFor();
    };
    const hidden = () => Object.entries(state().nodes).filter(([, { active }]) => active === false).map(([id]) => Number(id));

    test('a double tap shows it, with a target for each finger, within the window', async () => {
      assert.equal(await bar().getByRole('button').count(), 0);
      const place = [size.width / 2, size.height / 2];
      await page.touchscreen.tap(...place);
      await page.touchscreen.tap(...place);
      const { selection } = await until('a part', () => state().selection.node !== undefined && state());
      await page.locator('#part').getByText(selection.name, { exact: true }).waitFor();
      for (const one of await bar().getByRole('button').all()) {
        const { x, y, width, height } = await one.boundingBox();
        assert.ok(width >= LEAST_TARGET && height >= LEAST_TARGET, `${await one.textContent()} ${width}x${height}`);
        assert.ok(x >= 0 && y > 0.7 * size.height && x + width <= size.width && y + height <= size.height);
      }
      await tablet.screenshot(`part-${name}`);
      await button('Clear the selection').tap();
      await until('no part', () => state().selection.node === undefined);
      await page.locator('#part:empty').waitFor({ state: 'attached' });
      assert.equal(await bar().getByRole('button').count(), 0);
    });

    test('each level above is selected by its button; what has no room is left out, the last stay', async () => {
      await select('Spoiler');
      const { path } = state().selection;
      const shown = await page.locator('#part > :visible').allTextContents();
      assert.deepEqual(shown, path.slice(-shown.length));
      assert.ok(!shown.includes(path[0]));
      assert.ok(shown.length > 1, String(shown));
      const fits = await page.locator('#part').evaluate(({ scrollWidth, clientWidth }) => scrollWidth <= clientWidth);
      assert.ok(fits);
      await tablet.screenshot(`part-${name}-path`);
      await button('Boot lid').tap();
      await until('the level above', () => state().selection.name === 'Boot lid');
      await page.locator('#part').getByText('Spoiler').waitFor({ state: 'detached' });
    });

    testOnTablet('a long path is shortened', async () => {
      await page.setViewportSize({ width: 260, height: size.height });
      await select('Spoiler');
      await page.locator('#part.shortened').waitFor();
      assert.equal((await page.locator('#part > :visible').allTextContents()).at(-1), 'Spoiler');
      await page.setViewportSize(size);
      await page.locator('#part:not(.shortened)').waitFor();
    });

    testOnTablet('fits, by a key', async () => {
      const { eye } = state().camera;
      await button('Fit').focus();
      await page.keyboard.press('Enter');
      await until('another view', () => String(state().camera.eye) !== String(eye));
      assert.deepEqual(tablet.wire.sent.findLast(({ type }) => type === 'fit').node, ids.Spoiler);
    });

    testOnTablet('hides, and shows again what it hid, and nothing else', async () => {
      await other.patch({ nodes: { [ids.Interior]: { active: false } } });
      await select('Spoiler');
      await button('Hide').tap();
      await until('the spoiler hidden', () => hidden().includes(ids.Spoiler) && state().selection.node === undefined);
      await button('Show all').waitFor();
      await page.waitForFunction(() => document.activeElement.textContent === 'Show all');
      await tablet.screenshot(`part-${name}-hidden`);
      await select('Bonnet');
      await button('Hide').tap();
      await until('the bonnet hidden', () => hidden().length === 3);
      await button('Show all').tap();
      await until('all shown', () => hidden().length === 1);
      assert.deepEqual(hidden(), [ids.Interior]);
      await button('Show all').waitFor({ state: 'detached' });
      await page.waitForFunction(() => document.activeElement.id === 'view');
    });

    testOnTablet('isolates: what is beside it and beside all above it is hidden, and comes back by one patch', async () => {
      await select('Bonnet');
      await button('Isolate').tap();
      await until('the wheels hidden', () => hidden().includes(ids.Wheels));
      assert.ok(!hidden().includes(ids.Bonnet) && !hidden().includes(ids.Body));
      assert.ok(hidden().includes(ids['Boot lid']) && hidden().includes(ids['Floor shadow']));
      assert.ok(!hidden().includes(ids.Presentation), 'the background stays');
      assert.equal(state().selection.node, ids.Bonnet);
      await button('Show all').waitFor();
      await tablet.screenshot(`part-${name}-isolated`, tablet.wire.revision);
      const before = tablet.wire.sent.length;
      await button('Show all').tap();
      await until('all as before', () => hidden().length === 1);
      assert.deepEqual(state().nodes, { [ids.Interior]: { active: false } });
      assert.equal(tablet.wire.sent.slice(before).filter(({ type }) => type === 'patch').length, 1);
    });

    testOnTablet('who only watches sees the path', async () => {
      await select('Bonnet');
      const watcher = await Tablet.open(browser, `${server.address}#watch`, size);
      await watcher.page.locator('#part').getByText('Bonnet').waitFor();
      assert.equal(await watcher.page.locator('#selection button:visible').count(), 0);
      assert.deepEqual(watcher.complaints, []);
      await watcher.page.context().close();
    });

    test('in Czech it fits, too, and the browser had nothing to complain of', async () => {
      await page.evaluate(() => localStorage.setItem('vrut-preview.language', 'cs'));
      const { connections } = tablet.wire;
      await page.reload();
      await until('the state', () => tablet.wire.connections > connections && state());
      await tablet.wire.still();
      await select('Spoiler');
      await button('Skrýt').tap();
      await select('Bonnet');
      await button('Zobrazit vše').waitFor();
      await tablet.screenshot(`part-${name}-czech`);
      for (const one of await bar().getByRole('button').all()) {
        const { x, width } = await one.boundingBox();
        assert.ok(x >= 0 && x + width <= size.width);
      }
      assert.deepEqual(tablet.complaints, []);
    });
  });
}
