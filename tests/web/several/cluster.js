// NATS servers, servers that share a room, and edges, each a process of its own.
import { spawn } from 'node:child_process';
import { once } from 'node:events';
import { existsSync } from 'node:fs';
import { connect, createServer } from 'node:net';
import { setTimeout as delay } from 'node:timers/promises';
import { PROGRAM, sceneFile, temporaryFolder } from '../contract/server.js';
import { Schema } from '../contract/schema.js';

export const NATS_SERVER = '/usr/sbin/nats-server';
export const missing = existsSync(NATS_SERVER) ? false : `${NATS_SERVER} is missing`;
process.setMaxListeners(0);
const READY_WITHIN_MS = 60_000;

/** A machine: its address, and what runs a command there. */
const HERE = { address: '127.0.0.1', enter: [] };

export async function eventually(what, check, within = READY_WITHIN_MS) {
  let failure;
  for (const end = Date.now() + within; Date.now() < end; await delay(20)) {
    const result = await Promise.resolve().then(check).catch((error) => void (failure = error));
    if (result) return result;
  }
  throw new Error(`Not within ${within} ms: ${what}`, { cause: failure });
}

export async function freePort() {
  const server = createServer().listen(0, '127.0.0.1');
  await once(server, 'listening');
  const { port } = server.address();
  server.close();
  await once(server, 'close');
  return port;
}

export class Process {
  log = '';
  constructor(command, ...options) {
    this.child = spawn(command, options, { env: { ...process.env, XDG_STATE_HOME: temporaryFolder() } });
    this.exit = () => this.child.kill('SIGKILL');
    process.on('exit', this.exit);
    for (const stream of [this.child.stdout, this.child.stderr]) stream.setEncoding('utf8').on('data', (text) => (this.log += text));
    this.ended = once(this.child, 'close').then(([status]) => status);
  }
  signal(signal) {
    this.child.kill(signal);
  }
  async stop(signal = 'SIGKILL') {
    this.signal(signal);
    const status = await this.ended;
    process.removeListener('exit', this.exit);
    return status;
  }
  /** What it has logged of `event`, as an array of lines. */
  logged(event) {
    return this.log.split('\n').filter((line) => line.includes(`event=${event} `) || line.endsWith(`event=${event}`));
  }
}

export class Cluster {
  processes = [];
  #asked = 0;
  /** What servers and edges want to see, if any. */
  headers = {};
  folder = temporaryFolder();

  constructor(t) {
    t.after(() => Promise.all(this.processes.map((each) => each.stop())));
  }

  start(command, ...options) {
    const started = new Process(command, ...options);
    this.processes.push(started);
    return started;
  }

  /** Starts it on a machine, by default this one. */
  startOn({ enter } = HERE, command, ...options) {
    return this.start(...enter, command, ...options);
  }

  async startNats(...options) {
    this.port ??= await freePort();
    this.monitoring ??= await freePort();
    const nats = this.start(NATS_SERVER, '-a', '127.0.0.1', '-p', `${this.port}`, '-m', `${this.monitoring}`, '-js', '-sd', this.folder, ...options);
    await eventually('the NATS server', async () => (await fetch(`http://127.0.0.1:${this.monitoring}/healthz`)).ok);
    this.url ??= `nats://127.0.0.1:${this.port}`;
    return nats;
  }

  /** What NATS answers to a message, as JSON. */
  async asked(subject, message = '') {
    const text = typeof message === 'string' ? message : JSON.stringify(message);
    const answers = `answers.${++this.#asked}`;
    const socket = connect(this.port, '127.0.0.1').setEncoding('utf8');
    try {
      socket.write(`CONNECT {"verbose":false}\r\nSUB ${answers} 1\r\nPUB ${subject} ${answers} ${Buffer.byteLength(text)}\r\n${text}\r\n`);
      let received = '';
      for await (const data of socket) {
        received += data;
        const answer = /^MSG \S+ 1 .*\r\n(.*)\r\n/m.exec(received);
        if (answer) return JSON.parse(answer[1]);
      }
      throw new Error(`NATS has not answered: ${received}`);
    } finally {
      socket.destroy();
    }
  }

  /** A server of the room `name`, which follows or draws. */
  async serve(name, { scene = sceneFile('stage.vrut'), options = [], machine = HERE } = {}) {
    const server = this.startOn(machine, PROGRAM, 'serve', scene, '--listen', `${machine.address}:0`, '--nats', this.url, '--room', name, ...options);
    await this.#address(server);
    return server;
  }

  async edge(...options) {
    return this.edgeOn(HERE, `${HERE.address}:0`, ...options);
  }

  async edgeOn(machine, listen, ...options) {
    const edge = this.startOn(machine, PROGRAM, 'edge', '--listen', listen, '--nats', this.url, ...options);
    await this.#address(edge);
    return edge;
  }

  async #address(server) {
    const [, address] = await eventually('an address', () => {
      if (server.child.exitCode !== null) throw new Error(server.log);
      return /listening on (http:[^\s#]+?)(rooms\/NAME\/)?(#\S*)?\n/.exec(server.log);
    });
    server.url = address;
  }

  /** The room as ContractClient takes a server. */
  async room(edge, name) {
    const url = `${edge.url}rooms/${name}/`;
    await eventually(`the room ${name}`, async () => (await fetch(`${url}readyz`, { headers: this.headers })).ok);
    const room = { url, ws: `${url}ws`.replace('http', 'ws'), headers: this.headers, get: (route) => fetch(url + route, { headers: this.headers }) };
    room.schema = await Schema.fetch(room);
    return room;
  }

  /** Which of these servers draws the room. */
  owner(servers) {
    const tale = () => servers.map((server) => server.log).join('\n');
    return eventually('an owner', async () => {
      for (const server of servers) if (server.child.exitCode === null && (await fetch(`${server.url}readyz`, { headers: this.headers, signal: AbortSignal.timeout(500) }).catch(() => ({}))).ok) return server;
      return undefined;
    }, 15_000).catch((error) => Promise.reject(new Error(`${error.message}\n${tale()}`)));
  }
}
