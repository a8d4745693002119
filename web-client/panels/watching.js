import { element } from '../base/element.js';
import { holderName, say } from '../base/texts.js';
import { pointButton } from './pointing.js';

/**
 * @import { StateDocument } from '../base/protocol.js'
 * @import { Store } from '../base/store.js'
 */

const STAYS_MS = 6000;

/** The row of who only watches: what that means, and buttons. It goes when nobody touches the page. */
export class Watching {
  #element = /** @type {HTMLElement} */ (document.getElementById('watching'));
  #words = element('p');
  #store;
  #turnPointing;
  /** @type {?HTMLElement} */
  #point = null;
  #timer;

  /** Empty until `rebuild`. @param {Store} store @param {() => void} turnPointing */
  constructor(store, turnPointing) {
    this.#store = store;
    this.#turnPointing = turnPointing;
    store.subscribe(({ role }) => [role], (role) => {
      if (!role) return; // not connected: what was allowed still is
      this.#element.hidden = role !== 'view';
      this.#stay();
    });
    store.subscribe(({ state, language }) => [state?.control, language], (control) => {
      if (control) this.#words.textContent = watchingWords(control);
    });
    store.subscribe(({ points, state, language }) => [points, state?.pointing, language], () => this.#showPoint());
    for (const type of ['pointerdown', 'pointermove', 'keydown']) {
      document.addEventListener(type, () => this.#stay(), { capture: true, passive: true });
    }
  }

  /** @param {HTMLElement[]} buttons */
  rebuild(buttons) {
    const hadFocus = this.#element.contains(document.activeElement);
    this.#element.ariaLabel = say('watching.label');
    const point = pointButton(this.#turnPointing);
    this.#point = point;
    this.#element.replaceChildren(this.#words, point, ...buttons);
    this.#showPoint();
    if (hadFocus) buttons[0].focus();
  }

  #showPoint() {
    const { points, state } = this.#store.now;
    if (!this.#point) return;
    this.#point.ariaPressed = String(points);
    this.#point.hidden = state?.pointing?.watchers !== true;
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
