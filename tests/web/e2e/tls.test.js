import assert from 'node:assert/strict';
import { after, before, describe, test } from 'node:test';
import { assertClean } from './axe.js';
import { Server } from './program.js';
import { Tablet, browserIsMissing, launchBrowser } from './tablet.js';

const TABLET = { width: 1180, height: 820, pixelRatio: 1 };

describe('by HTTPS', { skip: browserIsMissing }, () => {
  let server;
  let browser;
  let address;

  before(async () => {
    server = await Server.start(0, ['--lan']);
    address = server.address.replace('http:', 'https:');
    browser = await launchBrowser();
  });

  after(async () => {
    await browser?.close();
    await server?.stop();
  });

  test('the page is shown, and may keep the screen awake', async () => {
    const tablet = await Tablet.open(browser, address, TABLET, { ignoreHTTPSErrors: true });
    await tablet.shows((await tablet.wire.still()).frame);
    assert.ok(await tablet.page.evaluate(() => isSecureContext && 'wakeLock' in navigator));
    assert.deepEqual(tablet.complaints, []);
  });

  test('another tablet is shown how to trust the server, and downloads its authority', async () => {
    const page = await browser.newPage();
    await page.goto(`${server.address}trust`);
    const downloads = page.waitForEvent('download');
    await page.getByRole('link', { name: 'Download the certificate' }).click();
    assert.equal((await downloads).suggestedFilename(), 'authority.crt');
    await page.locator('details').evaluateAll((all) => {
      for (const details of all) details.open = true;
    });
    await assertClean(page);
    for (const device of ['iPhone, iPad', 'Android', 'Windows']) assert.equal(await page.getByText(device, { exact: true }).count(), 2);
  });
});
