// What each library of the program costs the compiler, beside tests/compile-budget.tsv: `node tests/compile-budget.mjs BUILD`,
// where BUILD is a release build. Fails if a library's preprocessed lines are more than a tenth above the table's. CPU
// seconds, those of a clean build without a cache by tests/timed-compiler.sh, are printed and never fail.
// VRUT_RENEW=1 writes the table. It is raised in a commit of its own, which says why.
import { spawn } from 'node:child_process';
import { existsSync, readFileSync, writeFileSync } from 'node:fs';
import { availableParallelism } from 'node:os';
import path from 'node:path';
import { createInterface } from 'node:readline';
import { fileURLToPath } from 'node:url';

const TABLE = path.join(path.dirname(fileURLToPath(import.meta.url)), 'compile-budget.tsv');
const MOST_GROWTH = 1.1;
const HEAD = ['library', 'units', 'lines', 'cpu_s'];

/** The library of an object file; null: of a test. */
function libraryOf(object) {
  return /^tests\//.test(object) ? null : /CMakeFiles\/([^/]+)\.dir\//.exec(object)?.[1] ?? null;
}

/** The words of a command of compile_commands.json, which quotes by backslashes and double quotes. */
export function wordsOf(command) {
  return [...command.matchAll(/(?:\\.|"(?:\\.|[^"\\])*"|[^\s"\\])+/g)].map(([word]) =>
    word.replace(/\\(.)|"/g, (_, escaped) => escaped ?? ''));
}

/** The same compilation, of which only the preprocessor runs; a precompiled header counts where it is made. */
export function preprocessing(words) {
  const kept = [], isHeader = words.includes('c++-header');
  for (let i = 0; i < words.length; ++i) {
    if (['-o', '-MT', '-MF'].includes(words[i]) || (words[i] === '-include' && !isHeader)) ++i;
    else if (!['-c', '-MD', '-Winvalid-pch'].includes(words[i]) && !/(?:ccache|timed-compiler\.sh)$/.test(words[i])) kept.push(words[i]);
  }
  return [...kept, '-E', '-P'];
}

/** Lines that the preprocessor hands to the compiler, blank ones left out. */
function countLines(command, directory) {
  const [program, ...options] = preprocessing(wordsOf(command));
  return new Promise((resolve, reject) => {
    const child = spawn(program, options, { cwd: directory, stdio: ['ignore', 'pipe', 'inherit'] });
    let lines = 0;
    createInterface(child.stdout).on('line', (line) => (lines += line.trim() !== ''));
    child.on('error', reject);
    child.on('close', (status) => (status === 0 ? resolve(lines) : reject(new Error(`${command}\nended with ${status}`))));
  });
}

/** @returns {Promise<Map<string, {units: number, lines: number, cpu_s: number | null}>>} by library */
async function measure(build) {
  const rows = new Map();
  const row = (library) => rows.get(library) ?? rows.set(library, { units: 0, lines: 0, cpu_s: null }).get(library);
  const waiting = JSON.parse(readFileSync(path.join(build, 'compile_commands.json'), 'utf8'));
  const work = async () => {
    for (let unit; (unit = waiting.pop());) {
      const library = libraryOf(/ -o (\S+)/.exec(unit.command)[1]);
      if (!library) continue;
      const lines = await countLines(unit.command, unit.directory);
      row(library).units += 1;
      row(library).lines += lines;
    }
  };
  await Promise.all(Array.from({ length: availableParallelism() }, work));
  const times = path.join(build, 'compile-times.tsv');
  const newest = new Map(existsSync(times) ? readFileSync(times, 'utf8').trim().split('\n').map((line) => line.split('\t').reverse()) : []);
  for (const [object, seconds] of newest) {
    const library = libraryOf(object);
    if (library && rows.has(library)) row(library).cpu_s = (row(library).cpu_s ?? 0) + Number(seconds);
  }
  return new Map([...rows].sort(([a], [b]) => (a < b ? -1 : 1)));
}

const decimal = (seconds) => (seconds === null ? '-' : seconds.toFixed(1));
const total = (rows, what) => [...rows.values()].reduce((sum, row) => sum + (row[what] ?? 0), 0);

function readTable() {
  const lines = readFileSync(TABLE, 'utf8').trim().split('\n').slice(1).map((line) => line.split('\t'));
  return new Map(lines.map(([library, units, preprocessed, seconds]) =>
    [library, { units: Number(units), lines: Number(preprocessed), cpu_s: seconds === '-' ? null : Number(seconds) }]));
}

/** What is wrong, a sentence each. */
export function faults(table, rows) {
  const told = [];
  for (const [library, { lines }] of rows) {
    const planned = table.get(library);
    if (!planned) told.push(`${library} has no row: add it in a commit that says why it is compiled.`);
    else if (lines > planned.lines * MOST_GROWTH)
      told.push(`${library} has ${lines} preprocessed lines, more than a tenth above its ${planned.lines}: include less, or raise the table in a commit of its own.`);
  }
  for (const library of table.keys()) if (!rows.has(library)) told.push(`${library} has a row, but is not compiled: remove it.`);
  return told;
}

async function main(build) {
  const rows = await measure(build);
  if (process.env.VRUT_RENEW) {
    const lines = [...rows].map(([library, { units, lines: count, cpu_s }]) => [library, units, count, decimal(cpu_s)].join('\t'));
    writeFileSync(TABLE, `${[HEAD.join('\t'), ...lines].join('\n')}\n`);
    return;
  }
  const table = readTable();
  const print = (name, before, now) => console.log(`${name.padEnd(34)}${[
    before?.units ?? '-', now.units, before?.lines ?? '-', now.lines, decimal(before?.cpu_s ?? null), decimal(now.cpu_s),
  ].map((cell) => String(cell).padStart(11)).join('')}`);
  console.log(`${'library'.padEnd(34)}${['units', 'today', 'lines', 'today', 'CPU s', 'today'].map((cell) => cell.padStart(11)).join('')}`);
  for (const [library, row] of rows) print(library, table.get(library), row);
  const sum = (of) => ({ units: total(of, 'units'), lines: total(of, 'lines'), cpu_s: total(of, 'cpu_s') });
  print('all', sum(table), sum(rows));
  const told = faults(table, rows);
  for (const fault of told) console.error(`tests/compile-budget.mjs: ${fault}`);
  process.exitCode = told.length > 0 ? 1 : 0;
}

if (process.argv[1] === fileURLToPath(import.meta.url)) await main(process.argv[2]);
