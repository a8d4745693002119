// Our pictures beside VTK's, as its web application makes them (vtkWebApplication.StillRender): the same model, orbit,
// light and size, in turns in one run, since machines drift. Prints medians and ratios, and whether they meet what we
// want; --csv FILE writes them, too. VRUT_TEST_PEERS names the folder with the peer's driver and the generator of the
// model; without it, or without VTK, there is nothing to measure: exit status 77.
//
//   VRUT_TEST_PEERS=... BENCH_FRAMES=build/release/tests/bench/bench_frames node tests/bench/peers.mjs [--csv FILE]
import { execFileSync, spawn, spawnSync } from 'node:child_process';
import { mkdtempSync, readdirSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { createInterface } from 'node:readline';
import { startDisplay } from './display.mjs';

const SKIPPED = 77;
const SIZE = '1280x720';
const ROUNDS = 3;
const PYTHON = '/usr/bin/python3'; // that of Debian's packages
const PACKAGES = 'python3-paraview paraview python3-numpy xvfb xauth';

const MODELS = [
  { name: '50 k', triangles: 50_000, steps: 12, peerSteps: 6 },
  { name: '500 k', triangles: 500_000, steps: 12, peerSteps: 6 },
  { name: '5 M', triangles: 5_000_000, steps: 4, peerSteps: 2 },
];
/** What of the peer's time we want to be how many times faster, for each model. */
const WAYS = [
  { name: 'every triangle', order: 'frames 0 1 85', goals: [2, 1.5, 1.4] },
  { name: 'still, detail 0.5', order: 'frames 0.5 1 85', goals: [3, 4, 8] },
  { name: 'moving, half size, detail 1', order: 'frames 1 0.5 75', goals: [4.5, 6, 10] },
];
const LEAST_PSNR = 45; // dB
const MOST_ABOVE_8 = 0.2; // % of the pixels
const MOST_OVER_DRAWING = 1.1; // a whole frame of its drawing, from 500 k triangles on

/** One of our processes, which answers orders one by one. */
class Ours {
  constructor(file, steps, ...options) {
    this.process = spawn(process.env.BENCH_FRAMES, [file, SIZE, String(steps), ...options], { stdio: ['pipe', 'pipe', 'inherit'] });
    this.lines = createInterface({ input: this.process.stdout })[Symbol.asyncIterator]();
  }

  async answer() {
    const { value, done } = await this.lines.next();
    if (done) throw new Error('bench_frames has ended');
    return numbers(value);
  }

  ask(order) {
    this.process.stdin.write(`${order}\n`);
    return this.answer();
  }

  async end() {
    this.process.stdin.end();
    if (this.process.exitCode === null) await new Promise((resolve) => this.process.once('exit', resolve));
  }
}

const peers = process.env.VRUT_TEST_PEERS;
if (!peers) skip('VRUT_TEST_PEERS is not set: it names the folder with the driver of VTK and the generator of the model.');
if (spawnSync(PYTHON, ['-c', 'from vtkmodules.vtkWebCore import vtkWebApplication']).status !== 0 || spawnSync('sh', ['-c', 'command -v Xvfb']).status !== 0)
  skip(`VTK is not there: apt-get install --no-install-recommends ${PACKAGES}`);

const folder = mkdtempSync(join(tmpdir(), 'peers-'));
const display = await startDisplay();
const rows = [];
try {
  const generator = join(folder, 'generator');
  execFileSync(process.env.CXX ?? 'c++', ['-O2', '-o', generator, join(peers, 'car_generator.cpp')]);
  for (const [index, model] of MODELS.entries()) await measure(model, index, generator);
  print();
} finally {
  display.process.kill();
  rmSync(folder, { recursive: true });
}

function skip(why) {
  console.log(`skipped: ${why}`);
  process.exit(SKIPPED);
}

/** Adds the rows of one model. */
async function measure(model, index, generator) {
  const file = generate(model, generator);
  const peer = [];
  const bare = []; // without levels of detail
  const withLevels = [];
  const ways = WAYS.map(() => []);
  const ours = new Ours(file, model.steps, '--levels');
  withLevels.push(await ours.answer());
  for (let round = 0; round < ROUNDS; round += 1) {
    for (const [way, { order }] of WAYS.entries()) {
      ways[way].push(await ours.ask(order));
      if (way === 0) peer.push(runPeer(file, model.peerSteps));
    }
    bare.push(await firstPicture(file));
    if (round > 0) withLevels.push(await firstPicture(file, '--levels'));
  }
  const still = WAYS[1].order.split(' ')[1];
  const { psnr, above8 } = await ours.ask(`compare ${still}`);
  await ours.end();

  const every = median(ways[0], 'frame');
  const theirs = median(peer, 'StillRender');
  for (const [way, { name, goals }] of WAYS.entries()) {
    const ms = median(ways[way], 'frame');
    row(model, `${name}, ms`, ms, theirs, theirs / ms, '≥', goals[index]);
  }
  row(model, `detail ${still}: dB`, psnr, NaN, psnr, '≥', LEAST_PSNR);
  row(model, `detail ${still}: % of pixels off by more than 8`, above8, NaN, above8, '≤', MOST_ABOVE_8);
  const drawing = median(ways[0], 'draw');
  row(model, 'whole frame of its drawing, ms', every, drawing, every / drawing, '≤', index > 0 ? MOST_OVER_DRAWING : NaN);
  const first = median(bare, 'start_to_first');
  const [peak, peerPeak] = [median(bare, 'peak'), median(peer, 'rss')];
  row(model, 'peak memory, MB', peak, peerPeak, peak / peerPeak, '≤', index === 2 ? 1 : NaN);
  row(model, 'file to first picture, ms', first, median(peer, 'load') + median(peer, 'firstrender'), NaN, '', NaN);
  const delayed = median(withLevels, 'start_to_first');
  row(model, 'the same while levels are made, beside without, ms', delayed, first, delayed / first, '', NaN);
  row(model, 'bytes of a JPEG file', median(ways[0], 'bytes'), median(peer, 'bytes'), NaN, '', NaN);
}

/** @returns {string} the model's file; what else the generator writes is removed */
function generate({ triangles }, generator) {
  const name = `car${triangles}`;
  execFileSync(generator, [String(triangles), join(folder, name)]);
  for (const other of readdirSync(folder)) if (other.startsWith('car') && other !== `${name}.glb`) rmSync(join(folder, other));
  return join(folder, `${name}.glb`);
}

async function firstPicture(file, ...options) {
  const ours = new Ours(file, 1, ...options);
  const answer = await ours.answer();
  await ours.end();
  return answer;
}

function runPeer(file, steps) {
  const { stdout, stderr } = spawnSync(PYTHON, [join(peers, 'vtk_peer.py'), file, SIZE, String(steps)], {
    encoding: 'utf8',
    env: { ...process.env, DISPLAY: display.name, LIBGL_ALWAYS_SOFTWARE: '1' },
  });
  if (!stdout.includes('StillRender')) throw new Error(`VTK does not tell its times: ${stderr}`);
  return numbers(stdout);
}

/** @returns {Object<string, number>} of "name number name number …" */
function numbers(line) {
  return Object.fromEntries([...line.matchAll(/(\w+) (-?[\d.]+|inf)/g)].map(([, name, number]) => [name, number === 'inf' ? Infinity : Number(number)]));
}

function median(runs, name) {
  const values = runs.map((run) => run[name]).sort((a, b) => a - b);
  const middle = values.length >> 1;
  return values.length % 2 ? values[middle] : (values[middle - 1] + values[middle]) / 2;
}

function row({ name: model }, what, ours, theirs, ratio, sense, goal) {
  let verdict = '';
  if (!Number.isNaN(goal)) verdict = (sense === '≥' ? ratio >= goal : ratio <= goal) ? 'met' : 'NOT met';
  rows.push({ model, what, ours, theirs, ratio, goal: Number.isNaN(goal) ? '' : `${sense} ${goal}`, verdict });
}

function print() {
  const text = (value) => (typeof value === 'string' ? value : Number.isNaN(value) ? '' : value.toFixed(Math.abs(value) < 10 ? 2 : 1));
  const columns = Object.keys(rows[0]);
  const table = [columns, ...rows.map((of) => columns.map((column) => text(of[column])))];
  const widths = columns.map((_, i) => Math.max(...table.map((line) => line[i].length)));
  console.log(`${SIZE}, quality 85 (moving 75), medians of ${ROUNDS} rounds in turns with VTK's StillRender`);
  for (const line of table) console.log(line.map((cell, i) => (i < 2 || i > 4 ? cell.padEnd(widths[i]) : cell.padStart(widths[i]))).join('  '));
  const csv = process.argv.indexOf('--csv');
  if (csv > 0) writeFileSync(process.argv[csv + 1], `${table.map((line) => line.map((cell) => (cell.includes(',') ? `"${cell}"` : cell)).join(',')).join('\n')}\n`);
}
