// In a bare Debian 12: the steps of the Containerfile, from the sources to a server of the car; and the package, of which
// a purge leaves nothing.
'use strict';
const assert = require('node:assert/strict');
const { spawnSync } = require('node:child_process');
const fs = require('node:fs');
const path = require('node:path');
const { before, test } = require('node:test');
const { environmentOf, makeRoot, stages, wordsOf } = require('./containerfile.js');
const { Running, debs, output, temporaryFolder } = require('./helpers.js');
const { cannotSandbox } = require('./sandbox.js');

const START_LIMIT_MS = 180_000;  // the whole car, drawn in software, and no shader is compiled yet

const folder = temporaryFolder();
const at = (name) => path.join(folder, name);
const skip = cannotSandbox('mmdebstrap');

before(() => fs.chmodSync(folder, 0o755));  // mmdebstrap may read as another user

/** Unpacks the archive of a root. All files become those of whoever runs this, who is everybody in the sandbox. */
function unpack(archive, root) {
  fs.mkdirSync(root);
  output('tar', ['--extract', '--file', archive, '--directory', root, '--exclude=./dev/*', '--no-same-owner']);
}

/** In a root, with a user and settings, as the first process there. */
const inRoot = (root, id, settings, ...words) => ['bwrap', [
  '--unshare-user', '--unshare-pid', '--as-pid-1', '--unshare-ipc', '--unshare-uts', '--uid', id, '--gid', id,
  '--bind', root, '/', '--dev', '/dev', '--proc', '/proc', '--tmpfs', '/tmp', '--clearenv', '--setenv', 'PATH', '/usr/sbin:/usr/bin:/sbin:/bin',
  ...settings.flatMap(([name, value]) => ['--setenv', name, value]), '--chdir', '/', '--new-session', '--die-with-parent', ...words]];

test('the container is compiled from the sources, and serves the car', { skip }, async () => {
  fs.mkdirSync(at('container'), { mode: 0o755 });
  const root = at('container/root');
  unpack(makeRoot(at('container')), root);
  const last = stages().at(-1);
  const words = ['ENTRYPOINT', 'CMD'].flatMap((name) => JSON.parse(wordsOf(last, name)[0])).map((word) => word === '0.0.0.0:8080' ? '0.0.0.0:0' : word);
  const server = new Running(...inRoot(root, wordsOf(last, 'USER')[0].split(':')[0], environmentOf(last), ...words));
  // The address of this machine is the one of whoever publishes the port. Without a network there is no other.
  const [, address, token] = await server.printed(/(?:for this machine|listening) on (http:\/\/127\.0\.0\.1:\d+\/)#token=(\S+)\n/, START_LIMIT_MS);
  const frame = await fetch(`${address}frame.jpg`, { headers: { authorization: `Bearer ${token}` } });
  assert.equal(frame.headers.get('content-type'), 'image/jpeg');
  const bytes = Buffer.from(await frame.arrayBuffer());
  assert.ok(bytes.length > 30_000, `${bytes.length} bytes do not show the car`);
  assert.match(await (await fetch(address)).text(), /<title>VRUT Preview/);
  const { pid } = server.child;
  process.kill(Number(fs.readFileSync(`/proc/${pid}/task/${pid}/children`, 'utf8')), wordsOf(last, 'STOPSIGNAL')[0]);
  assert.equal(await server.ended, 0);
  assert.ok(fs.readdirSync(path.join(root, 'var/lib/vrut-preview')).length > 0);
  // What compiles stays in the first stage.
  for (const name of ['project', 'usr/bin/c++', 'usr/bin/cmake', 'usr/include/GL']) assert.ok(!fs.existsSync(path.join(root, name)), name);
});

test('a purge of the package leaves nothing', { skip: skip || cannotSandbox('cpack') }, () => {
  const root = at('root');
  output('mmdebstrap', ['--variant=essential', `--include=${debs(at('made'))['vrut-preview']}`,
    '--hook-dir=/usr/share/mmdebstrap/hooks/file-mirror-automount', 'bookworm', at('root.tar')]);
  unpack(at('root.tar'), root);
  const traces = () => output('find', [root, '-iname', '*vrut*', '-not', '-path', '*/proc/*', '-printf', '/%P\n']).trim();
  const inIt = (name) => path.join(root, name);
  // What an administrator and the unit add.
  for (const name of ['etc/vrut-preview', 'etc/systemd/system/multi-user.target.wants', 'var/lib/private/vrut-preview', 'var/cache/private/vrut-preview'])
    fs.mkdirSync(inIt(name), { recursive: true });
  fs.writeFileSync(inIt('etc/vrut-preview/tokens.json'), '{}');
  for (const name of ['var/lib', 'var/cache']) fs.symlinkSync('private/vrut-preview', inIt(`${name}/vrut-preview`));
  for (const unit of ['vrut-preview.service', 'vrut-preview-edge.service'])
    fs.symlinkSync(`/lib/systemd/system/${unit}`, inIt(`etc/systemd/system/multi-user.target.wants/${unit}`));
  assert.match(traces(), /vrut/);
  const { status, stdout, stderr } = spawnSync(...inRoot(root, '0', [], 'dpkg', '--purge', 'vrut-preview'), { encoding: 'utf8' });
  assert.equal(status, 0, `${stdout}${stderr}`);
  assert.equal(traces(), '');
});
