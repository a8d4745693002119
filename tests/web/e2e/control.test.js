import assert from 'node:assert/strict';
import { after, before, describe, test } from 'node:test';
import { pose } from './camera.js';
import { Server } from './program.js';
import { Tablet, browserIsMissing, launchBrowser } from './tablet.js';

const PHONE = { width: 390, height: 844, pixelRatio: 1 };
const OFFERED_MS = 8000; // what a visitor may do
/** Longer than the second after which the server takes a holder for quiet, who keeps control all the same. */
const QUIET_MS = 1200;
/** What presenters hold. */
const SIZES = {
  tablet: { width: 1180, height: 820, pixelRatio: 1 },
};

describe('control', { skip: browserIsMissing }, () => {
  let browser;

  before(async () => {
    browser = await launchBrowser();
  });

  after(() => browser?.close());

  for (const [name, size] of Object.entries(SIZES)) {
    describe(`of a presenter with a ${name}`, () => {
      let server;
      let presenter;
      let visitor;

      before(async () => {
        server = await Server.start();
        presenter = await Tablet.open(browser, server.address, size, { userAgent: 'Presenter (Windows)', reducedMotion: 'reduce' });
        await seen(presenter);
        visitor = await Tablet.open(browser, 'about:blank', PHONE, { userAgent: 'Visitor (Android)', reducedMotion: 'reduce' });
        await visitor.page.clock.install();
        await visitor.page.goto(server.address);
        await seen(visitor);
      });

      after(async () => {
        for (const tablet of [presenter, visitor]) await tablet?.page.context().close();
        await server?.stop();
        assert.deepEqual([presenter, visitor].map(({ complaints }) => complaints), [[], []]);
      });

      const seen = async (tablet) => tablet.shows((await tablet.wire.still()).frame);
      const pill = (tablet, words) => tablet.page.locator('#presence', { hasText: words }).waitFor();
      const bar = ({ page }) => page.locator('#control');
      const choose = (tablet, label) => bar(tablet).getByRole('button', { name: label }).tap();
      const touch = (tablet) => tablet.stroke([{ from: [180, 420], to: [240, 420] }]);
      const hold = async (tablet) => {
        const { x, y, width, height } = await tablet.page.locator('#presence').boundingBox();
        const at = [{ x: x + width / 2, y: y + height / 2, id: 0 }];
        const sent = tablet.wire.sent.length;
        await tablet.finger('touchStart', at);
        await tablet.wire.until('the press was long', () => tablet.wire.sent.slice(sent).some(({ action }) => action === 'take'));
        await tablet.finger('touchEnd', []);
      };

      test('a visitor who touches the picture changes nothing, and may ask', async () => {
        await pill(presenter, 'You are in control');
        await pill(visitor, 'Windows is in control');
        assert.equal(await bar(visitor).textContent(), '');
        const { camera, view } = await presenter.wire.still();
        await presenter.page.waitForTimeout(QUIET_MS);
        await touch(visitor);
        await bar(visitor).getByText('Windows is in control.').waitFor();
        await visitor.screenshot(`control-${name}-visitor`);
        await visitor.page.clock.fastForward(OFFERED_MS);
        await bar(visitor).getByText('Windows is in control.').waitFor({ state: 'detached' });
        await visitor.page.keyboard.press('ArrowLeft');
        await bar(visitor).getByText('Windows is in control.').waitFor();
        assert.deepEqual(visitor.wire.sent.filter(({ type }) => /pointer|wheel|key|patch|control/.test(type)), []);
        const after = (await presenter.touch([{ from: [180, 420], to: [200, 420] }])).before;
        assert.deepEqual(pose(after), pose(camera));
        assert.deepEqual(visitor.wire.frames.at(-1).view, view);
        assert.deepEqual(view, size);
      });

      test('is asked for, declined, and handed over; the picture has the holder\'s size', async () => {
        await touch(visitor);
        await choose(visitor, 'Ask for control');
        await bar(visitor).getByText('You have asked Windows for control.').waitFor();
        await bar(presenter).getByText('Android asks for control.').waitFor();
        await presenter.screenshot(`control-${name}-asked`);
        await choose(presenter, 'Not now');
        await visitor.page.locator('#lines').getByText('Windows keeps control.').waitFor();
        await bar(presenter).getByText('Android asks for control.').waitFor({ state: 'detached' });
        assert.equal(await bar(presenter).textContent(), '');

        await visitor.page.locator('#presence').tap();
        await choose(presenter, 'Hand over');
        await pill(visitor, 'You are in control');
        await pill(presenter, 'Android is in control');
        await presenter.wire.until('the size of the phone', () => presenter.wire.frames.at(-1).view.width === PHONE.width);
        await visitor.touch([{ from: [180, 420], to: [240, 420] }]);
      });

      test('is taken by holding the pill', async () => {
        await hold(presenter);
        await pill(presenter, 'You are in control');
        await pill(visitor, 'Windows is in control');
        await presenter.wire.until('the presenter\'s size', () => presenter.wire.frames.at(-1).view.width === size.width);
        await presenter.touch([{ from: [180, 420], to: [240, 420] }]);
      });

      test('stays over a reload, and no focus ring comes by touch', async () => {
        await presenter.page.reload();
        await seen(presenter);
        await pill(presenter, 'You are in control');
        await pill(visitor, 'Windows is in control');
        await presenter.touch([{ from: [180, 420], to: [240, 420] }]);
        const ring = () => presenter.page.locator('#view').evaluate((view) => getComputedStyle(view).outlineStyle);
        assert.equal(await presenter.page.evaluate(() => document.activeElement.id), 'view');
        assert.equal(await ring(), 'none');
        await presenter.page.keyboard.press('ArrowLeft');
        assert.notEqual(await ring(), 'none');
      });
    });
  }
});
