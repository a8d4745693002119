// What several files start from: the pose from which the stage is looked at, and a client that steers in that view.
import { createHash } from 'node:crypto';
import { setTimeout as sleep } from 'node:timers/promises';
import { ContractClient } from './contract-client.js';

export const VIEW = { width: 400, height: 300, pixelRatio: 1 };
export const POSE = { eye: [0, 0, 8], focus: [0, 0, 0], up: [0, 1, 0], center: [0, 0, 0], fov: 40 };

/** A client that has taken control to keep. */
export async function holder(t, server) {
  const client = await ContractClient.join(t, server);
  await client.ask({ type: 'control', action: 'take' });
  client.input = new Input(client);
  return client;
}

/** A holder in VIEW, at POSE with `camera` laid over it, a frame of which it has seen. */
export async function steering(t, server, camera = {}) {
  const client = await holder(t, server);
  await client.ask({ type: 'resize', ...VIEW });
  await client.patch({ camera: { ...POSE, ...camera }, navigation: null, selection: { node: null } });
  await client.frameOfNow(VIEW);
  return client;
}

/** A digest of the picture as it is now at full accuracy: equal where the pixels are. */
export async function pixelsNow(client, more = {}) {
  const { bytes } = await client.ask({ type: 'snapshot', width: 200, height: 150, format: 'png', ...more });
  return createHash('sha256').update(bytes.subarray(bytes.indexOf('IDAT'))).digest('hex');
}

/** Where a point of a face lies in VIEW, seen from POSE: CSS pixels. */
export const SEEN = {
  door: [256, 150], // about (1.1, 0, 0)
  pane: [134, 150], // about (-1.1, 0, 1)
  wall: [264, 214], // about (1.4, -1.4, -1)
  nothing: [5, 5],
};

/** Events with times of their own, which run ahead of the clock only as far as the contract lets them. */
export class Input {
  #client;
  #now = performance.now();

  constructor(client) {
    this.#client = client;
  }

  /** Lets the events' time pass. */
  async pass(ms) {
    this.#now += ms;
    const ahead = this.#now - performance.now();
    if (ahead > 500) await sleep(ahead - 400);
  }

  send(event) {
    this.#now = Math.max(this.#now, performance.now());
    return this.#client.send({ ...event, timeStamp: this.#now });
  }

  pointer(type, [x, y], more = {}) {
    return this.send({ type, pointerId: 1, pointerType: 'mouse', x, y, button: -1, buttons: 0, ...more });
  }

  /** `button` as in W3C: 0 left, 1 middle, 2 right. */
  down(at, button = 0, more = {}) {
    return this.pointer('pointerdown', at, { button, buttons: BUTTONS[button], ...more });
  }

  move(at, button = 0, more = {}) {
    return this.pointer('pointermove', at, { button: -1, buttons: BUTTONS[button], ...more });
  }

  up(at, button = 0, more = {}) {
    return this.pointer('pointerup', at, { button, buttons: 0, ...more });
  }

  /** Down, the moves, up: longer than a click. */
  async drag(points, button = 0, more = {}) {
    this.down(points[0], button, more);
    await this.pass(20);
    for (const point of points.slice(1)) this.move(point, button, more);
    this.up(points.at(-1), button, more);
    await this.#client.barrier();
  }

  async click(at, button = 0, more = {}) {
    this.down(at, button, more);
    await this.pass(20);
    this.up(at, button, more);
    await this.pass(60);
  }

  async doubleClick(at, button = 0, more = {}) {
    await this.click(at, button, more);
    await this.click(at, button, more);
    await this.#client.barrier();
  }

  finger(id) {
    return { pointerId: id, pointerType: 'touch' };
  }

  async key(key, code, modifiers = {}) {
    this.send({ type: 'keydown', key, code, ...modifiers });
    this.send({ type: 'keyup', key, code, ...modifiers });
    await this.#client.barrier();
  }

  async wheel(deltaY, deltaMode = 0, [x, y] = [200, 150], more = {}) {
    this.send({ type: 'wheel', x, y, deltaX: 0, deltaY, deltaMode, ...more });
    await this.#client.barrier();
  }
}

const BUTTONS = { 0: 1, 1: 4, 2: 2 };
