import assert from 'node:assert/strict';
import { after, before, describe, test } from 'node:test';
import { Server } from './program.js';
import { Tablet, browserIsMissing, launchBrowser } from './tablet.js';

const SIZES = {
  tablet: { width: 1180, height: 820, pixelRatio: 1 },
  phone: { width: 390, height: 844, pixelRatio: 1 },
};

const pose = ({ eye, focus, up, center, fov }) => ({ eye, focus, up, center, fov });

let browser;

before(async () => {
  if (!browserIsMissing) browser = await launchBrowser();
});

after(() => browser?.close());

for (const [name, size] of Object.entries(SIZES)) {
  describe(`saved views in the menu of a ${name}`, { skip: browserIsMissing }, () => {
    const testOnTablet = name === 'tablet' ? test : () => {};
    let server;
    let tablet;
    let page;
    let views;

    before(async () => {
      server = await Server.start();
      tablet = await Tablet.open(browser, server.address, size, { reducedMotion: 'reduce' });
      ({ page } = tablet);
      await tablet.shows((await tablet.wire.still()).frame);
      await tablet.pictures(false);
      await tablet.say({ type: 'patch', patch: { views: { 'Left lamp': {}, Wheel: { fov: 20 } } } });
      await tablet.wire.until('the views', () => tablet.wire.state.views.Wheel);
      await page.locator('#menu-button').tap();
      views = page.locator('[data-section="views"]');
      await views.locator('summary').tap();
    });

    after(async () => {
      for (const context of browser?.contexts() ?? []) await context.close();
      await server?.stop();
    });

    const state = () => tablet.wire.state;
    const until = (what, get) => tablet.wire.until(what, get);
    const button = (label, where = views) => where.getByRole('button', { name: label, exact: true });
    const undo = () => page.locator('#lines').getByRole('button', { name: 'Undo' });

    test('one is renamed by one patch, and keeps its members', async () => {
      const before = state().views['Left lamp'];
      const sent = tablet.wire.sent.length;
      await button('Change Left lamp').tap();
      const field = views.getByRole('textbox', { name: 'New name of Left lamp' });
      assert.equal(await field.inputValue(), 'Left lamp');
      for (const label of ['Rename', 'Save the present view here']) {
        const { x, width } = await button(label).boundingBox();
        assert.ok(x + width <= size.width - 8, label);
      }
      await tablet.screenshot(`views-${name}-edit`);
      await field.fill('Headlamp');
      await field.press('Enter');
      await until('the new name', () => state().views.Headlamp);
      assert.deepEqual(Object.keys(state().views).sort(), ['Headlamp', 'Wheel', 'home']);
      assert.deepEqual(state().views.Headlamp, before);
      assert.equal(tablet.wire.sent.slice(sent).filter(({ type }) => type === 'patch').length, 1);
      await button('Left lamp').waitFor({ state: 'detached' });
    });

    testOnTablet('a name that is taken or too long is refused, and Escape leaves the menu open', async () => {
      await button('Change Headlamp').tap();
      const field = views.getByRole('textbox', { name: 'New name of Headlamp' });
      for (const [taken, line] of [['Wheel', 'There is a view “Wheel” already.'], ['home', 'There is a view “home” already.'], ['é'.repeat(51), /100 bytes/]]) {
        await field.fill(taken);
        await button('Rename').tap();
        await page.locator('#lines').getByText(line).waitFor();
      }
      assert.deepEqual(Object.keys(state().views).sort(), ['Headlamp', 'Wheel', 'home']);
      await field.press('Escape');
      await field.waitFor({ state: 'hidden' });
      assert.equal(await page.locator('#menu.open').count(), 1);
      await page.waitForFunction(() => document.activeElement.ariaLabel === 'Change Headlamp');
    });

    testOnTablet('one is overwritten with the present camera, and that is undone', async () => {
      const before = state().views.Wheel;
      await button('Change Wheel').tap();
      await button('Save the present view here').tap();
      await until('the present view', () => state().views.Wheel.fov === state().camera.fov);
      assert.deepEqual(state().views.Wheel, pose(state().camera));
      await undo().tap();
      await until('the view before', () => state().views.Wheel.fov === before.fov);
      assert.deepEqual(state().views.Wheel, before);
      await undo().waitFor({ state: 'detached' });
    });

    testOnTablet('they are put in order, by a finger and by keys', async () => {
      const names = () => views.getByRole('list', { name: 'Saved views' }).locator('li > :first-child').allTextContents();
      await tablet.say({ type: 'patch', patch: { views: { Antenna: {} } } });
      await button('Change Antenna').tap();
      assert.deepEqual(await names(), ['Antenna', 'Headlamp', 'Wheel']);
      const row = views.locator('li').filter({ has: button('Antenna', page) });
      assert.equal(await button('Move up', row).getAttribute('aria-disabled'), 'true');
      await button('Move down', row).tap();
      await until('the order', () => state().views.Antenna.order === 1);
      await row.locator('[aria-disabled="false"]', { hasText: 'Move up' }).waitFor();
      assert.equal(await page.evaluate(() => document.activeElement.textContent), 'Move down');
      await tablet.screenshot(`views-${name}-order`);
      await page.keyboard.press('Enter');
      await row.locator('[aria-disabled="true"]', { hasText: 'Move down' }).waitFor();
      assert.deepEqual(await names(), ['Headlamp', 'Wheel', 'Antenna']);
      assert.deepEqual((await names()).map((one) => state().views[one].order), [0, 1, 2]);
      await button('Move up', row).press('Enter');
      await row.locator('[aria-disabled="false"]', { hasText: 'Move down' }).waitFor();
      assert.deepEqual(await names(), ['Headlamp', 'Antenna', 'Wheel']);
      assert.equal(await page.evaluate(() => document.activeElement.textContent), 'Move up');
      await tablet.say({ type: 'patch', patch: { views: { Antenna: null } } });
      await button('Antenna').waitFor({ state: 'detached' });
    });

    testOnTablet('one is deleted, and that is undone, by a key, too', async () => {
      const before = structuredClone(state().views);
      await button('Delete Wheel').tap();
      await until('no view', () => !state().views.Wheel);
      await undo().waitFor();
      await tablet.screenshot(`views-${name}-deleted`);
      await undo().focus();
      await page.keyboard.press('Enter');
      await until('the view', () => state().views.Wheel);
      assert.deepEqual(state().views, before);
    });

    testOnTablet('what is typed before the server has answered stays, and is added after it', async () => {
      const field = views.getByRole('textbox', { name: 'Name of the view' });
      const asked = (from) => tablet.wire.sent.slice(from).flatMap(({ patch }) => Object.keys(patch?.views ?? {}));
      const sent = tablet.wire.sent.length;
      await field.evaluate((input) => {
        for (const typed of ['Grille', 'Grille', 'Roof']) {
          input.value = typed;
          input.form.requestSubmit();
        }
        input.value = 'Trunk';
      });
      await button('Roof').waitFor();
      await button('Grille').waitFor();
      assert.deepEqual(asked(sent), ['Grille', 'Roof']);
      await tablet.say({ type: 'patch', patch: { views: { Grille: null, Roof: null } } });
      assert.equal(await field.inputValue(), 'Trunk');
      await button('Save view').tap();
      await page.waitForFunction((input) => input.value === '', await field.elementHandle());
      assert.ok(state().views.Trunk);
      await tablet.say({ type: 'patch', patch: { views: { Trunk: null } } });
    });

    test('in all this the browser had nothing to complain of', () => {
      assert.deepEqual(tablet.complaints, []);
    });
  });
}
