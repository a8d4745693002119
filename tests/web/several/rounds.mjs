// Kills, stops and cuts off each part of a room in turn, while a finger drags: three NATS servers, two servers, two
// edges, HAProxy, each on a machine of its own (a network namespace, with a cable to one bridge). Checks that nothing is
// lost, and prints the gaps between frames. ROUNDS in the environment: how many, one after the other.
import assert from 'node:assert/strict';
import { execFileSync, spawn, spawnSync } from 'node:child_process';
import { once } from 'node:events';
import { writeFileSync } from 'node:fs';
import path from 'node:path';
import { setTimeout as delay } from 'node:timers/promises';
import { ContractClient } from '../contract/contract-client.js';
import { PROGRAM } from '../contract/server.js';
import { Cluster, eventually, NATS_SERVER } from './cluster.js';

const INSIDE = '--inside';
if (!process.argv.includes(INSIDE)) {
  // Networks of its own, which end with it.
  const { status } = spawnSync('unshare', ['-rn', process.execPath, process.argv[1], INSIDE], { stdio: 'inherit' });
  process.exit(status ?? 1);
}

const ROUNDS = Number(process.env.ROUNDS ?? 24);
const NODES = 3;
const AWAY_MS = 4000, RESTART_MS = 1500, DRAG_MS = 8000, ANSWER_WITHIN_MS = 20_000;
const TOKEN = 'only-for-these-rounds';
const PORT = 8080;

const pointer = (event, x, y) => ({ type: `pointer${event}`, pointerId: 1, pointerType: 'touch', x, y, button: event === 'move' ? -1 : 0, buttons: event === 'up' ? 0 : 1 });
const quantile = (sorted, q) => sorted[Math.min(sorted.length - 1, Math.floor(q * sorted.length))];

// --- machines

const ip = (...words) => execFileSync('ip', words);
ip('link', 'set', 'lo', 'up');
ip('link', 'add', 'name', 'bridge', 'type', 'bridge');
ip('address', 'add', '10.77.0.1/24', 'dev', 'bridge');
ip('link', 'set', 'bridge', 'up');
let machines = 1;

async function machine() {
  const number = ++machines;
  const cable = `cable${number}`, plug = `plug${number}`, address = `10.77.0.${number}`;
  const holder = spawn('unshare', ['-n', 'sh', '-c', 'echo here; exec sleep infinity']);
  process.on('exit', () => holder.kill('SIGKILL'));
  await once(holder.stdout, 'data');
  const enter = ['nsenter', '-t', `${holder.pid}`, '-n'];
  ip('link', 'add', 'name', cable, 'type', 'veth', 'peer', 'name', plug);
  ip('link', 'set', plug, 'netns', `${holder.pid}`);
  ip('link', 'set', cable, 'master', 'bridge', 'up');
  for (const command of [['address', 'add', `${address}/24`, 'dev', plug], ['link', 'set', plug, 'up'], ['link', 'set', 'lo', 'up']]) execFileSync(enter[0], [...enter.slice(1), 'ip', ...command]);
  return { address, enter, cut: () => ip('link', 'set', cable, 'down'), mend: () => ip('link', 'set', cable, 'up') };
}

// --- the room's parts

const ends = [];
const t = { after: (end) => ends.push(end) };
const cluster = new Cluster(t);

const nodes = [];
for (let i = 0; i < NODES; ++i) nodes.push({ machine: await machine(), name: `NATS ${i}` });
const routes = nodes.map(({ machine: { address } }) => `nats://${address}:6222`).join(',');
for (const node of nodes)
  node.start = () => {
    const { address } = node.machine;
    node.process = cluster.startOn(node.machine, NATS_SERVER, '-a', address, '-p', '4222', '-m', '8222', '-js', '-sd', path.join(cluster.folder, address), '-n', node.name.replace(' ', ''),
      '--cluster_name', 'rounds', '--cluster', `nats://${address}:6222`, '--routes', routes);
  };
for (const node of nodes) node.start();
await eventually('a cluster', async () => {
  const answer = await (await fetch(`http://${nodes[0].machine.address}:8222/jsz`)).json();
  return answer.meta_cluster?.leader && answer.meta_cluster.cluster_size === NODES;
});
await delay(2000);
cluster.url = nodes.map(({ machine: { address } }) => `nats://${address}:4222`).join(',');

const tokens = path.join(cluster.folder, 'tokens.json');
writeFileSync(tokens, JSON.stringify({ control: TOKEN }), { mode: 0o600 });
cluster.headers = { Authorization: `Bearer ${TOKEN}` };
const servers = [{ machine: await machine() }, { machine: await machine() }];
for (const server of servers) {
  server.start = async () => {
    server.process = await cluster.serve('rounds', { machine: server.machine, options: ['--token-file', tokens] });
  };
  await server.start();
}
const owner = async () => {
  const drawing = await cluster.owner(servers.map((server) => server.process));
  return servers.find((server) => server.process === drawing);
};

const edges = [{ machine: await machine() }, { machine: await machine() }];
for (const edge of edges) {
  edge.start = async () => {
    edge.process = await cluster.edgeOn(edge.machine, `${edge.machine.address}:${PORT}`, '--token-file', tokens);
  };
  await edge.start();
}

const haproxy = { machine: await machine() };
const configuration = path.join(cluster.folder, 'haproxy.cfg');
writeFileSync(configuration, `
defaults
  mode http
  timeout connect 2s
  timeout client 1h
  timeout server 1h
frontend f
  bind ${haproxy.machine.address}:${PORT}
  default_backend edges
backend edges
  option httpchk
  http-check send meth GET uri /readyz ver HTTP/1.1 hdr Host localhost hdr Authorization "Bearer ${TOKEN}"
  balance source
  default-server inter 500ms fall 2 rise 1 on-marked-down shutdown-sessions
${edges.map((edge, i) => `  server e${i} ${edge.machine.address}:${PORT} check`).join('\n')}
`);
haproxy.start = () => {
  haproxy.process = cluster.startOn(haproxy.machine, '/usr/sbin/haproxy', '-f', configuration);
};
haproxy.start();
const proxy = { url: `http://${haproxy.machine.address}:${PORT}/` };

// --- who uses it

/** The client comes back where its connection has ended, as the page does. */
const connect = () => eventually('a connection', async () => {
  const joined = await ContractClient.join(t, await cluster.room(proxy, 'rounds'), { name: 'Tablet', resume: 'one-tablet', token: TOKEN });
  await joined.ask({ type: 'resize', width: 320, height: 180, pixelRatio: 1 });
  return joined;
});
const everything = () => [...servers, ...edges, haproxy].map((part) => part.process.log).join('\n---\n');
let client = await connect().catch((error) => {
  console.log(everything());
  throw error;
});
const gaps = [], worst = [];
let lease = 0, reconnects = 0;
const marked = [];

/** Drags while something is done to a part. @returns the longest time without a frame */
async function drag() {
  const end = Date.now() + DRAG_MS;
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
  return most;
}

/** A marker that is answered is there, once, whoever draws the room now, and so are those before it. */
async function mark(what) {
  const name = `m${marked.length + 1}`;
  // Who loses the connection before the answer comes back and asks again.
  for (let answered = false; !answered; ) {
    if (client.closed) {
      ++reconnects;
      client = await connect();
    }
    const answer = client.send({ type: 'patch', patch: { markers: { [name]: { point: [marked.length, 0, 0] } } } });
    answered = await client.until(`the answer to ${name}`, () => client.texts.find((text) => text.id === answer), ANSWER_WITHIN_MS).catch((error) => {
      if (!client.closed) throw error;
    });
  }
  marked.push(name);
  assert.deepEqual(new Set(Object.keys(client.state.markers)), new Set(marked), what);
  const camera = JSON.stringify(client.state.camera);
  const watcher = await eventually('a watcher', async () => ContractClient.join(t, await cluster.room(proxy, 'rounds'), { role: 'view', token: TOKEN }));
  assert.equal(JSON.stringify(watcher.state.camera), camera, what);
  await watcher.leave();
}

const harms = [
  ['killed', async (part) => {
    await part.process.stop();
    await delay(RESTART_MS);
    await part.start();
  }],
  ['stopped', async (part) => {
    part.process.signal('SIGSTOP');
    await delay(AWAY_MS);
    part.process.signal('SIGCONT');
  }],
  ['cut off', async (part) => {
    part.machine.cut();
    await delay(AWAY_MS);
    part.machine.mend();
  }],
];
const clientsEdge = () => edges.find((edge) => edge.process.logged('joined').some((line) => line.includes(client.id))) ?? edges[0];
const other = (all, one) => all.find((each) => each !== one);
const parts = [
  ['the owner', owner],
  ['the server that stands by', async () => other(servers, await owner())],
  ...nodes.map((node) => [node.name, () => node]),
  ["the client's edge", clientsEdge],
  ['the other edge', () => other(edges, clientsEdge())],
  ['HAProxy', () => haproxy],
];

try {
  for (let round = 0; round < ROUNDS; ++round) {
    const [name, choose] = parts[round % parts.length];
    const [harm, fail] = harms[Math.floor(round / parts.length) % harms.length];
    const what = `${name}, ${harm}`;
    const part = await choose();
    const failing = delay(700).then(() => fail(part));
    const most = await drag();
    await failing;
    await mark(what);
    worst.push(most);
    console.log(`${String(round + 1).padStart(2)}  ${what.padEnd(34)} longest gap ${String(most).padStart(5)} ms, lease ${lease}`);
  }
  // The camera is the replay's: a server that only followed the log takes over.
  const camera = JSON.stringify(client.state.camera);
  await (await owner()).process.stop();
  await owner();
  await client.until('the answer of the last server', () => client.state, ANSWER_WITHIN_MS);
  await client.barrier().catch(() => client.barrier());
  assert.equal(JSON.stringify(client.state.camera), camera);
} catch (error) {
  console.log(everything());
  throw error;
}

gaps.sort((a, b) => a - b);
worst.sort((a, b) => a - b);
console.log(`${gaps.length} frames in ${ROUNDS} rounds, ${reconnects} reconnects`);
console.log(`gap between frames: p50 ${quantile(gaps, 0.5)} ms, p99 ${quantile(gaps, 0.99)} ms, longest ${gaps.at(-1)} ms`);
console.log(`longest gap of a round: p50 ${quantile(worst, 0.5)} ms, p99 ${quantile(worst, 0.99)} ms`);
for (const end of ends.reverse()) await Promise.race([end(), delay(3000)]);
process.exit(0);
