/** @import { StateDocument } from '../base/protocol.js' */

/** @typedef {StateDocument['navigation']['style']} Style */
/** @typedef {'rotate'|'pan'|'zoom'} DragOperation */

/** `PointerEvent.button` */
const LEFT = 0;
const MIDDLE = 1;
const RIGHT = 2;

/** The bit of a button in `PointerEvent.buttons`; 0 for buttons without a binding. */
const buttonMask = (button) => ({ [LEFT]: 1, [RIGHT]: 2, [MIDDLE]: 4 })[button] ?? 0;

/**
 * @typedef {object} Grip the buttons and keys held; sampled when a drag starts, or restarts with other buttons
 * @property {number} button the held one that was pressed last; −1 where it is not known
 * @property {number} buttons those held
 * @property {boolean} afterChord another button was held together with the middle one, which is still held, and has
 *   been released
 * @property {boolean} alt
 * @property {number} number the number key held, the newest of several; 0 none
 */

/**
 * @typedef {object} Drag
 * @property {Style} style
 * @property {number} button
 * @property {boolean} [alt] only while Alt is held
 * @property {number} [number] only while this number key is held
 * @property {'alone'|'with other'|'after other'} [chord] how the button is held; without it, it is the one pressed
 *   last, whatever else is held
 * @property {DragOperation} operation
 */

/**
 * The first row that applies says what a drag does; none: nothing.
 *
 * @type {Drag[]}
 */
const DRAGS = [
  { style: 'vrut', button: LEFT, operation: 'rotate' },
  { style: 'vrut', button: RIGHT, operation: 'pan' },
  { style: 'vrut', button: MIDDLE, operation: 'zoom' },

  { style: 'maya', button: LEFT, alt: true, operation: 'rotate' },
  { style: 'maya', button: MIDDLE, alt: true, operation: 'pan' },
  { style: 'maya', button: RIGHT, alt: true, operation: 'zoom' },

  { style: 'catia', button: MIDDLE, chord: 'alone', operation: 'pan' },
  { style: 'catia', button: MIDDLE, chord: 'with other', operation: 'rotate' },
  { style: 'catia', button: MIDDLE, chord: 'after other', operation: 'zoom' },

  { style: 'cinema4d', button: LEFT, alt: true, operation: 'rotate' },
  { style: 'cinema4d', button: MIDDLE, alt: true, operation: 'pan' },
  { style: 'cinema4d', button: RIGHT, alt: true, operation: 'zoom' },
  { style: 'cinema4d', button: LEFT, number: 1, operation: 'pan' },
  { style: 'cinema4d', button: LEFT, number: 2, operation: 'zoom' },
  { style: 'cinema4d', button: LEFT, number: 3, operation: 'rotate' },
];

/**
 * What a drag by mouse or pen does; null: nothing.
 *
 * @param {Style} style
 * @param {Grip} grip
 * @returns {?DragOperation}
 */
export function dragOperation(style, grip) {
  const row = DRAGS.find((drag) => drag.style === style && (!drag.alt || grip.alt) &&
    (drag.number === undefined || drag.number === grip.number) && isHeld(drag, grip));
  return row?.operation ?? null;
}

/**
 * @param {Drag} drag
 * @param {Grip} grip
 */
function isHeld({ button, chord }, grip) {
  if (!chord) return grip.button === button;
  const held = grip.buttons & (buttonMask(LEFT) | buttonMask(MIDDLE) | buttonMask(RIGHT));
  if (!(held & buttonMask(button))) return false;
  const isAlone = held === buttonMask(button);
  if (chord === 'with other') return !isAlone;
  return isAlone && grip.afterChord === (chord === 'after other');
}

/**
 * A pointer's grip as it is pressed.
 *
 * @param {{button: number, buttons: number, altKey?: boolean}} message
 * @param {number} number the number key held
 * @returns {Grip}
 */
export function pressedGrip({ button, buttons, altKey = false }, number) {
  const held = buttons === 0 ? buttonMask(button) : buttons;
  return { button: button >= 0 ? button : firstHeld(held), buttons: held, afterChord: false, alt: altKey, number };
}

/**
 * Another button went down or up.
 *
 * @param {Grip} grip
 * @param {{button: number, buttons: number}} message
 * @returns {Grip}
 */
export function changedGrip(grip, { button, buttons }) {
  const others = buttonMask(LEFT) | buttonMask(RIGHT);
  const keepsMiddle = (grip.buttons & buttons & buttonMask(MIDDLE)) !== 0;
  const wentDown = (buttons & buttonMask(button)) !== 0;
  const last = wentDown ? button : grip.button;
  return {
    ...grip,
    buttons,
    button: (buttons & buttonMask(last)) !== 0 ? last : firstHeld(buttons),
    afterChord: keepsMiddle && (grip.afterChord || (grip.buttons & others) !== 0),
  };
}

const firstHeld = (buttons) => [LEFT, RIGHT, MIDDLE].find((button) => (buttons & buttonMask(button)) !== 0) ?? -1;
