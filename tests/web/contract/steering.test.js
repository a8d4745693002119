// Contract: "Control" and "Tokens and origins" of PROTOCOL.md, and `control`, `resize` and `hello`.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import path from 'node:path';
import { after, describe, test } from 'node:test';
import { setTimeout as sleep } from 'node:timers/promises';
import { ContractClient } from './contract-client.js';
import { schemaTest } from './schema.js';
import { sceneFile, SCENES, Server, temporaryFolder } from './server.js';
import { holder, Input, POSE, SEEN, steering, VIEW } from './stage.js';
import { INPUT_RULES } from '../input-rules.js';

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
  { type: 'swing', node: 3 },
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

/** The state's `control` where `client` holds it; `more` beside that. */
const heldBy = (client, more = {}) => ({ holder: client.id, kept: true, absent: false, asking: [], ...more });

test('the state tells how the holder calls itself, to everybody', async (t) => {
  const [watcher, first, second] = [await join(t, { role: 'view' }), await join(t, { name: 'Eva’s tablet' }), await join(t)];
  await watcher.until('the name', () => watcher.state.control.name === 'Eva’s tablet');
  assert.deepEqual(first.state.control, heldBy(first, { name: 'Eva’s tablet' }));
  await second.ask({ type: 'control', action: 'take' });
  assert.deepEqual(second.state.control, heldBy(second));
  await second.refused({ type: 'patch', patch: { control: { name: 'Mine' } } }, 'read-only');
});

describe('the first control client', () => {
  test('holds control from the start, others do not', async (t) => {
    const watcher = await join(t, { role: 'view' });
    const host = await join(t, { role: 'host' });
    assert.deepEqual(watcher.state.control, { kept: false, absent: false, asking: [] });
    const first = await join(t);
    const second = await join(t);
    for (const client of [watcher, host, first, second]) {
      await client.until('the holder', () => client.state.control.holder === first.id);
    }
    await first.ask(PATCH);
  });

  test('holds it, however quiet it is, and whoever tries', async (t) => {
    const first = await join(t);
    const second = await join(t);
    await first.ask(PATCH);
    await sleep(QUIET_MS + 100);
    for (const message of STEERING) await second.refused(message, 'not-in-control', { valid: true });
    await first.ask(PATCH);
    assert.ok(first.isHolder);
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
    const types = other.texts.slice(count).map((text) => text.type);
    assert.deepEqual(types.filter((type) => type !== 'stats'), ['picked']);  // those come each second
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

describe('control', () => {
  const control = (action, client) => ({ type: 'control', action, ...(client && { client: client.id }) });

  test('is asked for; the holder sees who asks, and gives it', async (t) => {
    const [first, second] = [await join(t), await join(t, { name: 'Visitor’s phone' })];
    await second.ask(control('ask'));
    await first.until('who asks', () => first.state.control.asking.length === 1);
    assert.deepEqual(first.state.control.asking, [{ client: second.id, name: 'Visitor’s phone' }]);
    await second.refused(PATCH, 'not-in-control', { valid: true });
    await first.ask(control('give', second));
    assert.deepEqual(first.state.control, heldBy(second, { name: 'Visitor’s phone' }));
    await second.ask(PATCH);
    await first.refused(PATCH, 'not-in-control', { valid: true });
  });

  test('is declined, or not asked for any more', async (t) => {
    const [first, second] = [await join(t), await join(t)];
    await second.ask(control('ask'));
    await second.ask(control('ask'));
    assert.equal(second.state.control.asking.length, 1);
    await first.ask(control('decline', second));
    await second.until('the answer', () => second.state.control.asking.length === 0);
    await second.ask(control('ask'));
    await second.ask(control('cancel'));
    assert.deepEqual(second.state.control, heldBy(first));
  });

  test('only the holder gives and declines, and only to control clients that are here', async (t) => {
    const [first, second, viewer] = [await join(t), await join(t), await join(t, { role: 'view' })];
    await second.ask(control('ask'));
    for (const action of ['give', 'decline']) {
      await second.refused(control(action, second), 'not-in-control', { valid: true });
      await first.refused({ type: 'control', action }, 'bad-message');
    }
    await first.refused(control('give', viewer), 'out-of-range', { valid: true });
    await first.refused({ type: 'control', action: 'give', client: 'nobody' }, 'out-of-range', { valid: true });
    assert.ok(first.isHolder);
  });

  test('take always succeeds, also from who has a pointer down', async (t) => {
    const first = await steering(t, server);
    first.input.down([200, 150]);
    await first.barrier();
    const second = await holder(t, server);
    assert.deepEqual(second.state.control, heldBy(second));
    await first.refused(PATCH, 'not-in-control', { valid: true });
    const before = structuredClone(second.state.camera);
    first.input.move([300, 150]);
    await first.barrier();
    assert.deepEqual(first.state.camera, before, 'a drag ends with control');
  });

  test('release gives it back to who held it before', async (t) => {
    const [first, second] = [await join(t), await join(t)];
    const script = await holder(t, server);
    await script.ask({ type: 'control', action: 'release' });
    assert.deepEqual(script.state.control, heldBy(first));
    await second.refused(PATCH, 'not-in-control', { valid: true });
    await first.ask(PATCH);
  });

  test('release gives it to who asks', async (t) => {
    const first = await join(t);
    await join(t);
    const third = await join(t);
    await third.ask(control('ask'));
    await first.ask(control('release'));
    assert.deepEqual(first.state.control, heldBy(third));
  });

  test('release of who is alone changes nothing but the pointers', async (t) => {
    const client = await steering(t, server);
    client.input.down([100, 150]);
    client.input.move([130, 150]);
    await client.ask({ type: 'control', action: 'release' });
    const { camera } = client.state;
    client.input.move([200, 150]);
    await client.barrier();
    assert.deepEqual(client.state.camera, camera);
    assert.ok(client.isHolder);
  });

  test('without a resume key a lost connection passes it on at once, and lifts the pointers', async (t) => {
    const first = await steering(t, server);
    const second = await join(t);
    first.input.down([100, 150]);
    await first.barrier();
    first.socket.terminate();
    await second.until('control', () => second.isHolder);
    await second.ask(PATCH);
  });
});

describe('a resume key', () => {
  const logs = temporaryFolder();
  // An absent holder stays the holder for tests that come after.
  const at = async (t) => {
    const own = await Server.start({ options: ['--record', logs] });
    t.after(() => own.stop());
    return (hello) => ContractClient.join(t, own, hello);
  };

  test('keeps control for 10 s for who comes back with it', async (t) => {
    const come = await at(t);
    const first = await come({ resume: 'a secret', name: 'Eva’s tablet' });
    const second = await come({ resume: 'another' });
    first.socket.terminate();
    await second.until('absence', () => second.state.control.absent);
    assert.deepEqual(second.state.control, heldBy(first, { absent: true, name: 'Eva’s tablet' }));
    await second.refused(PATCH, 'not-in-control', { valid: true });
    const other = await come({ resume: 'a third' });
    assert.equal(other.state.control.holder, first.id);
    const back = await come({ resume: 'a secret', name: 'Eva’s tablet' });
    await back.until('control', () => back.isHolder);
    assert.deepEqual(back.state.control, heldBy(back, { name: 'Eva’s tablet' }));
    await back.ask(PATCH);
  });

  test('works before the former connection is known to be dead', async (t) => {
    const come = await at(t);
    const first = await come({ resume: 'a secret' });
    const second = await come();
    const back = await come({ resume: 'a secret' });
    await back.until('control', () => back.isHolder);
    first.socket.terminate();
    await second.barrier();
    assert.equal(second.state.control.holder, back.id);
  });

  test('is told to nobody', async (t) => {
    const come = await at(t);
    const watcher = await come({ role: 'view' });
    const first = await come({ resume: 'a very secret key' });
    await first.ask({ type: 'record', action: 'start', name: 'resume-key' });
    const back = await come({ resume: 'a very secret key' });
    await back.ask({ type: 'record', action: 'stop' });
    assert.equal(readFileSync(path.join(logs, 'resume-key.jsonl'), 'utf8').includes('secret'), false);
    await watcher.barrier();
    assert.equal(JSON.stringify(watcher.texts).includes('a very secret key'), false);
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
      await second.until('control', () => second.isHolder);
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

  test('record and swing do not stop it', async (t) => {
    const client = await steering(t, server);
    const id = client.send({ type: 'fly', keyframes: [{ at: 300, camera: FAR }] });
    await client.answer(id);
    await client.ask({ type: 'record', action: 'start', name: 'flight' });
    await client.ask({ type: 'swing', node: 3, ms: 0 });
    const flown = await client.texted('flown');
    assert.deepEqual([flown.id, flown.completed], [id, true]);
    assert.deepEqual(client.state.camera.eye, FAR.eye);
    await client.ask({ type: 'record', action: 'stop' });
    await client.patch({ nodes: null });
  });

  for (const message of [...STEERING.filter((m) => !['open', 'record', 'swing'].includes(m.type)), ...INPUT]) {
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
  test('steer by patches of camera, nodes and selection, and take no control by it', async (t) => {
    const host = await join(t, { role: 'host' });
    await host.patch({ camera: { fov: 42 } });
    assert.equal(host.state.control.holder, undefined);
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

  test('not while the holder steers, nor within 1 s of that, nor while a pointer is down', async (t) => {
    const client = await steering(t, server);
    const host = await join(t, { role: 'host' });
    const patch = { type: 'patch', patch: { camera: { fov: 42 } } };
    await client.ask(PATCH);
    const start = Date.now();
    await host.refused(patch, 'not-in-control', { valid: true });
    await sleep(QUIET_MS - 300 - (Date.now() - start));
    await host.refused(patch, 'not-in-control', { valid: true });
    await sleep(500);
    await host.ask(patch);
    assert.equal(host.state.control.holder, client.id);
    client.input.down([200, 150]);
    await client.barrier();
    await sleep(QUIET_MS + 100);
    await host.refused(patch, 'not-in-control', { valid: true });
    client.input.up([200, 150]);
    await client.patch({ camera: POSE });
  });

  test('stop a flight of a quiet holder', async (t) => {
    const client = await steering(t, server);
    const host = await join(t, { role: 'host' });
    const id = client.send({ type: 'fly', keyframes: [{ at: 20000, camera: { eye: [3, 0, 8] } }] });
    await client.answer(id);
    await sleep(QUIET_MS + 200);
    await host.patch({ camera: POSE });
    const flown = await client.texted('flown');
    assert.deepEqual([flown.id, flown.completed], [id, false]);
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

test('the welcome tells what input does', async (t) => {
  assert.deepEqual((await ContractClient.join(t, server)).welcome.input, INPUT_RULES);
});

test('a pick at nothing selects nothing', async (t) => {
  const client = await steering(t, server);
  await client.patch({ selection: { node: 4 } });
  const [x, y] = SEEN.nothing;
  await client.ask({ type: 'pick', x, y, then: 'select' });
  assert.equal(client.state.selection.node, undefined);
});

schemaTest(server);
