import { measuresOf } from '../base/measures.js';
import { errorSentence, holderName, noticeSentence, say } from '../base/texts.js';
import { ControlBar } from './control.js';
import { FingerMarks } from './finger-marks.js';
import { Input } from './input.js';
import { Labels } from './labels.js';
import { Lines, connectionSentence } from './lines.js';
import { MeasureMarks } from './measure-marks.js';
import { nextTap } from './next-tap.js';
import { PartBar } from './part-bar.js';
import { Picture } from './picture.js';
import { PlaneHandle } from './plane-handle.js';
import { PointedMarks } from './pointed-marks.js';
import { Pointer } from './pointer.js';
import { Prediction } from './prediction.js';
import { Preparation } from './preparation.js';
import { Presence } from './presence.js';
import { Snapper } from './snapper.js';
import { freeOf, watchViewSize } from './view-size.js';

/**
 * @import { ServerError, ServerLoading, ServerPointed, StateDocument } from '../base/protocol.js'
 * @import { Now, Store } from '../base/store.js'
 * @import { Commands } from '../connection/commands.js'
 * @import { Connection, Frame } from '../connection/connection.js'
 * @import { Meter } from '../connection/meter.js'
 */

/** Few moves where all is late. */
const LATE_MS = 1000;
const THINNED_MS = 250;

/** The picture, all that lies on it, and the hands on it. */
export class Stage {
  #store;
  #hasToken;
  #connection;
  #canvas = find('view');
  #picture = new Picture(this.#canvas);
  #prediction = new Prediction({ surfaceAt: (camera, place) => this.#picture.surfaceAt(camera, place) });
  #labels = new Labels(find('labels'));
  #lines = new Lines(find('lines'));
  #measures = new MeasureMarks(find('measure-lines'), find('measures'), () => this.#showMeasures());
  #pointed = new PointedMarks(find('pointed'));
  #handle;
  #snapper;
  #pointer;
  #preparation;
  #noticesSeen = new Set();
  #controlBar;
  #input;
  #flying = 0;

  /** @param {{store: Store, commands: Commands, connection: Connection, meter: Meter, hasToken: boolean}} page */
  constructor({ store, commands, connection, meter, hasToken }) {
    this.#store = store;
    this.#hasToken = hasToken;
    this.#connection = connection;
    const presence = new Presence(find('presence'), {
      ask: () => commands.control({ action: 'ask' }),
      take: () => commands.control({ action: 'take' }),
    });
    this.#controlBar = new ControlBar(find('control'), {
      send: commands.control,
      declined: (name) => this.#lines.pass(say('control.declined', { name })),
    });
    this.#handle = new PlaneHandle(/** @type {*} */ (find('handle')), {
      change: (name, plane) => commands.change({ sections: { [name]: plane } }),
    });
    this.#snapper = new Snapper({ layer: find('snap-layer'), mark: find('snap'), loupe: find('loupe') }, {
      pick: commands.pick,
      mapping: () => this.#picture.mapping(),
      frame: () => this.#frame,
      paths: (lines) => this.#picture.paths(lines),
      free: () => this.#free,
      magnify: (canvas, place, factor) => this.#picture.magnify(canvas, place, factor),
      say: (text) => this.#lines.hold('snap', text, undefined, { label: say('measures.done'), act: this.#endSnapping }),
      wheel: (event) => this.#canvas.dispatchEvent(new WheelEvent('wheel', event)),
      press: (event) => this.#canvas.dispatchEvent(new PointerEvent('pointerdown', event)),
    });
    this.#pointer = new Pointer(find('point-layer'), {
      send: (pointed) => connection.send({ type: 'point', ...pointed }),
      mapping: () => this.#picture.mapping(),
      frame: () => this.#frame,
      turned: (points) => {
        const done = { label: say('pointing.done'), act: this.#endPointing };
        this.#lines.hold('point', points ? say('pointing.hint') : '', undefined, done);
        store.set({ points });
      },
      wheel: (event) => this.#canvas.dispatchEvent(new WheelEvent('wheel', event)),
    });
    const partBar = new PartBar(find('selection'), { commands, leave: () => this.#canvas.focus() });
    this.#input = new Input(this.#canvas, {
      send: (message) => connection.send(this.#prediction.withTouched(message)),
      mapping: () => this.#picture.mapping(),
      rules: () => connection.input,
      frame: () => this.#frame,
      soon: (action) =>
        (meter.lateMs(performance.now()) > LATE_MS ? setTimeout(action, THINNED_MS) : requestAnimationFrame(action)),
      moved: (message) => {
        this.#prediction.moved(message);
        this.#move();
      },
      marks: new FingerMarks(find('finger-marks')),
      unheard: () => this.#preparation.isOn || this.#controlBar.offer(),
    });
    this.#preparation = new Preparation(find('prepare'), {
      draw: commands.picture,
      state: () => store.now.state,
      view: () => store.now.header?.view ?? { width: 16, height: 9, pixelRatio: 1 },
      mapping: () => this.#picture.mapping(),
      rules: () => connection.input,
      moved: (preparedCamera) => store.set({ preparedCamera }),
    });
    this.#canvas.addEventListener('pointerdown', () => {
      // Who touches the picture means it with the keys, too.
      this.#canvas.classList.add('by-pointer');
      this.#canvas.focus({ preventScroll: true });
    });
    document.addEventListener('keydown', () => this.#canvas.classList.remove('by-pointer'), { capture: true });
    const rows = ['selection', 'strip', 'bar'].map(find);
    watchViewSize(this.#canvas, { over: find('over'), rows }, (size) => {
      this.#picture.layout();
      connection.resize(size);
      store.set({ inset: size.inset });
      this.#move();
    });

    store.subscribe(({ language }) => [language], (language) => {
      document.documentElement.lang = language;
      this.#canvas.ariaLabel = say('view.label');
    });
    store.subscribe(({ hasPicture, language }) => [hasPicture, language], () => this.#showPhase());
    store.subscribe(
      ({ phase, role, client, state, hasPicture, header, isLate, language }) =>
        [phase, role, client, state?.control, hasPicture && header?.quality?.level, isLate, language],
      () => {
        const { hasPicture, header, ...now } = store.now;
        presence.show({ ...now, header: hasPicture ? header : null });
      });
    store.subscribe(({ phase, state, language }) => [phase.name === 'open' && Boolean(state?.recording), language],
      (isRecorded) => {
        find('recording').textContent = isRecorded ? say('recording.name') : '';
      });
    store.subscribe(({ role, client, state, language }) => [role, client, state?.control, language],
      (role, client, control) => this.#controlBar.show({ role, client, control }));
    store.subscribe(
      ({ role, state, language }) => [role, state?.scene, state?.selection, state?.nodes, language],
      () => partBar.show(store.now));
    store.subscribe(({ prepares, steers, state, hasPicture }) => [prepares, steers && hasPicture, state?.cues],
      (prepares, isHeard) => {
        if (prepares === null || isHeard) this.#preparation.show(prepares);
        else this.#preparation.rest();
        this.#lines.hold('prepare', this.#preparation.isOn ? say('cues.onlyYou', { name: prepares }) : '');
        this.#input.enabled = store.now.steers && !this.#preparation.isOn;
      });
    store.subscribe(({ steers, state }) => [steers, state?.markers], () => this.#move());
    store.subscribe(({ steers, state, handled, inset }) => [steers, state?.sections, handled, inset],
      () => this.#showHandle());
    store.subscribe(({ state, inset, language }) => [state?.measures, state?.measured, state?.unit, inset, language],
      () => this.#showMeasures());
    // Without control nothing can be measured, and a node of another scene is another.
    store.subscribe(({ steers, state, language }) => [steers, state?.scene?.file, language], () => this.#snapper.end());
    store.subscribe(({ state }) => [state?.scene?.file], () => this.#pointed.clear());
    store.subscribe((now) => [mayPoint(now), now.client, now.language], this.#endPointing);
    store.subscribe(({ state }) => [state?.scene?.notices, state?.notices],
      (...notices) => this.#passNotices(notices.flat().filter(Boolean)));
  }

  /** Another phase of the connection has begun. */
  phase() {
    this.#input.enabled = this.#store.now.steers && !this.#preparation.isOn;
    this.#prediction.forget();
    this.#pointed.clear();
    this.#move();
    this.#lines.hold('loading', '');
    this.#showPhase();
  }

  /** Promises the header of the frame; null where that is not drawn. @param {Frame} frame */
  async draw(frame) {
    const { header } = frame;
    const outcome = await this.#picture.show(frame);
    if (outcome === 'failed') this.#lines.pass(say('view.unreadable'));
    if (outcome !== 'drawn' || !header || this.#store.now.phase.name !== 'open') return null;
    // In the same task, so that nothing jumps.
    this.#prediction.drawn(header);
    this.#move();
    return header;
  }

  /** Whether frames are to hold depth. */
  get warps() {
    return this.#picture.warps;
  }

  sent(message) {
    this.#prediction.sent(message);
    this.#move();
  }

  /** Before the next event, which counts only from who steers. @param {StateDocument} state */
  follow(state) {
    const { steers } = this.#store.now;
    this.#input.enabled = steers && !this.#preparation.isOn;
    this.#prediction.follow(state, steers);
    this.#move();
  }

  /** @param {ServerLoading} message */
  loading({ scene, fraction, done, refused }) {
    this.#lines.hold('loading', done || refused ? '' : say('view.loading', { scene }), fraction);
    if (refused) this.#lines.pass(errorSentence({ code: 'refused-scene', message: refused }));
  }

  /** @param {ServerPointed} message */
  pointed(message) {
    this.#pointed.receive(message);
    this.#pointed.show(this.#picture);
  }

  /** Begins or ends to point at what a finger touches. */
  turnPointing = () => {
    if (this.#store.now.points) return this.#pointer.end();
    this.#endPreparing();
    this.#snapper.end();
    this.#pointer.begin();
  };

  /**
   * Says what to tap, and promises where in which frame the picture is tapped next; null where that is given up.
   *
   * @param {string} text
   * @param {AbortSignal} signal
   */
  async nextTap(text, signal) {
    this.#endPreparing();
    this.#pointer.end();
    this.#lines.hold('tap', text);
    const tap = await nextTap(find('tap'), signal);
    this.#lines.hold('tap', '');
    return tap && { ...this.#picture.mapping()(tap.clientX, tap.clientY), frame: this.#frame };
  }

  /** Picks that snap: the panels' Snapping. */
  get snapping() {
    const snapper = this.#snapper;
    return {
      begin: (session) => {
        this.#endPreparing();
        this.#pointer.end();
        snapper.begin(session);
      },
      ask: (asked) => snapper.ask(asked),
      end: () => snapper.end(),
    };
  }

  /** Says what was done, with a button for what can be done about it. */
  offer(text, label, act) {
    this.#lines.pass(text, { label, act });
  }

  /** Says why something was refused; by the code `not-loaded`, that a part of the page was not. */
  report(error) {
    const { phase, state } = this.#store.now;
    if (error.code === 'not-in-control') {
      this.#lines.pass(say('control.other', { name: holderName(state?.control ?? {}) }));
      this.#controlBar.offer();
    } else if (error.code === 'not-loaded' && phase.name === 'open') {
      // The server has become another version, or the browser does not try again.
      this.offer(say('page.notLoaded'), say('page.reload'), () => location.reload());
    } else if (['not-sent', 'not-loaded'].includes(error.code)) {
      this.#lines.pass(say('phase.notSent'));
    } else if (error.message) {
      this.#lines.pass(errorSentence(error));
    }
  }

  /** What was refused is no answer to a question. @param {ServerError} error */
  inputRefused(error) {
    // What a finger points at next is in a newer one.
    if (error.code === 'unknown-frame') return;
    if (error.code === 'not-in-control') this.#prediction.release();
    this.#move();
    this.report(error);
  }

  /** While frames are late, picture and labels go with the fingers, and with flights. */
  #move() {
    this.#picture.look(this.#prediction.camera);
    this.#labels.show(this.#picture, this.#store.now.state?.markers);
    this.#showHandle();
    this.#showMeasures();
    this.#pointed.show(this.#picture);
    this.#snapper.look();
    if (this.#prediction.flies) this.#flying ||= requestAnimationFrame(() => this.#flyOn());
  }

  #showHandle() {
    const { state, steers, handled: name, inset } = this.#store.now;
    const plane = name !== null && steers ? state?.sections[name] : undefined;
    const camera = this.#prediction.camera;
    const lens = camera && this.#picture.lens(camera);
    const isShown = name !== null && state && plane?.on && lens;
    this.#handle.show(isShown
      ? { ...lens, free: freeOf(lens.lens, inset), bounds: state.scene.bounds, name, plane } : null);
  }

  #showMeasures() {
    const { state } = this.#store.now;
    if (state?.measures) this.#measures.show(this.#picture, measuresOf(state), state.unit, () => this.#free);
  }

  #endSnapping = () => this.#snapper.end();
  #endPointing = () => this.#pointer.end();

  /** What is tapped is to be in the picture that all see. */
  #endPreparing() {
    this.#store.set({ prepares: null });
  }

  /** The number of the frame shown. A server that has begun anew knows nothing of those before. */
  get #frame() {
    const { hasPicture, header } = this.#store.now;
    return hasPicture ? header?.frame : undefined;
  }

  /** What no panel covers of the window. */
  get #free() {
    return freeOf({ width: window.innerWidth, height: window.innerHeight }, this.#store.now.inset);
  }

  #flyOn() {
    this.#flying = 0;
    this.#move();
  }

  #showPhase() {
    const { phase, hasPicture } = this.#store.now;
    this.#canvas.classList.toggle('stale', !hasPicture);
    const sentence = connectionSentence(phase, hasPicture, this.#hasToken);
    if (sentence !== null) this.#lines.hold('connection', sentence);
  }

  #passNotices(notices) {
    for (const notice of notices) {
      if (!this.#noticesSeen.has(notice.message)) this.#lines.pass(noticeSentence(notice));
      this.#noticesSeen.add(notice.message);
    }
  }
}

/**
 * Whether this page may point.
 *
 * @param {Pick<Now, 'role'|'state'>} now
 */
export function mayPoint({ role, state }) {
  return role === 'control' || (role !== undefined && state?.pointing?.watchers === true);
}

/** Of index.html. */
function find(id) {
  return /** @type {HTMLElement} */ (document.getElementById(id));
}
