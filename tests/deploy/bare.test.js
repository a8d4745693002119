// The package in a bare Debian 12, as container.sh makes it: it serves the car as the Containerfile has it, and a purge
// leaves nothing.
'use strict';
const assert = require('node:assert/strict');
const { spawnSync } = require('node:child_process');
const fs = require('node:fs');
const path = require('node:path');
const { before, test } = require('node:test');
const { DEPLOY, Running, cannotSandbox, containerfile, debs, output, temporaryFolder } = require('./helpers.js');

const START_LIMIT_MS = 180_000;  // the whole car, drawn in software, and no shader is compiled yet

const folder = temporaryFolder();
const at = (name) => path.join(folder, name);
const skip = cannotSandbox('cpack', 'mmdebstrap');
const all = containerfile();

before(() => {
  if (skip) return;
  fs.chmodSync(folder, 0o755);  // mmdebstrap may read as another user
  output('bash', [path.join(DEPLOY, 'container.sh'), debs(at('made'))['vrut-preview'], at('container')]);
  fs.mkdirSync(at('root'));
  // All files become those of whoever runs this, who is everybody in the sandbox.
  output('tar', ['--extract', '--file', at('container/root.tar'), '--directory', at('root'), '--exclude=./dev/*', '--no-same-owner']);
});

/** In the root, with a user and settings. */
const inRoot = (id, settings, ...words) => ['bwrap', [
  '--unshare-user', '--unshare-pid', '--unshare-ipc', '--unshare-uts', '--uid', id, '--gid', id,
  '--bind', at('root'), '/', '--dev', '/dev', '--proc', '/proc', '--tmpfs', '/tmp', '--clearenv', '--setenv', 'PATH', '/usr/sbin:/usr/bin:/sbin:/bin',
  ...settings.flatMap(([name, value]) => ['--setenv', name, value]), '--chdir', '/', '--new-session', '--die-with-parent', ...words]];

test('the container serves the car', { skip }, async () => {
  const settings = all('ENV').flatMap((line) => line.split(' ')).map((word) => word.split('='));
  const words = [...JSON.parse(all('ENTRYPOINT')[0]), ...JSON.parse(all('CMD')[0])].map((word) => word === '0.0.0.0:8080' ? '127.0.0.1:0' : word);
  const server = new Running(...inRoot(all('USER')[0].split(':')[0], settings, ...words));
  const [, address] = await server.printed(/listening on (http:\/\/127\.0\.0\.1:\d+\/)/, START_LIMIT_MS);
  const frame = await fetch(`${address}frame.jpg`);
  assert.equal(frame.headers.get('content-type'), 'image/jpeg');
  const bytes = Buffer.from(await frame.arrayBuffer());
  assert.ok(bytes.length > 30_000, `${bytes.length} bytes do not show the car`);
  assert.match(await (await fetch(address)).text(), /<title>VRUT Preview/);
  await server.stop();
  assert.ok(fs.readdirSync(at('root/var/lib/vrut-preview')).length > 0);
});

test('a purge leaves nothing', { skip }, () => {
  const traces = () => output('find', [at('root'), '-iname', '*vrut*', '-not', '-path', '*/proc/*', '-printf', '/%P\n']).trim();
  // What an administrator and the unit add.
  for (const name of ['etc/vrut-preview', 'etc/systemd/system/multi-user.target.wants', 'var/lib/private/vrut-preview', 'var/cache/private/vrut-preview'])
    fs.mkdirSync(at(`root/${name}`), { recursive: true });
  fs.writeFileSync(at('root/etc/vrut-preview/tokens.json'), '{}');
  fs.symlinkSync('private/vrut-preview', at('root/var/cache/vrut-preview'));
  for (const unit of ['vrut-preview.service', 'vrut-preview-edge.service'])
    fs.symlinkSync(`/lib/systemd/system/${unit}`, at(`root/etc/systemd/system/multi-user.target.wants/${unit}`));
  assert.match(traces(), /vrut/);
  const { status, stdout, stderr } = spawnSync(...inRoot('0', [], 'dpkg', '--purge', 'vrut-preview'), { encoding: 'utf8' });
  assert.equal(status, 0, `${stdout}${stderr}`);
  assert.equal(traces(), '');
});
