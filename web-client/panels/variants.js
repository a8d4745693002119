import { isOpen } from '../base/hinges.js';
import { say } from '../base/texts.js';
import { choice, selection, toggle } from './controls.js';

/**
 * @import { ServerTree, StateDocument } from '../base/protocol.js'
 * @import { Commands } from '../connection/commands.js'
 *
 * @typedef {ServerTree['nodes'][number]} Node
 */

const MOST_SEGMENTS = 5;
const MOST_SWITCHED = 1000; // by one patch, which so stays below the protocol's 64 KiB

export function nameOf({ id, name }) {
  return name || `#${id}`;
}

/**
 * What there is to choose, as {title, switches}: those of the same names together, if none is empty.
 *
 * @param {Node[]} switches
 */
export function variants(switches) {
  const groups = new Map();
  for (const node of switches) {
    const { id, choices = [] } = node;
    if (choices.length < 2) continue;
    const key = choices.every(Boolean) ? JSON.stringify(choices) : id;
    if (!groups.has(key)) groups.set(key, []);
    groups.get(key).push(node);
  }
  return [...groups.values()].map((group) => ({ title: titleOf(group), switches: group }));
}

function titleOf(group) {
  const name = nameOf(group[0]);
  if (group.every((node) => nameOf(node) === name)) return name;
  return say('parts.count', { count: group.length });
}

/**
 * Chooses one of the variants.
 *
 * @param {{title: string, switches: (Node & {choices: string[]})[]}} variant
 * @param {{state: () => StateDocument, change: Commands['change']}} page
 * @returns {{element: HTMLElement, show: () => void}} shows the state
 */
export function variantControl({ title, switches }, { state, change }) {
  const present = () => switches.map(({ id, activeChild }) => state().nodes[id]?.activeChild ?? activeChild);
  const used = [...present(), ...switches.map(({ activeChild }) => activeChild)];
  const options = switches[0].choices.map((name, i) => [String(i), name || i + 1]);
  if (used.includes(-1)) options.push(['-1', say('parts.chooseNone')]);
  if (used.includes(-2)) options.push(['-2', say('parts.chooseAll')]);
  const set = async (value) => {
    for (let i = 0; i < switches.length; i += MOST_SWITCHED) {
      const some = switches.slice(i, i + MOST_SWITCHED);
      await change({ nodes: Object.fromEntries(some.map(({ id }) => [id, { activeChild: Number(value) }])) });
    }
  };
  const control = options.length > MOST_SEGMENTS ? selection(title, set) : choice(title, options, set);
  return {
    element: control.element,
    show() {
      const values = new Set(present());
      // Where they differ, none of the options is the case.
      control.show(values.size > 1 ? '' : String(...values), options);
    },
  };
}

/**
 * Opens and closes what turns about a hinge.
 *
 * @param {Node} node
 * @param {{state: () => StateDocument, commands: Pick<Commands, 'swing'>}} page
 * @returns {{element: HTMLElement, show: () => void}} shows the state
 */
export function doorControl(node, { state, commands }) {
  const control = toggle(nameOf(node), (open) => commands.swing(node.id, open ? 1 : 0));
  return { element: control.element, show: () => control.show(isOpen(node.id, state())) };
}
