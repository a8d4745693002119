// Contract: the messages that scripts use: navigate, fit, pick, snapshot, fly, tree, open, scenes, record.
import assert from 'node:assert/strict';
import { copyFileSync, mkdirSync, readdirSync, readFileSync, rmSync, symlinkSync, writeFileSync } from 'node:fs';
import path from 'node:path';
import { after, describe, test } from 'node:test';
import { setTimeout as sleep } from 'node:timers/promises';
import { ContractClient } from './contract-client.js';
import { add, axes, cross, dot, length, near, nearCamera, pixelAtFocus, product, projected, scale, sub, transformed, turnedAbout, unit } from './numbers.js';
import { schemaTest } from './schema.js';
import { sceneFile, Server, temporaryFolder } from './server.js';
import { pixelsNow, POSE, SEEN, steering, VIEW } from './stage.js';

const ASKEW = { eye: [3, 2, 7], focus: [0.5, 0.25, -0.5], center: [-1, 0.5, 1] };
const MANY = 20000;
const logs = temporaryFolder();
const scenes = temporaryFolder();
for (const name of ['stage.vrut', 'second.vrut', 'broken.vrut']) copyFileSync(sceneFile(name), path.join(scenes, name));
writeFileSync(path.join(scenes, 'many.vrut'), manyNodes());
const server = await Server.start({ options: ['--scenes', scenes, '--record', logs] });
after(() => server.stop());

/** A scene that takes a while to load, and whose tree needs pages. */
function manyNodes() {
  const lines = ['vrut-text 1', 'geometry 1 vertices 3  0 0 0  1 0 0  0 1 0  triangles 1  0 1 2 end', 'node 0 "Many" root end'];
  for (let i = 1; i <= MANY; ++i) {
    const matrix = `1 0 0 ${i % 100}  0 1 0 ${Math.floor(i / 100)}  0 0 1 0  0 0 0 1`;
    lines.push(`node ${i} "Part ${i}" geometry parent 0 geometry 1 matrix ${matrix} end`);
  }
  return lines.join('\n');
}

describe('navigate', () => {
  const orbit = (camera, right, down) => {
    const side = axes(camera).right;
    const both = (point, center) => turnedAbout(turnedAbout(point, center, side, -down), center, [0, 1, 0], -right);
    return { ...camera, eye: both(camera.eye, camera.center), focus: both(camera.focus, camera.center), up: both(camera.up, [0, 0, 0]) };
  };
  const pan = (camera, [right, down]) => {
    const a = axes(camera);
    const height = pixelAtFocus(camera, VIEW) * VIEW.height;
    const shift = add(scale(a.right, -right * height), scale(a.up, down * height));
    return { ...camera, eye: add(camera.eye, shift), focus: add(camera.focus, shift) };
  };
  const zoom = (camera, factor) => ({ ...camera, eye: add(camera.focus, scale(sub(camera.eye, camera.focus), 1 / factor)) });
  const upright = { navigation: { keepUpright: true, rotateSpeed: 10, panSpeed: 10, zoomSpeed: 10 } };
  const pose = ({ eye, focus, up, fov }) => ({ eye, focus, up, fov });

  for (const [what, message, expected] of [
    ['rotate', { rotate: [30, -20] }, (c) => orbit(c, 30, -20)],
    ['rotate by more than a turn', { rotate: [400, 0] }, (c) => orbit(c, 40, 0)],
    ['pan', { pan: [0.25, -0.5] }, (c) => pan(c, [0.25, -0.5])],
    ['zoom', { zoom: 2.5 }, (c) => zoom(c, 2.5)],
    ['zoom out', { zoom: 0.25 }, (c) => zoom(c, 0.25)],
    ['all, in this order', { zoom: 2, pan: [0.5, 0.25], rotate: [20, 10] }, (c) => zoom(pan(orbit(c, 20, 10), [0.5, 0.25]), 2)],
  ]) {
    test(`${what}; the speeds do not apply`, async (t) => {
      const client = await steering(t, server, ASKEW);
      await client.patch(upright);
      const before = client.state.camera;
      const { revision } = await client.ask({ type: 'navigate', ...message });
      assert.equal(revision, client.revision);
      nearCamera(client.state.camera, pose(expected(before)), what);
      await client.patch({ navigation: null });
    });
  }

  test('pan moves the picture in the plane through focus', async (t) => {
    const client = await steering(t, server, ASKEW);
    const { focus } = client.state.camera;
    await client.ask({ type: 'navigate', pan: [0.1, 0.2] });
    near(projected(client.state.camera, VIEW, focus), [230, 210], 'right by 10 %, down by 20 % of 300');
  });
});

describe('fit', () => {
  const FREE = 0.84; // of the view, between the margins
  /** The corners of a square with sides along x and y. */
  const square = ([x, y, z], side) => [[-1, -1], [1, -1], [1, 1], [-1, 1]].map(([i, j]) => [x + (i * side) / 2, y + (j * side) / 2, z]);
  const DOOR = square([1, 0, 0], 1);
  const SHOWN = [...square([0, 0, -1], 4), ...DOOR, ...square([-1, 0, 1], 1), ...square([0, 1.5, 0], 0.5), ...square([0, -1.5, 0], 0.5)];
  /** The points fill the free part of the view, in its middle. */
  const fills = (camera, view, points, { left = 0, right = 0, top = 0, bottom = 0 } = {}) => {
    const whole = points.map((point) => projected(camera, view, point));
    const seen = whole.map(([x, y]) => [x - left, y - top]);
    view = { width: view.width - left - right, height: view.height - top - bottom };
    for (const point of points) assert.ok(dot(sub(point, camera.eye), axes(camera).view) > 0);
    const sides = [view.width, view.height].map((size, i) => {
      const low = Math.min(...seen.map((p) => p[i])) / size - 0.5;
      const high = Math.max(...seen.map((p) => p[i])) / size - 0.5;
      return { most: Math.max(-low, high), skew: low + high };
    });
    const [fuller] = [...sides].sort((a, b) => b.most - a.most);
    near(2 * fuller.most, FREE, 'what is filled');
    near(fuller.skew, 0, 'the middle');
  };

  for (const [width, height] of [[400, 300], [150, 600], [600, 100]]) {
    test(`the whole scene fills what is free of ${width} x ${height}`, async (t) => {
      const client = await steering(t, server, ASKEW);
      await client.ask({ type: 'resize', width, height, pixelRatio: 1 });
      const before = axes(client.state.camera).view;
      await client.ask({ type: 'fit' });
      const { camera } = client.state;
      fills(camera, { width, height }, SHOWN);
      near(axes(camera).view, before, 'direction');
    });
  }

  test('what covers the view is left free', async (t) => {
    const client = await steering(t, server, ASKEW);
    for (const inset of [{ bottom: 120 }, { right: 200, top: 30 }, { left: 50, right: 10, bottom: 60 }]) {
      await client.ask({ type: 'resize', ...VIEW, inset });
      await client.ask({ type: 'fit' });
      fills(client.state.camera, VIEW, SHOWN, inset);
    }
    await client.ask({ type: 'resize', ...VIEW, inset: { left: 200, right: 100 } });
    await client.ask({ type: 'fit' });
    fills(client.state.camera, VIEW, SHOWN);
    assert.equal((await client.frameOfNow()).header.view.inset, undefined);
    await client.ask({ type: 'resize', ...VIEW });
  });

  test('what is hidden does not count', async (t) => {
    const client = await steering(t, server, ASKEW);
    await client.patch({ nodes: { 2: { active: false } } });
    await client.ask({ type: 'fit' });
    fills(client.state.camera, VIEW, SHOWN.slice(4));
    await client.patch({ nodes: null });
  });

  test('"home" is the view with which the scene opens: its camera node\'s', async (t) => {
    const fresh = await Server.start();
    t.after(() => fresh.stop());
    const { views, camera } = (await ContractClient.join(t, fresh)).state;
    assert.ok(camera.node !== undefined);
    for (const member of ['eye', 'focus', 'up', 'center', 'fov']) assert.deepEqual(views.home[member], camera[member], member);
  });

  test('or what fit gives where the scene has none', async (t) => {
    const bare = await Server.start({ scene: sceneFile('second.vrut') });
    t.after(() => bare.stop());
    const client = await ContractClient.join(t, bare);
    const { views, camera } = client.state;
    assert.deepEqual(client.state.cameras, {});
    assert.equal(camera.node, undefined);
    for (const member of ['eye', 'focus', 'center', 'fov']) assert.deepEqual(camera[member], views.home[member], member);
    await client.ask({ type: 'fit' });
    for (const member of ['eye', 'focus', 'fov']) near(client.state.camera[member], views.home[member], member);
  });

  test("a node's subtree, along the same direction", async (t) => {
    const client = await steering(t, server, ASKEW);
    const before = axes(client.state.camera).view;
    for (const node of [4, 3]) {
      await client.ask({ type: 'fit', node });
      fills(client.state.camera, VIEW, DOOR);
      near(client.state.camera.center, [1, 0, 0], 'center');
      near(axes(client.state.camera).view, before, 'direction');
    }
    await client.refused({ type: 'fit', node: 999 }, 'unknown-node', { valid: true });
  });
});

describe('swing', () => {
  /** About (1, 0, 0), by -90 degrees about y: closed times that rotation. */
  const OPEN = [0, 0, -1, 1, 0, 1, 0, 0, 1, 0, 0, 0, 0, 0, 0, 1];
  const matrixIn = (client) => client.state.nodes[3]?.matrix;

  test('opens and closes what has a hinge, or is part of it, for everybody', async (t) => {
    const client = await steering(t, server);
    const watcher = await ContractClient.join(t, server, { role: 'view' });
    await client.ask({ type: 'swing', node: 4, ms: 0 });
    await watcher.until('the door to open', () => matrixIn(watcher));
    near(matrixIn(watcher), OPEN, 'open');
    await client.ask({ type: 'swing', node: 3, open: 0.5, ms: 200 });
    assert.deepEqual(client.state.swings, { 3: { to: 0.5 } });
    await client.until('its end', () => Object.keys(client.state.swings).length === 0);
    near(matrixIn(client).slice(0, 3), [Math.SQRT1_2, 0, -Math.SQRT1_2], 'half open');
    await client.ask({ type: 'swing', node: 3, ms: 0 });
    await watcher.until('the door to close', () => matrixIn(watcher) === undefined);
  });

  test('a patch of the matrix ends it, and what has no hinge is refused', async (t) => {
    const client = await steering(t, server);
    await client.ask({ type: 'swing', node: 3, ms: 60000 });
    await client.patch({ nodes: null });
    assert.deepEqual(client.state.swings, {});
    await client.refused({ type: 'swing', node: 2 }, 'failed', { valid: true });
    await client.refused({ type: 'swing', node: 999 }, 'unknown-node', { valid: true });
    await client.refused({ type: 'swing', node: 3, open: 2 }, 'out-of-range');
  });

  test('a tap does it where that is wanted', async (t) => {
    const client = await steering(t, server);
    await client.patch({ navigation: { tapSwings: true }, selection: { node: 4 } });
    assert.equal(client.state.selection.hinge, 3);
    const [x, y] = SEEN.door;
    for (const type of ['pointerdown', 'pointerup']) {
      client.send({ type, pointerId: 1, pointerType: 'touch', x, y, button: 0, buttons: type === 'pointerdown' ? 1 : 0 });
    }
    await client.until('the door to open', () => matrixIn(client) && Object.keys(client.state.swings).length === 0);
    near(matrixIn(client), OPEN, 'open');
    await client.patch({ navigation: null, nodes: null });
  });
});

describe('pick', () => {
  const pick = (client, [x, y], more = {}) => client.ask({ type: 'pick', x, y, ...more });
  /** The point of the plane z that is seen at CSS pixels from POSE. */
  const onPlane = ([x, y], z) => {
    const pixel = (2 * (8 - z) * Math.tan(Math.PI / 9)) / VIEW.height;
    return [(x - 200) * pixel, (150 - y) * pixel, z];
  };

  test('tells node, name, path, point, normal and distance', async (t) => {
    const client = await steering(t, server);
    const picked = await pick(client, SEEN.door);
    assert.deepEqual([picked.node, picked.name], [4, 'Door']);
    assert.deepEqual(picked.path, ['Stage', 'House', 'Hinge', 'Door']);
    near(picked.point, onPlane(SEEN.door, 0), 'point');
    near(picked.normal, [0, 0, 1], 'normal');
    near(picked.distance, length(sub(picked.point, POSE.eye)), 'distance');
  });

  test('nothing hit: no such members', async (t) => {
    const client = await steering(t, server);
    for (const at of [SEEN.nothing, [-100, 150], [5000, 5000]]) {
      const { type, id, ...rest } = await pick(client, at);
      assert.deepEqual([type, typeof id, rest], ['picked', 'number', {}]);
    }
  });

  test('through passes transparent parts', async (t) => {
    const client = await steering(t, server);
    assert.equal((await pick(client, SEEN.pane)).node, 5);
    assert.equal((await pick(client, SEEN.pane, { through: false })).node, 5);
    const wall = await pick(client, SEEN.pane, { through: true });
    assert.equal(wall.node, 2);
    near(wall.point, onPlane(SEEN.pane, -1), 'point');
    assert.equal((await pick(client, SEEN.door, { through: true })).node, 4);
  });

  test('a switch shows its active child, an LOD its nearest', async (t) => {
    const client = await steering(t, server);
    assert.equal((await pick(client, projected(POSE, VIEW, [0, 1.5, 0]))).node, 7);
    assert.equal((await pick(client, projected(POSE, VIEW, [0, -1.5, 0]))).node, 15);
    await client.patch({ camera: { eye: [0, 0, 30] } });
    await client.frameOfNow();
    assert.equal((await pick(client, projected({ ...POSE, eye: [0, 0, 30] }, VIEW, [0, -1.5, 0]))).node, 16);
  });

  test('snap finds corners and edges near by, and what kinds are asked for', async (t) => {
    const client = await steering(t, server);
    const at = (point) => projected(POSE, VIEW, point);
    const snapped = async (point, snap) => (await pick(client, at(point), { snap })).snapped;
    const corner = await snapped([1.45, 0.47, 0], { within: 16 });
    assert.deepEqual(corner.feature, { node: 4, snap: 'vertex', points: [[0.5, 0.5, 0]] });
    near(corner.point, [1.5, 0.5, 0], 'in the world');
    const beside = await snapped([1.55, 0.2, 0], { within: 16, to: ['edge'] });
    assert.deepEqual([beside.feature.node, beside.feature.snap, beside.feature.points.length], [4, 'edge', 3], 'beside the door');
    near(beside.line.flat(), [1.5, -0.5, 0, 1.5, 0.5, 0], 'the whole edge');
    assert.equal((await snapped([1, 0, 0], { within: 0 })).feature.snap, 'plane');
    assert.equal((await snapped([1, 0, 0], { within: 4, to: ['vertex'] })), undefined);
    assert.equal((await snapped([1.49, 0.1, 0], { within: 8, to: ['loop'] })).feature.snap, 'loop');
    await client.refused({ type: 'pick', x: 1, y: 1, snap: { within: 101 } }, 'out-of-range');
  });

  test('uses the camera of the frame, the present one if left out', async (t) => {
    const client = await steering(t, server);
    const { frame } = (await client.frameOfNow()).header;
    await client.ask({ type: 'navigate', pan: [2, 0] });
    assert.equal((await pick(client, SEEN.door)).node, undefined, 'though no frame shows that');
    const now = (await client.frameOfNow()).header.frame;
    assert.equal((await pick(client, SEEN.door, { frame })).node, 4);
    assert.equal((await pick(client, SEEN.door, { frame: now })).node, undefined);
    await client.refused({ type: 'pick', x: 1, y: 1, frame: now + 1000 }, 'unknown-frame', { valid: true });
  });

  test('the last 64 frames are remembered, older ones are not', async (t) => {
    const client = await steering(t, server);
    await client.ask({ type: 'resize', width: 16, height: 16, pixelRatio: 1 });
    const numbers = [];
    for (let i = 0; i < 67; ++i) {
      await client.patch({ camera: { fov: 40 + i / 10 } });
      numbers.push((await client.frameOfNow()).header.frame);
    }
    await pick(client, [8, 8], { frame: numbers.at(-60) });
    await client.refused({ type: 'pick', x: 8, y: 8, frame: numbers[0] }, 'unknown-frame', { valid: true });
  });

  test('then: select, center, lookAt', async (t) => {
    const client = await steering(t, server);
    const { point } = await pick(client, SEEN.door, { then: 'select' });
    assert.equal(client.state.selection.node, 4);
    nearCamera(client.state.camera, POSE, 'select');
    await pick(client, SEEN.door, { then: 'center' });
    nearCamera(client.state.camera, { ...POSE, center: point }, 'center');
    await pick(client, SEEN.door, { then: 'lookAt' });
    nearCamera(client.state.camera, { ...POSE, center: point, focus: point, eye: add(POSE.eye, point) }, 'lookAt');
  });

  test('then on nothing: select clears, the others do nothing', async (t) => {
    const client = await steering(t, server);
    await client.patch({ selection: { node: 4 } });
    await pick(client, SEEN.nothing, { then: 'center' });
    await pick(client, SEEN.nothing, { then: 'lookAt' });
    nearCamera(client.state.camera, POSE, 'unmoved');
    assert.equal(client.state.selection.node, 4);
    await pick(client, SEEN.nothing, { then: 'select' });
    assert.equal(client.state.selection.node, undefined);
  });
});

describe('snapshot', () => {
  const SHOT = { type: 'snapshot', width: 123, height: 77 };

  for (const format of [undefined, 'jpeg', 'png']) {
    test(`${format ?? 'by default jpeg'}: one frame at full accuracy, of that size`, async (t) => {
      const client = await steering(t, server);
      const { revision } = client;
      const count = client.frames.length;
      const shot = await client.ask(format ? { ...SHOT, format } : SHOT);
      assert.equal(shot.format, format ?? 'jpeg');
      assert.deepEqual([shot.width, shot.height, shot.header.width, shot.header.height], [123, 77, 123, 77]);
      const { quality } = shot.header;
      assert.deepEqual([quality.level, quality.scale, quality.subsampling, quality.detail], ['still', 1, '4:4:4', 0]);
      if (shot.format === 'jpeg') assert.deepEqual([shot.subsampling, quality.jpegQuality], ['4:4:4', 90]);
      nearCamera(shot.header.camera, POSE, 'the shared camera');
      await client.barrier();
      assert.equal(client.frames.length, count + 1, 'it needs no grant and brings no other frame');
      assert.equal(client.revision, revision, 'shared state does not change');
    });
  }

  test('camera and renderer are laid over the shared ones', async (t) => {
    const client = await steering(t, server);
    const count = client.texts.length;
    const shot = await client.ask({ ...SHOT, camera: { eye: [2, 1, 6], fov: 30 }, renderer: { mode: 'stylized', wireframe: true } });
    nearCamera(shot.header.camera, { eye: [2, 1, 6], focus: POSE.focus, center: POSE.center, fov: 30 }, 'camera');
    assert.equal(shot.header.renderer.mode, 'stylized');
    assert.equal(shot.header.renderer.wireframe, true);
    await client.barrier();
    assert.equal(client.texts.slice(count).some((text) => text.type === 'patch'), false);
    nearCamera(client.state.camera, POSE, 'the shared camera');
  });

  test('each of them changes the picture', async (t) => {
    const client = await steering(t, server);
    const plain = await pixelsNow(client);
    assert.equal(await pixelsNow(client), plain, 'the same again');
    for (const more of [{ camera: { fov: 30 } }, { camera: { eye: [1, 0, 8] } }, { camera: { node: 12 } }, { renderer: { mode: 'stylized' } }, { renderer: { wireframe: true } }]) {
      assert.notEqual(await pixelsNow(client, more), plain, JSON.stringify(more));
    }
  });

  test("a frame header's own camera will do", async (t) => {
    const client = await steering(t, server);
    const { camera } = (await client.frameOfNow()).header;
    await client.ask({ type: 'navigate', rotate: [40, 10], zoom: 2 });
    const shot = await client.ask({ ...SHOT, width: 400, height: 300, camera });
    for (const member of ['eye', 'focus', 'up', 'center', 'fov', 'viewMatrix', 'projectionMatrix']) assert.deepEqual(shot.header.camera[member], camera[member], member);
  });

  test('jpegQuality makes files smaller, and is told', async (t) => {
    const client = await steering(t, server);
    const big = await client.ask({ ...SHOT, jpegQuality: 100 });
    const small = await client.ask({ ...SHOT, jpegQuality: 5 });
    assert.ok(small.bytes.length < big.bytes.length);
    assert.deepEqual([big.header.quality.jpegQuality, small.header.quality.jpegQuality], [100, 5]);
  });

  test('more than 2 waiting: busy; each is answered once, none replaced', async (t) => {
    const client = await steering(t, server);
    const ids = Array.from({ length: 12 }, () => client.send({ type: 'snapshot', width: 1600, height: 1200 }));
    const ends = await Promise.all(ids.map((id) => client.answer(id).then(() => 'frame', (error) => error.code)));
    assert.deepEqual([...new Set(ends)].sort(), ['busy', 'frame']);
    assert.ok(ends.filter((end) => end === 'frame').length >= 2, `${ends}`);
    assert.equal((await client.ask(SHOT)).width, 123, 'and afterwards there is room again');
  });

  test('refused: what the camera or the renderer would refuse, and sizes that are none', async (t) => {
    const client = await steering(t, server);
    await client.refused({ ...SHOT, camera: { fov: 171 } }, 'out-of-range');
    await client.refused({ ...SHOT, camera: { eye: POSE.focus } }, 'out-of-range');
    await client.refused({ ...SHOT, renderer: { mode: 'sketch' } }, 'out-of-range');
    await client.refused({ ...SHOT, width: 1000000, height: 1000000 }, 'out-of-range');
  });
});

describe('fly', () => {
  const LAST = { eye: [3, 1, 0.1 + 0.2], focus: [3, 0, -7], up: [0, 1, 0], center: [1 / 3, 0, 0], fov: 51.3 };
  const fly = async (client, ...keyframes) => {
    const id = client.send({ type: 'fly', keyframes });
    await client.answer(id);
    return id;
  };

  /** Takes every frame of the flight. */
  function watched(client) {
    let seen = client.frames.length;
    client.send({ type: 'frame' });
    return client.until('flown', () => {
      for (; seen < client.frames.length; ++seen) client.send({ type: 'frame' });
      return client.texts.find((text) => text.type === 'flown');
    });
  }

  for (const easing of ['smooth', 'linear', undefined]) {
    test(`${easing ?? 'by default'}: ends at exactly the last keyframe, after its time`, async (t) => {
      const client = await steering(t, server);
      const start = Date.now();
      const id = client.send({ type: 'fly', keyframes: [{ at: 100, camera: { ...POSE, eye: [0, 0, 4] } }, { at: 300, camera: LAST }], ...(easing && { easing }) });
      await client.answer(id);
      assert.ok(Date.now() - start < 250, 'ok comes at the start');
      const flown = await client.texted('flown');
      assert.ok(Date.now() - start >= 290, `${Date.now() - start} ms`);
      assert.deepEqual([flown.id, flown.completed], [id, true]);
      for (const member of ['eye', 'focus', 'center', 'fov']) assert.deepEqual(client.state.camera[member], LAST[member], member);
      await client.barrier();
      assert.equal(client.texts.filter((text) => text.type === 'flown').length, 1);
    });
  }

  test('begins where the camera is, and passes along the way', async (t) => {
    const client = await steering(t, server);
    const count = client.texts.length;
    await fly(client, { at: 400, camera: { ...POSE, eye: [4, 0, 8], focus: [4, 0, 0] } });
    await watched(client);
    const way = client.texts.slice(count).filter((text) => text.patch?.camera?.eye).map((text) => text.patch.camera.eye);
    assert.ok(way.length >= 3, `${way.length} steps`);
    for (const [i, [x, y, z]] of way.entries()) {
      near([y, z], [0, 8], 'on the line');
      assert.ok(x >= (i ? way[i - 1][0] : 0) && x <= 4, 'ever on');
    }
    assert.ok(way[0][0] < 3, `begins where the camera is: ${way[0]}`);
  });

  test('goes through every keyframe', async (t) => {
    const client = await steering(t, server);
    await fly(client, { at: 250, camera: { ...POSE, eye: [0, 0, 20] } }, { at: 500, camera: POSE });
    await watched(client);
    const farthest = Math.max(...client.texts.filter((text) => text.patch?.camera?.eye).map((text) => text.patch.camera.eye[2]));
    assert.ok(farthest > 14 && farthest < 26, `${farthest}`);
    assert.deepEqual(client.state.camera.eye, POSE.eye);
  });

  test('a touch of its own client stops it where it is', async (t) => {
    const client = await steering(t, server);
    const id = await fly(client, { at: 20000, camera: LAST });
    client.input.down([200, 150], 0, { pointerType: 'touch' });
    const flown = await client.texted('flown');
    assert.deepEqual([flown.id, flown.completed], [id, false]);
    client.input.up([200, 150], 0, { pointerType: 'touch' });
    await client.barrier();
    const { eye } = client.state.camera;
    await client.barrier();
    assert.deepEqual(client.state.camera.eye, eye);
    assert.ok(eye[2] > 7, 'far from the end');
  });

  test('refused keyframes start nothing', async (t) => {
    const client = await steering(t, server);
    const refused = (keyframes, code) => client.refused({ type: 'fly', keyframes }, code);
    await refused([{ at: 100, camera: { ...LAST, fov: 171 } }], 'out-of-range');
    await refused([{ at: 100, camera: { ...LAST, eye: LAST.focus } }], 'out-of-range');
    await refused([{ at: 100, camera: LAST }, { at: 100, camera: POSE }], 'out-of-range');
    await refused([], 'out-of-range');
    await client.barrier();
    assert.equal(client.texts.some((text) => text.type === 'flown'), false);
  });
});

describe('tree', () => {
  const ids = (tree) => tree.nodes.map((node) => node.id);

  test('the root and its children, if nothing is said', async (t) => {
    const client = await ContractClient.join(t, server, { role: 'view' });
    const tree = await client.ask({ type: 'tree' });
    assert.equal(tree.nodes[0].id, 0);
    assert.deepEqual(ids(tree).sort((a, b) => a - b), [0, 1, 5, 6, 9, 10, 11, 13, 14, 17]);
    assert.equal(tree.next, undefined);
    const [root, house] = tree.nodes;
    assert.deepEqual([root.name, root.type, root.active, root.children], ['Stage', 'root', true, 9]);
    assert.deepEqual([house.id, house.name, house.type, house.parent, house.children], [1, 'House', 'assembly', 0, 2]);
    const pane = tree.nodes.find((node) => node.id === 5);
    assert.deepEqual([pane.type, pane.parent, pane.children, pane.triangles, pane.material], ['geometry', 0, 0, 2, 3]);
    const types = Object.fromEntries(tree.nodes.map((node) => [node.id, node.type]));
    assert.deepEqual([6, 9, 10, 11, 13, 14].map((id) => types[id]), ['switch', 'light', 'light', 'camera', 'background', 'lod']);
    assert.equal(house.material, undefined);
  });

  test('node and depth', async (t) => {
    const client = await ContractClient.join(t, server, { role: 'view' });
    assert.deepEqual(ids(await client.ask({ type: 'tree', node: 1 })), [1, 2, 3]);
    assert.deepEqual(ids(await client.ask({ type: 'tree', node: 1, depth: 0 })), [1]);
    const deep = await client.ask({ type: 'tree', node: 1, depth: 2 });
    assert.equal(deep.nodes[0].id, 1);
    assert.deepEqual(ids(deep).sort((a, b) => a - b), [1, 2, 3, 4, 12]);
    assert.equal((await client.ask({ type: 'tree', depth: 32 })).nodes.length, 18);
    await client.refused({ type: 'tree', node: 999 }, 'unknown-node', { valid: true });
  });

  test('search finds names', async (t) => {
    const client = await ContractClient.join(t, server, { role: 'view' });
    const switches = await client.ask({ type: 'tree', only: 'switches' });
    assert.deepEqual(switches.nodes.map(({ id, activeChild, choices }) => [id, activeChild, choices]), [[6, 0, ['Summer', 'Winter']]]);
    assert.deepEqual(ids(await client.ask({ type: 'tree', only: 'hinges' })), [3]);
    await client.refused({ type: 'tree', only: 'doors' }, 'out-of-range');
    const found = await client.ask({ type: 'tree', search: 'Door', depth: 32 });
    assert.ok(ids(found).includes(4));
    assert.ok(!ids(found).includes(2));
    const none = await client.ask({ type: 'tree', search: 'Zebra', depth: 32 });
    assert.ok(!none.nodes.some((node) => node.name.includes('Zebra')));
  });

  test('tells what is active now, and what was painted', async (t) => {
    const client = await steering(t, server);
    await client.patch({ nodes: { 4: { active: false, material: 1 } } });
    const [door] = (await client.ask({ type: 'tree', node: 4 })).nodes;
    assert.deepEqual([door.active, door.material], [false, 1]);
    await client.patch({ nodes: null });
  });
});

test('a hinge is told, by which a part is opened and closed again', async (t) => {
  const client = await steering(t, server);
  const told = async () => (await client.ask({ type: 'tree', node: 3, depth: 0 })).nodes[0];
  const { matrix: file, hinge } = await told();
  assert.deepEqual(hinge, { axis: [0, 1, 0], degrees: -90, closed: [1, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1] });
  assert.deepEqual(file, hinge.closed);
  assert.equal((await client.ask({ type: 'tree', node: 4 })).nodes[0].hinge, undefined);

  const [x, y, z] = [[1, 0, 0], [0, 1, 0], [0, 0, 1]].map((axis) => turnedAbout(axis, [0, 0, 0], hinge.axis, 0.5 * hinge.degrees));
  const half = [x[0], y[0], z[0], 0, x[1], y[1], z[1], 0, x[2], y[2], z[2], 0, 0, 0, 0, 1];
  await client.patch({ nodes: { 3: { matrix: product(hinge.closed, half) } } });
  const open = await told();
  assert.deepEqual(open.hinge, hinge, 'closed stays what the file has');
  near(open.matrix, product(hinge.closed, half));
  await client.patch({ nodes: { 3: { matrix: null } } });
  assert.deepEqual((await told()).matrix, file);
});

describe('open', () => {
  const names = () => readdirSync(scenes).sort();

  test('another scene, in pages; the old one is served until then; and back', async (t) => {
    assert.ok(names().includes('many.vrut'));
    const client = await steering(t, server);
    const watcher = await ContractClient.join(t, server, { role: 'view' });
    try {
      await opened(client, watcher);
      await everyPage(client);
    } finally {
      await back(client);
    }
    assert.equal(client.state.scene.nodes, 18);
    assert.deepEqual(Object.keys(client.state.cameras), ['11', '12']);
  });

  async function opened(client, watcher) {
    const count = client.texts.length;
    const start = Date.now();
    await client.ask({ type: 'open', scene: 'many.vrut' });
    await client.ask({ type: 'pick', x: 1, y: 1 });
    for (const one of [client, watcher]) await one.until('the new state', () => one.state.scene.name === 'many', 30000);
    assert.equal(client.state.scene.nodes, MANY + 1);
    assert.deepEqual(client.state.cameras, {});
    assert.ok(client.texts.slice(count).some((text) => text.type === 'state'), '`state` comes anew');
    const told = () => client.texts.slice(count).filter((text) => text.type === 'loading');
    await client.until('done', () => told().some((text) => text.done));
    const fractions = told().map((text) => text.fraction);
    assert.ok(fractions.every((f, i) => f >= (fractions[i - 1] ?? 0) && f <= 1), `${fractions}`);
    assert.ok(told().every((text) => /many/.test(text.scene) && text.refused === undefined));
    if (Date.now() - start > 1000) assert.ok(fractions.some((f) => f > 0 && f < 1), `progress is told: ${fractions}`);
  }

  async function back(client) {
    await client.ask({ type: 'open', scene: 'stage.vrut' });
    await client.until('the first scene', () => client.state.scene.name === 'stage', 30000);
  }

  async function everyPage(client) {
    const seen = [];
    let after;
    let pages = 0;
    do {
      const tree = await client.ask({ type: 'tree', ...(after !== undefined && { after }) });
      seen.push(...tree.nodes.map((node) => node.id));
      after = tree.next;
      ++pages;
    } while (after !== undefined && pages < MANY);
    assert.ok(pages > 1, 'in pages');
    assert.equal(seen[0], 0);
    assert.equal(seen.length, MANY + 1);
    assert.equal(new Set(seen).size, MANY + 1);
  }

  test('a broken one is told by loading, and the old one kept', async (t) => {
    const client = await steering(t, server);
    const { scene } = client.state;
    await client.ask({ type: 'open', scene: 'broken.vrut' });
    const loading = await client.texted('loading', (text) => text.refused);
    assert.match(loading.scene, /broken/);
    assert.ok(loading.refused.length > 10);
    await client.barrier();
    assert.deepEqual(client.state.scene, scene);
    assert.equal((await client.ask({ type: 'pick', x: SEEN.door[0], y: SEEN.door[1] })).node, 4);
  });

  test('names that are not there: refused-scene', async (t) => {
    const client = await steering(t, server);
    for (const scene of ['nowhere.vrut', '', '.', '..', '../stage.vrut', path.join(scenes, 'stage.vrut'), '/etc/passwd', 'stage.vrut/', 'stage.vrut\0', './../' + path.basename(scenes) + '/stage.vrut']) {
      await client.refused({ type: 'open', scene }, 'refused-scene', { valid: true });
    }
  });

  test('without a scenes folder: refused-scene, or not-allowed', async (t) => {
    const bare = await Server.start();
    t.after(() => bare.stop());
    const client = await ContractClient.join(t, bare);
    await client.refused({ type: 'open', scene: 'nowhere.vrut' }, ['refused-scene', 'not-allowed'], { valid: true });
  });
});

describe('scenes', () => {
  test('every role hears what open would take, sorted, and what is added later', async (t) => {
    const clients = [];
    for (const role of ['control', 'view', 'host']) clients.push(await ContractClient.join(t, server, { role }));
    const listed = async (client) => (await client.ask({ type: 'scenes' })).scenes;
    const before = await listed(clients[0]);
    for (const name of ['stage.vrut', 'many.vrut', 'broken.vrut']) assert.ok(before.includes(name), `${before}`);
    for (const client of clients) assert.deepEqual(await listed(client), before);

    const folder = path.join(scenes, 'more');
    mkdirSync(folder);
    t.after(() => rmSync(folder, { recursive: true }));
    copyFileSync(sceneFile('second.vrut'), path.join(folder, 'second.vrut'));
    copyFileSync(sceneFile('second.vrut'), path.join(folder, 'second.txt'));
    symlinkSync('/etc', path.join(folder, 'etc'));
    symlinkSync(sceneFile('second.vrut'), path.join(folder, 'outside.vrut'));
    await sleep(1100); // it is looked up once a second at most
    const after = await listed(clients[1]);
    assert.deepEqual(after, [...before, 'more/second.vrut'].sort());

    await clients[0].ask({ type: 'open', scene: 'more/second.vrut' });
    await clients[0].until('the second scene', () => clients[0].state.scene.name === 'second', 30000);
    await clients[0].ask({ type: 'open', scene: 'stage.vrut' });
    await clients[0].until('the first scene', () => clients[0].state.scene.name === 'stage', 30000);
  });

  test('without a folder the scene of the start, which can be opened again', async (t) => {
    const bare = await Server.start();
    t.after(() => bare.stop());
    const client = await ContractClient.join(t, bare);
    assert.deepEqual((await client.ask({ type: 'scenes' })).scenes, ['stage.vrut']);
    assert.equal(client.state.scene.file, 'stage.vrut');
    await client.ask({ type: 'open', scene: 'stage.vrut' });
    await client.until('the loading to end', () => client.texts.some(({ type, done }) => type === 'loading' && done), 30000);
  });
});

describe('record', () => {
  test('start and stop write a log of that name; the state tells', async (t) => {
    const client = await steering(t, server);
    const started = await client.ask({ type: 'record', action: 'start', name: 'My_log-1' });
    assert.match(started.name, /^My_log-1/);
    assert.ok(client.state.recording !== undefined && client.state.recording !== false);
    await client.ask({ type: 'navigate', zoom: 2 });
    const stopped = await client.ask({ type: 'record', action: 'stop' });
    assert.equal(stopped.name, started.name);
    assert.ok(!client.state.recording);
    const file = readdirSync(logs).find((name) => name.startsWith('My_log-1'));
    const lines = readFileSync(path.join(logs, file), 'utf8').trim().split('\n').map((line) => JSON.parse(line));
    assert.deepEqual([lines[0].log, lines[0].version], ['vrut-preview', 1]);
    assert.ok(lines.some((line) => line.message?.type === 'navigate' && line.message.zoom === 2));
  });

  test('names are [A-Za-z0-9_-], up to 64', async (t) => {
    const client = await steering(t, server);
    for (const name of ['a b', '../a', 'a.b', 'ä', 'x'.repeat(65)]) await client.refused({ type: 'record', action: 'start', name }, 'out-of-range');
    await client.ask({ type: 'record', action: 'start', name: 'x'.repeat(64) });
    await client.ask({ type: 'record', action: 'stop' });
    const { name } = await client.ask({ type: 'record', action: 'start' });
    assert.ok(name.length > 0, 'without a name one is found');
    await client.ask({ type: 'record', action: 'stop' });
  });

  test('without a record folder: not-allowed', async (t) => {
    const bare = await Server.start();
    t.after(() => bare.stop());
    const client = await ContractClient.join(t, bare);
    await client.refused({ type: 'record', action: 'start', name: 'x' }, 'not-allowed', { valid: true });
  });
});

test('the matrices of a frame are those of its camera: clip = projection · view · world', async (t) => {
  const client = await steering(t, server, ASKEW);
  const { camera, view } = (await client.frameOfNow()).header;
  const { near: n, far: f } = camera;
  const clip = product(camera.projectionMatrix, camera.viewMatrix);
  for (const point of [[0, 0, 0], [1, 2, -1], ASKEW.focus]) {
    const [x, y, , w] = transformed(clip, [...point, 1]);
    near([((x / w + 1) / 2) * view.width, ((1 - y / w) / 2) * view.height], projected(camera, view, point), 'in the view');
  }
  const a = axes(camera);
  near(cross(a.right, a.up), scale(a.view, -1), 'right-handed, along -z');
  near(transformed(camera.viewMatrix, [...add(camera.eye, a.view), 1]), [0, 0, -1, 1], 'the view looks along -z');
  for (const [depth, expected] of [[n, -1], [f, 1]]) {
    const [, , z, w] = transformed(clip, [...add(camera.eye, scale(unit(a.view), depth)), 1]);
    near(z / w, expected, 'clip z from -w to w', 1e-7);
  }
});

schemaTest(server);
