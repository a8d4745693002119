// How soon a finger's move is on the glass while frames are late, and what that costs: drags on a tablet over a link of
// 100 ms there and 100 back, in Chromium at half the tablet's resolution. Prints medians and 95th percentiles.
import { spawn } from 'node:child_process';
import { once } from 'node:events';
import { Server } from '../e2e/program.js';
import { Tablet, launchBrowser } from '../e2e/tablet.js';

const TABLET = { width: 1180, height: 820, pixelRatio: 1 };
const DRAGS = 8;
const MOVES = 40;

/** Runs in the page: keeps when moves came, and when the picture was drawn after them. */
function watchDrawing() {
  globalThis.glass = { waits: [], moved: 0, refreshes: 0 };
  window.addEventListener('pointermove', ({ timeStamp }) => { globalThis.glass.moved ||= timeStamp; }, { capture: true });
  const { drawElements } = WebGL2RenderingContext.prototype;
  WebGL2RenderingContext.prototype.drawElements = function watched(...about) {
    const { moved, waits } = globalThis.glass;
    if (moved) waits.push(performance.now() - moved);
    globalThis.glass.moved = 0;
    return drawElements.apply(this, about);
  };
  const count = () => {
    globalThis.glass.refreshes += 1;
    requestAnimationFrame(count);
  };
  requestAnimationFrame(count);
}

const of = (values, part) => [...values].sort((a, b) => a - b)[Math.floor(part * (values.length - 1))];
const inMs = (seconds) => (1000 * seconds).toFixed(1);

const server = await Server.start();
const link = spawn(process.env.VRUT_SLOW_LINK, ['--to', String(server.port), '--delay-ms', '100']);
const [said] = await once(link.stdout, 'data');
const browser = await launchBrowser();
try {
  const tablet = await Tablet.open(browser, `http://127.0.0.1:${/\d{4,5}/.exec(String(said))[0]}/`, TABLET, { hasWebGl: true });
  await tablet.wire.stillOf(0);
  await tablet.page.evaluate(watchDrawing);
  const touch = (type, ...touchPoints) => tablet.devtools.send('Input.dispatchTouchEvent', { type, touchPoints });
  const spent = async () => {
    const { metrics } = await tablet.devtools.send('Performance.getMetrics');
    return ['TaskDuration', 'ScriptDuration'].map((wanted) => metrics.find(({ name }) => name === wanted).value);
  };
  await tablet.devtools.send('Performance.enable');
  const [from, refreshes] = [await spent(), await tablet.page.evaluate(() => globalThis.glass.refreshes)];
  const begun = performance.now();
  for (let drag = 0; drag < DRAGS; drag += 1) {
    await touch('touchStart', { x: 400, y: 400 });
    for (let move = 1; move <= MOVES; move += 1) await touch('touchMove', { x: 400 + 3 * move, y: 400 + move });
    await touch('touchEnd');
  }
  const seconds = (performance.now() - begun) / 1000;
  const to = await spent();
  const { waits, refreshes: now } = await tablet.page.evaluate(() => globalThis.glass);
  const count = now - refreshes;
  console.log(`${(count / seconds).toFixed(0)} refreshes a second, ${waits.length} moves`);
  console.log(`from a move to its drawing: ${of(waits, 0.5).toFixed(1)} ms, p95 ${of(waits, 0.95).toFixed(1)} ms`);
  const [tasks, scripts] = to.map((value, i) => inMs((value - from[i]) / count));
  console.log(`main thread: ${tasks} ms a refresh, of it scripts ${scripts}`);
} finally {
  await browser.close();
  link.kill();
  await server.stop();
}
