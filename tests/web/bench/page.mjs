// What a presenter waits for, in Chromium at the size of a tablet and of a desktop: from opening the page to its first
// and to its sharp picture, the bytes of that, and in a drag from each event to the picture that shows it.
//
//   cd tests/web; VRUT_PREVIEW=../../build/release/server/vrut-preview \
//     VRUT_CAR=../../build/release/scenes/car/car-50k.vrut node bench/page.mjs
import { Server } from '../e2e/program.js';
import { Tablet, launchBrowser } from '../e2e/tablet.js';

const SIZES = {
  tablet: { width: 1180, height: 820, pixelRatio: 2 },
  desktop: { width: 1440, height: 900, pixelRatio: 1 },
};
const LOADS = 5;
const DRAG_MS = 5000;
const EVENT_MS = 16;

const browser = await launchBrowser();
let server;
try {
  for (const [name, size] of Object.entries(SIZES)) {
    server = await Server.start(); // its picture has the size of its first page
    const loads = [];
    for (let i = 0; i < LOADS; i += 1) loads.push(await load(size));
    const [first, sharp] = ['first', 'sharp'].map((what) => Math.round(quantile(loads.map((one) => one[what]), 0.5)));
    const { latencies, pictures, kilobytes } = await drag(size);
    const [p50, p95] = [0.5, 0.95].map((part) => Math.round(quantile(latencies, part)));
    console.log(`${name}: first picture after ${first} ms, sharp after ${sharp} ms (medians of ${LOADS}), page ${loads[0].kilobytes} kB`);
    console.log(`  drag: event to drawn ${p50} ms (median), ${p95} ms (95 %), ${pictures.toFixed(1)} pictures a second, ${kilobytes} kB/s`);
    await server.stop();
  }
} finally {
  await browser.close();
  await server?.stop();
}

async function load(size) {
  const tablet = await Tablet.open(browser, 'about:blank', size);
  await tablet.page.addInitScript(keepTimes);
  await tablet.devtools.send('Network.enable');
  let bytes = 0;
  tablet.devtools.on('Network.loadingFinished', ({ encodedDataLength }) => (bytes += encodedDataLength));
  await tablet.page.goto(server.address);
  const { frame } = await tablet.wire.until('a sharp picture', () =>
    tablet.wire.frames.find(({ quality }) => quality.level === 'still' && quality.scale === 1));
  await tablet.shows(frame);
  const drawn = await tablet.page.evaluate(() => window.drawn);
  await tablet.page.context().close();
  return { first: drawn[0].at, sharp: drawn.find((one) => one.frame >= frame).at, kilobytes: Math.round(bytes / 1000) };
}

async function drag(size) {
  const tablet = await Tablet.open(browser, 'about:blank', size);
  const { page, wire } = tablet;
  await page.addInitScript(keepTimes);
  await page.goto(server.address);
  await wire.until('a picture', () => wire.state && wire.frames.length > 0);
  await tablet.say({ type: 'control', action: 'take' });
  await wire.quiet(1000);
  const middle = [size.width / 2, size.height / 2];
  await tablet.finger('touchStart', [{ x: middle[0], y: middle[1] }]);
  const began = Date.now();
  const mark = wire.frames.length;
  for (let step = 0; Date.now() - began < DRAG_MS; step += 1) {
    const x = middle[0] + 200 * Math.sin(step / 20);
    await tablet.finger('touchMove', [{ x, y: middle[1] }]);
    await new Promise((resolve) => setTimeout(resolve, EVENT_MS));
  }
  const seconds = (Date.now() - began) / 1000;
  const bytes = await page.evaluate(() => window.received);
  await tablet.finger('touchEnd', []);
  const { sent, drawn } = await page.evaluate(() => ({ sent: window.moved, drawn: window.drawn }));
  const handledBy = new Map(wire.frames.map(({ frame, handled }) => [frame, handled]));
  const latencies = sent.map(({ id, at }) => drawn.find((one) => one.at >= at && handledBy.get(one.frame) >= id)?.at - at)
    .filter((ms) => ms >= 0);
  const pictures = wire.frames.slice(mark).filter(({ quality }) => quality.level === 'moving').length / seconds;
  await page.context().close();
  return { latencies, pictures, kilobytes: Math.round(bytes / 1000 / seconds) };
}

/** Runs in the page, before it: when each move was sent, and each picture drawn, in ms since the page was opened. */
function keepTimes() {
  window.moved = [];
  window.drawn = [];
  window.received = 0;
  window.WebSocket = class extends WebSocket {
    constructor(...about) {
      super(...about);
      window.sockets = [this];
      this.addEventListener('message', ({ data }) => {
        if (typeof data !== 'string' && window.moved.length > 0) window.received += data.byteLength;
      });
    }

    send(text) {
      const { type, id } = JSON.parse(text);
      if (type === 'pointermove') window.moved.push({ id, at: performance.now() });
      super.send(text);
    }
  };
  const watch = () => {
    const canvas = document.querySelector('#view');
    new MutationObserver(() => window.drawn.push({ frame: Number(canvas.dataset.frame), at: performance.now() }))
      .observe(canvas, { attributeFilter: ['data-frame'] });
  };
  document.addEventListener('DOMContentLoaded', watch);
}

function quantile(values, part) {
  const sorted = [...values].sort((a, b) => a - b);
  return sorted[Math.min(sorted.length - 1, Math.floor(part * sorted.length))];
}
