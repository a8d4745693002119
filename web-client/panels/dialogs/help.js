import { element } from '../../base/element.js';
import { say } from '../../base/texts.js';

const ARROWS = '← ↑ ↓ →';
const MOUSE = '<path d="M32 4a10 10 0 0 1 10 10v12a10 10 0 0 1-20 0V14A10 10 0 0 1 32 4zM22 16h20M32 4v12"/>';
const LEFT = '<path class="pressed" d="M31 5v10h-8v-1a9 9 0 0 1 8-9z"/>';
const RIGHT = '<path class="pressed" d="M33 5v10h8v-1a9 9 0 0 0-8-9z"/>';
const TWICE = '<text x="47" y="14">2×</text>';
const DRAG = '<path d="M47 22h13M55 17l5 5-5 5"/>';

const APART = 'M17 30l-8 6M8 29l1 7 7 1M47 10l8-6M48 3l7 1 1 7';
const TURNS_WHEEL = '<path class="wheel" d="M32 8v5"/><path d="M51 16V7M47 11l4-4 4 4M51 24v9M47 29l4 4 4-4"/>';
const PILL = '<rect x="6" y="11" width="52" height="18" rx="9"/>';
const HELD = '<rect class="pressed" x="6" y="11" width="34" height="18" rx="9"/>';

const finger = (x, y) => `<circle class="pressed" cx="${x}" cy="${y}" r="4.5"/>`;
const TAP = `${finger(32, 20)}<circle cx="32" cy="20" r="10"/>`;

/**
 * What a hand can do, by fingers, the mouse or a button of the page, and keys.
 *
 * @typedef {{words?: string, picture?: string, icon?: string, keys?: string[]}} Way either keys, or words with a picture (SVG
 *   within 64 × 40) or one of the page's icons
 * @returns {{title: string, ways: Way[]}[]}
 */
export function gestures() {
  const gesture = (title, ...ways) => ({ title, ways });
  const drawn = (words, picture) => ({ words, picture });
  const shown = (words, icon) => ({ words, icon });
  const keys = (...names) => ({ keys: names });
  return [
    gesture(say('help.turn'),
      drawn(say('help.oneFinger'), `${finger(12, 28)}<path d="M20 24C28 12 40 9 52 13M45 7l7 6-8 5"/>`),
      drawn(say('help.leftButton'), MOUSE + LEFT + DRAG),
      keys(ARROWS)),
    gesture(say('help.move'),
      drawn(say('help.twoFingers'), `${finger(10, 27)}${finger(21, 15)}<path d="M29 21h25M47 14l7 7-7 7"/>`),
      drawn(say('help.rightButton'), MOUSE + RIGHT + DRAG),
      keys('Shift', ARROWS)),
    gesture(say('help.zoom'),
      drawn(say('help.apart'), `${finger(23, 26)}${finger(41, 14)}<path d="${APART}"/>`),
      drawn(say('help.wheel'), MOUSE + TURNS_WHEEL),
      keys('+', '−')),
    gesture(say('help.select'),
      drawn(say('help.doubleTap'), TAP + TWICE),
      drawn(say('help.doubleClick'), MOUSE + LEFT + TWICE)),
    gesture(say('help.deeper'),
      drawn(say('help.anotherTap'), `<path d="M10 4h32v32H10zM17 11h18v18H17z"/>${finger(26, 20)}${TWICE}`),
      drawn(say('help.anotherClick'), MOUSE + LEFT + TWICE)),
    gesture(say('part.clear'), shown(say('part.label'), 'close'), keys('Esc')),
    gesture(say('help.fit'), shown(say('bar.fit'), 'fit'), keys('F')),
    gesture(say('views.home'), shown(say('bar.home'), 'home'), keys('Home')),
    gesture(say('help.control'),
      drawn(say('help.tapPill'), PILL + finger(32, 20)),
      drawn(say('help.holdPill'), HELD + PILL)),
    gesture(say('help.title'), shown(say('menu.title'), 'help'), keys('?')),
  ];
}

/** The gestures, as a dialog. */
export function help() {
  const rows = gestures().map(({ title, ways }) => element('li', {}, element('h3', {}, title), ...ways.map(shown)));
  return {
    title: say('help.title'),
    content: [
      element('ul', { className: 'gestures' }, ...rows),
      element('p', { className: 'note' }, say('help.styles')),
    ],
    show: () => {},
  };
}

/** @param {Way} way */
function shown({ words = '', picture, icon, keys }) {
  if (keys) return element('p', { className: 'keys' }, ...keys.map((name) => element('kbd', {}, name)));
  const made = element('p', { className: icon ? 'shown' : '' });
  made.innerHTML = icon
    ? `<svg class="icon" viewBox="0 0 24 24" aria-hidden="true"><use href="#icon-${icon}"/></svg>`
    : `<svg viewBox="0 0 64 40" aria-hidden="true">${picture}</svg>`;
  made.append(words);
  return made;
}
