// Several servers and edges: deploy/several.sh starts them on this machine, and a room goes on when a server dies. And what
// deploy/nats.conf says.
'use strict';
const assert = require('node:assert/strict');
const fs = require('node:fs');
const path = require('node:path');
const { spawnSync } = require('node:child_process');
const { after, describe, test } = require('node:test');
const { DEPLOY, Running, eventually, freePort, missing, output, temporaryFolder } = require('./helpers.js');
const { makeCertificate } = require('./certificate.js');

const { VRUT_PREVIEW, VRUT_CAR } = process.env;
const AGAIN_WITHIN_MS = 10_000;
const folder = temporaryFolder();
const at = (name) => path.join(folder, name);

const status = async (url) => (await fetch(url, { signal: AbortSignal.timeout(1000) }).catch(() => ({}))).status;
const isAlive = (id) => fs.existsSync(`/proc/${id}/cmdline`) && fs.readFileSync(`/proc/${id}/cmdline`).length > 0;

/** An image of a size that nobody has asked for yet, so that a server has to draw it; false if none comes. */
let width = 64;
async function isDrawn(room) {
  const answer = await fetch(`${room}frame.jpg?width=${++width}&height=48`, { signal: AbortSignal.timeout(2000) }).catch(() => ({}));
  if (answer.status !== 200) return false;
  assert.equal(answer.headers.get('content-type'), 'image/jpeg');
  return Buffer.from(await answer.arrayBuffer()).subarray(0, 3).toString('hex') === 'ffd8ff';
}

describe('several servers and edges on one machine', { skip: missing('/usr/sbin/nats-server', '/usr/sbin/haproxy', 'curl') }, () => {
  let started;
  after(() => {
    // A group of its own, so that nothing is left of it if a test fails.
    try { process.kill(-started.child.pid, 'SIGKILL'); } catch { /* all have ended */ }
  });

  test('a room goes on when the server that draws it is killed, or an edge; SIGTERM ends all', async () => {
    const port = await freePort();
    const env = { ...process.env, XDG_STATE_HOME: at('state'), TMPDIR: folder };
    started = new Running(path.join(DEPLOY, 'several.sh'), ['--port', port, VRUT_PREVIEW, VRUT_CAR], { env, detached: true });
    const [room] = await started.printed(/^http:\/\/127\.0\.0\.1:\d+\/rooms\/car\/$/m);
    assert.equal(room, `http://127.0.0.1:${port}/rooms/car/`);
    const processes = Object.fromEntries([...started.text.matchAll(/^(\S+): process (\d+), (\S+)$/gm)].map(([, name, id, address]) => [name, { name, id: Number(id), address }]));
    assert.deepEqual(Object.keys(processes).sort(), ['edge-1', 'edge-2', 'haproxy', 'nats-server', 'server-1', 'server-2']);
    assert.match(await (await fetch(room)).text(), /<title>VRUT Preview/);
    assert.ok(await isDrawn(room));

    const servers = [processes['server-1'], processes['server-2']];
    const draws = await Promise.all(servers.map(async ({ address }) => (await status(`http://${address}/readyz`)) === 200));
    assert.deepEqual(draws.sort(), [false, true], 'one draws');
    const owner = servers[(await status(`http://${servers[0].address}/readyz`)) === 200 ? 0 : 1];
    process.kill(owner.id, 'SIGKILL');
    await eventually('an image of the other server', () => isDrawn(room), AGAIN_WITHIN_MS);
    await started.printed(new RegExp(`^${owner.name} has ended with status 137`, 'm'));

    process.kill(processes['edge-1'].id, 'SIGKILL');
    await eventually('an image by the other edge', () => isDrawn(room), AGAIN_WITHIN_MS);

    assert.equal(await started.stop(), 0, started.text);
    assert.deepEqual(Object.values(processes).filter(({ id }) => isAlive(id)), []);
    assert.deepEqual(fs.readdirSync(folder).filter((name) => name.startsWith('vrut-several')), []);
  });

  test('it says which process has ended, and ends all, if the others cannot go on', async () => {
    const env = { ...process.env, TMPDIR: folder };
    const { status, stderr } = spawnSync(path.join(DEPLOY, 'several.sh'), ['--port', await freePort(), '/bin/true'], { encoding: 'utf8', env, timeout: 20_000 });
    assert.equal(status, 1, stderr);
    assert.match(stderr, /^(server|edge)-1 has ended with status 0\. Its last lines:$/m);
    assert.match(stderr, /^several\.sh: there is no (server|edge) left, so the others end as well\.$/m);
  });
});

test('nats-server understands nats.conf', { skip: missing('/usr/sbin/nats-server', 'openssl') }, () => {
  makeCertificate(folder);
  let text = fs.readFileSync(path.join(DEPLOY, 'nats.conf'), 'utf8');
  for (const [from, to] of [['/etc/nats/server.crt', at('certificate.pem')], ['/etc/nats/server.key', at('key.pem')], ['/etc/nats/ca.crt', at('certificate.pem')], ['/var/lib/nats', at('nats')]]) {
    assert.ok(text.includes(from), from);
    text = text.replaceAll(from, to);
  }
  fs.writeFileSync(at('nats.conf'), text);
  assert.match(output('/usr/sbin/nats-server', ['-t', '-c', at('nats.conf')]), /is valid/);
  fs.writeFileSync(at('wrong.conf'), text.replace('no_advertise', 'no_advert'));
  assert.throws(() => output('/usr/sbin/nats-server', ['-t', '-c', at('wrong.conf')]), /unknown field/);
});
