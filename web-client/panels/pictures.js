/**
 * @import { StateDocument } from '../base/protocol.js'
 * @import { Store } from '../base/store.js'
 * @import { Commands } from '../connection/commands.js'
 *
 * What a picture shows: a text that is the same for things that look the same, and what a `snapshot` has for it.
 *
 * @typedef {{look: string, request: object}} Wanted
 */

/** Pixels across, of pictures that are shown half as wide. */
const WIDTH = 240;
/** A pixel; enough at this size, and many are waited for. */
const SAMPLES = 4;

/** Pictures of things of the state, drawn by the server, one after the other, and again only where one looks another. */
export class Pictures {
  #store;
  #commands;
  #find;
  /** Addresses of pictures by what they show; null while one is drawn. @type {Map<string, ?string>} */
  #made = new Map();
  /** What images show, or wait for. @type {Map<HTMLImageElement, {name: string, key: string}>} */
  #shown = new Map();
  #draws = false;

  /** @param {{store: Store, commands: Commands, find: (state: StateDocument, name: string) => Wanted|undefined}} page */
  constructor({ store, commands, find }) {
    this.#store = store;
    this.#commands = commands;
    this.#find = find;
  }

  /** Shows the picture of what has this name, once it is there. @param {HTMLImageElement} image @param {string} name */
  show(image, name) {
    const wanted = this.#wanted(name);
    if (!wanted) return;
    const { key } = wanted;
    this.#shown.set(image, { name, key });
    if (!this.#made.has(key)) this.#made.set(key, null);
    this.#put(image, key);
    this.#draw();
  }

  #put(image, key) {
    const address = this.#made.get(key);
    if (address && image.getAttribute('src') !== address) image.src = address;
  }

  #wanted(name) {
    const { state, header } = this.#store.now;
    const found = state && header && this.#find(state, name);
    if (!found) return undefined;
    const { mode, wireframe } = state.renderer;
    return { key: [state.scene.file, mode, wireframe, this.#size().height, found.look].join(' '), request: found.request };
  }

  #size() {
    const view = this.#store.now.header?.view ?? { width: 16, height: 9 };
    return { width: WIDTH, height: Math.max(1, Math.round((WIDTH * view.height) / view.width)) };
  }

  async #draw() {
    if (this.#draws) return;
    this.#draws = true;
    for (let next = this.#next(); next; next = this.#next()) {
      const { name, key, request } = next;
      const picture = await this.#commands.picture({ ...this.#size(), samples: SAMPLES, ...request });
      // Where it could not be drawn, it is tried again when it is shown again.
      if (!picture) this.#made.delete(key);
      else if (this.#wanted(name)?.key === key) this.#made.set(key, URL.createObjectURL(new Blob([picture.data], { type: 'image/jpeg' })));
      for (const [image, shown] of this.#shown) if (shown.key === key) this.#put(image, key);
    }
    this.#draws = false;
  }

  /** One that waits; what no image in the page shows any more is forgotten. */
  #next() {
    for (const image of this.#shown.keys()) if (!image.isConnected) this.#shown.delete(image);
    const shown = [...this.#shown.values()];
    const keys = new Set(shown.map(({ key }) => key));
    for (const [key, address] of this.#made) {
      if (keys.has(key)) continue;
      if (address) URL.revokeObjectURL(address);
      this.#made.delete(key);
    }
    for (const { name, key } of shown) {
      const wanted = this.#made.get(key) === null && this.#wanted(name);
      if (wanted && wanted.key === key) return { name, ...wanted };
    }
    return undefined;
  }
}
