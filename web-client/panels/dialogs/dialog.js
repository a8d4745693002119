import { button, element } from '../../base/element.js';
import { say } from '../../base/texts.js';

/**
 * Shows a modal dialog until it is closed: by its button, Escape or a tap beside it.
 *
 * @param {{name: string, title: string, content: HTMLElement[]}} about
 * @param {() => void} closed
 */
export function showDialog({ name, title, content }, closed) {
  // All else is inert: what has to be said is said in here.
  const lines = /** @type {HTMLElement} */ (document.getElementById('lines'));
  const next = /** @type {HTMLElement} */ (lines.nextElementSibling);
  const heading = element('h2', { id: 'dialog-title' }, title);
  const close = button(say('dialog.close'), () => made.close(), { icon: 'close', quiet: true, only: true });
  // It has the focus where nothing in it has, or keys would reach the view.
  const made = element('dialog', { className: name, tabIndex: -1, 'aria-labelledby': 'dialog-title' },
    element('div', { className: 'head' }, heading, close), ...content, lines);

  const isBeside = ({ target, clientX, clientY }) => {
    const { left, right, top, bottom } = made.getBoundingClientRect();
    return target === made && (clientX < left || clientX > right || clientY < top || clientY > bottom);
  };
  // Both ends: a drag out of it is no tap beside it.
  let pressedBeside = false;
  made.onpointerdown = (event) => {
    pressedBeside = isBeside(event);
  };
  made.onclick = (event) => {
    if (pressedBeside && isBeside(event)) made.close();
  };
  made.onkeydown = (event) => event.stopPropagation();
  made.onclose = () => {
    next.before(lines);
    made.remove();
    closed();
  };
  document.body.append(made);
  made.showModal();
  made.focus();
  return made;
}
