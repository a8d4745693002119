import { button, element } from '../../base/element.js';
import { onChange } from '../../base/store.js';
import { clientName, say } from '../../base/texts.js';
import { behindWords } from '../comfort.js';
import { byName, rows } from '../controls.js';
import { each } from '../section.js';

/**
 * @import { ClientControl, ServerShared, ServerStats, StateDocument } from '../../base/protocol.js'
 * @import { Page } from '../section.js'
 */

/** Light around a QR code, in modules. */
const QUIET_ZONE = 4;

/**
 * Somebody in the list. A message is one of `control` without its type.
 *
 * @typedef {{name: string, words: string[], actions: {label: string, message: Omit<ClientControl, 'type'>}[]}} Person
 */

/** Who is here, and how others can watch. @param {Page} page */
export function people({ commands }) {
  const here = present(commands);
  const invitation = invite(commands);
  return {
    title: say('people.title'),
    content: [
      element('div', { className: 'sides' }, element('section', {}, ...here.content), element('section', {}, ...invitation.content)),
    ],
    show: each(here.show, invitation.show),
  };
}

function present({ control }) {
  const list = rows(say('people.title'), '', () => {
    const name = element('span', { className: 'name' });
    const words = element('span', { className: 'note' });
    const actions = element('div', { className: 'buttons' });
    let shown = '';
    return {
      children: [element('div', {}, name, words), actions],
      show(person) {
        name.textContent = person.name;
        words.textContent = person.words.join(' · ');
        if (JSON.stringify(person) === shown) return;
        shown = JSON.stringify(person);
        const hadFocus = actions.contains(document.activeElement);
        actions.replaceChildren(...person.actions.map(({ label, message }) => {
          const made = button(label, () => control(message));
          made.ariaLabel = `${label}: ${person.name}`;
          return made;
        }));
        if (hadFocus) (actions.querySelector('button') ?? /** @type {HTMLElement} */ (list.element.firstElementChild)).focus();
      },
    };
  });
  const others = element('p', { className: 'note', role: 'status' });
  return {
    content: [list.element, others],
    show: each(
      onChange(({ state, client }) => [state.clients, state.control, client, behindWords(state.walls)],
        (clients, control, client, behind) => list.show(personRows({ clients, control }, client, behind))),
      onChange(({ state, stats, language }) => [state.clients, stats, language], (clients, stats) => {
        const count = furtherWatchers(clients, stats);
        others.textContent = count > 0 ? say('people.further', { count }) : '';
      })),
  };
}

/**
 * [client, person] of each who is here, for the page of `client`: who is in control first, then who may be, hosts, and
 * who only watches.
 *
 * @param {Pick<StateDocument, 'clients'|'control'>} state
 * @param {string} [client]
 * @param {string} [behind] how far hosts are
 * @returns {[string, Person][]}
 */
export function personRows({ clients, control }, client, behind = '') {
  const { holder, asking } = control;
  // Who has lost the connection is not here, and in control all the same.
  const away = control.absent && holder ? { [holder]: { name: control.name, role: /** @type {const} */ ('control') } } : {};
  const all = Object.entries({ ...away, ...clients }).map(([id, { name, role }]) => ({ id, role, name: clientName({ client: id, name }) }));
  const asks = new Set(asking.map((one) => one.client));
  const rank = ({ id, role }) => (id === holder ? -1 : ['control', 'host', 'view'].indexOf(role));
  const words = ({ id, role }) => [
    id === client && say('people.you'),
    id === holder && say('people.holder'),
    id in away && say('people.absent'),
    asks.has(id) && say('people.asks'),
    role === 'host' && say('people.wall'),
    role === 'host' && behind !== '' && behind,
    role === 'view' && say('people.watches'),
  ].filter((word) => word !== false);
  return all.sort((a, b) => rank(a) - rank(b) || byName(a.name, b.name)).map((one) =>
    [one.id, { name: one.name, words: words(one), actions: one.role === 'control' ? actions({ ...one, holder, client, asks }) : [] }]);
}

/**
 * What the page of `client` can do about control, in the row of another or of the holder.
 *
 * @returns {Person['actions']}
 */
function actions({ id, holder, client, asks }) {
  if (holder === client && id !== client) {
    /** @type {Person['actions']} */
    const give = [{ label: say('control.give'), message: { action: 'give', client: id } }];
    return asks.has(id) ? [...give, { label: say('control.decline'), message: { action: 'decline', client: id } }] : give;
  }
  if (id !== holder || holder === client) return [];
  return [asks.has(client)
    ? { label: say('control.cancel'), message: { action: 'cancel' } }
    : { label: say('control.ask'), message: { action: 'ask' } }];
}

/**
 * How many watch whom the state does not name.
 *
 * @param {StateDocument['clients']} clients
 * @param {?ServerStats} stats
 */
export function furtherWatchers(clients, stats) {
  const named = Object.values(clients).filter(({ role }) => role === 'view').length;
  return Math.max(0, (stats?.watchers ?? 0) - named);
}

function invite({ share }) {
  const code = button('', () => enlarge(code.ariaExpanded !== 'true'));
  code.className = 'code';
  const enlarge = (isLarge) => {
    code.ariaExpanded = String(isLarge);
    code.ariaLabel = isLarge ? say('people.smaller') : say('people.larger');
  };
  code.onkeydown = (event) => {
    if (event.key !== 'Escape' || code.ariaExpanded !== 'true') return;
    event.preventDefault(); // the dialog stays open
    enlarge(false);
  };
  enlarge(false);
  const address = element('p', { className: 'address' });
  const copied = element('span', { role: 'status', className: 'note' });
  const copy = button(say('people.copy'), async () => {
    await navigator.clipboard.writeText(/** @type {string} */ (address.textContent));
    copied.textContent = say('people.copied');
  });
  const only = element('p', { className: 'note' }, say('people.loopback'));
  const told = element('div', { hidden: true }, code,
    element('p', {}, say('people.inviteText')), address,
    // Browsers have one where the page came by HTTPS or from this machine.
    ...(navigator.clipboard ? [element('div', { className: 'copy' }, copy, copied)] : []), only);
  const ask = async () => {
    const shared = await share(new URL('.', location.href).href);
    if (!shared) return;
    code.innerHTML = qrPicture(shared.qr);
    address.textContent = shared.address;
    only.hidden = !shared.loopback;
    told.hidden = false;
  };
  return {
    content: [element('h3', {}, say('people.invite')), told],
    show: onChange(({ client }) => [client], (client) => client && ask()),
  };
}

/** The code as SVG, dark as the text. @param {ServerShared['qr']} rows */
export function qrPicture(rows) {
  const path = rows.map((row, y) => [...row.matchAll(/1+/g)]
    .map(({ index, 0: { length } }) => `M${index} ${y}h${length}v1h-${length}z`).join('')).join('');
  const side = rows.length + 2 * QUIET_ZONE;
  const box = [-QUIET_ZONE, -QUIET_ZONE, side, side].join(' ');
  return `<svg viewBox="${box}" shape-rendering="crispEdges" aria-hidden="true"><path d="${path}"/></svg>`;
}
