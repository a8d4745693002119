import { element } from '../base/element.js';

/**
 * @import { StateDocument } from '../base/protocol.js'
 * @import { Picture } from './picture.js'
 */

/** Shows each marker's text beside its sign in the picture, in a container as large as the window. */
export class Labels {
  #container;

  constructor(container) {
    this.#container = container;
  }

  /** @param {Picture} picture @param {StateDocument['markers']|undefined} markers */
  show(picture, markers) {
    const { children, clientWidth } = this.#container;
    const places = labelPlaces(picture, markers);
    while (children.length > places.length) children[0].remove();
    for (const [i, { text, x, y }] of places.entries()) {
      const label = children[i] ?? this.#container.appendChild(element('p', {}, element('span')));
      if (label.textContent !== text) label.firstChild.textContent = text;
      // On the side that has more room.
      label.classList.toggle('before', x > clientWidth / 2);
      label.style.transform = `translate(${x.toFixed(1)}px, ${y.toFixed(1)}px)`;
    }
  }
}

/**
 * {text, x, y} on the window.
 *
 * @param {Pick<Picture, 'header'|'mapping'|'placeOf'>} picture
 * @param {StateDocument['markers']|undefined} markers
 */
export function labelPlaces(picture, markers) {
  const { header } = picture;
  const mapping = picture.mapping();
  const origin = mapping(0, 0);
  const perPixel = mapping(1, 0).x - origin.x;
  const places = [];
  for (const [name, point] of Object.entries(header?.markers ?? {})) {
    const text = markers?.[name]?.text;
    const at = text && picture.placeOf(point);
    if (at) places.push({ text, x: (at.x - origin.x) / perPixel, y: (at.y - origin.y) / perPixel });
  }
  return places;
}
