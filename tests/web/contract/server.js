// Starts the real program. VRUT_PREVIEW in the environment says where it is.
import { spawn } from 'node:child_process';
import { once } from 'node:events';
import { mkdtempSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import path from 'node:path';
import { fileURLToPath } from 'node:url';
import { Schema } from './schema.js';

const READY_WITHIN_MS = 60_000;
const STOPPED_WITHIN_MS = 10_000;

export const PROGRAM = process.env.VRUT_PREVIEW;
export const SCENES = fileURLToPath(new URL('scene', import.meta.url));
export const sceneFile = (name) => path.join(SCENES, name);

/** A folder that goes when the process does. */
export function temporaryFolder() {
  const folder = mkdtempSync(path.join(tmpdir(), 'vrut-contract-'));
  process.on('exit', () => rmSync(folder, { recursive: true, force: true }));
  return folder;
}

export class Server {
  #child;
  #log = '';

  /**
   * @param {{scene?: string, options?: string[], env?: object, bearer?: string}} [what] `bearer`: token for HTTP
   * @returns {Promise<Server>} that listens, with its JSON Schema read
   */
  static async start({ scene = sceneFile('stage.vrut'), options = [], env = {}, bearer } = {}) {
    const server = new Server();
    server.url = await server.#start(['serve', scene, '--listen', '127.0.0.1:0', ...options], env);
    server.ws = server.url.replace('http', 'ws') + 'ws';
    server.headers = bearer ? { authorization: `Bearer ${bearer}` } : {};
    server.schema = await Schema.fetch(server);
    return server;
  }

  #start(command, env) {
    if (!PROGRAM) throw new Error('The environment has to give the path of the program in VRUT_PREVIEW.');
    const child = (this.#child = spawn(PROGRAM, command, { env: { ...process.env, XDG_STATE_HOME: temporaryFolder(), ...env } }));
    process.on('exit', () => child.kill('SIGKILL'));
    let printed = '';
    return new Promise((resolve, reject) => {
      const fail = (why) => reject(new Error(`${why}\n${printed}${this.#log}`));
      const limit = setTimeout(() => fail('The server was not ready in time.'), READY_WITHIN_MS);
      child.once('error', reject);
      child.once('exit', (status) => fail(`The server ended with ${status} before it was ready.`));
      child.stderr.setEncoding('utf8').on('data', (text) => (this.#log += text));
      child.stdout.setEncoding('utf8').on('data', (text) => {
        printed += text;
        const address = /listening on (http:\S+)\n/.exec(printed)?.[1];
        if (!address) return;
        clearTimeout(limit);
        resolve(new URL('/', address).href);
      });
    });
  }

  /**
   * HTTP; `route` without the leading slash. Each request has a connection of its own: the server may close an idle
   * one at the moment in which fetch() would use it again.
   */
  get(route, headers = this.headers) {
    return fetch(this.url + route, { headers: { ...headers, connection: 'close' } });
  }

  /** @returns {Promise<number | null>} the exit status */
  async stop(signal = 'SIGTERM') {
    if (this.#child.exitCode !== null || this.#child.signalCode !== null) return this.#child.exitCode;
    const ended = once(this.#child, 'exit');
    this.#child.kill(signal);
    const limit = setTimeout(() => this.#child.kill('SIGKILL'), STOPPED_WITHIN_MS);
    const [status] = await ended;
    clearTimeout(limit);
    return status;
  }
}
