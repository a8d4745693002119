import assert from 'node:assert/strict';
import { after, before, describe, test } from 'node:test';
import { assertClean } from './axe.js';
import { Server } from './program.js';
import { Tablet, browserIsMissing, launchBrowser } from './tablet.js';

// Axe looks at elements, not at pixels: one for each of CSS is enough.
const SIZES = { 'a tablet': { width: 1180, height: 820, pixelRatio: 1 }, 'a phone': { width: 390, height: 844, pixelRatio: 1 } };

describe('axe finds nothing', { skip: browserIsMissing }, () => {
  let server;
  let browser;

  before(async () => {
    browser = await launchBrowser();
  });

  after(async () => {
    await browser?.close();
    await server?.stop();
  });

  for (const [name, size] of Object.entries(SIZES)) {
    test(`on ${name}`, async (t) => {
      server = await Server.start();
      const tablet = await Tablet.open(browser, server.address, size, { reducedMotion: 'reduce' });
      const { page } = tablet;
      await tablet.shows((await tablet.wire.still()).frame);
      await tablet.pictures(false);
      const unfold = (where = '#menu') => page.locator(`${where} details`).evaluateAll((all) => {
        for (const details of all) details.open = true;
      });
      const open = async () => {
        await page.locator('#menu-button').tap();
        await page.locator('#menu.open').waitFor();
        await unfold();
      };

      const looks = {
        'the menu closed': async () => {},
        'a part selected, a measure, and the views': async () => {
          const picks = [0, 1].map((x) => ({ node: 100, snap: 'point', points: [[x, 0, 0]] }));
          const measures = { Gap: { kind: 'distance', picks } };
          await tablet.say({ type: 'patch', patch: { selection: { node: 100 }, views: { Left: {} }, measures } });
          await page.locator('#part span').waitFor();
          await page.locator('#measures button').waitFor();
          await page.locator('#bar').getByRole('button', { name: 'Views' }).tap();
          await page.locator('#strip').getByRole('button', { name: 'Left' }).waitFor();
        },
        'the variants': async () => {
          await page.locator('#bar').getByRole('button', { name: 'Variants' }).tap();
          await page.locator('#strip').getByRole('radio').first().waitFor();
        },
        'the menu open': open,
        'the settings': async () => {
          await tablet.settings('camera');
          await unfold('dialog');
        },
        'the settings in the dark': () => page.emulateMedia({ colorScheme: 'dark' }),
        'the help in the dark': async () => {
          await tablet.closeSettings();
          await page.keyboard.press('?');
          await page.locator('dialog.help').waitFor();
        },
        'the help': () => page.emulateMedia({ colorScheme: 'light' }),
        'the people': async () => {
          await tablet.closeSettings();
          await page.locator('#menu').getByRole('button', { name: 'People' }).tap();
          await page.locator('.code path').waitFor({ state: 'attached' });
        },
        'the people, and the code alone': () => page.locator('.code').tap(),
        'the people in the dark': async () => {
          await page.locator('.code').tap();
          await page.emulateMedia({ colorScheme: 'dark' });
        },
        'in the dark': async () => {
          await tablet.closeSettings();
          await page.emulateMedia({ colorScheme: 'dark' });
        },
        'in Czech': async () => {
          await page.locator('.head [lang]').tap();
          await page.locator('html[lang="cs"]').waitFor();
          await unfold();
        },
        'the server away': async () => {
          tablet.serverAway = true;
          await server.stop('SIGKILL');
          await page.locator('#view.stale').waitFor();
          await page.locator('#lines p').first().waitFor();
        },
        'and in the light': () => page.emulateMedia({ colorScheme: 'light' }),
      };
      await t.test('of who only watches', async () => {
        const watcher = await Tablet.open(browser, `${server.address}#watch`, size, { reducedMotion: 'reduce' });
        await watcher.page.locator('#watching p').waitFor();
        await assertClean(watcher.page);
        await watcher.page.context().close();
      });
      for (const [look, act] of Object.entries(looks)) {
        await t.test(look, async () => {
          await act();
          await assertClean(page);
        });
      }
      assert.deepEqual(tablet.complaints, []);
      await page.context().close();
    });
  }
});
