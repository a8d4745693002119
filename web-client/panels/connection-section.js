import { clientName, holderName } from '../base/client-names.js';
import { button, element } from '../base/element.js';
import { say, written } from '../base/texts.js';
import { fact, facts, joined, range } from './controls.js';

const LARGEST_SIDE = 8192;
const MEASURES_EVERY_MS = 500;
const KEEPS_FILE_MS = 60_000;

/** Who steers, how pictures come, and what the server does besides. */
export function connectionSection({ change, ask, report, meter, state, header }) {
  const tell = (message) => ask(message).catch(report);
  const others = scenes(tell);
  return {
    ...others,
    name: 'connection',
    title: say('connection.title'),
    ...joined([steering(tell), pictures(change, meter), files(tell, state, header), others]),
  };
}

function steering(tell) {
  const about = facts({
    holder: say('control.holder'),
    clients: say('connection.clients'),
    watchers: say('connection.watchers'),
  });
  const control = (action) => () => tell({ type: 'control', action });
  const take = button(say('control.take'), control('take'), { icon: 'hand' });
  const release = button(say('control.release'), control('release'));
  const heading = element('h3', {}, say('connection.walls'));
  const walls = element('dl', { className: 'facts' });
  return {
    content: [about.element, element('div', { className: 'buttons' }, take, release), heading, walls],
    show({ state, stats, client, steers, revision }) {
      const { hosts = {}, ...counts } = stats ?? {};
      about.show({ ...counts, holder: holderWords(state.control, client) });
      take.ariaDisabled = steers;
      release.ariaDisabled = !steers;
      const lines = Object.entries(hosts).map(([id, host]) =>
        fact(clientName({ client: id, name: host.name }), element('dd', {}, hostWords(host, revision))));
      heading.hidden = lines.length === 0;
      walls.replaceChildren(...lines);
    },
  };
}

function pictures(change, meter) {
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
    const { p50, p95, framesPerSecond, bytesPerSecond } = meter.read(performance.now());
    about.show({
      latency: p50 && `${written(p50)} ms, ${written(p95)} ms`,
      frames: written(framesPerSecond, 1),
      data: `${bytesWords(bytesPerSecond)} / s`,
    });
    // Nobody tells when pictures cease.
    if (framesPerSecond > 0 && about.element.isConnected) timer = setTimeout(measure, MEASURES_EVERY_MS);
  };
  return {
    content: [about.element, preferred.element, level],
    show({ state, header }) {
      measure();
      preferred.show(state.quality.preference);
      level.textContent = header ? qualityWords(header.quality) : '';
    },
  };
}

function files(tell, present, drawn) {
  const about = facts({ recording: say('recording.name') });
  const record = button('', () => tell({ type: 'record', action: present().recording ? 'stop' : 'start' }),
    { icon: 'record' });
  const snapshot = button('', async () => {
    if (snapshot.ariaBusy === 'true') return;
    setBusy(true);
    const picture = await tell({ type: 'snapshot', ...snapshotSize(drawn().view), jpegQuality: 95 });
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
    show({ state: { recording }, header }) {
      snapshot.disabled = !header;
      record.lastChild.data = recording ? say('recording.stop') : say('recording.start');
      about.element.hidden = !recording;
      about.show({ recording: recording?.name });
    },
  };
}

function scenes(tell) {
  let askedBy;
  const select = element('select');
  const label = element('label', { className: 'control' }, say('scenes.label'), select);
  const open = button(say('scenes.open'), () => tell({ type: 'open', scene: select.value }), { icon: 'open' });
  const row = element('div', { className: 'entry', hidden: true }, label, open);
  const none = element('p', { className: 'note', hidden: true }, say('scenes.none'));
  const unfolded = async () => {
    const answer = askedBy && await tell({ type: 'scenes' });
    if (!answer) return;
    select.replaceChildren(...answer.scenes.map((name) => new Option(name, name, false, name === select.value)));
    none.hidden = answer.scenes.length > 0;
    row.hidden = !none.hidden;
  };
  return {
    content: [row, none],
    unfolded,
    show({ client }) {
      if (!client || client === askedBy) return;
      askedBy = client;
      unfolded();
    },
  };
}

/** Who is in control, by `control` of the state, for the page of `client`. */
export function holderWords(control, client) {
  if (!control?.holder) return say('control.nobody');
  return control.holder === client ? say('control.you') : holderName(control);
}

/** How far a host is behind. */
export function hostWords({ revision: shown, lagMs }, revision) {
  const words = shown < revision ? say('connection.behind', { count: revision - shown }) : say('connection.upToDate');
  return lagMs === undefined ? words : `${words} · ${written(lagMs)} ms`;
}

/** By a header's `quality`. */
export function qualityWords({ level, scale, samples, detail, jpegQuality, error }) {
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

/** As many pixels as the server draws. */
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
