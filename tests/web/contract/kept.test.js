// What clients change of a scene survives a restart of the server, and another scene.
import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { readFileSync, readdirSync, writeFileSync } from 'node:fs';
import path from 'node:path';
import { describe, test } from 'node:test';
import { PROGRAM, SCENES, Server, temporaryFolder } from './server.js';
import { holder } from './stage.js';

const CHANGES = {
  views: { front: { eye: [0, 1, 9], focus: [0, 0, 0], fov: 25, order: 2 }, home: { fov: 33 } },
  markers: { bump: { point: [1, 2, 3], text: 'here' } },
  nodes: { 4: { active: false } },
};
const GIVE_BACK = { views: null, markers: null, nodes: null };

/** What `wanted` names, of `all`. */
const subset = (all, wanted) => (wanted !== null && typeof wanted === 'object' && !Array.isArray(wanted) && all
  ? Object.fromEntries(Object.keys(wanted).map((name) => [name, subset(all[name], wanted[name])])) : all);

const kept = ({ views, markers, nodes }) => ({ views, markers, nodes });

describe('what is kept of a scene', () => {
  const start = async (t, state) => {
    const server = await Server.start({ options: ['--scenes', SCENES], env: { XDG_STATE_HOME: state } });
    t.after(() => server.stop());
    const client = await holder(t, server);
    return { server, client };
  };
  const files = (state) => readdirSync(path.join(state, 'vrut-preview/scenes'));
  const show = async (client, scene) => {
    await client.ask({ type: 'open', scene });
    await client.until(scene, () => client.state.scene.file === scene, 30000);
  };

  test('survives a restart; null gives back what the file says, and nothing is kept then', async (t) => {
    const state = temporaryFolder();
    const first = await start(t, state);
    const file = kept(first.client.state);
    await first.client.patch(CHANGES);
    const changed = kept(first.client.state);
    await first.server.stop();
    assert.deepEqual(files(state).map((name) => /^[0-9a-f]{64}\.json$/.test(name)), [true]);

    const second = await start(t, state);
    assert.deepEqual(kept(second.client.state), changed);
    assert.equal(second.client.state.camera.fov, 33);
    await second.client.patch(GIVE_BACK);
    assert.deepEqual(kept(second.client.state), file);
    await second.server.stop();
    assert.deepEqual(files(state), []);

    const third = await start(t, state);
    assert.deepEqual(kept(third.client.state), file);
  });

  test('each of its members is kept where nothing else changes', async (t) => {
    const state = temporaryFolder();
    const pick = (point) => ({ node: 4, snap: 'point', points: [point] });
    const alone = [
      { views: { front: { eye: [0, 1, 9], focus: [0, 0, 0] } } }, { markers: { bump: { point: [1, 2, 3] } } },
      { measures: { gap: { kind: 'distance', picks: [pick([-0.5, 0, 0]), pick([0.5, 0, 0])] } } },
      { unit: { shown: 'm' } }, { cues: { Door: { text: 'first' } } }, { cues: { Door: { text: 'then' } } }, { nodes: { 4: { active: false } } },
    ];
    for (const patch of alone) {
      const { server, client } = await start(t, state);
      await client.patch(patch);
      await server.stop();
      const later = await start(t, state);
      assert.deepEqual(subset(later.client.state, patch), patch);
      await later.server.stop();
    }
  });

  test('survives another scene, and the first one can be opened again', async (t) => {
    const { client } = await start(t, temporaryFolder());
    await client.patch(CHANGES);
    const changed = kept(client.state);
    await show(client, 'second.vrut');
    assert.deepEqual(client.state.markers, {});
    await client.patch({ markers: { other: { point: [0, 0, 0] } } });
    await show(client, 'stage.vrut');
    assert.deepEqual(kept(client.state), changed);
    // At once after a change: the newest counts, whatever a disk has by then.
    await client.patch({ markers: { late: { point: [0, 0, 1] } } });
    await client.ask({ type: 'open', scene: 'stage.vrut' });
    await client.until('the scene again', () => client.state.nodes !== undefined && client.texts.filter(({ type, done }) => type === 'loading' && done).length === 3, 30000);
    assert.deepEqual(Object.keys(client.state.markers).sort(), ['bump', 'late']);
    await show(client, 'second.vrut');
    assert.deepEqual(Object.keys(client.state.markers), ['other']);
  });

  test('the up axis is chosen for a file that does not tell it, and is kept with what belongs to it', async (t) => {
    const [state, folder, logs] = [temporaryFolder(), temporaryFolder(), temporaryFolder()];
    writeFileSync(path.join(folder, 'tower.obj'), 'v 0 0 0\nv 1 0 0\nv 0 0 9\nf 1 2 3\n');
    const options = ['--scenes', folder, '--record', logs];
    const begin = async () => {
      const server = await Server.start({ options, env: { XDG_STATE_HOME: state } });
      t.after(() => server.stop());
      return { server, client: await holder(t, server) };
    };
    const open = async (client, message) => {
      const before = client.texts.length;
      await client.ask({ type: 'open', scene: 'tower.obj', ...message });
      await client.until('the tower', () => client.texts.slice(before).some(({ type }) => type === 'state'), 30000);
    };
    const height = ({ state: { scene } }) => scene.bounds.max[1];

    const first = await begin();
    assert.equal(first.client.state.scene.upAxis, undefined);
    await assert.rejects(first.client.ask({ type: 'open', scene: 'stage.vrut', upAxis: 'z' }),
      /refused-scene.*stage\.vrut: its format defines which axis is up: leave out 'upAxis'/);
    await open(first.client);
    assert.deepEqual([first.client.state.scene.upAxis, height(first.client)], ['y', 0]);
    await first.client.patch({ markers: { lying: { point: [0, 0, 9] } } });
    await first.client.ask({ type: 'record', action: 'start', name: 'turned' });
    await open(first.client, { upAxis: 'z' });
    assert.deepEqual([first.client.state.scene.upAxis, height(first.client), first.client.state.markers], ['z', 9, {}]);
    await first.client.patch({ markers: { standing: { point: [0, 9, 0] } } });
    await first.client.ask({ type: 'record', action: 'stop' });
    const { camera } = structuredClone(first.client.state);
    await first.server.stop();
    const replay = spawnSync(PROGRAM, ['replay', path.join(logs, 'turned.jsonl'), '--scene', path.join(folder, 'tower.obj')], { encoding: 'utf8' });
    const { eye, focus } = JSON.parse(replay.stdout);
    assert.deepEqual({ eye, focus }, { eye: camera.eye, focus: camera.focus });
    const log = readFileSync(path.join(logs, 'turned.jsonl'), 'utf8').trim().split('\n').map((line) => JSON.parse(line));
    assert.equal(log[0].upAxis, 'y');
    assert.equal(log.find(({ event }) => event === 'opened').upAxis, 'z');

    const second = await begin();
    await open(second.client);
    assert.deepEqual([second.client.state.scene.upAxis, height(second.client)], ['z', 9]);
    assert.deepEqual(Object.keys(second.client.state.markers), ['standing']);
    await open(second.client, { upAxis: 'y' });
    assert.deepEqual(Object.keys(second.client.state.markers), ['lying']);
  });

  const many = (count, entry) => Object.fromEntries(Array.from({ length: count }, (_, i) => [`n${i}`, entry]));
  const unusable = {
    'cut off': (text) => text.slice(0, -20),
    'empty': () => '',
    'no text': () => Buffer.from([0xff, 0xfe, 0x00, 0x7b]),
    'of a newer version': (text) => text.replace(/^\{/, '{"sketches":{},'),
    'of a version with more cues': (text) => JSON.stringify({ ...JSON.parse(text), cues: many(101, { text: 'x' }) }),
    'of a version with more notes': (text) => JSON.stringify({ ...JSON.parse(text), markers: many(257, { point: [0, 0, 0] }) }),
    'of another type': (text) => text.replace(/"fov":[\d.]+/, '"fov":"wide"'),
    'of another scene': (text) => text.replace('"4":', '"400":'),
  };
  const isSetAside = (name) => /^[0-9a-f]{64}\.json\.unreadable-\d{4}-\d\d-\d\dT\d\d-\d\d-\d\dZ$/.test(name);
  const noticed = (client, name) => client.until(`a notice of ${name}`, () =>
    client.state.notices.some(({ code, message }) => code === 'unusable-changes' && message.includes(name)), 10000);

  for (const [how, spoilt] of Object.entries(unusable)) {
    test(`and cannot be used, as it is ${how}, is set aside and never written over`, async (t) => {
      const state = temporaryFolder();
      const first = await start(t, state);
      const file = kept(first.client.state);
      await first.client.patch(CHANGES);
      await first.server.stop();
      const [name] = files(state);
      const inFolder = (other) => path.join(state, 'vrut-preview/scenes', other);
      const bytes = Buffer.from(spoilt(readFileSync(inFolder(name), 'utf8')));
      writeFileSync(inFolder(name), bytes);

      const second = await start(t, state);
      assert.deepEqual(kept(second.client.state), file);
      await second.client.until('the file is set aside', () => files(state).every(isSetAside), 10000);
      const [aside] = files(state);
      await noticed(second.client, aside);
      await noticed(second.client, 'stage.vrut cannot be used: ');
      await second.client.patch(CHANGES);
      await second.server.stop();
      assert.deepEqual(files(state).sort(), [name, aside]);
      assert.deepEqual(readFileSync(inFolder(aside)), bytes);

      const third = await start(t, state);
      assert.deepEqual(third.client.state.notices.filter(({ code }) => code === 'unusable-changes'), []);
      assert.deepEqual(subset(third.client.state, CHANGES), CHANGES);
    });
  }

  test('and cannot be used is set aside when its scene is opened later, too', async (t) => {
    const state = temporaryFolder();
    const first = await start(t, state);
    await show(first.client, 'second.vrut');
    await first.client.patch({ markers: { other: { point: [0, 0, 0] } } });
    await first.server.stop();
    const [name] = files(state);
    writeFileSync(path.join(state, 'vrut-preview/scenes', name), '{"markers":');

    const { client } = await start(t, state);
    await show(client, 'second.vrut');
    await client.until('the file is set aside', () => files(state).every(isSetAside), 10000);
    await noticed(client, files(state)[0]);
  });

  test('a folder that takes nothing is told in a notice, and all else goes on', async (t) => {
    const { client } = await start(t, '/dev/null/none');
    await client.patch(CHANGES);
    await client.until('the notice', () => client.state.notices.some(({ code, message }) => code === 'not-kept' && /cannot be kept/.test(message)), 10000);
    await client.patch({ markers: { second: { point: [0, 0, 0] } } });
  });
});
