// The systemd unit: its score, and the program in as much of its sandbox as can be had without systemd.
'use strict';
const assert = require('node:assert/strict');
const { spawnSync } = require('node:child_process');
const fs = require('node:fs');
const path = require('node:path');
const { before, test } = require('node:test');
const { Client, Running, TOKENS, cannotSandbox, eventually, missing, output, temporaryFolder, tokenFile } = require('./helpers.js');

const { VRUT_BUILD, VRUT_CMAKE } = process.env;
const WORST_SCORE = 2.0;
const folder = temporaryFolder();
const at = (name) => path.join(folder, name);
const PROGRAM = at('usr/bin/vrut-preview');
const UNIT = at('usr/lib/systemd/system/vrut-preview.service');

before(() => output(VRUT_CMAKE, ['--install', VRUT_BUILD, '--prefix', at('usr')]));

/** What the unit says of a setting, word by word, a line each. */
const settings = (name) => fs.readFileSync(UNIT, 'utf8').split('\n')
  .filter((line) => line.startsWith(`${name}=`)).map((line) => line.slice(name.length + 1).split(' '));

test('systemd understands the unit, and scores it well', { skip: missing('systemd-analyze') }, () => {
  assert.equal(output('systemd-analyze', ['verify', UNIT]), '');
  const said = output('systemd-analyze', ['security', '--offline=true', '--no-pager', UNIT]);
  const score = Number(/Overall exposure level.*: ([\d.]+)/.exec(said)[1]);
  assert.ok(score > 0 && score <= WORST_SCORE, said);
  // Left out, standard error would go where standard output goes.
  assert.deepEqual([settings('StandardOutput'), settings('StandardError')], [[['null']], [['journal']]]);
});

/** The system calls of a name, which may be a group's. */
function systemCalls(name) {
  if (!name.startsWith('@')) return [name];
  const words = output('systemd-analyze', ['syscall-filter', '--no-pager', name]).split('\n').map((line) => line.trim());
  return words.filter((word) => word && !word.startsWith('#') && word !== name).flatMap(systemCalls);
}

function systemCallFilter() {
  const calls = new Set();
  for (const [first, ...others] of settings('SystemCallFilter')) {
    const denied = first.startsWith('~');
    for (const call of [first.replace('~', ''), ...others].flatMap(systemCalls))
      if (denied) calls.delete(call);
      else calls.add(call);
  }
  const allowed = JSON.stringify({ calls: [...calls], families: settings('RestrictAddressFamilies').flat() });
  const made = spawnSync('/usr/bin/python3', [path.join(__dirname, 'system_call_filter.py')], { input: allowed });
  assert.equal(made.status, 0, `${made.stderr}`);
  fs.writeFileSync(at('filter.bpf'), made.stdout);
}

/** As ProtectSystem=strict, ProtectHome, PrivateTmp, PrivateDevices, PrivateUsers and the like have it. */
function sandboxed(command, args) {
  const words = [
    '--unshare-user', '--unshare-ipc', '--unshare-pid', '--unshare-uts', '--uid', '61000', '--gid', '61000', '--cap-drop', 'ALL',
    '--ro-bind', '/', '/', '--dev', '/dev', '--proc', '/proc', '--tmpfs', '/home', '--tmpfs', '/tmp', '--tmpfs', folder,
    ...['usr', 'credentials'].flatMap((name) => ['--ro-bind', at(name), at(name)]), '--bind', at('state'), at('state'),
    '--clearenv', '--setenv', 'XDG_STATE_HOME', at('state'), '--setenv', 'XDG_CACHE_HOME', at('state/cache'),
    '--chdir', '/', '--new-session', '--die-with-parent', '--seccomp', '3', command, ...args,
  ];
  return ['bwrap', words, { stdio: ['ignore', 'pipe', 'pipe', fs.openSync(at('filter.bpf'), 'r')] }];
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

test('it draws, reads foreign files and records in the unit\'s sandbox', { skip: cannotSandbox('systemd-analyze') }, async () => {
  fs.mkdirSync(at('state/recordings'), { recursive: true });
  fs.mkdirSync(at('credentials'));
  const tokens = tokenFile(at('credentials'));
  const scenes = at('usr/share/vrut-preview/scenes');
  output(PROGRAM, ['convert', path.join(scenes, 'teaching/matrices.vrut'), path.join(scenes, 'foreign.glb')]);
  systemCallFilter();

  // The sandbox is one.
  const walls = spawnSync(...sandboxed('/bin/bash', ['-c', 'cat /proc/self/status; touch /usr/x; ls -A /home | wc -l; echo > /dev/udp/127.0.0.1/9 && echo internet']));
  const seen = `${walls.stdout}${walls.stderr}`;
  for (const pattern of [/NoNewPrivs:\t1/, /Seccomp:\t2/, /CapEff:\t0+\n/, /CapBnd:\t0+\n/, /touch: .*Read-only/, /^0$/m, /^internet$/m])
    assert.match(seen, pattern);
  const denied = (python) => assert.match(`${spawnSync(...sandboxed('/usr/bin/python3', ['-c', python])).stderr}`, /PermissionError/, python);
  denied('import socket; socket.socket(socket.AF_UNIX)');
  denied('import os; os.chroot("/tmp")');

  const options = ['--listen', '127.0.0.1:0', '--token-file', tokens, '--scenes', scenes, '--record', at('state/recordings'), '--log-level', 'info'];
  const server = new Running(...sandboxed(PROGRAM, ['serve', ...options]));
  const [, port] = await server.printed(/listening on http:\/\/127\.0\.0\.1:(\d+)\//);
  await exercise(`ws://127.0.0.1:${port}/ws`, 'foreign.glb');
  const log = fs.readFileSync(at('state/recordings/in-a-sandbox.jsonl'), 'utf8').trim().split('\n').map((line) => JSON.parse(line));
  assert.ok(log.some(({ message }) => message?.type === 'navigate'));
  await server.stop();
  assert.doesNotMatch(server.text, /reader_not_confined/);
});
