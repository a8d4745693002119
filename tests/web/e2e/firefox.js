import { spawn } from 'node:child_process';
import { existsSync } from 'node:fs';
import { mkdtemp, rm } from 'node:fs/promises';
import { once } from 'node:events';
import { tmpdir } from 'node:os';
import path from 'node:path';
import WebSocket from 'ws';

const FIREFOX = '/usr/bin/firefox-esr';
const READY_WITHIN_MS = 60_000;
const TRUE_WITHIN_MS = 30_000;

export const firefoxIsMissing = existsSync(FIREFOX) ? false : `there is no ${FIREFOX}`;

/** Firefox with one page, steered by WebDriver BiDi (https://www.w3.org/TR/webdriver-bidi/). */
export class Firefox {
  /** What the pages wrote into the log as warnings and errors. */
  complaints = [];
  #child;
  #profile;
  #socket;
  #context;
  #lastId = 0;
  #waiting = new Map();

  static async launch() {
    const firefox = new Firefox();
    await firefox.#launch();
    return firefox;
  }

  async #launch() {
    this.#profile = await mkdtemp(path.join(tmpdir(), 'vrut-preview-firefox-'));
    this.#child = spawn(FIREFOX, ['--headless', '--no-remote', '--profile', this.#profile, '--remote-debugging-port', '0', 'about:blank'], {
      stdio: ['ignore', 'ignore', 'pipe'],
      env: { ...process.env, HOME: this.#profile },
    });
    this.#socket = new WebSocket(`${await this.#address()}/session`);
    await once(this.#socket, 'open');
    this.#socket.on('message', (text) => this.#receive(JSON.parse(text)));
    await this.#ask('session.new', { capabilities: {} });
    await this.#ask('session.subscribe', { events: ['log.entryAdded'] });
    const { contexts } = await this.#ask('browsingContext.getTree', {});
    this.#context = contexts[0].context;
    // The help, which opens by itself on a first visit, has been seen.
    const functionDeclaration = "() => { try { localStorage.setItem('vrut-preview.help', 'seen'); } catch {} }";
    await this.#ask('script.addPreloadScript', { functionDeclaration });
  }

  #address() {
    return new Promise((resolve, reject) => {
      let said = '';
      const limit = setTimeout(() => reject(new Error(`Firefox was not ready in time.\n${said}`)), READY_WITHIN_MS);
      this.#child.once('error', reject);
      this.#child.once('exit', (status) => reject(new Error(`Firefox ended (${status}).\n${said}`)));
      this.#child.stderr.setEncoding('utf8').on('data', (text) => {
        said += text;
        const address = /WebDriver BiDi listening on (ws:\S+)/.exec(said)?.[1];
        if (!address) return;
        clearTimeout(limit);
        resolve(address);
      });
    });
  }

  /** @param {{width: number, height: number, pixelRatio: number}} size */
  async open(url, { width, height, pixelRatio }) {
    const context = this.#context;
    await this.#ask('browsingContext.setViewport', { context, viewport: { width, height }, devicePixelRatio: pixelRatio });
    await this.#ask('browsingContext.navigate', { context, url, wait: 'complete' });
  }

  /** @param {string} expression @returns {Promise<*>} its value, as JSON */
  async evaluate(expression) {
    const { result, exceptionDetails } = await this.#ask('script.evaluate', {
      expression: `Promise.resolve(${expression}).then((value) => JSON.stringify(value ?? null))`,
      target: { context: this.#context },
      awaitPromise: true,
    });
    if (exceptionDetails) throw new Error(`${expression}: ${exceptionDetails.text}`);
    return JSON.parse(result.value);
  }

  /** Waits until an expression is true in the page. @returns {Promise<*>} its value */
  async until(expression) {
    for (const limit = Date.now() + TRUE_WITHIN_MS; Date.now() < limit;) {
      const value = await this.evaluate(expression);
      if (value) return value;
      await new Promise((resolve) => setTimeout(resolve, 50));
    }
    throw new Error(`Waited in vain for ${expression}`);
  }

  /** Presses at the first of some points, moves through the others, lets go. */
  point([[x, y], ...others], pointerType = 'mouse') {
    return this.#ask('input.performActions', {
      context: this.#context,
      actions: [{
        type: 'pointer',
        id: pointerType,
        parameters: { pointerType },
        actions: [
          { type: 'pointerMove', x, y },
          { type: 'pointerDown', button: 0 },
          ...others.map(([left, top]) => ({ type: 'pointerMove', x: left, y: top, duration: 50 })),
          { type: 'pointerUp', button: 0 },
        ],
      }],
    });
  }

  /** Presses the middle of an element. */
  async press(selector) {
    const middle = await this.evaluate(`(() => {
      const element = document.querySelector(${JSON.stringify(selector)});
      element.scrollIntoView({ block: 'center' });
      const { x, y, width, height } = element.getBoundingClientRect();
      return [Math.round(x + width / 2), Math.round(y + height / 2)];
    })()`);
    await this.point([middle], 'touch');
  }

  async close() {
    if (this.#child.exitCode === null) {
      const ended = once(this.#child, 'exit');
      this.#child.kill('SIGKILL');
      await ended;
    }
    await rm(this.#profile, { recursive: true, force: true, maxRetries: 5 });
  }

  #ask(method, params) {
    this.#lastId += 1;
    this.#socket.send(JSON.stringify({ id: this.#lastId, method, params }));
    return new Promise((resolve, reject) => this.#waiting.set(this.#lastId, { resolve, reject }));
  }

  #receive({ id, method, params, result, error, message }) {
    if (method === 'log.entryAdded' && params.level !== 'info' && params.level !== 'debug') this.complaints.push(params.text);
    const waiting = this.#waiting.get(id);
    this.#waiting.delete(id);
    if (error) waiting?.reject(new Error(`${error}: ${message}`));
    else waiting?.resolve(result);
  }
}
