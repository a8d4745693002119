// Kills, stops and cuts off each part of a room in turn, while a finger drags: three NATS servers, two servers, two
// edges, HAProxy. Checks that nothing is lost, and prints the gaps between frames. ROUNDS in the environment: how many.
import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { writeFileSync } from 'node:fs';
import path from 'node:path';
import { setTimeout as delay } from 'node:timers/promises';
import { ContractClient } from '../contract/contract-client.js';
import { PROGRAM } from '../contract/server.js';
import { Cluster, eventually, freePort, NATS_SERVER } from './cluster.js';

const ROUNDS = Number(process.env.ROUNDS ?? 20);
const NODES = 3;

const pointer = (event, x, y) => ({ type: `pointer${event}`, pointerId: 1, pointerType: 'touch', x, y, button: event === 'move' ? -1 : 0, buttons: event === 'up' ? 0 : 1 });
const quantile = (sorted, q) => sorted[Math.min(sorted.length - 1, Math.floor(q * sorted.length))];

const ends = [];
const t = { after: (end) => ends.push(end) };
const cluster = new Cluster(t);

const nodes = [];
const ports = await Promise.all(Array.from({ length: 3 * NODES }, freePort));
const [clients, routes, monitors] = [ports.slice(0, NODES), ports.slice(NODES, 2 * NODES), ports.slice(2 * NODES)];
async function startNode(i) {
  nodes[i] = cluster.start(NATS_SERVER, '-a', '127.0.0.1', '-p', `${clients[i]}`, '-m', `${monitors[i]}`, '-js', '-sd', path.join(cluster.folder, `${i}`), '-n', `n${i}`,
    '--cluster_name', 'rounds', '--cluster', `nats://127.0.0.1:${routes[i]}`, '--routes', routes.map((port) => `nats://127.0.0.1:${port}`).join(','));
}
for (let i = 0; i < NODES; ++i) await startNode(i);
await eventually('a cluster', async () => {
  const answer = await (await fetch(`http://127.0.0.1:${monitors[0]}/jsz`)).json();
  return answer.meta_cluster?.leader && answer.meta_cluster.cluster_size === NODES;
});
await delay(2000);
cluster.url = clients.map((port) => `nats://127.0.0.1:${port}`).join(',');

const servers = [await cluster.serve('rounds'), await cluster.serve('rounds')];
const edges = [await cluster.edge(), await cluster.edge()];
const proxyPort = await freePort();
const configuration = path.join(cluster.folder, 'haproxy.cfg');
writeFileSync(configuration, `
defaults
  mode http
  timeout connect 2s
  timeout client 1h
  timeout server 1h
frontend f
  bind 127.0.0.1:${proxyPort}
  default_backend edges
backend edges
  option httpchk GET /readyz HTTP/1.1\\r\\nHost:\\ localhost
  balance source
  default-server inter 500ms fall 2 rise 1 on-marked-down shutdown-sessions
${edges.map((edge, i) => `  server e${i} ${new URL(edge.url).host} check`).join('\n')}
`);
let haproxy = cluster.start('/usr/sbin/haproxy', '-f', configuration);
const proxy = { url: `http://127.0.0.1:${proxyPort}/` };

/** The client comes back where its connection has ended, as the page does. */
const connect = async () => {
  const room = await cluster.room(proxy, 'rounds');
  const client = await eventually('a connection', () => ContractClient.join(t, room, { name: 'Tablet', resume: 'one-tablet' }));
  await client.ask({ type: 'resize', width: 320, height: 180, pixelRatio: 1 });
  return client;
};
let client = await connect();
const gaps = [], worst = [];
let lease = 0, marker = 0, reconnects = 0;

/** The edge that the client came by, whose id its name ends with. */
let edgeOfClient = edges[0];
const edge = () => edgeOfClient;
const find = () => { edgeOfClient = edges.find((each) => each.logged('joined').some((line) => line.includes(client.id))) ?? edgeOfClient; };
async function restart(ended) {
  const again = cluster.start(PROGRAM, 'edge', '--listen', new URL(ended.url).host, '--nats', cluster.url);
  await eventually('an edge', () => again.log.includes('listening on'));
  return Object.assign(again, { url: ended.url });
}

for (let round = 0; round < ROUNDS; ++round) {
  const owner = await cluster.owner(servers);
  const parts = [
    ['the owner, killed', async () => { await owner.stop(); }, async () => { servers[servers.indexOf(owner)] = await cluster.serve('rounds'); }],
    ['the owner, stopped for 4 s', async () => { owner.signal('SIGSTOP'); await delay(4000); owner.signal('SIGCONT'); }, async () => {}],
    ['the server that stands by, killed', async () => { await servers.find((each) => each !== owner).stop(); }, async () => { servers[servers.findIndex((each) => each !== owner)] = await cluster.serve('rounds'); }],
    [`NATS ${round % NODES}, killed`, async () => { await nodes[round % NODES].stop(); await delay(1500); }, async () => { await startNode(round % NODES); }],
    [`NATS ${round % NODES}, stopped for 4 s`, async () => { nodes[round % NODES].signal('SIGSTOP'); await delay(4000); nodes[round % NODES].signal('SIGCONT'); }, async () => {}],
    ["the client's edge, killed", async () => { await edge().stop(); }, async () => { edges[edges.indexOf(edge())] = await restart(edge()); }],
    ["the client's edge, stopped for 4 s", async () => { const own = edge(); own.signal('SIGSTOP'); await delay(4000); own.signal('SIGCONT'); }, async () => {}],
    ['HAProxy, killed', async () => { await haproxy.stop(); await delay(500); haproxy = cluster.start('/usr/sbin/haproxy', '-f', configuration); }, async () => {}],
  ];
  find();
  const [what, fail, mend] = parts[round % parts.length];
  const failing = (async () => { await delay(700); await fail(); })();
  const end = Date.now() + 8000;
  let last = Date.now(), most = 0, at = client.frames.length;
  client.send(pointer('down', 160, 90));
  client.send({ type: 'frame' });
  for (let i = 0; Date.now() < end; ++i, await delay(16)) {
    if (client.closed) {
      ++reconnects;
      client = await connect();
      at = client.frames.length;
      client.send(pointer('down', 160, 90));
      client.send({ type: 'frame' });
    }
    client.send(pointer('move', 160 + 60 * Math.sin(i / 20), 90 + 30 * Math.sin(i / 13)));
    for (; at < client.frames.length; ++at) {
      const frame = client.frames[at];
      gaps.push(frame.at - last);
      most = Math.max(most, frame.at - last);
      last = frame.at;
      assert.ok(frame.header.lease >= lease, `lease ${frame.header.lease} after ${lease}`);
      lease = frame.header.lease;
      client.send({ type: 'frame' });
    }
  }
  client.send(pointer('up', 160, 90));
  await failing;
  await mend();
  // What was answered is there, once, whoever draws the room now.
  const name = `m${++marker}`;
  const answer = client.send({ type: 'patch', patch: { markers: { [name]: { point: [marker, 0, 0] } } } });
  await client.until(`the answer to ${name}`, () => client.texts.find((text) => text.id === answer), 20_000);
  assert.equal(Object.keys(client.state.markers).length, marker, what);
  const camera = JSON.stringify(client.state.camera);
  const watcher = await eventually('a watcher', () => cluster.room(proxy, 'rounds').then((room) => ContractClient.join(t, room, { role: 'view' })));
  assert.equal(JSON.stringify(watcher.state.camera), camera, what);
  await watcher.leave();
  worst.push(most);
  console.log(`${String(round + 1).padStart(2)}  ${what.padEnd(34)} longest gap ${String(most).padStart(5)} ms, lease ${lease}`);
}
// The camera is the replay's: a server that only followed the log takes over.
const camera = JSON.stringify(client.state.camera);
const owner = await cluster.owner(servers);
await owner.stop();
await cluster.owner(servers.filter((each) => each !== owner));
await client.until('the answer of the last server', () => client.state, 20_000);
await client.barrier().catch(() => client.barrier());
assert.equal(JSON.stringify(client.state.camera), camera);

gaps.sort((a, b) => a - b);
worst.sort((a, b) => a - b);
console.log(`${gaps.length} frames in ${ROUNDS} rounds, ${reconnects} reconnects`);
console.log(`gap between frames: p50 ${quantile(gaps, 0.5)} ms, p99 ${quantile(gaps, 0.99)} ms, longest ${gaps.at(-1)} ms`);
console.log(`longest gap of a round: p50 ${quantile(worst, 0.5)} ms, p99 ${quantile(worst, 0.99)} ms`);
for (const end of ends.reverse()) await Promise.race([end(), delay(3000)]);
process.exit(0);
