// Holds the table of the programs that tests start against the tests: `node tests/programs.mjs BUILD`, where BUILD is a
// configured build folder. Starts none of them. Fails with a sentence for each fault.
import { execFileSync } from 'node:child_process';
import { existsSync, readFileSync } from 'node:fs';
import path from 'node:path';
import { fileURLToPath } from 'node:url';

const TESTS = path.dirname(fileURLToPath(import.meta.url)), ROOT = path.join(TESTS, '..');
/** Words of packages.sh and of paths that are more often something else, or the project's own. */
const NOT_PROGRAMS = new Set(['file', 'vrut-preview']);

/** Comments left out, so that what only speaks of a program counts for nothing. */
export function withoutComments(file, text) {
  if (/\.(sh|cfg|conf)$/.test(file)) return text.replace(/^\s*#.*$/gm, '');
  return text.replace(/\/\*.*?\*\//gs, '').replace(/(^|\s)\/\/.*$/gm, '$1');
}

/** The programs of `known` that code names as a string or as the word of a shell, or that it names by a path. */
export function programsIn(file, text, known) {
  const code = withoutComments(file, text), found = new Set();
  for (const [, name] of code.matchAll(/\/usr\/(?:local\/)?s?bin\/([\w.+-]+)/g)) found.add(name);
  for (const [, name] of code.matchAll(/\b(?:spawn|spawnSync|execFile|execFileSync|output|Running)\(\s*['"]([\w.+-]+)['"]/g)) found.add(name);
  for (const name of known) {
    const word = name.replace(/[.+]/g, '\\$&');
    const started = /\.sh$/.test(file) ? `(?:^|[|;&(]|then|do|exec|command -v)\\s*${word}(?=\\s|$)` : `['"\`]${word}(?:['"\`]|\\s)`;
    if (new RegExp(started, 'm').test(code)) found.add(name);
  }
  for (const word of NOT_PROGRAMS) found.delete(word);
  return found;
}

/** The files that a test's file brings: imported, included, or run as a script of deploy/. */
function filesOf(start) {
  const files = new Set(), waiting = [...start];
  while (waiting.length) {
    const file = waiting.pop();
    if (files.has(file) || !existsSync(file) || file.includes('node_modules')) continue;
    files.add(file);
    const text = readFileSync(file, 'utf8'), folder = path.dirname(file);
    for (const [, name] of text.matchAll(/(?:from |import |import\(|require\()['"](\.[^'"]+)['"]/g)) waiting.push(path.join(folder, name));
    for (const [, name] of text.matchAll(/\bnew URL\(['"]([^'"]+\.m?js)['"]/g)) waiting.push(path.join(folder, name));
    for (const [, name] of text.matchAll(/^#include "([^"]+)"/gm))
      for (const from of [folder, path.join(TESTS, 'support')])
        waiting.push(path.join(from, name), path.join(from, name.replace(/\.hpp$/, '.cpp')));
    for (const [, name] of text.matchAll(/['"/](\w+\.sh)\b/g)) waiting.push(path.join(ROOT, 'deploy', name));
  }
  return files;
}

/** Of deploy/packages.sh: the commands that each list of packages brings. */
function commandsOf(list) {
  const entries = execFileSync('bash', ['-c', `source deploy/packages.sh; printf '%s\\n' "\${${list}[@]}"`], { cwd: ROOT, encoding: 'utf8' });
  return entries.trim().split('\n').map((entry) => entry.split(':')[1]).filter(Boolean);
}

function readTable(text) {
  const rows = text.split('\n').filter((line) => line && !line.startsWith('#')).map((line) => line.split(':').map((part) => part.trim()));
  return new Map(rows.map(([test, programs]) => [test, programs.split(/\s+/).filter(Boolean)]));
}

/** The table's faults, a sentence each. `tests`: name, labels, files, and the words of the command and its environment. */
export function faults({ table, tests, defaultLabels, defaultPrograms, known }) {
  const told = [], everywhere = new Set(table.get('everywhere') ?? []);
  for (const { name, labels, words = '', files } of tests) {
    const row = table.get(name) ?? [], declared = new Set(row.filter((program) => !program.endsWith('?')));
    const optional = new Set(row.filter((program) => program.endsWith('?')).map((program) => program.slice(0, -1)));
    const found = programsIn('', words, []);
    for (const file of files) for (const program of programsIn(file, readFileSync(file, 'utf8'), known)) found.add(program);
    for (const program of found)
      if (!declared.has(program) && !optional.has(program) && !everywhere.has(program))
        told.push(`${name} starts ${program}, which tests/programs.txt does not say: add it to the row of ${name}.`);
    for (const program of declared) {
      if (labels.some((label) => defaultLabels.has(label)) && !defaultPrograms.has(program))
        told.push(`${name} is among the tests that tests/run.sh runs without an option, and starts ${program}, which it does not install: ` +
          'add its package to TEST_PACKAGES of deploy/packages.sh, or give the test another label.');
    }
  }
  return told;
}

function testsOf(build) {
  const { tests } = JSON.parse(execFileSync('ctest', ['--show-only=json-v1'], { cwd: build, encoding: 'utf8', maxBuffer: 1 << 28 }));
  const compiled = JSON.parse(readFileSync(path.join(build, 'compile_commands.json'), 'utf8'));
  return tests.map(({ name, command = [], properties }) => {
    const target = `/test_${name.replace(/_VRUT_TEST_.*/, '')}.dir/`;
    const sources = compiled.filter(({ command: line }) => line.includes(target)).flatMap(({ file }) =>
      file.includes('/Unity/') ? [...readFileSync(file, 'utf8').matchAll(/^#include "(.*)"/gm)].map(([, each]) => each) : [file]);
    const property = (wanted) => properties.find((each) => each.name === wanted)?.value ?? [];
    const environment = property('ENVIRONMENT').map((setting) => setting.slice(setting.indexOf('=') + 1));
    const scripts = [...command, ...environment].filter((word) => /^[^-].*\.(mjs|js)$/.test(word))
      .map((word) => path.resolve(String(property('WORKING_DIRECTORY')), word));
    const labels = property('LABELS');
    return { name, labels, words: [...command, ...environment].join('\n'), files: filesOf([...sources, ...scripts].filter((file) => path.resolve(file).startsWith(TESTS))) };
  });
}

if (process.argv[1] === fileURLToPath(import.meta.url)) {
  const defaultLists = ['BUILD_PACKAGES', 'RUN_PACKAGES', 'TEST_PACKAGES'];
  const allLists = [...defaultLists, 'SEVERAL_PACKAGES', 'PACKAGING_PACKAGES', 'ALL_TEST_PACKAGES'];
  const labels = /^default_labels='(.*)'$/m.exec(readFileSync(path.join(TESTS, 'run.sh'), 'utf8'))[1].split('|');
  const table = readTable(readFileSync(path.join(TESTS, 'programs.txt'), 'utf8'));
  const told = faults({
    table,
    tests: testsOf(process.argv[2]),
    defaultLabels: new Set(labels),
    defaultPrograms: new Set(defaultLists.flatMap(commandsOf)),
    known: new Set(allLists.flatMap(commandsOf)),
  });
  for (const fault of told) console.error(`tests/programs.mjs: ${fault}`);
  process.exitCode = told.length > 0 ? 1 : 0;
}
