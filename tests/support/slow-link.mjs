import { spawn } from 'node:child_process';
import { once } from 'node:events';
import { createInterface } from 'node:readline';

const program = process.env.VRUT_SLOW_LINK;

/** A slow link in front of a server on this machine: the program `slow_link`, which the environment gives in VRUT_SLOW_LINK. */
export class SlowLink {
  #child;

  /**
   * @param {number} port of the server
   * @param {{delayMs?: number, bytesPerSecond: number}} quality each way
   */
  static async open(port, { delayMs = 0, bytesPerSecond }) {
    if (!program) throw new Error('The environment has to give the path of slow_link in VRUT_SLOW_LINK.');
    const words = ['--to', port, '--bytes-per-second', bytesPerSecond, '--delay-ms', delayMs].map(String);
    const link = new SlowLink();
    link.#child = spawn(program, words, { stdio: ['pipe', 'pipe', 'inherit'] });
    const [line] = await Promise.race([
      once(createInterface(link.#child.stdout), 'line'),
      once(link.#child, 'exit').then(([status]) => Promise.reject(new Error(`slow_link ended (${status})`))),
    ]);
    link.port = Number(line);
    link.address = `http://127.0.0.1:${link.port}/`;
    return link;
  }

  /** @param {number} bytesPerSecond each way, of what is sent from now on */
  rate(bytesPerSecond) {
    this.#command(`rate ${bytesPerSecond}`);
  }

  /** @param {number} ms each way, of what is sent from now on */
  delay(ms) {
    this.#command(`delay ${ms}`);
  }

  /** Nothing leaves and nothing arrives for so long. @param {number} ms */
  stall(ms) {
    this.#command(`stall ${ms}`);
  }

  /** Resets all connections; new ones may come. */
  cut() {
    this.#command('cut');
  }

  /** Ends the link and its connections; fails where a command was not understood. */
  async close() {
    const ended = once(this.#child, 'exit');
    this.#child.stdin.end();
    const [status] = await ended;
    if (status !== 0) throw new Error(`slow_link ended with ${status}`);
  }

  #command(line) {
    this.#child.stdin.write(`${line}\n`);
  }
}
