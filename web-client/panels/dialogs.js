import { keepsKeys } from '../base/element.js';
import { recall, remember } from '../base/memory.js';

/** @import { Page } from './section.js' */

/** The dialogs over all else, one at a time: the help opens on a browser's first visit. */
export class Dialogs {
  #page;
  /** @type {?HTMLDialogElement} */
  #open = null;
  /** @type {(now: *) => void} */
  #show = () => {};

  /** @param {Page} page */
  constructor(page) {
    const { store } = page;
    this.#page = page;
    store.subscribe(({ role }) => [role], (role) => {
      if (role === 'view') this.#open?.close();
    });
    store.subscribe(({ role, hasPicture }) => [role === 'control' && hasPicture], (may) => {
      if (may && !recall('help')) this.open('help');
    });
    store.subscribe((now) => [now], () => this.#showAll());
    // Before the menu, which keeps its keys to itself.
    document.addEventListener('keydown', (event) => {
      const { key, ctrlKey, metaKey, target } = event;
      if (key !== '?' || ctrlKey || metaKey || keepsKeys(target) || store.now.role !== 'control') return;
      event.preventDefault();
      this.open('help');
    }, { capture: true });
  }

  /**
   * @param {'settings'|'help'|'people'|'deletion'} name
   * @param {HTMLElement} [opener] gets the focus when the dialog is closed
   */
  async open(name, opener) {
    // Nor one that is closed before this would come to it.
    if (this.#open) return;
    const loaded = await import('./dialogs/contents.js').catch(() => null);
    if (!loaded) return this.#page.report({ code: 'not-loaded' });
    if (this.#open) return;
    const { showDialog, [name]: build } = loaded;
    const { show, ...about } = build(this.#page);
    this.#open = showDialog({ name, ...about }, () => {
      this.#open = null;
      this.#show = () => {};
      opener?.focus({ preventScroll: true });
    });
    this.#show = show;
    this.#showAll();
    if (name === 'help') remember('help', 'seen');
  }

  #showAll() {
    const { now } = this.#page.store;
    if (now.state) this.#show(now);
  }
}
