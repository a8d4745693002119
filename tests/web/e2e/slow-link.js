import { once } from 'node:events';
import { createServer, connect } from 'node:net';

/** Pieces as small as packets, so that a picture does not go over at one blow. */
const PIECE_BYTES = 1400;

/**
 * A slow link in front of a server: whatever goes through shares its bandwidth, each way, and takes its time.
 * It holds no more than is on its way, and takes nothing more meanwhile, so that its ends feel how slow it is.
 */
export class SlowLink {
  #listener;
  #sockets = new Set();

  /**
   * @param {number} port of the server, on this machine
   * @param {{delayMs: number, bytesPerSecond: number}} each way
   */
  static async open(port, { delayMs, bytesPerSecond }) {
    const link = new SlowLink();
    const up = new Way(delayMs, bytesPerSecond);
    const down = new Way(delayMs, bytesPerSecond);
    link.#listener = createServer({ allowHalfOpen: true }, (near) => {
      const far = connect({ port, host: '127.0.0.1', allowHalfOpen: true });
      up.carry(near, far);
      down.carry(far, near);
      for (const socket of [near, far]) {
        socket.setNoDelay(true);
        link.#sockets.add(socket);
        socket.on('error', () => {
          near.destroy();
          far.destroy();
        });
        socket.on('close', () => link.#sockets.delete(socket));
      }
    });
    link.#listener.listen(0, '127.0.0.1');
    await once(link.#listener, 'listening');
    link.address = `http://127.0.0.1:${link.#listener.address().port}/`;
    return link;
  }

  async close() {
    for (const socket of this.#sockets) socket.destroy();
    this.#listener.close();
    await once(this.#listener, 'close');
  }
}

/** One direction of the link. */
class Way {
  #delayMs;
  #bytesPerMs;
  /** When what was put on the link so far will have left. */
  #freeAt = 0;

  constructor(delayMs, bytesPerSecond) {
    this.#delayMs = delayMs;
    this.#bytesPerMs = bytesPerSecond / 1000;
  }

  carry(from, to) {
    // A stream may end while its last data still wait here.
    let passed = Promise.resolve();
    from.on('data', (data) => {
      from.pause();
      passed = this.#pass(data, to).then(() => from.resume());
    });
    from.on('end', () => passed.then(() => setTimeout(() => to.end(), this.#delayMs)));
  }

  async #pass(data, to) {
    for (let at = 0; at < data.length; at += PIECE_BYTES) {
      const piece = data.subarray(at, at + PIECE_BYTES);
      this.#freeAt = Math.max(this.#freeAt, performance.now()) + piece.length / this.#bytesPerMs;
      await until(this.#freeAt);
      setTimeout(() => to.writable && to.write(piece), this.#delayMs);
    }
  }
}

/** A timer is late by a millisecond or two; what is due already does not wait for one. */
function until(time) {
  const ms = time - performance.now();
  return ms > 1 ? new Promise((resolve) => setTimeout(resolve, ms)) : Promise.resolve();
}
