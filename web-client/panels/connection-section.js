import { button, element } from '../base/element.js';
import { onChange } from '../base/store.js';
import { clientName, holderName, say, written } from '../base/texts.js';
import { fact, facts, range } from './controls.js';
import { each, joined, stateOf } from './section.js';

/**
 * @import { FrameHeader, ServerStats, StateDocument } from '../base/protocol.js'
 * @import { Store } from '../base/store.js'
 * @import { Commands } from '../connection/commands.js'
 * @import { Meter } from '../connection/meter.js'
 * @import { Page, Section } from './section.js'
 */

const LARGEST_SIDE = 8192;
const MEASURES_EVERY_MS = 500;
const KEEPS_FILE_MS = 60_000;

/**
 * Who steers, how pictures come, and what the server does besides.
 *
 * @param {Page} page
 * @returns {Section}
 */
export function connectionSection({ commands, meter, store, offer }) {
  const others = scenes({ commands, store, offer });
  return {
    name: 'connection',
    title: say('connection.title'),
    unfolded: others.unfolded,
    ...joined([steering(commands), pictures(commands, meter), files(commands, store), others]),
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
  const heading = element('h3', {}, say('connection.walls'));
  const walls = element('dl', { className: 'facts' });
  return {
    content: [about.element, element('div', { className: 'buttons' }, take, release), heading, walls],
    show: each(
      onChange(({ state, stats, client }) => [state.control, client, stats], (held, client, stats) =>
        about.show({ ...stats, holder: holderWords(held, client) })),
      onChange(({ steers }) => [steers], (steers) => {
        take.ariaDisabled = steers;
        release.ariaDisabled = !steers;
      }),
      onChange(({ stats, revision }) => [stats?.hosts, hasMembers(stats?.hosts) && revision], (hosts, revision) => {
        const lines = hostLines(hosts, revision);
        heading.hidden = lines.length === 0;
        walls.replaceChildren(...lines.map(({ name, words }) => fact(name, element('dd', {}, words))));
      })),
  };
}

/** @param {Commands} commands @param {Meter} meter */
function pictures({ change }, meter) {
  const about = facts({
    latency: say('connection.latency'),
    frames: say('connection.frames'),
    data: say('connection.data'),
  });
  const accuracy = (value) => say('quality.accuracy', { percent: 100 * value });
  const preferred = range(say('quality.preference'),
    { min: 0, max: 1, step: 0.05, say: accuracy }, (preference) => change({ quality: { preference } }));
  const level = element('p', { className: 'note', data: { fact: 'level' } });
  let timer;
  const measure = () => {
    clearTimeout(timer);
    const measured = meter.read(performance.now());
    about.show(pictureFacts(measured));
    // Nobody tells when pictures cease.
    if (measured.framesPerSecond > 0 && about.element.isConnected) timer = setTimeout(measure, MEASURES_EVERY_MS);
  };
  return {
    content: [about.element, preferred.element, level],
    show: each(
      onChange(({ header }) => [header], measure),
      onChange(({ state }) => [state.quality.preference], preferred.show),
      onChange(({ header }) => [header ? qualityWords(header.quality) : ''], (words) => {
        level.textContent = words;
      })),
  };
}

/** @param {Commands} commands @param {Store} store */
function files(commands, store) {
  const about = facts({ recording: say('recording.name') });
  const record = button('', () => commands.record(stateOf(store).recording ? 'stop' : 'start'), { icon: 'record' });
  const snapshot = button('', async () => {
    if (snapshot.ariaBusy === 'true') return;
    setBusy(true);
    const picture = await commands.snapshot(snapshotSize(/** @type {FrameHeader} */ (store.now.header).view));
    if (picture) save(picture.data);
    setBusy(false);
  }, { icon: 'camera' });
  // Not disabled, which would take the focus from it.
  const setBusy = (busy) => {
    snapshot.ariaBusy = busy;
    snapshot.lastChild.data = busy ? say('snapshot.drawing') : say('snapshot.save');
  };
  setBusy(false);
  return {
    content: [element('div', { className: 'buttons' }, snapshot, record), about.element],
    show: each(
      onChange(({ header }) => [!header], (disabled) => Object.assign(snapshot, { disabled })),
      onChange(({ state }) => [state.recording], (recording) => {
        record.lastChild.data = recording ? say('recording.stop') : say('recording.start');
        about.element.hidden = !recording;
        about.show({ recording: recording?.name });
      })),
  };
}

/** @param {Pick<Page, 'commands'|'store'|'offer'>} page */
function scenes({ commands, store, offer }) {
  let names = /** @type {?string[]} */ (null);
  const select = element('select');
  const label = element('label', { className: 'control' }, say('scenes.label'), select);
  const open = button(say('scenes.open'), () => show(select.value), { icon: 'open' });
  const row = element('div', { className: 'entry', hidden: true }, label, open);
  const none = element('p', { className: 'note', hidden: true }, say('scenes.none'));
  const asInFile = button(say('scenes.asInFile'), () => giveBack(), { icon: 'back' });

  const show = async (scene) => {
    const { file } = stateOf(store).scene;
    if (!await commands.open(scene)) return;
    // Another may be opened meanwhile, and this one be refused.
    if (await store.next(({ state }) => state?.scene.file, file) === scene) {
      offer(say('scenes.opened', { name: scene }), say('bar.back'), () => show(file));
    }
  };
  const giveBack = async () => {
    const before = stateOf(store);
    if (!await commands.patch({ views: null, markers: null, nodes: null })) return;
    const undo = () => commands.patch(backTo(before, stateOf(store)));
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
    content: [row, none, asInFile],
    unfolded: () => names && ask(),
    show: each(
      onChange(({ client }) => [client], (client) => client && ask()),
      onChange(({ state }) => [state.scene.file], list),
      onChange(({ state }) => [isAsInFile(state)], (hidden) => Object.assign(asInFile, { hidden }))),
  };
}

/**
 * Whether nothing that is kept of a scene differs from its file, as far as a client can tell.
 *
 * @param {Pick<StateDocument, 'views'|'markers'|'nodes'>} state
 */
export function isAsInFile({ views, markers, nodes }) {
  return !hasMembers(nodes) && !hasMembers(markers) && !Object.keys(views).some((name) => name !== 'home');
}

/**
 * The patch that makes what is kept of a scene what it was `before`.
 *
 * @param {Pick<StateDocument, 'views'|'markers'|'nodes'>} before
 * @param {Pick<StateDocument, 'views'|'markers'|'nodes'>} now
 */
export function backTo(before, now) {
  const all = (member) => ({ ...Object.fromEntries(Object.keys(now[member]).map((key) => [key, null])), ...before[member] });
  return { views: all('views'), markers: all('markers'), nodes: all('nodes') };
}

function hasMembers(object = {}) {
  return Object.keys(object).length > 0;
}

/**
 * How far each host is behind.
 *
 * @param {ServerStats['hosts']|undefined} hosts
 * @param {number} revision
 */
export function hostLines(hosts, revision) {
  return Object.entries(hosts ?? {}).map(([client, host]) =>
    ({ name: clientName({ client, name: host.name }), words: hostWords(host, revision) }));
}

/** @param {ReturnType<Meter['read']>} measured */
export function pictureFacts({ p50, p95, framesPerSecond, bytesPerSecond }) {
  return {
    latency: p50 && `${written(p50)} ms, ${written(p95)} ms`,
    frames: written(framesPerSecond, 1),
    data: `${bytesWords(bytesPerSecond)} / s`,
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

/** How far a host is behind. @param {{revision: number, lagMs?: number}} host @param {number} revision */
export function hostWords({ revision: shown, lagMs }, revision) {
  const words = shown < revision ? say('connection.behind', { count: revision - shown }) : say('connection.upToDate');
  return lagMs === undefined ? words : `${words} · ${written(lagMs)} ms`;
}

/** @param {FrameHeader['quality']} quality */
export function qualityWords({ level, scale, samples, detail, jpegQuality, error = NaN }) {
  const flip = error > 0 && error < 1e-3 ? `< ${written(1e-3, 3)}` : written(error, 3);
  return [
    level === 'still' ? say('quality.still') : say('quality.moving'),
    samples > 1 && say('quality.samples', { count: samples }),
    scale < 1 ? say('quality.scale', { percent: 100 * scale }) : say('quality.fullSize'),
    detail > 0 && say('quality.detail', { pixels: written(detail, 2) }),
    `JPEG ${jpegQuality}`,
    error >= 0 && say('quality.error', { flip }),
  ].filter(Boolean).join(' · ');
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

export function bytesWords(bytes) {
  return bytes < 1e6 ? `${written(bytes / 1e3)} kB` : `${written(bytes / 1e6, 1)} MB`;
}

function save(data) {
  const href = URL.createObjectURL(new Blob([data], { type: 'image/jpeg' }));
  element('a', { href, download: snapshotName(new Date()) }).click();
  setTimeout(() => URL.revokeObjectURL(href), KEEPS_FILE_MS);
}
