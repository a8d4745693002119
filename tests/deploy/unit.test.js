// The systemd units: their scores, and the program in as much of their sandboxes as can be had without systemd.
'use strict';
const assert = require('node:assert/strict');
const { spawnSync } = require('node:child_process');
const fs = require('node:fs');
const path = require('node:path');
const { before, test } = require('node:test');
const { Client, Running, TOKENS, eventually, freePort, missing, output, temporaryFolder, tokenFile } = require('./helpers.js');
const { cannotSandbox } = require('./sandbox.js');

const { VRUT_BUILD, VRUT_CAR, VRUT_CMAKE } = process.env;
const WORST_SCORE = 2.0;
const folder = temporaryFolder();
const at = (name) => path.join(folder, name);
const PROGRAM = at('usr/bin/vrut-preview');
const SERVER = at('usr/lib/systemd/system/vrut-preview.service'), EDGE = at('usr/lib/systemd/system/vrut-preview-edge.service');

before(() => output(VRUT_CMAKE, ['--install', VRUT_BUILD, '--prefix', at('usr')]));

/** What a unit says of a setting, word by word, a line each. */
const settings = (unit, name) => fs.readFileSync(unit, 'utf8').split('\n')
  .filter((line) => line.startsWith(`${name}=`)).map((line) => line.slice(name.length + 1).split(' '));

test('systemd understands the units, and scores them well', { skip: missing('systemd-analyze') }, () => {
  for (const unit of [SERVER, EDGE]) {
    assert.equal(output('systemd-analyze', ['verify', unit]), '');
    const said = output('systemd-analyze', ['security', '--offline=true', '--no-pager', unit]);
    const score = Number(/Overall exposure level.*: ([\d.]+)/.exec(said)[1]);
    assert.ok(score > 0 && score <= WORST_SCORE, said);
    // Left out, standard error would go where standard output goes.
    assert.deepEqual([settings(unit, 'StandardOutput'), settings(unit, 'StandardError')], [[['null']], [['journal']]]);
  }
});

test('the edge may do no more than the server, and sees no graphics card', () => {
  const limits = (unit) => fs.readFileSync(unit, 'utf8').split('# --- what it must not do\n')[1].split('\n').filter((line) => /^[A-Z]\w+=/.test(line));
  const own = limits(EDGE);
  assert.deepEqual(limits(SERVER).filter((line) => !own.includes(line)), ['SystemCallFilter=landlock_create_ruleset landlock_add_rule landlock_restrict_self']);
  assert.ok(own.includes('PrivateDevices=yes'));
});

/** The system calls of a name, which may be a group's. */
function systemCalls(name) {
  if (!name.startsWith('@')) return [name];
  const words = output('systemd-analyze', ['syscall-filter', '--no-pager', name]).split('\n').map((line) => line.trim());
  return words.filter((word) => word && !word.startsWith('#') && word !== name).flatMap(systemCalls);
}

/** Makes a unit's filter. @returns {string} its file */
function systemCallFilter(unit) {
  const calls = new Set();
  for (const [first, ...others] of settings(unit, 'SystemCallFilter')) {
    const denied = first.startsWith('~');
    for (const call of [first.replace('~', ''), ...others].flatMap(systemCalls))
      if (denied) calls.delete(call);
      else calls.add(call);
  }
  const allowed = JSON.stringify({ calls: [...calls], families: settings(unit, 'RestrictAddressFamilies').flat() });
  const made = spawnSync('/usr/bin/python3', [path.join(__dirname, 'system_call_filter.py')], { input: allowed });
  assert.equal(made.status, 0, `${made.stderr}`);
  const file = at(`${path.basename(unit)}.bpf`);
  fs.writeFileSync(file, made.stdout);
  return file;
}

/** As ProtectSystem=strict, ProtectHome, PrivateTmp, PrivateDevices, PrivateUsers and the like have it. */
function sandboxed(filter, command, args) {
  const words = [
    '--unshare-user', '--unshare-ipc', '--unshare-pid', '--unshare-uts', '--uid', '61000', '--gid', '61000', '--cap-drop', 'ALL',
    '--ro-bind', '/', '/', '--dev', '/dev', '--proc', '/proc', '--tmpfs', '/home', '--tmpfs', '/tmp', '--tmpfs', folder,
    ...['usr', 'credentials'].flatMap((name) => ['--ro-bind', at(name), at(name)]), '--bind', at('state'), at('state'),
    '--clearenv', '--setenv', 'XDG_STATE_HOME', at('state'), '--setenv', 'XDG_CACHE_HOME', at('state/cache'),
    '--chdir', '/', '--new-session', '--die-with-parent', '--seccomp', '3', command, ...args,
  ];
  return ['bwrap', words, { stdio: ['ignore', 'pipe', 'pipe', fs.openSync(filter, 'r')] }];
}

/** Draws, reads a foreign file in a process of its own, and records. */
async function exercise(url, foreign) {
  const client = await Client.join(url, TOKENS.control);
  assert.ok((await client.frame()).includes(Buffer.from([0xff, 0xd8, 0xff])));
  await client.ask({ type: 'record', action: 'start', name: 'in-a-sandbox' });
  await client.ask({ type: 'navigate', rotate: [10, 5] });
  await client.ask({ type: 'open', scene: foreign });
  await eventually('the foreign scene', () => {
    assert.equal(client.texts.find((text) => text.refused), undefined);
    return client.texts.some((text) => text.type === 'loading' && text.scene === foreign && text.done) && client.texts.filter(({ type }) => type === 'state').length > 1;
  });
  await client.ask({ type: 'record', action: 'stop' });
}

let tokens;
before(() => {
  fs.mkdirSync(at('state/recordings'), { recursive: true });
  fs.mkdirSync(at('credentials'));
  tokens = tokenFile(at('credentials'));
});

test('it draws, reads foreign files and records in the unit\'s sandbox', { skip: cannotSandbox('systemd-analyze') }, async () => {
  const scenes = at('usr/share/vrut-preview/scenes');
  output(PROGRAM, ['convert', path.join(scenes, 'teaching/matrices.vrut'), path.join(scenes, 'foreign.glb')]);
  const filter = systemCallFilter(SERVER);

  // The sandbox is one.
  const walls = spawnSync(...sandboxed(filter, '/bin/bash', ['-c', 'cat /proc/self/status; touch /usr/x; ls -A /home | wc -l; echo > /dev/udp/127.0.0.1/9 && echo internet']));
  const seen = `${walls.stdout}${walls.stderr}`;
  for (const pattern of [/NoNewPrivs:\t1/, /Seccomp:\t2/, /CapEff:\t0+\n/, /CapBnd:\t0+\n/, /touch: .*Read-only/, /^0$/m, /^internet$/m])
    assert.match(seen, pattern);
  const denied = (python) => assert.match(`${spawnSync(...sandboxed(filter, '/usr/bin/python3', ['-c', python])).stderr}`, /PermissionError/, python);
  denied('import socket; socket.socket(socket.AF_UNIX)');
  denied('import os; os.chroot("/tmp")');

  const options = ['--listen', '127.0.0.1:0', '--token-file', tokens, '--scenes', scenes, '--record', at('state/recordings'), '--log-level', 'info'];
  const server = new Running(...sandboxed(filter, PROGRAM, ['serve', ...options]));
  const [, port] = await server.printed(/listening on http:\/\/127\.0\.0\.1:(\d+)\//);
  await exercise(`ws://127.0.0.1:${port}/ws`, 'foreign.glb');
  const log = fs.readFileSync(at('state/recordings/in-a-sandbox.jsonl'), 'utf8').trim().split('\n').map((line) => JSON.parse(line));
  assert.ok(log.some(({ message }) => message?.type === 'navigate'));
  await server.stop();
  assert.doesNotMatch(server.text, /reader_not_confined/);
});

test('a server shares a room, and an edge serves it, in their units\' sandboxes', { skip: cannotSandbox('systemd-analyze', '/usr/sbin/nats-server') }, async () => {
  const nats = await freePort();
  const queue = new Running('/usr/sbin/nats-server', ['-a', '127.0.0.1', '-p', nats, '-js', '-sd', at('nats')]);
  await queue.printed(/Server is ready/);
  const common = ['--listen', '127.0.0.1:0', '--token-file', tokens, '--nats', `nats://127.0.0.1:${nats}`];
  const server = new Running(...sandboxed(systemCallFilter(SERVER), PROGRAM, ['serve', VRUT_CAR, ...common, '--room', 'car']));
  // MemoryDenyWriteExecute=yes, where the kernel has it as an option of a process; prctl fails on others.
  const denied = 'import ctypes, os, sys; ctypes.CDLL(None).prctl(65, 1, 0, 0, 0); os.execv(sys.argv[1], sys.argv[1:])';
  const edge = new Running(...sandboxed(systemCallFilter(EDGE), '/usr/bin/python3', ['-c', denied, PROGRAM, 'edge', ...common]));
  const [, port] = await edge.printed(/listening on http:\/\/127\.0\.0\.1:(\d+)\//);
  const asked = (address) => fetch(`http://127.0.0.1:${port}${address}`, { headers: { authorization: `Bearer ${TOKENS.view}` } });
  await eventually('the room', async () => (await asked('/rooms/car/readyz')).ok);
  assert.equal((await asked('/rooms/car/frame.jpg?width=64&height=48')).headers.get('content-type'), 'image/jpeg');
  assert.ok((await asked('/metrics')).ok);
  for (const process of [edge, server, queue]) await process.stop();
});
