import assert from 'node:assert/strict';
import { after, before, describe, test } from 'node:test';
import { Server } from './program.js';
import { Tablet, browserIsMissing, launchBrowser } from './tablet.js';

const SIZES = {
  tablet: { width: 1180, height: 820, pixelRatio: 1 },
  'upright tablet': { width: 820, height: 1180, pixelRatio: 1 },
  phone: { width: 390, height: 844, pixelRatio: 1 },
  desktop: { width: 1440, height: 900, pixelRatio: 1 },
};
const LEAST_TARGET = 44;
const STILL_MS = 600; // so long a camera does not change until `trail.js` takes it for still

const saved = ({ eye, focus, center, fov }) => JSON.stringify({ eye, focus, center, fov });

let browser;

before(async () => {
  if (!browserIsMissing) browser = await launchBrowser();
});

after(() => browser?.close());

for (const [name, size] of Object.entries(SIZES)) {
  describe(`the bar on the picture of a ${name}`, { skip: browserIsMissing }, () => {
    const testOnTablet = name === 'tablet' ? test : () => {};
    let server;
    let tablet;
    let page;

    before(async () => {
      server = await Server.start();
      tablet = await Tablet.open(browser, server.address, size, { reducedMotion: 'reduce' });
      ({ page } = tablet);
      await tablet.shows((await tablet.wire.still()).frame);
      await tablet.pictures(false);
      await page.clock.install();
    });

    after(async () => {
      for (const context of browser?.contexts() ?? []) await context.close();
      await server?.stop();
    });

    const state = () => tablet.wire.state;
    const until = (what, get) => tablet.wire.until(what, get);
    const bar = () => page.locator('#bar');
    const strip = () => page.locator('#strip');
    const button = (label, where = bar()) => where.getByRole('button', { name: label, exact: true });
    const drag = () => tablet.stroke([{ from: [size.width / 2, size.height / 2], to: [size.width / 2 + 90, size.height / 2 + 20] }]);
    /** Waits until the page has the camera, and lets it be still for long enough. */
    const settled = async () => {
      await tablet.follows();
      await page.clock.fastForward(STILL_MS);
    };
    const cameraIs = (pose) => until('that camera', () => saved(state().camera) === saved(pose));

    /** All that lies on the picture is within it, big enough for a finger, and leaves the middle free. */
    async function assertSlim() {
      const boxes = await page.evaluate(() => [...document.querySelectorAll('#bar, #strip, #selection:has(span), #over button, #strip label')]
        .filter((one) => one.checkVisibility()).map((one) => ({ name: one.id || one.textContent, tag: one.tagName, inStrip: Boolean(one.closest('#strip > div')), ...one.getBoundingClientRect().toJSON() })));
      for (const { name: what, tag, inStrip, left, right, top, bottom, width, height } of boxes) {
        if (tag === 'BUTTON' && what !== 'presence') assert.ok(width >= LEAST_TARGET && height >= LEAST_TARGET, `${what} ${width}x${height}`);
        if (!inStrip) assert.ok(left >= 0 && right <= size.width && bottom <= size.height, what);
        if (what === 'presence') continue;
        assert.ok(top > 0.65 * size.height, `${what} begins at ${top}`);
      }
      const { width: wide, height: high } = await bar().boundingBox();
      assert.ok(high <= 64 && wide <= size.width, `${wide}x${high}`);
    }

    test('all its buttons have names, and room for a finger', async () => {
      const spare = name === 'phone' ? [] : ['Sections', 'Measure', 'Point', 'Cues'];
      assert.deepEqual(await bar().getByRole('button').allTextContents(),
        ['Home', 'Fit all', 'Back', 'Views', 'Variants', 'Doors', ...spare, 'More']);
      await assertSlim();
      await tablet.screenshot(`bar-${name}`);
    });

    testOnTablet('Home and Fit move the camera, and Back leads through what was before', async () => {
      assert.equal(await button('Back').getAttribute('aria-disabled'), 'true');
      const first = structuredClone(state().camera);
      await drag();
      await page.locator('#bar [aria-disabled="false"]').waitFor();
      await settled();
      const dragged = structuredClone(state().camera);
      await button('Home').tap();
      await cameraIs(state().views.home);
      await settled();
      await button('Fit all').tap();
      await until('the scene to fit', () => saved(state().camera) !== saved(state().views.home));
      await settled();
      for (const pose of [state().views.home, dragged]) {
        await button('Back').tap();
        await cameraIs(pose);
        await settled();
      }
      await button('Back').focus();
      await page.keyboard.press('Enter');
      await cameraIs(first);
      await page.locator('#bar [aria-disabled="true"]').waitFor();
      assert.deepEqual(tablet.wire.errors, []);
    });

    test('a strip has the views and cameras, and goes through them in order', async () => {
      await tablet.say({ type: 'patch', patch: { views: { 'Left lamp': {} } } });
      await until('the view', () => state().views['Left lamp']);
      await button('Views').tap();
      assert.equal(await button('Views').getAttribute('aria-expanded'), 'true');
      await strip().getByRole('list', { name: 'Views' }).waitFor();
      assert.deepEqual(await strip().locator('li').allTextContents(), ['Left lamp', 'Outside', 'Driver\'s seat']);
      await assertSlim();
      await button('Driver\'s seat', strip()).tap();
      await until('the camera', () => state().camera.name === 'Driver\'s seat');
      await strip().getByRole('button', { name: 'Driver\'s seat', pressed: true }).waitFor();
      await button('Next view', strip()).tap();
      await cameraIs(state().views['Left lamp']);
      await tablet.screenshot(`bar-${name}-views`, tablet.wire.revision);
      await button('Next view', strip()).tap();
      await button('Next view', strip()).tap();
      await until('two further', () => state().camera.name === 'Driver\'s seat');
      await settled();
      await button('Previous view', strip()).press('Enter');
      await until('one before', () => state().camera.name === 'Outside');
      await settled();
      await page.keyboard.press('Escape');
      await strip().waitFor({ state: 'hidden' });
      assert.equal(await page.evaluate(() => document.activeElement.textContent), 'Views');
      assert.deepEqual(tablet.wire.sent.filter(({ type }) => type.startsWith('key')), []);
    });

    test('another strip has the variants, and the selected part its bar above it', async () => {
      await button('Views').tap();
      await button('Variants').tap();
      const silver = strip().getByRole('radio', { name: 'Silver' });
      await silver.waitFor();
      assert.equal(await strip().locator('li').count(), 0);
      const was = JSON.stringify(state().nodes);
      await silver.tap();
      await until('silver', () => JSON.stringify(state().nodes) !== was);
      assert.equal(await silver.isChecked(), true);
      await page.keyboard.press('ArrowRight');
      await until('green', () => Object.values(state().nodes).some(({ activeChild }) => activeChild === 2));
      await tablet.say({ type: 'pick', x: size.width / 2, y: size.height / 2, then: 'select' });
      await page.locator('#part span').waitFor();
      await assertSlim();
      await tablet.screenshot(`bar-${name}-variants`, tablet.wire.revision);
      await tablet.say({ type: 'patch', patch: { selection: { node: null } } });
      await button('Variants').tap();
      await strip().waitFor({ state: 'hidden' });
    });

    testOnTablet('More opens the menu, which gives the focus back', async () => {
      await button('More').press('Enter');
      await page.locator('#menu.open').waitFor();
      await tablet.screenshot(`bar-${name}-menu`);
      await page.keyboard.press('Escape');
      await page.locator('#menu.open').waitFor({ state: 'detached' });
      assert.equal(await page.evaluate(() => document.activeElement.textContent), 'More');
    });

    testOnTablet('only the picture stays where the menu is told so, and its button brings all back', async () => {
      await button('More').tap();
      await page.getByRole('button', { name: 'Only the picture' }).tap();
      await bar().waitFor({ state: 'hidden' });
      await page.locator('#presence').waitFor({ state: 'hidden' });
      await tablet.screenshot(`bar-${name}-clean`);
      await page.getByRole('button', { name: 'Show the controls' }).tap();
      await bar().waitFor();
      assert.equal(await page.locator('#menu.open').count(), 0);
      await page.getByRole('button', { name: 'Menu' }).waitFor();
    });

    testOnTablet('who only watches has none', async () => {
      const watcher = await Tablet.open(browser, `${server.address}#watch`, size);
      await watcher.shows((await watcher.wire.still()).frame);
      assert.equal(await watcher.page.locator('#bar:visible').count(), 0);
      assert.deepEqual(watcher.complaints, []);
      await watcher.page.context().close();
    });

    test('in Czech it has room, too, and the browser had nothing to complain of', async () => {
      await page.evaluate(() => localStorage.setItem('vrut-preview.language', 'cs'));
      await page.reload();
      await button('Varianty').tap();
      await strip().getByRole('radio', { name: 'Silver' }).waitFor();
      const out = await bar().getByRole('button').evaluateAll((all) =>
        all.filter(({ scrollWidth, clientWidth }) => scrollWidth > clientWidth).map(({ textContent }) => textContent));
      assert.deepEqual(out, []);
      await assertSlim();
      await tablet.screenshot(`bar-${name}-czech`);
      assert.deepEqual(tablet.complaints, []);
    });
  });
}
