import { download } from '../base/download.js';
import { button, element } from '../base/element.js';
import { asItWas, noteNames, placeInPicture } from '../base/notes.js';
import { freeName, unusedName } from '../base/order.js';
import { onChange } from '../base/store.js';
import { say, writtenTime } from '../base/texts.js';
import { rows, toggle, words } from './controls.js';
import { each, joined, stateOf } from './section.js';
import { field, lookingAt, middleOf, placeOf } from './views-section.js';

/**
 * @import { FrameHeader } from '../base/protocol.js'
 * @import { Note, Notes } from '../base/notes.js'
 * @import { Page, Section } from './section.js'
 */

/** Of a text; see the state's `markers`. */
const MOST_BYTES = 1000;

/**
 * Notes on points of the scene, and the report of them.
 *
 * @param {Page} page
 * @returns {Section}
 */
export function notesSection(page) {
  const list = notes(page);
  const all = element('fieldset', { className: 'sections notes' }, ...list.content);
  const lock = onChange(({ steers }) => [steers], (steers) => Object.assign(all, { disabled: !steers }));
  const reports = joined([reportButton(page)]);
  return {
    name: 'notes',
    title: say('notes.title'),
    content: [all, ...reports.content],
    show: each(list.show, lock, reports.show),
  };
}

/** @param {Page} page */
function notes({ commands, store, offer, report, notePictures: pictures }) {
  const { patch, pick, fly } = commands;
  const all = () => stateOf(store).markers;
  /** Draws what comes into view, and nothing else: there may be many. */
  const seen = new IntersectionObserver((entries) => {
    for (const { target, isIntersecting } of entries) {
      const image = /** @type {HTMLImageElement} */ (target);
      image.dataset.seen = String(isIntersecting);
      if (isIntersecting) pictures.show(image, image.dataset.note ?? '');
    }
  });
  const go = (name) => {
    const { view, markers } = /** @type {FrameHeader} */ (store.now.header);
    const from = all()[name].view;
    const { camera } = stateOf(store);
    return fly(from ?? lookingAt(camera, markers?.[name] ?? camera.center, middleOf(view, store.now.inset), view));
  };
  const remove = async (name) => {
    const before = all()[name];
    const undo = () => {
      // A new note may have got its name.
      const to = freeName(name, Object.keys(all()), 'note');
      return patch({ markers: { [to]: asItWas(before) } });
    };
    if (await patch({ markers: { [name]: null } })) offer(say('views.deleted', { name: before.text || name }), say('views.undo'), undo);
  };
  const add = async (text) => {
    const { frame, view } = store.now.header ?? {};
    const picked = view && await pick({ ...middleOf(view, store.now.inset), frame });
    if (!picked) return false;
    if (!picked.point) return report(new Error(say('notes.noPart')));
    const name = unusedName('note', Object.keys(all()));
    return patch({ markers: { [name]: { ...placeOf(picked), text, time: Date.now() } } });
  };
  const change = (name, members) => Object.hasOwn(all(), name) && commands.change({ markers: { [name]: members } });
  const list = rows(say('notes.title'), say('notes.none'), (name) => noteRow(name, { go, remove, change, pictures, seen }));
  const entry = field(say('notes.text'), say('notes.add'), add, MOST_BYTES);
  return {
    content: [list.element, entry.element],
    // Where they are changes with each frame; here only which the frame has.
    show: onChange(({ state, header }) => [state.markers, String(Object.keys(header?.markers ?? {}))], (known) => {
      list.show(noteEntries(known, store.now.header));
      entry.show(unusedName(say('notes.newText'), Object.values(known).map(({ text }) => text)));
    }),
  };
}

/**
 * [name, item] of each note: where of its picture it is, and whether it is lost, as it was made from no view and is not
 * in the frame that was drawn last.
 *
 * @param {Notes} all
 * @param {Pick<FrameHeader, 'markers'|'view'>|null|undefined} drawn
 * @returns {[string, {note: Note, lost: boolean, at?: {x: number, y: number}}][]}
 */
export function noteEntries(all, drawn) {
  return noteNames(all).map((name) => {
    const note = all[name];
    const point = drawn?.markers?.[name];
    const at = note.view && drawn && point ? placeInPicture(note.view, point, drawn.view.width / drawn.view.height) : undefined;
    return [name, { note, lost: !note.view && !point, at }];
  });
}

/** Who wrote a note and when, as far as that is known. @param {Note} note */
export function byWords({ author, time }) {
  return [author, time === undefined ? undefined : writtenTime(time)].filter(Boolean).join(' · ');
}

/** A row of the list: its elements, and how it shows its note. */
function noteRow(name, { go, remove, change, pictures, seen }) {
  const image = element('img', { alt: '', draggable: false, data: { note: name } });
  seen.observe(image);
  const title = element('span', { className: 'text' });
  const by = element('span', { className: 'by' });
  const there = button('', () => go(name));
  there.replaceChildren(image, element('span', {}, title, by));
  const done = toggle(say('notes.done'), (value) => change(name, { done: value }));
  const doneInput = /** @type {HTMLInputElement} */ (done.element.querySelector('input'));
  const unfold = button('', () => turn(), { icon: 'edit', quiet: true, only: true });
  unfold.ariaExpanded = 'false';
  const away = button('', () => remove(name), { icon: 'remove', quiet: true, only: true });
  const text = words({}, MOST_BYTES, (value) => change(name, { text: value }));
  const editor = element('div', { className: 'editor', hidden: true }, text.element);
  const turn = () => {
    editor.hidden = !editor.hidden;
    unfold.ariaExpanded = String(!editor.hidden);
    (editor.hidden ? unfold : text.element).focus();
  };
  editor.onkeydown = (event) => {
    if (event.key !== 'Escape') return;
    event.preventDefault(); // the menu stays open
    turn();
  };
  return {
    children: [there, element('div', { className: 'tools' }, done.element, unfold, away), editor],
    show({ note, lost, at }) {
      const called = note.text || name;
      title.textContent = called;
      by.textContent = byWords(note);
      image.hidden = !note.view;
      // The note's place is not cut off.
      if (at) image.style.objectPosition = `${(100 * at.x).toFixed(1)}% ${(100 * at.y).toFixed(1)}%`;
      if (image.dataset.seen === 'true') pictures.show(image, name);
      there.disabled = lost;
      there.classList.toggle('done', note.done);
      done.show(note.done);
      doneInput.ariaLabel = say('notes.isDone', { text: called });
      unfold.ariaLabel = unfold.title = say('views.edit', { text: called });
      away.ariaLabel = away.title = say('views.delete', { text: called });
      text.element.ariaLabel = say('notes.textOf', { text: called });
      text.show(note.text);
    },
  };
}

/** Files that the server makes. @param {Page} page */
function reportButton({ store, report, fetchFile }) {
  const nameOf = (ending) => `${stateOf(store).scene.file.replace(/\.[^.]*$/, '').replaceAll('/', '-')}-report.${ending}`;
  const file = (label, ending, type) => {
    const made = button(label, async () => {
      made.ariaDisabled = 'true';
      made.lastChild.data = say('notes.making');
      const name = nameOf(ending);
      await fetchFile(`report.${ending}`).then((data) => download(data, type, name)).catch(report);
      made.lastChild.data = label;
      made.ariaDisabled = 'false';
    }, { icon: 'save' });
    return made;
  };
  const page = file(say('notes.report'), 'html', 'text/html');
  const table = file(say('notes.table'), 'csv', 'text/csv');
  return {
    content: [element('div', { className: 'buttons' }, page, table)],
    show: onChange(({ state }) => [Object.keys(state.markers).length === 0], (hidden) => Object.assign(table, { hidden })),
  };
}
