import { element } from '../base/element.js';
import { recall, remember } from '../base/memory.js';
import { onChange } from '../base/store.js';

/**
 * @import { Snap, Snapped } from '../base/measures.js'
 * @import { Now, Store } from '../base/store.js'
 * @import { StateDocument } from '../base/protocol.js'
 * @import { Commands } from '../connection/commands.js'
 * @import { Meter } from '../connection/meter.js'
 * @import { Control } from './controls.js'
 * @import { Pictures } from './pictures.js'
 */

/**
 * What a section is given.
 *
 * @typedef {{store: Store, commands: Commands, meter: Meter, report: (error: *) => void,
 *   offer: (text: string, label: string, act: () => void) => void, nextTap: NextTap, snapping: Snapping,
 *   turnPointing: () => void, present: () => void, makeRoom: () => void, fetchFile: (name: string) => Promise<Blob>,
 *   notePictures: Pictures, openDialog: (name: 'deletion', opener: HTMLElement) => void}} Page
 *   `turnPointing`: a finger begins or ends to point; `present`: opens what a presenter has of the cues; `makeRoom`:
 *   closes the menu where that covers most of the picture; `fetchFile`: of the server, or an error for `report`
 *
 * Says what to tap, and promises where in which frame the picture is tapped next; null where it is not.
 *
 * @typedef {(text: string, signal: AbortSignal) => Promise<?{x: number, y: number, frame?: number}>} NextTap
 *
 * Picks on the picture snap to what is there, from `begin` to `end`, which calls the session's `ended`; that may come
 * by itself, too. `ask` says what is wanted.
 *
 * @typedef {{
 *   begin: (session: {take: (snapped?: Snapped) => void, ended: () => void}) => void,
 *   ask: (asked: {text: string, to?: Snap[], taken: Snapped[]}) => void, end: () => void,
 * }} Snapping
 *
 * What the page knows once it has a state.
 *
 * @typedef {Now & {state: StateDocument}} Known
 *
 * A folding part of the menu or of the settings, told when opened, and when that or the menu is closed.
 *
 * @typedef {{name: string, title: string, content: HTMLElement[], show: (now: Known) => void,
 *   unfolded?: () => void, folded?: () => void}} Section
 */

/**
 * Of each control, what it shows depends on, and how that is shown: its arguments; left out, they are these themselves.
 *
 * @param {string} name
 * @param {string} title
 * @param {...[Control, (state: StateDocument, now: Known) => *[], ((...picked: *[]) => *[])?]} bound
 * @returns {Section}
 */
export function section(name, title, ...bound) {
  const parts = bound.map(([{ element, show }, select, model]) => ({
    content: [element],
    show: onChange((now) => select(now.state, now), model ? (...picked) => show(...model(...picked)) : show),
  }));
  return { name, title, ...joined(parts) };
}

/** What folds is remembered. @param {Section} section */
export function foldable({ name, title, content, unfolded: opened, folded: closed }) {
  const details = element('details', { data: { section: name }, open: unfolded().includes(name) },
    element('summary', {}, element('h2', {}, title)), element('div', { className: 'content' }, ...content));
  details.ontoggle = () => {
    const others = unfolded().filter((other) => other !== name);
    remember('sections', [...others, ...(details.open ? [name] : [])].join(' '));
    if (details.open) opened?.();
    else closed?.();
  };
  return details;
}

function unfolded() {
  return (recall('sections') ?? 'renderer light background').split(' ');
}

/** The state, which is there as soon as a section is shown. @param {Store} store */
export function stateOf(store) {
  return /** @type {StateDocument} */ (store.now.state);
}

/**
 * Parts of a section as one.
 *
 * @param {{content: HTMLElement[], show: (now: Known) => void}[]} parts
 */
export function joined(parts) {
  return {
    content: parts.flatMap(({ content }) => content),
    show: each(...parts.map(({ show }) => show)),
  };
}

/**
 * One function that calls all.
 *
 * @param {...(now: Known) => void} shows
 */
export function each(...shows) {
  /** @param {Known} now */
  return (now) => {
    for (const show of shows) show(now);
  };
}
