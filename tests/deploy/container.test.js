// The Containerfile: what it is made of is there, and its commands are ones that the program and bash understand.
'use strict';
const assert = require('node:assert/strict');
const { spawnSync } = require('node:child_process');
const { test } = require('node:test');
const { BASE, context, stages, wordsOf } = require('./containerfile.js');
const { Running, output, temporaryFolder, tokenFile } = require('./helpers.js');

const { VRUT_PREVIEW, VRUT_CAR } = process.env;
const all = stages();
const last = all.at(-1);
const only = (name) => wordsOf(last, name)[0];

test('each stage is Debian 12, for which packages.sh has its lists, and the last one takes what the first has compiled', () => {
  assert.deepEqual(all.map(({ base, name }) => [base, name]), [[BASE, 'build'], [BASE, undefined]]);
  assert.deepEqual(wordsOf(last, 'COPY'), ['deploy/packages.sh /tmp/', '--from=build /installed/ /']);
  assert.match(wordsOf(all[0], 'RUN').at(-1), /DESTDIR=\/installed cmake --install /);
});

test('the engine gets what the program is built from, and nothing that was built', () => {
  const files = context();
  for (const name of ['CMakeLists.txt', 'CMakePresets.json', 'deploy/packages.sh', 'server/CMakeLists.txt', 'web-client/index.html'])
    assert.ok(files.includes(name), name);
  assert.deepEqual(files.filter((name) => /^(build|tests|\.git)\/|(^|\/)node_modules\//.test(name)), []);
});

test('it runs as nobody in particular, with options that there are', () => {
  assert.match(only('USER'), /^[1-9]\d*:[1-9]\d*$/);
  assert.deepEqual(JSON.parse(only('ENTRYPOINT')), ['vrut-preview']);
  const [command, ...options] = JSON.parse(only('CMD'));
  const help = output(VRUT_PREVIEW, [command, '--help']);
  for (const option of options.filter((word) => word.startsWith('--'))) assert.ok(help.includes(option), option);
  assert.ok(options.includes(`0.0.0.0:${only('EXPOSE')}`));
});

test('the health check tells a server that is well from one that is not there', async () => {
  const server = new Running(VRUT_PREVIEW, ['serve', VRUT_CAR, '--listen', '127.0.0.1:0', '--token-file', tokenFile(temporaryFolder())]);
  const [, port] = await server.printed(/listening on http:\/\/127\.0\.0\.1:(\d+)\//);
  const [program, ...args] = JSON.parse(/CMD (\[.*\])$/.exec(only('HEALTHCHECK'))[1]);
  const check = () => spawnSync(program, args.map((word) => word.replace(`/${only('EXPOSE')}`, `/${port}`)), { timeout: 5000 }).status;
  assert.equal(check(), 0);
  assert.equal(await server.stop(), 0);
  assert.notEqual(check(), 0);
});
