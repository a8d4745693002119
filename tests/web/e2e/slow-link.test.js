import assert from 'node:assert/strict';
import { after, before, describe, test } from 'node:test';
import { SlowLink } from '../../support/slow-link.mjs';
import { Server } from './program.js';
import { Tablet, browserIsMissing, launchBrowser } from './tablet.js';

const TABLET = { width: 1180, height: 820, pixelRatio: 2 };
/** 200 ms there and back, 2 Mbit/s. */
const LINK = { delayMs: 100, bytesPerSecond: 250_000 };
const DRAG_MS = 6000;
const MOVE_EVERY_MS = 25;
const LEAST_MOVES = 30;

describe('a slow link', { skip: browserIsMissing }, () => {
  let server;
  let link;
  let browser;
  let tablet;

  before(async () => {
    server = await Server.start();
    link = await SlowLink.open(server.port, LINK);
    browser = await launchBrowser();
    tablet = await Tablet.open(browser, 'about:blank', TABLET, { reducedMotion: 'reduce' });
    await tablet.page.addInitScript(takeTimes);
    await tablet.page.goto(link.address);
  });

  after(async () => {
    await browser?.close();
    await link?.close();
    await server?.stop();
  });

  test('the page comes, and its picture', async () => {
    await tablet.shows((await tablet.wire.still()).frame);
    assert.deepEqual(tablet.wire.frames.at(-1).view, TABLET);
  });

  test('a drag stays near the finger, and does not fall behind', async (t) => {
    const place = (ms) => [{ x: 400 + 200 * Math.sin(ms / 500), y: 400 + 100 * Math.sin(ms / 800) }];
    await tablet.finger('touchStart', place(0));
    const began = performance.now();
    for (let ms = 0; ms < DRAG_MS; ms = performance.now() - began) {
      await tablet.finger('touchMove', place(ms));
      await new Promise((resolve) => setTimeout(resolve, MOVE_EVERY_MS));
    }
    await tablet.finger('touchEnd', []);
    const last = await tablet.wire.until('the end of the drag', () => tablet.wire.sent.find(({ type }) => type === 'pointerup'));
    await tablet.page.waitForFunction((id) => window.times.drawn.some(({ handled }) => handled >= id), last.id);

    const { moves, drawn } = await tablet.page.evaluate(() => window.times);
    const waits = moves.map(({ id, at }) => drawn.find(({ handled }) => handled >= id).at - at);
    assert.ok(waits.length >= LEAST_MOVES, `${waits.length} moves`);
    const third = Math.floor(waits.length / 3);
    const [first, final] = [mean(waits.slice(0, third)), mean(waits.slice(-third))];
    const sorted = [...waits].sort((a, b) => a - b);
    const quantile = (share) => Math.round(sorted[Math.floor(share * (sorted.length - 1))]);
    t.diagnostic(`${waits.length} moves, ${drawn.length} pictures; from a move to its picture: median ${quantile(0.5)} ms, ` +
      `95 % ${quantile(0.95)} ms, first third ${Math.round(first)} ms, last third ${Math.round(final)} ms`);
    assert.ok(final <= 1.5 * first + 100, `from ${first} ms to ${final} ms`);
  });

  test('the settings work meanwhile', async () => {
    await tablet.settings('renderer');
    await tablet.page.getByLabel('Wireframe').tap();
    await tablet.wire.until('the change', () => tablet.wire.state.renderer.wireframe);
    await tablet.page.waitForFunction((revision) => Number(document.querySelector('#view').dataset.revision) >= revision, tablet.wire.revision);
    assert.equal((await tablet.look()).lines, '');
    assert.deepEqual(tablet.complaints, []);
  });
});

/** Runs in the page, before it: notes when moves are sent, and when pictures that show them are drawn. */
function takeTimes() {
  window.times = { moves: [], drawn: [] };
  const handled = new Map();
  window.WebSocket = class extends WebSocket {
    constructor(...about) {
      super(...about);
      this.addEventListener('message', ({ data }) => {
        if (typeof data === 'string') return;
        const header = new TextDecoder('latin1').decode(new Uint8Array(data, 0, Math.min(data.byteLength, 4096)));
        handled.set(/"frame":(\d+)/.exec(header)[1], Number(/"handled":(\d+)/.exec(header)[1]));
      });
    }

    send(text) {
      const { type, id } = JSON.parse(text);
      if (type === 'pointermove') window.times.moves.push({ id, at: performance.now() });
      super.send(text);
    }
  };
  document.addEventListener('DOMContentLoaded', () => {
    const canvas = document.querySelector('#view');
    new MutationObserver(() => {
      window.times.drawn.push({ handled: handled.get(canvas.dataset.frame), at: performance.now() });
    }).observe(canvas, { attributeFilter: ['data-frame'] });
  });
}

function mean(values) {
  return values.reduce((sum, value) => sum + value, 0) / values.length;
}
