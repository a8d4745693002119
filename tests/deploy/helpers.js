// Processes and clients for the tests of deploy/.
'use strict';
const assert = require('node:assert/strict');
const { spawn, spawnSync } = require('node:child_process');
const { once } = require('node:events');
const fs = require('node:fs');
const net = require('node:net');
const os = require('node:os');
const path = require('node:path');
const { after } = require('node:test');
const WebSocket = require('../web/node_modules/ws');

const LIMIT_MS = 30_000;

const DEPLOY = path.join(__dirname, '../../deploy');
const TOKENS = { control: 'the-token-to-steer-with', view: 'the-token-to-watch-with' };

/** Why tests that need a program are left out, or false. */
const missing = (...commands) => {
  const absent = commands.find((command) => spawnSync(command, ['--version']).error);
  return absent ? `there is no ${absent}` : false;
};

/** A folder that goes when the process does. */
function temporaryFolder() {
  const folder = fs.mkdtempSync(path.join(os.tmpdir(), 'vrut-deploy-'));
  process.on('exit', () => fs.rmSync(folder, { recursive: true, force: true }));
  return folder;
}

function tokenFile(folder) {
  const file = path.join(folder, 'tokens.json');
  fs.writeFileSync(file, JSON.stringify(TOKENS), { mode: 0o600 });
  return file;
}

/** A port of this machine that is free now. */
async function freePort() {
  const server = net.createServer().listen(0, '127.0.0.1');
  await once(server, 'listening');
  const { port } = server.address();
  server.close();
  await once(server, 'close');
  return port;
}

/** What a command prints; fails with what it complains of. */
function output(command, args, options = {}) {
  const { status, stdout, stderr, error } = spawnSync(command, args, { encoding: 'utf8', ...options });
  if (error || status !== 0) throw new Error(`${command} ${args.join(' ')}: ${error ?? status}\n${stdout}${stderr}`);
  return stdout + stderr;
}

/** Files below a folder, by their paths in it. */
const files = (top) => fs.readdirSync(top, { recursive: true, withFileTypes: true })
  .filter((entry) => !entry.isDirectory()).map((entry) => path.relative(top, path.join(entry.parentPath ?? entry.path, entry.name))).sort();

/** Makes the Debian packages in a folder. @returns {object} their files, by their names */
function debs(folder) {
  output('cpack', ['--config', path.join(process.env.VRUT_BUILD, 'CPackConfig.cmake'), '-B', folder]);
  const made = fs.readdirSync(folder).filter((name) => name.endsWith('.deb'));
  return Object.fromEntries(made.map((name) => [name.split('_')[0], path.join(folder, name)]));
}

/** The libraries that a program itself is linked with. */
function linkedLibraries(program) {
  const paths = new Map([...output('ldd', [program]).matchAll(/(\S+) => (\S+)/g)].map(([, name, file]) => [name, file]));
  return [...output('readelf', ['--dynamic', program]).matchAll(/\(NEEDED\).*\[(.*)\]/g)].map(([, name]) => paths.get(name)).filter(Boolean);
}

/** The Debian packages that brought files. */
function packagesOf(paths) {
  // Where /lib is a link to /usr/lib, a package may name either.
  const asked = new Map(paths.map((file) => fs.realpathSync(file)).flatMap((file) => [[file, file], [file.replace(/^\/usr\/lib\//, '/lib/'), file]]));
  const { stdout } = spawnSync('dpkg-query', ['--search', ...asked.keys()], { encoding: 'utf8', maxBuffer: 1 << 26 });
  const found = [...stdout.matchAll(/^([^:,\s]+)(?::\w+)?(?:, .*)?: (\/.*)$/gm)];
  const owned = new Set(found.map(([, , file]) => asked.get(file)));
  assert.deepEqual([...new Set(asked.values())].filter((file) => !owned.has(file)), [], 'of no package');
  return new Set(found.map(([, name]) => name));
}

const running = [];
after(() => running.forEach(({ child }) => child.kill('SIGKILL')));

/** A process that ends with the tests, and what it has printed. */
class Running {
  text = '';

  constructor(command, args, options = {}) {
    this.child = spawn(command, args, options);
    running.push(this);
    for (const stream of [this.child.stdout, this.child.stderr]) stream?.setEncoding('utf8').on('data', (data) => (this.text += data));
    this.ended = new Promise((resolve) => this.child.once('close', (status) => resolve(status)));
    this.child.once('error', (error) => (this.text += error));
  }

  /** What a pattern finds in what it prints. */
  async printed(pattern, limitMs = LIMIT_MS) {
    let over = false;
    this.ended.then(() => (over = true));
    return eventually(`${pattern} in ${this.child.spawnfile}'s output`, () => {
      const found = pattern.exec(this.text);
      if (!found && over) throw new Error(`ended without ${pattern}: ${this.text}`);
      return found;
    }, limitMs);
  }

  /** @returns {Promise<number>} its status */
  stop(signal = 'SIGTERM') {
    this.child.kill(signal);
    return this.ended;
  }
}

async function eventually(what, look, limitMs = LIMIT_MS) {
  for (const end = Date.now() + limitMs; Date.now() < end; ) {
    const seen = await look();
    if (seen) return seen;
    await new Promise((resolve) => setTimeout(resolve, 20));
  }
  throw new Error(`waited in vain for ${what}`);
}

/** A client of the server's WebSocket. */
class Client {
  texts = [];
  frames = [];

  /** Rejects with `status` where the server refuses to upgrade. */
  static async connect(url, options = {}) {
    const client = new Client();
    client.socket = new WebSocket(url, ['vrut-preview.v1'], { rejectUnauthorized: false, ...options });
    client.closed = once(client.socket, 'close');
    client.socket.on('message', (data, binary) => {
      if (binary) client.frames.push(data);
      else client.texts.push(JSON.parse(data));
    });
    await new Promise((resolve, reject) => {
      client.socket.once('open', resolve);
      client.socket.once('unexpected-response', (_, response) => {
        response.destroy();
        reject(Object.assign(new Error(`HTTP ${response.statusCode}`), { status: response.statusCode }));
      });
      client.socket.once('error', reject);
    });
    client.socket.on('error', () => {});
    return client;
  }

  static async join(url, token, options) {
    const client = await Client.connect(url, options);
    client.send({ type: 'hello', role: 'control', token });
    await client.text('state');
    return client;
  }

  send(message) {
    this.socket.send(JSON.stringify(message));
  }

  text(type, fits = () => true) {
    return eventually(`${type}, after ${JSON.stringify(this.texts.map((text) => text.type))}`, () =>
      this.texts.find((text) => text.type === type && fits(text)));
  }

  /** Asks, and fails where the server refuses. */
  async ask(message) {
    this.lastId = (this.lastId ?? 0) + 1;
    const id = this.lastId;
    this.send({ ...message, id });
    const answer = await eventually(`an answer to ${message.type}`, () => this.texts.find((text) => text.id === id));
    if (answer.type === 'error') throw new Error(`${message.type}: ${answer.message}`);
    return answer;
  }

  /** The next frame. */
  frame() {
    const { length } = this.frames;
    this.send({ type: 'frame' });
    return eventually('a frame', () => this.frames[length]);
  }
}

module.exports = { Client, DEPLOY, Running, TOKENS, debs, eventually, files, freePort, linkedLibraries, missing, output, packagesOf, temporaryFolder, tokenFile };
