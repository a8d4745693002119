import { once } from 'node:events';
import { connect, createServer } from 'node:net';

/** A TCP link to a server that holds back what the server says while a test wants it. */
export class HeldLink {
  #sockets = new Set();
  #held = null;

  /** @param {number} port the server's, on this machine */
  static async open(port) {
    const link = new HeldLink();
    link.listener = createServer((page) => link.#join(page, connect(port, '127.0.0.1')));
    link.listener.listen(0, '127.0.0.1');
    await once(link.listener, 'listening');
    link.address = `http://127.0.0.1:${link.listener.address().port}/`;
    return link;
  }

  hold() {
    this.#held ??= [];
  }

  release() {
    const held = this.#held ?? [];
    this.#held = null;
    for (const pass of held) pass();
  }

  /** Lets pass what was held, and goes on holding. */
  pass() {
    this.release();
    this.hold();
  }

  close() {
    this.listener.close();
    for (const socket of this.#sockets) socket.destroy();
  }

  #join(page, server) {
    for (const socket of [page, server]) {
      this.#sockets.add(socket);
      socket.setNoDelay(true);
      socket.on('error', () => {});
      socket.on('close', () => {
        page.destroy();
        server.destroy();
      });
    }
    page.pipe(server);
    server.on('data', (bytes) => {
      if (this.#held) this.#held.push(() => page.write(bytes));
      else page.write(bytes);
    });
  }
}
