import { button, element } from '../base/element.js';
import { isOpen } from '../base/hinges.js';
import { say } from '../base/texts.js';
import { allOf } from '../connection/commands.js';

/**
 * @import { ServerTree, StateDocument } from '../base/protocol.js'
 * @import { Now } from '../base/store.js'
 * @import { Commands } from '../connection/commands.js'
 */

const MOST_PATCHED = 1000; // by one patch, which so stays below the protocol's 64 KiB
const UNSEEN = new Set(['light', 'camera', 'background']);

/** The selected part: its path, what can be done with it, and what shows again what was hidden here. */
export class PartBar {
  #element;
  #path;
  #commands;
  #leave;
  #hidden = new Hidden();
  /** @type {Pick<Now, 'role'|'state'>} */
  #now = { state: null };
  #scene = '';
  #shown = '';

  /**
   * `element` holds one for the path; `leave` gives the focus away when nothing here can have it.
   *
   * @param {HTMLElement} element
   * @param {{commands: Commands, leave: () => void}} page
   */
  constructor(element, { commands, leave }) {
    this.#element = element;
    this.#path = /** @type {HTMLElement} */ (element.firstElementChild);
    this.#commands = commands;
    this.#leave = leave;
    new ResizeObserver(() => this.#shorten()).observe(element);
  }

  /** @param {Pick<Now, 'role'|'state'|'language'>} now */
  show({ role, state, language }) {
    this.#now = { role, state };
    const scene = JSON.stringify(state?.scene);
    if (scene !== this.#scene) this.#hidden = new Hidden();
    this.#scene = scene;
    const steps = levels(state?.selection ?? {});
    const may = role === 'control';
    const back = may && Object.keys(this.#hidden.back(state?.nodes ?? {})).length > 0;
    const hinge = state?.selection?.hinge;
    const open = hinge !== undefined && isOpen(hinge, /** @type {StateDocument} */ (state));
    const shown = JSON.stringify([steps, may, back, hinge, open, language]);
    if (shown === this.#shown) return;
    this.#shown = shown;
    const hadFocus = this.#element.contains(document.activeElement);
    this.#element.ariaLabel = say('part.label');
    this.#showPath(steps, may);
    while (this.#path.nextSibling) this.#path.nextSibling.remove();
    if (may && steps.length > 0) this.#element.append(...this.#actions(hinge, open));
    if (back) this.#element.append(button(say('part.showAll'), () => this.#showHidden(), { icon: 'seen' }));
    this.#shorten();
    if (hadFocus) (this.#element.querySelector('button') ?? { focus: this.#leave }).focus();
  }

  #showPath(steps, may) {
    const parts = steps.map(({ id, name }, i) => (may && i < steps.length - 1
      ? button(name, () => this.#select(id), { quiet: true }) : element('span', {}, name)));
    const last = parts.at(-1);
    if (last) last.ariaCurrent = 'true';
    // Only a change: screen readers read it again.
    if (this.#path.textContent !== steps.map(({ name }) => name).join('')) this.#path.replaceChildren(...parts);
    else for (const [i, part] of parts.entries()) this.#path.children[i].replaceWith(part);
  }

  /** @param {number|undefined} hinge the part's, or that of what it belongs to @param {boolean} open */
  #actions(hinge, open) {
    const { node } = /** @type {StateDocument} */ (this.#now.state).selection;
    return [
      button(say('part.clear'), () => this.#select(null), { icon: 'close', quiet: true, only: true }),
      button(say('part.fit'), () => this.#commands.fit(node)),
      button(say('part.hide'), () => this.#hide([node], { selection: { node: null } })),
      button(say('part.isolate'), () => this.#isolate()),
      ...(hinge === undefined ? []
        : [button(say(open ? 'part.close' : 'part.open'), () => this.#commands.swing(hinge, open ? 0 : 1))]),
    ];
  }

  /** The outermost levels go until the rest has room. */
  #shorten() {
    const above = /** @type {HTMLElement[]} */ ([...this.#path.children]).slice(0, -1);
    const { classList } = this.#path;
    for (const level of above) level.hidden = false;
    classList.remove('shortened', 'alone');
    for (const level of above) {
      if (this.#path.scrollWidth <= this.#path.clientWidth) return;
      level.hidden = true;
      classList.add('shortened');
    }
    classList.add('alone');
  }

  #select(node) {
    this.#commands.change({ selection: { node } });
  }

  /** Together with what else is to change. */
  async #hide(ids, also = {}) {
    const { nodes } = /** @type {StateDocument} */ (this.#now.state);
    this.#hidden.add(ids, nodes);
    await this.#patch(ids.map((id) => [id, { active: false }]), also);
  }

  /** The background and the light in use stay, or the scene would look like another. */
  async #isolate() {
    const { selection, backgrounds, lights } = /** @type {StateDocument} */ (this.#now.state);
    const tree = (query) => allOf(this.#commands.tree, query);
    const kept = new Set();
    const parents = new Set();
    for (let id of [selection.node, Number(backgrounds.active), Number(lights.active)].filter(Number.isInteger)) {
      while (id !== undefined && !kept.has(id)) {
        kept.add(id);
        const [node] = await tree({ node: id, depth: 0 }) ?? [];
        if (!node) return;
        id = node.parent;
        if (id !== undefined) parents.add(id);
      }
    }
    const ids = [];
    for (const id of parents) {
      const nodes = await tree({ node: id });
      if (!nodes) return;
      ids.push(...besides(kept, nodes, this.#now.state?.nodes ?? {}));
    }
    await this.#hide(ids);
  }

  #showHidden() {
    const { nodes } = /** @type {StateDocument} */ (this.#now.state);
    return this.#patch(Object.entries(this.#hidden.back(nodes)));
  }

  async #patch(entries, also = {}) {
    for (let i = 0; i < entries.length; i += MOST_PATCHED) {
      await this.#commands.change({ nodes: Object.fromEntries(entries.slice(i, i + MOST_PATCHED)), ...also });
    }
  }
}

/**
 * {id, name} of what the selection lies in, from the outermost, and last of itself; the scene itself is left out.
 *
 * @param {StateDocument['selection']} selection
 */
export function levels({ node, name, path = [], pathIds = [] }) {
  if (node === undefined) return [];
  const all = path.map((level, i) => ({ id: pathIds[i], name: level || `#${pathIds[i]}` })).slice(1);
  return all.length > 0 ? all : [{ id: node, name: name || `#${node}` }];
}

/**
 * The ids of what is shown beside the nodes `kept`, of a parent and its children as `tree` tells them, and of the
 * state's nodes. Of the children of a switch or a LOD none is: they stand for one another.
 *
 * @param {Set<number>} kept
 * @param {ServerTree['nodes']} nodes
 * @param {StateDocument['nodes']} changed
 */
export function besides(kept, [parent, ...children], changed) {
  const chosen = changed[parent.id]?.activeChild ?? parent.activeChild;
  if (parent.type === 'lod' || (parent.type === 'switch' && chosen !== -2)) return [];
  return children.filter(({ id, type, active }) => active && !kept.has(id) && !UNSEEN.has(type)).map(({ id }) => id);
}

/** What was hidden, with what the state's nodes had of it before. */
export class Hidden {
  /** @type {Map<string, boolean|undefined>} */
  #before = new Map();

  /** @param {(number|string)[]} ids @param {StateDocument['nodes']} nodes before it */
  add(ids, nodes) {
    for (const id of ids.map(String)) if (!this.#before.has(id)) this.#before.set(id, nodes[id]?.active);
  }

  /**
   * The nodes of a patch that shows again what still is hidden.
   *
   * @param {StateDocument['nodes']} nodes
   */
  back(nodes) {
    const changed = [...this.#before].filter(([id, active]) => nodes[id]?.active !== active);
    return Object.fromEntries(changed.map(([id, active]) => [id, { active: active ?? null }]));
  }
}
