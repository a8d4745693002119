import { asShown, cueList, cueNames, exactly } from '../base/cues.js';
import { download } from '../base/download.js';
import { button, element } from '../base/element.js';
import { isObject } from '../base/merge-patch.js';
import { freeName, moved, unusedName } from '../base/order.js';
import { patchParts } from '../base/patch-parts.js';
import { onChange } from '../base/store.js';
import { say, written } from '../base/texts.js';
import { range, rows, words } from './controls.js';
import { each, joined, stateOf } from './section.js';
import { field } from './views-section.js';

/** @import { Page, Section } from './section.js' */

/** Of the words of a cue; see the state's `cues`. */
const MOST_BYTES = 2000;

/**
 * The cues of a presentation: made of what is shown, put in order, kept as a file.
 *
 * @param {Page} page
 * @returns {Section}
 */
export function cuesSection(page) {
  const parts = joined([cues(page), files(page)]);
  const all = element('fieldset', { className: 'sections' }, ...parts.content);
  return {
    name: 'cues',
    title: say('cues.title'),
    content: [all],
    show: each(parts.show, onChange(({ steers }) => [steers], (steers) => Object.assign(all, { disabled: !steers }))),
  };
}

/** @param {Page} page */
function cues({ commands, store, offer, report, present }) {
  const { patch, cue: show } = commands;
  const all = () => stateOf(store).cues;
  const isFree = (name) => {
    // What is there would stay as it is.
    if (Object.hasOwn(all(), name)) report(new Error(say('cues.nameTaken', { name })));
    return !Object.hasOwn(all(), name);
  };
  const put = async (name, changed, text) => {
    const before = all()[name];
    if (await patch({ cues: { [name]: changed } })) {
      offer(text, say('views.undo'), () => {
        // Another may have got the name of one that was deleted.
        const to = changed === null ? freeName(name, Object.keys(all())) : name;
        return patch({ cues: { [to]: exactly(before, all()[to]) } });
      });
    }
  };
  const add = async (name) => {
    const orders = Object.values(all()).map(({ order }) => order ?? 0);
    return isFree(name) && patch({ cues: { [name]: { order: Math.max(-1, ...orders) + 1 } } });
  };
  const actions = {
    show: (name) => show({ name }),
    remove: (name) => put(name, null, say('views.deleted', { name })),
    rename: async (name, to) => isFree(to) && patch({ cues: { [to]: all()[name], [name]: null } }),
    overwrite: (name) => put(name, asShown(), say('cues.overwritten', { name })),
    // One that another deletes while its words are typed would be made again.
    change: (name, members) => Object.hasOwn(all(), name) && commands.change({ cues: { [name]: members } }),
    move: (name, by) => {
      const changed = moved(all(), cueNames(all()), name, by);
      if (changed) patch({ cues: changed });
    },
  };
  const list = rows(say('cues.title'), say('cues.none'), (name) => cueRow(name, actions));
  const entry = field(say('cues.name'), say('cues.add'), add);
  const begin = button(say('cues.present'), present, { icon: 'present' });
  return {
    content: [list.element, entry.element, element('div', { className: 'buttons' }, begin)],
    show: onChange(({ state }) => [state.cues, state.cue], (known, shown) => {
      const names = cueNames(known);
      list.show(names.map((name, order) => [name, {
        cue: known[name], isShown: name === shown?.name, isFirst: order === 0, isLast: order === names.length - 1,
      }]));
      begin.hidden = names.length === 0;
      entry.show(unusedName(say('cues.newName'), names));
    }),
  };
}

/** A row of the list: its elements, and how it shows its cue. */
function cueRow(name, { show, remove, rename, overwrite, change, move }) {
  const there = button(name, () => show(name));
  const away = button(say('views.delete', { text: name }), () => remove(name), { icon: 'remove', quiet: true, only: true });
  const unfold = button(say('views.edit', { text: name }), () => turn(), { icon: 'edit', quiet: true, only: true });
  unfold.ariaExpanded = 'false';
  const entry = field(say('views.newNameOf', { name }), say('views.rename'), (to) => rename(name, to));
  const text = words({ ariaLabel: say('cues.wordsOf', { name }), placeholder: say('cues.words') }, MOST_BYTES,
    (value) => change(name, { text: value }));
  const time = range(say('cues.time'), { min: 0, max: 10, step: 0.1, say: (s) => `${written(s, 2)} s` }, (s) => change(name, { ms: Math.round(s * 1000) }));
  const earlier = button(say('views.earlier'), () => move(name, -1));
  const later = button(say('views.later'), () => move(name, 1));
  const editor = element('div', { className: 'editor', hidden: true }, text.element, time.element, entry.element,
    element('div', { className: 'buttons' }, earlier, later),
    button(say('cues.overwrite'), () => overwrite(name), { icon: 'camera' }));
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
    children: [there, unfold, away, editor],
    show({ cue, isShown, isFirst, isLast }) {
      there.ariaPressed = String(isShown);
      text.show(cue.text);
      time.show(cue.ms / 1000);
      entry.show(name);
      earlier.ariaDisabled = String(isFirst);
      later.ariaDisabled = String(isLast);
    },
  };
}

/** The list as a file. @param {Page} page */
function files({ commands, store, offer, report }) {
  const problems = element('ul', { className: 'problems', hidden: true, tabIndex: -1 });
  const input = element('input', { type: 'file', accept: 'application/json,.json', hidden: true });
  input.onchange = async () => {
    const [file] = /** @type {FileList} */ (input.files);
    input.value = '';
    if (file) await take(await file.text());
  };
  const show = (sentences) => {
    problems.replaceChildren(...sentences.map((sentence) => element('li', {}, sentence)));
    problems.hidden = sentences.length === 0;
    if (sentences.length > 0) problems.focus();
  };
  const take = async (text) => {
    const list = parsed(text);
    if (!list) return report(new Error(say('cues.noList')));
    const found = /** @type {string[]} */ ([]);
    const fitting = /** @type {string[]} */ ([]);
    for (const { cues } of patchParts({ cues: list.cues })) {
      const answer = await commands.check({ ...list, cues });
      if (!answer) return;
      found.push(...answer.problems.map(({ message }) => message));
      fitting.push(...answer.fitting);
    }
    show([...new Set(found)]);
    await put(Object.fromEntries(fitting.map((name) => [name, list.cues[name]])));
  };
  const put = async (taken) => {
    const before = stateOf(store).cues;
    const names = Object.keys(taken);
    const become = (wanted) => {
      const now = stateOf(store).cues;
      return commands.patch({ cues: Object.fromEntries(names.map((name) => [name, exactly(wanted[name], now[name])])) });
    };
    if (names.length === 0 || !await become(taken)) return;
    const undo = () => become(before);
    offer(say('cues.imported', { count: String(names.length) }), say('views.undo'), undo);
  };
  const saveList = () => {
    const list = cueList(stateOf(store));
    download(JSON.stringify(list, null, 1), 'application/json', `${list.scene.replace(/\.[^.]*$/, '').replaceAll('/', '-')}-cues.json`);
  };
  const save = button(say('cues.export'), () => saveList(), { icon: 'save' });
  const open = button(say('cues.openList'), () => input.click(), { icon: 'open' });
  return {
    content: [element('div', { className: 'buttons' }, open, save), input, problems],
    show: onChange(({ state }) => [Object.keys(state.cues).length === 0], (hidden) => Object.assign(save, { hidden })),
  };
}

/** A list of cues of a file's text; null where it is none. */
function parsed(text) {
  try {
    const list = JSON.parse(text);
    return isObject(list.cues) ? list : null;
  } catch {
    return null;
  }
}
