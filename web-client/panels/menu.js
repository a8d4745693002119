import { button, element } from '../base/element.js';
import { pictureOfNote } from '../base/notes.js';
import { language, say } from '../base/texts.js';
import { cuesSection } from './cues-section.js';
import { Dialogs } from './dialogs.js';
import { measuresSection } from './measures-section.js';
import { notesSection } from './notes-section.js';
import { partsSection } from './parts-section.js';
import { Pictures } from './pictures.js';
import { presentationSection } from './presentation-section.js';
import { foldable } from './section.js';
import { sectionsSection } from './sections-section.js';
import { viewsSection } from './views-section.js';
import { Watching } from './watching.js';

/** @import { Page, Section } from './section.js' */

/** Where the menu comes from below, over most of the picture: as in style.css. */
const SHEET = '(max-width: 37.5rem) and (orientation: portrait)';

/** The panel of folding sections, and the button that opens it. */
export class Menu {
  #button;
  /** What has the focus when the menu is closed. @type {HTMLElement} */
  #opener;
  #stage;
  #panel;
  #page;
  #dialogs;
  #watching;
  /** @type {Section[]} */
  #sections = [];

  /** Empty until `rebuild`. @param {Omit<Page, 'makeRoom'|'notePictures'|'openDialog'> & {setLanguage: (code: string) => void}} page */
  constructor(page) {
    const { store } = page;
    const opener = /** @type {HTMLButtonElement} */ (document.getElementById('menu-button'));
    const panel = /** @type {HTMLElement} */ (document.getElementById('menu'));
    const stage = /** @type {HTMLElement} */ (document.getElementById('stage'));
    this.#opener = opener;
    this.#stage = stage;
    this.#button = opener;
    this.#panel = panel;
    this.#page = {
      ...page,
      makeRoom: () => matchMedia(SHEET).matches && this.close(),
      openDialog: (name, opener) => this.#dialogs.open(name, opener),
      notePictures: new Pictures({ store, commands: page.commands, find: ({ markers }, name) => pictureOfNote(markers, name) }),
    };
    this.#dialogs = new Dialogs(this.#page);
    this.#watching = new Watching(store, page.turnPointing);
    opener.onclick = () => (stage.classList.contains('clean') ? this.#clean(false) : this.open(opener));
    panel.onkeydown = (event) => {
      // What is typed here is not meant for the view.
      event.stopPropagation();
      if (event.key === 'Escape' && !event.defaultPrevented) this.close();
    };
    store.subscribe(({ role }) => [role], (role) => {
      if (!role) return; // not connected: what was allowed still is
      opener.hidden = role !== 'control';
      if (!opener.hidden) return;
      this.close();
      this.#clean(false);
    });
    store.subscribe((now) => [now], () => this.#showAll());
  }

  get isOpen() {
    return !this.#panel.inert;
  }

  /**
   * @param {HTMLElement} opener gets the focus back
   * @param {string} [name] of a section to unfold
   */
  open(opener, name) {
    this.#opener = opener;
    this.#turn(true);
    this.#showAll();
    /** @type {?HTMLDetailsElement} */
    const section = name ? this.#panel.querySelector(`[data-section="${name}"]`) : null;
    if (section) section.open = true;
    section?.scrollIntoView();
    // Its texts may still be on their way.
    /** @type {?HTMLElement} */ (this.#panel.querySelector('.close'))?.focus({ preventScroll: true });
  }

  close() {
    if (!this.isOpen) return;
    // What it covers is shown again, and has the focus before the panel is inert, or the browser takes it first.
    this.#panel.classList.remove('open');
    this.#opener.focus({ preventScroll: true });
    this.#turn(false);
    for (const { folded } of this.#sections) folded?.();
  }

  #turn(isOpen) {
    this.#panel.inert = !isOpen;
    this.#panel.classList.toggle('open', isOpen);
    this.#button.ariaExpanded = String(isOpen);
  }

  /** Whether nothing lies on the picture but what has to be said, and the button that ends this. */
  #clean(isClean) {
    this.#stage.classList.toggle('clean', isClean);
    this.#button.title = isClean ? say('menu.unclean') : say('menu.title');
    this.#button.querySelector('use')?.setAttribute('href', isClean ? '#icon-seen' : '#icon-menu');
  }

  /** Makes everything anew, in the language in force. */
  rebuild() {
    const page = this.#page;
    this.#sections = [partsSection, viewsSection, cuesSection, notesSection, sectionsSection, measuresSection, presentationSection].map((build) => build(page));
    this.#panel.ariaLabel = say('menu.title');
    this.#clean(this.#stage.classList.contains('clean'));
    const close = tool('close', say('menu.close'), () => this.close());
    close.classList.add('close');
    const clean = tool('hidden', say('menu.clean'), () => {
      this.#opener = this.#button;
      this.#clean(true);
      this.close();
    });
    const turn = languageButton(page.setLanguage);
    const people = tool('people', say('people.title'), () => this.#dialogs.open('people', people));
    const help = tool('help', say('help.title'), () => this.#dialogs.open('help', help));
    const settings = button(say('settings.title'), () => this.#dialogs.open('settings', settings),
      { icon: 'settings', quiet: true });
    for (const opens of [people, help, settings]) opens.ariaHasPopup = 'dialog';
    const tools = [turn, people, help, clean, ...fullScreenButtons(), close];
    const head = element('div', { className: 'head' }, ...tools);
    this.#panel.replaceChildren(head, ...this.#sections.map(foldable), settings);
    if (this.isOpen) turn.focus({ preventScroll: true });
    this.#watching.rebuild([languageButton(page.setLanguage), ...fullScreenButtons()]);
    this.#showAll();
  }

  #showAll() {
    const { state, ...now } = this.#page.store.now;
    if (!this.isOpen || !state) return;
    for (const section of this.#sections) section.show({ ...now, state });
  }
}

function tool(icon, label, act) {
  return button(label, act, { icon, quiet: true, only: true });
}

/** @param {(code: string) => void} setLanguage */
function languageButton(setLanguage) {
  const other = language() === 'en' ? 'cs' : 'en';
  const made = button(say('menu.otherLanguage'), () => setLanguage(other), { quiet: true });
  made.lang = other;
  return made;
}

/** None where the browser has no full screen, as on an iPhone. */
function fullScreenButtons() {
  return document.fullscreenEnabled ? [tool('full', say('menu.fullScreen'), turnFullScreen)] : [];
}

function turnFullScreen() {
  if (document.fullscreenElement) document.exitFullscreen();
  else document.documentElement.requestFullscreen();
}
