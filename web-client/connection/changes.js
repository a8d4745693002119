import { mergePatch } from '../base/merge-patch.js';

/**
 * Sends changes of the state, one at a time: while one is on its way, those that follow become one. A slider
 * under a finger so never gets ahead of the server.
 */
export class Changes {
  #ask;
  #refused;
  /** @type {?object} */
  #next = null;
  /** @type {?Promise<void>} */
  #sending = null;

  /** `ask` sends a message and promises its answer; `refused` is told the error where there is none. */
  constructor({ ask, refused }) {
    this.#ask = ask;
    this.#refused = refused;
  }

  /** Promises that all that was added is answered; what was refused has been told. */
  add(patch) {
    this.#next = mergePatch(this.#next, patch, true);
    this.#sending ??= this.#send();
    return this.#sending;
  }

  async #send() {
    while (this.#next) {
      const patch = this.#next;
      this.#next = null;
      await this.#ask({ type: 'patch', patch }).catch(this.#refused);
    }
    this.#sending = null;
  }
}
