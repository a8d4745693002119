import { button, element } from '../base/element.js';
import { recall, remember } from '../base/memory.js';
import { language, say } from '../base/texts.js';

/**
 * @import { Store } from '../base/store.js'
 * @import { Section } from './section.js'
 */

/** The panel of folding sections, and the button that opens it. */
export class Menu {
  #button;
  #panel;
  #build;
  #setLanguage;
  #store;
  /** @type {Section[]} */
  #sections = [];

  /**
   * Empty until `rebuild`; `build` gives the sections in the language in force.
   *
   * @param {{store: Store, build: () => Section[], setLanguage: (code: string) => void}} page
   */
  constructor({ store, build, setLanguage }) {
    const opener = /** @type {HTMLButtonElement} */ (document.getElementById('menu-button'));
    const panel = /** @type {HTMLElement} */ (document.getElementById('menu'));
    this.#button = opener;
    this.#panel = panel;
    this.#store = store;
    this.#build = build;
    this.#setLanguage = setLanguage;
    opener.onclick = () => this.open();
    panel.onkeydown = (event) => {
      // What is typed here is not meant for the view.
      event.stopPropagation();
      if (event.key === 'Escape' && !event.defaultPrevented) this.close();
    };
    store.subscribe(({ role }) => [role], (role) => {
      if (!role) return; // not connected: what was allowed still is
      opener.hidden = role !== 'control';
      if (opener.hidden) this.close();
    });
    store.subscribe((now) => [now], () => this.#showAll());
  }

  get isOpen() {
    return !this.#panel.inert;
  }

  open() {
    this.#turn(true);
    this.#showAll();
    /** @type {HTMLElement} */ (this.#panel.querySelector('.close')).focus({ preventScroll: true });
  }

  close() {
    if (!this.isOpen) return;
    // Before it is inert, or the browser takes the focus from it first.
    this.#button.focus({ preventScroll: true });
    this.#turn(false);
  }

  #turn(isOpen) {
    this.#panel.inert = !isOpen;
    this.#panel.classList.toggle('open', isOpen);
    this.#button.ariaExpanded = String(isOpen);
  }

  /** Makes everything anew, in the language in force. */
  rebuild() {
    this.#sections = this.#build();
    this.#button.title = say('menu.title');
    this.#panel.ariaLabel = this.#button.title;
    const other = language() === 'en' ? 'cs' : 'en';
    const turn = button(say('menu.otherLanguage'), () => this.#setLanguage(other), { quiet: true });
    turn.lang = other;
    const close = tool('close', say('menu.close'), () => this.close());
    close.classList.add('close');
    const full = tool('full', say('menu.fullScreen'), turnFullScreen);
    const head = element('div', { className: 'head' }, turn, ...(document.fullscreenEnabled ? [full] : []), close);
    this.#panel.replaceChildren(head, ...this.#sections.map(foldable));
    if (this.isOpen) turn.focus({ preventScroll: true });
    this.#showAll();
  }

  #showAll() {
    const { state, ...now } = this.#store.now;
    if (!this.isOpen || !state) return;
    for (const section of this.#sections) section.show({ ...now, state });
  }
}

function tool(icon, label, act) {
  return button(label, act, { icon, quiet: true, only: true });
}

function turnFullScreen() {
  if (document.fullscreenElement) document.exitFullscreen();
  else document.documentElement.requestFullscreen();
}

/** @param {Section} section */
function foldable({ name, title, content, unfolded: opened }) {
  const details = element('details', { data: { section: name }, open: unfolded().includes(name) },
    element('summary', {}, element('h2', {}, title)), element('div', { className: 'content' }, ...content));
  details.ontoggle = () => {
    const others = unfolded().filter((other) => other !== name);
    remember('sections', [...others, ...(details.open ? [name] : [])].join(' '));
    if (details.open) opened?.();
  };
  return details;
}

function unfolded() {
  return (recall('sections') ?? 'scene renderer').split(' ');
}
