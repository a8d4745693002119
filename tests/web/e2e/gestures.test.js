import assert from 'node:assert/strict';
import { after, before, describe, test } from 'node:test';
import { project } from '../projection.js';
import { assertPanned, assertTurned, assertZoomed, pose } from './camera.js';
import { Server } from './program.js';
import { Tablet, browserIsMissing, difference, launchBrowser } from './tablet.js';

const SIZES = {
  'a tablet': { width: 1180, height: 820, pixelRatio: 1 },
  'a phone': { width: 390, height: 844, pixelRatio: 2 }, // higher than wide; what is taken for a pixel shows in its ratio
};
/** Of 255: by less than this a picture differs from itself, refined or compressed anew. */
const VISIBLE = 6;
const LONGER_THAN_A_TAP_MS = 400;
const FLICKS = 12;
const HEARD_WITHIN_MS = 5000;

let browser;

before(async () => {
  if (!browserIsMissing) browser = await launchBrowser();
});

after(() => browser?.close());

for (const [name, size] of Object.entries(SIZES)) {
  describe(`gestures on ${name}`, { skip: browserIsMissing }, () => {
    const { width, height } = size;
    const [x, y] = [width / 2, height / 2];
    const shorter = Math.min(width, height);
    const testOnTablet = name === 'a tablet' ? test : () => {};
    let server;
    let tablet;

    before(async () => {
      server = await Server.start();
      tablet = await Tablet.open(browser, server.address, size);
      await tablet.wire.until('control', () => tablet.wire.state?.control.holder);
      await tablet.wire.stillOf(0);
    });

    after(async () => {
      await tablet?.page.context().close();
      await server?.stop();
    });

    const state = () => tablet.wire.state;

    /** Does something; gives the cameras before and after, once the state is as expected. */
    async function moves(act, expected = (now, old) => JSON.stringify(now.camera) !== JSON.stringify(old.camera)) {
      const old = state();
      const sent = tablet.wire.sent.length;
      await act();
      await tablet.wire.until(`what comes of ${act}`, () => expected(state(), old));
      // A drag comes in several changes: its last message has been answered for with the next one's answer.
      const id = tablet.wire.sent.slice(sent).findLast((message) => message.id)?.id ?? 0;
      await tablet.wire.until('a frame of it', () => tablet.wire.frames.at(-1).handled >= id);
      return { before: old.camera, after: state().camera };
    }

    /** The same, which is to be seen. */
    async function changes(act, expected) {
      const seen = await tablet.glance(tablet.wire.revision);
      const cameras = await moves(act, expected);
      const by = difference(seen, await tablet.glance(tablet.wire.revision));
      assert.ok(by > VISIBLE, `the picture has changed by ${by} after ${act}`);
      return cameras;
    }

    /** At once: with a wait between, a busy machine would make a long press of it. */
    const tap = (...place) => Promise.all([
      tablet.finger('touchStart', [{ id: 0, x: place[0], y: place[1] }]),
      tablet.finger('touchEnd', []),
    ]);
    const press = (key) => tablet.page.keyboard.press(key);
    const across = (dx, dy) => [x + dx * shorter, y + dy * shorter];

    test('one finger turns', async () => {
      const stroke = [{ from: [x, y], to: across(0.2, 0.05) }];
      assertTurned(await changes(() => tablet.stroke(stroke)), { right: 36, down: 9 });
    });

    test('a tap is heard however soon it comes after a flick', async () => {
      const { page } = tablet;
      await page.evaluate(() => {
        globalThis.clicks = 0;
        const button = document.createElement('button');
        button.style = 'position: fixed; left: 0; top: 0; width: 50px; height: 50px; z-index: 1000';
        button.onclick = () => (globalThis.clicks += 1);
        document.body.append(button);
      });
      for (let flicks = 1; flicks <= FLICKS; flicks += 1) {
        const [from, to] = flicks % 2 ? [[x, y], across(0.1, 0.1)] : [across(0.1, 0.1), [x, y]];
        await tablet.stroke([{ from, to }]);
        await page.touchscreen.tap(25, 25);
        await page.waitForFunction((count) => globalThis.clicks === count, flicks, { timeout: HEARD_WITHIN_MS });
      }
      // What comes next begins where the last flick ends.
      await tablet.wire.still(tablet.wire.sent.findLast(({ id }) => id).id);
    });

    test('two fingers move and zoom', async () => {
      const aside = (part) => [{ from: across(-0.2, 0), to: across(part - 0.2, -part) }, { from: across(0.2, 0), to: across(part + 0.2, -part) }];
      const { point: panned } = await tablet.pick([x, y]);
      assertPanned(await changes(() => tablet.stroke(aside(0.1))), [0.1 * shorter, -0.1 * shorter], height, panned);
      const spread = [{ from: across(-0.2, 0), to: across(-0.3, 0) }, { from: across(0.2, 0), to: across(0.3, 0) }];
      const { point: zoomed } = await tablet.pick([x, y]);
      assertZoomed(await changes(() => tablet.stroke(spread)), 1.5, zoomed);
    });

    test('two fingers and the wheel zoom about what they touch, beside the middle', async () => {
      const place = across(0.2, 0.05);
      const at = ([dx, dy]) => [place[0] + dx, place[1] + dy];
      const { point } = await tablet.pick(place);
      assert.ok(point, 'a part lies there');
      const pinch = [{ from: at([-60, -20]), to: at([-30, -10]) }, { from: at([60, 20]), to: at([30, 10]) }];
      assertZoomed(await changes(() => tablet.stroke(pinch)), 0.5, point);
      const [old, { point: turned }] = [state().camera, await tablet.pick(place)];
      const { last } = await tablet.wheel(-200, place);
      assertZoomed({ before: old, after: state().camera }, 1.1 ** (-last.deltaY / 100), turned ?? old.focus);
    });

    test('f shows the whole car, as large as the view allows, in its middle', async () => {
      await changes(() => press('f'));
      const steps = Array.from({ length: 49 }, (_, i) => (i + 1) / 50);
      const met = async (places) => {
        // Of what is free of the view.
        const { top, right, bottom, left } = tablet.wire.sent.findLast(({ type }) => type === 'resize').inset;
        const place = ([across, down]) => [left + across * (width - left - right), top + down * (height - top - bottom)];
        const hits = await tablet.picks(places.map(place));
        return hits.some(({ node }) => node !== undefined);
      };
      const sides = async (part) => ({
        left: await met(steps.map((step) => [part, step])),
        right: await met(steps.map((step) => [1 - part, step])),
        top: await met(steps.map((step) => [step, part])),
        bottom: await met(steps.map((step) => [step, 1 - part])),
      });
      assert.deepEqual(await sides(0.075), { left: false, right: false, top: false, bottom: false });
      const within = await sides(0.105);
      assert.ok((within.left && within.right) || (within.top && within.bottom), JSON.stringify(within));
      await tablet.screenshot(`fit-${width}`);
    });

    test('a double tap chooses a part, which is named', async () => {
      await changes(() => Promise.all([tap(x, y), tap(x, y)]), (now) => now.selection.node !== undefined);
      const part = await tablet.page.locator('#part').textContent();
      assert.ok(part.includes(state().selection.name), part);
      await moves(() => press('Escape'), (now) => now.selection.node === undefined);
      await tablet.page.locator('#part:empty').waitFor({ state: 'attached' });
    });

    test('one finger rests, another taps: that is looked at', async () => {
      const { before: old, after: now } = await changes(async () => {
        const resting = { id: 0, x: x - 0.3 * shorter, y: y + 0.3 * shorter };
        await tablet.finger('touchStart', [resting]);
        await new Promise((resolve) => setTimeout(resolve, LONGER_THAN_A_TAP_MS));
        const [tapX, tapY] = across(0.1, 0);
        const tapping = { id: 1, x: tapX, y: tapY };
        await Promise.all([tablet.finger('touchStart', [resting, tapping]), tablet.finger('touchEnd', [tapping])]);
        await tablet.finger('touchEnd', []);
      });
      assert.deepEqual(now.focus, now.center);
      assert.notDeepEqual(now.focus, old.focus);
    });

    testOnTablet('the mouse turns, moves and zooms', async () => {
      const drag = (button, to) => () => tablet.mouse(button, { from: [x, y], to });
      assertTurned(await changes(drag('left', across(-0.1, -0.05))), { right: -18, down: -9 });
      const { point } = await tablet.pick([x, y]);
      assertPanned(await moves(drag('right', [x - 30, y + 20])), [-30, 20], height, point);
      assertZoomed(await moves(drag('middle', [x, y + height / 10])), 4 ** -0.1);
      const { deltaY } = (await tablet.wheel(-100)).last;
      assert.ok(deltaY < 0);
    });

    testOnTablet('a double click with the right button sets the centre, with the middle one it looks there', async () => {
      const twice = (button, place) => () => tablet.page.mouse.dblclick(...place, { button });
      const right = await moves(twice('right', [x, y]));
      assert.notDeepEqual(right.after.center, right.before.center);
      assert.deepEqual(pose(right.after), pose(right.before));
      const middle = await moves(twice('middle', across(0.05, 0)));
      assert.deepEqual(middle.after.focus, middle.after.center);
    });

    testOnTablet('a pen does as the mouse', async () => {
      const pen = (type, place, buttons) => tablet.devtools.send('Input.dispatchMouseEvent', {
        type, x: place[0], y: place[1], button: 'left', buttons, clickCount: 1, pointerType: 'pen',
      });
      const turned = await moves(async () => {
        await pen('mousePressed', [x, y], 1);
        await pen('mouseMoved', across(0.1, 0), 1);
        await pen('mouseReleased', across(0.1, 0), 0);
      });
      const released = () => tablet.wire.sent.findLast(({ type }) => type === 'pointerup');
      await tablet.wire.until('the pen to be lifted', () => released()?.pointerType === 'pen');
      assertTurned(turned, { right: 18, down: 0 });
    });

    testOnTablet('keys turn, move, zoom, fit, go home and choose the drawing', async () => {
      assertTurned(await moves(() => press('ArrowLeft')), { right: -5, down: 0 });
      assertPanned(await moves(() => press('Shift+ArrowUp')), [0, -0.05 * height], height);
      assertZoomed(await moves(() => press('+')), 1.1);
      assertZoomed(await moves(() => press('-')), 1 / 1.1);
      await changes(() => press('w'), (now) => now.renderer.wireframe);
      await moves(() => press('w'), (now) => !now.renderer.wireframe);
      await changes(() => press('s'), (now) => now.renderer.mode === 'stylized');
      await moves(() => press('s'), (now) => now.renderer.mode === 'realistic');
      await moves(() => press('f'));
      const { after: home } = await moves(() => press('Home'));
      assert.deepEqual(pose(home), pose(state().views.home));
    });

    test('with an option one finger turns about what it touches', async () => {
      const { page } = tablet;
      const option = page.getByText('Turn about what is touched');
      await tablet.settings('camera');
      await moves(() => option.tap(), (now) => now.navigation.turnAbout === 'touched');
      await tablet.screenshot(`turn-about-${name.replaceAll(' ', '-')}`);
      await tablet.closeSettings();
      await page.getByRole('button', { name: 'Close the menu' }).tap();

      const place = across(0.15, 0.05);
      const { point } = await tablet.pick(place);
      assert.ok(point, 'a part lies there');
      const [toX, toY] = across(0.25, 0.1);
      const { before: old, after: turned } = await moves(() => tablet.stroke([{ from: place, to: [toX, toY] }]));
      assert.deepEqual(turned.center, old.center);
      const seen = project(turned, point, size);
      assert.ok(Math.hypot(seen[0] + x - place[0], seen[1] + y - place[1]) < 0.5, `seen at ${seen}`);
    });

    test('in all this the browser had nothing to complain of', () => assert.deepEqual(tablet.complaints, []));
  });
}
