import { button, element } from '../base/element.js';
import { onChange } from '../base/store.js';
import { say } from '../base/texts.js';
import { toggle } from './controls.js';
import { each } from './section.js';

/** @import { Page } from './section.js' */

/** A button that begins and ends pointing, pressed meanwhile. @param {() => void} turn */
export function pointButton(turn) {
  const made = button(say('pointing.point'), turn, { icon: 'point' });
  made.ariaPressed = 'false';
  return made;
}

/** That button, and whether watchers may point. @param {Page} page */
export function pointing({ commands, turnPointing, makeRoom }) {
  const point = pointButton(() => {
    makeRoom();
    turnPointing();
  });
  const watchers = toggle(say('pointing.watchers'), (allowed) => commands.change({ pointing: { watchers: allowed } }));
  const all = element('fieldset', { className: 'sections' }, watchers.element);
  return {
    content: [element('div', { className: 'buttons' }, point), all],
    show: each(
      onChange(({ points }) => [points], (points) => Object.assign(point, { ariaPressed: String(points) })),
      onChange(({ steers }) => [steers], (steers) => Object.assign(all, { disabled: !steers })),
      onChange(({ state }) => [state.pointing], (allowed) => watchers.show(allowed?.watchers))),
  };
}
