// Two servers share a room, and clients come by an edge: they keep their connections, whatever happens to a server.
import assert from 'node:assert/strict';
import { copyFileSync } from 'node:fs';
import path from 'node:path';
import { describe, test } from 'node:test';
import { setTimeout as delay } from 'node:timers/promises';
import { ContractClient } from '../contract/contract-client.js';
import { sceneFile, temporaryFolder } from '../contract/server.js';
import { Cluster, eventually, missing } from './cluster.js';

const WITHIN_MS = 15_000;

async function stage(t) {
  const cluster = new Cluster(t);
  const nats = await cluster.startNats();
  const servers = [await cluster.serve('stage'), await cluster.serve('stage')];
  const edge = await cluster.edge();
  const room = await cluster.room(edge, 'stage');
  const client = await ContractClient.join(t, room, { name: 'Tablet', resume: 'one-tablet' });
  await client.ask({ type: 'resize', width: 400, height: 300, pixelRatio: 1 });
  return { cluster, nats, servers, edge, room, client };
}

const pointer = (event, x, y) => ({ type: `pointer${event}`, pointerId: 1, pointerType: 'touch', x, y, button: event === 'move' ? -1 : 0, buttons: event === 'up' ? 0 : 1, isPrimary: true });

/** A watcher who has sized its view, and has a frame. */
async function watching(t, room) {
  const watcher = await ContractClient.join(t, room, { role: 'view' });
  await watcher.ask({ type: 'resize', width: 400, height: 300, pixelRatio: 1 });
  await sees(watcher, 1);
  return watcher;
}

/** Gets so many frames, as the page does: grants have no id, so that they are no messages to the room. */
async function sees(watcher, count, lease = 0) {
  for (let seen = watcher.frames.length; count > 0; seen = watcher.frames.length) {
    watcher.send({ type: 'frame' }, { id: null });
    await watcher.until(`${count} frames`, () => watcher.frames.length > seen, WITHIN_MS);
    if (watcher.frames.at(-1).header.lease >= lease) --count;
  }
}

/** The view moves on and on: no frame shows what is to be seen now. */
const flying = (client) => client.ask({ type: 'fly', keyframes: [{ at: 60_000, camera: { eye: [-3, 2, 5] } }] });

/** Draws a circle with a finger, and all the time asks for frames. @returns the numbers of the frames that came */
async function drag(client, milliseconds, during = async () => {}) {
  client.send(pointer('down', 200, 150));
  const end = Date.now() + milliseconds;
  const doing = during();
  let at = client.frames.length;
  client.send({ type: 'frame' });
  for (let i = 0; Date.now() < end; ++i, await delay(16)) {
    client.send(pointer('move', 200 + 80 * Math.sin(i / 20), 150 + 40 * Math.sin(i / 13)));
    for (; at < client.frames.length; ++at) client.send({ type: 'frame' });
  }
  await doing;
  client.send(pointer('up', 200, 150));
  await client.until('the end of the drag', () => true);
}

const pose = ({ state }) => JSON.stringify(state.camera);

describe('a room of two servers', { skip: missing }, () => {
  for (const [what, signal] of [['is killed', 'SIGKILL'], ['hangs', 'SIGSTOP'], ['is stopped', 'SIGTERM']]) {
    test(`goes on for clients when the one that draws it ${what}`, async (t) => {
      const { cluster, servers, client } = await stage(t);
      const owner = await cluster.owner(servers);
      const other = servers.find((server) => server !== owner);
      await drag(client, 3500, async () => {
        await delay(500);
        owner.signal(signal);
      });
      // Each patch is answered once, and has happened once.
      const { revision } = await client.answer(client.send({ type: 'patch', patch: { markers: { here: { point: [1, 2, 3] } } } }));
      await client.until('the patch', () => client.revision >= revision && client.state.markers.here, WITHIN_MS);
      assert.equal(client.state.control.holder, client.id, 'control is kept');
      const before = pose(client);
      await client.frame((header) => JSON.stringify(header.camera.eye) === JSON.stringify(client.state.camera.eye));
      assert.equal(await cluster.owner([other]), other);
      if (signal === 'SIGSTOP') {
        owner.signal('SIGCONT');
        await eventually('that the former server follows', () => owner.logged('room_followed').length === 2);
      }
      assert.equal(pose(client), before);
    });
  }

  test('shows a view that moves to watchers who touch nothing, after another server has taken it over', async (t) => {
    const { cluster, servers, room, client } = await stage(t);
    const watchers = await Promise.all([1, 2].map(() => watching(t, room)));
    // What the room's log does not have counts, too.
    await watchers[1].ask({ type: 'check', cues: { format: 'vrut-preview-cues', version: 1, cues: {} } });
    const owner = await cluster.owner(servers);
    await owner.stop();
    await cluster.owner(servers);
    const { lease } = (await client.frame((header) => header.lease > watchers[0].frames.at(-1).header.lease)).header;
    await flying(client);
    await Promise.all(watchers.map((watcher) => sees(watcher, 20, lease)));
  });

  test('shows a view that moves to watchers whose edge was cut off for so long that it counted as lost', async (t) => {
    const { cluster, servers, edge, room } = await stage(t);
    const watcher = await watching(t, room);
    const owner = await cluster.owner(servers);
    const presenter = await ContractClient.join(t, { ...room, url: owner.url, ws: `${owner.url}ws`.replace('http', 'ws') }, { name: 'At the door' });
    edge.signal('SIGSTOP');
    await eventually('that the edge is lost', () => owner.logged('edge_lost').length > 0, WITHIN_MS);
    edge.signal('SIGCONT');
    await presenter.ask({ type: 'control', action: 'take' });
    await eventually('that it is back', () => owner.logged('edge_joined').length > 1, WITHIN_MS);
    await flying(presenter);
    await sees(watcher, 20);
  });

  test('keeps the camera to the last bit over three servers, one after the other', async (t) => {
    const { cluster, servers, client, edge } = await stage(t);
    await drag(client, 400);
    for (let i = 0; i < 3; ++i) {
      await client.barrier();
      const [before, revision] = [pose(client), client.revision];
      const owner = await cluster.owner(servers);
      await owner.stop();
      servers.splice(servers.indexOf(owner), 1, await cluster.serve('stage'));
      await cluster.owner(servers);
      // Who comes later gets the state of the server that has taken over.
      const later = await ContractClient.join(t, await cluster.room(edge, 'stage'), { role: 'view' });
      assert.equal(pose(later), before);
      assert.ok(later.revision >= revision);
      await later.leave();
      await drag(client, 400);
    }
  });

  test('keeps what happened while a server draws it for the second time', async (t) => {
    const { cluster, servers, client } = await stage(t);
    const mark = async (name) => {
      const { revision } = await client.answer(client.send({ type: 'patch', patch: { markers: { [name]: { point: [1, 2, 3] } } } }));
      await client.until(name, () => client.revision >= revision, WITHIN_MS);
    };
    for (const name of ['a', 'b', 'c', 'd']) await mark(name);
    const first = await cluster.owner(servers);
    const second = servers.find((server) => server !== first);
    first.signal('SIGSTOP');
    await cluster.owner([second]);
    first.signal('SIGCONT');
    await eventually('that the former server follows', () => first.logged('room_followed').length === 2);
    await second.stop();
    await cluster.owner([first]);
    const third = await cluster.serve('stage');
    await mark('e');
    await first.stop();
    await cluster.owner([third]);
    await mark('f');
    assert.deepEqual(Object.keys(client.state.markers), ['a', 'b', 'c', 'd', 'e', 'f']);
  });

  test('has what was done at the own door of a server while NATS was away for long', async (t) => {
    const { cluster, servers, nats, room } = await stage(t);
    const owner = await cluster.owner(servers);
    const presenter = await ContractClient.join(t, { ...room, url: owner.url, ws: `${owner.url}ws`.replace('http', 'ws') }, { name: 'At the door' });
    await presenter.ask({ type: 'control', action: 'take' });
    const mark = (name) => presenter.ask({ type: 'patch', patch: { markers: { [name]: { point: [1, 2, 3] } } } });
    await mark('before');
    await nats.stop();
    await mark('away');
    await eventually('a state, in whose place no lines wait for NATS', () => owner.logged('room_log_restarts').length > 0);
    await mark('later');
    await cluster.startNats();
    await eventually('that it is stored', () => owner.logged('room_stored').length > 0);
    await mark('after');
    const camera = JSON.stringify(presenter.state.camera);
    await delay(500);
    await owner.stop();
    const watcher = await eventually('a watcher', async () => ContractClient.join(t, await cluster.room(await cluster.edge(), 'stage'), { role: 'view' }));
    assert.deepEqual(Object.keys(watcher.state.markers).sort(), ['after', 'away', 'before', 'later']);
    assert.equal(JSON.stringify(watcher.state.camera), camera);
  });

  test('says that a scene is not opened when the server that loads it is gone', async (t) => {
    const folder = temporaryFolder();
    copyFileSync(sceneFile('stage.vrut'), path.join(folder, 'stage.vrut'));
    copyFileSync(process.env.VRUT_CAR, path.join(folder, 'car.vrut'));
    const cluster = new Cluster(t);
    await cluster.startNats();
    const scene = path.join(folder, 'stage.vrut'), options = ['--scenes', folder];
    const servers = [await cluster.serve('stage', { scene, options }), await cluster.serve('stage', { scene, options })];
    const client = await ContractClient.join(t, await cluster.room(await cluster.edge(), 'stage'));
    const owner = await cluster.owner(servers);
    await client.ask({ type: 'open', scene: 'car.vrut' });
    await client.texted('loading');
    await owner.stop();
    const { scene: name, refused } = await client.until('its end', () => client.texts.find((text) => text.type === 'loading' && (text.refused || text.done)), WITHIN_MS);
    assert.deepEqual([name, refused], ['car.vrut', 'the server that loaded the scene is gone: open it again']);
    await client.ask({ type: 'open', scene: 'car.vrut' });
    await client.until('the car', () => client.state.scene.name !== 'Stage' && client.texts.find((text) => text.type === 'loading' && text.done), 60_000);
  });
});
