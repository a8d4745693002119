// `cmake --install` into a staging folder: what lies there, and that it works from anywhere.
'use strict';
const assert = require('node:assert/strict');
const fs = require('node:fs');
const path = require('node:path');
const { before, test } = require('node:test');
const { Client, DEPLOY, Running, files, linkedLibraries, missing, output, packagesOf, temporaryFolder } = require('./helpers.js');

const { VRUT_BUILD, VRUT_CMAKE } = process.env;
const SOURCE = path.dirname(DEPLOY);
const folder = temporaryFolder();
const prefix = path.join(folder, 'moved');

before(() => {
  // As packages are made: installed as if into /usr, which lies somewhere else meanwhile.
  output(VRUT_CMAKE, ['--install', VRUT_BUILD, '--prefix', '/usr'], { env: { ...process.env, DESTDIR: path.join(folder, 'staging') } });
  fs.renameSync(path.join(folder, 'staging/usr'), prefix);
});

test('what a server needs is installed, and nothing else', () => {
  assert.deepEqual(files(path.join(folder, 'staging')), []);
  const scenes = path.join(SOURCE, 'scenes');
  const expected = [
    'bin/vrut-preview', ...['vrut-preview', 'vrut-preview-edge'].map((name) => `lib/systemd/system/${name}.service`),
    'libexec/vrut-preview/vrut-preview-chart', 'share/bash-completion/completions/vrut-preview',
    ...['', '-serve', '-edge', '-render', '-worker', '-replay', '-info', '-convert', '-compare', '-cues', '-chart'].map((command) => `share/man/man1/vrut-preview${command}.1`),
    ...['CHANGELOG.md', 'README.md', 'copyright', 'haproxy-edges.cfg', 'haproxy.cfg', 'nats.conf', 'watchers.svg'].map((name) => `share/doc/vrut-preview/${name}`),
    ...['README.md', 'car/car.vrut'].map((name) => `share/vrut-preview/scenes/${name}`),
    ...files(path.join(scenes, 'car/textures')).map((name) => `share/vrut-preview/scenes/car/textures/${name}`),
    ...files(path.join(scenes, 'teaching')).filter((name) => !name.endsWith('.py')).map((name) => `share/vrut-preview/scenes/teaching/${name}`),
  ];
  assert.deepEqual(files(prefix), expected.sort());
});

const released = /^CMAKE_BUILD_TYPE:\w+=Release$/m.test(fs.readFileSync(path.join(VRUT_BUILD, 'CMakeCache.txt'), 'utf8'));

test('nothing refers to where it was built', { skip: released ? false : 'what helps to find bugs does' }, () => {
  for (const name of files(prefix)) {
    const bytes = fs.readFileSync(path.join(prefix, name));
    for (const place of [SOURCE, VRUT_BUILD, folder]) assert.ok(!bytes.includes(place), `${name} names ${place}`);
  }
});

test('the units start the program where it is installed to', () => {
  const elsewhere = path.join(folder, 'opt');
  output(VRUT_CMAKE, ['--install', VRUT_BUILD, '--prefix', elsewhere]);
  const unit = (top, name) => fs.readFileSync(path.join(top, `lib/systemd/system/${name}.service`), 'utf8');
  assert.match(unit(prefix, 'vrut-preview'), /^ExecStart=\/usr\/bin\/vrut-preview serve .* --scenes \/usr\/share\/vrut-preview\/scenes /m);
  for (const [name, command] of [['vrut-preview', 'serve'], ['vrut-preview-edge', 'edge']]) {
    assert.ok(unit(prefix, name).includes(`ExecStart=/usr/bin/vrut-preview ${command} `), name);
    const text = unit(elsewhere, name);
    assert.ok(text.includes(`ExecStart=${elsewhere}/bin/vrut-preview ${command} `), text);
    assert.doesNotMatch(text, /@CMAKE/);
  }
});

test('the packages to run bring every library that it is linked with', { skip: missing('dpkg-query') }, () => {
  const listed = output('bash', ['-c', `source ${DEPLOY}/packages.sh; printf '%s\\n' "\${RUN_PACKAGES[@]}"`]).trim().split('\n');
  const program = path.join(prefix, 'bin/vrut-preview');
  const libraries = linkedLibraries(program);
  assert.ok(libraries.length > 5);
  for (const owner of packagesOf(libraries)) assert.ok(['libc6', 'libstdc++6', 'libgcc-s1', ...listed].includes(owner), owner);
  assert.doesNotMatch(output('readelf', ['--dynamic', program]), /R(UN)?PATH/);
});

test('it draws and serves the car from where it was moved to', async () => {
  const program = path.join(prefix, 'bin/vrut-preview');
  const elsewhere = { cwd: '/', env: { PATH: '/usr/bin:/bin' } };
  output(program, ['render', path.join(prefix, 'share/vrut-preview/scenes/car/car.vrut'), '-o', path.join(folder, 'car.png'), '--size', '64x36', '--samples', '1'], elsewhere);
  assert.ok(fs.statSync(path.join(folder, 'car.png')).size > 1000);
  assert.throws(() => output(program, ['chart', 'none.vrut', '--calibrate'], elsewhere), /none\.vrut: there is no such file/);
  const server = new Running(program, ['serve', '--listen', '127.0.0.1:0', '--scenes', path.join(prefix, 'share/vrut-preview/scenes')], elsewhere);
  const [, port] = await server.printed(/listening on http:\/\/127\.0\.0\.1:(\d+)\//);
  assert.ok(server.text.includes(path.join(prefix, 'share/vrut-preview/scenes/car/car.vrut')), server.text);
  const client = await Client.join(`ws://127.0.0.1:${port}/ws`);
  const { scenes } = await client.ask({ type: 'scenes' });
  assert.ok(scenes.includes('car/car.vrut') && scenes.includes('teaching/glass.vrut'), `${scenes}`);
  assert.equal(await server.stop(), 0);
});
