import { once } from 'node:events';
import WebSocket from 'ws';
import { socketAddress } from '../../../web-client/connection/connection.js';
import { mergePatch } from '../../../web-client/base/merge-patch.js';

/** Somebody else at the server, who wants no pictures. */
export class Colleague {
  state = null;
  id;
  #socket;
  #lastId = 0;
  #asked = new Map();

  /**
   * @param {string} address of the page
   * @param {{role?: string, name?: string}} [hello]
   */
  static async join(address, hello = {}) {
    const colleague = new Colleague();
    const socket = new WebSocket(socketAddress(address), 'vrut-preview.v1');
    colleague.#socket = socket;
    await once(socket, 'open');
    const joined = new Promise((resolve) => {
      socket.on('message', (data, isBinary) => {
        if (isBinary) return;
        colleague.#receive(JSON.parse(data));
        if (colleague.state) resolve();
      });
    });
    socket.send(JSON.stringify({ type: 'hello', role: 'control', ...hello }));
    await joined;
    return colleague;
  }

  /** @returns {Promise<object>} the answer, which may be an error */
  ask(message) {
    this.#lastId += 1;
    const id = this.#lastId;
    this.#socket.send(JSON.stringify({ ...message, id }));
    return new Promise((resolve) => {
      this.#asked.set(id, resolve);
    });
  }

  /**
   * Takes control, changes the state, and gives control back.
   *
   * @returns {Promise<number>} the revision of the change
   */
  async patch(patch) {
    await this.ask({ type: 'control', action: 'take' });
    const { type, message, revision } = await this.ask({ type: 'patch', patch });
    await this.ask({ type: 'control', action: 'release' });
    if (type === 'error') throw new Error(message);
    return revision;
  }

  async leave() {
    this.#socket.close();
    await once(this.#socket, 'close');
  }

  #receive(message) {
    if (message.type === 'welcome') this.id = message.client;
    if (message.type === 'state') this.state = message.state;
    if (message.type === 'patch') this.state = mergePatch(this.state, message.patch);
    this.#asked.get(message.id)?.(message);
    this.#asked.delete(message.id);
  }
}
