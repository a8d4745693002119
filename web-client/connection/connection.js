import { frameHeader } from './frame-header.js';
import { mergePatch } from '../base/merge-patch.js';

/**
 * @import {
 *   ClientHello, ClientMessage, ClientResize, FrameHeader, ServerError, ServerMessage, ServerWelcome, StateDocument,
 * } from '../base/protocol.js'
 * @import { Phase } from '../base/store.js'
 *
 * @typedef {{header: ?FrameHeader, data: ArrayBuffer}} Frame
 */

const SUBPROTOCOL = 'vrut-preview.v1';
const POLICY_VIOLATION = 1008;
/** One frame is drawn while the next is on its way. */
const GRANTS = 2;

const FIRST_RETRY_MS = 250;
const LAST_RETRY_MS = 4000;
const WELCOME_WITHIN_MS = 8000;
const ANSWER_WITHIN_MS = 4000;
const ASKS_AFTER_MS = 5000;
const SILENT_AFTER_MS = 10_000;

/** Connects, says hello, keeps the state document, grants frames, and begins anew when the connection is lost. */
export class Connection {
  /** @type {?StateDocument} as last heard, kept over a lost connection; null before the first */
  state = null;
  revision = 0;
  /** @type {ClientHello['role']|undefined} what the server gave this page; undefined while not connected */
  role;
  /** @type {string|undefined} the same */
  client;
  /** @type {ServerWelcome['input']|undefined} what input does, kept over a lost connection */
  input;

  #url;
  #hello;
  #on;

  /** @type {?WebSocket} */
  #socket = null;
  #phase = 'waiting';
  /** @type {?Omit<ClientResize, 'type'>} */
  #size = null;
  #lastId = 0;
  /** @type {Map<number, {resolve: Function, reject: Function}>} how to settle what is not answered yet, by id */
  #asked = new Map();
  #retries = 0;
  /** @type {ServerError|undefined} that came before the welcome */
  #refusal;
  /** @type {{message: string}|undefined} why the last handshake was refused */
  #why;
  #opened = false;
  #timer;

  /**
   * `on` has a function for each `phase`, `frame` (promises that it is drawn or dropped), message `sent`,
   * changed `state`, `error` and other `message` that answers nothing that was asked.
   *
   * @param {{url: string, hello: () => Omit<ClientHello, 'type'>, on: {
   *   phase: (phase: Phase) => void,
   *   frame: (frame: Frame) => Promise<void>,
   *   sent?: (message: ClientMessage & {id: number}) => void,
   *   state: (state: StateDocument) => void,
   *   error: (error: ServerError) => void,
   *   message: (message: ServerMessage) => void,
   * }}} page
   */
  constructor({ url, hello, on }) {
    this.#url = url;
    this.#hello = hello;
    this.#on = on;
  }

  /** Whether this page holds control. */
  get steers() {
    return this.client !== undefined && this.state?.control?.holder === this.client;
  }

  start() {
    this.#setPhase({ name: 'connecting' });
    this.#refusal = undefined;
    const socket = new WebSocket(this.#url, SUBPROTOCOL);
    this.#socket = socket;
    socket.binaryType = 'arraybuffer';
    this.#opened = false;
    socket.onopen = () => {
      this.#opened = true;
      this.#why = undefined;
      this.#post({ type: 'hello', ...this.#hello() });
    };
    socket.onmessage = ({ data }) => {
      if (this.#phase === 'open') this.#listen();
      if (typeof data === 'string') this.#receive(parse(data));
      else this.#receiveFrame(socket, data);
    };
    socket.onclose = (event) => this.#lost(event);
    this.#giveUpAfter(WELCOME_WITHIN_MS);
  }

  /** Tries at once, or asks whether an open connection is alive: sleep leaves dead ones behind. */
  wake() {
    if (this.#phase === 'open') this.#probe(ANSWER_WITHIN_MS);
    else if (this.#phase !== 'connecting') this.start();
  }

  /** What this page wants, now and after every reconnect. @param {Omit<ClientResize, 'type'>} size */
  resize(size) {
    this.#size = size;
    this.send({ type: 'resize', ...size });
  }

  /** Sends a message and returns its id; 0 while not connected: what a finger does then is of no use later. */
  send(message) {
    if (this.#phase !== 'open') return 0;
    this.#lastId += 1;
    const sent = { ...message, id: this.#lastId };
    this.#post(sent);
    this.#on.sent?.(sent);
    return this.#lastId;
  }

  /**
   * Sends a message and promises its answer, of a `snapshot` the frame. An error of the server's has its `code`; the
   * code `not-sent` tells that there is no connection. One without a message or code: the answer got lost.
   */
  ask(message) {
    const id = this.send(message);
    return new Promise((resolve, reject) => {
      if (id) this.#asked.set(id, { resolve, reject });
      else reject(Object.assign(new Error(), { code: 'not-sent' }));
    });
  }

  #post(message) {
    this.#socket?.send(JSON.stringify(message));
  }

  /** A connection may die without a word: after a silence a question finds out. */
  #listen() {
    this.#setTimer(ASKS_AFTER_MS, () => this.#probe(SILENT_AFTER_MS));
  }

  #probe(withinMs) {
    this.send({ type: 'tree', depth: 0 });
    this.#giveUpAfter(withinMs);
  }

  #giveUpAfter(ms) {
    this.#setTimer(ms, () => this.#lost({}));
  }

  /** @param {{code?: number, reason?: string}} event */
  #lost({ code, reason }) {
    const socket = /** @type {WebSocket} */ (this.#socket);
    // The close of a silent connection may never come.
    socket.onclose = null;
    socket.close();
    this.#socket = null;
    clearTimeout(this.#timer);
    const hadOpened = this.#phase === 'open';
    this.role = undefined;
    this.client = undefined;
    for (const { reject } of this.#asked.values()) reject(new Error());
    this.#asked.clear();

    if (code === POLICY_VIOLATION) {
      this.#setPhase({ name: 'refused', reason: this.#refusal ?? (reason ? { message: reason } : undefined) });
      return;
    }
    const longest = Math.min(LAST_RETRY_MS, FIRST_RETRY_MS * 2 ** this.#retries);
    this.#retries += 1;
    // The pages of a room are not to come back all at once.
    const retryMs = longest * (0.5 + 0.5 * Math.random());
    this.#setTimer(retryMs, () => this.start());
    this.#setPhase({ name: 'waiting', retryMs, hadOpened, reason: this.#refusal ?? this.#why });
    if (!this.#opened) this.#learnWhy({ name: 'waiting', retryMs, hadOpened });
  }

  /** A browser does not tell why a handshake was refused; the answer to an ordinary request does. @param {Phase} phase */
  async #learnWhy(phase) {
    const answer = await fetch(`${this.#url.replace('ws', 'http')}?origin=${location.origin}`).catch(() => undefined);
    const message = answer && [403, 426].includes(answer.status) && (await answer.text()).trim();
    this.#why = message ? { message } : undefined;
    if (this.#phase === 'waiting') this.#setPhase({ ...phase, reason: this.#why });
  }

  #receive(message) {
    const isOpen = this.#phase === 'open';
    switch (message?.type) {
      case 'welcome':
        this.role = message.role;
        this.client = message.client;
        this.input = message.input;
        break;
      case 'state':
      case 'patch':
        this.state = message.state ?? mergePatch(this.state, message.patch);
        this.revision = message.revision;
        if (!isOpen) this.#begin();
        this.#on.state(/** @type {StateDocument} */ (this.state));
        break;
      case 'error':
        if (!isOpen) this.#refusal = message;
        else if (!this.#settle(message.id, message)) this.#on.error(message);
        break;
      case undefined: // no message at all
        break;
      default:
        if (!this.#settle(message.id, message)) this.#on.message(message);
    }
  }

  /** Whether somebody has waited for the answer. */
  #settle(id, answer) {
    const asked = this.#asked.get(id);
    if (answer.type === 'error') asked?.reject(Object.assign(new Error(answer.message), { code: answer.code }));
    else asked?.resolve(answer);
    return this.#asked.delete(id);
  }

  /** The hello is answered in full: asks for the first pictures. */
  #begin() {
    this.#listen();
    this.#setPhase({ name: 'open' });
    if (this.#size) this.send({ type: 'resize', ...this.#size });
    for (let i = 0; i < GRANTS; i += 1) this.#post({ type: 'frame' });
  }

  /** A frame's grant is given back once it is drawn: a slow page is sent no more than it can show. */
  async #receiveFrame(socket, data) {
    this.#retries = 0;
    const header = frameHeader(data);
    // What was asked for uses no grant, and is not for the view.
    if (header?.snapshot) {
      this.#settle(header.snapshot, { header, data });
      return;
    }
    try {
      await this.#on.frame({ header, data });
    } finally {
      if (socket === this.#socket) this.#post({ type: 'frame', shown: header?.frame });
    }
  }

  /** @param {Phase} phase */
  #setPhase(phase) {
    this.#phase = phase.name;
    this.#on.phase(phase);
  }

  #setTimer(ms, action) {
    clearTimeout(this.#timer);
    this.#timer = setTimeout(action, ms);
  }
}

export function socketAddress(page) {
  return new URL('ws', page).href.replace('http', 'ws');
}

/** @param {string} hash @returns {'view'|'control'} */
export function roleFrom(hash) {
  return settings(hash).has('watch') ? 'view' : 'control';
}

export function tokenFrom(hash) {
  return settings(hash).get('token') || undefined;
}

/** The page's settings are in the fragment of its address (`#watch&token=…`), which browsers keep to themselves. */
function settings(hash) {
  // A plus is no space.
  return new URLSearchParams(hash.slice(1).replaceAll('+', '%2B'));
}

function parse(text) {
  try {
    return JSON.parse(text);
  } catch {
    return null;
  }
}
