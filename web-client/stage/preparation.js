import { Gestures } from '../navigation/gestures.js';
import { contextOf, movedBy } from '../navigation/input.js';
import { Input } from './input.js';

/**
 * @import { StateDocument } from '../base/protocol.js'
 * @import { Camera } from '../navigation/camera.js'
 * @import { Place } from '../navigation/drags.js'
 *
 * @typedef {{width: number, height: number, cue: string, camera?: Camera, samples?: number, jpegQuality: number}} Wanted
 */

/** In pixels of the view, while it moves. */
const MOVING_SCALE = 0.5;
/** So long nothing has moved before a picture is drawn well. */
const STILL_MS = 150;

/**
 * The picture of a cue that this page alone sees, turned by the hands as the shared one is. One picture is on its way
 * at a time, and the newest camera waits: it takes no more of the server than that gives to pictures on request.
 */
export class Preparation {
  #layer;
  #image;
  #page;
  #input;
  #gestures = new Gestures();
  /** @type {?{cue: string, camera: Camera, isMoved: boolean}} */
  #prepared = null;
  #isAsking = false;
  /** What changed since the last picture was asked for: nothing, or the camera, or only how well it is drawn. */
  #wanted = /** @type {?'moving'|'still'} */ (null);
  /** @type {ReturnType<typeof setTimeout>|undefined} */
  #timer;
  /** The address of the picture shown. */
  #shown = '';

  /**
   * @param {HTMLElement} layer of index.html, over the picture
   * @param {{
   *   draw: (wanted: Wanted) => Promise<{data: BlobPart}|undefined>, state: () => ?StateDocument,
   *   view: () => {width: number, height: number, pixelRatio: number}, mapping: () => (x: number, y: number) => Place,
   *   rules: () => *, moved: (camera: Camera|undefined) => void,
   * }} page `moved`: the camera that is to be taken, where it is not the cue's
   */
  constructor(layer, page) {
    this.#layer = layer;
    this.#image = /** @type {HTMLImageElement} */ (layer.querySelector('img'));
    this.#page = page;
    this.#input = new Input(layer, {
      send: (message) => this.#apply(message),
      mapping: page.mapping,
      rules: page.rules,
      frame: () => undefined,
      soon: (action) => requestAnimationFrame(action),
    });
    this.#input.enabled = false;
  }

  get isOn() {
    return this.#prepared !== null;
  }

  /** Shows a cue; null: nothing any more. @param {?string} cue */
  show(cue) {
    const known = cue === null ? undefined : this.#page.state()?.cues[cue];
    this.#layer.hidden = !known;
    this.#input.enabled = Boolean(known);
    clearTimeout(this.#timer);
    if (cue === this.#prepared?.cue && known) return this.#want('still'); // it may look another
    this.#prepared = known && cue !== null ? { cue, camera: known.camera, isMoved: false } : null;
    this.#wanted = null;
    this.#gestures = new Gestures();
    this.#page.moved(undefined);
    this.#put('');
    if (!this.#prepared) return;
    this.#gestures.restart(this.#prepared.camera);
    this.#want('moving');
  }

  /** Keeps what is prepared, and hears no hand until it is shown again. */
  rest() {
    this.#input.enabled = false;
    this.#wanted = null;
    clearTimeout(this.#timer);
    if (!this.#prepared) return;
    this.#gestures = new Gestures();
    this.#gestures.restart(this.#prepared.camera);
  }

  #apply(message) {
    const [prepared, state] = [this.#prepared, this.#page.state()];
    if (!prepared || !state) return;
    // What lies where is known of the shared picture alone.
    const camera = movedBy(this.#gestures, message, prepared.camera, contextOf(state, this.#page.view(), () => null));
    if (camera === prepared.camera) return;
    Object.assign(prepared, { camera, isMoved: true });
    this.#page.moved(camera);
    this.#want('moving');
  }

  /** @param {'moving'|'still'} quality */
  #want(quality) {
    this.#wanted = quality;
    clearTimeout(this.#timer);
    if (!this.#isAsking) this.#ask();
  }

  async #ask() {
    const [prepared, quality] = [this.#prepared, this.#wanted];
    if (!prepared || !quality) return;
    this.#isAsking = true;
    this.#wanted = null;
    const { camera: { eye, focus, up, center, fov }, cue, isMoved } = prepared;
    const { width, height, pixelRatio } = this.#page.view();
    const scale = quality === 'moving' ? MOVING_SCALE : pixelRatio;
    const picture = await this.#page.draw({
      width: Math.max(1, Math.round(width * scale)), height: Math.max(1, Math.round(height * scale)), cue,
      ...(isMoved ? { camera: { eye, focus, up, center, fov } } : {}),
      ...(quality === 'moving' ? { samples: 1, jpegQuality: 75 } : { jpegQuality: 90 }),
    });
    this.#isAsking = false;
    if (this.#prepared !== prepared) return this.#ask();
    if (picture) this.#put(URL.createObjectURL(new Blob([picture.data], { type: 'image/jpeg' })));
    if (this.#wanted) return this.#ask();
    if (quality === 'moving') this.#timer = setTimeout(() => this.#want('still'), STILL_MS);
  }

  #put(address) {
    if (this.#shown) URL.revokeObjectURL(this.#shown);
    this.#shown = address;
    if (address) this.#image.src = address;
    else this.#image.removeAttribute('src');
  }
}
