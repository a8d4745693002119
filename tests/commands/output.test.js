// A server whose output nobody takes: it serves on.
'use strict';
const assert = require('node:assert/strict');
const { spawn } = require('node:child_process');
const fs = require('node:fs');
const http = require('node:http');
const net = require('node:net');
const os = require('node:os');
const path = require('node:path');
const { after, test } = require('node:test');

const PROGRAM = process.env.VRUT_PREVIEW;
const CAR = process.env.VRUT_CAR;

const folder = fs.mkdtempSync(path.join(os.tmpdir(), 'vrut-preview-'));
const groups = [];
after(() => {
  fs.rmSync(folder, { recursive: true });
  for (const group of groups) {
    try { process.kill(-group, 'SIGKILL'); } catch { /* it has ended */ }
  }
});

const freePort = () => new Promise((resolve) => {
  const server = net.createServer().listen(0, '127.0.0.1', () => {
    const { port } = server.address();
    server.close(() => resolve(port));
  });
});

async function eventually(what, check) {
  for (const end = Date.now() + 60000; Date.now() < end; await new Promise((next) => setTimeout(next, 20))) {
    try {
      const result = await check();
      if (result) return result;
    } catch { /* not yet */ }
  }
  throw new Error(`${what} does not come`);
}

const statusOf = async (url) => (await fetch(url, { signal: AbortSignal.timeout(5000) })).status;

/** A page of another site that knocks: a line in the log. */
const knock = (port) => new Promise((resolve, reject) => {
  const headers = {
    Connection: 'Upgrade', Upgrade: 'websocket', 'Sec-WebSocket-Version': 13,
    'Sec-WebSocket-Key': 'AAAAAAAAAAAAAAAAAAAAAA==', Origin: 'http://evil.example',
  };
  http.get({ host: '127.0.0.1', port, path: '/ws', headers }, (response) => {
    response.resume();
    resolve(response.statusCode);
  }).on('error', reject);
});

for (const [what, redirection] of [
  ['standard output and error closed', '>&- 2>&- <&-'],
  ['a pipe that breaks after its first line', '2>&1 | head -n 1 >/dev/null'],
  ['a full device', '>/dev/full 2>&1'],
]) {
  test(`a server serves on with ${what}, and ends with status 0`, async () => {
    const port = await freePort();
    const pid = path.join(folder, `${port}.pid`);
    const command = `(echo $BASHPID >"$PID"; exec "$PROGRAM" serve "$CAR" --listen 127.0.0.1:${port}) ${redirection}`;
    const shell = spawn('bash', ['-c', `set -o pipefail; ${command}`],
      { env: { ...process.env, PROGRAM, CAR, PID: pid }, stdio: 'ignore', detached: true });
    groups.push(shell.pid);
    const ended = new Promise((resolve) => shell.on('exit', resolve));
    const url = `http://127.0.0.1:${port}`;
    await eventually('the server', async () => await statusOf(`${url}/readyz`) === 200);
    for (let i = 0; i < 3; ++i) assert.equal(await knock(port), 403);
    assert.equal(await statusOf(`${url}/frame.jpg?width=64&height=48`), 200);
    assert.equal(await statusOf(`${url}/healthz`), 200);
    process.kill(Number(fs.readFileSync(pid, 'utf8')), 'SIGTERM');
    assert.equal(await ended, 0);
  });
}
