// Starts the real program. VRUT_PREVIEW in the environment says where it is.
import { spawn } from 'node:child_process';
import { once } from 'node:events';
import { existsSync, mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import path from 'node:path';
import { setTimeout as delay } from 'node:timers/promises';
import { fileURLToPath } from 'node:url';
import { Schema } from './schema.js';

const READY_WITHIN_MS = 60_000;
const STOPPED_WITHIN_MS = 10_000;

export const PROGRAM = process.env.VRUT_PREVIEW;
export const SCENES = fileURLToPath(new URL('scene', import.meta.url));
/** The same for clients that come by an edge: the environment names the module that starts those. */
export const BY_EDGE = Boolean(process.env.VRUT_BY_EDGE);
const byEdge = BY_EDGE && (await import(process.env.VRUT_BY_EDGE));
export const sceneFile = (name) => path.join(SCENES, name);

/** A folder that goes when the process does. */
export function temporaryFolder() {
  const folder = mkdtempSync(path.join(tmpdir(), 'vrut-contract-'));
  process.on('exit', () => rmSync(folder, { recursive: true, force: true }));
  return folder;
}

export class Server {
  #children = [];
  #log = '';

  /**
   * @param {{scene?: string, options?: string[], env?: object, bearer?: string}} [what] `bearer`: token for HTTP
   * @returns {Promise<Server>} that listens, with its JSON Schema read
   */
  static async start({ scene = sceneFile('stage.vrut'), options = [], env = {}, bearer } = {}) {
    const server = new Server();
    const listen = ['--listen', '127.0.0.1:0'];
    if (BY_EDGE) {
      const { serve, edge, room } = await byEdge.commandLines(options);
      await server.#start(['serve', scene, ...listen, ...serve], env);
      server.url = `${await server.#start(['edge', ...listen, ...edge], env)}rooms/${room}/`;
    } else {
      server.url = await server.#start(['serve', scene, ...listen, ...options], env);
    }
    server.ws = server.url.replace('http', 'ws') + 'ws';
    server.headers = bearer ? { authorization: `Bearer ${bearer}` } : {};
    // A room that was just opened at an edge is not ready for a moment.
    for (const end = Date.now() + READY_WITHIN_MS; BY_EDGE && (await server.get('readyz')).status === 503 && Date.now() < end;) await delay(20);
    server.schema = await Schema.fetch(server);
    return server;
  }

  #start(command, env) {
    if (!PROGRAM) throw new Error('The environment has to give the path of the program in VRUT_PREVIEW.');
    const child = spawn(PROGRAM, command, { env: { ...process.env, XDG_STATE_HOME: temporaryFolder(), ...env } });
    this.#children.push(child);
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
    let status = null;
    for (const child of this.#children.reverse()) {
      if (child.exitCode !== null || child.signalCode !== null) {
        status = child.exitCode;
        continue;
      }
      const ended = once(child, 'exit');
      child.kill(signal);
      const limit = setTimeout(() => child.kill('SIGKILL'), STOPPED_WITHIN_MS);
      [status] = await ended;
      clearTimeout(limit);
    }
    return status;
  }
}
