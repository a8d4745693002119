import { holderName } from './base/client-names.js';
import { element } from './base/element.js';
import { recall, remember, resumeKey } from './base/memory.js';
import { errorSentence, language, preferredLanguage, say, setLanguage } from './base/texts.js';
import { Changes } from './connection/changes.js';
import { Connection, roleFrom, socketAddress } from './connection/connection.js';
import { Meter } from './connection/meter.js';
import { Token } from './connection/token.js';
import { Awake } from './stage/awake.js';
import { ControlBar } from './stage/control.js';
import { FingerMarks } from './stage/finger-marks.js';
import { Input } from './stage/input.js';
import { Labels } from './stage/labels.js';
import { Lines, connectionSentence } from './stage/lines.js';
import { Picture } from './stage/picture.js';
import { Prediction } from './stage/prediction.js';
import { Presence } from './stage/presence.js';
import { watchViewSize } from './stage/view-size.js';
import { connectionSection } from './panels/connection-section.js';
import { Menu } from './panels/menu.js';
import { partsSection } from './panels/parts-section.js';
import { sceneSections } from './panels/scene-sections.js';
import { viewsSection } from './panels/views-section.js';

/** @import { StateDocument } from './base/protocol.js' */

/** Of index.html. */
const find = (id) => /** @type {HTMLElement} */ (document.getElementById(id));
const canvas = find('view');
const lines = new Lines(find('lines'));
const picture = new Picture(canvas);
const prediction = new Prediction();
const labels = new Labels(find('labels'));
const meter = new Meter();
const awake = new Awake();
const token = new Token(location.hash);

/** @type {import('./connection/connection.js').Phase} */
let phase = { name: 'starting' };
let hasPicture = false;
let stats = null;
const noticesSeen = new Set();

const connection = new Connection({
  url: socketAddress(document.baseURI),
  hello: {
    role: roleFrom(location.hash),
    // An iPad says that it is a Mac.
    name: /iPhone|Android|Windows|Mac|Linux(?!; A)/.exec(navigator.userAgent)?.[0]
      .replace('Mac', navigator.maxTouchPoints > 1 ? 'iPad' : 'Mac'),
    token: token.value,
    resume: resumeKey(),
  },
  on: {
    phase(now) {
      phase = now;
      hasPicture = false;
      stats = null;
      const controls = connection.role === 'control';
      awake.wanted = controls;
      input.enabled = connection.steers;
      meter.forgetSent();
      prediction.forget();
      lines.hold('loading', '');
      if (phase.name === 'open') {
        // A link to watch is not to take the presenter's place.
        if (controls || !recall('token')) token.accepted();
        find('menu-button').hidden = !controls;
        if (!controls) menu.close();
      }
      showPhase();
      show();
    },

    async frame(frame) {
      const outcome = await picture.show(frame);
      if (outcome === 'failed') lines.pass(say('view.unreadable'));
      if (outcome !== 'drawn' || phase.name !== 'open') return;
      // In the same task, so that nothing jumps.
      prediction.drawn(frame.header);
      follow();
      meter.drawn(frame.header.handled, frame.data.byteLength, performance.now());
      hasPicture = true;
      showPhase();
      show();
    },

    sent(message) {
      prediction.sent(message);
      follow();
      // What one who does not steer sends moves nothing.
      if (connection.steers) meter.sent(message.type, message.id, performance.now());
    },

    state(state) {
      input.enabled = connection.steers;
      prediction.follow(state, connection.steers);
      for (const notice of [state.scene?.notices ?? [], state.notices ?? []].flat()) {
        if (!noticesSeen.has(notice)) lines.pass(notice);
        noticesSeen.add(notice);
      }
      show();
    },

    error(error) {
      if (error.code === 'not-in-control') prediction.forget();
      report(error);
    },

    message(message) {
      if (message.type === 'stats') {
        stats = message;
        show();
      } else if (message.type === 'loading') {
        const { scene, fraction, done, refused } = message;
        lines.hold('loading', done || refused ? '' : say('view.loading', { scene }), fraction);
        if (refused) lines.pass(refused);
      }
    },
  },
});

const ask = (message) => connection.ask(message);
const changes = new Changes({ ask, refused: report });

const input = new Input(canvas, {
  send: (message) => connection.send(message),
  mapping: () => picture.mapping(),
  // A server that has begun anew knows nothing of the frames before.
  frame: () => (hasPicture ? picture.header?.frame : undefined),
  // Few moves where all is late.
  soon: (action) => (meter.lateMs(performance.now()) > 1000 ? setTimeout(action, 250) : requestAnimationFrame(action)),
  marks: new FingerMarks(find('finger-marks')),
  unheard: () => controlBar.offer(),
});

const sendControl = (message) => ask(message).catch(report);
const corner = new Presence(find('presence'), {
  ask: () => sendControl({ type: 'control', action: 'ask' }),
  take: () => sendControl({ type: 'control', action: 'take' }),
});
const controlBar = new ControlBar(find('control'), {
  send: sendControl,
  declined: (name) => lines.pass(say('control.declined', { name })),
});

canvas.addEventListener('pointerdown', () => {
  // Who touches the picture means it with the keys, too.
  canvas.classList.add('by-pointer');
  canvas.focus({ preventScroll: true });
});

/** For the menu's sections. */
const page = {
  change: (patch) => changes.add(patch),
  ask,
  state: () => connection.state,
  header: () => picture.header,
  report,
  meter,
};

const menu = new Menu({
  button: find('menu-button'),
  panel: find('menu'),
  build: () => [...sceneSections(page), partsSection(page), viewsSection(page), connectionSection(page)],
  setLanguage(code) {
    remember('language', code);
    speak(code);
  },
});

/** While frames are late, picture and labels go with the fingers. */
function follow() {
  picture.move(prediction.transform);
  labels.show(picture.header, connection.state?.markers, picture.mapping(), prediction.transform);
}

/** Says why something was refused, and shows what is so instead. */
function report(error) {
  if (error.code === 'not-in-control') {
    lines.pass(say('control.other', { name: holderName(connection.state?.control ?? {}) }));
    controlBar.offer();
  } else if (error.code === 'not-sent') {
    lines.pass(say('phase.notSent'));
  } else if (error.message) {
    lines.pass(errorSentence(error));
  }
  show();
}

let nextShow;

/** In the next display frame. */
function show() {
  cancelAnimationFrame(nextShow);
  nextShow = requestAnimationFrame(() => {
    const { state, revision, role, client, steers } = connection;
    const { header } = picture;
    corner.show({ phase, role, client, state, header: hasPicture ? header : null });
    controlBar.show({ role, client, control: state?.control });
    showPart(state?.selection ?? {});
    follow();
    menu.show({ state, revision, header, stats, client, steers });
  });
}

/**
 * The chosen part's name and its parent's, as variants are called by their paint; the rest of its path is small.
 *
 * @param {StateDocument['selection']} selection
 */
function showPart({ node, name, path = [] }) {
  const names = path.slice(1);
  const title = names.slice(-2).join(' › ') || name || (node === undefined ? '' : `#${node}`);
  const above = names.slice(0, -2).join(' › ');
  const part = find('part');
  // Only a change: screen readers read it again.
  if (part.textContent === title + above) return;
  part.replaceChildren(...(title ? [title, element('small', {}, above)] : []));
}

function showPhase() {
  canvas.classList.toggle('stale', !hasPicture);
  const sentence = connectionSentence(phase, hasPicture, token.inAddress);
  if (sentence !== null) lines.hold('connection', sentence);
}

function speak(code) {
  setLanguage(code);
  document.documentElement.lang = language();
  canvas.ariaLabel = say('view.label');
  menu.rebuild();
  showPhase();
  show();
}

watchViewSize(canvas, (size) => {
  picture.layout();
  connection.resize(size);
  show();
});

document.addEventListener('keydown', () => canvas.classList.remove('by-pointer'), { capture: true });
document.addEventListener('visibilitychange', () => {
  if (!document.hidden) connection.wake();
});
window.addEventListener('online', () => connection.wake());
// Another token: another start.
window.addEventListener('hashchange', () => location.reload());

speak(recall('language') ?? preferredLanguage(navigator.languages));
connection.start();
