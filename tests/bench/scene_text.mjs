// Scene text beside assimp's reader of OBJ: the same geometry with the same digits, in turns in one run, since machines
// drift. Prints medians, the ratio of the times and of our peak of memory to what is drawn, and whether they meet what
// we want; --csv FILE writes them, too. VRUT_TEST_PEERS names the folder with the generator of the model; without it
// there is nothing to measure: exit status 77.
//
//   VRUT_TEST_PEERS=... BENCH_SCENE_TEXT=build/release/tests/bench/bench_scene_text node tests/bench/scene_text.mjs
import { execFileSync } from 'node:child_process';
import { mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';

const SKIPPED = 77;
const ROUNDS = 7;
const MODELS = [
  { name: '1 M', triangles: 1_000_000 },
  { name: '5 M', triangles: 5_000_000 },
];
const LEAST_RATIO = 5; // of assimp's time to ours
const MOST_OVER_DRAWN = 2.5; // our peak of memory, of the arrays that are drawn

const peers = process.env.VRUT_TEST_PEERS;
if (!peers) {
  console.log('skipped: VRUT_TEST_PEERS is not set: it names the folder with the generator of the model.');
  process.exit(SKIPPED);
}

const folder = mkdtempSync(join(tmpdir(), 'scene-text-'));
const rows = [];
try {
  const generator = join(folder, 'generator');
  execFileSync(process.env.CXX ?? 'c++', ['-O2', '-o', generator, join(peers, 'car_generator.cpp')]);
  for (const model of MODELS) measure(model, generator);
  print();
} finally {
  rmSync(folder, { recursive: true });
}

/** Adds the rows of one model. */
function measure({ name, triangles }, generator) {
  const model = join(folder, `car${triangles}`);
  execFileSync(generator, [String(triangles), model]);
  run('convert', `${model}.obj`, `${model}.vrut`);
  const runs = { ours: [], parts: [], sum: [], peer: [] };
  for (let round = 0; round < ROUNDS; round += 1)
    for (const step of Object.keys(runs)) runs[step].push(run(step, `${model}.${step === 'peer' ? 'obj' : 'vrut'}`));
  for (const ending of ['bin', 'glb', 'mtl', 'obj', 'ply', 'vrut']) rmSync(`${model}.${ending}`);

  const [ours, peer] = [median(runs.ours, 'ms'), median(runs.peer, 'ms')];
  const drawn = runs.ours[0].drawn;
  row(name, 'read, ms', ours, peer, peer / ours, '≥', LEAST_RATIO);
  row(name, 'of this up to the linked scene, ms', median(runs.parts, 'ms'));
  row(name, 'read again for its SHA-256, ms', median(runs.sum, 'ms'));
  row(name, 'processor time, ms', median(runs.ours, 'cpu'), median(runs.peer, 'cpu'), median(runs.peer, 'cpu') / median(runs.ours, 'cpu'));
  row(name, 'peak of memory over what is drawn, MB', median(runs.ours, 'peak'), drawn, median(runs.ours, 'peak') / drawn, '≤', MOST_OVER_DRAWN);
  row(name, 'peak of memory, MB', median(runs.ours, 'peak'), median(runs.peer, 'peak'), median(runs.peer, 'peak') / median(runs.ours, 'peak'));
}

/** @returns {Object<string, number>} of the "name number name number …" that the step prints */
function run(...words) {
  const line = execFileSync(process.env.BENCH_SCENE_TEXT, words, { encoding: 'utf8' });
  return Object.fromEntries([...line.matchAll(/(\w+) (-?[\d.e+]+)/g)].map(([, name, number]) => [name, Number(number)]));
}

function median(runs, name) {
  const values = runs.map((run) => run[name]).sort((a, b) => a - b);
  return values[values.length >> 1];
}

function row(model, what, ours, other = NaN, ratio = NaN, sense = '', goal = NaN) {
  let verdict = '';
  if (!Number.isNaN(goal)) verdict = (sense === '≥' ? ratio >= goal : ratio <= goal) ? 'met' : 'NOT met';
  rows.push({ model, what, ours, other, ratio, goal: Number.isNaN(goal) ? '' : `${sense} ${goal}`, verdict });
}

function print() {
  const text = (value) => (typeof value === 'string' ? value : Number.isNaN(value) ? '' : value.toFixed(Math.abs(value) < 10 ? 2 : 1));
  const columns = Object.keys(rows[0]);
  const table = [columns, ...rows.map((of) => columns.map((column) => text(of[column])))];
  const widths = columns.map((_, i) => Math.max(...table.map((line) => line[i].length)));
  console.log(`medians of ${ROUNDS} rounds in turns with assimp's reader of OBJ`);
  for (const line of table) console.log(line.map((cell, i) => (i < 2 || i > 4 ? cell.padEnd(widths[i]) : cell.padStart(widths[i]))).join('  '));
  const csv = process.argv.indexOf('--csv');
  if (csv > 0) writeFileSync(process.argv[csv + 1], `${table.map((line) => line.map((cell) => (cell.includes(',') ? `"${cell}"` : cell)).join(',')).join('\n')}\n`);
}
