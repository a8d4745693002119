// How soon a large file is seen: from `open` to the new scene's first picture, in a server that shows another one;
// beside assimp's own import of the file, and, as a whole process that writes the picture, beside F3D. In turns in one
// run, since machines drift. VRUT_TEST_MODELS and VRUT_TEST_PEERS name the folders with a real car and with the
// generator of larger ones; without both there is nothing to measure: exit status 77.
//
//   cd tests/web; VRUT_PREVIEW=../../build/release/server/vrut-preview \
//     BENCH_SCENE_TEXT=../../build/release/tests/bench/bench_scene_text node bench/first-picture.mjs
import { execFileSync, spawnSync } from 'node:child_process';
import { copyFileSync, readdirSync, rmSync } from 'node:fs';
import path from 'node:path';
import WebSocket from 'ws';
import { startDisplay } from '../../bench/display.mjs';
import { PROGRAM, Server, sceneFile, temporaryFolder } from '../contract/server.js';

const SKIPPED = 77;
const ROUNDS = 5;
const SIZE = [1280, 720];
const WITHIN_MS = 60_000;
const SMALL = 'stage.vrut'; // shown before, so that nothing of a large one is still being worked on
const { VRUT_TEST_MODELS: models, VRUT_TEST_PEERS: peers } = process.env;
if (!models || !peers) {
  console.log('skipped: VRUT_TEST_MODELS and VRUT_TEST_PEERS name the folders with the models.');
  process.exit(SKIPPED);
}
const hasF3d = ['f3d', 'Xvfb'].every((name) => spawnSync('sh', ['-c', `command -v ${name}`]).status === 0);
if (!hasF3d) console.log('F3D is not there: apt-get install --no-install-recommends f3d xvfb xauth');

const folder = temporaryFolder();
copyFileSync(path.join(models, 'bmw_m6', 'bmw_m6.glb'), path.join(folder, 'bmw_m6.glb'));
copyFileSync(sceneFile(SMALL), path.join(folder, SMALL));
generate(5_000_000);
const display = hasF3d ? await startDisplay() : null;
const server = await Server.start({ options: ['--scenes', folder] });
try {
  for (const name of ['bmw_m6.glb', 'car5000000.glb']) await measure(name);
} finally {
  await server.stop();
  display?.process.kill();
}

function generate(triangles) {
  const generator = path.join(folder, 'generator');
  execFileSync(process.env.CXX ?? 'c++', ['-O2', '-o', generator, path.join(peers, 'car_generator.cpp')]);
  execFileSync(generator, [String(triangles), path.join(folder, `car${triangles}`)]);
  for (const file of readdirSync(folder)) if (!/\.(glb|vrut)$/.test(file)) rmSync(path.join(folder, file));
}

async function measure(name) {
  const file = path.join(folder, name);
  const out = path.join(folder, 'out.png');
  const runs = { loaded: [], seen: [], assimp: [], process: [], f3d: [] };
  for (let round = 0; round < ROUNDS; round += 1) {
    await open(SMALL);
    const { loaded, seen } = await open(name);
    runs.loaded.push(loaded);
    runs.seen.push(seen);
    runs.assimp.push(Number(/ms ([\d.]+)/.exec(execFileSync(process.env.BENCH_SCENE_TEXT, ['peer', file], { encoding: 'utf8' }))[1]));
    runs.process.push(took(PROGRAM, 'render', file, '-o', out, '--size', SIZE.join('x'), '--samples', '1'));
    if (hasF3d) runs.f3d.push(took('f3d', file, `--output=${out}`, `--resolution=${SIZE}`, '--no-background'));
  }
  const [loaded, seen, assimp, whole, f3d] = Object.values(runs).map(median);
  console.log(`${name}, medians of ${ROUNDS}: loaded ${loaded} ms after open, seen ${seen} ms; assimp's import ${assimp} ms`);
  console.log(`  seen over assimp's import: ${(seen / assimp).toFixed(2)}; loaded over it: ${(loaded / assimp).toFixed(2)}`);
  console.log(`  process, with PNG: ${whole} ms${hasF3d ? `; F3D ${f3d} ms: ours is ${(f3d / whole).toFixed(2)} times as fast` : ''}`);
}

/** In a server that has drawn before. @returns {Promise<{loaded: number, seen: number}>} milliseconds after `open` */
function open(scene) {
  const socket = new WebSocket(server.ws, 'vrut-preview.v1', { perMessageDeflate: false });
  const say = (message) => socket.send(JSON.stringify(message));
  return new Promise((resolve, reject) => {
    const limit = setTimeout(() => reject(new Error(`${scene}: no picture`)), WITHIN_MS);
    let start = 0;
    let loaded = 0;
    socket.on('open', () => {
      say({ type: 'hello', role: 'control' });
      say({ type: 'resize', width: SIZE[0], height: SIZE[1], pixelRatio: 1 });
      say({ type: 'frame' });
    });
    socket.on('message', (data, isBinary) => {
      const message = isBinary ? { type: 'picture' } : JSON.parse(data);
      if (message.type === 'picture' && start === 0) {
        start = performance.now();
        say({ type: 'open', id: 1, scene });
      } else if (message.type === 'picture' && loaded > 0) {
        clearTimeout(limit);
        socket.close();
        resolve({ loaded: Math.round(loaded), seen: Math.round(performance.now() - start) });
      } else if (message.type === 'loading' && message.done) {
        loaded = performance.now() - start;
      } else if (message.type === 'error' || message.refused) {
        reject(new Error(`${scene}: ${message.message ?? message.refused}`));
      }
      if (isBinary) say({ type: 'frame' });
    });
    socket.on('error', reject);
  });
}

function took(...command) {
  const start = performance.now();
  const env = { ...process.env, DISPLAY: display?.name ?? '', LIBGL_ALWAYS_SOFTWARE: '1' };
  const { status, stderr } = spawnSync(command[0], command.slice(1), { encoding: 'utf8', env });
  if (status !== 0) throw new Error(`${command.join(' ')}: ${stderr}`);
  return Math.round(performance.now() - start);
}

function median(values) {
  return values.sort((a, b) => a - b)[values.length >> 1];
}
