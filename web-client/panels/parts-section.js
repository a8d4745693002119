import { button, element } from '../base/element.js';
import { onChange } from '../base/store.js';
import { say } from '../base/texts.js';
import { allOf } from '../connection/commands.js';
import { stateOf } from './section.js';
import { doorControl, nameOf, variantControl, variants } from './variants.js';

/**
 * @import { Page, Section } from './section.js'
 * @import { Node } from './variants.js'
 */

const MOST_ROWS = 50; // before somebody asks for more, or as a page has them
const SEARCH_AFTER_MS = 250;

/**
 * The scene's variants, doors and parts, asked for when looked at, and anew with each whole state.
 *
 * @param {Page} page
 * @returns {Section}
 */
export function partsSection({ commands, store }) {
  const { change } = commands;
  const state = () => stateOf(store);
  let scene;
  /** What shows a part of the state, and how it is brought up to date. */
  const followers = new Map();

  const all = say('parts.all');
  const choices = element('div', { className: 'choices' });
  const tree = element('div');
  const asInFile = button(say('parts.asInFile'), async () => {
    await change({}); // by itself, or what waits with it would take its place
    commands.patch({ nodes: null });
  });

  function look() {
    const present = store.now.state?.scene;
    if (!present || !choices.closest('details').open) return;
    if (scene !== present) {
      scene = present;
        choices.replaceChildren();
      listParts();
      loadChoices();
    }
    refresh();
  }

  function follow(made, show) {
    followers.set(made, show);
    return made;
  }

  function refresh() {
    for (const [made, show] of followers) {
      if (made.isConnected) show(state());
      else followers.delete(made);
    }
    asInFile.ariaDisabled = Object.keys(state().nodes).length === 0;
  }

  /** Adds rows of what a `tree` message finds, and one for more; a list that is gone is left alone. */
  async function fill(rows, query) {
    const enough = rows.childElementCount + MOST_ROWS;
    let { after } = query;
    // A page may be empty, and yet not the last.
    do {
      const answer = await commands.tree({ ...query, after });
      if (!answer || !rows.isConnected) return;
      rows.append(...answer.nodes.filter(({ id, parent }) => parent !== undefined && id !== query.node).map(row));
      refresh();
      after = answer.next;
    } while (after !== undefined && rows.childElementCount < enough);
    if (query.search) {
      const count = `${rows.childElementCount}${after === undefined ? '' : '+'}`;
      found.textContent = say('parts.found', { count });
    }
    if (after === undefined) return;
    const more = element('li', { className: 'buttons' }, button(say('parts.more'), () => {
      more.previousElementSibling.querySelector('[aria-pressed]').focus();
      more.remove();
      fill(rows, { ...query, after });
    }));
    rows.append(more);
  }

  function row(node) {
    const { id } = node;
    const name = nameOf(node);
    let active;
    const choose = button(name, () => change({ selection: { node: state().selection.node === id ? null : id } }),
      { quiet: true });
    const see = tool('seen', '', () => change({ nodes: { [id]: { active: !active } } }));
    const fit = tool('fit', say('parts.fit', { name }), () => commands.fit(id));
    const line = element('div', { className: 'row' }, choose, see, fit);
    const item = element('li', {}, line);
    if (node.children > 0) line.prepend(unfolder(item, id, name));

    let before;
    return follow(item, ({ nodes, selection: { node: selected } }) => {
      const changed = nodes[id]?.active;
      // The answer told what was so then; an entry differs from the file, which has the other.
      if (changed !== undefined) node.active = !changed;
      active = changed ?? node.active;
      const now = `${active} ${selected === id}`;
      if (now === before) return;
      before = now;
      choose.ariaPressed = selected === id;
      item.classList.toggle('off', !active);
      see.querySelector('use').setAttribute('href', active ? '#icon-seen' : '#icon-hidden');
      see.title = active ? say('parts.hide', { name }) : say('parts.show', { name });
      see.ariaLabel = see.title;
    });
  }

  function unfolder(item, id, name) {
    const label = say('parts.unfold', { name });
    const unfold = tool('open', label, () => {
      const below = item.querySelector('ul');
      unfold.ariaExpanded = !below;
      if (below) below.remove();
      else fill(item.appendChild(list(label)), { node: id });
    });
    unfold.ariaExpanded = false;
    return unfold;
  }

  let timer;
  const field = element('input', {
    type: 'search', placeholder: say('parts.search'), ariaLabel: say('parts.search'),
    autocomplete: 'off',
    oninput() {
      clearTimeout(timer);
      timer = setTimeout(listParts, SEARCH_AFTER_MS);
    },
    onkeydown(event) {
      if (event.key !== 'Escape' || !field.value) return;
      event.preventDefault(); // the menu stays open
      clear();
    },
  });
  const box = element('div', { className: 'entry' }, field,
    tool('close', say('parts.clearSearch'), clear));
  const found = element('p', { className: 'note', role: 'status' });

  function clear() {
    field.value = '';
    field.focus();
    listParts();
  }

  /** The tree, or what is found instead of it. */
  function listParts() {
    clearTimeout(timer);
    const search = field.value.trim();
    found.textContent = '';
    tree.replaceChildren(list(all));
    fill(tree.firstChild, search ? { search } : {});
    // Above a keyboard on the screen.
    if (search) box.scrollIntoView();
  }

  async function loadChoices() {
    const asked = scene;
    const switches = await allOf(commands.tree, { only: 'switches' });
    const doors = switches && await allOf(commands.tree, { only: 'hinges' });
    if (!doors || asked !== scene) return;
    addChoices(say('parts.variants'), variants(switches).map((variant) => {
      const { element: made, show } = variantControl(variant, { change, state });
      return follow(made, show);
    }));
    addChoices(say('parts.doors'), doors.map(door));
    refresh();
  }

  function addChoices(title, controls) {
    if (controls.length > 0) choices.append(element('h3', {}, title), ...controls);
  }

  function door(node) {
    const { element: made, show } = doorControl(node, { commands, state });
    return follow(made, show);
  }

  return {
    name: 'parts',
    title: say('parts.title'),
    content: [choices, element('div', { className: 'control' }, element('h3', {}, all), asInFile), box, found, tree],
    unfolded: look,
    show: onChange(({ state: { scene: whole, nodes, selection: chosen } }) => [whole, nodes, chosen], look),
  };
}

function list(label) {
  return element('ul', { className: 'tree', ariaLabel: label });
}

function tool(icon, label, act) {
  return button(label, act, { icon, quiet: true, only: true });
}
