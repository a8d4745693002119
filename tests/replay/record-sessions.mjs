// Records the sessions of tests/data/logs anew, by the real program over its WebSocket, with the scenes of
// tests/data/scenes: NAME.jsonl is the log, NAME.camera.json the camera as the script saw it at the end, and
// NAME.measured.json what was measured then, if anything; NAME.walls.json cameras that a host had on the way.
//
//   VRUT_PREVIEW=build/release/vrut-preview node tests/replay/record-sessions.mjs [NAME…]
//
// To be run when a scene or the log's format has changed; then VRUT_RENEW=1 test_replay_pictures for each, and a look
// at the pictures. `ws` is a module of tests/web.
import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { copyFileSync, mkdirSync, mkdtempSync, rmSync, statSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import path from 'node:path';
import { setTimeout as sleep } from 'node:timers/promises';
import { fileURLToPath } from 'node:url';
import { ContractClient } from '../web/contract/contract-client.js';
import { PROGRAM, Server } from '../web/contract/server.js';

const SCENES = fileURLToPath(new URL('../data/scenes', import.meta.url));
const LOGS = fileURLToPath(new URL('../data/logs', import.meta.url));
const ROOM = path.join(SCENES, 'room.vrut');
const LARGEST = 60_000; // bytes of a log
const VIEW = { width: 400, height: 250, pixelRatio: 1 };
const BETWEEN_FRAMES_MS = 20;
const BUTTONS = { 0: 1, 1: 4, 2: 2 };
const quietHolder = () => sleep(1050);

/** Numbers from 0 to 1, the same in each run. */
function dice(seed) {
  let state = seed;
  return () => {
    state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
    return state / 2 ** 32;
  };
}

/** One client: its messages, and what hands do. */
class Participant {
  constructor(client) {
    this.client = client;
    this.dice = dice(7);
  }

  static async join(session, role = 'control', view = undefined, named = {}) {
    const participant = new Participant(await ContractClient.connect(session.server));
    session.participants.push(participant);
    const { client } = participant;
    client.send({ type: 'hello', role, ...named }, { id: null });
    await client.until('state', () => client.state);
    if (view) await client.ask({ type: 'resize', ...view });
    return participant;
  }

  /** Grants frames as a page does, so that pictures are drawn between the moves. */
  watch() {
    const grant = () => this.client.closed || this.client.send({ type: 'frame' }, { id: null });
    this.client.socket.on('message', (_, binary) => binary && setTimeout(grant, BETWEEN_FRAMES_MS));
    grant();
  }

  ask(message) {
    return this.client.ask(message);
  }

  get state() {
    return this.client.state;
  }

  /** The newest frame that has come. */
  get frame() {
    return this.client.frames.at(-1)?.header.frame;
  }

  pointer(type, at, more) {
    this.client.send({
      type, x: at[0], y: at[1], pointerId: 1, pointerType: 'mouse', button: -1, buttons: 0,
      timeStamp: performance.now(), frame: this.frame, ...more,
    });
  }

  down(at, button = 0, more = {}) {
    this.pointer('pointerdown', at, { button, buttons: BUTTONS[button], ...more });
  }

  move(at, button = 0, more = {}) {
    this.pointer('pointermove', at, { buttons: BUTTONS[button], frame: undefined, ...more });
  }

  up(at, button = 0, more = {}) {
    this.pointer('pointerup', at, { button, ...more });
  }

  /** `count` moves from one place to another, a little off the way and not in step, as a hand does it. */
  async glide(from, to, count, button = 0, more = {}) {
    for (let i = 1; i <= count; ++i) {
      const [x, y] = [0, 1].map((k) => from[k] + ((to[k] - from[k]) * i) / count + this.dice() - 0.5);
      this.move([x, y], button, more);
      if (this.dice() < 0.6) await sleep(this.dice() * 14); // some come two or three at once
    }
  }

  async drag(from, to, count, button = 0, more = {}) {
    this.down(from, button, more);
    await this.glide(from, to, count, button, more);
    this.up(to, button, more);
  }

  async tap(at, button = 0, more = {}) {
    this.down(at, button, more);
    await sleep(30);
    this.up(at, button, more);
    await sleep(50);
  }

  wheel(deltaY, deltaMode = 0) {
    this.client.send({ type: 'wheel', x: 200, y: 125, deltaX: 0, deltaY, deltaMode, timeStamp: performance.now() });
  }

  key(type, key, code, more = {}) {
    this.client.send({ type, key, code, timeStamp: performance.now(), ...more });
  }

  strike(key, code, more = {}) {
    this.key('keydown', key, code, more);
    this.key('keyup', key, code, more);
  }

  /** A frame of the camera as it is now has come. */
  async seen() {
    const { camera } = this.state;
    const isNow = (frame) => ['eye', 'focus', 'up'].every((m) => `${frame.header.camera[m]}` === `${camera[m]}`);
    await this.client.until('a frame of now', () => this.client.frames.some(isNow));
  }

  record(name) {
    return this.ask({ type: 'record', action: 'start', name });
  }
}

const finger = (pointerId) => ({ pointerId, pointerType: 'touch' });

/** Each begins its recording by `record(name)`; it ends behind them, by the participant that they return. */
const SESSIONS = {
  orbit: async (session, name) => {
    const user = await Participant.join(session, 'control', VIEW);
    user.watch();
    await user.record(name);
    await user.drag([120, 140], [260, 90], 40, 0, finger(4));
    for (const [delta, mode] of [[-120, 0], [-37.5, 0], [3, 1], [-0.5, 2]]) {
      user.wheel(delta, mode);
      await sleep(user.dice() * 30);
    }
    await user.drag([300, 60], [180, 200.25], 24);
    await user.drag([200, 125], [230, 118], 12, 2);
    return user;
  },

  pinch: async (session, name) => {
    const user = await Participant.join(session, 'control', VIEW);
    user.watch();
    await user.record(name);
    const [one, two, three] = [finger(11), finger(12), finger(13)];
    user.down([170, 130], 0, one);
    user.down([230, 120], 0, two);
    for (let i = 1; i <= 24; ++i) {
      user.move([170 - 3 * i + user.dice(), 130 + i], 0, one);
      if (i % 3) user.move([230 + 2.5 * i, 120 + user.dice()], 0, two);
      if (i === 12) user.down([60, 60], 0, three); // drags nothing
      if (i > 12) user.move([60 + i, 60 - i], 0, three);
      await sleep(user.dice() * 8);
    }
    user.up([98, 154], 0, one); // now the second and third drag
    await user.glide([290, 120], [250, 150], 6, 0, two);
    user.up([84, 36], 0, three);
    await user.glide([250, 150], [240, 170], 6, 0, two); // one finger turns
    user.pointer('pointercancel', [240, 170], two);
    user.down([120, 60], 0, one); // back, until all is seen
    user.down([280, 190], 0, two);
    for (let i = 1; i <= 12; ++i) {
      user.move([120 + 5.5 * i, 60 + 4 * i], 0, one);
      user.move([280 - 5.5 * i, 190 - 4 * i], 0, two);
    }
    user.up([186, 108], 0, one);
    user.up([214, 142], 0, two);
    return user;
  },

  'select-and-centre': async (session, name) => {
    const user = await Participant.join(session, 'control', VIEW);
    user.watch();
    await user.client.until('a frame', () => user.frame);
    await user.record(name);
    for (const [part, node] of [['the furniture', 3], ['of that the red box', 5]]) {
      await user.tap([176, 125], 0, finger(2));
      await user.tap([177, 126], 0, finger(2));
      await user.client.until(part, () => user.state.selection.node === node);
    }
    await user.tap([222, 122], 2); // the blue box: the scene turns about it from here on
    await user.tap([222, 122], 2);
    await user.client.until('another centre', () => user.state.camera.center[0] > 0.1);
    await user.drag([100, 100], [160, 110], 10);
    await user.client.barrier();
    await user.seen();
    const { frame, camera } = user.client.frames.at(-1).header;
    user.down([330, 60], 0, finger(3)); // rests
    await sleep(300);
    await user.tap([110, 158], 0, finger(4)); // the stool
    user.up([330, 60], 0, finger(3));
    await user.client.until('the stool', () => `${user.state.camera.focus}` !== `${camera.focus}`);
    await user.seen();
    // What that frame showed, however the camera stands now.
    const picked = await user.ask({ type: 'pick', x: 200, y: 120, frame, then: 'lookAt' });
    assert.ok(picked.node > 0);
    user.strike('f', 'KeyF'); // fits the red box
    await user.client.barrier();
    await user.drag([200, 100], [150, 120], 12, 0, finger(5));
    return user;
  },

  'flight-and-touch': async (session, name) => {
    const user = await Participant.join(session, 'control', VIEW);
    user.watch();
    await user.record(name);
    const keyframes = [
      { at: 400, camera: { eye: [3, 2, 3.5] } },
      { at: 900, camera: { eye: [2.5, 1.2, -1], focus: [0, 0.9, 0], fov: 60 } },
      { at: 1500, camera: { eye: [-4, 3, 1] } },
    ];
    user.client.send({ type: 'fly', keyframes });
    await sleep(700);
    user.down([200, 100], 0, finger(1));
    await user.glide([200, 100], [170, 115], 8, 0, finger(1));
    const flown = await user.client.texted('flown');
    assert.equal(flown.completed, false);
    user.up([170, 115], 0, finger(1));
    await user.ask({ type: 'navigate', rotate: [12.5, -3], pan: [0.05, 0.02], zoom: 1.2 });
    const second = user.client.send({ type: 'fly', easing: 'linear', keyframes: [{ at: 150, camera: { focus: [0.35, 1.1, 0.1] } }] });
    assert.equal((await user.client.texted('flown', (text) => text.id === second)).completed, true);
    user.wheel(-60);
    return user;
  },

  contend: async (session, name) => {
    const user = await Participant.join(session, 'control', VIEW);
    user.watch();
    await user.record(name);
    await user.drag([120, 140], [160, 120], 8);
    const guest = await Participant.join(session, 'control', { width: 250, height: 400, pixelRatio: 2 });
    await guest.client.refused({ type: 'navigate', rotate: [90, 0] }, 'not-in-control', { valid: true });
    await guest.ask({ type: 'control', action: 'ask' });
    await user.ask({ type: 'control', action: 'give', client: guest.client.id });
    await guest.drag([60, 200], [120, 180], 10, 0, finger(1)); // measured in the view that it began in
    await guest.client.barrier();
    assert.equal(guest.client.isHolder, true);
    await user.client.refused({ type: 'fit' }, 'not-in-control', { valid: true });
    await user.ask({ type: 'control', action: 'take' });
    await user.drag([200, 100], [190, 160], 6);
    await quietHolder();
    await guest.client.refused({ type: 'fit' }, 'not-in-control', { valid: true }); // kept
    await user.ask({ type: 'control', action: 'release' });
    await guest.ask({ type: 'navigate', zoom: 0.9 });
    guest.down([100, 100], 0, finger(2));
    await guest.glide([100, 100], [140, 90], 6, 0, finger(2));
    await guest.client.barrier();
    guest.client.socket.terminate(); // in mid-drag
    await user.client.until('control to come back', () => user.client.isHolder);
    await quietHolder();
    const host = await Participant.join(session, 'host');
    await host.ask({ type: 'patch', patch: { camera: { eye: [2.5, 1.9, 4], focus: [0.2, 1, 0] } } });
    await host.ask({ type: 'shown', revision: host.client.revision });
    await host.client.refused({ type: 'patch', patch: { camera: { fov: 60 }, renderer: { wireframe: true } } }, 'not-allowed', { valid: true });
    const viewer = await Participant.join(session, 'view');
    await viewer.client.refused({ type: 'navigate', zoom: 3 }, 'not-allowed', { valid: true });
    await user.ask({ type: 'control', action: 'take' });
    await user.drag([200, 125], [160, 130], 8, 2);
    return user;
  },

  sections: async (session, name) => {
    const user = await Participant.join(session, 'control', VIEW);
    user.watch();
    await user.record(name);
    await user.ask({ type: 'patch', patch: { camera: { eye: [2.5, 2.2, 4], focus: [0, 0.6, 0] }, navigation: { turnAbout: 'touched' } } });
    for (const distance of [0.6, 0.35, 0.1]) {
      await user.ask({ type: 'patch', patch: { sections: { Front: { normal: [0, 0, 1], distance, hatched: true } } } });
      await sleep(20);
    }
    const caps = [];
    for (let x = 20; x < 400; x += 20)
      for (let y = 60; y < 250; y += 20) {
        const picked = await user.ask({ type: 'pick', x, y, frame: await user.seen() });
        if (picked.normal?.[2] === 1 && Math.abs(picked.point[2] - 0.1) < 1e-9) caps.push([x, y]);
      }
    assert.ok(caps.length > 3, `${caps.length} caps`);
    await user.drag(caps[1], [caps[1][0] + 60, caps[1][1] - 20], 12, 0, finger(4)); // about a point of a cap
    await user.ask({ type: 'patch', patch: { sections: { Side: { normal: [1, 0, 1], distance: 0.5, caps: false } } } });
    await user.drag([210, 130], [150, 140], 10, 0, finger(5));
    await user.ask({ type: 'patch', patch: { sections: { Side: { on: false } }, sectionBox: { on: true, max: [1, 0.9, 3] } } });
    await user.ask({ type: 'pick', x: 200, y: 140, frame: await user.seen(), then: 'center' });
    await user.drag([210, 130], [250, 120], 10);
    return user;
  },

  measures: async (session, name) => {
    const user = await Participant.join(session, 'control', VIEW);
    user.watch();
    await user.record(name);
    await user.ask({ type: 'patch', patch: { camera: { eye: [0, 1.6, 2.5], focus: [0.6, 0.9, -2.9] } } });
    const snapped = async (x, y, to) => {
      const { snapped } = await user.ask({ type: 'pick', x, y, frame: await user.seen(), snap: { within: 12, to } });
      return snapped?.feature;
    };
    const found = { vertex: [], edge: [], plane: [], loop: [] };
    for (const kind of Object.keys(found))
      for (let x = 20; x < 400; x += 20) {
        const feature = await snapped(x, 130, [kind]);
        if (feature && !found[kind].some(({ node }) => node === feature.node)) found[kind].push(feature);
      }
    const of = (kind, wanted) => found[kind].find(({ node }) => node === wanted);
    const [corner] = found.vertex;
    const measures = {
      'To the door': { kind: 'distance', picks: [corner, of('edge', 9)] },
      'From an edge': { kind: 'parallel', picks: [of('edge', 2), { ...corner, snap: 'point' }] },
      'Of the door': { kind: 'angle', picks: [of('plane', 2), of('plane', 9)] },
      'Around a face': { kind: 'length', picks: [of('loop', 6)] },
    };
    for (const [key, measure] of Object.entries(measures)) {
      await user.ask({ type: 'patch', patch: { measures: { [key]: measure } } });
      await user.drag([200, 125], [190, 120], 4, 0, finger(4));
    }
    const before = user.state.measured['Of the door'].value;
    for (const degrees of [-10, -25]) {
      const [c, s] = [Math.cos((degrees * Math.PI) / 180), Math.sin((degrees * Math.PI) / 180)];
      const matrix = [c, 0, s, 1.2, 0, 1, 0, 0, -s, 0, c, -2.9, 0, 0, 0, 1];
      await user.ask({ type: 'patch', patch: { nodes: { 8: { matrix } } } });
    }
    assert.ok(Math.abs(user.state.measured['Of the door'].value - before - 25) < 1e-9, 'the door has turned by 25 degrees');
    await user.ask({ type: 'patch', patch: { nodes: { 6: { active: false } } } });
    return user;
  },

  cues: async (session, name) => {
    const user = await Participant.join(session, 'control', VIEW);
    user.watch();
    await user.record(name);
    const save = (cue, more) => user.ask({ type: 'patch', patch: { cues: { [cue]: { ms: 300, ...more } } } });
    await save('Arrival', { order: 1, text: 'Welcome' });
    await user.ask({ type: 'patch', patch: { camera: { eye: [2, 1.5, 3], focus: [0.6, 0.9, -1] }, nodes: { 5: { active: false } } } });
    await save('Without the box', { order: 2 });
    await user.ask({ type: 'patch', patch: { nodes: null, lights: { active: '13' }, selection: { node: 7 }, sections: { Cut: { normal: [0, 1, 0], distance: 1.2 } } } });
    await save('Cut', { order: 3, easing: 'linear', camera: { eye: [-2, 2.5, 3], focus: [0, 0.5, 0] } });
    const flown = (id) => user.client.until('the end', () => user.client.texts.find((text) => text.type === 'flown' && text.id === id));
    const show = (which) => user.client.send({ type: 'cue', ...which });
    await flown(show({ name: 'Arrival' }));
    assert.deepEqual([user.state.sections, user.state.lights.active], [{}, 'headlight']);
    await flown(show({ step: 1 }));
    const stopped = show({ step: 1 });
    await sleep(120);
    await user.ask({ type: 'navigate', rotate: [10, 5] }); // in the middle of the way
    assert.equal((await flown(stopped)).completed, false);
    show({ step: -1 });
    await sleep(100);
    await flown(show({ name: 'Cut' })); // while another is on its way
    assert.equal(user.state.cue.name, 'Cut');
    await user.drag([200, 125], [240, 140], 10);
    return user;
  },

  comfort: async (session, name) => {
    const user = await Participant.join(session, 'control', VIEW);
    const host = await Participant.join(session, 'host');
    user.watch();
    await user.record(name);
    await user.ask({ type: 'patch', patch: { unit: { metres: 1 }, comfort: { degreesPerSecond: 60 } } });
    const { camera } = user.state;
    const rest = () => host.client.until('rest', () => !host.state.walls && host.client.revision === user.client.revision);
    await user.drag([350, 130], [60, 120], 12); // a flick
    await sleep(400);
    await user.drag([60, 120], [350, 160], 12); // and back, while they follow
    await user.ask({ type: 'fly', keyframes: [{ at: 600, camera: { eye: [2.5, 1.9, 4], focus: [0.2, 1, 0] } }] });
    user.wheel(-240);
    await rest();
    await user.ask({ type: 'patch', patch: { comfort: { on: false } } });
    await user.ask({ type: 'patch', patch: { camera: { eye: [0, 1.6, 4], focus: [0, 1, 0] }, comfort: { on: true } } });
    await user.drag([200, 125], [330, 110], 8);
    await rest();
    await user.ask({ type: 'patch', patch: { camera: { eye: camera.eye, focus: camera.focus } } });
    await rest();
    user.walls = wallsSeen(host);
    return user;
  },

  notes: async (session, name) => {
    const user = await Participant.join(session, 'control', VIEW, { name: 'Bea' });
    user.watch();
    await user.record(name);
    const note = (markers) => user.ask({ type: 'patch', patch: { markers } });
    await note({ Gap: { point: [0.6, 0.9, 0], text: 'Gap too wide', time: 1764345600000 } });
    await user.drag([200, 125], [262, 141], 12);
    await note({ Dent: { node: 4, point: [0, 0, 0], text: 'Dent', author: 'Ada' }, Old: { point: [0, 0, 0], author: null, view: null } });
    await note({ Gap: { done: true }, Dent: { text: 'Dent in the door' }, Old: null });
    const { view } = user.state.markers.Gap;
    const id = user.client.send({ type: 'fly', keyframes: [{ at: 300, camera: view }] });
    await user.client.until('the end', () => user.client.texts.find((text) => text.type === 'flown' && text.id === id));
    assert.deepEqual(user.state.camera.eye, view.eye);
    assert.deepEqual([user.state.markers.Gap.author, user.state.markers.Dent.author], ['Bea', 'Ada']);
    return user;
  },

  doors: async (session, name) => {
    const user = await Participant.join(session, 'control', VIEW);
    user.watch();
    await user.record(name);
    const turned = (degrees) => {
      const [c, s] = [Math.cos((degrees * Math.PI) / 180), Math.sin((degrees * Math.PI) / 180)];
      return [c, 0, s, 1.2, 0, 1, 0, 0, -s, 0, c, -2.9, 0, 0, 0, 1];
    };
    await user.ask({ type: 'patch', patch: { views: { start: {} }, camera: { node: 12 } } });
    for (const degrees of [-10, -25, -40]) {
      await user.ask({ type: 'patch', patch: { nodes: { 8: { matrix: turned(degrees) } } } });
      await sleep(20);
    }
    assert.equal(user.state.camera.node, 12); // it went along
    await user.ask({ type: 'patch', patch: {
      nodes: { 14: { activeChild: 1 }, 5: { material: 6 }, 7: { active: false } },
      markers: { grip: { point: [0.75, 1, 0.12], node: 10, text: 'Turn here' } },
      lights: { active: '13' },
      selection: { node: 8 },
    } });
    await user.drag([150, 125], [190, 140], 10);
    assert.equal(user.state.camera.node, undefined);
    await user.ask({ type: 'patch', patch: { views: { door: {} }, navigation: { style: 'maya', rotateSpeed: 1.5 } } });
    await user.ask({ type: 'patch', patch: { camera: user.state.views.start, nodes: { 5: null } } });
    await user.drag([200, 125], [140, 110], 10, 0, { altKey: true }); // rotates
    await user.drag([200, 125], [180, 100], 8, 1, { altKey: true }); // pans
    await user.drag([200, 125], [230, 125], 8, 2, { altKey: true }); // zooms
    return user;
  },

  'other-scene': async (session, name) => {
    const user = await Participant.join(session, 'control', VIEW);
    user.watch();
    await user.record(name);
    await user.ask({ type: 'patch', patch: { navigation: { keepUpright: false, panSpeed: 2 }, renderer: { mode: 'stylized' } } });
    user.down([100, 100], 0, finger(1));
    await user.glide([100, 100], [130, 90], 6, 0, finger(1));
    await user.ask({ type: 'open', scene: 'corner.vrut' });
    await user.client.until('the corner', () => user.state.scene.name.includes('Corner') || user.state.scene.nodes === 3);
    await user.glide([130, 90], [130, 91], 1, 0, finger(1));
    user.up([130, 91], 0, finger(1));
    await user.ask({ type: 'open', scene: 'corner.vrut' }); // as it was read
    await user.client.texted('loading', (text) => text.done);
    await user.client.until('home', () => `${user.state.camera.eye}` === `${user.state.views.home.eye}`);
    await user.ask({ type: 'resize', width: 300, height: 300, pixelRatio: 1 }); // home is fitted to that
    await user.drag([60, 120], [180, 90], 12, 0, finger(2));
    await user.drag([150, 150], [140, 170], 6, 2);
    return user;
  },

  'begun-in-drag': async (session, name) => {
    const user = await Participant.join(session, 'control', VIEW);
    user.watch();
    await user.ask({ type: 'patch', patch: { navigation: { style: 'cinema4d' } } });
    user.key('keydown', '1', 'Digit1');
    user.down([200, 125], 0); // with the key held the left button pans
    await user.glide([200, 125], [230, 140], 8);
    await user.record(name);
    await user.glide([230, 140], [260, 120], 8);
    user.key('keyup', '1', 'Digit1'); // the drag stays what it was
    await user.glide([260, 120], [280, 100], 8);
    user.up([280, 100]);
    user.key('keydown', '2', 'Digit2');
    await user.drag([200, 125], [200, 100], 8); // zooms
    user.key('keyup', '2', 'Digit2');
    return user;
  },

  'begun-in-pinch': async (session, name) => {
    const user = await Participant.join(session, 'control', VIEW);
    user.watch();
    user.down([150, 125], 0, finger(1));
    await user.glide([150, 125], [140, 120], 4, 0, finger(1));
    user.down([250, 125], 0, finger(2));
    await user.glide([250, 125], [270, 130], 6, 0, finger(2));
    await user.record(name);
    await user.glide([270, 130], [300, 160], 8, 0, finger(2));
    user.up([140, 120], 0, finger(1));
    await user.glide([300, 160], [280, 165], 6, 0, finger(2));
    user.up([280, 165], 0, finger(2));
    return user;
  },

  'begun-in-flight': async (session, name) => {
    const user = await Participant.join(session, 'control', VIEW);
    user.watch();
    await user.client.until('a frame', () => user.frame);
    const before = user.frame;
    const flight = user.client.send({ type: 'fly', keyframes: [{ at: 300, camera: { eye: [3, 2, 4] } }, { at: 800, camera: { eye: [-2, 1.5, 4], fov: 35 } }] });
    await sleep(350);
    await user.record(name);
    assert.equal((await user.client.texted('flown', (text) => text.id === flight)).completed, true);
    await user.ask({ type: 'pick', x: 222, y: 122, frame: before, then: 'center' }); // seen before it was recorded
    await user.drag([150, 100], [190, 105], 10, 0, finger(1));
    user.client.send({ type: 'fly', keyframes: [{ at: 5000, camera: { eye: [0, 6, 4] } }] });
    await sleep(400);
    await user.ask({ type: 'fit', node: 3 });
    return user;
  },
};

/** Some of the cameras that a host had while it was behind, as lists of numbers. */
function wallsSeen({ client }) {
  const seen = [];
  let walls = {};
  for (const { type, patch } of client.texts) {
    if (type !== 'patch' || patch.walls === undefined) continue;
    walls = patch.walls && { ...walls, ...patch.walls };
    if (walls) seen.push([...walls.eye, ...walls.focus, ...walls.up]);
  }
  return seen.filter((_, i) => i % 20 === 10);
}

async function record(name, play) {
  const folder = mkdtempSync(path.join(tmpdir(), 'vrut-record-'));
  const session = { participants: [] };
  session.server = await Server.start({ scene: ROOM, options: ['--scenes', SCENES, '--record', folder] });
  try {
    const user = await play(session, name);
    await user.ask({ type: 'record', action: 'stop' });
    const { camera, measured } = user.state;
    for (const { client } of session.participants) await client.leave();
    const log = path.join(folder, `${name}.jsonl`);
    const replayed = spawnSync(PROGRAM, ['replay', log, '--scene', ROOM], { encoding: 'utf8' });
    assert.equal(replayed.status, 0, replayed.stderr);
    assert.deepEqual(JSON.parse(replayed.stdout), camera);
    const { size } = statSync(log);
    assert.ok(size < LARGEST, `${size} bytes`);
    mkdirSync(LOGS, { recursive: true });
    copyFileSync(log, path.join(LOGS, `${name}.jsonl`));
    writeFileSync(path.join(LOGS, `${name}.camera.json`), `${JSON.stringify(camera)}\n`);
    if (user.walls) writeFileSync(path.join(LOGS, `${name}.walls.json`), `${JSON.stringify(user.walls)}\n`);
    if (Object.keys(measured).length > 0)
      writeFileSync(path.join(LOGS, `${name}.measured.json`), `${JSON.stringify(measured)}\n`);
    console.log(`${name}: ${size} bytes`);
  } finally {
    await session.server.stop();
    rmSync(folder, { recursive: true });
  }
}

const wanted = process.argv.slice(2);
for (const name of wanted) assert.ok(name in SESSIONS, `there is no session '${name}'`);
for (const [name, play] of Object.entries(SESSIONS)) if (wanted.length === 0 || wanted.includes(name)) await record(name, play);
process.exit(0);
