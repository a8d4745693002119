// How long the page computes for a display frame in a drag, with the menu open and every section unfolded: the sum of
// the main thread's tasks of script from one display frame to the next, by Chromium's trace, in time of the processor.
import { Server } from '../e2e/program.js';
import { Tablet, launchBrowser } from '../e2e/tablet.js';

const TABLET = { width: 1180, height: 820, pixelRatio: 1 };
const SECTIONS = ['parts', 'views', 'measures', 'presentation'];
const MOST_MS = 8;
const DRAG_MS = 6000;
const MOVE_EVERY_MS = 16;
/** What Chromium calls the tasks that run script. */
const SCRIPT = new Set([
  'FunctionCall', 'v8.callFunction', 'RunMicrotasks', 'EventDispatch', 'FireAnimationFrame', 'TimerFire',
]);

const server = await Server.start();
const browser = await launchBrowser();
try {
  const tablet = await Tablet.open(browser, 'about:blank', TABLET);
  await tablet.page.addInitScript((names) => localStorage.setItem('vrut-preview.sections', names), SECTIONS.join(' '));
  await tablet.page.goto(server.address);
  await tablet.wire.still();
  await tablet.page.click('#menu-button');
  await tablet.page.waitForSelector('.tree li');
  await tablet.wire.still();

  const events = [];
  tablet.devtools.on('Tracing.dataCollected', ({ value }) => events.push(...value));
  const drawn = tablet.wire.frames.length;
  await tablet.devtools.send('Tracing.start', {
    transferMode: 'ReportEvents',
    traceConfig: { includedCategories: ['devtools.timeline', 'v8', 'disabled-by-default-devtools.timeline'] },
  });
  const start = performance.now();
  await tablet.finger('touchStart', [{ id: 0, x: 300, y: 400 }]);
  for (let i = 0; performance.now() - start < DRAG_MS; i += 1) {
    await tablet.finger('touchMove', [{ id: 0, x: 300 + 150 * Math.sin(i / 20), y: 400 + 60 * Math.sin(i / 13) }]);
    await new Promise((resolve) => setTimeout(resolve, MOVE_EVERY_MS));
  }
  await tablet.finger('touchEnd', []);
  const pictures = tablet.wire.frames.length - drawn;
  const complete = new Promise((resolve) => tablet.devtools.once('Tracing.tracingComplete', resolve));
  await tablet.devtools.send('Tracing.end');
  await complete;

  const sorted = scriptPerFrame(events).sort((a, b) => a - b);
  const percentile = (percent) => sorted[Math.ceil((sorted.length * percent) / 100) - 1].toFixed(2);
  const over = sorted.filter((ms) => ms > MOST_MS).length;
  console.log(`${pictures} pictures, ${sorted.length} display frames`);
  const told = [50, 95, 99, 100].map((percent) => `p${percent} ${percentile(percent)}`).join(', ');
  console.log(`script a display frame, ms: ${told}`);
  console.log(`more than ${MOST_MS} ms: ${over}`);
} finally {
  await browser.close();
  await server.stop();
}

/** @returns {number[]} milliseconds of script from each display frame's begin to the next */
function scriptPerFrame(events) {
  const main = events.find(({ name }) => name === 'FireAnimationFrame');
  const ours = events.filter(({ pid, tid }) => pid === main.pid && tid === main.tid).sort((a, b) => a.ts - b.ts);
  const sums = [];
  let end = 0; // of the outermost task of script
  for (const { name, ph, ts, dur = 0, tdur = dur } of ours) {
    if (name === 'FireAnimationFrame' && ph === 'X' && ts >= end) sums.push(0);
    if (!SCRIPT.has(name) || ph !== 'X' || ts < end || sums.length === 0) continue;
    sums[sums.length - 1] += tdur / 1000;
    end = ts + dur;
  }
  return sums;
}
