import { holderName, say } from '../base/texts.js';

/**
 * @import { StateDocument } from '../base/protocol.js'
 * @import { Now } from '../base/store.js'
 */

const CONNECTION = {
  open: 'presence.connected',
  late: 'presence.late',
  starting: 'presence.connecting',
  connecting: 'presence.connecting',
  waiting: 'presence.notConnected',
  refused: 'presence.refused',
};
const LEVEL = { moving: 'quality.moving', still: 'quality.still' };
/** So long the pill is held to take control. */
const HOLD_MS = 800;

/**
 * What is always to be seen: the connection, which is `late` while an answer is, who is in control (`own`, `other`,
 * `absent` or `nobody`), and the picture's kind.
 *
 * @param {Pick<Now, 'phase'|'client'|'state'|'header'|'isLate'>} now
 */
export function presence({ phase, client, state, header, isLate }) {
  if (phase.name !== 'open') return { connection: phase.name };
  const { holder, absent } = state?.control ?? {};
  const others = absent ? 'absent' : 'other';
  const held = holder === client ? 'own' : others;
  const steering = holder ? held : 'nobody';
  if (isLate) return { connection: 'late', steering };
  return { connection: 'open', steering, level: header?.quality?.level };
}

/**
 * Who is in control, in words.
 *
 * @param {string} steering
 * @param {StateDocument} state
 */
function controlWords(steering, { control }) {
  if (steering === 'own') return say('presence.own');
  if (steering === 'nobody') return say('presence.nobody');
  const name = holderName(control);
  return steering === 'absent' ? say('presence.absent', { name }) : say('presence.other', { name });
}

/** The pill in the corner. A tap asks for control, holding it takes control. */
export class Presence {
  #element;
  #timer;
  #may = false;

  /** `on`: `ask` and `take`. */
  constructor(element, on) {
    this.#element = element;
    element.ariaDisabled = true;
    let taken = false;
    element.onpointerdown = () => {
      taken = false;
      if (!this.#may) return;
      element.classList.add('held');
      this.#timer = setTimeout(() => {
        taken = true;
        release();
        on.take();
      }, HOLD_MS);
    };
    const release = () => {
      clearTimeout(this.#timer);
      element.classList.remove('held');
    };
    element.onpointerup = element.onpointerleave = element.onpointercancel = release;
    // Of a long press.
    element.oncontextmenu = (event) => event.preventDefault();
    element.onclick = () => {
      if (this.#may && !taken) on.ask();
    };
  }

  show(page) {
    const { connection, steering = '', level = '' } = presence(page);
    this.#may = page.role === 'control' && ['other', 'absent'].includes(steering);
    const text = [
      say(CONNECTION[connection]),
      connection === 'open' && controlWords(steering, page.state),
      level && say(LEVEL[level]),
    ].filter(Boolean).join(' · ');
    const title = this.#may ? say('presence.hint') : '';
    if (this.#element.title !== title) Object.assign(this.#element, { title, ariaDisabled: !this.#may });
    if (text === this.#element.textContent) return;
    Object.assign(this.#element.dataset, { connection, steering, level });
    this.#element.textContent = text;
  }
}
