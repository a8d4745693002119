// Records the sessions of tests/data/glass, which `chart --glass` measures: the program serves the car of 20,000
// triangles, and a client sends what hands at a tablet do, 60 events a second.
//
//   VRUT_PREVIEW=build/release/server/vrut-preview VRUT_CAR=build/release/scenes/car/car-20k.vrut node tests/measure/record-glass.mjs
import { copyFileSync, mkdirSync, mkdtempSync } from 'node:fs';
import { tmpdir } from 'node:os';
import path from 'node:path';
import { setTimeout as sleep } from 'node:timers/promises';
import { fileURLToPath } from 'node:url';
import { ContractClient } from '../web/contract/contract-client.js';
import { Server } from '../web/contract/server.js';

const OUT = fileURLToPath(new URL('../data/glass', import.meta.url));
const VIEW = { width: 1180, height: 820, pixelRatio: 1 };
const MIDDLE = [590, 410];

const t = { after: () => {} };

class Hand {
  constructor(client, id) {
    Object.assign(this, { client, id, at: MIDDLE });
  }
  #send(type, at, more) {
    this.at = at;
    this.client.send({ type, x: at[0], y: at[1], pointerId: this.id, pointerType: 'touch', button: -1, buttons: 1, timeStamp: performance.now(), ...more });
  }
  down(at) {
    this.#send('pointerdown', at, { button: 0 });
  }
  move(at) {
    this.#send('pointermove', at);
  }
  up() {
    this.#send('pointerup', this.at, { button: 0, buttons: 0 });
  }
}

/** Calls `step` with 0 to 1, at 60 a second. */
async function during(seconds, step) {
  const begin = performance.now();
  for (let i = 1; i <= seconds * 60; ++i) {
    await sleep(Math.max(0, begin + (1000 * i) / 60 - performance.now()));
    step(i / (seconds * 60));
  }
}
/** Begins and ends slowly, as hands do. */
const eased = (x) => x * x * (3 - 2 * x);

async function drag(client, from, to, seconds) {
  const finger = new Hand(client, 1);
  finger.down(from);
  await during(seconds, (part) => finger.move([0, 1].map((k) => from[k] + (to[k] - from[k]) * eased(part))));
  finger.up();
}

async function pinch(client, from, to, seconds) {
  const fingers = [new Hand(client, 1), new Hand(client, 2)];
  fingers.forEach((finger, i) => finger.down(from[i]));
  await during(seconds, (part) => fingers.forEach((finger, i) => finger.move([0, 1].map((k) => from[i][k] + (to[i][k] - from[i][k]) * eased(part)))));
  fingers.forEach((finger) => finger.up());
}

const SESSIONS = {
  'turn-slowly': (client) => drag(client, [500, 420], [640, 400], 3),
  'turn-fast': async (client) => {
    await drag(client, [250, 420], [950, 400], 0.8);
    await sleep(300);
    await drag(client, [900, 420], [300, 460], 0.8);
  },
  'turn-back-and-forth': async (client) => {
    const finger = new Hand(client, 1);
    finger.down(MIDDLE);
    await during(3, (part) => finger.move([590 + 200 * Math.sin(part * 12), 410 + 40 * Math.sin(part * 7)]));
    finger.up();
  },
  'zoom-and-shift': async (client) => {
    await pinch(client, [[560, 400], [620, 420]], [[420, 360], [760, 470]], 1);
    await pinch(client, [[520, 400], [660, 420]], [[420, 330], [560, 350]], 1);
  },
  wheel: async (client) => {
    for (const way of [-1, 1]) {
      await during(0.6, () => client.send({ type: 'wheel', x: 700, y: 420, deltaX: 0, deltaY: 12 * way, deltaMode: 0, timeStamp: performance.now() }));
      await sleep(300);
    }
  },
  flight: async (client) => {
    const { eye } = client.state.camera;
    const id = client.send({ type: 'fly', keyframes: [{ at: 1000, camera: { eye: [-eye[0], eye[1] * 1.5, eye[2]] } }, { at: 2000, camera: { eye: [eye[2], eye[1], -eye[0]] } }] });
    await client.until('the end of the flight', () => client.texts.find((text) => text.type === 'flown' && text.id === id));
  },
};

mkdirSync(OUT, { recursive: true });
const folder = mkdtempSync(path.join(tmpdir(), 'vrut-preview-'));
const server = await Server.start({ scene: process.env.VRUT_CAR, options: ['--record', folder] });
for (const [name, act] of Object.entries(SESSIONS)) {
  const client = await ContractClient.join(t, server);
  await client.ask({ type: 'resize', ...VIEW });
  await client.ask({ type: 'patch', patch: { camera: client.state.views.home } });
  await client.ask({ type: 'record', action: 'start', name });
  await sleep(200);
  await act(client);
  await sleep(400);
  await client.ask({ type: 'record', action: 'stop' });
  copyFileSync(path.join(folder, `${name}.jsonl`), path.join(OUT, `${name}.jsonl`));
  await client.leave();
}
await server.stop?.();
process.exit(0);
