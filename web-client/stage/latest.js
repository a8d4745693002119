/**
 * Asks one question at a time. Of those that come meanwhile the newest alone is asked: slots replace, they never queue.
 *
 * @template {object} Q
 * @template A
 */
export class Latest {
  /** The newest answer, and to what. @type {?{question: Q, answer: A}} */
  last = null;
  #ask;
  #answered;
  /** @type {?Q} */
  #newest = null;
  /** Whether that waits to be asked. */
  #waits = false;
  /** @type {?Promise<void>} */
  #asking = null;
  /** How often all was forgotten. */
  #begun = 0;

  /** @param {(question: Q) => Promise<A>} ask @param {() => void} answered there is another `last` */
  constructor(ask, answered) {
    this.#ask = ask;
    this.#answered = answered;
  }

  /** @param {Q} question */
  want(question) {
    if (question === this.#newest) return;
    this.#newest = question;
    this.#waits = true;
    this.#asking ??= this.#askAll();
  }

  /** Promises the answer to a question; undefined where another is asked meanwhile. @param {Q} question */
  async answerTo(question) {
    this.want(question);
    await this.#asking;
    return this.last?.question === question ? this.last.answer : undefined;
  }

  /** What is still to be answered is of no use any more. */
  forget() {
    this.last = null;
    this.#newest = null;
    this.#waits = false;
    this.#begun += 1;
  }

  async #askAll() {
    while (this.#waits) {
      const question = /** @type {Q} */ (this.#newest);
      const begun = this.#begun;
      this.#waits = false;
      const answer = await this.#ask(question);
      if (begun !== this.#begun) continue;
      this.last = { question, answer };
      this.#answered();
    }
    this.#asking = null;
  }
}
