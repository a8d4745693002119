import { frameHeader } from '../../../web-client/connection/frame-header.js';
import { mergePatch } from '../../../web-client/base/merge-patch.js';

const LIMIT_MS = 30_000;
/** Samples of a picture at rest, after which none comes. */
const FINEST = 16;

/** Listens in on a page's WebSocket: all of this is about its latest connection. */
export class Wire {
  /** Messages that the page sent. */
  sent = [];
  /** Headers of the frames that it received. */
  frames = [];
  state = null;
  revision = 0;
  /** The server's errors. */
  errors = [];
  connections = 0;
  #listeners = new Set();

  /** @param {import('playwright-core').Page} page */
  constructor(page) {
    page.on('websocket', (socket) => this.#follow(socket));
  }

  /**
   * Waits until something is true of what has been heard.
   *
   * @template T
   * @param {string} what for the complaint when it never is
   * @param {() => T} get
   * @returns {Promise<T>} the first true result
   */
  until(what, get) {
    const now = get();
    if (now) return Promise.resolve(now);
    return new Promise((resolve, reject) => {
      const finish = (settle, value) => {
        clearTimeout(limit);
        this.#listeners.delete(check);
        settle(value);
      };
      const check = () => {
        const result = get();
        if (result) finish(resolve, result);
      };
      const limit = setTimeout(() => finish(reject, new Error(`Waited in vain for ${what}. ${this.#summary()}`)), LIMIT_MS);
      this.#listeners.add(check);
    });
  }

  /** Waits for a still frame that shows what the message of this id did. */
  still(id = 0) {
    return this.until(`a still frame that shows message ${id}`, () => {
      const last = this.frames.at(-1);
      return last?.quality.level === 'still' && last.handled >= id && last;
    });
  }

  /** Waits for a still frame of a revision, or a later one. */
  stillOf(revision) {
    return this.until(`a still frame of revision ${revision}`, () => {
      const last = this.frames.at(-1);
      return last?.quality.level === 'still' && last.revision >= revision && last;
    });
  }

  /** Waits for the picture after which none comes while nothing changes. */
  finest() {
    return this.until('the finest picture', () => {
      const last = this.frames.at(-1);
      return last?.quality.samples === FINEST && last;
    });
  }

  /** Waits until no frame has come for a while. */
  async quiet(ms) {
    const limit = Date.now() + LIMIT_MS;
    for (let before = -1; before !== this.frames.length; ) {
      if (Date.now() > limit) throw new Error(`Frames never ceased. ${this.#summary()}`);
      before = this.frames.length;
      await new Promise((resolve) => setTimeout(resolve, ms));
    }
  }

  #follow(socket) {
    this.sent = [];
    this.frames = [];
    this.state = null;
    this.revision = 0;
    this.errors = [];
    this.connections += 1;
    const { sent, frames } = this;
    socket.on('framesent', ({ payload }) => {
      sent.push(JSON.parse(payload));
      this.#heard();
    });
    socket.on('framereceived', ({ payload }) => {
      if (typeof payload === 'string') this.#receive(JSON.parse(payload));
      else frames.push(frameHeader(Uint8Array.from(payload).buffer));
      this.#heard();
    });
  }

  #receive(message) {
    if (message.type === 'state') this.state = message.state;
    if (message.type === 'patch') this.state = mergePatch(this.state, message.patch);
    if (message.type === 'state' || message.type === 'patch') this.revision = message.revision;
    if (message.type === 'error') this.errors.push(message);
  }

  #heard() {
    for (const listener of [...this.#listeners]) listener();
  }

  #summary() {
    const { frame, handled, quality, view } = this.frames.at(-1) ?? {};
    const last = JSON.stringify({ frame, handled, quality, view });
    return `Connections: ${this.connections}, sent: ${this.sent.length}, frames: ${this.frames.length}, the last ${last}.`;
  }
}
