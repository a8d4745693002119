// The Containerfile: it names no package itself, and its commands are ones that the program and bash understand.
'use strict';
const assert = require('node:assert/strict');
const { spawnSync } = require('node:child_process');
const fs = require('node:fs');
const path = require('node:path');
const { test } = require('node:test');
const { DEPLOY, Running, output, temporaryFolder, tokenFile } = require('./helpers.js');

const { VRUT_PREVIEW, VRUT_CAR } = process.env;
const text = fs.readFileSync(path.join(DEPLOY, 'Containerfile'), 'utf8').replace(/\\\n\s*/g, '').replace(/^#.*\n/gm, '');
const instructions = text.trim().split(/\n+/).map((line) => /^([A-Z]+) (.*)$/.exec(line).slice(1));
const all = (name) => instructions.filter(([instruction]) => instruction === name).map(([, words]) => words);

test('what is installed is named in packages.sh alone', () => {
  const listed = output('bash', ['-c', `source ${DEPLOY}/packages.sh; printf '%s\\n' "\${BUILD_PACKAGES[@]%%:*}" "\${RUN_PACKAGES[@]}"`]);
  const words = new Set(text.split(/[^\w.+-]+/));
  for (const name of listed.trim().split('\n')) if (name !== 'cmake') assert.ok(!words.has(name), name);
  assert.doesNotMatch(text, /apt-get|apt install|dpkg/);
  for (const list of ['BUILD_PACKAGES', 'RUN_PACKAGES'])
    assert.equal(all('RUN').filter((command) => command.includes(`install_packages \\"\${${list}[@]}\\"`)).length, 1, list);
});

test('it runs as nobody in particular, with options that there are', () => {
  assert.match(all('USER').at(-1), /^[1-9]\d*:[1-9]\d*$/);
  assert.deepEqual(JSON.parse(all('ENTRYPOINT')[0]), ['vrut-preview']);
  const [command, ...options] = JSON.parse(all('CMD')[0]);
  const help = output(VRUT_PREVIEW, [command, '--help']);
  for (const option of options.filter((word) => word.startsWith('--'))) assert.ok(help.includes(option), option);
  assert.ok(options.includes(`0.0.0.0:${all('EXPOSE')[0]}`));
});

test('the health check tells a server that is well from one that is not there', async () => {
  const server = new Running(VRUT_PREVIEW, ['serve', VRUT_CAR, '--listen', '127.0.0.1:0', '--token-file', tokenFile(temporaryFolder())]);
  const [, port] = await server.printed(/listening on http:\/\/127\.0\.0\.1:(\d+)\//);
  const [program, ...args] = JSON.parse(/CMD (\[.*\])$/.exec(all('HEALTHCHECK')[0])[1]);
  const check = () => spawnSync(program, args.map((word) => word.replace(`/${all('EXPOSE')[0]}`, `/${port}`)), { timeout: 5000 }).status;
  assert.equal(check(), 0);
  assert.equal(await server.stop(), 0);
  assert.notEqual(check(), 0);
});
