import { pictureOfCue } from '../base/cues.js';
import { button, element, keepsKeys } from '../base/element.js';
import { say } from '../base/texts.js';
import { allOf } from '../connection/commands.js';
import { rows, toggle } from './controls.js';
import { cueStrip, shownOf } from './cue-strip.js';
import { Pictures } from './pictures.js';
import { pointButton } from './pointing.js';
import { Presentation } from './presentation.js';
import { stateOf } from './section.js';
import { Trail } from './trail.js';
import { doorControl, variantControl, variants } from './variants.js';
import { viewNames } from './views-section.js';

/**
 * @import { StateDocument } from '../base/protocol.js'
 * @import { Now, Store } from '../base/store.js'
 * @import { Commands } from '../connection/commands.js'
 * @import { Menu } from './menu.js'
 *
 * @typedef {{store: Store, commands: Commands, menu: Menu, report: (error: *) => void, turnPointing: () => void,
 *   offer: (text: string, label: string, act: () => void) => void}} BarPage
 */

/** Keys of presenters' clickers, and the steps that they take through the cues. */
const STEPS = { PageDown: 1, PageUp: -1 };

/** So long a chosen view counts as the present one, while the camera flies there. */
const FLIES_MS = 1000;

/** The slim bar at the picture's lower edge, and the strip that two of its buttons open above it. */
export class Bar {
  #bar = /** @type {HTMLElement} */ (document.getElementById('bar'));
  #strip = /** @type {HTMLElement} */ (document.getElementById('strip'));
  #store;
  #commands;
  #menu;
  #turnPointing;
  #presentation;
  #pictures;
  #point = /** @type {?HTMLElement} */ (null);
  #cues = /** @type {?HTMLElement} */ (null);
  #trail = new Trail(() => this.#showBack());
  /** The button of the strip that is open. @type {?HTMLElement} */
  #opener = null;
  /** @type {(now: Now) => void} */
  #showStrip = () => {};
  /** @type {?HTMLElement} */
  #back = null;
  #chosen = { key: '', at: -Infinity };

  /** Empty until `rebuild`. @param {BarPage} page */
  constructor({ store, commands, menu, report, offer, turnPointing }) {
    this.#turnPointing = turnPointing;
    this.#presentation = new Presentation({ store, commands, report, offer });
    this.#pictures = new Pictures({ store, commands, find: ({ cues }, name) => pictureOfCue(cues, name) });
    this.#store = store;
    this.#commands = commands;
    this.#menu = menu;
    this.#strip.onkeydown = (event) => {
      if (event.key === 'Escape') this.#open(null);
    };
    store.subscribe(({ role }) => [role], (role) => {
      if (!role) return; // not connected: what was allowed still is
      this.#bar.hidden = role !== 'control';
      if (this.#bar.hidden) this.#open(null);
    });
    store.subscribe(({ state }) => [state?.scene?.file, !state], () => this.#trail.forget());
    store.subscribe(({ state }) => [state?.camera], (camera) => camera && this.#trail.follow(camera));
    // Each connection sends the whole state again. The strip stays open if the scene in it is the same.
    let shown = '';
    store.subscribe(({ state }) => [state?.scene], (scene) => {
      const before = shown;
      shown = JSON.stringify(scene ?? null);
      if (shown !== before) this.#open(null);
    });
    store.subscribe(({ state }) => [state?.camera, state?.views, state?.nodes, state?.swings, state?.navigation],
      () => this.#showStrip(store.now));
    store.subscribe(shownOf, () => this.#showStrip(store.now));
    store.subscribe(({ points, language }) => [points, language], () => this.#showPoint());
    document.addEventListener('keydown', (event) => this.#key(event));
  }

  /** What a presenter needs while they show the cues. */
  present() {
    this.#menu.close();
    if (this.#cues?.ariaExpanded === 'false') this.#cues.click();
  }

  /** In the menu and where something is typed, these keys have another meaning. @param {KeyboardEvent} event */
  #key(event) {
    const { key, target, altKey, ctrlKey, metaKey, shiftKey } = event;
    const { role } = this.#store.now;
    if (!(key in STEPS) || altKey || ctrlKey || metaKey || shiftKey || keepsKeys(target)) return;
    if (role !== 'control' || !this.#presentation.hasCues) return;
    event.preventDefault();
    if (!event.repeat) this.#presentation.step(STEPS[key]);
  }

  /** What this page sent. */
  sent(message) {
    if (this.#store.now.steers) this.#trail.sent(message);
  }

  /** Makes everything anew, in the language in force. */
  rebuild() {
    const { fly, fit } = this.#commands;
    const opens = (label, icon, build) => {
      const made = button(label, () => this.#open(made === this.#opener ? null : made, build), { icon });
      made.setAttribute('aria-controls', 'strip');
      made.ariaExpanded = 'false';
      return made;
    };
    const shared = (act) => {
      this.#presentation.end();
      return act();
    };
    const back = button(say('bar.back'), () => {
      const pose = this.#store.now.steers ? this.#trail.back() : undefined;
      if (pose) shared(() => fly(pose));
    }, { icon: 'back' });
    this.#back = back;
    const sections = button(say('sections.title'), () => this.#menu.open(sections, 'sections'), { icon: 'section' });
    const measures = button(say('measures.title'), () => this.#menu.open(measures, 'measures'), { icon: 'measure' });
    const point = pointButton(this.#turnPointing);
    this.#point = point;
    const cues = opens(say('cues.title'), 'present', () => cueStrip({
      store: this.#store, pictures: this.#pictures, presentation: this.#presentation,
    }));
    this.#cues = cues;
    for (const spare of [sections, measures, point, cues]) spare.classList.add('spare');
    const more = button(say('bar.more'), () => this.#menu.open(more), { icon: 'menu' });
    this.#open(null);
    this.#bar.ariaLabel = say('bar.label');
    this.#bar.replaceChildren(
      button(say('bar.home'), () => shared(() => fly(stateOf(this.#store).views.home)), { icon: 'home' }),
      button(say('bar.fit'), () => shared(() => fit()), { icon: 'fit' }),
      back,
      opens(say('views.title'), 'camera', () => this.#views()),
      opens(say('parts.variants'), 'variants', () => this.#variants()),
      opens(say('parts.doors'), 'door', () => this.#doors()),
      sections,
      measures,
      point,
      cues,
      more,
    );
    this.#showBack();
    this.#showPoint();
  }

  #showBack() {
    if (this.#back) this.#back.ariaDisabled = String(this.#trail.isEmpty);
  }

  #showPoint() {
    if (this.#point) this.#point.ariaPressed = String(this.#store.now.points);
  }

  /** The strip of a button, or none. `build` gives its content, and how that follows the state. */
  #open(opener, build) {
    if (this.#opener) this.#opener.ariaExpanded = 'false';
    if (!opener && this.#strip.contains(document.activeElement)) this.#opener?.focus();
    this.#opener = opener;
    this.#strip.hidden = !opener;
    // What is prepared can be taken only in the strip that goes.
    this.#presentation.end();
    this.#showStrip = () => {};
    this.#strip.replaceChildren();
    if (!opener || !this.#store.now.state) return;
    opener.ariaExpanded = 'true';
    this.#strip.ariaLabel = opener.textContent;
    const { content, show } = build();
    this.#strip.append(...content);
    this.#showStrip = show;
    show(this.#store.now);
  }

  #views() {
    const state = () => stateOf(this.#store);
    const go = (stop) => {
      if (!stop) return;
      const [key, { camera }] = stop;
      this.#chosen = { key, at: performance.now() };
      this.#commands.fly(camera);
    };
    const present = (all) => {
      const { key, at } = this.#chosen;
      return performance.now() - at < FLIES_MS ? key : stopAt(all, state().camera) ?? key;
    };
    const step = (by, label) => button(label, () => {
      const all = stops(state());
      go(stopFrom(all, present(all), by));
    }, { icon: 'open', only: true });
    const list = rows(say('views.title'), say('views.none'), (key) => {
      const chip = button('', () => go(stops(state()).find(([other]) => other === key)));
      return {
        children: [chip],
        show({ text, used }) {
          chip.lastChild.data = text;
          if (used && chip.ariaPressed !== 'true') chip.scrollIntoView({ inline: 'center', block: 'nearest' });
          chip.ariaPressed = String(used);
        },
      };
    });
    const before = step(-1, say('bar.previous'));
    before.classList.add('before');
    const after = step(1, say('bar.next'));
    return {
      content: [before, list.element, after],
      show: () => {
        const all = stops(state());
        const at = stopAt(all, state().camera);
        before.hidden = after.hidden = all.length < 2;
        list.show(all.map(([key, { text }]) => [key, { text, used: key === at }]));
      },
    };
  }

  #variants() {
    const { change } = this.#commands;
    const state = () => stateOf(this.#store);
    return this.#found('switches', say('bar.noVariants'),
      (switches) => variants(switches).map((variant) => variantControl(variant, { change, state })));
  }

  #doors() {
    const commands = this.#commands;
    const state = () => stateOf(this.#store);
    const option = toggle(say('bar.tapOpens'), (tapSwings) => commands.change({ navigation: { tapSwings } }));
    const taps = { element: option.element, show: () => option.show(state().navigation.tapSwings) };
    return this.#found('hinges', say('bar.noDoors'),
      (doors) => (doors.length > 0 ? [taps, ...doors.map((door) => doorControl(door, { commands, state }))] : []));
  }

  /** The controls that `build` makes of the nodes of a kind, or the words `none`. */
  #found(only, none, build) {
    const all = element('div', { className: 'choices' });
    let controls = [];
    const show = () => {
      for (const control of controls) control.show();
    };
    const load = async () => {
      const nodes = await allOf(this.#commands.tree, { only });
      if (!nodes || !all.isConnected) return;
      controls = build(nodes);
      all.replaceChildren(...controls.map((control) => control.element));
      if (controls.length === 0) all.append(none);
      show();
    };
    load();
    return { content: [all], show };
  }
}

/**
 * Where a presentation stops: [key, {text, camera}] of each saved view and then each camera of the scene.
 *
 * @param {Pick<StateDocument, 'views'|'cameras'>} state
 * @returns {[string, {text: string, camera: *}][]}
 */
export function stops({ views, cameras }) {
  return [
    ...viewNames(views).map((name) => /** @type {[string, *]} */ ([`view ${name}`, { text: name, camera: views[name] }])),
    ...Object.entries(cameras).map(([id, { name }]) =>
      /** @type {[string, *]} */ ([`camera ${id}`, { text: name || `#${id}`, camera: { node: Number(id) } }])),
  ];
}

/**
 * The key of the one at which the camera stands; undefined between them.
 *
 * @param {ReturnType<typeof stops>} all
 * @param {StateDocument['camera']} camera
 */
export function stopAt(all, camera) {
  const isThere = ([, { camera: stop }]) => ['node', 'eye', 'focus', 'center', 'fov']
    .every((member) => !(member in stop) || String(stop[member]) === String(camera[member]));
  return all.find(isThere)?.[0];
}

/**
 * The one so many steps from that of a key, around the end; without a key the first, or the last.
 *
 * @param {ReturnType<typeof stops>} all
 * @param {string|undefined} key
 * @param {1|-1} by
 */
export function stopFrom(all, key, by) {
  const at = all.findIndex(([other]) => other === key);
  return at < 0 ? all.at(by > 0 ? 0 : -1) : all[(at + by + all.length) % all.length];
}
