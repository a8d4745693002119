import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { afterEach, beforeEach, describe, test } from 'node:test';
import Ajv from 'ajv/dist/2020.js';
import { commandsBy } from '../../../web-client/connection/commands.js';
import { FakeClock, replaceGlobals } from './fakes.js';

const schema = JSON.parse(readFileSync(new URL('../../../protocol/protocol.schema.json', import.meta.url), 'utf8'));
const ajv = new Ajv({ strict: true, strictRequired: false });
ajv.addSchema(schema);
const isClientMessage = ajv.compile({ $ref: `${schema.$id}#/$defs/clientMessage` });

const settled = () => new Promise(setImmediate);

test('each command is a message of the protocol', async () => {
  const asked = [];
  const commands = commandsBy({ ask: async (message) => asked.push(message), refused: assert.fail, late: assert.fail });
  await commands.change({ camera: { fov: 50 } });
  await commands.patch({ nodes: null });
  await commands.control({ action: 'give', client: 'c2' });
  await commands.fit();
  await commands.swing(7);
  await commands.fly({ eye: [1, 2, 3], focus: [0, 0, 0] });
  await commands.pick({ x: 1, y: 2, frame: 3 });
  await commands.tree({ only: 'switches' });
  await commands.snapshot({ width: 10, height: 20 });
  await commands.cue({ name: 'Arrival' });
  await commands.check({ format: 'vrut-preview-cues', version: 1, cues: {} });
  await commands.picture({ width: 10, height: 20, cue: 'Arrival' });
  await commands.record('start');
  await commands.scenes();
  await commands.share('https://preview.example/');
  await commands.open('car', 'z');
  assert.deepEqual(asked.map(({ type }) => type),
    ['patch', 'patch', 'control', 'fit', 'swing', 'fly', 'pick', 'tree', 'snapshot', 'cue', 'check', 'snapshot', 'record', 'scenes', 'share', 'open']);
  for (const message of asked) {
    assert.ok(isClientMessage(JSON.parse(JSON.stringify(message))), `${JSON.stringify(message)}: ${ajv.errorsText(isClientMessage.errors)}`);
  }
  assert.equal(asked.length, Object.keys(commands).length);
});

test('a command promises its answer, or nothing once its refusal is told', async () => {
  const refused = [];
  const answers = [async () => ({ type: 'ok' }), () => Promise.reject(new Error('no such scene'))];
  const commands = commandsBy({ ask: () => answers.shift()(), refused: ({ message }) => refused.push(message), late: assert.fail });
  assert.deepEqual(await commands.scenes(), { type: 'ok' });
  assert.deepEqual(refused, []);
  assert.equal(await commands.open('none'), undefined);
  assert.deepEqual(refused, ['no such scene']);
});

describe('an answer', () => {
  let clock;
  let restore;
  let asked;
  let calls;
  let commands;

  beforeEach(() => {
    clock = new FakeClock();
    restore = replaceGlobals({ setTimeout: clock.setTimeout, clearTimeout: clock.clearTimeout });
    asked = [];
    calls = [];
    commands = commandsBy({
      ask: ({ type }) => new Promise((resolve, reject) => { asked.push({ type, resolve, reject }); }),
      refused: () => {}, late: (isLate) => calls.push(isLate),
    });
  });
  afterEach(() => restore());

  test('that the user waits for is late after a second, and no more once it is here', async () => {
    commands.cue({ name: 'Arrival' });
    clock.advance(999);
    assert.deepEqual(calls, []);
    clock.advance(1);
    assert.deepEqual(calls, [true]);
    asked[0].resolve({});
    await settled();
    assert.deepEqual(calls, [true, false]);
  });

  test('within a second is not late', async () => {
    const taps = [commands.fit(), commands.change({ camera: { fov: 50 } })];
    clock.advance(900);
    for (const { resolve } of asked) resolve({});
    await Promise.all(taps);
    clock.advance(5000);
    assert.deepEqual(calls, []);
  });

  test('of several that are late counts as one wait, until the last is here or lost with the connection', async () => {
    commands.cue({ name: 'Arrival' });
    clock.advance(600);
    commands.change({ camera: { fov: 50 } });
    clock.advance(600);
    commands.tree({ only: 'hinges' });
    clock.advance(600);
    asked[0].resolve({});
    await settled();
    assert.deepEqual(calls, [true]);
    for (const { reject } of asked) reject(new Error());
    await settled();
    clock.advance(5000);
    assert.deepEqual(calls, [true, false]);
  });

  test('for which the page alone waits is never late: images, and the list of scenes', async () => {
    commands.picture({ width: 10, height: 20 });
    commands.snapshot({ width: 10, height: 20 });
    commands.scenes();
    clock.advance(60_000);
    assert.deepEqual(calls, []);
  });
});

test('a long patch goes in parts, the next one when the one before is done', async () => {
  const asked = [];
  const commands = commandsBy({
    ask: async ({ patch }) => (asked.push(Object.keys(patch.cues)) === 2 ? Promise.reject(new Error('no')) : {}),
    refused: () => {},
    late: assert.fail,
  });
  const text = 'x'.repeat(40_000);
  const cues = { a: { text }, b: { text }, c: { text } };
  assert.equal(await commands.patch({ cues }), undefined);
  assert.deepEqual(asked, [['a'], ['b']]);
  assert.deepEqual(await commands.patch({ cues }), {});
  assert.deepEqual(asked.slice(2), [['a'], ['b'], ['c']]);
});

test('two pictures are on their way at a time, and the next follow in their order', async () => {
  const asked = [];
  const refused = [];
  const commands = commandsBy({
    ask: ({ width }) => new Promise((resolve, reject) => { asked.push({ width, resolve, reject }); }),
    refused: ({ message }) => refused.push(message),
    late: assert.fail,
  });
  const widths = () => asked.map(({ width }) => width);
  const answers = [1, 2, 3, 4].map((width) => commands.picture({ width, height: 1 }));
  answers.push(commands.snapshot({ width: 5, height: 1 }));
  assert.deepEqual(widths(), [1, 2]);
  asked[1].reject(new Error('busy')); // that one is given up, and its place is free
  await settled();
  assert.deepEqual(widths(), [1, 2, 3]);
  asked[0].resolve('first');
  asked[2].resolve('third');
  await settled();
  assert.deepEqual(widths(), [1, 2, 3, 4, 5]);
  asked[3].resolve('fourth');
  asked[4].reject(new Error('too large'));
  assert.deepEqual(await Promise.all(answers), ['first', undefined, 'third', 'fourth', undefined]);
  assert.deepEqual(refused, ['too large']);
  commands.picture({ width: 6, height: 1 });
  commands.picture({ width: 7, height: 1 });
  commands.picture({ width: 8, height: 1 });
  assert.deepEqual(widths(), [1, 2, 3, 4, 5, 6, 7]);
});
