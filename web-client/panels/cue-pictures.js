import { lookOf } from '../base/cues.js';

/**
 * @import { Store } from '../base/store.js'
 * @import { Commands } from '../connection/commands.js'
 */

/** Pixels across, of pictures that are shown half as wide. */
const WIDTH = 240;

/** Pictures of cues, drawn by the server, one after the other, and again only where a cue looks another. */
export class CuePictures {
  #store;
  #commands;
  /** Addresses of pictures by what they show; null while one is drawn. @type {Map<string, ?string>} */
  #made = new Map();
  /** What images show, or wait for. @type {Map<HTMLImageElement, {name: string, key: string}>} */
  #shown = new Map();
  #draws = false;

  /** @param {{store: Store, commands: Commands}} page */
  constructor({ store, commands }) {
    this.#store = store;
    this.#commands = commands;
  }

  /** Shows the picture of a cue, once it is there. @param {HTMLImageElement} image @param {string} name */
  show(image, name) {
    const key = this.#keyOf(name);
    if (key === undefined) return;
    this.#shown.set(image, { name, key });
    if (!this.#made.has(key)) this.#made.set(key, null);
    this.#put(image, key);
    this.#draw();
  }

  #put(image, key) {
    const address = this.#made.get(key);
    if (address && image.getAttribute('src') !== address) image.src = address;
  }

  #keyOf(name) {
    const { state, header } = this.#store.now;
    const cue = state?.cues?.[name];
    if (!cue || !header) return undefined;
    const { mode, wireframe } = state.renderer;
    return [state.scene.file, mode, wireframe, this.#size().height, lookOf(cue)].join(' ');
  }

  #size() {
    const view = this.#store.now.header?.view ?? { width: 16, height: 9 };
    return { width: WIDTH, height: Math.max(1, Math.round((WIDTH * view.height) / view.width)) };
  }

  async #draw() {
    if (this.#draws) return;
    this.#draws = true;
    for (let next = this.#next(); next; next = this.#next()) {
      const { name, key } = next;
      const picture = await this.#commands.cuePicture({ ...this.#size(), cue: name });
      // Where it could not be drawn, it is tried again when it is shown again.
      if (!picture) this.#made.delete(key);
      else if (this.#keyOf(name) === key) this.#made.set(key, URL.createObjectURL(new Blob([picture.data], { type: 'image/jpeg' })));
      for (const [image, shown] of this.#shown) if (shown.key === key) this.#put(image, key);
    }
    this.#draws = false;
  }

  /** One that waits; what no image in the page shows any more is forgotten. */
  #next() {
    for (const image of this.#shown.keys()) if (!image.isConnected) this.#shown.delete(image);
    const wanted = new Set([...this.#shown.values()].map(({ key }) => key));
    for (const [key, address] of this.#made) {
      if (wanted.has(key)) continue;
      if (address) URL.revokeObjectURL(address);
      this.#made.delete(key);
    }
    return [...this.#shown.values()].find(({ name, key }) => this.#made.get(key) === null && this.#keyOf(name) === key);
  }
}
