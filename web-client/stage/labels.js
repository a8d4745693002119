import { element } from '../base/element.js';

/**
 * @import { FrameHeader, StateDocument } from '../base/protocol.js'
 * @import { Similarity } from './prediction.js'
 */

/** Shows each marker's text beside its sign in the picture, in a container as large as the window. */
export class Labels {
  #container;

  constructor(container) {
    this.#container = container;
  }

  /** @param {Parameters<typeof labelPlaces>} picture */
  show(...picture) {
    const { children, clientWidth } = this.#container;
    const places = labelPlaces(...picture);
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
 * {text, x, y} on the window, of a picture's header, the state's markers, the picture's mapping(), and its move.
 *
 * @param {?FrameHeader} header
 * @param {StateDocument['markers']|undefined} markers
 * @param {(x: number, y: number) => {x: number, y: number}} mapping
 * @param {?Similarity} [move]
 */
export function labelPlaces(header, markers, mapping, move) {
  const { scale, x, y } = move ?? { scale: 1, x: 0, y: 0 };
  const origin = mapping(0, 0);
  const perPixel = mapping(1, 0).x - origin.x;
  const places = [];
  if (!header) return places;
  for (const [name, point] of Object.entries(header.markers ?? {})) {
    const text = markers?.[name]?.text;
    const at = text && inView(header, point);
    if (!at) continue;
    const { width, height } = header.view;
    places.push({
      text,
      x: ((at.x - width / 2) * scale + x + width / 2 - origin.x) / perPixel,
      y: ((at.y - height / 2) * scale + y + height / 2 - origin.y) / perPixel,
    });
  }
  return places;
}

/**
 * Where a point of the world is in the view; null behind the camera and outside the picture.
 *
 * @param {Pick<FrameHeader, 'camera'|'view'>} header
 * @param {number[]} point
 */
export function inView({ camera, view }, point) {
  const [x, y, , w] = transformed(camera.projectionMatrix, transformed(camera.viewMatrix, [...point, 1]));
  if (!(w > 0) || Math.abs(x) > w || Math.abs(y) > w) return null;
  return { x: ((1 + x / w) / 2) * view.width, y: ((1 - y / w) / 2) * view.height };
}

/** A row-major 4×4 matrix times a column vector. */
function transformed(matrix, vector) {
  return [0, 4, 8, 12].map((row) => vector.reduce((sum, value, i) => sum + matrix[row + i] * value, 0));
}
