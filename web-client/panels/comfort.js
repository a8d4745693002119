import { element } from '../base/element.js';
import { onChange } from '../base/store.js';
import { say, written } from '../base/texts.js';
import { range, toggle } from './controls.js';
import { each } from './section.js';

/**
 * @import { StateDocument } from '../base/protocol.js'
 * @import { Page } from './section.js'
 */

/** Until walls turn at full speed. */
const EASES_S = 0.25;
/** What is below does not jump under a finger. */
const KEEPS_ITS_LINE = '\u00a0';

/** How fast walls follow, and how far they are behind; nothing where there are none. @param {Pick<Page, 'commands'>} page */
export function gentleWalls({ commands }) {
  const on = toggle(say('comfort.on'), (on) => commands.change({ comfort: { on } }));
  const speed = range(say('comfort.speed'), { min: 10, max: 180, step: 5, say: (degrees) => written(degrees, 0, '°/s') },
    (degrees) => commands.change({ comfort: { degreesPerSecond: degrees, degreesPerSecondSquared: degrees / EASES_S } }));
  const behind = element('p', { className: 'note' });
  const all = element('fieldset', { className: 'sections' }, on.element, speed.element, behind);
  return {
    content: [all],
    show: each(
      onChange(({ steers }) => [steers], (steers) => Object.assign(all, { disabled: !steers })),
      onChange(({ state }) => [state.clients], (clients) => Object.assign(all, { hidden: !hasWalls(clients) })),
      onChange(({ state }) => [state.comfort], (comfort) => {
        on.show(comfort?.on);
        speed.show(comfort?.degreesPerSecond);
        speed.element.hidden = !comfort?.on;
      }),
      onChange(({ state, language }) => [behindWords(state.walls), language], (words) => {
        behind.textContent = words ? say('comfort.walls', { behind: words }) : KEEPS_ITS_LINE;
      })),
  };
}

/** @param {StateDocument['clients']} clients */
export function hasWalls(clients) {
  return Object.values(clients).some(({ role }) => role === 'host');
}

/**
 * How far the walls are behind, in whole degrees, or else in metres; '' where nobody would see it.
 *
 * @param {StateDocument['walls']} [walls]
 */
export function behindWords(walls) {
  if (!walls) return '';
  const degrees = Math.round(walls.behindDegrees);
  if (degrees > 0) return say('comfort.behind', { way: `${written(degrees)}°` });
  return walls.behindMetres >= 0.05 ? say('comfort.behind', { way: written(walls.behindMetres, 1, 'm') }) : '';
}
