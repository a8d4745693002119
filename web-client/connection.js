import { frameHeader } from './frame-header.js';
import { mergePatch } from './merge-patch.js';

const SUBPROTOCOL = 'vrut-preview.v1';
const POLICY_VIOLATION = 1008;
const MOST_GRANTS = 2;

const FIRST_RETRY_MS = 250;
const LAST_RETRY_MS = 4000;
const WELCOME_WITHIN_MS = 8000;
const ANSWER_WITHIN_MS = 4000;

/** What the connection needs of the browser; tests bring their own. */
const browser = {
  openSocket: (url, protocol) => new WebSocket(url, protocol),
  setTimeout: (action, ms) => setTimeout(action, ms),
  clearTimeout: (timer) => clearTimeout(timer),
  random: () => Math.random(),
};

/**
 * @typedef {object} Phase where the connection stands
 * @property {'connecting'|'open'|'waiting'|'refused'} name
 * @property {number} [retryMs] waiting: when the next attempt begins
 * @property {boolean} [hadOpened] waiting: an open connection was lost just now
 * @property {string} [reason] waiting, refused: why the server would not have this page, in its own words
 *
 * @typedef {object} Frame
 * @property {?object} header null where it could not be read
 * @property {ArrayBuffer} data the whole file
 *
 * @typedef {object} Listeners
 * @property {(phase: Phase) => void} phase
 * @property {(frame: Frame) => Promise<void>} frame settles when the frame is drawn or dropped
 * @property {(state: object) => void} state the state document has changed
 * @property {(error: {code: string, message: string, id?: number}) => void} error
 * @property {(message: object) => void} message every other kind of message
 */

/**
 * The page's end of the wire: connects, says hello, keeps the state document, grants frames, and begins anew
 * when the connection is lost.
 */
export class Connection {
  #url;
  #hello;
  #on;
  #browser;

  #socket = null;
  #phase = 'waiting';
  #welcome = null;
  #state = null;
  #revision = 0;
  #size = null;
  #lastId = 0;
  #claimId = 0;
  #retries = 0;
  #refusal = '';
  /** The next attempt while waiting; else the limit for an answer that is due. */
  #timer = undefined;

  /**
   * @param {object} options
   * @param {string} options.url
   * @param {{role: string, name?: string, token?: string}} options.hello
   * @param {Listeners} options.on
   * @param {typeof browser} [options.environment]
   */
  constructor({ url, hello, on, environment = browser }) {
    this.#url = url;
    this.#hello = hello;
    this.#on = on;
    this.#browser = environment;
  }

  /** The role that the server gave; undefined while not connected. */
  get role() {
    return this.#welcome?.role;
  }

  /** The state document as last heard, kept over a lost connection; null before the first. */
  get state() {
    return this.#state;
  }

  get revision() {
    return this.#revision;
  }

  /** Connects, and from then on stays connected as well as can be. */
  start() {
    this.#connect();
  }

  /**
   * The page is seen again, or the network is back: tries at once instead of waiting, and makes sure that a
   * connection that looks open still is (a tablet's sleep leaves dead ones behind).
   */
  wake() {
    if (this.#phase === 'waiting' || this.#phase === 'refused') {
      this.#connect();
    } else if (this.#phase === 'open' && this.#size) {
      this.send({ type: 'resize', ...this.#size });
      this.#setTimer(ANSWER_WITHIN_MS, () => this.#abandon());
    }
  }

  /**
   * The size that this page wants, now and after every reconnect.
   *
   * @param {{width: number, height: number, pixelRatio: number}} size
   */
  resize(size) {
    this.#size = size;
    this.send({ type: 'resize', ...size });
  }

  /**
   * Sends a message with the next id; without an open connection it is dropped, since what a finger did
   * then is of no use later.
   *
   * @param {object} message
   * @returns {number} its id; 0 when dropped
   */
  send(message) {
    if (this.#phase !== 'open') return 0;
    this.#lastId += 1;
    this.#post({ ...message, id: this.#lastId });
    return this.#lastId;
  }

  #post(message) {
    this.#socket.send(JSON.stringify(message));
  }

  #connect() {
    this.#setPhase({ name: 'connecting' });
    this.#refusal = '';
    const socket = this.#browser.openSocket(this.#url, SUBPROTOCOL);
    this.#socket = socket;
    socket.binaryType = 'arraybuffer';
    socket.onopen = () => this.#post({ type: 'hello', ...this.#hello });
    socket.onmessage = ({ data }) => {
      if (typeof data === 'string') this.#receive(data);
      else this.#receiveFrame(socket, data);
    };
    socket.onclose = ({ code, reason }) => this.#lost(code, reason);
    this.#setTimer(WELCOME_WITHIN_MS, () => this.#abandon());
  }

  /** Gives a silent connection up without waiting for a close that may never come. */
  #abandon() {
    const socket = this.#socket;
    this.#lost();
    socket.close();
  }

  #lost(code, reason) {
    Object.assign(this.#socket, { onopen: null, onmessage: null, onclose: null });
    this.#socket = null;
    this.#clearTimer();
    const hadOpened = this.#phase === 'open';
    this.#welcome = null;

    if (code === POLICY_VIOLATION) {
      this.#setPhase({ name: 'refused', reason: this.#refusal || reason });
      return;
    }
    const longest = Math.min(LAST_RETRY_MS, FIRST_RETRY_MS * 2 ** this.#retries);
    this.#retries += 1;
    // Spread, so that the pages of a room do not all come back in the same instant.
    const retryMs = longest * (0.5 + 0.5 * this.#browser.random());
    this.#setTimer(retryMs, () => this.#connect());
    this.#setPhase({ name: 'waiting', retryMs, hadOpened, reason: this.#refusal });
  }

  #receive(text) {
    if (this.#phase === 'open') this.#clearTimer();
    const message = parse(text);
    switch (message?.type) {
      case 'welcome':
        this.#welcome = message;
        break;
      case 'state':
        this.#state = message.state;
        this.#revision = message.revision;
        if (this.#phase !== 'open') this.#begin();
        this.#on.state(this.#state);
        break;
      case 'patch':
        this.#state = mergePatch(this.#state, message.patch);
        this.#revision = message.revision;
        this.#on.state(this.#state);
        break;
      case 'error':
        if (this.#phase !== 'open') this.#refusal = message.message;
        else if (!message.id || message.id !== this.#claimId) this.#on.error(message);
        break;
      case undefined:
        break;
      default:
        this.#on.message(message);
    }
  }

  /** The hello is answered in full: asks for the first pictures. */
  #begin() {
    this.#clearTimer();
    this.#setPhase({ name: 'open' });
    if (this.#size) this.send({ type: 'resize', ...this.#size });
    // The view has the size that its holder wants. Where nobody holds control, a change of nothing is
    // enough to become the holder, and the first picture has this page's size. It is taken from nobody.
    if (this.role === 'control' && !this.#state.control?.holder) {
      this.#claimId = this.send({ type: 'patch', patch: {} });
    }
    const grants = Math.min(MOST_GRANTS, this.#welcome?.limits?.maxGrants ?? MOST_GRANTS);
    for (let i = 0; i < grants; i += 1) this.#post({ type: 'frame' });
  }

  /** A frame's grant is given back when it is drawn, so that a slow page is sent no more than it can show. */
  async #receiveFrame(socket, data) {
    this.#clearTimer();
    this.#retries = 0;
    try {
      await this.#on.frame({ header: frameHeader(data), data });
    } finally {
      if (socket === this.#socket) this.#post({ type: 'frame' });
    }
  }

  #setPhase(phase) {
    this.#phase = phase.name;
    this.#on.phase(phase);
  }

  #setTimer(ms, action) {
    this.#clearTimer();
    this.#timer = this.#browser.setTimeout(action, ms);
  }

  #clearTimer() {
    this.#browser.clearTimeout(this.#timer);
    this.#timer = undefined;
  }
}

/**
 * The address of the server's WebSocket, beside the page's own.
 *
 * @param {string} page
 * @returns {string}
 */
export function socketAddress(page) {
  const address = new URL('ws', page);
  address.protocol = address.protocol === 'https:' ? 'wss:' : 'ws:';
  address.hash = '';
  return address.href;
}

/**
 * The token in the page's address (`#token=…`), which browsers keep to themselves.
 *
 * @param {string} hash
 * @returns {string|undefined}
 */
export function tokenFrom(hash) {
  const token = /[#&]token=([^&]*)/.exec(hash)?.[1];
  if (!token) return undefined;
  try {
    return decodeURIComponent(token);
  } catch {
    return token;
  }
}

function parse(text) {
  try {
    return JSON.parse(text);
  } catch {
    return null;
  }
}
