import { say } from './texts.js';

/** @import { StateDocument } from './protocol.js' */

/**
 * How people call a client: by the name that it gave in `hello`, or else by its id.
 *
 * @param {{client?: string, name?: string}} who
 */
export function clientName({ client, name }) {
  return name || say('connection.client', { id: client });
}

/**
 * How people call the holder of `control` of the state.
 *
 * @param {Partial<StateDocument['control']>} control
 */
export function holderName({ holder, name }) {
  return clientName({ client: holder, name });
}
