// A server and an edge, as VRUT_BY_EDGE has them in the place of a server alone.
import { spawn } from 'node:child_process';
import { existsSync, mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import path from 'node:path';
import { setTimeout as delay } from 'node:timers/promises';

const READY_WITHIN_MS = 60_000;

/** @returns {Promise<string>} the address of a NATS server of this process's own */
async function startNats() {
  const folder = mkdtempSync(path.join(tmpdir(), 'vrut-nats-'));
  process.on('exit', () => rmSync(folder, { recursive: true, force: true }));
  const child = spawn('/usr/sbin/nats-server', ['-a', '127.0.0.1', '-p', '-1', '-js', '-sd', folder, '--ports_file_dir', folder], { stdio: 'ignore' });
  child.unref();  // it goes with this process
  process.on('exit', () => child.kill('SIGKILL'));
  const file = path.join(folder, `nats-server_${child.pid}.ports`);
  for (const end = Date.now() + READY_WITHIN_MS; Date.now() < end; await delay(20)) if (existsSync(file)) break;
  return JSON.parse(readFileSync(file, 'utf8')).nats[0];
}

/** Options of `serve`, and those of them that `edge` has, too. */
function divided(options) {
  const own = [], network = [];
  for (let i = 0; i < options.length; ++i) {
    const list = ['--max-clients', '--token-file', '--allow-origin'].includes(options[i]) ? network : own;
    list.push(options[i]);
    if (options[i].startsWith('--') && options[i + 1] !== undefined && !options[i + 1].startsWith('--')) list.push(options[++i]);
  }
  return { own, network };
}

/** @type {Promise<string> | undefined} */
let nats;
let rooms = 0;

/** @returns {Promise<{serve: string[], edge: string[], room: string}>} the options of both, from those of a server alone */
export async function commandLines(options) {
  const url = await (nats ??= startNats());
  const room = `room-${++rooms}`;
  // Who may come in is the room's to say; which page may connect, and how many clients may be here, the edge's.
  const { own, network } = divided(options);
  return { serve: ['--nats', url, '--room', room, ...own, ...network], edge: ['--nats', url, ...network], room };
}
