/** The page's one quiet line: empty while all is well. */
export class Status {
  #element;
  #environment;
  #lasting = '';
  #passing = '';
  #timer = undefined;

  /**
   * @param {HTMLElement} element
   * @param {{setTimeout: Function, clearTimeout: Function}} [environment]
   */
  constructor(element, environment = globalThis) {
    this.#element = element;
    this.#environment = environment;
  }

  /**
   * Says a sentence until it is replaced; '' says nothing.
   *
   * @param {string} sentence
   */
  hold(sentence) {
    this.#lasting = sentence;
    this.#show();
  }

  /**
   * Says a sentence for some seconds, where nothing lasting is being said.
   *
   * @param {string} sentence
   * @param {number} [ms]
   */
  pass(sentence, ms = 6000) {
    this.#environment.clearTimeout(this.#timer);
    this.#passing = sentence;
    this.#timer = this.#environment.setTimeout(() => {
      this.#passing = '';
      this.#show();
    }, ms);
    this.#show();
  }

  #show() {
    const sentence = this.#lasting || this.#passing;
    // Only a change: a screen reader would read the same words again.
    if (this.#element.textContent !== sentence) this.#element.textContent = sentence;
  }
}

/**
 * What is to be said of the connection.
 *
 * @param {import('./connection.js').Phase} phase
 * @param {boolean} hasPicture whether a picture has been drawn since the connection opened
 * @param {boolean} hasToken
 * @returns {?string} null: what was said last still holds
 */
export function connectionSentence(phase, hasPicture, hasToken) {
  switch (phase.name) {
    case 'open':
      return hasPicture ? '' : 'Waiting for the picture…';
    case 'waiting':
      return waitingSentence(phase);
    case 'refused':
      return refusedSentence(phase, hasToken);
    default:
      return null;
  }
}

function waitingSentence({ retryMs, hadOpened, reason }) {
  if (hadOpened) return 'The connection to the server is lost. Trying again…';
  const seconds = Math.round(retryMs / 1000);
  const why = reason ? ended(reason) : 'The server does not answer.';
  return `${why} Trying again${seconds > 0 ? ` in ${seconds} s.` : '…'}`;
}

function refusedSentence({ reason }, hasToken) {
  const why = reason ? ended(reason) : `The server ${hasToken ? 'does not accept the token in this address' : 'asks for a token'}.`;
  return `${why} Open the address that the server printed, or scan its code.`;
}

function ended(sentence) {
  return /[.!?…]$/.test(sentence) ? sentence : `${sentence}.`;
}
