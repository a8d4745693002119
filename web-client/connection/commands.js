import { mergePatch } from '../base/merge-patch.js';
import { patchParts } from '../base/patch-parts.js';

/**
 * @import {
 *   ClientControl, ClientCue, ClientMessage, ClientSnapshot, ClientOpen, ClientPick, ClientTree, ServerChecked, ServerShared, ServerTree, StatePatch,
 * } from '../base/protocol.js'
 */

const FLIGHT_MS = 600;
/** More snapshots of a client at a time are refused. */
const SNAPSHOTS = 2;
/** An answer that takes longer is late. */
const LATE_MS = 1000;

/**
 * All that the page asks of the server. Each promises the answer; undefined where `refused` was told why there is none.
 * `late` is called when the first answer that the user waits for becomes late, and when none is late any more. Images,
 * which take long to draw, and the list of scenes, which is read from a disk, are never late: the page asks for them by
 * itself, or says elsewhere that it waits.
 *
 * @typedef {ReturnType<typeof commandsBy>} Commands
 *
 * @param {{ask: (message: ClientMessage) => Promise<*>, refused: (error: *) => void, late: (isLate: boolean) => void}} page
 */
export function commandsBy({ ask, refused, late }) {
  const awaited = watched(ask, late);
  /** @param {Promise<*>} answer */
  const orRefused = (answer) => answer.catch((error) => void refused(error));
  /** @param {ClientMessage} message */
  const tell = (message) => orRefused(awaited(message));
  const changes = new Changes({ ask: awaited, refused });
  const draw = atMost(SNAPSHOTS, ask);
  return {
    /** Together with what waits for an answer; see Changes. @param {StatePatch} patch */
    change: (patch) => changes.add(patch),
    /** By itself, a long one in parts. @param {StatePatch} patch */
    patch: async (patch) => {
      let answer;
      for (const part of patchParts(patch)) {
        answer = await tell({ type: 'patch', patch: part });
        if (!answer) break;
      }
      return answer;
    },
    /** @param {Omit<ClientControl, 'type'>} action */
    control: (action) => tell({ type: 'control', ...action }),
    /**
     * Closes or opens what turns about a hinge.
     *
     * @param {number} node
     * @param {0|1} [open] the other of the two if left out
     */
    swing: (node, open) => tell({ type: 'swing', node, open, ...(movesLittle() ? { ms: 0 } : {}) }),
    /** @param {number} [node] the whole scene if left out */
    fit: (node) => tell({ type: 'fit', node }),
    fly: (camera) => tell({ type: 'fly', keyframes: [{ at: FLIGHT_MS, camera }] }),
    /** @param {Omit<ClientPick, 'type'>} place */
    pick: (place) => tell({ type: 'pick', ...place }),
    /** @param {Omit<ClientTree, 'type'>} query */
    tree: (query) => tell({ type: 'tree', ...query }),
    /** @param {{width: number, height: number}} size */
    snapshot: (size) => orRefused(draw({ type: 'snapshot', ...size, jpegQuality: 95 })),
    /** @param {{name: string, camera?: ClientCue['camera']}} which */
    cue: (which) => tell({ type: 'cue', ...which }),
    /** What of a list of cues does not go with the scene. @param {object} cues @returns {Promise<ServerChecked|undefined>} */
    check: (cues) => tell({ type: 'check', cues }),
    /** Nothing where it cannot be drawn. @param {Omit<ClientSnapshot, 'type'>} picture */
    picture: (picture) => draw({ type: 'snapshot', ...picture }).catch(() => undefined),
    /** @param {'start'|'stop'} action */
    record: (action) => tell({ type: 'record', action }),
    scenes: () => orRefused(ask({ type: 'scenes' })),
    /** @param {string} page its address @returns {Promise<ServerShared|undefined>} */
    share: (page) => tell({ type: 'share', page }),
    /** @param {string} scene @param {ClientOpen['upAxis']} [upAxis] as chosen last if left out */
    open: (scene, upAxis) => tell({ type: 'open', scene, upAxis }),
  };
}

/**
 * Asks, and calls `late` with true when an answer becomes late, and with false when none is late any more.
 *
 * @param {(message: ClientMessage) => Promise<*>} ask
 * @param {(isLate: boolean) => void} late
 */
function watched(ask, late) {
  let count = 0;
  /** @param {ClientMessage} message */
  return async (message) => {
    let isLate = false;
    const timer = setTimeout(() => {
      isLate = true;
      count += 1;
      if (count === 1) late(true);
    }, LATE_MS);
    try {
      return await ask(message);
    } finally {
      clearTimeout(timer);
      if (isLate) {
        count -= 1;
        if (count === 0) late(false);
      }
    }
  };
}

/**
 * Asks so many questions at a time; the others wait, in their order.
 *
 * @param {number} most
 * @param {(message: ClientMessage) => Promise<*>} ask
 */
function atMost(most, ask) {
  const waiting = /** @type {(() => void)[]} */ ([]);
  let free = most;
  /** @param {ClientMessage} message */
  return async (message) => {
    if (free > 0) free -= 1;
    else await new Promise((resolve) => waiting.push(() => resolve(undefined)));
    try {
      return await ask(message);
    } finally {
      const next = waiting.shift();
      if (next) next();
      else free += 1;
    }
  };
}

function movesLittle() {
  return globalThis.matchMedia?.('(prefers-reduced-motion: reduce)').matches;
}

/**
 * Promises all nodes that a `tree` query finds, page after page; undefined where an answer is missing.
 *
 * @param {(query: Omit<ClientTree, 'type'>) => Promise<ServerTree|undefined>} tree
 * @param {Omit<ClientTree, 'type'>} query
 */
export async function allOf(tree, query) {
  const nodes = [];
  let after;
  do {
    const answer = await tree({ ...query, after });
    if (!answer) return undefined;
    nodes.push(...answer.nodes);
    after = answer.next;
  } while (after !== undefined);
  return nodes;
}

/**
 * Sends changes of the state, one at a time: while one is on its way, those that follow become one. A slider
 * under a finger so never gets ahead of the server.
 */
export class Changes {
  #ask;
  #refused;
  /** @type {?object} */
  #next = null;
  /** @type {?Promise<void>} */
  #sending = null;

  /** `ask` sends a message and promises its answer; `refused` is told the error where there is none. */
  constructor({ ask, refused }) {
    this.#ask = ask;
    this.#refused = refused;
  }

  /** Promises that all that was added is answered; what was refused has been told. */
  add(patch) {
    this.#next = mergePatch(this.#next, patch, true);
    this.#sending ??= this.#send();
    return this.#sending;
  }

  async #send() {
    while (this.#next) {
      const patch = this.#next;
      this.#next = null;
      await this.#ask({ type: 'patch', patch }).catch(this.#refused);
    }
    this.#sending = null;
  }
}
