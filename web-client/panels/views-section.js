import { button, element } from '../base/element.js';
import { moved, namesInOrder, unusedName } from '../base/order.js';
import { onChange } from '../base/store.js';
import { say } from '../base/texts.js';
import { byName, limit, rows } from './controls.js';
import { each, joined, stateOf } from './section.js';

/**
 * @import { ServerPicked, StateDocument } from '../base/protocol.js'
 * @import { Now } from '../base/store.js'
 * @import { Page, Section } from './section.js'
 */

/**
 * Where to look from: saved views and cameras.
 *
 * @param {Page} page
 * @returns {Section}
 */
export function viewsSection({ commands, report, offer, store }) {
  const page = { ...commands, report, offer, state: () => stateOf(store) };
  const parts = joined([savedViews, cameras].map((part) => part(page)));
  const home = button(say('views.home'), () => commands.fly(page.state().views.home), { icon: 'home' });
  const fit = button('', () => commands.fit(page.state().selection.node), { icon: 'fit' });
  return {
    name: 'views',
    title: say('views.title'),
    content: [element('div', { className: 'buttons' }, home, fit), ...parts.content],
    show: each(parts.show, onChange(({ state }) => [state.selection.node === undefined], (isScene) => {
      fit.lastChild.data = isScene ? say('views.fitScene') : say('views.fitPart');
    })),
  };
}

function savedViews({ fly, patch, report, offer, state }) {
  const isFree = (name) => {
    const isTaken = Object.hasOwn(state().views, name);
    // What is there would stay as it is.
    if (isTaken) report(new Error(say('views.nameTaken', { name })));
    return !isTaken;
  };
  const put = async (name, view, text) => {
    const before = state().views[name];
    const undo = () => patch({ views: { [name]: before } });
    if (await patch({ views: { [name]: view } })) offer(text, say('views.undo'), undo);
  };
  const rename = (name) => async (to) =>
    isFree(to) && patch({ views: { [to]: state().views[name], [name]: null } });
  const overwrite = (name) => put(name, poseOf(state().camera), say('views.overwritten', { name }));
  const move = (name, by) => {
    const views = movedView(state().views, name, by);
    if (views) patch({ views });
  };
  const edit = (name) => {
    const earlier = button(say('views.earlier'), () => move(name, -1));
    const later = button(say('views.later'), () => move(name, 1));
    return {
      content: [
        field(say('views.newNameOf', { name }), say('views.rename'), rename(name)).element,
        element('div', { className: 'buttons' }, earlier, later),
        button(say('views.overwrite'), () => overwrite(name), { icon: 'camera' }),
      ],
      show({ order, last }) {
        earlier.ariaDisabled = String(order === 0);
        later.ariaDisabled = String(order === last);
      },
    };
  };
  const list = places(say('views.saved'), say('views.none'), (name) => fly(state().views[name]),
    (name) => put(name, null, say('views.deleted', { name })), edit);
  const entry = field(say('views.name'), say('views.save'),
    async (name) => isFree(name) && patch({ views: { [name]: {} } }));
  return {
    content: [...list.content, entry.element],
    show: onChange(({ state }) => [state.views], (views) => {
      const names = viewNames(views);
      list.show(names.map((name, order) => [name, { text: name, order, last: names.length - 1 }]));
      entry.show(unusedName(say('views.newName'), names));
    }),
  };
}

/**
 * The saved views: those with an `order` first, by that, then the others, by name.
 *
 * @param {StateDocument['views']} views
 */
export function viewNames(views) {
  return namesInOrder(views, byName).filter((name) => name !== 'home');
}

/**
 * What of the views is to be changed for one to change places with the one before or after it; null at the ends.
 *
 * @param {StateDocument['views']} views
 * @param {string} name
 * @param {1|-1} by
 */
export function movedView(views, name, by) {
  return moved(views, viewNames(views), name, by);
}

/** What a saved view has of a camera. @param {StateDocument['camera']} camera */
export function poseOf({ eye, focus, up, center, fov }) {
  return { eye, focus, up, center, fov };
}

function cameras({ change }) {
  const list = places(say('views.cameras'), say('views.noCameras'),
    (id) => change({ camera: { node: Number(id) } }));
  return {
    ...list,
    show: onChange(({ state: { cameras: all, camera } }) => [all, camera.node], (entries, node) =>
      list.show(cameraEntries(entries, node))),
  };
}

/**
 * [id, item] of each; `node`: that of the camera in use.
 *
 * @param {StateDocument['cameras']} all
 * @param {number} [node]
 */
export function cameraEntries(all, node) {
  return Object.entries(all).map(([id, { name }]) => [id, { text: name || `#${id}`, used: node === Number(id) }]);
}

/**
 * A list of buttons that go there, with `remove` those that delete, and with `edit` those that unfold what it gives:
 * {content, show(item)}. Items are in their `order`, if they have one, and by name.
 */
function places(title, none, go, remove, edit) {
  const list = rows(title, none, (key) => {
    const there = button('', () => go(key));
    const away = button('', () => remove(key), { icon: 'remove', quiet: true, only: true });
    const edited = edit?.(key);
    const editor = element('div', { className: 'editor', hidden: true }, ...(edited?.content ?? []));
    const unfold = button('', () => turn(editor.hidden), { icon: 'edit', quiet: true, only: true });
    const turn = (isOpen) => {
      editor.hidden = !isOpen;
      unfold.ariaExpanded = String(isOpen);
      const input = editor.querySelector('input');
      if (!input || !isOpen) return unfold.focus();
      input.value = key;
      input.select();
    };
    editor.onkeydown = (event) => {
      if (event.key !== 'Escape') return;
      event.preventDefault(); // the menu stays open
      turn(false);
    };
    unfold.ariaExpanded = 'false';
    const show = (item) => {
      const { text, used } = item;
      edited?.show(item);
      there.lastChild.data = text;
      there.ariaPressed = used;
      away.ariaLabel = away.title = say('views.delete', { text });
      unfold.ariaLabel = unfold.title = say('views.edit', { text });
    };
    return { children: [there, ...(edit ? [unfold] : []), ...(remove ? [away] : []), editor], show };
  });
  return {
    content: [element('h3', {}, title), list.element],
    show: (entries) => list.show(entries.sort(([, a], [, b]) => (a.order ?? 0) - (b.order ?? 0) || byName(a.text, b.text))),
  };
}

/**
 * Adds what is typed, or else what it shows, of so many bytes. What is entered before the server has answered waits;
 * `add` gives nothing where it fails.
 */
export function field(label, action, add, most = Infinity) {
  const input = element('input', { ariaLabel: label });
  if (most < Infinity) input.oninput = () => limit(input, most);
  const form = element('form', { className: 'entry' }, input, element('button', {}, action));
  let waiting = /** @type {?string} */ (null);
  let answered = Promise.resolve();
  form.onsubmit = (event) => {
    event.preventDefault();
    const { value } = input;
    if (value === waiting) return; // pressed twice
    waiting = value;
    // Which names are taken is known when the one before has its own.
    answered = answered.then(async () => {
      const isAdded = await add(value.trim() || input.placeholder);
      // What is typed meanwhile is of the next one.
      if (isAdded && input.value === value) input.value = '';
      if (waiting === value) waiting = null;
    });
  };
  return { element: form, show: (placeholder) => Object.assign(input, { placeholder }) };
}

/**
 * Where a note is to be: if the server tells it, in the part's own space, to move with the part.
 *
 * @param {ServerPicked} picked
 */
export function placeOf({ node, point, local }) {
  return local ? { node, point: local } : { point };
}

/**
 * The middle of what is free of a view, in CSS pixels.
 *
 * @param {{width: number, height: number}} view
 * @param {Now['inset']} inset
 */
export function middleOf({ width, height }, { top, right, bottom, left }) {
  return { x: (left + width - right) / 2, y: (top + height - bottom) / 2 };
}

/**
 * The camera that turns about a place and shows it at `at` of the view, in the same direction and from as far.
 *
 * @param {StateDocument['camera']} camera
 * @param {number[]} place
 * @param {{x: number, y: number}} at
 * @param {{width: number, height: number}} view
 */
export function lookingAt({ eye, focus, up, fov }, place, at, { width, height }) {
  const ahead = focus.map((x, i) => x - eye[i]);
  const pixel = (2 * Math.tan((fov * Math.PI) / 360)) / height; // in parts of the distance
  const across = [1, 2, 0].map((j, i) => ahead[j] * up[(i + 2) % 3] - ahead[(i + 2) % 3] * up[j]); // as long as `ahead`
  const aside = across.map((x, i) => (x * (at.x - width / 2) - up[i] * Math.hypot(...ahead) * (at.y - height / 2)) * pixel);
  const seen = place.map((x, i) => x - aside[i]);
  return { eye: seen.map((x, i) => x - ahead[i]), focus: seen, center: place };
}
