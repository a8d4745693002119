// The Containerfile: it takes nothing from a registry, and its commands are ones that the program and bash understand.
'use strict';
const assert = require('node:assert/strict');
const { spawnSync } = require('node:child_process');
const fs = require('node:fs');
const path = require('node:path');
const { test } = require('node:test');
const { DEPLOY, Running, containerfile, output, temporaryFolder, tokenFile } = require('./helpers.js');

const { VRUT_PREVIEW, VRUT_CAR } = process.env;
const all = containerfile();

test('it is made of the root that container.sh makes, and needs nothing from elsewhere', () => {
  assert.deepEqual([all('FROM'), all('ADD'), all('COPY'), all('RUN')], [['scratch'], ['root.tar /'], [], []]);
  assert.match(fs.readFileSync(path.join(DEPLOY, 'container.sh'), 'utf8'), /"\$folder\/root\.tar"/);
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
