import { say } from './texts.js';

const TEXTS = {
  open: 'presence.connected',
  starting: 'presence.connecting',
  connecting: 'presence.connecting',
  waiting: 'presence.notConnected',
  refused: 'presence.refused',
  steering: 'presence.steering',
  kept: 'presence.kept',
  watching: 'presence.watching',
  free: 'presence.free',
  moving: 'quality.moving',
  still: 'quality.still',
};

/** What is always to be seen, as keys of TEXTS: the connection, who steers, and the picture's kind. */
export function presence({ phase, role, client, state, header }) {
  if (phase.name !== 'open') return { connection: phase.name };
  const { holder, kept } = state?.control ?? {};
  const others = !holder && role === 'control' ? 'free' : 'watching';
  const own = kept ? 'kept' : 'steering';
  return { connection: 'open', steering: holder === client ? own : others, level: header?.quality?.level };
}

/** Says it, and tells the style sheet. */
export class Presence {
  #element;

  constructor(element) {
    this.#element = element;
  }

  show(page) {
    const { connection, steering = '', level = '' } = presence(page);
    const text = [connection, steering, level].filter(Boolean).map((key) => say(TEXTS[key])).join(' · ');
    if (text === this.#element.textContent) return;
    Object.assign(this.#element.dataset, { connection, steering, level });
    this.#element.textContent = text;
  }
}
