// Films that workers draw, by way of a NATS server.
'use strict';
const assert = require('node:assert/strict');
const { spawn, spawnSync } = require('node:child_process');
const { once } = require('node:events');
const fs = require('node:fs');
const net = require('node:net');
const os = require('node:os');
const path = require('node:path');
const { after, afterEach, before, describe, test } = require('node:test');

const { PROGRAM, examples } = require('./examples.js');

const CAR = process.env.VRUT_CAR;
const NATS_SERVER = '/usr/sbin/nats-server';
const FRAMES = 8, SIZE = '320x180';

const folder = fs.mkdtempSync(path.join(os.tmpdir(), 'vrut-preview-'));
const file = (name) => path.join(folder, name);
const processes = new Set();
let port, monitoring, nats;

function start(command, ...options) {
  const child = spawn(command, options, { stdio: ['ignore', 'pipe', 'pipe'] });
  processes.add(child);
  child.text = '';
  for (const stream of [child.stdout, child.stderr]) stream.setEncoding('utf8').on('data', (text) => { child.text += text; });
  child.ended = once(child, 'close').then(([status]) => {
    processes.delete(child);
    return status;
  });
  return child;
}

async function eventually(what, check) {
  for (const end = Date.now() + 60000; Date.now() < end; await new Promise((next) => setTimeout(next, 50))) {
    const result = await Promise.resolve().then(check).catch(() => false);
    if (result) return result;
  }
  throw new Error(`${what} does not come: ${[...processes].map((child) => child.text).join('\n')}`);
}

async function freePort() {
  const server = net.createServer().listen(0, '127.0.0.1');
  await once(server, 'listening');
  const number = server.address().port;
  server.close();
  await once(server, 'close');
  return number;
}

const url = () => `nats://127.0.0.1:${port}`;
const answers = (at) => fetch(`http://127.0.0.1:${at}/healthz`).then((answer) => answer.ok);

async function startNats(...options) {
  nats = start(NATS_SERVER, '-a', '127.0.0.1', '-p', String(port), '-m', String(monitoring), ...options);
  await eventually('the NATS server', () => answers(monitoring));
}

async function stop(child, signal) {
  child.kill(signal);
  return child.ended;
}

/// The streams of the NATS server, and how many messages are in each.
async function streams() {
  const answer = await fetch(`http://127.0.0.1:${monitoring}/jsz?streams=1`);
  const [account] = (await answer.json()).account_details ?? [];
  return Object.fromEntries((account?.stream_detail ?? []).map((stream) => [stream.name, stream.state.messages]));
}

/// What the NATS server tells of the workers.
async function consumer() {
  const answer = await fetch(`http://127.0.0.1:${monitoring}/jsz?consumers=1`);
  const [account] = (await answer.json()).account_details ?? [];
  return (account?.stream_detail ?? []).find((stream) => stream.name === 'VRUT_JOBS')?.consumer_detail?.[0] ?? {};
}

/// How many workers wait for jobs.
const waiting = async () => (await consumer()).num_waiting ?? 0;

function worker(scenes = path.dirname(CAR), ...options) {
  return start(PROGRAM, 'worker', '--nats', url(), '--scenes', scenes, ...options);
}

const film = (name, ...options) => ['render', CAR, '-o', file(name), '--keyframes', file('flight.json'), '--frames', String(FRAMES),
  '--size', SIZE, ...options];
const queued = (name, ...options) => start(PROGRAM, ...film(name, '--nats', url(), ...options));

function images(name) {
  const { name: stem, ext } = path.parse(name);
  return Array.from({ length: FRAMES }, (_, i) => fs.readFileSync(file(`${stem}-${String(i + 1).padStart(4, '0')}${ext}`)));
}

/// The film of this machine alone.
function alone(name, ...options) {
  const result = spawnSync(PROGRAM, film(name, ...options), { encoding: 'utf8' });
  assert.equal(result.status, 0, result.stderr);
  return images(name);
}

async function isWhole(collector, name, expected) {
  assert.equal(await collector.ended, 0, collector.text);
  images(name).forEach((image, i) => assert.ok(image.equals(expected[i]), `image ${i + 1} of ${name}`));
}

const missing = [NATS_SERVER, '/usr/bin/openssl'].filter((name) => !fs.existsSync(name)).map((name) => `${name} is missing`).join(', ') || false;

describe('a queue of images', { skip: missing }, () => {
  before(async () => {
    fs.writeFileSync(file('flight.json'), JSON.stringify({
      keyframes: [{ at: 0, camera: { eye: [3, 2, 5] } }, { at: 700, camera: { eye: [-4, 1.7, 5.3], fov: 33.3 } }],
    }));
    [port, monitoring] = [await freePort(), await freePort()];
    await startNats('-js', '-sd', file('store'));
  });

  const stopAll = (kept) => Promise.all([...processes].filter((child) => child !== kept).map((child) => stop(child, 'SIGKILL')));
  afterEach(() => stopAll(nats));
  after(async () => {
    await stopAll();
    fs.rmSync(folder, { recursive: true });
  });

  test('two workers draw the images of one machine, to the byte, and leave nothing behind', async () => {
    const workers = [worker(), worker()];
    for (const [name, ...options] of [['a.png'], ['b.jpg', '--mode', 'stylized', '--detail', '1', '--studio', 'on', '--set',
      '{"renderer":{"showSelection":true}}', '--select', '101']]) {
      const expected = alone(`alone-${name}`, ...options);
      await isWhole(queued(name, ...options), name, expected);
    }
    for (const child of workers) {
      assert.match(child.text, /event=image_drawn/);
      assert.equal(await stop(child, 'SIGTERM'), 0);
    }
    assert.deepEqual(await streams(), { VRUT_JOBS: 0 });
  });

  test('workers draw the film of one machine, to the byte, and leave nothing behind', async (t) => {
    const options = ['render', CAR, '--keyframes', file('flight.json'), '--frames', '8', '--size', SIZE];
    const { status, stderr } = spawnSync(PROGRAM, [...options, '-o', file('film-alone.mp4')], { encoding: 'utf8' });
    if (/built without libavformat/.test(stderr)) return t.skip('the program is built without libavformat');
    assert.equal(status, 0, stderr);
    for (let i = 0; i < 3; ++i) worker();
    const collector = start(PROGRAM, ...options, '-o', file('film.mp4'), '--nats', url());
    assert.equal(await collector.ended, 0, collector.text);
    assert.ok(fs.readFileSync(file('film.mp4')).equals(fs.readFileSync(file('film-alone.mp4'))));
    assert.deepEqual(await streams(), { VRUT_JOBS: 0 });
  });

  test('a worker draws a single image', async () => {
    worker();
    const options = ['render', CAR, '--eye', '3,2,5', '--size', SIZE];
    const collector = start(PROGRAM, ...options, '-o', file('one.png'), '--nats', url());
    assert.equal(await collector.ended, 0, collector.text);
    assert.equal(spawnSync(PROGRAM, [...options, '-o', file('one-alone.png')]).status, 0);
    assert.ok(fs.readFileSync(file('one.png')).equals(fs.readFileSync(file('one-alone.png'))));
    assert.deepEqual(await streams(), { VRUT_JOBS: 0 });
  });

  test('a worker counts its images for those who monitor it', async () => {
    const child = worker(path.dirname(CAR), '--listen', '127.0.0.1:0');
    const [, at] = await eventually('the address', () => /event=listening host=127.0.0.1 port=(\d+)/.exec(child.text));
    const get = (route) => fetch(`http://127.0.0.1:${at}${route}`);
    assert.equal(await (await get('/healthz')).text(), 'ok\n');
    await eventually('readiness', async () => (await get('/readyz')).ok);
    for (const route of ['/', '/ws', '/frame.jpg', '/rooms/car/', '/index.html', '/protocol.schema.jsonx']) assert.equal((await get(route)).status, 404, route);

    await isWhole(queued('counted.png'), 'counted.png', alone('counted-alone.png'));
    const text = await (await get('/metrics')).text();
    assert.match(text, /^vrut_preview_jobs_total\{result="drawn"\} 8$/m);
    assert.match(text, /^vrut_preview_nats_connected 1$/m);
    assert.match(text, /^vrut_preview_build_info\{version="[^"]+",renderer="[^"]+"\} 1$/m);
    assert.doesNotMatch(text, /vrut_preview_clients|vrut_preview_frames/);

    const open = worker(path.dirname(CAR), '--listen', '0.0.0.0:0');
    assert.equal(await open.ended, 1);
    assert.match(open.text, /--listen: 0.0.0.0 is open to other machines: give a token with --token-file/);
    fs.writeFileSync(file('tokens.json'), JSON.stringify({ view: 'for-the-one-who-monitors' }), { mode: 0o600 });
    const guarded = worker(path.dirname(CAR), '--listen', '0.0.0.0:0', '--token-file', file('tokens.json'));
    const [, port] = await eventually('the address', () => /event=listening host=0.0.0.0 port=(\d+)/.exec(guarded.text));
    const metrics = `http://127.0.0.1:${port}/metrics`;
    assert.equal((await fetch(metrics)).status, 401);
    assert.equal((await fetch(metrics, { headers: { Authorization: 'Bearer for-the-one-who-monitors' } })).status, 200);
    assert.equal(await stop(child, 'SIGTERM'), 0);
  });

  test('a large image comes whole', async () => {
    worker();
    const large = (name, ...options) => ['render', CAR, '-o', file(name), '--keyframes', file('flight.json'), '--frames', '2', '--size',
      '4000x3000', '--samples', '1', ...options];
    for (const [name, ...options] of [['large-alone.png'], ['large.png', '--nats', url()]]) {
      const child = start(PROGRAM, ...large(name, ...options));
      assert.equal(await child.ended, 0, child.text);
    }
    for (const number of ['0001', '0002']) {
      const image = fs.readFileSync(file(`large-${number}.png`));
      assert.ok(image.length > 2 ** 20, `${image.length} bytes`);
      assert.ok(image.equals(fs.readFileSync(file(`large-alone-${number}.png`))));
    }
  });

  test('a worker that is killed or stands still loses nothing, and neither does a NATS server that starts anew', async () => {
    const slow = ['--samples', '64'];
    const expected = alone('slow-alone.png', ...slow);
    const [killed, still] = [worker(), worker()];
    const collector = queued('slow.png', ...slow);
    await eventually('an image of each worker', () => /image_drawn/.test(killed.text) && /image_drawn/.test(still.text));
    await stop(killed, 'SIGKILL');
    still.kill('SIGSTOP');
    await stop(nats, 'SIGKILL');
    await startNats('-js', '-sd', file('store'));
    worker();
    await isWhole(collector, 'slow.png', expected);
  });

  test('a worker without the scene says so, and one that has it in a folder below draws', async () => {
    fs.mkdirSync(file('none'));
    fs.mkdirSync(file('deep/below'), { recursive: true });
    fs.copyFileSync(CAR, file(path.join('deep/below', path.basename(CAR))));
    fs.cpSync(path.join(path.dirname(CAR), 'textures'), file('deep/below/textures'), { recursive: true });
    const without = worker(file('none'));
    const collector = queued('deep.png');
    await eventually('the problem', () => /is not in the worker's folder of scenes/.test(collector.text));
    await stop(without, 'SIGTERM');
    worker(file('deep'));
    await isWhole(collector, 'deep.png', alone('deep-alone.png'));
  });

  test('images that are written take no room in the NATS server', async () => {
    const child = worker();
    const collector = queued('kept.png', '--samples', '64');
    await eventually('two images', () => fs.existsSync(file('kept-0002.png')));
    child.kill('SIGSTOP');
    await eventually('an empty stream', async () => Object.entries(await streams()).every(([name, count]) =>
      name === 'VRUT_JOBS' || count === 0));
    child.kill('SIGCONT');
    assert.equal(await collector.ended, 0, collector.text);
  });

  test('where the NATS server has lost the queue, a film says so, and a worker makes the queue anew', async () => {
    const lost = queued('lost.png');
    await eventually('jobs', async () => (await streams()).VRUT_JOBS === FRAMES);
    await stop(nats, 'SIGKILL');
    await startNats('-js', '-sd', file('empty-store'));
    assert.equal(await lost.ended, 1, lost.text);
    assert.match(lost.text, /the server has lost the film's queue; start the film again$/m);

    const child = worker();
    await eventually('the worker', () => /waiting_for_jobs/.test(child.text));
    await stop(nats, 'SIGKILL');
    await startNats('-js', '-sd', file('other-store'));
    await eventually('the queue', async () => (await waiting()) > 0);
    await isWhole(queued('anew.png'), 'anew.png', alone('anew-alone.png'));
  });

  test('a worker with another scene or without its textures says so, and one with the right ones draws', async () => {
    for (const [name, change] of [['other', '\nmaterial 9999 "Other"\n  ambient 0 0 0 1  diffuse 1 1 1 1  specular 0 0 0 1  emission 0 0 0 1\nend\n'],
      ['bare', '']]) {
      fs.mkdirSync(file(name));
      fs.writeFileSync(file(path.join(name, path.basename(CAR))), fs.readFileSync(CAR, 'utf8') + change);
      if (change) fs.cpSync(path.join(path.dirname(CAR), 'textures'), file(path.join(name, 'textures')), { recursive: true });
      const wrong = worker(file(name));
      const collector = queued(`${name}.png`);
      await eventually('the problem', () => /is another scene here than where the film was asked for/.test(collector.text));
      assert.equal(await stop(wrong, 'SIGTERM'), 0);
      assert.equal((await consumer()).num_ack_pending, 0);  // what it cannot draw waits as if nobody had tried
      const right = worker();
      await isWhole(collector, `${name}.png`, alone(`${name}-alone.png`));
      await stop(right, 'SIGTERM');
    }
  });

  test('a film that is stopped takes its jobs along', async () => {
    const collector = queued('stopped.png');
    await eventually('jobs', async () => (await streams()).VRUT_JOBS === FRAMES);
    assert.equal(await stop(collector, 'SIGINT'), 1);
    assert.match(collector.text, /^vrut-preview: a signal stopped the film: 0 of 8 images are drawn$/m);
    assert.deepEqual(await streams(), { VRUT_JOBS: 0 });
  });

  /// Collectors of films that wait in the queue, one behind the other; workers have been there before.
  async function queuedInTurn(...names) {
    const first = worker();
    await eventually('a worker that waits', async () => (await waiting()) > 0);
    await stop(first, 'SIGTERM');
    const collectors = [];
    for (const name of names) {
      collectors.push(queued(name));
      await eventually('its jobs', async () => (await streams()).VRUT_JOBS === FRAMES * collectors.length);
    }
    return collectors;
  }

  test('a film that ends leaves another its images', { timeout: 120_000 }, async () => {
    const [first, second] = await queuedInTurn('first.png', 'second.png');
    worker();
    const expected = alone('first-alone.png');
    await isWhole(first, 'first.png', expected);
    await isWhole(second, 'second.png', expected);
    assert.deepEqual(await streams(), { VRUT_JOBS: 0 });
  });

  test('a film that is stopped leaves others their images', { timeout: 120_000 }, async () => {
    const [ahead, waits, runs, behind] = await queuedInTurn('ahead.png', 'waits.png', 'runs.png', 'behind.png');
    assert.equal(await stop(waits, 'SIGINT'), 1);
    assert.equal((await streams()).VRUT_JOBS, 3 * FRAMES);
    worker();
    await eventually('its first image', () => fs.existsSync(file('runs-0001.png')));
    await stop(runs, 'SIGINT');
    const expected = alone('ahead-alone.png');
    await isWhole(ahead, 'ahead.png', expected);
    await isWhole(behind, 'behind.png', expected);
    await eventually('an empty queue', async () => (await streams()).VRUT_JOBS === 0);
  });

  test('what is no job is logged and leaves the queue', async () => {
    const child = worker();
    await eventually('the worker', () => /waiting_for_jobs/.test(child.text));
    const socket = net.connect(port, '127.0.0.1');
    for (const text of ['garbage', '{}', '{"run":"x"}', '[1]', '\xff\xfe'])
      socket.write(`PUB vrut.jobs.x ${Buffer.byteLength(text)}\r\n${text}\r\n`);
    await eventually('complaints', () => (child.text.match(/event=invalid_job/g) ?? []).length === 5);
    await eventually('an empty queue', async () => (await streams()).VRUT_JOBS === 0);
    socket.destroy();
    const expected = alone('after-alone.png');
    await isWhole(queued('after.png'), 'after.png', expected);
    assert.equal(await stop(child, 'SIGTERM'), 0);
  });

  for (const example of examples('worker')) {
    test(`example: ${example}`, async () => {
      fs.mkdirSync(file('scenes'), { recursive: true });
      const words = example.replace('nats://127.0.0.1', url()).split(' ');
      assert.equal(words.shift(), 'vrut-preview');
      const child = spawn(PROGRAM, words, { cwd: folder });
      processes.add(child);
      const ended = once(child, 'close');
      child.stderr.resume();
      await eventually('a worker that waits', async () => (await waiting()) > 0);
      child.kill('SIGTERM');
      assert.deepEqual(await ended, [0, null]);
      processes.delete(child);
    });
  }

  test('a NATS server that is not there, has no JetStream, or no address', async () => {
    const fails = async (child, sentence) => {
      assert.equal(await child.ended, 1, child.text);
      assert.match(child.text, sentence);
      assert.equal(child.text.trim().split('\n').length, 1, child.text);
    };
    const at = (address) => [start(PROGRAM, ...film('x.png', '--nats', address)),
      start(PROGRAM, 'worker', '--nats', address, '--scenes', folder)];
    const nobody = await freePort();
    for (const child of at(`nats://drawer:secret@127.0.0.1:${nobody}`))
      await fails(child, new RegExp(`^vrut-preview: --nats: nats://127\\.0\\.0\\.1:${nobody}: it cannot be reached: no NATS server answers there$`, 'm'));
    for (const child of at('http://127.0.0.1')) await fails(child, /--nats: .*no address of a NATS server/);
    await fails(start(PROGRAM, 'worker', '--nats', url(), '--scenes', file('nowhere')), /--scenes: .*nowhere is no folder/);
    await stop(nats, 'SIGTERM');
    await startNats();
    for (const child of at(url())) await fails(child, /JetStream is off; start nats-server with -js/);
    await stop(nats, 'SIGTERM');
    await startNats('-js', '-sd', file('store'), '--user', 'drawer', '--pass', 'secret');
    for (const child of at(url())) await fails(child, /the server refuses the name and the password/);
    for (const child of at(`nats://drawer:wrong@127.0.0.1:${port}`)) await fails(child, /the server refuses the name and the password/);
    const pem = (name) => [file(`${name}.key`), file(`${name}.crt`)];
    for (const name of ['localhost', 'example.org']) {
      const [key, certificate] = pem(name);
      const made = spawnSync('openssl', ['req', '-x509', '-newkey', 'ec', '-pkeyopt', 'ec_paramgen_curve:prime256v1', '-nodes', '-keyout', key,
        '-out', certificate, '-days', '2', '-subj', `/CN=${name}`, '-addext', `subjectAltName=DNS:${name}`]);
      assert.equal(made.status, 0, String(made.stderr));
    }
    const byTls = (trusted) => start('env', `SSL_CERT_FILE=${trusted}`, PROGRAM, 'worker', '--nats', `tls://localhost:${port}`, '--scenes', folder);
    for (const [name, trusted] of [['localhost', '/dev/null'], ['example.org', file('example.org.crt')]]) {
      await stop(nats, 'SIGTERM');
      const [key, certificate] = pem(name);
      await startNats('-js', '-sd', file('store'), '--tls', '--tlskey', key, '--tlscert', certificate);
      await fails(byTls(trusted), /TLS fails: this machine does not trust the server's certificate, or it is for another name\n$/);
    }
    await stop(nats, 'SIGTERM');
    await startNats('-js', '-sd', file('store'), '--tls', '--tlskey', file('localhost.key'), '--tlscert', file('localhost.crt'));
    const encrypted = byTls(file('localhost.crt'));
    await eventually('the worker by TLS', () => /waiting_for_jobs nats=tls:/.test(encrypted.text));
    await stop(nats, 'SIGTERM');
    await startNats('-js', '-sd', file('store'), '--user', 'drawer', '--pass', 'secret');
    const known = start(PROGRAM, 'worker', '--nats', `nats://drawer:secret@127.0.0.1:${port}`, '--scenes', folder);
    await eventually('the worker', () => /waiting_for_jobs nats=nats:\/\/127/.test(known.text));
  });
});
