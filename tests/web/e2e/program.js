import { execFile, spawn } from 'node:child_process';
import { once } from 'node:events';
import { mkdtempSync, rmSync } from 'node:fs';
import { mkdtemp, readFile, rm, writeFile } from 'node:fs/promises';
import { tmpdir } from 'node:os';
import path from 'node:path';
import { promisify } from 'node:util';

const READY_WITHIN_MS = 60_000;

const program = fromEnvironment('VRUT_PREVIEW', 'the path of the program');
const scene = fromEnvironment('VRUT_CAR', 'the car');

function fromEnvironment(name, what) {
  const value = process.env[name];
  if (!value) throw new Error(`The environment has to give ${what} in ${name}.`);
  return value;
}

/** A folder that goes when the process does. */
export function temporaryFolder() {
  const folder = mkdtempSync(path.join(tmpdir(), 'vrut-e2e-'));
  process.on('exit', () => rmSync(folder, { recursive: true, force: true }));
  return folder;
}

/** A running `vrut-preview serve` with the car. */
export class Server {
  #child;

  /**
   * @param {number} [port] any free one if left out
   * @param {string[]} [options] more of the command line
   * @param {string} [state] the folder of what is kept; one of its own if left out
   */
  static async start(port = 0, options = [], state = temporaryFolder()) {
    const server = new Server();
    server.state = state;
    server.address = await server.#start(port, options);
    server.port = Number(new URL(server.address).port);
    return server;
  }

  #start(port, options) {
    const words = ['serve', scene, '--listen', `127.0.0.1:${port}`, ...options];
    this.#child = spawn(program, words, { stdio: ['ignore', 'pipe', 'pipe'], env: { ...process.env, XDG_STATE_HOME: this.state } });
    const child = this.#child;
    let said = '';
    let complained = '';
    return new Promise((resolve, reject) => {
      const fail = (why) => reject(new Error(`${why}\n${said}${complained}`));
      const limit = setTimeout(() => fail('The server was not ready in time.'), READY_WITHIN_MS);
      child.once('error', reject);
      child.once('exit', (status, signal) => {
        clearTimeout(limit);
        fail(`The server ended (${signal ?? status}) before it was ready.`);
      });
      child.stderr.setEncoding('utf8').on('data', (text) => {
        complained += text;
      });
      child.stdout.setEncoding('utf8').on('data', (text) => {
        said += text;
        const address = /listening on (http:\S+)\s/.exec(said)?.[1];
        if (!address) return;
        clearTimeout(limit);
        resolve(address);
      });
    });
  }

  /** @param {NodeJS.Signals} name */
  signal(name) {
    this.#child.kill(name);
  }

  /** @param {NodeJS.Signals} [signal] */
  async stop(signal = 'SIGTERM') {
    if (this.#child.exitCode !== null || this.#child.signalCode !== null) return;
    const ended = once(this.#child, 'exit');
    this.#child.kill(signal);
    await ended;
  }
}

/**
 * The picture that `vrut-preview render` makes of the car.
 *
 * @param {{camera: object, width: number, height: number, samples: number}} what
 * @returns {Promise<Buffer>} a PNG file
 */
export async function render({ camera, width, height, samples }) {
  const folder = await mkdtemp(path.join(tmpdir(), 'vrut-preview-'));
  try {
    const pose = path.join(folder, 'camera.json');
    const picture = path.join(folder, 'picture.png');
    const { eye, focus, center, up, fov } = camera;
    await writeFile(pose, JSON.stringify({ eye, focus, center, up, fov }));
    const size = `${width}x${height}`;
    await promisify(execFile)(program, [
      'render', scene, '-o', picture, '--size', size, '--samples', String(samples), '--camera', pose,
    ]);
    return await readFile(picture);
  } finally {
    await rm(folder, { recursive: true });
  }
}
