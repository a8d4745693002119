// What NATS keeps of a room: its state, which expires, and the log of what has happened since.
import assert from 'node:assert/strict';
import { describe, test } from 'node:test';
import { setTimeout as delay } from 'node:timers/promises';
import { ContractClient } from '../contract/contract-client.js';
import { Cluster, eventually, missing } from './cluster.js';

const WITHIN_MS = 15_000;
const STATES = 'KV_VRUT_ROOMS';

/** NATS, which keeps a state for so many seconds. */
async function nats(t, seconds = 600) {
  const cluster = new Cluster(t);
  await cluster.startNats();
  const nanoseconds = seconds * 1e9;
  const { error } = await cluster.asked(`$JS.API.STREAM.CREATE.${STATES}`, {
    name: STATES, subjects: ['$KV.VRUT_ROOMS.>'], max_msgs_per_subject: 1, max_age: nanoseconds, duplicate_window: Math.min(nanoseconds, 120e9),
    discard: 'new', allow_rollup_hdrs: true, deny_delete: true, allow_direct: true, storage: 'file', num_replicas: 1,
  });
  assert.equal(error, undefined);
  return cluster;
}

/** Waits until a state that was stored before, and not again, has expired. */
async function expired(cluster) {
  await cluster.asked('$KV.VRUT_ROOMS.probe', 'x');
  await eventually('the end of what was stored', async () => (await cluster.asked(`$JS.API.STREAM.MSG.GET.${STATES}`, { last_by_subj: '$KV.VRUT_ROOMS.probe' })).error?.code === 404);
}

async function joined(t, cluster, hello = { name: 'Tablet', resume: 'one-tablet' }) {
  const edge = await cluster.edge();
  return ContractClient.join(t, await cluster.room(edge, 'stage'), hello);
}

async function mark(client, name) {
  const { revision } = await client.answer(client.send({ type: 'patch', patch: { markers: { [name]: { point: [1, 2, 3] } } } }));
  await client.until(name, () => client.revision >= revision, WITHIN_MS);
}

/** Drags without a pause until `doing` is done. */
async function dragging(client, doing) {
  const pointer = (event, x) => client.send({ type: `pointer${event}`, pointerId: 1, pointerType: 'touch', x, y: 150, button: event === 'move' ? -1 : 0, buttons: event === 'up' ? 0 : 1, isPrimary: true });
  let goesOn = true;
  const done = Promise.allSettled([doing()]).finally(() => (goesOn = false));
  pointer('down', 200);
  for (let i = 0; goesOn && !client.closed; ++i, await delay(50)) pointer('move', 200 + (i % 100));
  const [{ reason }] = await done;
  if (reason) throw reason;
  pointer('up', 200);
}

describe('a room at NATS', { skip: missing }, () => {
  test('keeps its state while a finger drags on and on, for servers that come later', async (t) => {
    const cluster = await nats(t, 5);
    const first = await cluster.serve('stage');
    const client = await joined(t, cluster);
    await mark(client, 'here');
    await dragging(client, async () => {
      await expired(cluster);
      const second = await cluster.serve('stage');
      await eventually('that it follows', () => second.logged('room_followed').length > 0);
      await first.stop();
      assert.equal(await cluster.owner([second]), second);
      await expired(cluster);
      const third = await cluster.serve('stage');
      await eventually('that it follows', () => third.logged('room_followed').length > 0);
      await second.stop();
      assert.equal(await cluster.owner([third]), third);
    });
    await mark(client, 'there');
    assert.deepEqual(Object.keys(client.state.markers), ['here', 'there']);
    assert.equal(client.state.control.holder, client.id);
  });

  test('is not begun by a server that has no state, while one that has it hangs', async (t) => {
    const cluster = await nats(t);
    const hangs = await cluster.serve('stage');
    const client = await joined(t, cluster);
    await mark(client, 'before');
    hangs.signal('SIGSTOP');
    assert.equal((await cluster.asked(`$JS.API.STREAM.PURGE.${STATES}`)).success, true);
    const without = await cluster.serve('stage');
    await eventually('that it waits', () => without.logged('room_waits').length > 0 || without.logged('room_taken_over').length > 0);
    assert.deepEqual(without.logged('room_taken_over'), []);
    assert.match(without.logged('room_waits')[0], /reason="NATS has the log of the room, but no state: .*serve it by another name, or wait/);
    hangs.signal('SIGCONT');
    await mark(client, 'later');
    await eventually('a state', async () => (await cluster.asked(`$JS.API.STREAM.INFO.${STATES}`)).state.messages > 0);
    await hangs.stop();
    assert.equal(await cluster.owner([without]), without);
    await mark(client, 'last');
    assert.deepEqual(Object.keys(client.state.markers), ['before', 'later', 'last']);
  });

  test('begins again where nobody has drawn it for so long that its state has expired', async (t) => {
    const cluster = await nats(t, 2);
    const first = await cluster.serve('stage');
    const client = await joined(t, cluster);
    await mark(client, 'before');
    await first.stop();
    await expired(cluster);
    const next = await cluster.serve('stage');
    assert.equal(await cluster.owner([next]), next);
    assert.deepEqual(Object.keys((await joined(t, cluster)).state.markers), []);
  });

  test('is begun by the next server where the first one has died before it did anything', async (t) => {
    const cluster = await nats(t);
    const { error } = await cluster.asked('$JS.API.STREAM.CREATE.VRUT_LOG_STAGE', { name: 'VRUT_LOG_STAGE', subjects: ['vrut.rooms.stage.log'], retention: 'limits', storage: 'file', num_replicas: 1 });
    assert.equal(error, undefined);
    for (let i = 1; i <= 2; ++i) assert.equal((await cluster.asked('vrut.rooms.stage.log')).seq, i);
    const server = await cluster.serve('stage');
    assert.equal(await cluster.owner([server]), server);
  });
});
