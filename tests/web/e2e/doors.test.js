import assert from 'node:assert/strict';
import { after, before, describe, test } from 'node:test';
import { Server } from './program.js';
import { Tablet, browserIsMissing, launchBrowser } from './tablet.js';

const SIZES = {
  tablet: { width: 1180, height: 820, pixelRatio: 1 },
  phone: { width: 390, height: 844, pixelRatio: 1 },
};
/** Off the car's left side, which its front left door fills the middle of. */
const BESIDE = { eye: [5, 0.9, 0.3], focus: [0, 0.9, 0.3], center: [0, 0.9, 0.3], up: [0, 1, 0], fov: 30 };

let browser;

before(async () => {
  if (!browserIsMissing) browser = await launchBrowser();
});

after(() => browser?.close());

for (const [name, size] of Object.entries(SIZES)) {
  describe(`on a ${name}`, { skip: browserIsMissing }, () => {
    const testOnTablet = name === 'tablet' ? test : () => {};
    let server;
    let tablet;
    let page;

    before(async () => {
      server = await Server.start();
      tablet = await Tablet.open(browser, server.address, size, { reducedMotion: 'reduce' });
      ({ page } = tablet);
      await until('control', () => state()?.control.holder);
      await page.locator('#bar').waitFor();
      await tablet.pictures(false);
    });

    after(async () => {
      for (const context of browser?.contexts() ?? []) await context.close();
      await server?.stop();
    });

    const state = () => tablet.wire.state;
    const until = (what, get) => tablet.wire.until(what, get);
    const button = (where, label) => page.locator(where).getByRole('button', { name: label, exact: true });
    const changed = () => Object.keys(state().nodes).length;
    const stand = async (camera) => {
      await tablet.say({ type: 'patch', patch: { camera } });
      await until('the camera', () => Object.entries(camera).every(([member, value]) => String(state().camera[member]) === String(value)));
    };

    testOnTablet('doors open from a strip, from the bar of the selected part, and by a tap', async () => {
      await stand(BESIDE);
      await button('#bar', 'Doors').tap();
      const doors = page.locator('#strip').getByRole('switch');
      await doors.first().waitFor();
      const names = await doors.evaluateAll((all) => all.map((one) => one.closest('label').textContent));
      assert.deepEqual(names.slice(0, 3), ['A tap opens', 'Front left', 'Front right']);
      await doors.nth(1).tap();
      await until('the door to open', () => changed() === 1);
      assert.equal(await doors.nth(1).isChecked(), true);
      await tablet.screenshot(`doors-${name}`, tablet.wire.revision);
      await doors.nth(1).tap();
      await until('the door to close', () => changed() === 0);
      assert.equal(await doors.nth(1).isChecked(), false);

      await tablet.say({ type: 'pick', x: size.width / 2, y: size.height / 2, then: 'select' });
      await button('#selection', 'Open').tap();
      await until('the same door to open', () => changed() === 1);
      await tablet.screenshot(`doors-${name}-part`);
      await button('#selection', 'Close').tap();
      await until('it to close', () => changed() === 0);
      await tablet.say({ type: 'patch', patch: { selection: { node: null } } });

      await doors.first().tap();
      await until('taps to open', () => state().navigation.tapSwings);
      await page.touchscreen.tap(size.width / 2, size.height / 2);
      await until('the door to open by the tap', () => changed() === 1 && Object.keys(state().swings).length === 0);
      await page.waitForFunction((strip) => document.querySelectorAll(strip)[1].checked, '#strip [role=switch]');
      await button('#bar', 'Doors').tap();
      await tablet.say({ type: 'patch', patch: { nodes: null, navigation: { tapSwings: null } } });
      await until('the doors as in the file', () => changed() === 0);
    });

    test('fit leaves free what lies on the picture', async () => {
      const inset = () => tablet.wire.sent.findLast(({ type }) => type === 'resize').inset;
      /** By how much the car's middle is seen above the view's, after a fit. */
      const fitted = async () => {
        await stand(BESIDE);
        await button('#bar', 'Fit all').tap();
        await until('the fit', () => String(state().camera.center) !== String(BESIDE.center));
        const { eye, focus, center, up } = state().camera;
        const rise = center.reduce((sum, x, i) => sum + (x - focus[i]) * up[i], 0);
        return rise / Math.hypot(...eye.map((x, i) => x - focus[i]));
      };
      const alone = await fitted();
      const { y } = await page.locator('#bar').boundingBox();
      assert.equal(inset().bottom, Math.round(size.height - y));
      await button('#bar', 'Views').tap();
      await until('the strip in the inset', () => inset().bottom > size.height - y + 40);
      const above = await fitted();
      assert.ok(above > alone + 0.005, `${above} above ${alone}`);
      await tablet.screenshot(`fit-above-the-strip-${name}`, tablet.wire.revision);
      await button('#bar', 'Views').tap();
      await button('#bar', 'More').tap();
      await until('the menu in the inset', () => (size.width > 600 ? inset().right > 380 : inset().bottom > 0.6 * size.height));
      await page.keyboard.press('Escape');
      await until('the bar alone', () => inset().bottom === Math.round(size.height - y));
    });

    testOnTablet('a drag in the driver\'s seat looks around', async () => {
      const [seat] = Object.entries(state().cameras).find(([, camera]) => camera.name === 'Driver\'s seat');
      await stand({ node: Number(seat) });
      const [x, y] = [size.width / 3, size.height / 2];
      await tablet.pictures(true);
      const was = structuredClone(state().camera);
      const { after: now } = await tablet.touch([{ from: [x, y], to: [2 * x, y] }]);
      assert.deepEqual(now.eye, was.eye);
      assert.ok(Math.hypot(...now.focus.map((value, i) => value - was.focus[i])) > 0.1);
      await tablet.screenshot(`look-${name}`);
      assert.deepEqual([tablet.complaints, tablet.wire.errors], [[], []]);
    });
  });
}
