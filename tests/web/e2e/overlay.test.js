import assert from 'node:assert/strict';
import { after, before, describe, test } from 'node:test';
import { Server } from './program.js';
import { Tablet, browserIsMissing, launchBrowser } from './tablet.js';

const SIZES = {
  tablet: { width: 1180, height: 820, pixelRatio: 1 },
  'upright tablet': { width: 820, height: 1180, pixelRatio: 1 },
  phone: { width: 390, height: 844, pixelRatio: 1 },
  'phone on its side': { width: 844, height: 390, pixelRatio: 1 },
  desktop: { width: 1440, height: 900, pixelRatio: 1 },
};

/** Pairs of what lies on the picture and meets, by their ids. */
function overlaps() {
  const boxes = [...document.querySelectorAll('#presence, #control, #lines, #selection, #strip, #bar, #menu-button, #menu.open')]
    .filter((element) => element.checkVisibility() && (element.textContent || /menu/.test(element.id)))
    .map((element) => ({ id: element.id, element, ...element.getBoundingClientRect().toJSON() }))
    .filter(({ width, height }) => width > 0 && height > 0);
  return boxes.flatMap((a, i) => boxes.slice(i + 1)
    .filter((b) => !a.element.contains(b.element) && !(a.id === 'menu-button' && b.id === 'menu'))
    .filter((b) => Math.min(a.right, b.right) > Math.max(a.left, b.left) + 0.5 && Math.min(a.bottom, b.bottom) > Math.max(a.top, b.top) + 0.5)
    .map((b) => `${a.id} and ${b.id}`));
}

describe('what lies on the picture does not cover one another', { skip: browserIsMissing }, () => {
  let server;
  let browser;

  before(async () => {
    server = await Server.start();
    browser = await launchBrowser();
  });

  after(async () => {
    await browser?.close();
    await server?.stop();
  });

  for (const [name, size] of Object.entries(SIZES)) {
    test(`on a ${name}, when a visitor is refused with the menu open, and closed`, async () => {
      const presenter = await Tablet.open(browser, server.address, size, { userAgent: 'Presenter (Windows)', reducedMotion: 'reduce' });
      await presenter.wire.still();
      await presenter.pictures(false);
      await presenter.say({ type: 'control', action: 'take' });
      await presenter.say({ type: 'pick', x: size.width / 2, y: size.height / 2, then: 'select' });
      await presenter.wire.until('a part', () => presenter.wire.state.selection.name);
      const visitor = await Tablet.open(browser, server.address, size,
        { userAgent: 'Visitor (Android)', reducedMotion: 'reduce', locale: 'cs-CZ' });
      const { page } = visitor;
      await visitor.shows((await visitor.wire.still()).frame);
      await visitor.pictures(false);
      await page.locator('#menu-button').tap();
      await page.locator('#menu.open').waitFor();
      for (const section of ['views', 'presentation']) await page.locator(`[data-section="${section}"] > summary`).tap();
      await page.getByRole('textbox', { name: 'Název pohledu' }).fill('home');
      await page.getByRole('button', { name: 'Uložit pohled' }).tap();
      await page.locator('[data-section="views"]').getByRole('button', { name: 'Výchozí pohled' }).tap();
      await page.locator('#control').getByRole('button', { name: 'Požádat o řízení' }).waitFor();
      await page.locator('#lines').getByText(/^Řídí Windows( 2)?\.$/).waitFor();
      await page.evaluate(() => Promise.allSettled(document.getAnimations().map((animation) => animation.finished)));
      await visitor.screenshot(`overlay-${name}-menu`);
      assert.deepEqual(await page.evaluate(overlaps), []);
      await page.keyboard.press('Escape');
      await page.locator('#menu.open').waitFor({ state: 'detached' });
      await page.locator('#bar').getByRole('button', { name: 'Pohledy' }).tap();
      await visitor.screenshot(`overlay-${name}`);
      assert.deepEqual(await page.evaluate(overlaps), []);
      assert.deepEqual([...presenter.complaints, ...visitor.complaints], []);
      for (const tablet of [visitor, presenter]) await tablet.page.context().close();
    });
  }
});
