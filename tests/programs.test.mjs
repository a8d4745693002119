// A test that starts a program which its table does not name, or which its tier does not install, is found without
// being started.
import assert from 'node:assert/strict';
import { mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import path from 'node:path';
import { after, test } from 'node:test';
import { faults, programsIn } from './programs.mjs';

const folder = mkdtempSync(path.join(tmpdir(), 'vrut-programs-'));
after(() => rmSync(folder, { recursive: true }));
const file = path.join(folder, 'queue.test.js');
writeFileSync(file, "spawn('/usr/sbin/nats-server', ['-js']);\n");

const known = ['nats-server', 'curl', 'gnuplot'];
const found = (name, text) => [...programsIn(name, text, known)];
const faultsOf = (rows, labels = ['contract'], installed = ['nats-server']) => faults({
  table: new Map(Object.entries(rows)),
  tests: [{ name: 'queue', labels, files: [file] }],
  defaultLabels: new Set(['contract']),
  defaultPrograms: new Set(installed),
  known,
});

test('programs are found by their path, by their call and by their name', () => {
  assert.deepEqual(found('a.js', "const SERVER = '/usr/sbin/some-server';"), ['some-server']);
  assert.deepEqual(found('a.js', "spawnSync('convert', ['a', 'b'])"), ['convert']);
  assert.deepEqual(found('a.js', "missing('curl')"), ['curl']);
  assert.deepEqual(found('a.cpp', 'std::system("gnuplot --version")'), ['gnuplot']);
  assert.deepEqual(found('a.sh', 'if true; then\n    exec curl --silent "$1"\nfi'), ['curl']);
  assert.deepEqual(found('a.js', "// spawn('curl') is not called\nconst why = 'curls';"), []);
  assert.deepEqual(found('a.sh', '# curl would do it\nsay "no curl"'), []);
});

test('a program has to be in the row of its test', () => {
  assert.match(faultsOf({}).join('\n'), /^queue starts nats-server, which tests\/programs\.txt does not say/);
  assert.deepEqual(faultsOf({ queue: ['nats-server'] }), []);
  assert.deepEqual(faultsOf({ everywhere: ['nats-server'] }), []);
});

test('a test of the default tier starts what that tier installs', () => {
  assert.match(faultsOf({ queue: ['nats-server'] }, ['contract'], []).join('\n'), /^queue is among the tests that tests\/run\.sh runs without an option/);
  assert.deepEqual(faultsOf({ queue: ['nats-server'] }, ['several'], []), []);
  assert.deepEqual(faultsOf({ queue: ['nats-server?'] }, ['contract'], []), [], 'it is used if it is there');
});
