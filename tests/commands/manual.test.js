// What the program says about itself: help, manual pages, completion for Bash. Every example is run.
'use strict';
const assert = require('node:assert/strict');
const { spawnSync } = require('node:child_process');
const fs = require('node:fs');
const path = require('node:path');
const { before, test } = require('node:test');
const { Running, missing, output, temporaryFolder } = require('../deploy/helpers.js');
const { PROGRAM, commands, examples, help, section, terms } = require('./examples.js');

const DATA = path.join(__dirname, '../data');
const folder = temporaryFolder();
const work = path.join(folder, 'work');
const manual = path.join(folder, 'manual');
const run = (...options) => spawnSync(PROGRAM, options, { encoding: 'utf8', cwd: work });
const environment = { ...process.env, PATH: `${folder}:${process.env.PATH}`, XDG_STATE_HOME: path.join(folder, 'state') };

before(() => {
  fs.symlinkSync(PROGRAM, path.join(folder, 'vrut-preview'));
  fs.cpSync(path.join(process.env.VRUT_SCENES, 'teaching'), path.join(work, 'scenes'), { recursive: true });
  fs.cpSync(path.join(work, 'scenes/mirror.vrut'), path.join(work, 'mirror.vrut'));
  // The log looks for its scene beside itself and in the folder above.
  for (const name of ['room.vrut', 'my.vrut']) fs.cpSync(path.join(DATA, 'scenes/room.vrut'), path.join(work, name));
  fs.cpSync(path.join(DATA, 'logs/pinch.jsonl'), path.join(work, 'recordings/session.jsonl'));
  fs.writeFileSync(path.join(work, 'my-cues.json'), '{"format": "vrut-preview-cues", "version": 1, "cues": {"All": {"text": "Welcome"}}}');
  for (const name of ['my.glb', 'my.obj']) output(PROGRAM, ['convert', 'my.vrut', name], { cwd: work });
  for (const name of ['my.png', 'truth.png']) output(PROGRAM, ['render', 'my.vrut', '-o', name, '--size', '64x36'], { cwd: work });
  output(PROGRAM, ['--write-manual', manual]);
});

for (const command of [[], ...commands().map((name) => [name])]) {
  const name = ['vrut-preview', ...command].join(' ');
  const text = help(...command);

  test(`the help of ${name} is whole`, () => {
    assert.match(text, new RegExp(`^Usage: ${name} `));
    assert.equal(examples(...command).length, 3);
    assert.deepEqual(terms(section(text, 'Exit status')), ['0', '1', '2']);
    assert.ok(terms(section(text, 'General options')).includes('-h, --help'));
    for (const line of text.split('\n')) assert.ok(line.length <= 80, line);
    // Sentences, which tell where a value is taken from; and no type of a programming language.
    for (const part of text.split('\n\n')) assert.match(part.trim(), part.startsWith('Usage: ') ? /\]$|\.\.\.$|\S$/ : /\.$/);
    assert.doesNotMatch(text, /\b(TEXT|UINT|INT|FLOAT|REQUIRED|Excludes|picture)\b|:FILE/);
  });

  test(`the usage that ${name} refuses is told, with status 2`, () => {
    for (const options of [[...command, '--nothing'], command.length > 0 ? [...command, 'a', 'b', '--device', 'x'] : []]) {
      const { status, stderr, stdout } = run(...options);
      assert.equal(status, 2, stderr);
      assert.equal(stdout, '');
      assert.match(stderr, new RegExp(`^vrut-preview: .*; see '${name} --help'\n$`));
    }
  });

  // Those of chart are run in chart.test.js, with gnuplot; those of worker in render-queue.test.js, and those of edge in
  // several/edges.test.js of tests/web, with a NATS server.
  for (const example of ['chart', 'worker', 'edge'].includes(command[0]) ? [] : examples(...command)) {
    test(`example: ${example}`, async () => {
      const here = fs.mkdtempSync(path.join(folder, 'example-'));
      fs.cpSync(work, here, { recursive: true });
      if (/^vrut-preview serve(?! --help)/.test(example)) return serves(example, here);
      const { status, stderr } = spawnSync('bash', ['--norc', '-o', 'pipefail', '-c', example], { cwd: here, env: environment, encoding: 'utf8' });
      assert.equal(status, 0, stderr);
      const options = [...example.matchAll(/(?:-o|--map|--out|>) ?(\S+)/g)].map(([, written]) => written);
      for (const written of options) assert.ok(fs.existsSync(path.join(here, written)), written);
    });
  }
}

/** Runs an example of a server on a free port instead of its own, and ends it. */
async function serves(example, cwd) {
  const free = example.includes('--listen') ? example.replace(/(--listen \S+):\d+/, '$1:0') : `${example} --listen 127.0.0.1:0`;
  const server = new Running('bash', ['--norc', '-c', `exec ${free}`], { cwd, env: environment });
  await server.printed(/listening on http:\S+/);
  assert.equal(await server.stop(), 0);
}

test('what cannot be done is told with status 1, by every command', () => {
  const none = path.join(folder, 'none.vrut');
  const calls = {
    serve: [none], edge: ['--nats', 'nats://127.0.0.1', '--token-file', none], render: [none, '-o', 'x.png'], worker: ['--nats', 'nats://127.0.0.1', '--scenes', none], replay: [none], info: [none], convert: [none, 'x.glb'],
    compare: [none, none], cues: ['check', none, none], chart: [none, '--calibrate'],
  };
  assert.deepEqual(Object.keys(calls), commands());
  for (const [command, options] of Object.entries(calls)) {
    const { status, stderr } = run(command, ...options);
    assert.equal(status, 1, `${command}: ${stderr}`);
    assert.match(stderr, /^vrut-preview: .*none\.vrut.*\n$/, command);
  }
});

test('every option and argument of the help is in the manual pages, with its sentences', () => {
  assert.deepEqual(fs.readdirSync(path.join(manual, 'man1')).sort(),
    ['vrut-preview.1', ...commands().map((name) => `vrut-preview-${name}.1`)].sort());
  const words = (text) => text.replace(/[\s\u00ad]+/g, ' ').replace(/(Examples|Environment|Exit status|[A-Z][a-z]+ options|Arguments|Commands):/g, '').trim();
  for (const command of [[], ...commands().map((name) => [name])]) {
    const page = path.join(manual, 'man1', `${['vrut-preview', ...command].join('-')}.1`);
    const shown = output('groff', ['-man', '-Tascii', '-P-cbou', '-rHY=0', page]).replace(/\s+/g, ' ');
    const [, , ...parts] = help(...command).split('\n\n');
    for (const part of parts)
      for (const sentence of words(part).split(/(?<=\.) (?=[A-Z])/)) assert.ok(shown.includes(sentence), `${sentence}\n${shown}`);
  }
});

test('groff has nothing to say against the manual pages', { skip: missing('groff') }, () => {
  for (const name of fs.readdirSync(path.join(manual, 'man1'))) {
    const { status, stderr } = spawnSync('groff', ['-ww', '-man', '-Tutf8', '-z', path.join(manual, 'man1', name)], { encoding: 'utf8' });
    assert.equal(status, 0);
    assert.equal(stderr, '', name);
  }
});

/** What Bash offers for the last of the words, in the folder of the scenes. */
function completions(...words) {
  const script = `source ${path.join(manual, 'completions/vrut-preview')}
    [[ $(complete -p vrut-preview) == *' -F _vrut_preview vrut-preview' ]] || exit 1
    COMP_WORDS=("$@") COMP_CWORD=$(($# - 1)); _vrut_preview; printf '%s\\n' "\${COMPREPLY[@]}"`;
  return output('bash', ['--norc', '-euc', `set +e; ${script}`, 'bash', 'vrut-preview', ...words], { cwd: work }).split('\n').filter(Boolean).sort();
}

test('Bash completes commands and options', () => {
  assert.deepEqual(completions(''), commands().sort());
  assert.deepEqual(completions('re'), ['render', 'replay']);
  assert.deepEqual(completions('--v'), ['--version']);
  assert.deepEqual(completions('info', '--'), ['--help', '--json']);
  for (const command of commands()) {
    const options = terms([...help(command).matchAll(/^\w+ options:\n((?: {2}.*\n)+)/gm)].map(([, part]) => part).join(''));
    const names = options.flatMap((term) => term.match(/(?<![\w-])--?[a-z][a-z-]*/g));
    assert.deepEqual(completions(command, '-'), names.sort(), command);
  }
});

test('Bash completes the values of options', () => {
  assert.deepEqual(completions('render', '--mode', ''), ['realistic', 'stylized']);
  assert.deepEqual(completions('render', '--mode', '=', 's'), ['stylized']);
  assert.deepEqual(completions('render', '--mode', '='), ['realistic', 'stylized']);
  assert.deepEqual(completions('render', '--light', ''), ['headlight']);
  assert.deepEqual(completions('render', '--eye', '-'), []);
  assert.deepEqual(completions('serve', '--record', 're'), ['recordings']);
  assert.deepEqual(completions('serve', '--scenes', ''), ['recordings', 'scenes']);
});

test('Bash completes files', () => {
  assert.deepEqual(completions('info', 'm'), fs.readdirSync(work).filter((name) => name.startsWith('m')));
  assert.deepEqual(completions('replay', 'recordings/'), ['recordings/session.jsonl']);
  assert.deepEqual(completions('render', 'my.vrut', '-o', 'tr'), ['truth.png']);
  fs.writeFileSync(path.join(work, 'with space.vrut'), '');
  assert.deepEqual(completions('info', 'with'), ['with space.vrut']);
  fs.rmSync(path.join(work, 'with space.vrut'));
  assert.deepEqual(completions('nothing', ''), []);
});
