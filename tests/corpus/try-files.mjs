// Tries the scene files of a folder with `vrut-preview render`: how many are drawn, refused, blank, how many crash or
// hang, in what time and memory, beside F3D where there is one. OUT.html shows all of them, OUT.json lists them.
//
//   VRUT_PREVIEW=build/release/server/vrut-preview node tests/corpus/try-files.mjs FOLDER OUT [SECONDS]
//
// SECONDS is how long a file may take, 60 without it. Memory is measured by /usr/bin/time (package `time`). F3D draws
// where there is a display: without one, put `xvfb-run` (package `xvfb`) before `node`.
import { spawnSync } from 'node:child_process';
import { existsSync, mkdtempSync, readFileSync, readdirSync, rmSync, statSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import path from 'node:path';
import { fileURLToPath } from 'node:url';
import { inflateSync } from 'node:zlib';

const ENDINGS = /\.(vrut|osb|glb|gltf|obj|stl|ply|dae|fbx)$/i;
const SIZE = [240, 135];
const TIME = '/usr/bin/time';
const OUTCOMES = ['crashed', 'hung', 'blank', 'refused', 'drawn'];

/** @returns {string[]} the scene files in the folder and below, relative to it, sorted */
function sceneFiles(folder) {
  return readdirSync(folder, { recursive: true })
    .filter((name) => ENDINGS.test(name) && statSync(path.join(folder, name)).isFile()).sort();
}

/** True if all pixels of a PNG file (RGB or RGBA, 8 bits, not interlaced) have one colour. */
function isOneColor(png) {
  const data = [];
  let [width, bytes] = [0, 3];
  for (let at = 8; at < png.length; at += 12 + png.readUInt32BE(at)) {
    const type = png.toString('latin1', at + 4, at + 8);
    const body = png.subarray(at + 8, at + 8 + png.readUInt32BE(at));
    if (type === 'IHDR') [width, bytes] = [body.readUInt32BE(0), { 2: 3, 6: 4 }[body[9]]];
    if (type === 'IDAT') data.push(body);
  }
  const pixels = unfiltered(inflateSync(Buffer.concat(data)), width * bytes, bytes);
  return pixels.every((byte, i) => byte === pixels[i % bytes]);
}

/** PNG specification, 9.2: each row begins with the type of its filter. */
function unfiltered(rows, size, bytes) {
  const pixels = Buffer.alloc((rows.length / (size + 1)) * size);
  for (let from = 0, to = 0; from < rows.length; from += size + 1)
    for (let i = 0; i < size; ++i, ++to) {
      const a = i < bytes ? 0 : pixels[to - bytes];
      const b = to < size ? 0 : pixels[to - size];
      const c = i < bytes || to < size ? 0 : pixels[to - size - bytes];
      pixels[to] = rows[from + 1 + i] + [0, a, b, (a + b) >> 1, paeth(a, b, c)][rows[from]];
    }
  return pixels;
}

function paeth(a, b, c) {
  const [pa, pb, pc] = [Math.abs(b - c), Math.abs(a - c), Math.abs(a + b - 2 * c)];
  return pa <= pb && pa <= pc ? a : pb <= pc ? b : c;
}

/** Runs a program to its end or for so many seconds. `mb`: the memory that it and its children held at most. */
function run(program, options, seconds) {
  const measured = existsSync(TIME);
  const start = performance.now();
  const words = measured ? [TIME, '-f', 'memory %M', program] : [program];
  const { status, signal, stderr, error } = spawnSync('timeout', ['-s', 'KILL', String(seconds), ...words, ...options],
    { encoding: 'utf8', maxBuffer: 1 << 26 });
  if (error) throw error;
  const ms = performance.now() - start;
  const memory = /^memory (\d+)$/m.exec(stderr);
  return { status, signal, ms, hung: ms > seconds * 1000, mb: memory ? Number(memory[1]) / 1024 : NaN, stderr };
}

function outcomeOf({ status, hung, stderr }, picture) {
  if (hung || /is not read within/.test(stderr)) return 'hung';
  if ((status !== 0 && status !== 1) || /its reader ended with|^Command terminated by signal/m.test(stderr)) return 'crashed';
  if (status === 1) return 'refused';
  return isOneColor(picture) ? 'blank' : 'drawn';
}

/** The program's error, or its notices, without the name of the file. */
function sentences(outcome, { stderr }, file) {
  const lines = stderr.split('\n');
  const found = outcome === 'refused' || outcome === 'crashed'
    ? lines.filter((line) => line.startsWith('vrut-preview: '))
    : lines.flatMap((line) => /event=notice text="?(.*?)"?$/.exec(line)?.[1] ?? []);
  return found.map((line) => line.replace('vrut-preview: ', '').replaceAll(file, '').replace(/^:? */, ''));
}

/** Draws one file. @returns what is known of it, with its pictures as PNG */
function tryFile(folder, name, { program, f3d, seconds, scratch }) {
  const file = path.join(folder, name);
  const picture = path.join(scratch, 'picture.png');
  rmSync(picture, { force: true });
  const ran = run(program, ['render', file, '-o', picture, '--studio', 'off', '--size', SIZE.join('x')], seconds);
  const png = existsSync(picture) ? readFileSync(picture) : null;
  const outcome = outcomeOf(ran, png);
  const row = { name, outcome, sentences: sentences(outcome, ran, file), ms: ran.ms, mb: ran.mb, png };
  return f3d ? { ...row, f3d: tryF3d(file, f3d, seconds, scratch) } : row;
}

function tryF3d(file, f3d, seconds, scratch) {
  const picture = path.join(scratch, 'f3d.png');
  rmSync(picture, { force: true });
  const { ms, mb } = run(f3d, [file, '--output', picture, '--resolution', SIZE.join(',')], seconds);
  return { ms, mb, png: existsSync(picture) ? readFileSync(picture) : null };
}

/** Sentences without what differs from file to file. */
const kindOf = (sentence) => sentence.replace(/'[^']*'/g, "'…'").replace(/\d+/g, 'N');

/** @returns {[string, number][]} how often each kind of sentence stands in rows of an outcome, the most frequent first */
export function countSentences(rows, outcome) {
  const counts = new Map();
  for (const row of rows.filter((of) => of.outcome === outcome))
    for (const kind of new Set(row.sentences.map(kindOf))) counts.set(kind, (counts.get(kind) ?? 0) + 1);
  return [...counts].sort((a, b) => b[1] - a[1]);
}

const escaped = (text) => text.replace(/[&<>]/g, (sign) => ({ '&': '&amp;', '<': '&lt;', '>': '&gt;' })[sign]);
const image = (png) => (png ? `<img src="data:image/png;base64,${png.toString('base64')}" width="240">` : '');
const cost = ({ ms, mb }) => `${ms.toFixed(0)} ms, ${mb.toFixed(0)} MB`;

function figure({ name, outcome, sentences: said, f3d, ...ours }) {
  const theirs = f3d ? `${image(f3d.png)}<br>F3D: ${cost(f3d)}` : '';
  return `<figure class="${outcome}">${image(ours.png)}${theirs}<figcaption><b>${escaped(name)}</b><br>${outcome}, ${cost(ours)}<br>${
    said.map(escaped).join('<br>')}</figcaption></figure>`;
}

function counts(rows) {
  const all = OUTCOMES.map((outcome) => `${rows.filter((row) => row.outcome === outcome).length} ${outcome}`);
  return `${rows.length} files: ${all.reverse().join(', ')}`;
}

function sheet(rows) {
  const sections = OUTCOMES.map((outcome) =>
    `<h2>${outcome}</h2>\n${rows.filter((row) => row.outcome === outcome).map(figure).join('\n')}`);
  return `<!doctype html><meta charset="utf-8"><title>Scene files</title>
<style>body{font:12px sans-serif}figure{display:inline-block;width:250px;margin:4px;vertical-align:top;overflow-wrap:anywhere}</style>
<p>${counts(rows)}</p>\n${sections.join('\n')}\n`;
}

function main([folder, out, seconds = '60']) {
  const program = process.env.VRUT_PREVIEW;
  if (!program || !folder || !out) throw new Error('expected VRUT_PREVIEW, FOLDER and OUT: see the head of this script');
  const f3d = spawnSync('sh', ['-c', 'command -v f3d'], { encoding: 'utf8' }).stdout.trim();
  const scratch = mkdtempSync(path.join(tmpdir(), 'try-files-'));
  const rows = [];
  try {
    for (const name of sceneFiles(folder))
      rows.push(tryFile(folder, name, { program, f3d, seconds: Number(seconds), scratch }));
  } finally {
    rmSync(scratch, { recursive: true });
  }
  writeFileSync(`${out}.html`, sheet(rows));
  writeFileSync(`${out}.json`, JSON.stringify(rows.map(({ png, f3d: theirs, ...row }) =>
    ({ ...row, f3d: theirs && { ms: theirs.ms, mb: theirs.mb, drawn: theirs.png !== null } })), null, 1));
  console.log(counts(rows));
  for (const outcome of OUTCOMES.slice(0, -1))
    for (const [sentence, times] of countSentences(rows, outcome)) console.log(`${outcome} ${times}: ${sentence}`);
}

if (process.argv[1] === fileURLToPath(import.meta.url)) main(process.argv.slice(2));
