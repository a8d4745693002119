import { button, element } from '../base/element.js';
import { flipped, movedCorner, planeAcross, planeFacing, planeThrough, sweep } from '../base/planes.js';
import { unusedName } from '../base/order.js';
import { onChange } from '../base/store.js';
import { say, written } from '../base/texts.js';
import { range, rows, toggle } from './controls.js';
import { each, stateOf } from './section.js';


/**
 * @import { Bounds, Plane } from '../base/planes.js'
 * @import { StateDocument } from '../base/protocol.js'
 * @import { Known, Page, Section } from './section.js'
 */

const MOST_PLANES = 6;
const AXES = ['X', 'Y', 'Z'];
const UNITS = [[1, 0, 0], [0, 1, 0], [0, 0, 1]];

/**
 * Planes and a box that cut the scene open.
 *
 * @param {Page} page
 * @returns {Section}
 */
export function sectionsSection(page) {
  const { commands, store } = page;
  const list = planeList(page);
  const adding = adders(page, list.choose);
  const box = boxControls(commands, () => stateOf(store));
  const all = element('fieldset', { className: 'sections' }, ...adding.content, ...list.content, ...box.content);
  const folded = () => {
    adding.stop();
    list.showHandle(false);
  };
  return {
    name: 'sections',
    title: say('sections.title'),
    content: [all],
    unfolded: () => list.showHandle(true),
    folded,
    show: each(
      onChange(({ steers }) => [steers], (steers) => {
        all.disabled = !steers;
        if (!steers) adding.stop();
      }),
      adding.show, list.show, box.show,
      () => list.showHandle(/** @type {*} */ (all.closest('details')).open)),
  };
}

/** @param {Page} page @param {(name: string) => void} choose */
function adders({ commands, store, report, nextTap }, choose) {
  const state = () => stateOf(store);
  /** Asked for, and not yet in the state. @type {Set<string>} */
  const asked = new Set();
  const names = () => [...new Set([...Object.keys(state().sections), ...asked])];
  const isFull = () => names().length >= MOST_PLANES;
  /** @param {Plane} plane */
  const add = async (plane) => {
    const name = unusedName(say('sections.newName'), names());
    asked.add(name);
    const isAdded = await commands.patch({ sections: { [name]: plane } });
    asked.delete(name);
    if (isAdded) choose(name);
  };
  const adder = (label, make) => button(label, () => isFull() || make());

  let tapping = /** @type {?AbortController} */ (null);
  const stop = () => tapping?.abort();
  /** The next face that is tapped; undefined where that is given up. */
  const pickedFace = async (signal) => {
    while (!signal.aborted) {
      const tap = await nextTap(say('sections.tapFace'), signal);
      const picked = tap && await commands.pick(tap);
      if (picked?.normal || !tap) return picked;
      if (picked) report(new Error(say('sections.noFace')));
    }
  };
  const cutFace = async () => {
    if (tapping) return stop();
    tapping = new AbortController();
    const { signal } = tapping;
    face.ariaPressed = 'true';
    const picked = await pickedFace(signal);
    face.ariaPressed = 'false';
    tapping = null;
    if (picked?.normal && !signal.aborted) add(planeThrough(picked.point, picked.normal));
  };
  const across = AXES.map((label, axis) =>
    adder(label, () => add(planeAcross(axis, state().scene.bounds, state().camera))));
  const facing = adder(say('sections.facing'), () => add(planeFacing(state().camera)));
  const face = adder(say('sections.face'), cutFace);
  face.ariaPressed = 'false';
  const label = say('sections.across');
  const full = element('p', { className: 'note', role: 'status' });
  return {
    content: [
      element('div', { className: 'buttons', role: 'group', 'aria-label': label }, element('span', {}, label), ...across),
      element('div', { className: 'buttons' }, facing, face),
      full,
    ],
    stop,
    show: onChange(({ state, steers }) => [state.sections, steers], (_, steers) => {
      const why = isFull() ? say('sections.full') : '';
      if (full.textContent !== why) full.textContent = why;
      for (const one of [...across, facing, face]) {
        one.ariaDisabled = String(isFull() || !steers);
        one.title = why;
      }
    }),
  };
}

/** The planes. The chosen one has its controls unfolded, and a handle in the picture. @param {Page} page */
function planeList({ commands, store, offer }) {
  const { change, patch } = commands;
  const state = () => stateOf(store);
  let chosen = /** @type {?string} */ (null);
  let hasHandle = false;
  const remove = async (name) => {
    const before = state().sections[name];
    const undo = () => patch({ sections: { [name]: before } });
    if (await patch({ sections: { [name]: null } })) offer(say('sections.removed', { name }), say('views.undo'), undo);
  };
  const list = rows(say('sections.planes'), say('sections.none'), (name) => {
    const set = (members) => change({ sections: { [name]: members } });
    return planeRow(name, {
      set,
      choose: () => choose(name === chosen ? null : name),
      turn: () => set(flipped(state().sections[name])),
      remove: () => remove(name),
    });
  });
  const show = () => {
    const { sections, scene: { bounds } } = state();
    list.show(Object.keys(sections).map((name) =>
      [name, { plane: sections[name], isChosen: name === chosen, limits: sweep(sections[name].normal, bounds) }]));
  };
  /** @param {?string} name */
  const choose = (name) => {
    chosen = name;
    show();
    showHandle(hasHandle);
  };
  const showHandle = (isShown) => {
    hasHandle = isShown;
    const handled = isShown ? chosen : null;
    if (store.now.handled !== handled) store.set({ handled });
  };
  return {
    content: [element('h3', {}, say('sections.planes')), list.element],
    choose,
    showHandle,
    show: onChange(({ state }) => [state.sections, state.scene.bounds], show),
  };
}

/** A row of the list: its elements, and how it shows its plane. */
function planeRow(name, { set, choose, turn, remove }) {
  const there = button(name, choose);
  const on = toggle('', (value) => set({ on: value }));
  Object.assign(on.element.lastChild ?? {}, { ariaLabel: say('sections.isOn', { name }) });
  const tools = [
    button(say('sections.turn', { name }), turn, { icon: 'turn', quiet: true, only: true }),
    button(say('sections.remove', { name }), remove, { icon: 'remove', quiet: true, only: true }),
  ];
  const position = measure(say('sections.position'), (distance) => set({ distance }));
  const caps = capControls(set);
  const editor = element('div', { className: 'editor' }, position.element, ...caps.content);
  return {
    children: [there, on.element, ...tools, editor],
    show({ plane, isChosen, limits }) {
      there.ariaPressed = String(isChosen);
      const isNew = isChosen && editor.hidden;
      editor.hidden = !isChosen;
      on.show(plane.on);
      position.show(plane.distance, limits);
      caps.show(plane);
      if (isNew) editor.scrollIntoView({ block: 'nearest' });
    },
  };
}

/** A length along the scene, by a slider that is given its limits with each value. */
function measure(label, change) {
  let extent = 1;
  const control = range(label, { min: 0, max: 1, step: 0.001, say: (value) => lengthWords(value, extent) }, change);
  return {
    element: control.element,
    show(value, limits) {
      extent = limits.max - limits.min;
      control.show(value, limits);
    },
  };
}

/** A length of a scene, to a thousandth of how far that reaches. */
export function lengthWords(value, extent) {
  const digits = extent > 0 ? Math.ceil(3 - Math.log10(extent)) : 0;
  return written(value, Math.min(Math.max(digits, 0), 9));
}

/** What both planes and the box have. */
function capControls(set) {
  const caps = toggle(say('sections.caps'), (value) => set({ caps: value }));
  const hatched = toggle(say('sections.hatched'), (value) => set({ hatched: value }));
  return {
    content: [element('div', { className: 'sides-of-box' }, caps.element, hatched.element)],
    show(cut) {
      caps.show(cut.caps);
      hatched.show(cut.hatched);
    },
  };
}

/** @param {Page['commands']} commands @param {() => StateDocument} state */
function boxControls({ change }, state) {
  /** The corners as they are, or will be once the server has answered. @type {Bounds} */
  let corners = { min: [], max: [] };
  let waiting = 0;
  const limits = (axis) => sweep(UNITS[axis], state().scene.bounds);
  const set = (members) => change({ sectionBox: members });
  const move = async (corner, axis, value) => {
    corners = { ...corners, [corner]: movedCorner(corners, corner, axis, value, limits(axis)) };
    waiting += 1;
    await set({ [corner]: corners[corner] });
    waiting -= 1;
    if (waiting === 0) corners = state().sectionBox;
  };
  const sides = AXES.flatMap((axis, i) => [
    { corner: 'min', i, ...measure(say('sections.lower', { axis }), (value) => move('min', i, value)) },
    { corner: 'max', i, ...measure(say('sections.upper', { axis }), (value) => move('max', i, value)) },
  ]);
  const on = toggle(say('sections.boxIsOn'), (value) => set({ on: value }));
  const caps = capControls(set);
  const reset = button(say('sections.reset'), () => set({ min: null, max: null }), { icon: 'fit' });
  const inside = element('div', {},
    element('div', { className: 'sides-of-box' }, ...sides.map((side) => side.element)), ...caps.content, reset);
  return {
    content: [element('h3', {}, say('sections.box')), on.element, inside],
    show: onChange(({ state: { sectionBox, scene } }) => [sectionBox, scene.bounds], (box) => {
      if (waiting === 0) corners = box;
      inside.hidden = !box.on;
      on.show(box.on);
      caps.show(box);
      for (const { corner, i, show } of sides) show(box[corner][i], limits(i));
    }),
  };
}
