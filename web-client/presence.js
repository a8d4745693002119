import { texts } from './texts.js';

const word = texts({
  open: ['Connected', 'Připojeno'],
  starting: ['Connecting', 'Připojování'],
  connecting: ['Connecting', 'Připojování'],
  waiting: ['Not connected', 'Nepřipojeno'],
  refused: ['Refused', 'Odmítnuto'],
  steering: ['Steering', 'Řídíte'],
  kept: ['Steering, kept', 'Řídíte trvale'],
  watching: ['Watching', 'Sledujete'],
  free: ['Nobody steers', 'Nikdo neřídí'],
  moving: ['Moving', 'V pohybu'],
  still: ['Still', 'V klidu'],
});

/** What is always to be seen, as keys of words: the connection, who steers, and the picture's kind. */
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
    const text = [connection, steering, level].filter(Boolean).map((key) => word(key)).join(' · ');
    if (text === this.#element.textContent) return;
    Object.assign(this.#element.dataset, { connection, steering, level });
    this.#element.textContent = text;
  }
}
