// The example scripts of protocol/examples and example_host, run as a reader would, against a server with tokens.
'use strict';
const assert = require('node:assert/strict');
const { execFile, spawn } = require('node:child_process');
const fs = require('node:fs');
const os = require('node:os');
const path = require('node:path');
const { after, before, test } = require('node:test');
const WebSocket = require('../web/node_modules/ws');

const { VRUT_PREVIEW, VRUT_CAR, VRUT_EXAMPLE_HOST, PYTHON } = process.env;
const EXAMPLES = path.join(__dirname, '../../protocol/examples');
const TOKEN = 'a-token-of-the-tests';
const folder = fs.mkdtempSync(path.join(os.tmpdir(), 'vrut-preview-'));
const file = (name) => path.join(folder, name);

let server;
let port;
let watcher;

before(async () => {
  server = spawn(VRUT_PREVIEW, ['serve', VRUT_CAR, '--listen', '127.0.0.1:0'], {
    env: { ...process.env, VRUT_PREVIEW_CONTROL_TOKEN: TOKEN },
    stdio: ['ignore', 'pipe', 'ignore'],
  });
  port = await printed(server, /listening on http:\/\/127\.0\.0\.1:(\d+)\//);
  watcher = await Watcher.join();
  // A script finds `ws` beside it, as after `npm install ws`.
  fs.copyFileSync(path.join(EXAMPLES, 'snapshot.mjs'), file('snapshot.mjs'));
  fs.symlinkSync(path.join(__dirname, '../web/node_modules'), file('node_modules'));
});

after(() => {
  watcher?.socket.terminate();
  server?.kill();
  fs.rmSync(folder, { recursive: true });
});

/** Resolves with what `pattern` finds in what a process prints, from now on. */
function printed(child, pattern) {
  let text = '';
  return new Promise((resolve, reject) => {
    child.stdout.on('data', (data) => {
      text += data;
      const found = pattern.exec(text);
      if (found) resolve(found[1] ?? found[0]);
    });
    child.once('exit', () => reject(new Error(`ended without ${pattern}: ${text}`)));
  });
}

/** Runs a script; the address and the token come from the environment. */
function run(command, args, env = {}) {
  const environment = { ...process.env, VRUT_PREVIEW_URL: `http://127.0.0.1:${port}/`, VRUT_PREVIEW_TOKEN: TOKEN, ...env };
  return new Promise((resolve) => {
    execFile(command, args, { cwd: folder, env: environment, timeout: 60_000 }, (error, stdout, stderr) => {
      resolve({ status: error ? error.code : 0, stdout, stderr });
    });
  });
}
const python = (script, ...args) => run(PYTHON, [path.join(EXAMPLES, script), ...args]);
const snapshot = (...args) => run(process.execPath, [file('snapshot.mjs'), ...args]);
const picture = (...args) => run('bash', [path.join(EXAMPLES, 'picture.sh'), ...args]);

async function succeeds(running) {
  const result = await running;
  assert.equal(result.status, 0, `${result.stdout}${result.stderr}`);
  return result.stdout;
}

/** A client of role control that knows the state, and how it came about. */
class Watcher {
  patches = [];
  pointed = [];

  static async join() {
    const self = new Watcher();
    self.socket = new WebSocket(`ws://127.0.0.1:${port}/ws`, 'vrut-preview.v1');
    await new Promise((resolve, reject) => {
      self.socket.on('open', () => self.send({ type: 'hello', role: 'control', token: TOKEN }));
      self.socket.on('error', reject);
      self.socket.on('message', (data) => {
        const message = JSON.parse(data);
        if (message.type === 'state') resolve((self.state = message.state));
        if (message.type === 'tree') self.tree = message.nodes;
        if (message.type === 'pointed') self.pointed.push(message);
        if (message.type === 'patch') self.patches.push(message.patch);
        if (message.type === 'patch') self.state = merged(self.state, message.patch);
      });
    });
    return self;
  }

  send(message) {
    this.socket.send(JSON.stringify(message));
  }

  async until(condition) {
    for (const limit = Date.now() + 10_000; !condition(); ) {
      assert.ok(Date.now() < limit, `waited in vain for ${condition}`);
      await new Promise((resolve) => setTimeout(resolve, 10));
    }
  }
}

function merged(target, patch) {
  if (patch === null || typeof patch !== 'object' || Array.isArray(patch)) return patch;
  const result = { ...target };
  for (const [name, value] of Object.entries(patch)) {
    if (value === null) delete result[name];
    else result[name] = merged(result[name] ?? {}, value);
  }
  return result;
}

/** Size and header of a JPEG frame. */
function jpeg(name) {
  const bytes = fs.readFileSync(file(name));
  assert.equal(bytes.readUInt16BE(0), 0xffd8, `${name} is no JPEG file`);
  const result = {};
  for (let at = 2; result.width === undefined; at += 2 + bytes.readUInt16BE(at + 2)) {
    const marker = bytes[at + 1];
    if (marker === 0xfe) result.header = JSON.parse(bytes.toString('utf8', at + 4, at + 2 + bytes.readUInt16BE(at + 2)));
    if (marker >= 0xc0 && marker <= 0xc2) {
      result.height = bytes.readUInt16BE(at + 5);
      result.width = bytes.readUInt16BE(at + 7);
    }
  }
  return result;
}

/** Size and header of a PNG snapshot. */
function png(name) {
  const bytes = fs.readFileSync(file(name));
  assert.equal(bytes.toString('latin1', 1, 4), 'PNG', `${name} is no PNG file`);
  const start = bytes.indexOf('iTXtvrut-preview\0') + 'iTXtvrut-preview\0'.length;
  const end = start - 'iTXtvrut-preview\0'.length + 4 + bytes.readUInt32BE(start - 'iTXtvrut-preview\0'.length - 4);
  const fields = 4; // not compressed, no method, no language, no translated keyword
  return {
    width: bytes.readUInt32BE(16),
    height: bytes.readUInt32BE(20),
    header: JSON.parse(bytes.toString('utf8', start + fields, end)),
  };
}

test('the script of the README moves the camera, and gives control back', async () => {
  const [, script] = /```python\n(.*?)```/s.exec(fs.readFileSync(path.join(__dirname, '../../README.md'), 'utf8'));
  fs.writeFileSync(file('readme.py'), script.replace('127.0.0.1:8080', `127.0.0.1:${port}`)
    .replace('role="control"', `role="control", token="${TOKEN}"`));
  const { holder } = watcher.state.control;
  await succeeds(run(PYTHON, [file('readme.py')]));
  await watcher.until(() => String(watcher.state.camera.eye) === '3,2,5' && watcher.state.control.holder === holder);
});

test('each script tells its usage', async () => {
  assert.match(await succeeds(python('orbit.py', '--help')), /--steps/);
  assert.match(await succeeds(python('door.py', '--help')), /--open/);
  assert.match(await succeeds(python('sweep.py', '--help')), /--normal/);
  assert.match(await succeeds(python('gaps.py', '--help')), /--second/);
  assert.match(await succeeds(python('show_cues.py', '--help')), /--hold/);
  assert.match(await succeeds(python('point.py', '--help')), /--seconds/);
  assert.match(await succeeds(python('notes.py', '--help')), /--report/);
  assert.match(await succeeds(snapshot('--help')), /--camera/);
  assert.match(await succeeds(picture('--help')), /VRUT_PREVIEW_TOKEN/);
  assert.match(await succeeds(run(VRUT_EXAMPLE_HOST, ['--help'])), /--lead/);
  assert.equal((await snapshot()).status, 2);
  assert.equal((await picture()).status, 2);
  assert.equal((await run(VRUT_EXAMPLE_HOST, ['--nose'])).status, 2);
});

test('a wrong token is told in a sentence', async () => {
  for (const [script, args] of [['orbit.py', []], ['door.py', []], ['sweep.py', []], ['gaps.py', []], ['show_cues.py', []], ['point.py', []], ['notes.py', []]]) {
    const result = await python(script, ...args, '--token', 'guess');
    assert.equal(result.status, 1);
    assert.equal(result.stderr, `${script}: the token is wrong\n`);
  }
  const result = await snapshot('x.png', '--token', 'guess');
  assert.equal(result.status, 1);
  assert.equal(result.stderr, 'snapshot.mjs: the token is wrong\n');
  const refused = await run('bash', [path.join(EXAMPLES, 'picture.sh'), 'x.jpg'], { VRUT_PREVIEW_TOKEN: 'guess' });
  assert.notEqual(refused.status, 0);
  assert.match(refused.stderr, /401/);
});

test('orbit.py saves the views of a whole turn, told the address as it is printed', async () => {
  const env = { VRUT_PREVIEW_URL: '', VRUT_PREVIEW_TOKEN: '' };
  const address = `http://127.0.0.1:${port}/#token=${TOKEN}`;
  const script = [path.join(EXAMPLES, 'orbit.py'), '--url', address, '--steps', '3', '--size', '320x200', '--out', 'orbit'];
  await succeeds(run(PYTHON, script, env));
  const names = fs.readdirSync(file('orbit')).sort();
  assert.deepEqual(names, ['frame-000.jpg', 'frame-001.jpg', 'frame-002.jpg']);
  const directions = names.map((name) => {
    const { width, height, header } = jpeg(`orbit/${name}`);
    assert.deepEqual([width, height], [320, 200]);
    assert.equal(header.quality.level, 'still');
    const { eye, center } = header.camera;
    return (Math.atan2(eye[0] - center[0], eye[2] - center[2]) * 180) / Math.PI;
  });
  // The scene turns to the right, so the eye goes to the left around it.
  for (let i = 1; i < 3; ++i) {
    const turn = (directions[i - 1] - directions[i] + 360) % 360;
    assert.ok(Math.abs(turn - 120) < 1e-9, `turned by ${turn}`);
  }
});

test('point.py points everybody to the car, and takes the point away again', async () => {
  const points = (await succeeds(python('point.py', '--seconds', '0.4'))).trim().split('\n').map((line) => line.split(' ').map(Number));
  assert.ok(points.length > 1 && points.every((point) => point.length === 3 && point.every(Number.isFinite)), `${points}`);
  const { min, max } = watcher.state.scene.bounds;
  for (const point of points) point.forEach((x, i) => assert.ok(x > min[i] - 0.01 && x < max[i] + 0.01, `${point}`));
  await watcher.until(() => watcher.pointed.length >= 2 && !watcher.pointed.at(-1).point);
  const seen = watcher.pointed.filter(({ name }) => name === 'point.py');
  assert.deepEqual(seen.slice(0, 1).map(({ point }) => point.map((x) => Number(x.toFixed(4)))), points.slice(0, 1));
});

test('notes.py lists notes, marks one as done, and saves the report and the table', async () => {
  const patch = (markers) => {
    watcher.send({ type: 'control', action: 'take' });
    watcher.send({ type: 'patch', patch: { markers } });
  };
  patch({ gap: { point: [1, 2, 3], text: 'Gap too wide', author: 'Bea', time: 1764345600000 }, old: { point: [0, 0, 0], text: 'Dent', author: null, view: null } });
  await watcher.until(() => watcher.state.markers.gap);
  assert.match(await succeeds(python('notes.py')), /^open\told\tDent\t\t\nopen\tgap\tGap too wide\tBea\t2025-11-28 \d\d:\d\d\n$/);
  const printed = await succeeds(python('notes.py', '--done', 'Gap too wide', '--report', file('report.html')));
  assert.match(printed, /\ndone\tgap\t/);
  await watcher.until(() => watcher.state.markers.gap?.done);
  const html = fs.readFileSync(file('report.html'), 'utf8');
  assert.ok(html.includes('Gap too wide') && html.includes('src="data:image/jpeg;base64,/9j/'));
  await succeeds(python('notes.py', '--report', file('report.csv')));
  assert.match(fs.readFileSync(file('report.csv'), 'utf8'), /\r\ngap,Gap too wide,Bea,2025-11-28T16:00:00Z,true,1,2,3,\r\n/);
  const unknown = await python('notes.py', '--done', 'Nose');
  assert.equal(unknown.stderr, "notes.py: there is no note 'Nose'; without options the script lists them\n");
  assert.equal((await python('notes.py', '--report', 'x.pdf')).status, 2);
  patch(null);
  await watcher.until(() => !watcher.state.markers.gap);
});

test('show_cues.py shows a list, saves a picture of each cue, and takes the list away again', async () => {
  const cues = {
    'All doors': { order: 2, ms: 10, camera: { eye: [4, 2, 5], focus: [0, 0.7, 0] }, nodes: { 101: { active: false } } },
    Arrival: { order: 1, ms: 0 },
    Lost: { order: 3, selection: { node: 9_999_999 } },
  };
  fs.writeFileSync(file('cues.json'), JSON.stringify({ format: 'vrut-preview-cues', version: 1, cues }));
  const printed = await succeeds(python('show_cues.py', file('cues.json'), '--size', '320x200', '--out', 'cues'));
  assert.match(printed, /there is no node 9999999/);
  assert.deepEqual(fs.readdirSync(file('cues')).sort(), ['01-Arrival.jpg', '02-All-doors.jpg']);
  assert.deepEqual([jpeg('cues/01-Arrival.jpg').width, jpeg('cues/02-All-doors.jpg').height], [320, 200]);
  const files = ['01-Arrival.jpg', '02-All-doors.jpg'].map((name) => fs.readFileSync(file(`cues/${name}`)));
  assert.notDeepEqual(...files);
  await watcher.until(() => Object.keys(watcher.state.cues).length === 0);
  assert.deepEqual(watcher.state.nodes, {});
});

test('sweep.py saves a picture for each step of a section, and takes it away again', async () => {
  const seen = [];
  const noted = watcher.patches.length;
  await succeeds(python('sweep.py', '--steps', '3', '--size', '320x200', '--normal', '0,2,0', '--out', 'sweep'));
  const names = fs.readdirSync(file('sweep')).sort();
  assert.deepEqual(names, ['cut-000.jpg', 'cut-001.jpg', 'cut-002.jpg']);
  for (const name of names) {
    const { width, height } = jpeg(`sweep/${name}`);
    assert.deepEqual([width, height], [320, 200]);
    seen.push(fs.readFileSync(file(`sweep/${name}`)).toString('base64'));
  }
  assert.equal(new Set(seen).size, 3);
  await watcher.until(() => Object.keys(watcher.state.sections).length === 0);
  const distances = watcher.patches.slice(noted).map((patch) => patch.sections?.Sweep?.distance).filter(Number.isFinite);
  assert.ok(distances.length > 0 && distances.every((distance) => distance > 0 && distance < 1.6), `${distances}`);
});

test('a section of no direction is refused in a sentence', async () => {
  const result = await python('sweep.py', '--normal', '0,0,0', '--out', 'sweep');
  assert.equal(result.status, 1);
  assert.match(result.stderr, /^sweep.py: 'sections.Sweep.normal' is \[0, 0, 0\]/);
});

test('gaps.py writes how wide the gap between two doors is, and takes its measure away again', async () => {
  const { eye } = watcher.state.camera;
  const table = (await succeeds(python('gaps.py', '--lines', '3', '--out', '-'))).trim().split('\n').map((row) => row.trim().split(','));
  assert.deepEqual(table[0], ['line', 'first x', 'first y', 'first z', 'second x', 'second y', 'second z', 'width mm']);
  assert.ok(table.length > 1, 'a line across the picture crosses the gap');
  for (const row of table.slice(1)) assert.ok(row[7] > 2 && row[7] < 30, `a gap of ${row[7]} mm`);
  await watcher.until(() => Object.keys(watcher.state.measures).length === 0);
  assert.deepEqual(watcher.state.camera.eye, eye);
  const nothing = await python('gaps.py', '--lines', '2', '--first', 'Nowhere');
  assert.equal(nothing.status, 1);
  assert.equal(nothing.stderr, "gaps.py: 'Doors/Rear left' does not follow 'Nowhere' on any line of this view\n");
});

test('example_host prints the camera that others set, and ends at SIGINT', async () => {
  const host = spawn(VRUT_EXAMPLE_HOST, ['--port', port, '--token', TOKEN, '--name', 'wall']);
  const ended = new Promise((resolve) => host.on('exit', (status) => resolve(status)));
  await printed(host, /^revision \d+ eye .* fov [\d.]+\n/);
  watcher.send({ type: 'patch', patch: { camera: { eye: [4, 1.5, 3], focus: [0, 0.5, 0], up: [0, 1, 0], fov: 35 } } });
  await printed(host, /^revision \d+ eye 4 1.5 3 focus 0 0.5 0 up \S+ \S+ \S+ fov 35\n/m);
  host.kill('SIGINT');
  assert.equal(await ended, 0);
});

test('example_host prints the camera of a room, by an edge', { skip: !fs.existsSync('/usr/sbin/nats-server') && 'there is no nats-server' }, async (t) => {
  const { Cluster } = await import('../web/several/cluster.js');
  const cluster = new Cluster(t);
  await cluster.startNats();
  await cluster.serve('car', { scene: VRUT_CAR });
  const edge = await cluster.edge();
  await cluster.room(edge, 'car');
  const host = spawn(VRUT_EXAMPLE_HOST, ['--port', new URL(edge.url).port, '--path', '/rooms/car/ws']);
  t.after(() => host.kill());
  await printed(host, /^revision \d+ eye .* fov [\d.]+\n/);
});

test('example_host prints what others point at', async () => {
  watcher.send({ type: 'patch', patch: { camera: { eye: [4, 1.5, 3], focus: [0, 0.5, 0], up: [0, 1, 0], fov: 35 } } });
  const host = spawn(VRUT_EXAMPLE_HOST, ['--port', port, '--token', TOKEN, '--name', 'wall']);
  await printed(host, /^revision /);
  watcher.send({ type: 'point', x: 640, y: 360 });
  await printed(host, /^points at \S+ \S+ \S+ normal \S+ \S+ \S+ client c1 name \n/m);
  watcher.send({ type: 'point' });
  await printed(host, /^points no more client c1 name \n/m);
  host.kill('SIGINT');
});

test('example_host leads the camera once around, back to where it was', async () => {
  await new Promise((resolve) => setTimeout(resolve, 1200)); // until who steered last counts as quiet
  const { eye } = watcher.state.camera;
  const opposite = (at) => Math.hypot(at[0] + eye[0], at[2] + eye[2]) < 0.02;
  watcher.send({ type: 'patch', patch: { camera: { center: [0, 0, 0] } } });
  await new Promise((resolve) => setTimeout(resolve, 1200));
  watcher.patches.length = 0;
  const host = spawn(VRUT_EXAMPLE_HOST, ['--port', port, '--token', TOKEN, '--lead']);
  await watcher.until(() => watcher.patches.some((patch) => patch.camera?.eye && opposite(patch.camera.eye)));
  await watcher.until(() => watcher.state.camera.eye.every((x, i) => x === eye[i]));
  host.kill('SIGTERM');
});

test('door.py opens a door about its own hinge, and closes it', async () => {
  const named = (name, parent) => watcher.tree?.find((node) => node.name === name && (!parent || node.parent === parent));
  watcher.send({ type: 'tree', id: 1, search: 'Doors' });
  await watcher.until(() => named('Doors'));
  const doors = named('Doors').id;
  watcher.send({ type: 'tree', id: 2, node: doors });
  await watcher.until(() => named('Front left', doors));
  const { id, matrix: closed } = named('Front left', doors);

  watcher.patches.length = 0;
  await succeeds(python('door.py', '--hold', '0.1'));
  const matrices = watcher.patches.map((patch) => patch.nodes?.[id]?.matrix).filter(Boolean);
  assert.ok(matrices.length >= 5, `${matrices.length} steps`);
  // The closed door has no rotation: open, it has that of -65°, cos 0.42261826, sin -0.90630779.
  const expected = [...closed];
  [expected[0], expected[2], expected[8], expected[10]] = [0.42261826, -0.90630779, 0.90630779, 0.42261826];
  assert.ok(matrices.some((matrix) => expected.every((value, i) => Math.abs(matrix[i] - value) < 1e-7)), `${matrices}`);
  await watcher.until(() => !(id in (watcher.state.nodes ?? {})));
  assert.match((await python('door.py', '--door', 'Body/Nose')).stderr, /^door\.py: .*'Body\/Nose'\n$/);
  assert.equal((await python('door.py', '--door', 'Body/Roof')).stderr, "door.py: 'Body/Roof' has no hinge\n");
});

test('door.py opens what turns about another axis, and as far as it is told to', async () => {
  watcher.tree = undefined;
  watcher.send({ type: 'tree', id: 3, search: 'Boot lid' });
  await watcher.until(() => watcher.tree);
  const { id, hinge } = watcher.tree.find((node) => node.hinge);
  assert.deepEqual([hinge.axis, hinge.degrees], [[1, 0, 0], 70]);
  for (const [args, degrees] of [[[], 70], [['--open', '0.5'], 35]]) {
    watcher.patches.length = 0;
    await succeeds(python('door.py', '--door', 'Body/Boot lid', '--hold', '0.1', ...args));
    const matrices = watcher.patches.map((patch) => patch.nodes?.[id]?.matrix).filter(Boolean);
    const [c, s] = [Math.cos((degrees * Math.PI) / 180), Math.sin((degrees * Math.PI) / 180)];
    const expected = [...hinge.closed];
    [expected[5], expected[6], expected[9], expected[10]] = [c, -s, s, c];
    assert.ok(matrices.some((matrix) => expected.every((value, i) => Math.abs(matrix[i] - value) < 1e-12)), `${matrices}`);
    await watcher.until(() => !(id in (watcher.state.nodes ?? {})));
  }});

test('snapshot.mjs saves pictures of the size and from where it is asked to', async () => {
  const before = JSON.stringify(watcher.state.camera);
  await succeeds(snapshot('view.jpg', '--size', '300x170', '--quality', '80'));
  const shared = jpeg('view.jpg');
  assert.deepEqual([shared.width, shared.height], [300, 170]);
  assert.deepEqual(shared.header.camera.eye, watcher.state.camera.eye);
  assert.equal(shared.header.quality.jpegQuality, 80);

  fs.writeFileSync(file('camera.json'), JSON.stringify({ eye: [0, 9, 0.5], focus: [0, 0, 0], fov: 25 }));
  await succeeds(snapshot('above.png', '--size', '64x48', '--camera', 'camera.json'));
  const above = png('above.png');
  assert.deepEqual([above.width, above.height], [64, 48]);
  assert.deepEqual(above.header.camera.eye, [0, 9, 0.5]);
  assert.equal(above.header.snapshot, 1);
  assert.equal(JSON.stringify(watcher.state.camera), before);

  const refused = await snapshot('x.png', '--size', '0x5');
  assert.equal(refused.status, 1);
  assert.match(refused.stderr, /^snapshot\.mjs: .*width/);
  assert.ok(!fs.existsSync(file('x.png')));
});

test('picture.sh fetches the picture, and again only when it has changed', async () => {
  assert.match(await succeeds(picture('p.jpg', '200', '100')), /^p\.jpg: saved\n[^]*vrut_preview_clients\{role="view"\} \d/);
  const first = jpeg('p.jpg');
  assert.deepEqual([first.width, first.height], [200, 100]);
  const bytes = fs.readFileSync(file('p.jpg'));
  for (let i = 0; i < 2; ++i) assert.match(await succeeds(picture('p.jpg', '200', '100')), /^p\.jpg: unchanged\n/);
  assert.deepEqual(fs.readFileSync(file('p.jpg')), bytes);
  watcher.send({ type: 'patch', patch: { camera: { fov: 44 } } });
  await watcher.until(() => watcher.state.camera.fov === 44);
  assert.match(await succeeds(picture('p.jpg', '200', '100')), /^p\.jpg: saved\n/);
  assert.notDeepEqual(fs.readFileSync(file('p.jpg')), bytes);
});
