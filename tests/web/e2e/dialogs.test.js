import assert from 'node:assert/strict';
import { after, before, describe, test } from 'node:test';
import { Server, temporaryFolder } from './program.js';
import { Tablet, browserIsMissing, launchBrowser } from './tablet.js';

const SIZES = {
  tablet: { width: 1180, height: 820, pixelRatio: 1 },
  phone: { width: 390, height: 844, pixelRatio: 1 },
  desktop: { width: 1440, height: 900, pixelRatio: 1 },
};
const GESTURES = [
  'Turn', 'Move', 'Nearer, farther', 'Select a part', 'A level deeper', 'Clear the selection', 'Fit into the view',
  'Home', 'Control', 'Help',
];

/** What sticks out of a dialog, is too small for a finger or, drawn, is not to be seen. */
function faults(dialog) {
  const { left, right } = dialog.getBoundingClientRect();
  return [...dialog.querySelectorAll('*')].filter((element) => element.checkVisibility()).filter((element) => {
    const box = element.getBoundingClientRect();
    const isSmall = element.tagName === 'BUTTON' && (box.width < 44 || box.height < 44);
    return isSmall || box.left < left - 0.5 || box.right > right + 0.5 || (element.tagName === 'svg' && box.width < 24);
  }).map((element) => element.outerHTML.slice(0, 90));
}

let browser;

before(async () => {
  if (!browserIsMissing) browser = await launchBrowser();
});

after(() => browser?.close());

for (const [name, size] of Object.entries(SIZES)) {
  describe(`dialogs on a ${name}`, { skip: browserIsMissing }, () => {
    const testOnTablet = name === 'tablet' ? test : () => {};
    let server;
    let tablet;
    let page;

    before(async () => {
      server = await Server.start(0, ['--record', temporaryFolder()]);
      tablet = await Tablet.open(browser, server.address, size, { isFirstVisit: true, reducedMotion: 'reduce' });
      ({ page } = tablet);
    });

    after(async () => {
      for (const context of browser?.contexts() ?? []) await context.close();
      await server?.stop();
    });

    const help = () => page.locator('dialog.help');
    const settings = () => page.locator('dialog.settings');
    const gone = () => page.locator('dialog').waitFor({ state: 'detached' });
    const drawn = async () => tablet.shows((await tablet.wire.until('a picture', () => tablet.wire.frames.at(-1))).frame);
    const focused = () => page.evaluate(() => document.activeElement.getAttribute('aria-label') ?? document.activeElement.textContent);
    const keys = () => tablet.wire.sent.filter(({ type }) => type === 'keydown').length;
    const openMenu = async () => {
      if (await page.locator('#menu.open').count()) return;
      await page.locator('#menu-button').tap();
      await page.locator('#menu.open').waitFor();
    };
    const isPhone = name === 'phone';

    test('the help opens by itself on the first visit, with each gesture drawn, and not again', async () => {
      await help().waitFor();
      assert.deepEqual(await help().locator('h3').allTextContents(), GESTURES);
      assert.ok(await help().locator('svg').count() >= GESTURES.length);
      assert.deepEqual(await help().evaluate(faults), []);
      const { x, y, width, height } = await help().boundingBox();
      assert.ok(x >= 0 && y >= 0 && x + width <= size.width && y + height <= size.height);
      if (isPhone) assert.deepEqual([x, y, width, height], [0, 0, size.width, size.height]);
      await page.evaluate(() => Promise.allSettled(document.getAnimations().map((animation) => animation.finished)));
      await tablet.screenshot(`help-${name}`);
      await help().getByRole('button', { name: 'Close' }).tap();
      await gone();

      await page.reload();
      await drawn();
      await page.evaluate(() => new Promise((resolve) => { requestAnimationFrame(() => requestAnimationFrame(resolve)); }));
      // Were it opening, its module would be on its way.
      await page.waitForLoadState('networkidle');
      assert.equal(await page.locator('dialog').count(), 0);
      await tablet.pictures(false);
    });

    testOnTablet('a key opens it, but not while something is typed; its keys do not steer', async () => {
      await page.keyboard.press('?');
      await help().waitFor();
      await page.keyboard.press('ArrowLeft');
      await page.mouse.click(size.width / 2, 200); // on no control: the focus stays in the dialog
      await page.keyboard.press('ArrowLeft');
      await page.keyboard.press('?');
      assert.equal(await page.locator('dialog').count(), 1);
      await page.keyboard.press('Escape');
      await gone();
      assert.equal(keys(), 0);
      await page.keyboard.press('ArrowLeft');
      await tablet.wire.until('a key', () => keys() === 1);

      await page.keyboard.press('?');
      await help().waitFor();
      // Under load the next key, which closes the dialog, may come before this one's module does.
      await page.evaluate(async () => {
        document.body.dispatchEvent(new KeyboardEvent('keydown', { key: '?', bubbles: true, cancelable: true }));
        const dialog = document.querySelector('dialog');
        dialog.close();
        dialog.dispatchEvent(new Event('close'));
        for (let i = 0; i < 4; i += 1) await new Promise((resolve) => { setTimeout(resolve); });
      });
      await gone();
      assert.equal(await page.locator('dialog').count(), 0);

      await openMenu();
      await page.locator('[data-section="views"] summary').tap();
      const field = page.getByRole('textbox', { name: 'Name of the view' });
      await field.focus();
      await page.keyboard.type('What?');
      assert.equal(await field.inputValue(), 'What?');
      await field.fill('');
      assert.equal(await page.locator('dialog').count(), 0);
      await page.locator('[data-section="views"] summary').tap();
    });

    testOnTablet('a button in the menu opens it, and has the focus afterwards', async () => {
      await page.locator('#menu').getByRole('button', { name: 'Help' }).tap();
      await help().waitFor();
      assert.equal(await help().evaluate((dialog) => dialog.contains(document.activeElement)), true);
      await page.keyboard.press('Escape');
      await gone();
      assert.equal(await focused(), 'Help');
      await page.locator('#menu').getByRole('button', { name: 'Help' }).press('Enter');
      await help().waitFor();
      await help().getByRole('button', { name: 'Close' }).press('Enter');
      await gone();
      assert.equal(await focused(), 'Help');
    });

    test('the settings leave the picture as it is, where there is room for both', async () => {
      await openMenu();
      await page.getByRole('button', { name: 'Settings' }).tap();
      await settings().waitFor();
      const { x, y, width, height } = await settings().boundingBox();
      assert.deepEqual([y, x + width, height], [0, size.width, size.height]);
      if (isPhone) assert.equal(x, 0);
      else assert.ok(x > size.width / 2, `begins at ${x}`);
      assert.equal(await settings().evaluate((dialog) => getComputedStyle(dialog, '::backdrop').backgroundColor), 'rgba(0, 0, 0, 0)');
      assert.deepEqual(await settings().evaluate(faults), []);
      await tablet.screenshot(`settings-${name}`);
      await settings().getByRole('button', { name: 'Close' }).tap();
      await gone();
      assert.equal(await focused(), 'Settings');
      assert.equal(await page.locator('#menu.open').count(), 1);
    });

    test('a tap beside closes them and does nothing else, a drag out of them does not', { skip: isPhone && 'nothing is beside' }, async () => {
      await page.getByRole('button', { name: 'Settings' }).tap();
      await settings().waitFor();
      const sent = tablet.wire.sent.length;
      const [x, y] = [size.width - 200, 32];
      await page.mouse.move(x, y);
      await page.mouse.down();
      await page.mouse.move(200, 400, { steps: 3 });
      await page.mouse.up();
      assert.equal(await settings().count(), 1);
      await page.touchscreen.tap(200, 400);
      await gone();
      assert.equal(await focused(), 'Settings');
      assert.deepEqual(tablet.wire.sent.slice(sent).filter(({ type }) => type.startsWith('pointer')), []);
    });

    testOnTablet('what has to be said is said in them', async () => {
      const camera = await tablet.settings('camera');
      await tablet.say({ type: 'resize', width: size.width, height: size.height, pixelRatio: size.pixelRatio });
      const watcher = await Tablet.open(browser, server.address, SIZES.phone, { userAgent: 'Visitor (Android)' });
      await watcher.wire.until('a state', () => watcher.wire.state);
      await watcher.say({ type: 'control', action: 'take' });
      await tablet.wire.until('another in control', () => tablet.wire.state.control.name === 'Android');
      await camera.getByText('Keep upright').tap();
      await settings().locator('#lines').getByText('Android is in control.').waitFor();
      await page.evaluate(() => Promise.allSettled(document.getAnimations().map((animation) => animation.finished)));
      await tablet.screenshot(`settings-${name}-refused`);
      await tablet.closeSettings();
      await page.locator('#over > #lines').waitFor();
      await watcher.page.context().close();
      await tablet.say({ type: 'control', action: 'take' });
      await tablet.wire.until('control again', () => tablet.wire.state.control.name !== 'Android');
    });

    test('while the session is recorded a dot says so, to all, and beside only the picture', async () => {
      const watcher = await Tablet.open(browser, `${server.address}#watch`, SIZES.phone, { isFirstVisit: true });
      const dot = (on) => on.locator('#recording', { hasText: 'Recording' });
      const recording = await tablet.settings('recording');
      await recording.getByRole('button', { name: 'Record', exact: true }).tap();
      await dot(page).waitFor();
      await dot(watcher.page).waitFor();
      await watcher.page.keyboard.press('?');
      await watcher.wire.until('a picture', () => watcher.wire.frames.length > 0);
      await watcher.screenshot(`recording-watcher-${name}`);
      assert.equal(await watcher.page.locator('dialog').count(), 0);
      assert.deepEqual(watcher.complaints, []);
      await watcher.page.context().close();

      await tablet.closeSettings();
      await tablet.screenshot(`recording-${name}`);
      const [pill, opener] = await Promise.all(['#presence', '#menu-button'].map((id) => page.locator(id).boundingBox()));
      if (isPhone) assert.ok(pill.x + pill.width <= opener.x, 'the pill and the button of the menu do not meet');
      await page.getByRole('button', { name: 'Only the picture' }).tap();
      await page.locator('#presence').waitFor({ state: 'hidden' });
      const { x, y, width, height } = await dot(page).boundingBox();
      assert.ok(x < 48 && y < 48 && width <= 32 && height <= 32, `${x} ${y} ${width} ${height}`);
      assert.equal(await dot(page).evaluate((sign) => getComputedStyle(sign, '::before').backgroundColor), 'rgb(255, 90, 78)');
      await tablet.screenshot(`recording-${name}-clean`);
      await page.getByRole('button', { name: 'Show the controls' }).tap();

      await (await tablet.settings('recording')).getByRole('button', { name: 'Stop recording' }).tap();
      await dot(page).waitFor({ state: 'detached' });
      await tablet.closeSettings();
    });

    test('in Czech, and in the dark, they have room, too', async () => {
      await page.getByRole('button', { name: 'Čeština' }).tap();
      await page.locator('html[lang="cs"]').waitFor();
      await page.emulateMedia({ colorScheme: 'dark' });
      await tablet.settings('recording');
      assert.deepEqual(await settings().evaluate(faults), []);
      await tablet.screenshot(`settings-${name}-czech`);
      await tablet.closeSettings();
      await page.keyboard.press('?');
      await help().waitFor();
      assert.deepEqual(await help().evaluate(faults), []);
      await tablet.screenshot(`help-${name}-czech`);
      await page.keyboard.press('Escape');
      await gone();
    });

    test('in all this the browser had nothing to complain of', () => {
      assert.deepEqual(tablet.complaints, []);
    });
  });
}

test('a dialog that cannot be loaded is explained, and comes later', { skip: browserIsMissing }, async () => {
  let server = await Server.start();
  try {
    const tablet = await Tablet.open(browser, server.address, SIZES.phone, { reducedMotion: 'reduce' });
    const { page } = tablet;
    await tablet.wire.until('a picture', () => tablet.wire.frames.length > 0);
    await page.locator('#menu-button').tap();
    const settings = page.getByRole('button', { name: 'Settings' });
    // As where a server of another version has taken the place of the page's.
    await page.route('**/contents-*.js', (route) => route.abort());
    await settings.tap();
    await page.locator('#lines').getByRole('button', { name: 'Reload the page' }).waitFor();
    await page.unroute('**/contents-*.js');

    await server.stop('SIGKILL');
    await page.locator('#view.stale').waitFor();
    await settings.tap();
    await page.locator('#lines').getByText('There is no connection to the server: nothing was changed.').waitFor();
    server = await Server.start(server.port);
    await page.locator('#view:not(.stale)').waitFor();
    await settings.tap();
    await page.locator('dialog.settings').waitFor();
  } finally {
    for (const context of browser.contexts()) await context.close();
    await server.stop();
  }
});
