import { button, element } from '../base/element.js';
import { TOOLS, UNITS, componentWords, measuresOf, nextPick, valueWords } from '../base/measures.js';
import { freeName, unusedName } from '../base/order.js';
import { onChange } from '../base/store.js';
import { say } from '../base/texts.js';
import { byName, choice, facts, numbers, rows, toggle } from './controls.js';
import { each, joined, stateOf } from './section.js';
import { field } from './views-section.js';

/**
 * @import { Kind, Measure, Snapped, Unit } from '../base/measures.js'
 * @import { Page, Section } from './section.js'
 */

/**
 * What is measured of the scene, and the tools that measure it.
 *
 * @param {Page} page
 * @returns {Section}
 */
export function measuresSection(page) {
  const parts = joined([toolButtons(page), measureList(page), unitControls(page)]);
  const all = element('fieldset', { className: 'sections measures' }, ...parts.content);
  return {
    name: 'measures',
    title: say('measures.title'),
    content: [all],
    show: each(parts.show, onChange(({ steers }) => [steers], (steers) => Object.assign(all, { disabled: !steers }))),
  };
}

/** @param {Page} page */
function toolButtons({ commands, store, report, snapping, makeRoom }) {
  /** Asked for, and not yet in the state. @type {Set<string>} */
  const asked = new Set();
  let isLoop = false;
  /** Asks again what the tool that is on asks for. */
  let askAgain = () => {};
  /** @param {Kind} kind @param {Snapped[]} taken */
  const add = async (kind, taken) => {
    const name = unusedName(say(TOOLS[kind]), [...Object.keys(stateOf(store).measures), ...asked]);
    asked.add(name);
    await commands.patch({ measures: { [name]: { kind, picks: taken.map(({ feature }) => feature) } } });
    asked.delete(name);
  };
  const start = (kind, tool) => {
    /** @type {Snapped[]} */
    let taken = [];
    /** Since no circle was where one was touched. */
    let isByPoints = false;
    const next = () => nextPick(kind, taken.map(({ feature }) => feature), { isLoop, isByPoints });
    const ask = () => {
      if (!next()) {
        add(kind, taken);
        taken = [];
        isByPoints = false;
      }
      const { ask: what, to } = /** @type {{ask: string}&*} */ (next());
      snapping.ask({ text: say(what), to, taken });
    };
    const take = (snapped) => {
      const hasNoCircle = !snapped && kind === 'radius' && !isByPoints;
      isByPoints ||= hasNoCircle;
      if (snapped) taken = [...taken, snapped];
      else report(new Error(say(hasNoCircle ? 'measures.noCircle' : 'measures.nothing')));
      ask();
    };
    const ended = () => {
      tool.ariaPressed = 'false';
      askAgain = () => {};
    };
    snapping.begin({ take, ended });
    tool.ariaPressed = 'true';
    askAgain = ask;
    ask();
    makeRoom();
  };
  const tools = Object.entries(TOOLS).map(([kind, name]) => {
    const tool = button(say(name), () => (tool.ariaPressed === 'true' ? snapping.end() : start(kind, tool)));
    tool.ariaPressed = 'false';
    return tool;
  });
  const loop = toggle(say('measures.wholeLoop'), (value) => {
    isLoop = value;
    askAgain();
  });
  return {
    content: [
      element('div', { className: 'tools', role: 'group', 'aria-label': say('measures.tools') }, ...tools), loop.element,
    ],
    show: () => {},
  };
}

/** The measures, each with its value; one unfolds its name and what else is known of it. @param {Page} page */
function measureList({ commands: { patch }, store, offer, report }) {
  const all = () => stateOf(store).measures;
  let chosen = /** @type {?string} */ (null);
  const remove = async (name) => {
    const before = all()[name];
    // A new measure may have got its name.
    const undo = () => patch({ measures: { [freeName(name, Object.keys(all()))]: before } });
    if (await patch({ measures: { [name]: null } })) offer(say('measures.removed', { name }), say('views.undo'), undo);
  };
  const rename = async (name, to) => {
    // What is there would stay as it is.
    if (Object.hasOwn(all(), to)) return report(new Error(say('measures.nameTaken', { name: to })));
    const isRenamed = await patch({ measures: { [to]: all()[name], [name]: null } });
    if (isRenamed) choose(to);
    return isRenamed;
  };
  const list = rows(say('measures.title'), say('measures.none'), (name) => measureRow(name, {
    choose: () => choose(name === chosen ? null : name),
    rename: (to) => rename(name, to),
    remove: () => remove(name),
  }));
  const show = () => {
    const measures = measuresOf(stateOf(store));
    const { unit } = stateOf(store);
    list.show(Object.keys(measures).sort(byName)
      .map((name) => [name, { measure: measures[name], unit, isChosen: name === chosen }]));
  };
  /** @param {?string} name */
  const choose = (name) => {
    chosen = name;
    show();
  };
  return {
    content: [list.element],
    show: onChange(({ state: { measures, measured, unit } }) => [measures, measured, unit], show),
  };
}

/** A row of the list: its elements, and how it shows its measure. */
function measureRow(name, { choose, rename, remove }) {
  const value = element('span', { className: 'value' });
  const there = button('', choose);
  there.append(element('span', {}, name), value);
  const away = button(say('sections.remove', { name }), remove, { icon: 'remove', quiet: true, only: true });
  const entry = field(say('measures.newNameOf', { name }), say('views.rename'), rename);
  const components = facts({ x: 'X', y: 'Y', z: 'Z' });
  const editor = element('div', { className: 'editor' }, components.element, entry.element);
  editor.hidden = true;
  return {
    children: [there, away, editor],
    show({ measure, unit, isChosen }) {
      const words = measure.problem ?? valueWords(measure, unit);
      if (value.textContent !== words) value.textContent = words;
      value.classList.toggle('problem', measure.problem !== undefined);
      const isNew = isChosen && editor.hidden;
      there.ariaExpanded = String(isChosen);
      editor.hidden = !isChosen;
      const parts = componentWords(measure, unit);
      components.element.hidden = !parts;
      if (parts) components.show(parts);
      entry.show(name);
      if (isNew) editor.scrollIntoView({ block: 'nearest' });
    },
  };
}

/** In what lengths are shown, and how long a unit of the scene is. @param {Page} page */
function unitControls({ commands: { change } }) {
  const shown = choice(say('measures.unit'), UNITS.map((unit) => [unit, unit]), (unit) => change({ unit: { shown: unit } }));
  const scene = numbers(say('measures.sceneUnit'), ['m'], ([metres]) => change({ unit: { metres } }));
  return {
    content: [shown.element, scene.element],
    show: onChange(({ state: { unit } }) => [unit], (unit) => {
      shown.show(unit.shown);
      scene.show([unit.metres]);
    }),
  };
}
