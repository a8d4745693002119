// Conversions: what is written draws the same picture, but for what is told.
'use strict';
const assert = require('node:assert/strict');
const { spawnSync } = require('node:child_process');
const fs = require('node:fs');
const os = require('node:os');
const path = require('node:path');
const { after, test } = require('node:test');

const PROGRAM = process.env.VRUT_PREVIEW;
const CAR = process.env.VRUT_CAR;
const TEACHING = path.join(process.env.VRUT_SCENES, 'teaching');
const MODELS = process.env.VRUT_TEST_MODELS;
const folder = fs.mkdtempSync(path.join(os.tmpdir(), 'vrut-preview-'));
after(() => fs.rmSync(folder, { recursive: true }));

const file = (name) => path.join(folder, name);
const run = (...options) => spawnSync(PROGRAM, options, { encoding: 'utf8' });

function succeeds(...options) {
  const result = run(...options);
  assert.equal(result.status, 0, result.stderr);
  return result;
}

function fails(status, culprit, ...options) {
  const result = run(...options);
  assert.equal(result.status, status, `${options}: ${result.stderr}`);
  assert.equal(result.stderr.trim().split('\n').length, 1, result.stderr);
  assert.match(result.stderr, culprit);
  assert.equal(result.stdout, '');
}

// What the conversion tells, of the written file.
function convert(scene, out) {
  const { stderr, stdout } = succeeds('convert', scene, out);
  assert.equal(stdout, '');
  return stderr.split('\n').filter((line) => line.startsWith(out));
}

// Written files have no backgrounds, so none is drawn, nor the studio, which is not in them.
function draw(scene, name) {
  succeeds('render', scene, '-o', file(name), '--size', '320x240', '--samples', '1', '--background', 'none', '--studio', 'off');
  return file(name);
}

function compare(before, after) {
  return JSON.parse(succeeds('compare', before, after, '--json').stdout);
}

const GLTF_LOOKS = /a tenth of its diffuse|highlight|reflects|picture becomes white/;

// The picture of the scene's GLB file. With no more told than what no picture shows, it is the same but for
// rounding: positions as floats and colours through two transfer curves move a byte by 1, and a pixel at an
// edge to its other side. Where materials change as is told, they stay alike: an ambient colour that becomes
// a tenth of the diffuse one moves a surface by less than 26 of 255, which is 20 dB where it covers everything.
function checkGlb(scene, before, lost) {
  const difference = compare(before, draw(file('x.glb'), 'glb.png'));
  const bound = lost.some((line) => GLTF_LOOKS.test(line)) ? 20 : 45;
  assert.ok(difference.psnr === null || difference.psnr > bound, `${scene}: ${difference.psnr} dB`);
}

function checkConversions(scene) {
  const before = draw(scene, 'before.png');
  assert.deepEqual(convert(scene, file('x.vrut')), []);
  assert.equal(compare(before, draw(file('x.vrut'), 'vrut.png')).maximum, 0, scene);
  checkGlb(scene, before, convert(scene, file('x.glb')));
  for (const name of ['x.obj', 'x.stl']) {
    convert(scene, file(name));
    assert.equal(triangles(file(name)), triangles(file('x.glb')), `${scene} ${name}`);
  }
}

const triangles = (scene) => JSON.parse(succeeds('info', scene, '--json').stdout).triangles;

test('scenes convert, and draw the same picture', () => {
  for (const name of ['hierarchy', 'materials', 'matrices', 'texture', 'texture-holes', 'camera', 'light-spot', 'two-sided', 'glass', 'switch'])
    checkConversions(path.join(TEACHING, `${name}.vrut`));
  checkConversions(CAR);
});

test('models convert, and draw the same picture', { skip: MODELS ? false : 'VRUT_TEST_MODELS names no folder' }, () => {
  // Those in glTF lose nothing in a GLB file: they are drawn the same, to the last pixel but rounding.
  const models = ['bmw_m6/bmw_m6.glb', 'osb/few_cubes.osb', 'hatchback/hatchback/meshes/hatchback.obj',
    'jeep/2013_ASCII/jeep1.fbx', 'jeep/2013_BINARY/jeep1.fbx'];
  for (const name of fs.readdirSync(path.join(MODELS, 'racing')))
    if (name.endsWith('.glb')) models.push(path.join('racing', name));
  for (const model of models) checkConversions(path.join(MODELS, model));
});

test('textures come from other folders, and z may be up', () => {
  fs.mkdirSync(file('other'));
  fs.writeFileSync(file('other/my.mtl'), 'newmtl A\nmap_Kd /home/me/letter.png\n');
  fs.writeFileSync(file('other/my.obj'), 'mtllib my.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 2\nvt 0 0\nusemtl A\nf 1/1 2/1 3/1\n');
  const textures = path.join(TEACHING, 'textures');
  const options = ['--textures', folder, '--textures', textures, '--up-axis', 'z'];
  assert.match(succeeds('convert', file('other/my.obj'), file('x.vrut')).stderr, /without its texture/);
  assert.doesNotMatch(succeeds('convert', ...options, file('other/my.obj'), file('x.vrut')).stderr, /without its texture/);
  assert.match(fs.readFileSync(file('x.vrut'), 'utf8'), /image "x\.textures\/0-letter\.png"/);
  assert.match(fs.readFileSync(file('x.vrut'), 'utf8'), /matrix 1 0 0 0 +0 0 1 0 +0 -1 0 0 +0 0 0 1/);
  assert.doesNotMatch(succeeds('render', ...options, file('other/my.obj'), '-o', file('x.png'), '--size', '16x9').stderr, /without its texture/);
  for (const command of ['convert', 'serve', 'render'])
    fails(2, /--textures: there is no folder 'none'/, command, file('other/my.obj'), '--textures', 'none');
});

test('what has no light is shown in a studio, unless it is scene text, or as --studio says', () => {
  fs.writeFileSync(file('cube.obj'), 'v 0 0 0\nv 1 0 0\nv 1 0 1\nv 0 1 0\nf 1 2 3\nf 1 3 4\nf 3 2 4\nf 2 1 4\n');
  assert.equal(succeeds('convert', file('cube.obj'), file('cube.vrut')).stderr, '');
  for (const name of ['cube.obj', 'cube.vrut']) assert.doesNotMatch(succeeds('info', file(name)).stdout, /Studio|shadow/);
  const shown = (name, ...options) => {
    succeeds('render', file(name), '-o', file('x.png'), '--size', '64x36', ...options);
    return fs.readFileSync(file('x.png'));
  };
  const on = shown('cube.obj', '--studio', 'on'), off = shown('cube.obj', '--studio', 'off');
  assert.notDeepEqual(on, off);
  assert.deepEqual(shown('cube.obj'), on);
  assert.deepEqual(shown('cube.vrut'), off);
  assert.deepEqual(shown('cube.vrut', '--studio', 'on'), on);
  for (const command of ['serve', 'render', 'replay', 'chart'])
    fails(2, /--studio: expected on\|off, found 'no'/, command, file('cube.obj'), '--studio', 'no');
  for (const command of ['info', 'convert']) fails(2, /--studio/, command, file('cube.obj'), '--studio', 'on');
});

test('what is lost is told, a line each', () => {
  const lost = convert(path.join(TEACHING, 'cube-map.vrut'), file('x.glb'));
  assert.ok(lost.includes(`${file('x.glb')}: a background is lost`), lost.join('\n'));
});

test('wrong usage ends with status 2, and what cannot be done with 1', () => {
  const scene = path.join(TEACHING, 'triangle.vrut');
  fails(2, /IN is required/, 'convert');
  fails(2, /OUT is required/, 'convert', scene);
  fails(2, /x\.fbx: .*\.vrut, \.obj, \.stl, \.glb/, 'convert', scene, file('x.fbx'));
  fs.copyFileSync(scene, file('same.vrut'));
  fails(2, /own file/, 'convert', file('same.vrut'), path.join(folder, '.', 'same.vrut'));
  assert.deepEqual(fs.readFileSync(file('same.vrut')), fs.readFileSync(scene));
  fails(1, /none\.vrut: there is no such file/, 'convert', file('none.vrut'), file('x.glb'));
  fails(1, /y\.glb: it cannot be written/, 'convert', scene, file('a/b/y.glb'));
  fs.writeFileSync(file('car.csb'), 'anything');
  fails(1, /CSB format is not supported/, 'convert', file('car.csb'), file('x.glb'));
});

test('what a scene is read from is not written over', () => {
  fs.mkdirSync(file('in/car.textures'), { recursive: true });
  const letter = path.join(TEACHING, 'textures', 'letter.png');
  for (const name of ['in/x.png', 'in/car.textures/0-x.png']) fs.copyFileSync(letter, file(name));
  fs.writeFileSync(file('in/car.mtl'), 'newmtl A\nmap_Kd x.png\nnewmtl B\nmap_Kd car.textures/0-x.png\n');
  fs.writeFileSync(file('in/my.obj'), 'mtllib car.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl A\nf 1/1 2/1 3/1\nusemtl B\nf 3/1 2/1 1/1\n');
  const before = fs.readFileSync(file('in/car.mtl'), 'utf8');
  fails(1, /car\.textures\/0-x\.png: the scene was read from this file/, 'convert', file('in/my.obj'), file('in/car.vrut'));
  fs.writeFileSync(file('in/car.mtl'), 'newmtl A\n');
  fails(1, /car\.mtl: the scene was read from this file/, 'convert', file('in/my.obj'), file('in/car.obj'));
  assert.deepEqual(fs.readdirSync(file('in')).sort(), ['car.mtl', 'car.textures', 'my.obj', 'x.png']);
  fs.writeFileSync(file('in/car.mtl'), before);
  succeeds('convert', file('in/my.obj'), file('in/other.obj'));
});

test('a file that does not fit leaves the old one', () => {
  fs.writeFileSync(file('old.obj'), 'old');
  // In blocks of 1 KiB; the signal would end the program before it could tell.
  const limited = spawnSync('bash', ['-c', 'trap "" XFSZ; ulimit -f 8; exec "$@"', 'bash', PROGRAM, 'convert', CAR, file('old.obj')], { encoding: 'utf8' });
  assert.equal(limited.status, 1, limited.stderr);
  assert.match(limited.stderr, /it cannot be written: File too large\n$/);
  assert.equal(fs.readFileSync(file('old.obj'), 'utf8'), 'old');
  assert.deepEqual(fs.readdirSync(folder).filter((name) => name.endsWith('.part') || name === 'old.textures' || name === 'old.mtl'), []);
});
