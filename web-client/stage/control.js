import { button, element } from '../base/element.js';
import { clientName, holderName, say } from '../base/texts.js';

/** @import { ClientControl, ClientHello, StateDocument } from '../base/protocol.js' */

const OFFERED_MS = 8000;

/**
 * What the bar says of control to the page of `client`, or null: to the holder that somebody asks, to another that it
 * has asked, or, where that is `offered`, that it may ask. An action is a `control` message without its type.
 *
 * @param {{role?: ClientHello['role'], client?: string, control?: StateDocument['control'], offered?: boolean}} now
 * @returns {?{text: string, actions: {label: string, message: Omit<ClientControl, 'type'>}[]}}
 */
export function controlBar({ role, client, control, offered }) {
  if (role !== 'control' || !control?.holder) return null;
  const { holder, asking = [] } = control;
  if (holder === client) {
    const [first] = asking;
    return first ? {
      text: say('control.asks', { name: clientName(first) }),
      actions: [
        { label: say('control.give'), message: { action: 'give', client: first.client } },
        { label: say('control.decline'), message: { action: 'decline', client: first.client } },
      ],
    } : null;
  }
  const name = holderName(control);
  if (asking.some((one) => one.client === client)) {
    return { text: say('control.asked', { name }), actions: [{ label: say('control.cancel'), message: { action: 'cancel' } }] };
  }
  const text = control.absent ? say('control.absent', { name }) : say('control.other', { name });
  return offered ? { text, actions: [{ label: say('control.ask'), message: { action: 'ask' } }] } : null;
}

/** Shows it, and sends what is chosen. */
export class ControlBar {
  #element;
  #on;
  #offered = false;
  #timer;
  #now = {};
  #shown = 'null';
  /** The id under which this page waits for an answer; undefined while it does not. */
  #askedAs;
  #cancelled = false;

  /** `on`: `send` a `control` message, and `declined` by the holder of a name. */
  constructor(element, on) {
    this.#element = element;
    this.#on = on;
  }

  /** To who touches the picture, and does not hold control. */
  offer() {
    this.#offered = true;
    clearTimeout(this.#timer);
    this.#timer = setTimeout(() => {
      this.#offered = false;
      this.show(this.#now);
    }, OFFERED_MS);
    this.show(this.#now);
  }

  /** By `role`, `client` and the state's `control`. */
  show(now) {
    this.#now = now;
    const { client, control } = now;
    const asks = client !== undefined && control?.asking?.some((one) => one.client === client);
    const ended = this.#askedAs === client && client !== undefined && !asks;
    if (ended && !this.#cancelled && control.holder !== client) this.#on.declined(holderName(control));
    this.#askedAs = asks ? client : undefined;
    this.#cancelled &&= asks;
    const bar = controlBar({ ...now, offered: this.#offered });
    const shown = JSON.stringify(bar);
    if (shown === this.#shown) return;
    this.#shown = shown;
    const act = (message) => () => {
      this.#cancelled = message.action === 'cancel';
      this.#on.send({ type: 'control', ...message });
    };
    this.#element.replaceChildren(...(bar ? [
      element('span', {}, bar.text),
      ...bar.actions.map(({ label, message }) => button(label, act(message))),
    ] : []));
  }
}
