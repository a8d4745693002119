import { button, element } from '../../base/element.js';
import { onChange } from '../../base/store.js';
import { clientName, say, written } from '../../base/texts.js';
import { fact, facts, range } from '../controls.js';
import { each, joined, section, stateOf } from '../section.js';

/**
 * @import { FrameHeader, ServerStats } from '../../base/protocol.js'
 * @import { Commands } from '../../connection/commands.js'
 * @import { Meter } from '../../connection/meter.js'
 * @import { Page, Section } from '../section.js'
 */

const MEASURES_EVERY_MS = 500;

/**
 * What the server does besides: how it draws, what it records, and last the numbers for developers.
 *
 * @param {Page} page
 * @returns {Section[]}
 */
export function connectionSections({ commands, meter, store }) {
  return [
    quality(commands),
    recording(commands, () => stateOf(store)),
    { name: 'connection', title: say('connection.title'), ...joined([pictures(meter), walls()]) },
  ];
}

/** @param {Commands} commands */
function quality({ change }) {
  const accuracy = (value) => say('quality.accuracy', { percent: 100 * value });
  const preferred = range(say('quality.preference'),
    { min: 0, max: 1, step: 0.05, say: accuracy }, (preference) => change({ quality: { preference } }));
  return section('quality', say('quality.title'), [preferred, (state) => [state.quality.preference]]);
}

/** @param {Commands} commands */
function recording({ record }, present) {
  const about = facts({ recording: say('fact.name') });
  const turn = button('', () => record(present().recording ? 'stop' : 'start'), { icon: 'record' });
  return {
    name: 'recording',
    title: say('recording.title'),
    content: [turn, about.element],
    show: onChange(({ state }) => [state.recording], (recorded) => {
      turn.lastChild.data = recorded ? say('recording.stop') : say('recording.start');
      about.element.hidden = !recorded;
      about.show({ recording: recorded?.name });
    }),
  };
}

/** @param {Meter} meter */
function pictures(meter) {
  const about = facts({
    latency: say('connection.latency'),
    frames: say('connection.frames'),
    data: say('connection.data'),
  });
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
    content: [about.element, level],
    show: each(
      onChange(({ header }) => [header], measure),
      onChange(({ header }) => [header ? qualityWords(header.quality) : ''], (words) => {
        level.textContent = words;
      })),
  };
}

function walls() {
  const heading = element('h3', {}, say('connection.walls'));
  const list = element('dl', { className: 'facts' });
  return {
    content: [heading, list],
    show: onChange(({ stats, revision }) => [stats?.hosts, Object.keys(stats?.hosts ?? {}).length > 0 && revision],
      (hosts, revision) => {
        const lines = hostLines(hosts, revision);
        heading.hidden = lines.length === 0;
        list.replaceChildren(...lines.map(({ name, words }) => fact(name, element('dd', {}, words))));
      }),
  };
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
    latency: p50 && `${written(p50, 0, 'ms')}, ${written(p95, 0, 'ms')}`,
    frames: written(framesPerSecond, 1),
    data: `${bytesWords(bytesPerSecond)}/s`,
  };
}

/** How far a host is behind. @param {{revision: number, lagMs?: number}} host @param {number} revision */
export function hostWords({ revision: shown, lagMs }, revision) {
  const words = shown < revision ? say('connection.behind', { count: revision - shown }) : say('connection.upToDate');
  return lagMs === undefined ? words : `${words} · ${written(lagMs, 0, 'ms')}`;
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

export function bytesWords(bytes) {
  return bytes < 1e6 ? written(bytes / 1e3, 0, 'kB') : written(bytes / 1e6, 1, 'MB');
}
