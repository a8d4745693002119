// A client written from the contract. It holds every connection to what the contract says of all messages: answers
// come once, patches before them, revisions, frames and `handled` only rise, and all is valid by the JSON Schema.
import assert from 'node:assert/strict';
import { once } from 'node:events';
import { isDeepStrictEqual } from 'node:util';
import WebSocket from 'ws';
import { readFrame } from './frame-file.js';

export const SUBPROTOCOL = 'vrut-preview.v1';
const WITHIN_MS = 5000;
const SILENT_UNLESS_WRONG = /^(pointer(down|move|up|cancel)|wheel|key(down|up)|point|frame)$/;
const ANSWERED_BY = { hello: 'welcome', pick: 'picked', tree: 'tree', scenes: 'scenes', share: 'shared', check: 'checked' };

/** RFC 7396. */
export function mergePatch(target, patch) {
  if (patch === null || typeof patch !== 'object' || Array.isArray(patch)) return patch;
  const merged = target !== null && typeof target === 'object' && !Array.isArray(target) ? { ...target } : {};
  for (const [member, value] of Object.entries(patch)) {
    if (value === null) delete merged[member];
    else merged[member] = mergePatch(merged[member], value);
  }
  return merged;
}

export class ServerError extends Error {
  constructor(request, { code, message }) {
    super(`${JSON.stringify(request).slice(0, 300)}: ${code}: ${message}`);
    this.code = code;
    this.sentence = message;
  }
}

export class ContractClient {
  /** Text messages in the order in which they came. */
  texts = [];
  /** Frames in the order in which they came: {format, header, width, height, subsampling, bytes, at}. */
  frames = [];
  state = null;
  revision = 0;
  welcome = null;
  /** {code, reason} once the connection has ended. */
  closed = null;
  #requests = new Map();
  #lastId = 0;
  #lastFrame = { shared: -1, snapshot: -1 };
  #handled = 0;
  #latestFrameRevision = 0;
  #faults = [];
  #checks = new Set();

  /** A connection before `hello`. Rejects with {status} where the server refuses to upgrade. */
  static async connect(server, protocols = [SUBPROTOCOL], options = {}) {
    const client = new ContractClient();
    client.server = server;
    client.socket = new WebSocket(server.ws, protocols, { perMessageDeflate: false, ...options });
    client.socket.on('message', (data, binary) => client.#receive(data, binary));
    client.socket.on('close', (code, reason) => {
      client.closed = { code, reason: reason.toString() };
      client.#look();
    });
    await new Promise((resolve, reject) => {
      client.socket.once('open', resolve);
      client.socket.once('unexpected-response', (_, response) => {
        response.destroy();
        reject(Object.assign(new Error(`HTTP ${response.statusCode}`), { status: response.statusCode }));
      });
      client.socket.once('error', reject);
    });
    client.socket.on('error', () => {});
    return client;
  }

  /** A client that has said `hello` and got `welcome` and `state`; it leaves, and is judged, when test `t` ends. */
  static async join(t, server, { role = 'control', ...hello } = {}) {
    const client = await ContractClient.connect(server);
    t.after(() => client.leave());
    client.send({ type: 'hello', role, ...hello }, { id: null });
    await client.until('state', () => client.state);
    return client;
  }

  get id() {
    return this.welcome?.client;
  }

  get isHolder() {
    return this.state.control.holder === this.id;
  }

  /** @param {{id?: null}} [options] `id: null` sends none @returns {number | undefined} the id it was sent with */
  send(message, options = {}) {
    const sent = options.id === null ? message : { ...message, id: ++this.#lastId };
    const complaint = this.server.schema.complaint('clientMessage', sent);
    if (complaint) this.#faults.push(`sent: ${complaint}`);
    return this.#send(sent);
  }

  /** Sends what the contract forbids, so unchecked. */
  sendBad(message) {
    return this.#send({ ...message, id: message.id ?? ++this.#lastId });
  }

  #send(message) {
    if (Number.isSafeInteger(message.id)) this.#requests.set(message.id, { message, answers: 0 });
    this.socket.send(JSON.stringify(message));
    return message.id;
  }

  /** Sends bytes as they are; what they say is `message`, which has an id. */
  sendRaw(message, ...pieces) {
    this.#requests.set(message.id, { message, answers: 0 });
    pieces.forEach((piece, i) => this.socket.send(piece, { binary: false, fin: i === pieces.length - 1 }));
    return message.id;
  }

  /** Sends a message and waits for its answer; a frame for `snapshot`. @throws {ServerError} for `error` */
  async ask(message) {
    return this.answer(this.send(message));
  }

  async answer(id) {
    const request = this.#requests.get(id);
    const what = `the answer to ${JSON.stringify(request.message).slice(0, 300)}`;
    const answer = await this.until(what, () => request.answer);
    if (answer.type === 'error') throw new ServerError(request.message, answer);
    return answer;
  }

  /** Expects `error` with `code` (or one of several), and nothing changed. @returns the error */
  async refused(message, code, { valid = false } = {}) {
    const before = this.texts.length;
    const id = valid ? this.send(message) : this.sendBad(message);
    const request = this.#requests.get(id);
    const what = `the refusal of ${JSON.stringify(message).slice(0, 300)}`;
    const error = await this.until(what, () => request.answer);
    assert.equal(error.type, 'error', `${what}: got ${JSON.stringify(error).slice(0, 300)}`);
    assert.ok([code].flat().includes(error.code), `${what}: ${error.code}, not ${code}: ${error.message}`);
    const mine = this.texts.slice(before).filter((text) => text.type === 'patch' && text.by === this.id);
    assert.deepEqual(mine, [], `${what} changed the state`);
    return error;
  }

  patch(patch, more = {}) {
    return this.ask({ type: 'patch', patch, ...more });
  }

  /** Everything sent before has been handled, and what it caused has come. */
  barrier() {
    return this.ask({ type: 'pick', x: 0, y: 0 });
  }

  /** The newest shared frame whose header satisfies `accept`, granting more as they come. */
  async frame(accept = () => true, what = 'a frame') {
    let seen = this.frames.length;
    this.send({ type: 'frame' });
    return this.until(what, () => {
      for (; seen < this.frames.length; ++seen) {
        if (this.frames[seen].header.snapshot !== undefined) continue;
        if (accept(this.frames[seen].header)) return this.frames[seen];
        this.send({ type: 'frame' });
      }
      return null;
    });
  }

  /** A frame that shows the present camera, in the present view where `view` is given. */
  async frameOfNow(view = {}) {
    const isNow = (header) =>
      ['eye', 'focus', 'up', 'center', 'fov'].every((m) => isDeepStrictEqual(header.camera[m], this.state.camera[m])) &&
      Object.entries(view).every(([member, value]) => header.view[member] === value);
    const newest = this.frames.filter((f) => f.header.snapshot === undefined).at(-1);
    if (newest && isNow(newest.header)) return newest;
    return this.frame(isNow, 'a frame of the present camera');
  }

  texted(type, accept = () => true) {
    return this.until(type, () => this.texts.find((text) => text.type === type && accept(text)));
  }

  /** Waits until `get` is true of what has come. @returns its first true result */
  async until(what, get, within = WITHIN_MS) {
    const result = await new Promise((resolve, reject) => {
      const finish = (settle, value) => {
        clearTimeout(limit);
        this.#checks.delete(check);
        settle(value);
      };
      const check = () => {
        let value;
        try {
          value = get();
        } catch (error) {
          return finish(reject, error);
        }
        if (value) return finish(resolve, value);
        if (this.closed) finish(reject, new Error(this.#tale(`The connection ended (${this.closed.code}) before: ${what}`)));
        return undefined;
      };
      const limit = setTimeout(() => finish(reject, new Error(this.#tale(`Not within ${within} ms: ${what}`))), within);
      this.#checks.add(check);
      check();
    });
    this.#judge();
    return result;
  }

  /** Waits for the end of the connection. @returns {Promise<{code: number, error?: object}>} with the last `error` */
  async ended(within = WITHIN_MS) {
    await this.until('the end of the connection', () => this.closed, within);
    return { code: this.closed.code, error: this.texts.at(-1)?.type === 'error' ? this.texts.at(-1) : undefined };
  }

  async leave() {
    if (!this.closed) {
      this.socket.close();
      const limit = setTimeout(() => this.socket.terminate(), 2000);
      await once(this.socket, 'close');
      clearTimeout(limit);
    }
    this.#judge();
  }

  #tale(why) {
    const last = this.texts.slice(-6).map((text) => JSON.stringify(text).slice(0, 300));
    return [why, ...this.#faults, `${this.frames.length} frames; the last messages:`, ...last].join('\n  ');
  }

  #judge() {
    if (this.#faults.length === 0) return;
    const faults = this.#faults.splice(0);
    assert.fail(`against the contract:\n  ${faults.join('\n  ')}`);
  }

  #fault(unless, why) {
    if (!unless) this.#faults.push(why);
  }

  #look() {
    for (const check of [...this.#checks]) check();
  }

  #receive(data, binary) {
    try {
      if (binary) this.#receiveFrame(data);
      else this.#receiveText(JSON.parse(data.toString()));
    } catch (error) {
      this.#faults.push(error.stack);
    }
    this.#look();
  }

  #receiveText(text) {
    this.texts.push(text);
    const complaint = this.server.schema.complaint('serverMessage', text);
    this.#fault(!complaint, `received: ${complaint}`);
    if (text.type === 'welcome') this.welcome = text;
    if (text.type === 'state') this.#receiveState(text);
    if (text.type === 'patch') this.#receivePatch(text);
    if (text.type === 'error') this.#fault(text.message.length <= 300, `longer than 300 characters: ${text.message}`);
    if (text.id !== undefined && text.type !== 'flown') this.#receiveAnswer(text);
    if (text.type === 'ok') {
      this.#fault(Number.isSafeInteger(text.revision), `ok without revision: ${JSON.stringify(text)}`);
      this.#fault(this.revision >= text.revision, `ok of revision ${text.revision} came before its patch`);
    }
  }

  #receiveState(text) {
    this.#fault(this.welcome, 'state before welcome');
    this.#fault(text.revision >= this.revision, `the revision fell from ${this.revision} to ${text.revision}`);
    this.state = text.state;
    this.revision = text.revision;
    this.#checkState();
  }

  #receivePatch(text) {
    this.#fault(this.state, 'patch before state');
    this.#fault(text.revision > this.revision, `a patch's revision ${text.revision} does not rise above ${this.revision}`);
    const late = text.by === this.id && this.#latestFrameRevision >= text.revision;
    this.#fault(!late, `a frame of revision ${this.#latestFrameRevision} came before its own patch ${text.revision}`);
    this.state = mergePatch(this.state, text.patch);
    this.revision = text.revision;
    this.#checkState();
  }

  #checkState() {
    const complaint = this.server.schema.complaint('stateDocument', this.state);
    this.#fault(!complaint, complaint);
    this.#fault(!JSON.stringify(this.state).includes(':null'), 'there is null in the state');
  }

  #receiveAnswer(answer) {
    const request = this.#requests.get(answer.id);
    this.#fault(request, `an answer to what was not asked: ${JSON.stringify(answer)}`);
    if (!request) return;
    const { type } = request.message;
    const expected = ANSWERED_BY[type] ?? (type === 'snapshot' ? 'a frame' : 'ok');
    this.#fault(answer.type === 'error' || answer.type === expected, `${type} answered by ${JSON.stringify(answer)}`);
    this.#fault(answer.type === 'error' || !SILENT_UNLESS_WRONG.test(type), `${type} was right, yet answered`);
    this.#settle(request, answer);
  }

  #settle(request, answer) {
    request.answer = answer;
    this.#fault(++request.answers === 1, `a second answer: ${JSON.stringify(answer.header ?? answer).slice(0, 300)}`);
  }

  #receiveFrame(bytes) {
    const frame = { ...readFrame(bytes), bytes, at: Date.now() };
    const { header } = frame;
    this.frames.push(frame);
    const complaint = this.server.schema.complaint('frameHeader', header);
    this.#fault(!complaint, `received: ${complaint}`);
    const line = header.snapshot === undefined ? 'shared' : 'snapshot';
    this.#fault(header.frame > this.#lastFrame[line], `frame ${header.frame} after ${this.#lastFrame[line]}`);
    this.#fault(header.handled >= this.#handled, `handled fell from ${this.#handled} to ${header.handled}`);
    this.#fault(header.handled <= this.#lastId, `handled ${header.handled}, but ${this.#lastId} was the last id sent`);
    this.#lastFrame[line] = header.frame;
    this.#handled = header.handled;
    this.#latestFrameRevision = Math.max(this.#latestFrameRevision, header.revision);
    const request = this.#requests.get(header.snapshot);
    if (request) this.#settle(request, { type: 'a frame', ...frame });
    else this.#fault(header.snapshot === undefined, `a snapshot ${header.snapshot} that nobody asked for`);
  }
}
