// Contract: `frame`, FRAMES.md, and that nothing is sent while nothing changes.
import assert from 'node:assert/strict';
import { after, describe, test } from 'node:test';
import { setTimeout as sleep } from 'node:timers/promises';
import { inflateSync } from 'node:zlib';
import { ContractClient } from './contract-client.js';
import { near, nearCamera } from './numbers.js';
import { schemaTest } from './schema.js';
import { Server } from './server.js';
import { pixelsNow, POSE, SEEN, steering, VIEW } from './stage.js';

const server = await Server.start();
after(() => server.stop());

const isStill = (header) => header.quality.level === 'still';

/** Grants until nothing more comes for half a second. @returns the headers that came */
async function settled(client) {
  const from = client.frames.length;
  let seen = from;
  let quietSince = Date.now();
  client.send({ type: 'frame' });
  while (Date.now() - quietSince < 600) {
    await sleep(20);
    for (; seen < client.frames.length; ++seen) {
      client.send({ type: 'frame' });
      quietSince = Date.now();
    }
  }
  return client.frames.slice(from).map((frame) => frame.header);
}

describe('grants', () => {
  test('one grant brings one frame', async (t) => {
    const client = await steering(t, server);
    const count = client.frames.length;
    await sleep(400);
    assert.equal(client.frames.length, count, 'none without a grant');
    client.send({ type: 'frame' });
    await client.until('a frame', () => client.frames.length > count);
    await client.ask({ type: 'navigate', rotate: [5, 0] });
    await sleep(400);
    assert.equal(client.frames.length, count + 1, 'no more than granted');
  });

  test('at most 2 are kept', async (t) => {
    const client = await steering(t, server);
    await settled(client); // one grant is left over
    const count = client.frames.length;
    for (let i = 0; i < 5; ++i) client.send({ type: 'frame' });
    for (let i = 0; i < 8; ++i) {
      await client.ask({ type: 'navigate', rotate: [5, 0] });
      await sleep(80);
    }
    await sleep(300);
    assert.equal(client.frames.length, count + 2);
  });

  test('while nothing changes, nothing is sent; one change ends the wait', async (t) => {
    const client = await steering(t, server);
    await settled(client);
    const count = client.frames.length;
    await client.barrier();
    await client.patch({});
    client.send({ type: 'pointermove', pointerId: 1, pointerType: 'mouse', x: 9, y: 9, button: -1, buttons: 0 });
    await sleep(500);
    assert.equal(client.frames.length, count);
    await client.ask({ type: 'navigate', rotate: [5, 0] });
    await client.until('a frame', () => client.frames.length > count);
  });

  test('a change of the document that cannot be seen brings no frame', async (t) => {
    const client = await steering(t, server);
    await settled(client);
    const count = client.frames.length;
    await client.patch({ navigation: { panSpeed: 3 } });
    await client.patch({ navigation: null });
    await sleep(400);
    assert.equal(client.frames.length, count);
  });

  test('who acknowledges a frame that it was never sent is refused, and grants nothing', async (t) => {
    const client = await steering(t, server);
    const other = await ContractClient.join(t, server, { role: 'view' });
    await client.ask({ type: 'navigate', rotate: [5, 0] });
    await other.until('the newest state', () => other.revision === client.revision);
    const { header } = await other.frameOfNow();
    const own = client.frames.at(-1).header.frame;
    assert.ok(header.frame > own, 'only the other has it');
    const count = client.frames.length;
    for (const shown of [header.frame, Number.MAX_SAFE_INTEGER]) {
      await client.refused({ type: 'frame', shown }, 'out-of-range', { valid: true });
    }
    await client.barrier();
    assert.equal(client.frames.length, count, 'none, though there is a newer one');
    client.send({ type: 'frame', shown: own });
    await client.until('a frame', () => client.frames.length > count);
  });

  for (const [what, patch, back] of [
    ['camera', { camera: { fov: 44 } }, {}],
    ['the plain colour', { backgrounds: { active: 'color', color: [0.2, 0.4, 0.1, 1] } }, { backgrounds: { active: null, color: null } }],
    ['selection', { selection: { node: 4 } }, { selection: { node: null } }],
    ['renderer', { renderer: { mode: 'stylized' } }, { renderer: null }],
    ['wireframe', { renderer: { wireframe: true } }, { renderer: null }],
    ['light', { lights: { active: '9' } }, { lights: { active: null } }],
    ["a light's colour", { lights: { items: { headlight: { color: [1, 0, 0, 1] } } } }, { lights: { items: { headlight: null } } }],
    ['background', { backgrounds: { active: '17' } }, { backgrounds: { active: null } }],
    ['nodes', { nodes: { 4: { active: false } } }, { nodes: null }],
    ['a paint', { nodes: { 4: { material: 1 } } }, { nodes: null }],
    ['a switch', { nodes: { 6: { activeChild: 1 } } }, { nodes: null }],
  ]) {
    test(`a change of ${what} can be seen`, async (t) => {
      const client = await steering(t, server);
      const still = (header) => header.revision >= client.revision && isStill(header) && header.quality.scale === 1;
      const fov = client.revision % 2 ? 41 : 42; // a change that is sure to be drawn
      await client.patch({ ...back, camera: { fov } });
      await client.frame(still, 'a still frame');
      const before = await pixelsNow(client);
      await client.patch(patch);
      await client.frame(still, 'a still frame of the change');
      assert.notEqual(await pixelsNow(client), before, 'the picture differs');
      await client.patch(back);
    });
  }
});

describe('the header', () => {
  test('has every member', async (t) => {
    const client = await steering(t, server);
    const { header, width, height, subsampling } = await client.frameOfNow();
    assert.ok(Number.isSafeInteger(header.frame) && header.frame > 0);
    assert.ok(header.revision <= client.revision);
    assert.ok(header.handled >= 0);
    assert.equal(header.snapshot, undefined);
    nearCamera(header.camera, POSE, 'camera');
    assert.ok(header.camera.near > 0 && header.camera.far > header.camera.near);
    assert.equal(header.camera.viewMatrix.length, 16);
    assert.equal(header.camera.projectionMatrix.length, 16);
    assert.deepEqual([header.width, header.height], [width, height]);
    assert.deepEqual(header.view, VIEW);
    assert.deepEqual([header.renderer.mode, header.renderer.wireframe, typeof header.renderer.showSelection], ['realistic', false, 'boolean']);
    const { quality } = header;
    assert.ok(['moving', 'still'].includes(quality.level));
    assert.ok(quality.scale > 0 && quality.scale <= 1);
    assert.ok(quality.samples >= 1);
    assert.ok(quality.detail >= 0);
    assert.ok(quality.jpegQuality >= 1 && quality.jpegQuality <= 100);
    assert.equal(quality.subsampling, subsampling, 'as the file says');
    for (const member of ['renderMs', 'readbackMs', 'encodeMs']) assert.ok(header.timing[member] >= 0, member);
  });

  test('handled is 0 before the first id, then the highest that was handled', async (t) => {
    const client = await ContractClient.join(t, server);
    client.send({ type: 'frame' }, { id: null });
    await client.until('a frame', () => client.frames.length > 0);
    assert.equal(client.frames[0].header.handled, 0);
    await client.ask({ type: 'control', action: 'take' });
    const id = client.send({ type: 'navigate', rotate: [7, 0] });
    await client.answer(id);
    assert.ok((await client.frameOfNow()).header.handled >= id);
  });

  test('sinceInputMs is the time since the newest input that it shows', async (t) => {
    const client = await steering(t, server);
    await settled(client);
    const before = Date.now();
    client.input.send({ type: 'wheel', x: 200, y: 150, deltaX: 0, deltaY: -100, deltaMode: 0 });
    const frame = await client.frame((header) => header.camera.eye[2] < 8);
    const { sinceInputMs } = frame.header.timing;
    assert.ok(sinceInputMs > 0 && sinceInputMs <= frame.at - before + 5, `${sinceInputMs} ms in ${frame.at - before}`);
  });

  test('numbers are those of the state, to the bit', async (t) => {
    const client = await steering(t, server, { eye: [0.1 + 0.2, 1 / 3, 7.1], fov: 33.3 });
    const { camera } = (await client.frameOfNow()).header;
    for (const member of ['eye', 'focus', 'up', 'center', 'fov', 'near', 'far']) assert.deepEqual(camera[member], client.state.camera[member], member);
  });
});

describe('sizes', () => {
  for (const [width, height, pixelRatio] of [[400, 300, 1], [333.3, 222.2, 1.5], [100, 75, 4], [401, 299, 0.25], [1, 1, 0.25], [2, 2, 0.25]]) {
    test(`a still frame of ${width} x ${height} at ${pixelRatio} has round(size x ratio x scale) pixels`, async (t) => {
      const client = await steering(t, server);
      await client.ask({ type: 'resize', width, height, pixelRatio });
      const shows = (header) => header.view.width === width && header.view.pixelRatio === pixelRatio;
      const { header } = await client.frame((h) => shows(h) && isStill(h) && h.quality.scale === 1, 'a still frame');
      assert.deepEqual(header.view, { width, height, pixelRatio });
      assert.deepEqual([header.width, header.height], [Math.max(1, Math.round(width * pixelRatio)), Math.max(1, Math.round(height * pixelRatio))]);
      for (const { header: any } of client.frames.filter((f) => shows(f.header))) {
        const { scale } = any.quality;
        near(any.width, Math.max(1, Math.round(any.view.width * pixelRatio * scale)), 'width at its scale', 1 / any.width);
      }
    });
  }

  test('more than maxPixels is drawn smaller', async (t) => {
    const client = await steering(t, server);
    const { maxPixels } = client.welcome.limits;
    await client.ask({ type: 'resize', width: 8192, height: 8192, pixelRatio: 4 });
    const { header } = await client.frame((h) => h.view.width === 8192);
    assert.deepEqual(header.view, { width: 8192, height: 8192, pixelRatio: 4 });
    assert.ok(header.width * header.height <= maxPixels, `${header.width} x ${header.height}`);
    assert.ok(header.quality.scale < 1);
    await client.ask({ type: 'resize', ...VIEW });
  });
});

describe('levels of accuracy', () => {
  test('after a change: moving, then still of rising samples, the first after 150 ms, the last at scale 1', async (t) => {
    const client = await steering(t, server);
    await settled(client);
    const asked = Date.now();
    await client.ask({ type: 'navigate', rotate: [3, 0] });
    const { revision } = client;
    const headers = (await settled(client)).filter((header) => header.revision >= revision);
    const firstStill = headers.findIndex(isStill);
    assert.ok(firstStill >= 0, 'a still one came');
    assert.ok(headers.slice(firstStill).every(isStill), 'none is moving behind a still one');
    const samples = headers.slice(firstStill).map((header) => header.quality.samples);
    assert.ok(samples.every((n, i) => i === 0 || n > samples[i - 1]), `${samples} rise`);
    assert.equal(headers.at(-1).quality.scale, 1);
    const at = client.frames.find((frame) => frame.header.frame === headers[firstStill].frame).at;
    assert.ok(at - asked >= 149, `after ${at - asked} ms`);
  });

  test('while it moves, all frames are moving', async (t) => {
    const client = await steering(t, server);
    const count = client.frames.length;
    let seen = count;
    client.send({ type: 'frame' });
    let last = Date.now();
    let slowest = 0;
    for (let i = 0; i < 25; ++i) {
      await client.ask({ type: 'navigate', rotate: [1, 0] });
      slowest = Math.max(slowest, Date.now() - last);
      last = Date.now();
      for (; seen < client.frames.length; ++seen) client.send({ type: 'frame' });
      await sleep(20);
    }
    if (slowest > 120) return t.skip(`the machine stalled for ${slowest} ms`);
    const levels = client.frames.slice(count + 1).map((frame) => frame.header.quality.level);
    assert.ok(levels.length >= 3);
    assert.deepEqual([...new Set(levels)], ['moving']);
    return undefined;
  });

  test('every client sees the same picture', async (t) => {
    const client = await steering(t, server);
    const watcher = await ContractClient.join(t, server, { role: 'view' });
    const done = (header) => isStill(header) && header.quality.scale === 1 && header.quality.samples === 16 && header.camera.fov === 43;
    await client.patch({ camera: { fov: 43 } });
    const [mine, its] = await Promise.all([client.frame(done), watcher.frame(done)]);
    assert.equal(its.header.frame, mine.header.frame);
    assert.deepEqual(its.bytes.subarray(-500), mine.bytes.subarray(-500));
  });
});

describe('depth', () => {
  /** The newest frame that shows what is to be seen now at full accuracy. */
  async function sharp(client) {
    await settled(client);
    const frame = client.frames.at(-1);
    assert.equal(frame.header.quality.samples, 16);
    return frame;
  }

  /** The map's `far`, and which blocks have an edge; see FRAMES.md. */
  function blocksOf({ header: { depth }, map }) {
    const { columns, rows } = depth;
    const bytes = inflateSync(map);
    const blocks = columns * rows;
    const far = [];
    for (let i = 0; i < blocks; ++i) {
      const [left, upper] = [far[i - 1], far[i - columns]];
      let predicted = i === 0 ? 0 : i < columns ? left : upper;
      if (i > columns && i % columns > 0) {
        predicted = [left, upper, left + upper - far[i - columns - 1]].sort((a, b) => a - b)[1];
      }
      far.push((predicted + (bytes[i] % 2 ? -(bytes[i] + 1) / 2 : bytes[i] / 2)) & 255);
    }
    const edges = far.map((_, i) => (bytes[blocks + (i >> 3)] >> (i & 7)) & 1);
    const count = edges.filter(Boolean).length;
    assert.equal(bytes.length, blocks + Math.ceil(blocks / 8) + 3 * count);
    return { far, edges };
  }

  test('who asks for it gets it once for each view, and nobody else', async (t) => {
    const client = await steering(t, server);
    const other = await ContractClient.join(t, server, { role: 'view', depth: true });
    client.send({ type: 'frame' });
    const first = await sharp(other);
    assert.ok(first.header.depth.frame > 0);
    assert.equal(other.frames.filter(({ header }) => header.depth?.bytes > 0).length, 1, 'once for a view');
    assert.ok(client.frames.every(({ header, map }) => !header.depth && map.length === 0));

    const count = other.frames.length;
    await client.ask({ type: 'navigate', rotate: [5, 0] });
    const next = await sharp(other);
    assert.ok(next.header.depth.frame > first.header.depth.frame);
    const withMap = other.frames.slice(count).filter(({ header }) => header.depth?.bytes > 0);
    assert.ok(withMap.every(({ header }) => header.depth.frame === header.frame), 'moving frames have their own');
    assert.ok(withMap.length > 0);
  });

  test('a view that turns is drawn ahead, where all who get frames have depth', async (t) => {
    const client = await ContractClient.join(t, server, { depth: true });
    await client.ask({ type: 'control', action: 'take' });
    await client.ask({ type: 'resize', ...VIEW });
    await client.patch({ camera: POSE, navigation: null });
    await sharp(client);
    /** By how many degrees the frames that come are drawn ahead. */
    const turn = async () => {
      const from = client.frames.length;
      let seen = from;
      for (let step = 0; step < 60; ++step) {
        client.send({ type: 'navigate', rotate: [2, 0] });
        for (; seen < client.frames.length; ++seen) client.send({ type: 'frame' });
        await sleep(16);
      }
      const azimuth = ({ eye: [x, , z] }) => Math.atan2(x, z) * 180 / Math.PI;
      return client.frames.slice(from).map(({ header: { camera, depth } }) =>
        depth?.camera ? (azimuth(depth.camera) - azimuth(camera) + 540) % 360 - 180 : 0);
    };
    // On a busy machine the steps may come so late that the view stands still in between.
    let ahead = [];
    for (let tries = 0; tries < 10 && ahead.every((degrees) => degrees === 0); ++tries) ahead = await turn();
    assert.ok(ahead.some((degrees) => degrees !== 0), `${ahead}`);
    // The camera goes to the left, so that the scene turns to the right.
    assert.ok(ahead.every((degrees) => degrees <= 0 && degrees > -45.1), `${ahead}`);
    const { header } = await sharp(client);
    assert.equal(header.depth.camera, undefined, 'what is at rest is seen from where it is');
    nearCamera(header.camera, client.state.camera);

    const other = await ContractClient.join(t, server, { role: 'view' });
    other.send({ type: 'frame' });
    await other.until('a frame', () => other.frames.length > 0);
    assert.ok((await turn()).every((degrees) => degrees === 0), 'this one would see it sway');
  });

  test('it tells how far away is what is seen', async (t) => {
    const client = await steering(t, server);
    const other = await ContractClient.join(t, server, { role: 'view', depth: true });
    await sharp(other);
    const frame = other.frames.find(({ header }) => header.depth?.bytes > 0);
    const { columns, rows, scale } = frame.header.depth;
    const { far } = blocksOf(frame);
    const distanceAt = ([x, y]) => {
      const block = Math.floor(y / VIEW.height * rows) * columns + Math.floor(x / VIEW.width * columns);
      return 255 / (far[block] * scale);
    };
    // The eye is at z = 8; the door lies at z = 0, and the wall at -1, which is seen through the clear pane, too.
    for (const [place, distance] of [[SEEN.door, 8], [SEEN.pane, 9], [SEEN.wall, 9]]) {
      near(distanceAt(place), distance, 'distance', 0.005);
    }
    assert.equal(distanceAt(SEEN.nothing), Infinity);
    await client.barrier();
  });

  test('wireframes and snapshots have none', async (t) => {
    const client = await steering(t, server);
    const other = await ContractClient.join(t, server, { role: 'control', depth: true });
    const { header } = await other.ask({ type: 'snapshot', width: 200, height: 150, format: 'jpeg' });
    assert.equal(header.depth, undefined);
    await client.patch({ renderer: { wireframe: true } });
    assert.equal((await sharp(other)).header.depth, undefined);
    await client.patch({ renderer: null });
    assert.ok((await sharp(other)).header.depth);
  });
});

describe('a slow client', () => {
  test('never delays another, and gets the newest when it takes again', async (t) => {
    const client = await steering(t, server);
    const slow = await ContractClient.join(t, server, { role: 'view' });
    slow.send({ type: 'frame' });
    slow.socket.pause();
    const start = Date.now();
    for (let i = 0; i < 30; ++i) {
      await client.ask({ type: 'navigate', rotate: [1, 0] });
      slow.send({ type: 'frame' });
      await client.frameOfNow();
    }
    assert.ok(Date.now() - start < 5000, `${Date.now() - start} ms for 30 frames of another`);
    slow.socket.resume();
    await slow.until('the newest state', () => slow.revision === client.revision);
    assert.deepEqual(slow.state, client.state);
    const { header } = await slow.frameOfNow();
    assert.deepEqual(header.camera.eye, client.state.camera.eye);
  });
});

test('the header tells where markers stand in that picture; one that does not show has no place', async (t) => {
  const client = await steering(t, server);
  const now = async () => (await client.frame((header) => header.revision === client.revision && isStill(header))).header;
  assert.equal((await now()).markers, undefined);
  await client.patch({ markers: { Free: { point: [1, 2, 0.1 + 0.2] }, Grip: { node: 4, point: [0.5, 0, 0] }, Snow: { node: 8, point: [0, 0, 0] } } });
  assert.deepEqual((await now()).markers, { Free: [1, 2, 0.1 + 0.2], Grip: [1.5, 0, 0] });
  await client.patch({ nodes: { 3: { matrix: [0, 0, 1, 1, 0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 0, 1] } } });
  near((await now()).markers.Grip, [1, 0, -0.5], 'goes with its node');
  const snapshot = await client.ask({ type: 'snapshot', width: 64, height: 48 });
  near(snapshot.header.markers.Grip, [1, 0, -0.5], 'in a snapshot as well');
  await client.patch({ nodes: { 4: { active: false } } });
  assert.deepEqual(Object.keys((await now()).markers), ['Free']);
  await client.patch({ markers: { Free: null, Other: { point: [1, 2, 3] } }, nodes: null });
  assert.deepEqual(Object.keys((await now()).markers), ['Grip', 'Other']);
  await client.patch({ markers: null });
  assert.equal((await now()).markers, undefined);
});

test('a marker at what was picked goes with its part', async (t) => {
  const client = await steering(t, server);
  const now = async () => (await client.frame((header) => header.revision === client.revision && isStill(header))).header;
  await client.patch({ nodes: { 4: { matrix: [2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 1] } } });
  const { node, point, local } = await client.ask({ type: 'pick', x: 256, y: 150 });
  assert.equal(node, 4);
  near(local, [(point[0] - 1) / 2, point[1] / 2, point[2] / 2], 'in the space of the node, which is twice as large');
  await client.patch({ markers: { Bolt: { node, point: local } } });
  near((await now()).markers.Bolt, point, 'where it was picked');
  const FLAT = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1];
  for (const angle of [0.1, 0.2, 0.3, 0.4]) {
    // By rounding its determinant may be anything near zero.
    await client.patch({ nodes: { 4: { matrix: times(times(turned(angle), FLAT), turned(angle)) } } });
    const picked = await client.ask({ type: 'pick', x: 256, y: 150 });
    assert.deepEqual([picked.node, picked.local], [4, undefined], 'a flattened part has no space of its own');
  }
  await client.patch({ markers: null, nodes: null });
});

/** About y and x. */
function turned(angle) {
  const [c, s] = [Math.cos(angle), Math.sin(angle)];
  return times([c, 0, s, 0, 0, 1, 0, 0, -s, 0, c, 0, 0, 0, 0, 1], [1, 0, 0, 0, 0, c, -s, 0, 0, s, c, 0, 0, 0, 0, 1]);
}

function times(a, b) {
  return a.map((_, i) => [0, 1, 2, 3].reduce((sum, k) => sum + a[i - (i % 4) + k] * b[4 * k + (i % 4)], 0));
}

schemaTest(server);
