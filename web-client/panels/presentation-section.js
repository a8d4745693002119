import { added, isNone } from '../base/added.js';
import { download } from '../base/download.js';
import { button, element } from '../base/element.js';
import { onChange } from '../base/store.js';
import { holderName, say } from '../base/texts.js';
import { gentleWalls } from './comfort.js';
import { choice, facts } from './controls.js';
import { pointing } from './pointing.js';
import { each, joined, stateOf } from './section.js';

/**
 * @import { FrameHeader, StateDocument } from '../base/protocol.js'
 * @import { Store } from '../base/store.js'
 * @import { Commands } from '../connection/commands.js'
 * @import { Page, Section } from './section.js'
 */

const LARGEST_SIDE = 8192;

/**
 * Who is in control, the picture as a file, and what scene is shown.
 *
 * @param {Page} page
 * @returns {Section}
 */
export function presentationSection(page) {
  const { commands, store } = page;
  const others = scenes(page);
  return {
    name: 'presentation',
    title: say('presentation.title'),
    unfolded: others.unfolded,
    ...joined([steering(commands), pointing(page), gentleWalls(page), snapshot(commands, store), others]),
  };
}

/** @param {Commands} commands */
function steering({ control }) {
  const about = facts({
    holder: say('control.holder'),
    clients: say('connection.clients'),
    watchers: say('connection.watchers'),
  });
  const take = button(say('control.take'), () => control({ action: 'take' }), { icon: 'hand' });
  const release = button(say('control.release'), () => control({ action: 'release' }));
  return {
    content: [about.element, element('div', { className: 'buttons' }, take, release)],
    show: each(
      onChange(({ state, stats, client }) => [state.control, client, stats], (held, client, stats) =>
        about.show({ ...stats, holder: holderWords(held, client) })),
      onChange(({ steers }) => [steers], (steers) => {
        take.ariaDisabled = steers;
        release.ariaDisabled = !steers;
      })),
  };
}

/** @param {Commands} commands @param {Store} store */
function snapshot(commands, store) {
  const made = button('', async () => {
    if (made.ariaBusy === 'true') return;
    setBusy(true);
    const picture = await commands.snapshot(snapshotSize(/** @type {FrameHeader} */ (store.now.header).view));
    if (picture) download(picture.data, 'image/jpeg', snapshotName(new Date()));
    setBusy(false);
  }, { icon: 'camera' });
  // Not disabled, which would take the focus from it.
  const setBusy = (busy) => {
    made.ariaBusy = busy;
    made.lastChild.data = busy ? say('snapshot.drawing') : say('snapshot.save');
  };
  setBusy(false);
  return {
    content: [made],
    show: onChange(({ header }) => [!header], (disabled) => Object.assign(made, { disabled })),
  };
}

/** @param {Pick<Page, 'commands'|'store'|'offer'|'openDialog'>} page */
function scenes({ commands, store, offer, openDialog }) {
  let names = /** @type {?string[]} */ (null);
  const select = element('select');
  const label = element('label', { className: 'control' }, say('scenes.label'), select);
  const open = button(say('scenes.open'), () => show(select.value), { icon: 'open' });
  const row = element('div', { className: 'entry', hidden: true }, label, open);
  const none = element('p', { className: 'note', hidden: true }, say('scenes.none'));
  const upAxis = choice(say('scenes.upAxis'), [['y', 'Y'], ['z', 'Z']], (axis) => turn(axis));
  const asInFile = button(say('scenes.asInFile'), () => giveBack(), { icon: 'back' });
  const remove = button(say('deletion.open'), () => openDialog('deletion', remove), { icon: 'remove' });
  remove.ariaHasPopup = 'dialog';

  const show = async (scene) => {
    const { file } = stateOf(store).scene;
    if (!await commands.open(scene)) return;
    // Another may be opened meanwhile, and this one be refused.
    if (await store.next(({ state }) => state?.scene.file, file) === scene) {
      offer(say('scenes.opened', { name: scene }), say('bar.back'), () => show(file));
    }
  };
  /**
   * Does not wait until the scene is shown: it may still be refused.
   *
   * @param {*} axis
   * @param {Pick<StateDocument['scene'], 'file'|'upAxis'>} [scene]
   */
  const turn = async (axis, { file, upAxis: before } = stateOf(store).scene) => {
    if (!await commands.open(file, axis)) return;
    store.next(({ state }) => state?.scene.upAxis, before).then(() => {
      if (stateOf(store).scene.file !== file) return;
      offer(say('scenes.turned', { axis: axis.toUpperCase() }), say('views.undo'), () => turn(before, { file, upAxis: axis }));
    });
  };
  const giveBack = async () => {
    const { nodes, views: { home } } = stateOf(store);
    if (!await commands.patch({ nodes: null, views: { home: null } })) return;
    const undo = () => {
      const since = Object.keys(stateOf(store).nodes).map((id) => [id, null]);
      return commands.patch({ nodes: { ...Object.fromEntries(since), ...nodes }, views: { home } });
    };
    offer(say('scenes.isAsInFile'), say('views.undo'), undo);
  };
  const list = () => {
    const shown = store.now.state?.scene.file;
    if (!names) return;
    const text = (name) => (name === shown ? say('scenes.shown', { name }) : name);
    const chosen = names.includes(select.value) && select.value !== shown ? select.value : shown;
    select.replaceChildren(...names.map((name) => new Option(text(name), name, false, name === chosen)));
    row.hidden = !names.some((name) => name !== shown);
    none.hidden = !row.hidden;
  };
  const ask = async () => {
    names = (await commands.scenes())?.scenes ?? names;
    list();
  };
  return {
    content: [row, none, upAxis.element, asInFile, remove],
    unfolded: () => names && ask(),
    show: each(
      onChange(({ client }) => [client], (client) => client && ask()),
      onChange(({ state }) => [state.scene.file], list),
      onChange(({ state }) => [state.scene], ({ upAxis: axis }) => {
        upAxis.element.hidden = !axis;
        upAxis.show(axis);
      }),
      onChange(({ state }) => [Object.keys(state.nodes).length === 0], (hidden) => Object.assign(asInFile, { hidden })),
      onChange(({ state }) => [isNone(added(state))], (hidden) => Object.assign(remove, { hidden }))),
  };
}

/**
 * Who is in control, for the page of `client`.
 *
 * @param {StateDocument['control']|undefined} control
 * @param {string|undefined} client
 */
export function holderWords(control, client) {
  if (!control?.holder) return say('control.nobody');
  return control.holder === client ? say('control.you') : holderName(control);
}

/** As many pixels as the server draws. @param {FrameHeader['view']} view */
export function snapshotSize({ width, height, pixelRatio }) {
  const scale = Math.min(pixelRatio, LARGEST_SIDE / width, LARGEST_SIDE / height);
  const side = (length) => Math.max(1, Math.round(length * scale));
  return { width: side(width), height: side(height) };
}

/** scene-YYYYMMDD-HHMMSS.jpg, by the user's clock. */
export function snapshotName(date) {
  // Swedish has the order of ISO 8601: 2026-03-04 05:06:07.
  return `scene-${date.toLocaleString('sv').replace(/[-:]/g, '').replace(' ', '-')}.jpg`;
}
