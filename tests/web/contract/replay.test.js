// Contract: `record`, EVENT_LOG.md, and that its replay ends at the same camera.
import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { createHash } from 'node:crypto';
import { readdirSync, readFileSync, writeFileSync } from 'node:fs';
import path from 'node:path';
import { after, before, describe, test } from 'node:test';
import { setTimeout as sleep } from 'node:timers/promises';
import { ContractClient } from './contract-client.js';
import { schemaTest } from './schema.js';
import { PROGRAM, sceneFile, Server, temporaryFolder } from './server.js';
import { Input, POSE, VIEW } from './stage.js';

const SCENE = sceneFile('stage.vrut');
const TOKEN = 'steer-0123456789abcdef';
const logs = temporaryFolder();
const env = { VRUT_PREVIEW_CONTROL_TOKEN: TOKEN, VRUT_PREVIEW_VIEW_TOKEN: 'watch-0123456789abcdef' };
const server = await Server.start({ scene: SCENE, env, bearer: TOKEN, options: ['--record', logs] });
after(() => server.stop());

const logFile = (name) => path.join(logs, readdirSync(logs).find((file) => file.startsWith(name)));
const lines = (name) => readFileSync(logFile(name), 'utf8').trim().split('\n').map((line) => JSON.parse(line));
const MEMBERS = ['eye', 'focus', 'up', 'center', 'fov', 'near', 'far'];

function replayed(name, ...options) {
  const run = spawnSync(PROGRAM, ['replay', logFile(name), '--scene', SCENE, ...options], { encoding: 'utf8' });
  assert.equal(run.status, 0, run.stderr);
  return JSON.parse(run.stdout);
}

async function join(t, hello) {
  const client = await ContractClient.join(t, server, { token: TOKEN, ...hello });
  client.input = new Input(client);
  return client;
}

/** Records what `session` does; resolves with the camera when it stopped. */
async function recorded(t, name, session) {
  const client = await join(t);
  await client.ask({ type: 'control', action: 'take' });
  await client.ask({ type: 'resize', ...VIEW });
  await client.patch({ camera: POSE });
  await client.frameOfNow();
  await client.ask({ type: 'record', action: 'start', name });
  await session(client);
  await client.ask({ type: 'record', action: 'stop' });
  return structuredClone(client.state.camera);
}

const SESSIONS = {
  drags: async (client) => {
    await client.input.drag([[50, 50], [61.25, 80], [170.5, 91.75]]);
    await client.input.drag([[300, 200], [280, 190], [111, 203]], 2);
    await client.input.drag([[200, 200], [200, 111]], 1);
    await client.input.wheel(-137.5);
    await client.input.wheel(2, 1);
    await client.input.key('ArrowLeft', 'ArrowLeft');
    await client.input.doubleClick([210, 150], 1);
    await client.ask({ type: 'navigate', rotate: [33.3, -7.1], pan: [0.1, 0.01], zoom: 1.7 });
  },
  pinch: async (client) => {
    const { input } = client;
    input.down([150, 150], 0, input.finger(3));
    input.down([250, 160], 0, input.finger(4));
    await input.pass(30);
    for (let i = 0; i < 20; ++i) {
      input.move([150 - 3 * i, 150 + i], 0, input.finger(3));
      input.move([250 + 2 * i, 160 + 2 * i], 0, input.finger(4));
    }
    input.up([93, 169], 0, input.finger(3));
    input.up([288, 198], 0, input.finger(4));
    await client.barrier();
  },
  flown: async (client) => {
    client.send({ type: 'fly', keyframes: [{ at: 200, camera: { ...POSE, eye: [1 / 3, 2, 5] } }] });
    await client.texted('flown');
    await client.input.wheel(-50);
  },
  interrupted: async (client) => {
    client.send({ type: 'fly', keyframes: [{ at: 5000, camera: { ...POSE, eye: [1 / 3, 2, 5], fov: 70 } }] });
    await sleep(230);
    await client.input.drag([[50, 50], [61.25, 80]]); // the first press stops the flight
    await client.texted('flown');
  },
  several: async (client) => {
    await client.patch({ nodes: { 3: { matrix: [1, 0, 0, 1.5, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1] } }, navigation: { rotateSpeed: 1.5 } });
    const seen = await client.frameOfNow();
    await client.ask({ type: 'pick', x: 285, y: 150, frame: seen.header.frame, then: 'lookAt' });
    await client.input.drag([[50, 150], [77, 155]]);
    await client.patch({ nodes: null, navigation: null });
  },
};

for (const [name, session] of Object.entries(SESSIONS)) {
  test(`${name}: the replay ends at the same camera, to the last bit`, async (t) => {
    const camera = await recorded(t, name, session);
    const end = replayed(name);
    for (const member of MEMBERS) assert.deepEqual(end[member], camera[member], member);
    assert.deepEqual(replayed(name), end, 'as often as one likes');
  });
}

test('with other clients that come, take over and go', async (t) => {
  const camera = await recorded(t, 'guests', async (client) => {
    const guest = await join(t, { role: 'control' });
    await guest.ask({ type: 'resize', width: 300, height: 500, pixelRatio: 2 });
    await guest.ask({ type: 'control', action: 'take' });
    await guest.input.drag([[50, 50], [90, 300]]);
    guest.input.down([10, 10]);
    await guest.leave();
    await client.until('control', () => client.isHolder);
    await client.input.drag([[50, 50], [90, 90]]);
  });
  const end = replayed('guests');
  for (const member of MEMBERS) assert.deepEqual(end[member], camera[member], member);
  const events = lines('guests').filter((line) => /connected$/.test(line.event)).map((line) => line.event);
  assert.deepEqual(events, ['connected', 'disconnected']);
  assert.deepEqual(lines('guests').filter((line) => line.event === 'control').length, 2);
});

describe('the log', () => {
  let log;
  let camera;
  before(async () => {
    const cleanup = [];
    camera = await recorded({ after: (f) => cleanup.push(f) }, 'session', async (client) => {
      const guest = await join({ after: (f) => cleanup.push(f) }, { role: 'view' });
      await guest.leave();
      await client.input.drag([[50, 50], [90, 90]]);
      await client.frameOfNow();
      await client.refused({ type: 'navigate', zoom: 0 }, 'out-of-range');
      await client.ask({ type: 'navigate', zoom: 1.25, remark: 'unknown members travel' });
    });
    for (const leave of cleanup) await leave();
    log = lines('session');
  });

  test('begins with what it is, the scene, the state and the clients', () => {
    const [head] = log;
    assert.deepEqual([head.log, head.version], ['vrut-preview', 1]);
    assert.match(head.scene, /stage/);
    assert.equal(head.sceneSha256, createHash('sha256').update(readFileSync(SCENE)).digest('hex'));
    assert.match(head.started, /^\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d/);
    assert.ok(Math.abs(Date.parse(head.started) - Date.now()) < 120_000);
    assert.deepEqual(head.state.camera.eye, POSE.eye);
    const steering = head.clients.find((client) => client.client === head.state.control.holder);
    assert.deepEqual([steering.role, steering.width, steering.height, steering.pixelRatio], ['control', 400, 300, 1]);
  });

  test('has a line for each accepted message as it came, with its client and time', () => {
    const messages = log.slice(1).filter((line) => line.message);
    const types = messages.map((line) => line.message.type);
    for (const type of ['pointerdown', 'pointermove', 'pointerup', 'navigate']) assert.ok(types.includes(type), type);
    const navigate = messages.filter((line) => line.message.type === 'navigate');
    assert.equal(navigate.length, 1, 'the refused one is not there');
    assert.deepEqual([navigate[0].message.zoom, navigate[0].message.remark], [1.25, 'unknown members travel']);
    assert.equal(typeof navigate[0].client, 'string');
    const times = log.slice(1).map((line) => line.at);
    assert.ok(times.every((at, i) => at >= (times[i - 1] ?? 0)), `${times}`);
  });

  test('has who came and went, and no token', () => {
    const events = log.filter((line) => /connected$/.test(line.event));
    assert.deepEqual(events.map((line) => line.event), ['connected', 'disconnected']);
    assert.equal(events[0].role, 'view');
    assert.equal(events[0].client, events[1].client);
    assert.equal(JSON.stringify(log).includes(TOKEN), false);
  });

  test('cut off in mid-flight: the flight is taken at the last line', async (t) => {
    await recorded(t, 'cut', async (client) => {
      client.send({ type: 'fly', keyframes: [{ at: 3000, camera: { ...POSE, eye: [0, 0, 20], focus: [0, 0, 12] } }], easing: 'linear' });
      await sleep(200);
      await client.ask({ type: 'tree' });
    });
    const kept = lines('cut').filter((line) => !line.message || line.message.type === 'fly');
    const fly = kept.find((line) => line.message);
    const viewer = { at: fly.at + 1500, client: 'c999', event: 'connected', role: 'view' };
    const file = path.join(logs, 'halfway.jsonl');
    writeFileSync(file, [kept[0], fly, viewer].map((line) => JSON.stringify(line)).join('\n') + '\n');
    const { eye } = replayed('halfway');
    assert.ok(Math.abs(eye[2] - 14) < 1e-6, `halfway after half the time: ${eye}`);
  });

  test('replay --out writes frames; a log that is none is told in a sentence', () => {
    const out = temporaryFolder();
    const end = replayed('session', '--out', out);
    assert.ok(readdirSync(out).length > 0, 'what was drawn for somebody');
    for (const member of MEMBERS) assert.deepEqual(end[member], camera[member], member);
    const wrong = spawnSync(PROGRAM, ['replay', SCENE], { encoding: 'utf8' });
    assert.equal(wrong.status, 1);
    assert.equal(wrong.stderr.trim().split('\n').length, 1, wrong.stderr);
    assert.equal(wrong.stdout, '');
  });
});

schemaTest(server);
