import { element } from '../base/element.js';
import { holderName, say } from '../base/texts.js';

/**
 * @import { StateDocument } from '../base/protocol.js'
 * @import { Store } from '../base/store.js'
 */

const STAYS_MS = 6000;

/** The row of who only watches: what that means, and buttons. It goes when nobody touches the page. */
export class Watching {
  #element = /** @type {HTMLElement} */ (document.getElementById('watching'));
  #words = element('p');
  #timer;

  /** Empty until `rebuild`. @param {Store} store */
  constructor(store) {
    store.subscribe(({ role }) => [role], (role) => {
      if (!role) return; // not connected: what was allowed still is
      this.#element.hidden = role !== 'view';
      this.#stay();
    });
    store.subscribe(({ state, language }) => [state?.control, language], (control) => {
      if (control) this.#words.textContent = watchingWords(control);
    });
    for (const type of ['pointerdown', 'pointermove', 'keydown']) {
      document.addEventListener(type, () => this.#stay(), { capture: true, passive: true });
    }
  }

  /** @param {HTMLElement[]} buttons */
  rebuild(buttons) {
    const hadFocus = this.#element.contains(document.activeElement);
    this.#element.ariaLabel = say('watching.label');
    this.#element.replaceChildren(this.#words, ...buttons);
    if (hadFocus) buttons[0].focus();
  }

  #stay() {
    if (this.#element.hidden) return;
    this.#element.classList.remove('away');
    clearTimeout(this.#timer);
    this.#timer = setTimeout(() => this.#element.classList.add('away'), STAYS_MS);
  }
}

/** @param {StateDocument['control']} control */
export function watchingWords(control) {
  return control.holder ? say('watching.holder', { name: holderName(control) }) : say('watching.nobody');
}
