// The Debian packages that `cpack` makes: what is in them, one version everywhere, and other projects that use the client.
'use strict';
const assert = require('node:assert/strict');
const fs = require('node:fs');
const path = require('node:path');
const { before, test } = require('node:test');
const { Client, DEPLOY, Running, TOKENS, debs, files, missing, output, temporaryFolder, tokenFile } = require('./helpers.js');

const { VRUT_PREVIEW, VRUT_CAR, VRUT_BUILD, VRUT_CMAKE } = process.env;
const SOURCE = path.dirname(DEPLOY);
const folder = temporaryFolder();
const at = (name) => path.join(folder, name);
const SERVER = 'vrut-preview', CLIENT = 'libvrut-client-dev';
const skip = missing('cpack', 'dpkg-shlibdeps', 'file');
let made;

const version = /^CMAKE_PROJECT_VERSION:\w+=(.*)$/m.exec(fs.readFileSync(path.join(VRUT_BUILD, 'CMakeCache.txt'), 'utf8'))[1];
const field = (name, key) => output('dpkg-deb', ['--field', made[name], key]).trim();

before(() => {
  if (skip) return;
  made = debs(at('made'));
  for (const name of [SERVER, CLIENT]) output('dpkg-deb', ['--raw-extract', made[name], at(name)]);
});

/** A server of the car, and where it listens. */
async function served() {
  const server = new Running(VRUT_PREVIEW, ['serve', VRUT_CAR, '--listen', '127.0.0.1:0', '--token-file', tokenFile(folder)]);
  const [, port] = await server.printed(/listening on http:\/\/127\.0\.0\.1:(\d+)\//);
  return { server, port };
}

test('there is a package of the server and one of its client, named as Debian does', { skip }, () => {
  assert.deepEqual(Object.keys(made).sort(), [CLIENT, SERVER]);
  for (const name of [SERVER, CLIENT])
    assert.equal(path.basename(made[name]), `${name}_${version}_${output('dpkg', ['--print-architecture']).trim()}.deb`);
});

test('the server\'s package has all that is installed, and the client\'s none of it', { skip }, () => {
  output(VRUT_CMAKE, ['--install', VRUT_BUILD, '--prefix', '/usr'], { env: { ...process.env, DESTDIR: at('installed') } });
  const installed = files(at('installed/usr'));
  const packaged = files(at(`${SERVER}/usr`));
  const ofDebian = [`share/doc/${SERVER}/changelog.gz`, `share/lintian/overrides/${SERVER}`];
  const compressed = installed.map((name) => name.replace(/^share\/man\/.*/, '$&.gz'));
  assert.deepEqual(packaged, [...compressed, ...ofDebian].sort());
  assert.deepEqual(files(at(`${CLIENT}/usr`)).filter((name) => installed.includes(name)), []);
  assert.deepEqual(fs.readdirSync(at(SERVER)).sort(), ['DEBIAN', 'usr']);
  for (const [name, command] of [['vrut-preview', 'serve'], ['vrut-preview-edge', 'edge']]) {
    const unit = fs.readFileSync(at(`${SERVER}/usr/lib/systemd/system/${name}.service`), 'utf8');
    assert.ok(unit.includes(`ExecStart=/usr/bin/vrut-preview ${command} `), unit);
    // What Debian's scripts do with one unit, they do with the other.
    for (const script of ['postinst', 'prerm', 'postrm'])
      assert.ok(fs.readFileSync(at(`${SERVER}/DEBIAN/${script}`), 'utf8').includes(`${name}.service`), script);
  }
});

test('it depends on what it is linked with, and on a driver, and recommends what films need', { skip }, () => {
  const names = field(SERVER, 'Depends').split(', ').map((word) => word.split(' ')[0]);
  for (const name of ['libc6', 'libstdc++6', 'libegl1', 'libassimp5', 'libgl1-mesa-dri']) assert.ok(names.includes(name), `${names}`);
  assert.equal(field(SERVER, 'Recommends'), 'libavformat59, libswscale6');
});

test('lintian finds no error', { skip: skip || missing('lintian') }, () => {
  output('lintian', ['--fail-on', 'error', '--allow-root', ...Object.values(made)]);
});

test('the program, its welcome and the packages have the version of the build', { skip }, async () => {
  assert.match(version, /^\d+\.\d+\.\d+$/);
  assert.equal(output(VRUT_PREVIEW, ['--version']).trim(), `vrut-preview ${version}`);
  for (const name of [SERVER, CLIENT]) assert.equal(field(name, 'Version'), version);
  const { server, port } = await served();
  const client = await Client.join(`ws://127.0.0.1:${port}/ws`, TOKENS.view);
  assert.equal((await client.text('welcome')).server, version);
  await server.stop();
});

test('another project finds the installed client, by CMake and by pkg-config, and follows a server', { skip: skip || missing('pkg-config', 'c++') }, async () => {
  const usr = at(`${CLIENT}/usr`);
  const example = path.join(usr, `share/doc/${CLIENT}/example_host.cpp`);

  fs.mkdirSync(at('host'));
  fs.writeFileSync(at('host/CMakeLists.txt'), `cmake_minimum_required(VERSION 3.16)
project(host LANGUAGES CXX)
find_package(vrut_client ${version} EXACT REQUIRED)
add_executable(host ${example})
target_link_libraries(host PRIVATE vrut_client::vrut_client)
target_compile_features(host PRIVATE cxx_std_17)
`);
  output(VRUT_CMAKE, ['-S', at('host'), '-B', at('host/build'), `-DCMAKE_PREFIX_PATH=${usr}`]);
  output(VRUT_CMAKE, ['--build', at('host/build')]);

  const asked = (...words) => output('pkg-config', [...words, 'vrut_client'], { env: { ...process.env, PKG_CONFIG_PATH: path.join(usr, 'lib/pkgconfig') } }).trim();
  assert.equal(asked('--modversion'), version);
  output('c++', ['-std=c++17', example, '-o', at('host/by-pkg-config'), ...asked('--cflags', '--libs').split(' ')]);

  const { server, port } = await served();
  for (const program of ['host/build/host', 'host/by-pkg-config']) {
    const host = new Running(at(program), ['--port', port, '--token', TOKENS.control]);
    await host.printed(/^revision \d+ eye /m);
    assert.equal(await host.stop('SIGINT'), 0);
  }
  const refused = new Running(at('host/build/host'), ['--port', port, '--token', 'guess']);
  await refused.printed(/the token is wrong/);
  await refused.stop('SIGINT');
  await server.stop();
});

test('a host that uses Boost itself sees nothing of the client\'s', { skip: skip || missing('nm') }, () => {
  const seen = output('nm', ['--extern-only', '--defined-only', '--demangle', at(`${CLIENT}/usr/lib/libvrut_client.a`)]);
  const names = [...seen.matchAll(/^[0-9a-f]+ \w (.*)$/gm)].map(([, name]) => name);
  assert.ok(names.includes('vrut::client::PreviewClient::PreviewClient(vrut::client::Options)'));
  assert.deepEqual(names.filter((name) => !/^(bool )?vrut::client::/.test(name)), []);
});
