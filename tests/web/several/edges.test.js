// What an edge does when a part beside it fails, and what it does not let pass.
import assert from 'node:assert/strict';
import { chmodSync, writeFileSync } from 'node:fs';
import { connect } from 'node:net';
import path from 'node:path';
import { describe, test } from 'node:test';
import { setTimeout as delay } from 'node:timers/promises';
import { ContractClient } from '../contract/contract-client.js';
import { PROGRAM, temporaryFolder } from '../contract/server.js';
import examplesOfHelp from '../../commands/examples.js';
import { Cluster, eventually, missing } from './cluster.js';

const WITHIN_MS = 15_000;
const TOKENS = { control: 'control-token-0123456789', view: 'view-token-0123456789ab' };

async function stage(t, options = []) {
  const cluster = new Cluster(t);
  const nats = await cluster.startNats();
  const server = await cluster.serve('stage', { options });
  const edge = await cluster.edge();
  return { cluster, nats, server, edge };
}

/** Says something on a subject, as who has the right to use NATS can. */
async function publish(cluster, subject, text) {
  const socket = connect(cluster.port, '127.0.0.1');
  socket.write(`CONNECT {"verbose":false}\r\nPUB ${subject} ${Buffer.byteLength(text)}\r\n${text}\r\nPING\r\n`);
  await new Promise((resolve) => socket.on('data', (data) => data.toString().includes('PONG') && resolve()));
  socket.destroy();
}

const marker = (name) => ({ markers: { [name]: { point: [1, 2, 3] } } });
const answered = (client, id) => client.until('the answer', () => client.texts.find((text) => text.id === id), WITHIN_MS);

describe('an edge', { skip: missing }, () => {
  for (const [what, away, back] of [
    ['hangs', (nats) => nats.signal('SIGSTOP'), (nats) => nats.signal('SIGCONT')],
    ['is killed and started again', (nats) => nats.stop(), (nats, cluster) => cluster.startNats()],
  ]) {
    test(`recovers when NATS ${what}, and presenters at the server's own door go on meanwhile`, async (t) => {
      const { cluster, nats, server, edge } = await stage(t);
      const room = await cluster.room(edge, 'stage');
      const there = await ContractClient.join(t, room);
      await there.patch(marker('before'));
      const door = { url: server.url, ws: `${server.url}ws`.replace('http', 'ws'), schema: room.schema };
      const here = await ContractClient.join(t, door);
      await away(nats);
      await here.ask({ type: 'control', action: 'take' });
      for (let i = 0; i < 4; ++i, await delay(500)) await here.patch(marker(`here${i}`));
      await eventually('that the edge says so', async () => (await fetch(`${room.url}readyz`)).status === 503, WITHIN_MS);
      await there.until('that its clients are told', () => there.texts.find((text) => text.type === 'error' && /what you do is done when one does again/.test(text.message)), WITHIN_MS);
      const id = there.send({ type: 'control', action: 'take' });
      await here.frame();
      await back(nats, cluster);
      await answered(there, id);
      assert.equal(there.state.control.holder, there.id);
      assert.ok(there.state.markers.here3 && there.state.markers.before, 'the state has all');
      await there.frame();
      await eventually('that the edge is ready', async () => (await fetch(`${room.url}readyz`)).ok, WITHIN_MS);
    });
  }

  test('that dies takes its clients with it; they come back by another, and have control again', async (t) => {
    const { cluster, edge } = await stage(t);
    const client = await ContractClient.join(t, await cluster.room(edge, 'stage'), { name: 'Tablet', resume: 'one-tablet' });
    const other = await cluster.edge();
    const room = await cluster.room(other, 'stage');
    await edge.stop();
    await client.until('the end', () => client.closed);
    const again = await ContractClient.join(t, room, { name: 'Tablet', resume: 'one-tablet' });
    assert.equal(again.state.control.holder, again.id);
    await again.until('the end of the former one', () => Object.keys(again.state.clients).length === 1, WITHIN_MS);
  });

  test('lets nobody steer without the control token, and neither does the server let an edge', async (t) => {
    const file = path.join(temporaryFolder(), 'tokens');
    writeFileSync(file, JSON.stringify(TOKENS));
    chmodSync(file, 0o600);
    const { cluster, server, edge } = await stage(t, ['--token-file', file]);
    const room = await cluster.room(edge, 'stage');
    await assert.rejects(ContractClient.join(t, room), /ended \(1008\)/);
    const watcher = await ContractClient.join(t, room, { token: TOKENS.view });
    assert.equal(watcher.welcome.role, 'view');
    const client = await ContractClient.join(t, room, { token: TOKENS.control, name: 'Tablet' });
    const before = JSON.stringify(client.state);
    const forged = { client: 'c9.forged', role: 'control' };
    const say = (message) => publish(cluster, 'vrut.rooms.stage.in', JSON.stringify({ edge: 'forged', ...message }));
    await say({ type: 'sync', version: 1, clients: [forged, { ...forged, client: 'c8.forged', token: TOKENS.view }] });
    for (const name of [forged.client, 'c8.forged', client.id]) {
      await say({ type: 'said', client: name, sequence: 2, text: JSON.stringify({ type: 'patch', patch: marker('forged') }) });
    }
    await client.barrier();
    assert.equal(JSON.stringify(client.state), before);
    assert.deepEqual(server.logged('invalid_relay'), []);
  });

  test('and the server say in a sentence what is wrong on a subject, and go on', async (t) => {
    const { cluster, server, edge } = await stage(t);
    const client = await ContractClient.join(t, await cluster.room(edge, 'stage'));
    const before = JSON.stringify(client.state);
    const edge_id = client.id.split('.')[1];
    for (const text of ['', '\0', 'no JSON', '[]', '{}', '{"edge":"x","type":"none"}', '{"edge":"x","type":"said","client":"c","sequence":-1,"text":""}', `{"edge":"${edge_id}","type":"sync","version":99,"clients":[]}`, 'x'.repeat(600_000)]) {
      await publish(cluster, 'vrut.rooms.stage.in', text);
      await publish(cluster, 'vrut.rooms.stage.out', text);
    }
    await client.barrier();
    assert.equal(JSON.stringify(client.state), before);
    await eventually('a sentence of the server', () => server.logged('invalid_relay')[0]?.includes('reason="'));
    await eventually('a sentence of the edge', () => edge.logged('invalid_relay')[0]?.includes('reason="'));
    assert.ok(server.logged('invalid_relay').length <= 2, 'once in a while');
  });

  for (const example of examplesOfHelp.examples('edge')) {
    test(`example: ${example}`, async (t) => {
      const cluster = new Cluster(t);
      await cluster.startNats();
      const words = example.replace('nats://127.0.0.1', cluster.url).replace(/(--listen \S+):\d+/, '$1:0').split(' ');
      assert.equal(words.shift(), 'vrut-preview');
      if (!words.includes('--listen')) words.push('--listen', words.includes('--lan') ? '0.0.0.0:0' : '127.0.0.1:0');
      const edge = cluster.start(PROGRAM, ...words);
      await eventually('an address', () => /listening on https?:\S+rooms\/NAME\//.test(edge.log));
      assert.equal(await edge.stop('SIGTERM'), 0);
    });
  }

  test('says that no server draws a room, and goes to a page of a room by its name alone', async (t) => {
    const cluster = new Cluster(t);
    await cluster.startNats();
    const edge = await cluster.edge();
    const schema = { complaint: () => undefined };
    await assert.rejects(ContractClient.join(t, { ws: `${edge.url}rooms/nobody/ws`.replace('http', 'ws'), schema }), /no server draws the room 'nobody' now/);
    const redirected = await fetch(`${edge.url}rooms/nobody`, { redirect: 'manual' });
    assert.deepEqual([redirected.status, redirected.headers.get('location')], [308, '/rooms/nobody/']);
    assert.match(await (await fetch(`${edge.url}rooms/nobody/`)).text(), /<title>VRUT Preview<\/title>/);
    for (const route of ['', 'index.html', 'rooms/', 'rooms/Nobody/', 'rooms/a_b/ws', 'ws', 'frame.jpg']) assert.equal((await fetch(edge.url + route)).status, 404, route);
    assert.equal((await fetch(`${edge.url}rooms/nobody/frame.jpg`)).status, 503);
    assert.equal((await fetch(`${edge.url}readyz`)).status, 200);
    const metrics = await (await fetch(`${edge.url}metrics`)).text();
    assert.match(metrics, /^vrut_preview_nats_connected 1$/m);
    assert.match(metrics, /^vrut_preview_rooms_open 1$/m);
  });
});
