import { cueAfter, cueNames } from '../base/cues.js';
import { say } from '../base/texts.js';
import { stateOf } from './section.js';

/**
 * @import { Store } from '../base/store.js'
 * @import { Commands } from '../connection/commands.js'
 */

/** Goes through the cues: at once, or by way of a picture that this page alone sees until it is taken. */
export class Presentation {
  #store;
  #commands;
  #report;
  #offer;

  /**
   * @param {{
   *   store: Store, commands: Commands, report: (error: *) => void,
   *   offer: (text: string, label: string, act: () => void) => void,
   * }} page
   */
  constructor({ store, commands, report, offer }) {
    this.#store = store;
    this.#commands = commands;
    this.#report = report;
    this.#offer = offer;
    // What was prepared may have gone, with its scene, too. A lost connection alone ends nothing, and who holds control
    // is certain once a picture of the new one is here.
    store.subscribe(({ state, role, steers, hasPicture }) => [state?.cues, role, hasPicture && !steers],
      (cues, role, isOver) => {
        const { prepares } = store.now;
        if (prepares !== null && role && (isOver || !cues?.[prepares])) this.end();
      });
  }

  get hasCues() {
    return cueNames(this.#store.now.state?.cues).length > 0;
  }

  /** Its maker sees what all see: to be called before anything acts on that. */
  end() {
    this.#store.set({ prepares: null });
  }

  /** Shows all a cue, or this page alone while it prepares. @param {string} name */
  choose(name) {
    if (this.#store.now.prepares === null) return this.#commands.cue({ name });
    if (this.#maySteer()) this.#store.set({ prepares: name });
  }

  /**
   * To the next cue or the one before; what is prepared is taken instead of the next. The cue is named, so that another
   * step before the answer leads to the same one.
   *
   * @param {1|-1} by
   */
  step(by) {
    if (by > 0 && this.#store.now.prepares !== null) return this.take();
    const name = cueAfter(stateOf(this.#store), by);
    if (name !== undefined) {
      this.end();
      return this.#commands.cue({ name });
    }
    this.#report(new Error(say(by > 0 ? 'cues.isLast' : 'cues.isFirst')));
  }

  /** Begins with the next cue, or with the first one after the last. */
  turnPreparing() {
    if (!this.#maySteer()) return;
    const state = stateOf(this.#store);
    const first = cueAfter(state, 1) ?? cueNames(state.cues)[0];
    this.#store.set({ prepares: this.#store.now.prepares === null ? first ?? null : null });
  }

  /** Shows all what is prepared; the next one is prepared then. */
  async take() {
    const { prepares: name, preparedCamera: camera } = this.#store.now;
    if (name === null || !await this.#commands.cue({ name, ...(camera ? { camera } : {}) })) return;
    // It may have been ended meanwhile, or another be chosen.
    if (this.#store.now.prepares !== name) return;
    const names = cueNames(stateOf(this.#store).cues);
    this.#store.set({ prepares: names[names.indexOf(name) + 1] ?? null });
  }

  /** The cue is seen from there from now on. */
  async keep() {
    const { prepares: name, preparedCamera: camera, state } = this.#store.now;
    if (name === null || !camera) return;
    const before = state?.cues[name].camera;
    if (!await this.#commands.patch({ cues: { [name]: { camera } } })) return;
    this.#offer(say('cues.kept', { name }), say('views.undo'), () => this.#commands.patch({ cues: { [name]: { camera: before } } }));
  }

  /** Says why where it does not. */
  #maySteer() {
    const { role, steers } = this.#store.now;
    if (!steers) this.#report({ code: role ? 'not-in-control' : 'not-sent' });
    return steers;
  }
}
