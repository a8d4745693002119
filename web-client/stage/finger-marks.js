import { element } from '../base/element.js';

/** A `.finger-mark` for each finger and pen, `.pressed` while that is; in a container that fills the window. */
export class FingerMarks {
  #container;
  #pressed = new Map();

  constructor(container) {
    this.#container = container;
  }

  /** Coordinates are the window's. */
  press(pointerId, x, y) {
    const free = this.#pressed.get(pointerId) ?? this.#container.querySelector(':not(.pressed)');
    const mark = free ?? this.#container.appendChild(element('div', { className: 'finger-mark' }));
    this.#pressed.set(pointerId, mark);
    this.move(pointerId, x, y);
    mark.classList.add('pressed');
  }

  move(pointerId, x, y) {
    const mark = this.#pressed.get(pointerId);
    if (mark) mark.style.transform = `translate(${x}px, ${y}px)`;
  }

  release(pointerId) {
    this.#pressed.get(pointerId)?.classList.remove('pressed');
    this.#pressed.delete(pointerId);
  }

  clear() {
    for (const pointerId of this.#pressed.keys()) this.release(pointerId);
  }
}
