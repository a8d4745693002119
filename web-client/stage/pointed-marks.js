import { element } from '../base/element.js';
import { pointerColor } from '../base/pointer-color.js';
import { clientName } from '../base/texts.js';

/**
 * @import { ServerPointed } from '../base/protocol.js'
 * @import { Place } from '../navigation/drags.js'
 *
 * @typedef {{point: number[], dot: HTMLElement, label: HTMLElement, timer: ReturnType<typeof setTimeout>}} Shown
 */

/** A client that points sends more often; else it is lost. */
const STAYS_MS = 2000;

/** Shows what clients point at: a dot with a name, in a colour of each, in a container as large as the window. */
export class PointedMarks {
  #container;
  /** @type {Map<string, Shown>} by client */
  #shown = new Map();

  /** @param {HTMLElement} container */
  constructor(container) {
    this.#container = container;
  }

  /** show() must follow. @param {ServerPointed} message */
  receive({ client, name, point }) {
    const before = this.#shown.get(client);
    clearTimeout(before?.timer);
    if (!point) {
      this.#drop(client);
      return;
    }
    // Apart, so that no name covers another's dot.
    const { dot, label } = before ?? this.#made(client);
    const words = clientName({ client, name });
    if (label.textContent !== words) /** @type {HTMLElement} */ (label.firstChild).textContent = words;
    this.#shown.set(client, { point, dot, label, timer: setTimeout(() => this.#drop(client), STAYS_MS) });
  }

  /** @param {string} client */
  #made(client) {
    const made = { dot: element('i'), label: element('p', {}, element('span')) };
    for (const part of Object.values(made)) {
      part.style.setProperty('--color', pointerColor(client));
      this.#container.append(part);
    }
    return made;
  }

  /** @param {{paths: (lines: number[][][]) => Place[][][]}} picture where lines of the world are seen on the window */
  show(picture) {
    if (this.#shown.size === 0) return;
    const all = [...this.#shown.values()];
    // A point as a line of no length, which is left out where it is not seen.
    const seen = picture.paths(all.map(({ point }) => [point, point]));
    const { clientWidth } = this.#container;
    for (const [i, { dot, label }] of all.entries()) {
      const at = seen[i][0]?.[0];
      dot.hidden = label.hidden = !at;
      if (!at) continue;
      // On the side that has more room.
      label.classList.toggle('before', at.x > clientWidth / 2);
      dot.style.transform = label.style.transform = `translate(${at.x.toFixed(1)}px, ${at.y.toFixed(1)}px)`;
    }
  }

  /** Another scene is shown, or the connection is lost. */
  clear() {
    for (const client of [...this.#shown.keys()]) this.#drop(client);
  }

  /** @param {string} client */
  #drop(client) {
    const shown = this.#shown.get(client);
    if (!shown) return;
    clearTimeout(shown.timer);
    shown.dot.remove();
    shown.label.remove();
    this.#shown.delete(client);
  }
}
