import { button, element } from '../base/element.js';
import { errorSentence, say } from '../base/texts.js';

const MOST_LINES = 3;
const PASSES_AFTER_MS = 6000;
/** With something to do, for which a hand needs time. */
const OFFERED_MS = 15_000;

/** Quiet lines over the picture: none while all is well. */
export class Lines {
  #element;
  #lasting = new Map();
  #passing = [];

  constructor(element) {
    this.#element = element;
  }

  /**
   * Says one sentence until it is replaced, '' for none, with a bar where a fraction, 0 to 1, is done, and with a button
   * where something can be done about it.
   *
   * @param {string} about
   * @param {string} text
   * @param {number} [fraction]
   * @param {{label: string, act: () => void}} [action]
   */
  hold(about, text, fraction, action) {
    if (text) this.#lasting.set(about, { sentence: whole(text), fraction, ...action });
    else this.#lasting.delete(about);
    this.#show();
  }

  /**
   * Says a sentence for some seconds, not twice at once; where something can be done about it, with a button.
   *
   * @param {string} text
   * @param {{label: string, act: () => void}} [action]
   */
  pass(text, action) {
    const sentence = whole(text);
    this.#passing = this.#passing.filter((line) => line.sentence !== sentence).slice(1 - MOST_LINES);
    const drop = () => {
      this.#passing = this.#passing.filter((other) => other !== line);
      this.#show();
    };
    const act = action && (() => {
      drop();
      action.act();
    });
    const line = { sentence, label: action?.label, act };
    this.#passing.push(line);
    setTimeout(drop, action ? OFFERED_MS : PASSES_AFTER_MS);
    this.#show();
  }

  #show() {
    const lines = [...this.#lasting.values(), ...this.#passing];
    while (this.#element.children.length > lines.length) this.#element.lastElementChild.remove();
    for (const [i, { sentence, fraction, label, act }] of lines.entries()) {
      const line = this.#element.children[i] ?? this.#element.appendChild(element('p', {}, element('span')));
      // Only a change: a screen reader would read the same words again.
      if (line.firstChild.textContent !== sentence) line.firstChild.textContent = sentence;
      const offered = line.querySelector('button');
      if (offered?.onclick !== act) {
        offered?.remove();
        if (act) line.append(button(label, act));
      }
      const bar = line.querySelector('progress');
      if (fraction === undefined) bar?.remove();
      else Object.assign(bar ?? line.appendChild(element('progress')), { ariaLabel: sentence, value: fraction });
    }
  }
}

/**
 * What is to be said of a Phase of the connection; null where the last still holds.
 *
 * @param {import('../base/store.js').Phase} phase
 * @param {boolean} hasPicture
 * @param {boolean} hasToken
 */
export function connectionSentence({ name, retryMs, hadOpened, reason }, hasPicture, hasToken) {
  const seconds = Math.round((retryMs ?? 0) / 1000);
  switch (name) {
    case 'starting':
      return say('phase.connecting');
    case 'open':
      return hasPicture ? '' : say('view.waiting');
    case 'waiting':
      return [
        reason ? whole(errorSentence(reason)) : say(hadOpened ? 'phase.lost' : 'phase.noAnswer'),
        hadOpened || seconds === 0 ? say('phase.retry') : say('phase.retryIn', { seconds }),
      ].join(' ');
    case 'refused':
      // What is not allowed in a hello is its token.
      return [
        reason && reason.code !== 'not-allowed'
          ? whole(errorSentence(reason)) : say(hasToken ? 'phase.tokenWrong' : 'phase.tokenMissing'),
        say('phase.openAddress'),
      ].join(' ');
    default:
      return null;
  }
}

/** The server's sentences begin small, to be put behind others. */
function whole(text) {
  const sentence = text.charAt(0).toUpperCase() + text.slice(1);
  return /[.!?…]$/.test(sentence) ? sentence : `${sentence}.`;
}
