import assert from 'node:assert/strict';
import { after, before, describe, test } from 'node:test';
import { qrPicture } from '../../../web-client/panels/dialogs/people.js';
import { Colleague } from './colleague.js';
import { Server } from './program.js';
import { Tablet, browserIsMissing, launchBrowser } from './tablet.js';

const SIZES = {
  tablet: { width: 1180, height: 820, pixelRatio: 1 },
  phone: { width: 390, height: 844, pixelRatio: 1 },
};
const LEAST_TARGET = 44;
const STAYS_MS = 6000; // the row of who only watches

describe('people', { skip: browserIsMissing }, () => {
  let browser;

  before(async () => {
    browser = await launchBrowser();
  });

  after(() => browser?.close());

  /** What of an element's buttons a finger misses. */
  const tooSmall = (where) => where.getByRole('button').evaluateAll((all, least) => all
    .filter((button) => button.checkVisibility())
    .map((button) => [button.ariaLabel || button.textContent, button.getBoundingClientRect()])
    .filter(([, { width, height, left, right }]) => width < least || height < least || left < 0 || right > innerWidth)
    .map(([label]) => label), LEAST_TARGET);

  for (const [name, size] of Object.entries(SIZES)) {
    describe(`on a ${name}`, () => {
      const testOnTablet = name === 'tablet' ? test : () => {};
      let server;
      let tablet;
      let page;
      let eva;
      let others;

      before(async () => {
        server = await Server.start();
        tablet = await Tablet.open(browser, server.address, size, { userAgent: 'Presenter (Windows)', reducedMotion: 'reduce' });
        ({ page } = tablet);
        await tablet.shows((await tablet.wire.until('a frame', () => tablet.wire.frames.at(-1))).frame);
        await tablet.pictures(false);
        await page.context().grantPermissions(['clipboard-read', 'clipboard-write']);
        eva = await Colleague.join(server.address, { name: 'Eva' });
        others = [
          await Colleague.join(server.address, { role: 'host', name: 'Wall' }),
          await Colleague.join(server.address, { role: 'view', name: 'Guest' }),
          await Colleague.join(server.address, { role: 'view' }),
        ];
      });

      after(async () => {
        await page?.context().close();
        await server?.stop();
      });

      const state = () => tablet.wire.state;
      const own = () => Object.entries(state().clients).find(([, one]) => one.name === 'Windows')[0];
      const dialog = () => page.locator('dialog.people');
      const button = (label) => dialog().getByRole('button', { name: label, exact: true });
      const lines = () => dialog().locator('li > :first-child').evaluateAll((all) => all.map((one) => [...one.children].map((part) => part.textContent)));

      test('are listed by name, with who is in control and who only watches', async () => {
        await page.locator('#menu-button').tap();
        await page.locator('#menu').getByRole('button', { name: 'People' }).tap();
        await dialog().getByText('1 more is watching.').waitFor();
        assert.deepEqual(await lines(), [['Windows', 'you · in control'], ['Eva', ''], ['Wall', 'wall'], ['Guest', 'only watches']]);
        await button('Enlarge the QR code').waitFor();
        assert.deepEqual(await tooSmall(dialog()), []);
        await tablet.screenshot(`people-${name}`);
      });

      testOnTablet('are handed control, and asked for it', async () => {
        await button('Hand over: Eva').tap();
        await tablet.wire.until('Eva in control', () => state().control.holder === eva.id);
        await button('Ask for control: Eva').tap();
        await tablet.wire.until('the question', () => state().control.asking[0]?.client === own());
        await button('Cancel: Eva').waitFor();
        await page.waitForFunction(() => document.activeElement.ariaLabel === 'Cancel: Eva');
        assert.deepEqual(await lines(), [['Eva', 'in control'], ['Windows', 'you · asks for control'], ['Wall', 'wall'], ['Guest', 'only watches']]);
        await page.keyboard.press('Enter');
        await button('Ask for control: Eva').press('Enter');
        await tablet.wire.until('the question', () => state().control.asking[0]?.client === own());
        await eva.ask({ type: 'control', action: 'give', client: own() });
        await button('Hand over: Eva').waitFor();
        await eva.ask({ type: 'control', action: 'ask' });
        await button('Not now: Eva').tap();
        await tablet.wire.until('no question', () => state().control.asking.length === 0);
        await button('Not now: Eva').waitFor({ state: 'detached' });
      });

      test('are invited by an address and its QR code, which fills the page on demand', async () => {
        const { address, qr } = await eva.ask({ type: 'share', page: server.address });
        assert.equal(address, `${server.address}#watch`);
        assert.equal(await dialog().locator('.address').textContent(), address);
        await dialog().getByText('This address works on this machine only').waitFor();
        const code = () => dialog().locator('.code svg');
        const [, path] = /d="(.+?)"/.exec(qrPicture(qr));
        assert.equal(await code().locator('path').getAttribute('d'), path);
        await button('Copy the address').tap();
        await dialog().getByText('Copied').waitFor();
        assert.equal(await page.evaluate(() => navigator.clipboard.readText()), address);

        await button('Enlarge the QR code').tap();
        const { x, y, width, height } = await code().boundingBox();
        assert.ok(Math.min(width, height) >= Math.min(size.width, size.height) - 1, `${width}x${height}`);
        assert.ok(x >= 0 && y >= 0);
        await tablet.screenshot(`people-${name}-code`);
        await page.keyboard.press('Escape');
        await button('Enlarge the QR code').waitFor();
        assert.equal(await dialog().count(), 1);
      });

      test('come and go', async () => {
        await others.pop().leave();
        await others.pop().leave();
        await dialog().getByText('Guest').waitFor({ state: 'detached' });
        await dialog().getByText('more is watching').waitFor({ state: 'detached' });
        await page.keyboard.press('Escape');
        await dialog().waitFor({ state: 'detached' });
        assert.equal(await page.evaluate(() => document.activeElement.ariaLabel), 'People');
      });

      test('in Czech there is room, too, and the browser had nothing to complain of', async () => {
        await page.locator('.head [lang]').tap();
        await page.locator('#menu').getByRole('button', { name: 'Účastníci' }).tap();
        await dialog().getByText('Adresa funguje jen na tomto počítači').waitFor();
        assert.deepEqual(await tooSmall(dialog()), []);
        await tablet.screenshot(`people-${name}-czech`);
        assert.deepEqual(tablet.complaints, []);
      });

      test('who only watches can choose the language and the full screen, and reads who presents', async () => {
        const watcher = await Tablet.open(browser, 'about:blank', size, { userAgent: 'Guest (Android)', reducedMotion: 'reduce' });
        await watcher.page.clock.install();
        await watcher.page.goto(`${server.address}#watch`);
        const row = watcher.page.locator('#watching');
        await row.getByText('You are only watching; Windows presents.').waitFor();
        assert.deepEqual(await tooSmall(row), []);
        await row.getByRole('button', { name: 'Full screen' }).waitFor();
        await watcher.shows((await watcher.wire.until('a frame', () => watcher.wire.frames.at(-1))).frame);
        await watcher.screenshot(`watching-${name}`);
        await row.getByRole('button', { name: 'Čeština' }).tap();
        await row.getByText('Jen sledujete, prezentuje Windows.').waitFor();
        assert.deepEqual(await tooSmall(row), []);
        await watcher.screenshot(`watching-${name}-czech`);

        const isThere = (there) => watcher.page.waitForFunction((wanted) =>
          (getComputedStyle(document.querySelector('#watching')).opacity === '1') === wanted, there);
        if (name === 'phone') {
          await watcher.page.clock.fastForward(STAYS_MS);
          await isThere(false);
          await watcher.page.touchscreen.tap(180, 300);
          await isThere(true);
          await watcher.page.clock.fastForward(STAYS_MS);
          await isThere(false);
        }
        await row.getByRole('button', { name: 'English' }).focus();
        await watcher.page.keyboard.press('Enter');
        await row.getByText('You are only watching').waitFor();
        await isThere(true);
        assert.deepEqual(watcher.wire.sent.filter(({ type }) => /pointer|key|control/.test(type)), []);
        assert.deepEqual(watcher.complaints, []);
        await watcher.page.context().close();
      });
    });
  }
});
