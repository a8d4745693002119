// What an audience costs at one server, and at 1, 2 and 3 edges: deliveries a second, what is rendered and encoded, and
// processor time. WATCHERS in the environment: how many, between commas. The clients share the machine.
import { spawn } from 'node:child_process';
import { readFileSync } from 'node:fs';
import { Cluster } from './cluster.js';

const WATCHERS = (process.env.WATCHERS ?? '100,300,1000').split(',').map(Number);
const BENCH = process.env.BENCH_DOORS;
const CAR = process.env.VRUT_CAR;

const ends = [];
const cluster = new Cluster({ after: (end) => ends.push(end) });
await cluster.startNats();
const server = await cluster.serve('bench', { scene: CAR, options: ['--max-clients', '2000', '--log-level', 'error'] });
const edges = [];
for (let i = 0; i < 3; ++i) edges.push(await cluster.edge('--max-clients', '2000', '--log-level', 'error'));
await cluster.room(edges[0], 'bench');

const cpu = ({ child }) => {
  const fields = readFileSync(`/proc/${child.pid}/stat`, 'utf8').split(') ')[1].split(' ');
  return (Number(fields[11]) + Number(fields[12])) * 10;
};
async function counters(url) {
  const text = await (await fetch(`${url}metrics`)).text();
  const value = (name) => [...text.matchAll(new RegExp(`^vrut_preview_${name}(?:{[^}]*})? (\\S+)$`, 'gm'))].reduce((sum, [, number]) => sum + Number(number), 0);
  return { rendered: value('frames_rendered_total'), encoded: value('frames_encoded_total'), sent: value('frames_sent_total') };
}

async function measure(doors, watchers, parts) {
  const child = spawn(BENCH, [], { env: { ...process.env, VRUT_DOORS: doors.join(','), VRUT_WATCHERS: `${watchers}` } });
  let text = '', before;
  child.stdout.setEncoding('utf8');
  const at = async () => ({ server: await counters(server.url), cpu: parts.map(cpu) });
  for await (const chunk of child.stdout) {
    text += chunk;
    if (!before && text.includes('begun')) before = await at();
  }
  const after = await at();
  const found = JSON.parse(/\{.*\}/.exec(text)?.[0] ?? `{"failed":${JSON.stringify(text)}}`);
  return { ...found, rendered: after.server.rendered - before.server.rendered, encoded: after.server.encoded - before.server.encoded, cpu: after.cpu.map((ms, i) => ms - before.cpu[i]) };
}

console.log('              watchers | changes/s delivered/s  p50 ms  p99 ms | rendered encoded | CPU ms: server, edges');
for (const watchers of WATCHERS) {
  for (const count of [0, 1, 2, 3]) {
    const parts = [server, ...edges.slice(0, count)];
    const doors = count === 0 ? [`${new URL(server.url).port}/ws`] : edges.slice(0, count).map(({ url }) => `${new URL(url).port}/rooms/bench/ws`);
    const row = await measure(doors, watchers, parts);
    const name = count === 0 ? 'one server' : `${count} edge${count > 1 ? 's' : ''}`;
    if (row.failed) console.log(`${name.padEnd(12)} ${String(watchers).padStart(9)} | failed: ${row.failed.slice(-300)}`);
    else console.log(`${name.padEnd(12)} ${String(watchers).padStart(9)} | ${row.changes.toFixed(1).padStart(9)} ${row.delivered.toFixed(0).padStart(11)} ${row.p50.toFixed(1).padStart(7)} ${row.p99.toFixed(1).padStart(7)} | ${String(row.rendered).padStart(8)} ${String(row.encoded).padStart(7)} | ${row.cpu.join(', ')}`);
  }
}
for (const end of ends) await end();
process.exit(0);
