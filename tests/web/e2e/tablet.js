import { existsSync } from 'node:fs';
import path from 'node:path';
import { chromium } from 'playwright-core';
import WebSocket from 'ws';
import { Wire } from './wire.js';

const BROWSER = '/usr/bin/chromium';
const LIMIT_MS = 20_000;
const ARGUMENTS = [
  '--disable-gpu', '--disable-quic', '--no-first-run', '--disable-background-networking', '--disable-component-update',
  '--disable-sync',
];

export const browserIsMissing = existsSync(BROWSER) ? false : `there is no ${BROWSER}`;

export function launchBrowser() {
  return chromium.launch({ executablePath: BROWSER, headless: true, chromiumSandbox: false, args: ARGUMENTS });
}

/** Runs in the page, before it: keeps its WebSockets and the newest revision where tests find them, and grants while it wants no pictures. */
function rememberSockets() {
  window.sockets = [];
  window.revision = 0;
  window.keptGrants = null;
  window.WebSocket = class extends WebSocket {
    constructor(...about) {
      super(...about);
      window.sockets.push(this);
      window.revision = 0;
      this.addEventListener('message', ({ data }) => {
        const { type, revision } = typeof data === 'string' ? JSON.parse(data) : {};
        if (type === 'state' || type === 'patch') window.revision = revision;
      });
      if (window.keptGrants) window.keptGrants = []; // a connection's grants are its own
    }

    send(text) {
      if (window.keptGrants && text.startsWith('{"type":"frame"')) window.keptGrants.push(text);
      else super.send(text);
    }
  };
}

/** Runs there, too: the software that draws WebGL 2 counts as a graphics card, and what it draws can be looked at later. */
function acceptWebGl() {
  const { getContext } = HTMLCanvasElement.prototype;
  HTMLCanvasElement.prototype.getContext = function changed(kind, options) {
    return getContext.call(this, kind, kind === 'webgl2' ? { ...options, preserveDrawingBuffer: true } : options);
  };
  const { getParameter } = WebGL2RenderingContext.prototype;
  WebGL2RenderingContext.prototype.getParameter = function changed(what) {
    const value = getParameter.call(this, what);
    return typeof value === 'string' ? value.replace(/SwiftShader|llvmpipe/g, 'card') : value;
  };
}

/** Runs there, too: the help, which opens by itself on a first visit, has been seen. */
function rememberHelp() {
  try {
    localStorage.setItem('vrut-preview.help', 'seen');
  } catch {
    // A blank page has no storage.
  }
}

/** @returns {number} by how much, of 255, two glances differ where they differ most */
export function difference(a, b) {
  return Math.max(...a.map((value, i) => Math.abs(value - b[i])));
}

/** A page in the browser, with what a test needs to use it like a hand and to listen in. */
export class Tablet {
  /** What the browser complained of. */
  complaints = [];
  /** While the server is known to be away, the browser may say that it cannot be reached. */
  serverAway = false;
  #wantsPictures = true;

  /**
   * @param {import('playwright-core').Browser} browser
   * @param {string} address
   * @param {{width: number, height: number, pixelRatio: number}} size
   * @param {import('playwright-core').BrowserContextOptions & {isFirstVisit?: boolean, hasWebGl?: boolean}} [options] more of the browser's
   */
  static async open(browser, address, { width, height, pixelRatio }, { isFirstVisit = false, hasWebGl = false, ...options } = {}) {
    const tablet = new Tablet();
    const context = await browser.newContext({
      viewport: { width, height },
      deviceScaleFactor: pixelRatio,
      hasTouch: true,
      isMobile: true,
      ...options,
    });
    context.setDefaultTimeout(LIMIT_MS);
    await context.addInitScript(rememberSockets);
    if (hasWebGl) await context.addInitScript(acceptWebGl);
    if (!isFirstVisit) await context.addInitScript(rememberHelp);
    tablet.page = await context.newPage();
    tablet.wire = new Wire(tablet.page);
    tablet.page.on('pageerror', (error) => tablet.complaints.push(String(error)));
    tablet.page.on('console', (message) => {
      const expected = tablet.serverAway && /WebSocket connection|ERR_CONNECTION_REFUSED/.test(message.text());
      if (message.type() === 'error' && !expected) tablet.complaints.push(message.text());
    });
    tablet.devtools = await context.newCDPSession(tablet.page);
    await tablet.page.goto(address);
    return tablet;
  }

  /**
   * Does something with the hand, and waits until the page shows what came of it.
   *
   * @param {() => Promise<void>} act
   * @param {{type: string, count?: number}} end the messages that are the gesture's last
   * @returns {Promise<{before: object, after: object, last: object}>} the cameras, and the last message that moved them
   */
  async gesture(act, { type, count = 1 }) {
    const { wire } = this;
    const { camera: before } = await wire.still();
    const mark = wire.sent.length;
    await act();
    const last = await wire.until(`${count} ${type}`, () => {
      const sent = wire.sent.slice(mark);
      const ended = sent.filter((message) => message.type === type).length >= count;
      return ended && sent.filter((message) => message.type === 'pointermove' || message.type === 'wheel').at(-1);
    });
    const { frame, camera: after } = await wire.still(last.id);
    await this.shows(frame);
    return { before, after, last };
  }

  /**
   * Moves fingers that come down one after the other and leave together.
   *
   * @param {{from: number[], to: number[]}[]} fingers
   */
  touch(fingers) {
    return this.gesture(() => this.stroke(fingers), { type: 'pointerup', count: fingers.length });
  }

  /** The same anywhere on the page, whatever comes of it. */
  async stroke(fingers) {
    const points = (part) =>
      fingers.map(({ from, to }, id) => ({ id, x: from[0] + part * (to[0] - from[0]), y: from[1] + part * (to[1] - from[1]) }));
    for (let down = 1; down <= fingers.length; down += 1) await this.finger('touchStart', points(0).slice(0, down));
    for (const part of [0.25, 0.5, 0.75, 1]) await this.finger('touchMove', points(part));
    await this.finger('touchEnd', []);
  }

  /** @param {'touchStart'|'touchMove'|'touchEnd'} type */
  finger(type, touchPoints) {
    return this.devtools.send('Input.dispatchTouchEvent', { type, touchPoints });
  }

  /**
   * Drags with the mouse.
   *
   * @param {'left'|'right'|'middle'} button
   */
  mouse(button, { from, to }) {
    const { mouse } = this.page;
    return this.gesture(async () => {
      await mouse.move(...from);
      await mouse.down({ button });
      await mouse.move(...to, { steps: 4 });
      await mouse.up({ button });
    }, { type: 'pointerup' });
  }

  /** Turns the wheel, over the middle of the page if nothing else is said. */
  wheel(deltaY, place) {
    const { mouse } = this.page;
    const { width, height } = this.page.viewportSize();
    return this.gesture(async () => {
      await mouse.move(...(place ?? [width / 2, height / 2]));
      await mouse.wheel(0, deltaY);
    }, { type: 'wheel' });
  }

  /** Opens the settings with a section of them unfolded, and gives that. */
  async settings(name) {
    const { page } = this;
    if (!(await page.locator('#menu.open').count())) await page.locator('#menu-button').tap();
    if (!(await page.locator('dialog').count())) await page.locator('#menu > button').tap();
    const section = page.locator(`dialog [data-section="${name}"]`);
    await section.waitFor();
    if (!(await section.evaluate((details) => details.open))) await section.locator('summary').tap();
    return section;
  }

  async closeSettings() {
    await this.page.keyboard.press('Escape');
    await this.page.locator('dialog').waitFor({ state: 'detached' });
  }

  /** What lies at a place of the view, as another client hears it. */
  async pick(place) {
    return (await this.picks([place]))[0];
  }

  /** The same of several places. */
  picks(places) {
    return new Promise((resolve, reject) => {
      const client = new WebSocket(`ws://${new URL(this.page.url()).host}/ws`, 'vrut-preview.v1');
      const picked = [];
      client.on('open', () => {
        client.send(JSON.stringify({ type: 'hello', role: 'view' }));
        for (const [i, [x, y]] of places.entries()) client.send(JSON.stringify({ type: 'pick', id: i + 1, x, y }));
      });
      client.on('message', (data, isBinary) => {
        const message = isBinary ? {} : JSON.parse(data);
        if (message.type === 'error') reject(new Error(message.message));
        if (message.type === 'picked') picked.push(message);
        if (message.type === 'error' || picked.length === places.length) client.close();
        if (picked.length === places.length) resolve(picked);
      });
      client.on('error', reject);
    });
  }

  /** Sends a message on the page's own connection, behind its back. */
  say(message) {
    return this.page.evaluate((text) => window.sockets.at(-1).send(text), JSON.stringify(message));
  }

  /** Waits until the page has received a revision, or a later one, and shown what it has of it beside the picture. */
  async follows(revision = this.wire.revision) {
    await this.page.waitForFunction((number) => window.revision >= number, revision);
    await this.page.evaluate(() => new Promise((resolve) => { requestAnimationFrame(() => requestAnimationFrame(resolve)); }));
  }

  /** Waits until the canvas shows a frame, or a later one. */
  shows(frame) {
    return this.page.waitForFunction((number) => Number(document.querySelector('#view').dataset.frame) >= number, frame);
  }

  /**
   * Waits for a still picture.
   *
   * @param {number} [revision] that it shows at least
   * @returns {Promise<number[]>} what it looks like from far away: 24 × 16 mean colours
   */
  async glance(revision = 0) {
    const wanted = this.#wantsPictures;
    if (!wanted) await this.pictures(true);
    const { frame } = await this.wire.stillOf(revision);
    await this.shows(frame);
    if (!wanted) await this.pictures(false);
    return this.page.evaluate(() => {
      const context = new OffscreenCanvas(24, 16).getContext('2d', { willReadFrequently: true });
      context.imageSmoothingQuality = 'high';
      context.drawImage(document.querySelector('#view'), 0, 0, 24, 16);
      return [...context.getImageData(0, 0, 24, 16).data];
    });
  }

  /** Without pictures the server draws none, and tests that look at none are so much faster. A glance has one. */
  pictures(wanted) {
    this.#wantsPictures = wanted;
    return this.page.evaluate((wants) => {
      const kept = window.keptGrants ?? [];
      window.keptGrants = wants ? null : kept;
      if (wants) for (const text of kept) window.sockets.at(-1).send(text);
    }, wanted);
  }

  /** What a script sees of the page. */
  look() {
    return this.page.evaluate(() => {
      const canvas = document.querySelector('#view');
      return {
        frame: Number(canvas.dataset.frame),
        level: canvas.dataset.level,
        revision: Number(canvas.dataset.revision),
        width: canvas.width,
        height: canvas.height,
        stale: canvas.classList.contains('stale'),
        lines: document.querySelector('#lines').textContent,
      };
    });
  }

  /**
   * Compares what the canvas shows with a PNG file of the same size.
   *
   * @param {Buffer} png
   * @returns {Promise<{frame: number, psnr: number, drawn: number}>} which frame it was, the peak signal to noise
   *   ratio in dB, and the share of pixels that differ from the first
   */
  compare(png) {
    return this.page.evaluate(async (base64) => {
      const canvas = document.querySelector('#view');
      const { width, height } = canvas;
      const frame = Number(canvas.dataset.frame);
      const copy = new OffscreenCanvas(width, height).getContext('2d');
      copy.drawImage(canvas, 0, 0);
      const shown = copy.getImageData(0, 0, width, height).data;

      const file = Uint8Array.from(atob(base64), (character) => character.charCodeAt(0));
      const bitmap = await createImageBitmap(new Blob([file], { type: 'image/png' }));
      if (bitmap.width !== width || bitmap.height !== height) return { frame, psnr: 0, drawn: 0 };
      const context = new OffscreenCanvas(width, height).getContext('2d');
      context.drawImage(bitmap, 0, 0);
      const made = context.getImageData(0, 0, width, height).data;

      let squares = 0;
      let drawn = 0;
      for (let i = 0; i < made.length; i += 4) {
        let differs = false;
        for (let channel = 0; channel < 3; channel += 1) {
          squares += (shown[i + channel] - made[i + channel]) ** 2;
          differs ||= Math.abs(shown[i + channel] - shown[channel]) > 8;
        }
        if (differs) drawn += 1;
      }
      const mean = squares / (width * height * 3);
      return { frame, psnr: 10 * Math.log10(255 ** 2 / mean), drawn: drawn / (width * height) };
    }, png.toString('base64'));
  }

  /**
   * Keeps a picture of the page where the environment names a folder for them.
   *
   * @param {string} name
   * @param {number} [revision] that the picture in it shows, where the page wants none otherwise
   */
  async screenshot(name, revision) {
    const folder = process.env.VRUT_SCREENSHOTS;
    if (!folder) return;
    if (revision !== undefined) await this.glance(revision);
    await this.page.screenshot({ path: path.join(folder, `${name}.png`) });
  }
}
