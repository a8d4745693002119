import assert from 'node:assert/strict';
import { after, before, describe, test } from 'node:test';
import { axes, focalLength, project } from '../projection.js';
import { pose } from './camera.js';
import { Server } from './program.js';
import { Tablet, browserIsMissing, difference, launchBrowser } from './tablet.js';

/** `face` is a place of the car that no panel covers, `sky` one beside it. */
const SIZES = {
  tablet: { size: { width: 1180, height: 820, pixelRatio: 1 }, face: [300, 430], sky: [100, 130] },
  phone: { size: { width: 390, height: 844, pixelRatio: 1 }, face: [150, 250], sky: [60, 120] },
};
const CUT = 10; // of 255, in the colour of a part of the picture

const dot = (a, b) => a.reduce((sum, x, i) => sum + x * b[i], 0);
const add = (a, b, factor = 1) => a.map((x, i) => x + factor * b[i]);
const near = (actual, expected, tolerance, what) =>
  assert.ok(Math.hypot(...add(actual, expected, -1)) <= tolerance, `${what}: ${actual} instead of ${expected}`);

let browser;

before(async () => {
  if (!browserIsMissing) browser = await launchBrowser();
});

after(() => browser?.close());

for (const [name, { size, face, sky }] of Object.entries(SIZES)) {
  describe(`sections on a ${name}`, { skip: browserIsMissing }, () => {
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
    });

    after(async () => {
      for (const context of browser?.contexts() ?? []) await context.close();
      await server?.stop();
    });

    const state = () => tablet.wire.state;
    const until = (what, get) => tablet.wire.until(what, get);
    const panel = (of = page) => of.locator('[data-section="sections"]');
    const button = (label) => panel().getByRole('button', { name: label, exact: true });
    const toggle = (label) => panel().getByRole('switch', { name: label, exact: true });
    const slider = (label) => panel().getByRole('slider', { name: label });
    const line = (text) => page.locator('#lines').getByText(text);
    const plane = (number = 1) => state().sections[`Section ${number}`];
    const sent = (type, mark) => tablet.wire.sent.slice(mark).filter((message) => message.type.startsWith(type));
    const patch = (sections) => tablet.say({ type: 'patch', patch: { sections } });
    /** The planes are these alone, and the panel shows that. */
    const only = async (sections) => {
      const others = Object.keys(state().sections).filter((key) => !sections[key]);
      await patch({ ...Object.fromEntries(others.map((key) => [key, null])), ...sections });
      await until('the planes', () => String(Object.keys(state().sections)) === String(Object.keys(sections)));
      await page.waitForFunction((count) =>
        document.querySelectorAll('[data-section="sections"] .rows > li').length === count, Object.keys(sections).length);
    };

    /** The middle of a part of the handle on the window, once it stays where it is. */
    const middleOf = (part) => page.evaluate(async (selector) => {
      const middle = () => {
        const { left, right, top, bottom } = document.querySelector(selector).getBoundingClientRect();
        return [(left + right) / 2, (top + bottom) / 2];
      };
      for (let last = ''; last !== String(middle());) {
        last = String(middle());
        await new Promise(requestAnimationFrame);
        await new Promise(requestAnimationFrame);
      }
      return middle();
    }, part);
    const foot = () => middleOf('#handle [data-grip="move"] circle');
    const knob = () => middleOf('#handle [data-grip="turn"] circle:not(.reach)');
    /** The point of a plane that is seen at a place of the window. */
    const pointOf = ({ normal, distance }, [x, y]) => {
      const { eye } = state().camera;
      const { forward, right, up } = axes(state().camera);
      const focal = focalLength(state().camera, size);
      const ray = add(add(forward, right, (x - size.width / 2) / focal), up, (size.height / 2 - y) / focal);
      return add(eye, ray, (distance - dot(normal, eye)) / dot(normal, ray));
    };

    test('a button leads to them, and one across an axis cuts the car open', async () => {
      if (name === 'tablet') await page.locator('#bar').getByRole('button', { name: 'Sections' }).tap();
      else {
        assert.equal(await page.locator('#bar').getByRole('button', { name: 'Sections' }).count(), 0);
        await page.locator('#menu-button').tap();
        await panel().locator('summary').tap();
      }
      await panel().getByText('No plane cuts the scene yet.').waitFor();
      const whole = await tablet.glance();
      await button('X').tap();
      await until('a plane', () => plane());
      const { eye } = state().camera;
      assert.deepEqual(plane(), { normal: [Math.sign(eye[0]), 0, 0], distance: 0, on: true, caps: true, hatched: false });
      assert.ok(difference(whole, await tablet.glance(tablet.wire.revision)) > CUT);
      await panel().getByRole('button', { name: 'Section 1', pressed: true }).waitFor();
      await tablet.screenshot(`sections-${name}`);
    });

    test('it is swept by a slider, from one end of the scene to the other', async () => {
      const { bounds: { min, max } } = state().scene;
      const beyond = 0.02 * Math.hypot(...add(max, min, -1));
      const sign = plane().normal[0];
      await slider('Position').press('End');
      await until('the end', () => Math.abs(plane().distance - (sign > 0 ? max[0] : -min[0]) - beyond) < 1e-6);
      await slider('Position').press('Home');
      await until('the start', () => Math.abs(plane().distance - (sign > 0 ? min[0] : -max[0]) + beyond) < 1e-6);
      const start = plane().distance;
      const { x, y, width, height } = await slider('Position').boundingBox();
      const at = (part) => [x + part * width, y + height / 2];
      await tablet.stroke([{ from: at(0.03), to: at(0.5) }]);
      await until('the middle', () => Math.abs(plane().distance) < 0.1);
      assert.ok(start < -1);
    });

    testOnTablet('it is turned round, switched off and on, and has caps and lines across', async () => {
      const { normal, distance } = plane();
      await button('Turn Section 1 round').tap();
      await until('the other side', () => plane().normal[0] === -normal[0]);
      near([plane().distance], [-distance], 1e-12, 'distance');
      await toggle('Section 1 cuts').tap();
      await until('off', () => !plane().on);
      await page.locator('#handle').waitFor({ state: 'hidden' });
      await toggle('Section 1 cuts').tap();
      await until('on', () => plane().on);
      await page.locator('#handle').waitFor();
      await toggle('Hatched').first().tap();
      await toggle('Caps').first().tap();
      await until('both', () => plane().hatched && !plane().caps);
    });

    testOnTablet('one like the view takes away what is before the focus, and one is removed, which is undone', async () => {
      await button('Like the view').tap();
      await until('a plane', () => plane(2));
      const { eye, focus } = state().camera;
      near(plane(2).normal, axes({ ...state().camera }).forward.map((x) => -x), 1e-9, 'normal');
      near([plane(2).distance], [dot(plane(2).normal, focus)], 1e-9, 'distance');
      assert.ok(dot(plane(2).normal, eye) > plane(2).distance);
      const before = structuredClone(state().sections);
      await button('Remove Section 1').tap();
      await until('one', () => !plane());
      await page.locator('#lines').getByRole('button', { name: 'Undo' }).tap();
      await until('both', () => plane());
      assert.deepEqual(plane(), before['Section 1']);
    });

    test('one goes through a face that is tapped, and the tap is no one else\'s', async () => {
      await only({});
      const { point, normal } = await tablet.pick(face);
      const mark = tablet.wire.sent.length;
      await button('Through a face').tap();
      await line('Tap the face to cut along.').waitFor();
      await page.touchscreen.tap(...sky);
      await line('There is no part at this place.').waitFor();
      await page.touchscreen.tap(...face);
      await until('a plane', () => plane());
      near(plane().normal, normal, 1e-6, 'normal');
      near([plane().distance], [dot(normal, point)], 1e-6, 'distance');
      await line('Tap the face').waitFor({ state: 'detached' });
      assert.deepEqual(sent('pointer', mark), []);
    });

    testOnTablet('that is given up by Escape, by a second tap on the button, and with the menu', async () => {
      const armed = () => panel().getByRole('button', { name: 'Through a face', pressed: true });
      const given = async () => {
        await armed().waitFor({ state: 'detached' });
        await line('Tap the face').waitFor({ state: 'detached' });
        assert.equal(await page.locator('#tap:visible').count(), 0);
      };
      const mark = tablet.wire.sent.length;
      await button('Through a face').tap();
      await armed().waitFor();
      await page.keyboard.press('Escape');
      await given();
      assert.equal(await page.locator('#menu.open').count(), 1);
      await button('Through a face').tap();
      await armed().waitFor();
      await armed().tap();
      await given();
      await button('Through a face').tap();
      await armed().waitFor();
      await page.getByRole('button', { name: 'Close the menu' }).tap();
      await line('Tap the face').waitFor({ state: 'detached' });
      await page.locator('#handle').waitFor({ state: 'hidden' });
      await page.locator('#menu-button').tap();
      await page.locator('#handle').waitFor();
      assert.deepEqual([...sent('key', mark), ...sent('pick', mark)], []);
    });

    test('the handle moves its plane by what the finger shows, and leaves the camera alone', async () => {
      await only({});
      await button('X').tap();
      await page.locator('#handle').waitFor();
      const before = structuredClone(state());
      const start = await foot();
      const along = add(await knob(), start, -1);
      const way = along.map((x) => 60 * x / Math.hypot(...along));
      const point = pointOf(plane(), start);
      const mark = tablet.wire.sent.length;
      await tablet.stroke([{ from: start, to: add(start, way) }]);
      await until('the last of it', () => {
        const patches = sent('patch', mark);
        const last = patches.at(-1)?.patch.sections['Section 1'].distance;
        return last !== undefined && plane().distance === last;
      });
      const { normal, distance } = plane();
      assert.deepEqual(normal, before.sections['Section 1'].normal);
      const after = add(point, normal, distance - before.sections['Section 1'].distance);
      const seen = add(project(state().camera, after, size), project(state().camera, point, size), -1);
      near(seen, way, 2, 'pixels');
      near(await foot(), add(start, way), 2, 'the handle');
      assert.deepEqual(pose(state().camera), pose(before.camera));
      assert.deepEqual(sent('pointer', mark), []);
      await tablet.screenshot(`sections-${name}-moved`);
    });

    test('its knob turns the plane about the foot', async () => {
      await only({});
      await button('X').tap();
      await page.locator('#handle').waitFor();
      const before = structuredClone(plane());
      const point = pointOf(before, await foot());
      const start = await knob();
      const mark = tablet.wire.sent.length;
      await tablet.stroke([{ from: start, to: add(start, [-10, -45]) }]);
      await until('the last of it', () => {
        const last = sent('patch', mark).at(-1)?.patch.sections['Section 1'];
        return last && Math.abs(plane().distance - last.distance) < 1e-9;
      });
      assert.ok(dot(plane().normal, before.normal) < 0.98, String(plane().normal));
      near([dot(plane().normal, point)], [plane().distance], 0.01, 'distance of the foot');
      assert.deepEqual(sent('pointer', mark), []);
    });

    testOnTablet('six planes are the most, which is said, and what the server refuses, too', async () => {
      const added = (number) => ({ normal: [0, 1, 0], distance: number });
      await only(Object.fromEntries([1, 2, 4, 5, 6].map((number) => [`Section ${number}`, added(number)])));
      await button('Y').tap();
      await until('the free name', () => plane(3));
      await panel().getByText('There are six planes, which is the most.').waitFor();
      for (const label of ['X', 'Y', 'Z', 'Like the view', 'Through a face']) {
        assert.equal(await button(label).getAttribute('aria-disabled'), 'true', label);
        assert.match(await button(label).getAttribute('title'), /six/, label);
      }
      const mark = tablet.wire.sent.length;
      for (const label of ['Z', 'Through a face']) await button(label).tap({ force: true });
      await button('Remove Section 2').tap();
      await until('five', () => !plane(2));
      assert.equal(sent('patch', mark).length, 1);
      await panel().locator('[aria-disabled="false"]', { hasText: 'Like the view' }).waitFor();
      await patch({ 'Section 2b': added(0) });
      await until('six', () => state().sections['Section 2b']);
      await page.locator('#lines').getByRole('button', { name: 'Undo' }).tap();
      const { message } = await until('the refusal', () => tablet.wire.errors.find(({ code }) => code === 'too-many'));
      await line(message[0].toUpperCase() + message.slice(1)).waitFor();
    });

    testOnTablet('the box is switched on, drawn in on each side, and laid around the scene again', async () => {
      await only({});
      const { min, max } = structuredClone(state().sectionBox);
      await toggle('Show only what is in the box').tap();
      await until('on', () => state().sectionBox.on);
      await slider('Z max').press('PageDown');
      await slider('X min').press('PageUp');
      await until('both', () => state().sectionBox.max[2] < max[2] && state().sectionBox.min[0] > min[0]);
      assert.deepEqual(state().sectionBox.min.slice(1), min.slice(1));
      await slider('Y min').press('End');
      await until('almost the upper side', () => state().sectionBox.min[1] > max[1] - 0.1);
      assert.ok(state().sectionBox.min[1] < state().sectionBox.max[1]);
      await tablet.screenshot(`sections-${name}-box`);
      await button('Around the scene').tap();
      await until('the start', () => String(state().sectionBox.min) === String(min));
      assert.deepEqual(state().sectionBox.max, max);
      await toggle('Show only what is in the box').tap();
      await until('off', () => !state().sectionBox.on);
      assert.equal(tablet.wire.errors.filter(({ code }) => code !== 'too-many').length, 0);
    });

    testOnTablet('who is not in control sees them and changes nothing', async () => {
      await only({ 'Section 1': { normal: [0, 0, 1], distance: 0.5 } });
      const visitor = await Tablet.open(browser, server.address, size, { reducedMotion: 'reduce' });
      await visitor.shows((await visitor.wire.still()).frame);
      await visitor.page.locator('#menu-button').tap();
      const seen = panel(visitor.page);
      await seen.locator('summary').tap();
      await seen.getByRole('switch', { name: 'Section 1 cuts', checked: true }).waitFor();
      const controls = seen.locator('button, input');
      assert.ok(await controls.count() > 12);
      for (const control of await controls.all()) assert.ok(await control.isDisabled());
      await visitor.screenshot(`sections-${name}-visitor`);
      await patch({ 'Section 1': { on: false } });
      await seen.getByRole('switch', { name: 'Section 1 cuts', checked: false }).waitFor();
      assert.equal(await visitor.page.locator('#handle:visible').count(), 0);
      assert.deepEqual(visitor.wire.sent.filter(({ type }) => type === 'patch'), []);
      assert.deepEqual(visitor.complaints, []);
      await visitor.page.context().close();
    });

    test('in all this the browser had nothing to complain of', () => {
      assert.deepEqual(tablet.complaints, []);
    });
  });
}
