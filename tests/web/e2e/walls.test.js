import assert from 'node:assert/strict';
import { after, before, describe, test } from 'node:test';
import { assertClean } from './axe.js';
import { Colleague } from './colleague.js';
import { Server } from './program.js';
import { Tablet, browserIsMissing, launchBrowser } from './tablet.js';

const SIZE = { width: 1180, height: 820, pixelRatio: 1 };

describe('walls', { skip: browserIsMissing }, () => {
  let server;
  let browser;
  let tablet;
  let wall;
  let section;

  before(async () => {
    server = await Server.start();
    browser = await launchBrowser();
    tablet = await Tablet.open(browser, server.address, SIZE, { userAgent: 'Presenter (Windows)', reducedMotion: 'reduce' });
    await tablet.shows((await tablet.wire.still()).frame);
    await tablet.pictures(false);
    await tablet.page.locator('#menu-button').tap();
    section = tablet.page.locator('[data-section="presentation"]');
    await section.evaluate((details) => Object.assign(details, { open: true }));
  });

  after(async () => {
    await wall?.leave();
    await browser?.close();
    await server?.stop();
  });

  const gentle = () => section.getByRole('switch', { name: 'Gentle motion on the walls' });
  const speed = () => section.getByRole('slider', { name: 'Walls turn by at most' });
  const behind = () => section.getByText(/^Walls: .* behind$/);
  const setSpeed = (degrees) => speed().fill(`${degrees}`);

  test('without walls there is nothing to set', async () => {
    assert.equal(await gentle().isVisible(), false);
    wall = await Colleague.join(server.address, { role: 'host', name: 'Wall' });
    await gentle().waitFor();
    assert.equal(await gentle().isChecked(), true);
  });

  test('walls are slowed, the page says how far they are behind, and not once they have caught up', async () => {
    await setSpeed(20);
    await tablet.wire.until('the limit', () => tablet.wire.state.comfort.degreesPerSecond === 20);
    const { camera } = tablet.wire.state;
    await tablet.finger('touchStart', [{ id: 0, x: 300, y: 400 }]);
    for (let x = 340; x <= 620; x += 40) await tablet.finger('touchMove', [{ id: 0, x, y: 400 }]);
    await tablet.finger('touchEnd', []);
    await behind().waitFor();
    await tablet.screenshot('walls-menu');
    await assertClean(tablet.page);
    assert.notDeepEqual(tablet.wire.state.camera.eye, camera.eye);
    await behind().waitFor({ state: 'hidden' });
    await tablet.wire.until('rest', () => !tablet.wire.state.walls);
  });

  test('switched off, walls move as the tablet does', async () => {
    await gentle().tap();
    await tablet.wire.until('the switch', () => !tablet.wire.state.comfort.on);
    await speed().waitFor({ state: 'hidden' });
    await gentle().tap();
    await speed().waitFor();
    assert.deepEqual([tablet.complaints, tablet.wire.errors], [[], []]);
  });
});
