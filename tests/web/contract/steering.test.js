// Contract: "Rules": who steers, tokens; and `control`, `resize` and `hello` of the message table.
import assert from 'node:assert/strict';
import { after, describe, test } from 'node:test';
import { setTimeout as sleep } from 'node:timers/promises';
import { ContractClient } from './contract-client.js';
import { schemaTest } from './schema.js';
import { sceneFile, SCENES, Server, temporaryFolder } from './server.js';
import { holder, Input, POSE, SEEN, steering, VIEW } from './stage.js';

const server = await Server.start({ options: ['--scenes', SCENES, '--record', temporaryFolder()] });
after(() => server.stop());

const env = { VRUT_PREVIEW_CONTROL_TOKEN: 'steer-0123456789abcdef', VRUT_PREVIEW_VIEW_TOKEN: 'watch-0123456789abcdef' };
const guarded = await Server.start({ scene: sceneFile('second.vrut'), env, bearer: env.VRUT_PREVIEW_CONTROL_TOKEN });
after(() => guarded.stop());

const QUIET_MS = 1000;
const POINTER = { pointerId: 1, pointerType: 'mouse', button: 0, buttons: 1 };
const PATCH = { type: 'patch', patch: {} };

async function join(t, hello) {
  const client = await ContractClient.join(t, server, hello);
  client.input = new Input(client);
  return client;
}

/** Every message that steers; `patch` is the one most used above. */
const STEERING = [
  { type: 'navigate', rotate: [1, 0] },
  { type: 'fit' },
  { type: 'fly', keyframes: [{ at: 10, camera: { fov: 41 } }] },
  PATCH,
  { type: 'open', scene: 'stage.vrut' },
  { type: 'record', action: 'start', name: 'steering' },
  { type: 'pick', x: 5, y: 5, then: 'select' },
];
const INPUT = [
  { type: 'pointerdown', ...POINTER, x: 5, y: 5 },
  { type: 'wheel', x: 5, y: 5, deltaX: 0, deltaY: 1, deltaMode: 0 },
  { type: 'keydown', key: 'ArrowLeft', code: 'ArrowLeft' },
];
const FREE = [
  { type: 'pick', x: 5, y: 5 },
  { type: 'snapshot', width: 8, height: 8 },
  { type: 'tree' },
  { type: 'scenes' },
  { type: 'resize', ...VIEW },
];

test('the state tells how the holder calls itself, to everybody', async (t) => {
  const [watcher, first, second] = [await join(t, { role: 'view' }), await join(t, { name: 'Eva’s tablet' }), await join(t)];
  await first.ask({ type: 'control', action: 'take' });
  await watcher.until('the name', () => watcher.state.control.name === 'Eva’s tablet');
  assert.equal(watcher.state.control.holder, first.id);
  await second.ask({ type: 'control', action: 'take' });
  assert.deepEqual(second.state.control, { holder: second.id, kept: true });
  await first.ask({ type: 'control', action: 'take' });
  await first.ask({ type: 'control', action: 'release' });
  assert.deepEqual(first.state.control, { kept: false });
  await first.refused({ type: 'patch', patch: { control: { name: 'Mine' } } }, 'read-only');
});

describe('becoming the holder', () => {
  for (const message of [...STEERING.filter((m) => !['open', 'record'].includes(m.type)), { type: 'record', action: 'stop' }, ...INPUT]) {
    test(`by ${message.type}, while there is none`, async (t) => {
      const client = await join(t);
      assert.equal(client.state.control.holder, undefined);
      const isInput = INPUT.includes(message);
      const id = client.send(message);
      if (isInput) await client.until('control', () => client.isHolder);
      else if (message.type === 'record') await client.answer(id).catch(() => {}); // nothing is being recorded
      else await client.answer(id);
      if (message.type !== 'record') assert.equal(client.isHolder, true);
      assert.equal(client.state.control.kept, false);
    });
  }

  test('not by looking', async (t) => {
    const client = await join(t);
    for (const message of FREE.filter((m) => m.type !== 'snapshot' && m.type !== 'tree')) await client.ask(message);
    await client.frame();
    client.send({ type: 'pointermove', ...POINTER, buttons: 0, button: -1, x: 5, y: 5 });
    client.send({ type: 'keyup', key: 'x', code: 'KeyX' });
    await client.barrier();
    assert.equal(client.state.control.holder, undefined);
  });

  test('not by a message that is refused', async (t) => {
    const client = await join(t);
    await client.refused({ type: 'patch', patch: { camera: { fov: 1000 } } }, 'out-of-range');
    await client.refused({ type: 'navigate', zoom: 0 }, 'out-of-range');
    assert.equal(client.state.control.holder, undefined);
  });
});

describe('only the holder steers', () => {
  for (const message of STEERING) {
    test(`${message.type} of another: not-in-control`, async (t) => {
      await holder(t, server);
      const other = await join(t);
      await other.refused(message, 'not-in-control', { valid: true });
    });
  }

  test('input events of another: not-in-control with an id, silence without', async (t) => {
    await holder(t, server);
    const other = await join(t);
    for (const message of INPUT) await other.refused(message, 'not-in-control', { valid: true });
    const count = other.texts.length;
    for (const message of INPUT) other.send(message, { id: null });
    await other.barrier();
    assert.deepEqual(other.texts.slice(count).map((text) => text.type), ['picked']);
  });

  test('what does not steer is free to all', async (t) => {
    await holder(t, server);
    for (const role of ['control', 'view', 'host']) {
      const other = await join(t, { role });
      for (const message of FREE) await other.ask(message);
      await other.frame();
    }
  });

  test('a view may never steer, nor take control: not-allowed', async (t) => {
    const viewer = await join(t, { role: 'view' });
    for (const message of [...STEERING, ...INPUT]) await viewer.refused(message, 'not-allowed', { valid: true });
    for (const action of ['take', 'release']) await viewer.refused({ type: 'control', action }, 'not-allowed', { valid: true });
  });
});

describe('a quiet holder', () => {
  test('loses control to who steers after 1 s, not before', async (t) => {
    const first = await join(t);
    const second = await join(t);
    await first.ask(PATCH);
    const start = Date.now();
    await second.refused(PATCH, 'not-in-control', { valid: true });
    await sleep(QUIET_MS - 300 - (Date.now() - start));
    await second.refused(PATCH, 'not-in-control', { valid: true });
    await sleep(500);
    await second.ask(PATCH);
    assert.ok(second.isHolder);
    await first.refused(PATCH, 'not-in-control', { valid: true });
  });

  test('is not quiet while a pointer is down', async (t) => {
    const first = await join(t);
    const second = await join(t);
    await first.ask({ type: 'resize', ...VIEW });
    first.input.down([200, 150]);
    await first.until('control', () => first.isHolder);
    await sleep(QUIET_MS + 300);
    await second.refused(PATCH, 'not-in-control', { valid: true });
    first.input.up([200, 150]);
    await first.barrier();
    await second.refused(PATCH, 'not-in-control', { valid: true });
    await sleep(QUIET_MS + 200);
    await second.ask(PATCH);
  });

  test('is quiet though its flight goes on', async (t) => {
    const first = await join(t);
    const second = await join(t);
    const flight = first.send({ type: 'fly', keyframes: [{ at: 20000, camera: { eye: [3, 0, 8] } }] });
    await first.answer(flight);
    await sleep(QUIET_MS + 200);
    await second.ask(PATCH);
    assert.ok(second.isHolder);
    assert.equal((await first.texted('flown')).completed, false);
  });

  test('keeps control once taken to keep', async (t) => {
    const first = await holder(t, server);
    assert.equal(first.state.control.kept, true);
    const second = await join(t);
    await sleep(QUIET_MS + 200);
    await second.refused(PATCH, 'not-in-control', { valid: true });
  });
});

describe('control', () => {
  test('take always succeeds, also from who keeps it, or has a pointer down', async (t) => {
    const first = await steering(t, server);
    first.input.down([200, 150]);
    await first.barrier();
    const second = await holder(t, server);
    assert.deepEqual(second.state.control, { holder: second.id, kept: true });
    await first.refused(PATCH, 'not-in-control', { valid: true });
    const before = structuredClone(second.state.camera);
    first.input.move([300, 150]);
    await first.barrier();
    assert.deepEqual(first.state.camera, before, 'a drag ends with control');
  });

  test('release leaves it free: nobody inherits, the next who steers has it', async (t) => {
    const first = await holder(t, server);
    const second = await join(t);
    await first.ask({ type: 'control', action: 'release' });
    assert.equal(first.state.control.holder, undefined);
    assert.equal(first.state.control.kept, false);
    await second.ask(PATCH);
    assert.deepEqual(second.state.control, { holder: second.id, kept: false });
  });

  test('release lifts the pointers', async (t) => {
    const client = await steering(t, server);
    client.input.down([100, 150]);
    client.input.move([130, 150]);
    await client.ask({ type: 'control', action: 'release' });
    const { camera } = client.state;
    client.input.move([200, 150]);
    await client.barrier();
    assert.deepEqual(client.state.camera, camera);
    assert.equal(client.state.control.holder, undefined, 'a move without a press does not steer');
  });

  test('a lost connection leaves it free at once, pointers and all', async (t) => {
    const first = await steering(t, server);
    const second = await join(t);
    first.input.down([100, 150]);
    await first.barrier();
    first.socket.terminate();
    await second.until('control free', () => second.state.control.holder === undefined);
    assert.equal(second.state.control.kept, false);
    await second.ask(PATCH);
    assert.ok(second.isHolder);
  });
});

describe('a flight', () => {
  const FAR = { ...POSE, eye: [3, 0, 8], focus: [3, 0, 0] };

  for (const [what, go] of [['release', (client) => client.ask({ type: 'control', action: 'release' })], ['a lost connection', (client) => client.socket.terminate()]]) {
    test(`${what} stops it`, async (t) => {
      const first = await steering(t, server);
      const second = await join(t);
      await first.ask({ type: 'fly', keyframes: [{ at: 500, camera: FAR }] });
      await go(first);
      await second.until('control free', () => second.state.control.holder === undefined);
      await sleep(700);
      assert.ok(second.state.camera.eye[0] < 2.9, `${second.state.camera.eye}`);
    });
  }

  test('goes on when another takes control, until that one steers', async (t) => {
    const first = await steering(t, server);
    const id = first.send({ type: 'fly', keyframes: [{ at: 300, camera: FAR }] });
    await first.answer(id);
    await holder(t, server);
    const flown = await first.texted('flown');
    assert.deepEqual([flown.id, flown.completed], [id, true]);
    assert.deepEqual(first.state.camera.eye, FAR.eye);
  });

  test('record does not stop it', async (t) => {
    const client = await steering(t, server);
    const id = client.send({ type: 'fly', keyframes: [{ at: 300, camera: FAR }] });
    await client.answer(id);
    await client.ask({ type: 'record', action: 'start', name: 'flight' });
    const flown = await client.texted('flown');
    assert.deepEqual([flown.id, flown.completed], [id, true]);
    assert.deepEqual(client.state.camera.eye, FAR.eye);
    await client.ask({ type: 'record', action: 'stop' });
  });

  for (const message of [...STEERING.filter((m) => !['open', 'record'].includes(m.type)), ...INPUT]) {
    test(`${message.type} stops it`, async (t) => {
      const client = await steering(t, server);
      const id = client.send({ type: 'fly', keyframes: [{ at: 20000, camera: FAR }] });
      await client.answer(id);
      client.send(message);
      const flown = await client.texted('flown');
      assert.deepEqual([flown.id, flown.completed], [id, false]);
      await client.barrier();
      assert.ok(client.state.camera.eye[0] < 2.9);
    });
  }

  test('a refused message does not stop it', async (t) => {
    const client = await steering(t, server);
    const id = client.send({ type: 'fly', keyframes: [{ at: 200, camera: FAR }] });
    await client.answer(id);
    const refusal = client.sendBad({ type: 'patch', patch: { camera: { fov: 1000 } } });
    await assert.rejects(client.answer(refusal), { code: 'out-of-range' });
    assert.equal((await client.texted('flown')).completed, true);
  });
});

describe('hosts', () => {
  test('steer by patches of camera, nodes and selection', async (t) => {
    const host = await join(t, { role: 'host' });
    await host.patch({ camera: { fov: 42 } });
    assert.deepEqual(host.state.control, { holder: host.id, kept: false });
    await host.patch({ selection: { node: 4 } });
    await host.patch({ nodes: { 4: { active: false } } });
    await host.patch({ nodes: null, selection: { node: null }, camera: POSE });
  });

  test('of nothing else: not-allowed', async (t) => {
    const host = await join(t, { role: 'host' });
    for (const patch of [{ navigation: { panSpeed: 2 } }, { renderer: { wireframe: true } }, { lights: { active: '9' } }, { backgrounds: { active: '17' } }, { markers: { A: { point: [0, 0, 0], text: '' } } }, { views: { home: { fov: 3 } } }, { quality: { preference: 1 } }, { camera: { fov: 42 }, navigation: { panSpeed: 2 } }]) {
      await host.refused({ type: 'patch', patch }, 'not-allowed', { valid: true });
    }
    for (const message of [...STEERING.filter((m) => m.type !== 'patch'), ...INPUT]) await host.refused(message, 'not-allowed', { valid: true });
    for (const action of ['take', 'release']) await host.refused({ type: 'control', action }, 'not-allowed', { valid: true });
  });

  test('by the same rule: not while another holds, yes once that is quiet', async (t) => {
    const client = await join(t);
    const host = await join(t, { role: 'host' });
    await client.ask(PATCH);
    await host.refused({ type: 'patch', patch: { camera: { fov: 42 } } }, 'not-in-control', { valid: true });
    await sleep(QUIET_MS + 200);
    await host.patch({ camera: { fov: 42 } });
    await client.refused(PATCH, 'not-in-control', { valid: true });
    await sleep(QUIET_MS + 200);
    await client.patch({ camera: POSE });
    assert.ok(client.isHolder);
  });

  test('shown is for hosts only', async (t) => {
    const host = await join(t, { role: 'host' });
    await host.ask({ type: 'shown', revision: host.revision });
    for (const role of ['control', 'view']) {
      const client = await join(t, { role });
      await client.refused({ type: 'shown', revision: client.revision }, 'not-allowed', { valid: true });
    }
  });
});

describe('one view', () => {
  test('has the size that the holder asked for, whoever grants', async (t) => {
    const first = await join(t);
    const second = await join(t);
    const watcher = await join(t, { role: 'view' });
    await first.ask({ type: 'resize', width: 320, height: 200, pixelRatio: 1 });
    await second.ask({ type: 'resize', width: 200, height: 320, pixelRatio: 1 });
    await watcher.ask({ type: 'resize', width: 90, height: 90, pixelRatio: 1 });
    await first.ask({ type: 'control', action: 'take' });
    const wide = await watcher.frame((header) => header.view.width === 320);
    assert.deepEqual(wide.header.view, { width: 320, height: 200, pixelRatio: 1 });
    await second.ask({ type: 'control', action: 'take' });
    const tall = await watcher.frame((header) => header.view.width === 200);
    assert.deepEqual(tall.header.view, { width: 200, height: 320, pixelRatio: 1 });
    const third = await holder(t, server); // never sent one
    await third.patch({ camera: { ...POSE, fov: 45 } });
    const last = await watcher.frame((header) => header.camera.fov === 45);
    assert.deepEqual(last.header.view, { width: 200, height: 320, pixelRatio: 1 });
  });

  test('is 1280 x 720 at ratio 1 before anybody asked', async (t) => {
    const fresh = await Server.start();
    t.after(() => fresh.stop());
    const client = await ContractClient.join(t, fresh, { role: 'view' });
    assert.deepEqual((await client.frame()).header.view, { width: 1280, height: 720, pixelRatio: 1 });
  });
});

describe('tokens', () => {
  for (const [what, hello] of [['none', {}], ['a wrong one', { token: 'steer-0123456789abcdeg' }], ['an empty one', { token: '' }]]) {
    test(`${what}: 1008`, async () => {
      const client = await ContractClient.connect(guarded);
      client.send({ type: 'hello', role: 'view', ...hello });
      const end = await client.ended();
      assert.equal(end.code, 1008);
      assert.ok(end.error, 'an error goes before');
    });
  }

  test('the view token gives role view, the control token every role', async (t) => {
    for (const [role, token, expected] of [
      ['view', env.VRUT_PREVIEW_VIEW_TOKEN, 'view'], ['control', env.VRUT_PREVIEW_VIEW_TOKEN, 'view'], ['host', env.VRUT_PREVIEW_VIEW_TOKEN, 'view'],
      ['view', env.VRUT_PREVIEW_CONTROL_TOKEN, 'view'], ['control', env.VRUT_PREVIEW_CONTROL_TOKEN, 'control'], ['host', env.VRUT_PREVIEW_CONTROL_TOKEN, 'host'],
    ]) {
      const client = await ContractClient.join(t, guarded, { role, token });
      assert.equal(client.welcome.role, expected, `${role} with the ${expected} token`);
    }
  });
});

test('a pick at nothing selects nothing', async (t) => {
  const client = await steering(t, server);
  await client.patch({ selection: { node: 4 } });
  const [x, y] = SEEN.nothing;
  await client.ask({ type: 'pick', x, y, then: 'select' });
  assert.equal(client.state.selection.node, undefined);
});

schemaTest(server);
