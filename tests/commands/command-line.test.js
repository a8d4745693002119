// The command line: what it prints, what it writes, and how it ends.
'use strict';
const assert = require('node:assert/strict');
const { spawn, spawnSync } = require('node:child_process');
const fs = require('node:fs');
const os = require('node:os');
const path = require('node:path');
const { after, test } = require('node:test');
const zlib = require('node:zlib');
const { Running } = require('../deploy/helpers.js');

const PROGRAM = process.env.VRUT_PREVIEW;
const CAR = process.env.VRUT_CAR;
const MATRICES = path.join(process.env.VRUT_SCENES, 'teaching', 'matrices.vrut');
const folder = fs.mkdtempSync(path.join(os.tmpdir(), 'vrut-preview-'));
after(() => fs.rmSync(folder, { recursive: true }));

const file = (name) => path.join(folder, name);
const run = (...options) => spawnSync(PROGRAM, options, { encoding: 'utf8' });
const sentences = (text) => text.trim().split('\n');

function succeeds(...options) {
  const result = run(...options);
  assert.equal(result.status, 0, result.stderr);
  return result.stdout;
}

function fails(status, culprit, ...options) {
  const result = run(...options);
  assert.equal(result.status, status, `${options}: ${result.stderr}`);
  assert.equal(sentences(result.stderr).length, 1, result.stderr);
  assert.match(result.stderr, culprit);
  assert.equal(result.stdout, '');
}

function pngSize(name) {
  const bytes = fs.readFileSync(file(name));
  assert.equal(bytes.toString('latin1', 1, 4), 'PNG');
  return [bytes.readUInt32BE(16), bytes.readUInt32BE(20)];
}

test('help and version', () => {
  assert.match(succeeds('--version'), /^vrut-preview \d+\.\d+\.\d+\n$/);
  assert.match(succeeds('--help'), /^Usage: vrut-preview COMMAND/);
  assert.match(succeeds('render', '--help'), /^Usage: vrut-preview render \[OPTIONS\] SCENE\n/);
});

test('wrong usage is told in a sentence, with status 2', () => {
  fails(2, /a command is required/);
  fails(2, /dance/, 'dance');
  fails(2, /SCENE/, 'info');
  fails(2, /'import'/, 'import', CAR);
  fails(2, /--output/, 'render', CAR);
  fails(2, /--size: .*'12'/, 'render', CAR, '-o', file('x.png'), '--size', '12');
  fails(2, /--size/, 'render', CAR, '-o', file('x.png'), '--size', '0x5');
  fails(2, /--samples/, 'render', CAR, '-o', file('x.png'), '--samples', '0');
  fails(2, /--eye: .*'1,2'/, 'render', CAR, '-o', file('x.png'), '--eye', '1,2');
  fails(2, /--detail/, 'render', CAR, '-o', file('x.png'), '--detail', '-1');
  fails(2, /--fov/, 'render', CAR, '-o', file('x.png'), '--fov', '180');
  fails(2, /'8080'/, 'serve', '--listen', '8080');
  fails(2, /--log-level/, 'serve', '--log-level', 'loud');
});

test('what cannot be done is told in a sentence, with status 1', () => {
  fails(1, /missing\.vrut: there is no such file/, 'info', file('missing.vrut'));
  fails(1, /this file extension cannot be read/, 'info', __filename);
  fs.writeFileSync(file('bad.vrut'), 'vrut-text 1\nnode 1 "A" assembly\n  parent 7 end\n');
  fails(1, /bad\.vrut:2: expected parent 7 of node 1/, 'info', file('bad.vrut'));
  fs.writeFileSync(file('bad.glb'), 'glTF, but not really');
  fails(1, /bad\.glb: /, 'info', file('bad.glb'));
  fails(1, /bad\.glb: /, 'render', file('bad.glb'), '-o', file('x.png'));
  fails(1, /picture\.gif/, 'render', CAR, '-o', file('picture.gif'));
  fails(1, /no-such-folder/, 'render', CAR, '-o', file('no-such-folder/x.png'), '--size', '8x8');
  fails(1, /camera\.json/, 'render', CAR, '-o', file('x.png'), '--camera', file('camera.json'));
  const film = (...words) => ['render', CAR, '-o', file('x.png'), '--keyframes', ...words];
  fails(1, /--keyframes: .*no-flight\.json cannot be read/, ...film(file('no-flight.json'), '--frames', '2'));
  for (const [flight, culprit] of [
    ['[]', /bad\.json: a flight must be a JSON object/],
    ['{"keyframes":[]}', /bad\.json: .*'keyframes'/],
    ['{"keyframes":[{"at":5,"camera":{}},{"at":5,"camera":{}}]}', /'keyframes\[1\]\.at' must be later than the one before/],
    ['{"keyframes":[{"at":5,"camera":{"eye":[0,0,0],"focus":[0,0,0]}}]}', /keyframes\[0\]\.camera: eye and focus must be apart/],
  ]) {
    fs.writeFileSync(file('bad.json'), flight);
    fails(1, culprit, ...film(file('bad.json'), '--frames', '2'));
  }
  fails(1, /--size/, 'render', CAR, '-o', file('x.png'), '--size', '100000x2');
  fails(1, /'camera\.nose'/, 'render', CAR, '-o', file('x.png'), '--set', '{"camera":{"nose":1}}');
  fails(1, /eye and focus/, 'render', CAR, '-o', file('x.png'), '--eye', '0,0,0', '--focus', '0,0,0');
  fails(1, /there is no EGL device 99/, 'render', CAR, '-o', file('x.png'), '--device', '99');
  assert.equal(fs.existsSync(file('x.png')), false);
});

test('info tells what a scene holds', () => {
  assert.match(succeeds('info', CAR), /^car-20k: \d+ nodes/);
  const info = JSON.parse(succeeds('info', CAR, '--json'));
  assert.equal(info.tree.length, info.nodes);
  assert.equal(info.tree[0].type, 'root');
  assert.equal(info.tree.reduce((sum, node) => sum + node.triangles, 0), info.triangles);
});

test('names that would steer a terminal do not', () => {
  fs.writeFileSync(file('names.vrut'), 'vrut-text 1\nnode 1 "Left 90° \x1b[31mred" assembly end\nnode 2 "90°" assembly end\n');
  const said = succeeds('info', file('names.vrut'));
  assert.match(said, /1 "Left 90\\u00b0 \\u001b\[31mred" \(/);
  assert.match(said, /2 90° \(/);
});

test('render draws pictures of the size asked for', () => {
  succeeds('render', CAR, '-o', file('car.png'), '--size', '320x200');
  assert.deepEqual(pngSize('car.png'), [320, 200]);
  succeeds('render', CAR, '-o', file('line.png'), '--size', '1x700', '--samples', '1');
  assert.deepEqual(pngSize('line.png'), [1, 700]);
  succeeds('render', CAR, '-o', file('car.jpg'), '--size', '64x64', '--jpeg-quality', '50');
  assert.equal(fs.readFileSync(file('car.jpg')).readUInt16BE(0), 0xffd8);
});

test('render draws a film: its images begin at the camera, pass the keyframes in their times, and end at the last', () => {
  fs.writeFileSync(file('flight.json'), JSON.stringify({
    type: 'fly', id: 7, keyframes: [{ at: 1000, camera: { fov: 30 } }, { at: 2500, camera: { eye: [4, 1, 3], focus: [0, 0.6, 0] } }],
  }));
  const draw = (name, ...options) => succeeds('render', CAR, '-o', file(name), '--size', '64x36', '--samples', '1', ...options);
  assert.equal(draw('film.png', '--keyframes', file('flight.json'), '--frames', '6', '--stats').trim().split('\n').length, 6);
  draw('begin.png');
  draw('third.png', '--fov', '30');
  draw('end.png', '--fov', '30', '--eye', '4,1,3', '--focus', '0,0.6,0');
  const image = (number) => fs.readFileSync(file(`film-000${number}.png`));
  assert.deepEqual(image(1), fs.readFileSync(file('begin.png')));
  assert.deepEqual(image(3), fs.readFileSync(file('third.png')));
  assert.deepEqual(image(6), fs.readFileSync(file('end.png')));
  assert.equal(new Set([1, 2, 3, 4, 5, 6].map((number) => image(number).toString('base64'))).size, 6);
  assert.deepEqual([fs.existsSync(file('film.png')), fs.existsSync(file('film-0007.png'))], [false, false]);
  draw('traced.jpg', '--keyframes', file('flight.json'), '--frames', '2', '--reference', '--eye', '5,1,1');
  assert.equal(fs.readFileSync(file('traced-0002.jpg')).readUInt16BE(0), 0xffd8);
  fails(2, /--frames requires --keyframes/, 'render', CAR, '-o', file('x.png'), '--frames', '3');
});

const CUES = {
  Arrival: { order: 1, ms: 60_000, camera: { eye: [4, 1, 3], focus: [0, 0.6, 0], up: [0, 1, 0] } },
  Bare: { order: 2, ms: 400, camera: { fov: 30 }, nodes: { 101: { active: false } } },
};
const listOf = (name, cues, more = {}) =>
  fs.writeFileSync(file(name), JSON.stringify({ format: 'vrut-preview-cues', version: 1, cues, ...more }));

test('render draws the film of a list of cues: at rest at each, on its way between them', () => {
  listOf('cues.json', CUES);
  const draw = (name, ...options) => succeeds('render', CAR, '-o', file(name), '--size', '64x36', '--samples', '1', ...options);
  draw('cue.png', '--cues', file('cues.json'), '--fps', '10', '--hold', '0.3');
  draw('arrival.png', '--eye', '4,1,3', '--focus', '0,0.6,0');
  draw('bare.png', '--fov', '30', '--set', '{"nodes":{"101":{"active":false}}}');
  const images = fs.readdirSync(folder).filter((name) => /^cue-\d+\.png$/.test(name)).sort().map((name) => fs.readFileSync(file(name)));
  assert.equal(images.length, 11); // 0.3 s, 0.4 s on the way, 0.3 s, and the end
  for (const i of [0, 1, 2]) assert.deepEqual(images[i], fs.readFileSync(file('arrival.png')), `image ${i + 1}`);
  for (const i of [7, 8, 9, 10]) assert.deepEqual(images[i], fs.readFileSync(file('bare.png')), `image ${i + 1}`);
  assert.equal(new Set(images.map((image) => image.toString('base64'))).size, 6);
});

test('what of a list of cues does not go with a scene is printed, and nothing is drawn of it', () => {
  listOf('cues.json', CUES);
  assert.equal(succeeds('cues', 'check', file('cues.json'), CAR), '');
  listOf('wrong.json', { ...CUES, Lost: { selection: { node: 9_999_999 }, lights: { active: '9999998' } } }, { scene: 'other.vrut' });
  const { status, stdout, stderr } = run('cues', 'check', file('wrong.json'), CAR);
  assert.equal(status, 1);
  const lines = stdout.trim().split('\n');
  assert.equal(lines.length, 3);
  for (const [i, words] of [/made for 'other\.vrut'/, /no light '9999998'/, /no node 9999999/].entries()) assert.match(lines[i], words);
  assert.match(stderr, /^vrut-preview: .*wrong\.json: not all of the list goes with car-20k\.vrut.*\n$/);
  const film = (list) => ['render', CAR, '-o', file('no.png'), '--cues', file(list)];
  fails(1, /wrong\.json: the list was made for/, ...film('wrong.json'));
  listOf('none.json', {});
  fails(1, /none\.json: the list has no cues/, ...film('none.json'));
  listOf('newer.json', CUES, { version: 2 });
  fails(1, /newer\.json: the list is of version 2.*newer program/, ...film('newer.json'));
  fails(1, /--cues: .*missing\.json cannot be read/, ...film('missing.json'));
  fails(2, /--hold requires --cues/, 'render', CAR, '-o', file('no.png'), '--hold', '1');
  fails(2, /--eye excludes --cues/, ...film('cues.json'), '--eye', '1,2,3');
  fails(2, /--fps: one image has no speed/, 'render', CAR, '-o', file('no.png'), '--fps', '5');
  fails(2, /ACTION: draw not in \{check\}/, 'cues', 'draw', file('cues.json'), CAR);
  assert.deepEqual(fs.readdirSync(folder).filter((name) => name.startsWith('no')), ['none.json']);
});

test('a film that cannot be is rejected before the scene is read', (t) => {
  const none = file('no-scene.vrut');
  const film = (...options) => ['render', none, '-o', file('my.mp4'), '--keyframes', file('flight.json'), ...options];
  fails(2, /my\.mp4: a film needs --keyframes/, 'render', none, '-o', file('my.mp4'));
  fails(2, /--size: .* for 641x361 is 642x362/, ...film('--size', '641x361'));
  fails(2, /--size: .* for 641x360 is 642x360/, 'replay', none, '--film', file('my.mp4'), '--size', '641x360');
  fails(2, /--fps: 3 numbered images have no speed; leave out --fps or --frames/,
    'render', none, '-o', file('my.png'), '--keyframes', file('flight.json'), '--frames', '3', '--fps', '3');
  fails(2, /--fps/, ...film('--fps', '0'));
  fails(2, /--fps requires --film/, 'replay', none, '--fps', '5');
  fails(2, /--out excludes --film/, 'replay', none, '--film', file('my.mp4'), '--out', folder);
  fails(1, /my\.webm: .* that of a film in \.mp4/, 'replay', none, '--film', file('my.webm'));
  fs.writeFileSync(file('long.json'), '{"keyframes":[{"at":4e6,"camera":{"fov":30}}]}');
  fails(1, /long\.json: the flight takes 4000 s, which needs more than 100000 images at 30 a second; give --frames or a lower --fps/,
    'render', CAR, '-o', file('x.png'), '--keyframes', file('long.json'));

  const { status, stderr } = run(...film());
  if (/built without libavformat/.test(stderr)) return t.skip('the program is built without libavformat');
  assert.equal(status, 1);
  assert.match(stderr, /no-scene\.vrut: there is no such file/);
});

test('what is left out of a scene is told on standard error, and the picture drawn', () => {
  const scene = file('torn.vrut');
  fs.writeFileSync(scene, 'vrut-text 1\nmaterial 7 "Torn" image "nowhere.png" end\n');
  const result = run('render', scene, '-o', file('torn.png'), '--size', '8x8', '--reference');
  assert.equal(result.status, 0, result.stderr);
  assert.match(result.stderr, /material 7.*nowhere\.png/);
  assert.deepEqual(pngSize('torn.png'), [8, 8]);
});

test('render tells what a picture took', () => {
  const stats = JSON.parse(succeeds('render', MATRICES, '-o', file('s.png'), '--size', '64x64', '--samples', '1', '--stats'));
  const info = JSON.parse(succeeds('info', MATRICES, '--json'));
  assert.equal(stats.passes, 1);
  assert.equal(stats.triangles, info.triangles);
  assert.equal(stats.draws, info.tree.filter((node) => node.triangles > 0).length);
  assert.ok(stats.renderMs > 0);
});

/** Pixels of an 8-bit RGB PNG, rows from the top. */
function pngPixels(name) {
  const bytes = fs.readFileSync(file(name));
  const parts = [];
  for (let at = 8; at < bytes.length; at += 12 + bytes.readUInt32BE(at))
    if (bytes.toString('latin1', at + 4, at + 8) === 'IDAT') parts.push(bytes.subarray(at + 8, at + 8 + bytes.readUInt32BE(at)));
  const [width, height] = pngSize(name);
  const data = zlib.inflateSync(Buffer.concat(parts));
  const stride = 3 * width;
  const rows = Array.from({ length: height }, () => Buffer.alloc(stride));
  for (let y = 0; y < height; y++)
    for (let i = 0; i < stride; i++) {
      const a = i < 3 ? 0 : rows[y][i - 3];
      const b = y === 0 ? 0 : rows[y - 1][i];
      const c = i < 3 || y === 0 ? 0 : rows[y - 1][i - 3];
      const nearest = [a, b, c].sort((p, q) => Math.abs(a + b - c - p) - Math.abs(a + b - c - q))[0];
      const guess = [0, a, b, (a + b) >> 1, nearest][data[y * (stride + 1)]];
      rows[y][i] = data[y * (stride + 1) + 1 + i] + guess;
    }
  return rows;
}

const SQUARE = (id) => `vrut-text 1
material 1 "Glow" emission 0.2 0.6 1 1 diffuse 0 0 0 1 end
geometry 1 vertices 4 -1 -1 0 1 -1 0 1 1 0 -1 1 0 triangles 2 0 1 2 0 2 3 end
node ${id} "Square" geometry parent 0 geometry 1 material 1 end
`;

test('the reference, its unrounded values, and the nodes', () => {
  fs.writeFileSync(file('square.vrut'), SQUARE(66051));  // 0x010203
  const view = ['--size', '4x3', '--samples', '1', '--eye', '-1,0,1', '--focus', '-1,0,0', '--fov', '90'];
  // No device is asked for: 99 is none.
  succeeds('render', file('square.vrut'), '-o', file('r.png'), ...view, '--reference', '--float', file('r.pfm'), '--ids', file('ri.png'), '--device', '99');
  succeeds('render', file('square.vrut'), '-o', file('g.png'), ...view, '--ids', file('gi.png'));
  const [sky, glow] = [[230, 235, 242], [51, 153, 255]];
  for (const name of ['r.png', 'g.png'])
    assert.deepEqual(pngPixels(name).map((row) => [...row]), Array(3).fill([...sky, ...sky, ...glow, ...glow]));
  for (const name of ['ri.png', 'gi.png'])
    assert.deepEqual(pngPixels(name).map((row) => [...row]), Array(3).fill([...Array(6).fill(255), 1, 2, 3, 1, 2, 3]));
  const header = 'PF\n4 3\n-1.0\n';
  const pfm = fs.readFileSync(file('r.pfm'));
  assert.equal(pfm.toString('latin1', 0, header.length), header);
  assert.equal(pfm.length, header.length + 4 * 3 * 12);
  assert.equal(pfm.readFloatLE(header.length + 2 * 12 + 4), Math.fround(0.6));

  fails(2, /--float/, 'render', CAR, '-o', file('x.png'), '--float', file('x.pfm'));
  fails(2, /--stats/, 'render', CAR, '-o', file('x.png'), '--reference', '--stats');
  for (const shown of [['--wireframe'], ['--mode', 'stylized'], ['--select', '66051'], ['--set', '{"renderer":{"wireframe":true}}']])
    fails(2, /--reference draws surfaces alone/, 'render', file('square.vrut'), '-o', file('x.png'), '--reference', ...shown);
  fs.writeFileSync(file('high.vrut'), SQUARE(16777215));
  fails(1, /--ids: node 16777215/, 'render', file('high.vrut'), '-o', file('x.png'), ...view, '--reference', '--ids', file('i.png'));
});

test('the camera of a file, of --set and of the options is the same camera', () => {
  const eye = [3, 2.25, 5.5];
  fs.writeFileSync(file('camera.json'), JSON.stringify({ eye, focus: [0, 0.7, 0], fov: 30, near: 9, node: 4 }));
  const size = ['--size', '160x90'];
  succeeds('render', CAR, '-o', file('a.png'), ...size, '--camera', file('camera.json'));
  succeeds('render', CAR, '-o', file('b.png'), ...size, '--eye', eye.join(','), '--focus', '0,0.7,0', '--fov', '30');
  const set = JSON.stringify({ camera: { eye, focus: [0, 0.7, 0], fov: 30 } });
  succeeds('render', CAR, '-o', file('c.png'), ...size, '--set', set);
  succeeds('render', CAR, '-o', file('home.png'), ...size);
  assert.deepEqual(fs.readFileSync(file('a.png')), fs.readFileSync(file('b.png')));
  assert.deepEqual(fs.readFileSync(file('a.png')), fs.readFileSync(file('c.png')));
  assert.notDeepEqual(fs.readFileSync(file('a.png')), fs.readFileSync(file('home.png')));
});

/** Starts a server; resolves with the process and what it printed when it is ready. */
function serve(...options) {
  const server = spawn(PROGRAM, ['serve', ...options]);
  let printed = '';
  const ready = new Promise((resolve, reject) => {
    server.stdout.on('data', (data) => {
      printed += data;
      if (/listening on \S+\n/.test(printed)) resolve(printed);
    });
    server.on('exit', () => reject(new Error(`the server ended: ${printed}`)));
  });
  return { server, ready };
}

for (const signal of ['SIGTERM', 'SIGINT']) {
  test(`${signal} ends the server within five seconds, with status 0`, async () => {
    const { server, ready } = serve('--listen', '127.0.0.1:0');
    assert.match(await ready, /listening on http:\/\/127\.0\.0\.1:\d+\/\n/);
    const start = Date.now();
    const ended = new Promise((resolve) => server.on('exit', (status) => resolve(status)));
    server.kill(signal);
    assert.equal(await ended, 0);
    assert.ok(Date.now() - start < 5000);
  });
}

test('beyond this machine a token is made, and printed with a code to scan, and for this machine', async () => {
  const server = new Running(PROGRAM, ['serve', CAR, '--listen', '0.0.0.0:0']);
  const [, host, port, token] = await server.printed(/listening on http:\/\/([\d.]+):(\d+)\/#token=([0-9a-f]{32})\n/);
  // Without a network, the address before is the same.
  if (!host.startsWith('127.')) await server.printed(new RegExp(`for this machine on http://127\\.0\\.0\\.1:${port}/#token=${token}\n`));
  await server.stop('SIGKILL');
});

test('a start where too few threads can be had is told in a sentence', (t) => {
  // The limit holds for who is not root, and who is not may not reach the program by its path.
  if (process.getuid() !== 0) return t.skip('only root can become another user');
  const program = fs.openSync(PROGRAM, 'r');
  const nobody = '65534';
  const result = spawnSync(
    'prlimit',
    ['--nproc=5', 'setpriv', '--reuid', nobody, '--regid', nobody, '--clear-groups', '/proc/self/fd/3', 'serve'],
    { stdio: ['ignore', 'pipe', 'pipe', program], encoding: 'utf8', timeout: 20_000 },
  );
  fs.closeSync(program);
  assert.equal(result.status, 1, result.stderr);
  assert.match(result.stderr, /^vrut-preview: only \d+ threads can be had, and \d+ are needed: raise the limit \(ulimit -u\)\n$/);
});

test('a port that is taken is told in a sentence', async () => {
  const { server, ready } = serve('--listen', '127.0.0.1:0');
  const [, port] = /:(\d+)\//.exec(await ready);
  fails(1, new RegExp(`cannot listen at 127\\.0\\.0\\.1:${port}`), 'serve', '--listen', `127.0.0.1:${port}`, '--log-level', 'off');
  server.kill('SIGKILL');
});

test('compare tells how far pictures are apart', () => {
  const draw = (name, size, ...options) =>
    succeeds('render', CAR, '-o', file(name), '--size', size, ...options);
  draw('a.png', '64x48');
  draw('b.png', '64x48', '--wireframe');
  draw('c.jpg', '64x48');
  draw('wide.png', '65x48');
  const compare = (...options) => JSON.parse(succeeds('compare', ...options, '--json'));

  const same = compare(file('a.png'), file('a.png'));
  assert.deepEqual(same, {
    width: 64, height: 48, maximum: 0, rms: 0, psnr: null, above2: 0, above8: 0,
    flip: { mean: 0, weightedMedian: 0, firstWeightedQuartile: 0, thirdWeightedQuartile: 0, min: 0, max: 0 },
  });
  assert.match(succeeds('compare', file('a.png'), file('a.png')), /maximum 0 \/ 255\n.*PSNR inf dB/s);

  const other = compare(file('a.png'), file('b.png'), '--map', file('map.png'));
  assert.ok(other.maximum > 50 && other.rms > 1 && other.flip.mean > 0.01, JSON.stringify(other));
  assert.ok(Math.abs(other.psnr - 20 * Math.log10(255 / other.rms)) < 1e-9);
  assert.ok(other.above2 >= other.above8 && other.above8 > 0 && other.above2 <= 1);
  assert.deepEqual(pngSize('map.png'), [64, 48]);
  assert.match(succeeds('compare', file('a.png'), file('b.png')), /FLIP mean 0\.\d+/);

  const jpeg = compare(file('a.png'), file('c.jpg'));
  assert.ok(jpeg.rms > 0 && jpeg.rms < other.rms);

  fails(1, /different sizes.*64 x 48.*65 x 48/, 'compare', file('a.png'), file('wide.png'));
  fails(1, /missing\.png: there is no such file/, 'compare', file('a.png'), file('missing.png'));
  fails(1, /none of PNG, JPEG/, 'compare', CAR, file('a.png'));
  fails(1, /map\.jpg/, 'compare', file('a.png'), file('b.png'), '--map', file('map.jpg'));
  fails(2, /IMAGE2 is required/, 'compare', file('a.png'));
});

test('with pixels of detail fewer triangles are drawn', () => {
  const triangles = (detail) =>
    JSON.parse(succeeds('render', CAR, '-o', file('x.png'), '--size', '160x90', '--detail', detail, '--stats')).triangles;
  assert.ok(triangles('1') < triangles('0'));
});
