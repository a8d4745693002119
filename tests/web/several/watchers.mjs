// What an audience costs at one server, and at 1, 2 and 3 edges: deliveries a second, what is rendered and encoded, and
// processor time. In the environment, WATCHERS: how many, between commas; CHART: a file for a chart, as SVG. The clients
// share the machine.
import { execFileSync, spawn } from 'node:child_process';
import { readFileSync } from 'node:fs';
import { Cluster } from './cluster.js';

const WATCHERS = (process.env.WATCHERS ?? '100,300,1000').split(',').map(Number);
const BENCH = process.env.BENCH_DOORS;
const CAR = process.env.VRUT_CAR;
const SECONDS = 8;  // of a measurement, as in doors_bench.cpp

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
const DOORS = ['one server', '1 edge', '2 edges', '3 edges'];
const rows = DOORS.map(() => []);
for (const watchers of WATCHERS) {
  for (const count of [0, 1, 2, 3]) {
    const parts = [server, ...edges.slice(0, count)];
    const doors = count === 0 ? [`${new URL(server.url).port}/ws`] : edges.slice(0, count).map(({ url }) => `${new URL(url).port}/rooms/bench/ws`);
    const row = await measure(doors, watchers, parts);
    const name = DOORS[count];
    if (!row.failed) rows[count].push({ watchers, ...row });
    if (row.failed) console.log(`${name.padEnd(12)} ${String(watchers).padStart(9)} | failed: ${row.failed.slice(-300)}`);
    else console.log(`${name.padEnd(12)} ${String(watchers).padStart(9)} | ${row.changes.toFixed(1).padStart(9)} ${row.delivered.toFixed(0).padStart(11)} ${row.p50.toFixed(1).padStart(7)} ${row.p99.toFixed(1).padStart(7)} | ${String(row.rendered).padStart(8)} ${String(row.encoded).padStart(7)} | ${row.cpu.join(', ')}`);
  }
}

// Okabe and Ito's colours, which eyes tell apart that take red for green.
const COLORS = ['#0072B2', '#D55E00', '#009E73', '#CC79A7'];
const FACES = [7, 5, 9, 13];
/** One panel: a line for each number of edges. */
const panel = (title, unit, value) => `
set title '${title}' font ',14'
set ylabel '${unit}'
plot ${DOORS.map((name, i) => `'-' with linespoints lw 2 pt ${FACES[i]} ps 0.7 lc rgb '${COLORS[i]}' title '${name}'`).join(', ')}
${rows.map((all) => [...all.map((row) => `${row.watchers} ${value(row)}`), 'e'].join('\n')).join('\n')}`;
if (process.env.CHART)
  execFileSync('gnuplot', { input: `
set terminal svg size 900,380 font 'sans-serif,12' background '#ffffff' name 'watchers'
set output '${process.env.CHART}'
set multiplot layout 1,2
set logscale xy
set xlabel 'watchers'
set xtics (${WATCHERS.join(',')})
set xrange [${WATCHERS[0] / 1.2}:${WATCHERS.at(-1) * 1.2}]
set key bottom right
set grid lc rgb '#d0d0d0'
${panel('Images passed on', 'a second', (row) => row.delivered)}
set key top right
${panel('Processor time of server and edges', 'ms for each image passed on', (row) => row.cpu.reduce((sum, ms) => sum + ms) / (row.delivered * SECONDS))}
` });
for (const end of ends) await end();
process.exit(0);
