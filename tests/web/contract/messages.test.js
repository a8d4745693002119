// Contract: CLIENT_MESSAGES.md, member by member: what is missing, of a wrong type, or out of range.
import { after, describe, test } from 'node:test';
import { ContractClient } from './contract-client.js';
import { schemaTest } from './schema.js';
import { Server } from './server.js';
import { holder } from './stage.js';

const server = await Server.start();
after(() => server.stop());

const POINTER = { pointerId: 1, pointerType: 'mouse', x: 1, y: 1, button: 0, buttons: 0 };
const NUMBER = ['1', true, null, [1], {}];
const WORD = [1, true, null, [], {}];
const FLAG = [1, 'true', null, [], {}];
const LIST = [1, 'x', true, null, {}];
const OBJECT = [1, 'x', true, null, [1]];

/** type: [a right message's members, {member: {type: values of wrong JSON types, range: values out of range}}, required] */
const POINTER_MEMBERS = {
  pointerId: { type: NUMBER, range: [1.5] },
  pointerType: { type: WORD, range: ['finger', ''] },
  x: { type: NUMBER },
  y: { type: NUMBER },
  button: { type: NUMBER, range: [1.5] },
  buttons: { type: NUMBER, range: [1.5] },
};
const OPTIONAL_INPUT = {
  ctrlKey: { type: FLAG },
  shiftKey: { type: FLAG },
  altKey: { type: FLAG },
  metaKey: { type: FLAG },
  timeStamp: { type: NUMBER },
};
const MESSAGES = {
  resize: {
    right: { width: 400, height: 300, pixelRatio: 1 },
    required: {
      width: { type: NUMBER, range: [0, 0.5, 8193] },
      height: { type: NUMBER, range: [0, -1, 8193] },
      pixelRatio: { type: NUMBER, range: [0.24, 4.01] },
    },
  },
  pointerdown: { right: POINTER, required: POINTER_MEMBERS, optional: { ...OPTIONAL_INPUT, frame: { type: NUMBER, range: [0.5] } } },
  pointermove: { right: POINTER, required: POINTER_MEMBERS, optional: OPTIONAL_INPUT },
  pointerup: { right: POINTER, required: POINTER_MEMBERS, optional: OPTIONAL_INPUT },
  pointercancel: { right: POINTER, required: POINTER_MEMBERS, optional: OPTIONAL_INPUT },
  wheel: {
    right: { x: 1, y: 1, deltaX: 0, deltaY: 0, deltaMode: 0 },
    required: { x: { type: NUMBER }, y: { type: NUMBER }, deltaX: { type: NUMBER }, deltaY: { type: NUMBER }, deltaMode: { type: NUMBER, range: [-1, 3, 0.5] } },
    optional: OPTIONAL_INPUT,
  },
  keydown: { right: { key: 'x', code: 'KeyX' }, required: { key: { type: WORD }, code: { type: WORD } }, optional: OPTIONAL_INPUT },
  keyup: { right: { key: 'x', code: 'KeyX' }, required: { key: { type: WORD }, code: { type: WORD } }, optional: OPTIONAL_INPUT },
  navigate: {
    right: { rotate: [0, 0] },
    optional: {
      rotate: { type: [...LIST, ['1', 2], [1, null]], range: [[1], [1, 2, 3]] },
      pan: { type: [...LIST, [1, '2']], range: [[], [1, 2, 3]] },
      zoom: { type: NUMBER, range: [0, -1, 0.99e-6, 1.01e6] },
    },
  },
  fit: { right: {}, optional: { node: { type: NUMBER, range: [1.5] } } },
  patch: { right: { patch: {} }, required: { patch: { type: OBJECT } }, optional: { ifRevision: { type: NUMBER, range: [1.5, -1] } } },
  pick: {
    right: { x: 1, y: 1 },
    required: { x: { type: NUMBER }, y: { type: NUMBER } },
    optional: { frame: { type: NUMBER, range: [1.5] }, then: { type: WORD, range: ['dance'] }, through: { type: FLAG }, snap: { type: OBJECT } },
  },
  snapshot: {
    right: { width: 8, height: 8 },
    required: { width: { type: NUMBER, range: [0, -1, 1.5] }, height: { type: NUMBER, range: [0, -1, 1.5] } },
    optional: {
      format: { type: WORD, range: ['gif', 'JPEG'] },
      jpegQuality: { type: NUMBER, range: [0, 101, 50.5] },
      camera: { type: OBJECT },
      renderer: { type: OBJECT },
    },
  },
  fly: {
    right: { keyframes: [{ at: 1, camera: { fov: 40 } }] },
    required: {
      keyframes: {
        type: [...LIST, [1], [{ at: '1', camera: {} }], [{ at: 1, camera: [] }], [{ camera: {} }], [{ at: 1 }]],
        range: [[], [{ at: 5, camera: {} }, { at: 5, camera: {} }], [{ at: 5, camera: {} }, { at: 4, camera: {} }], [{ at: -1, camera: {} }]],
      },
    },
    optional: { easing: { type: WORD, range: ['rough'] } },
  },
  tree: {
    right: {},
    optional: { node: { type: NUMBER, range: [1.5] }, depth: { type: NUMBER, range: [-1, 1.5] }, search: { type: WORD } },
  },
  open: { right: { scene: 'second.vrut' }, required: { scene: { type: WORD } }, optional: { upAxis: { type: WORD, range: ['x', 'Z', ''] } } },
  record: { right: { action: 'stop' }, required: { action: { type: WORD, range: ['pause', 'Start'] } }, optional: { name: { type: WORD } } },
  control: { right: { action: 'take' }, required: { action: { type: WORD, range: ['steal', ''] } }, optional: { client: { type: WORD } } },
};

/** `member` out of what is optional or required, as the message that has only that wrong. */
const wrong = (type, member, value) => ({ type, ...MESSAGES[type].right, [member]: value });

for (const [type, { right, required = {}, optional = {} }] of Object.entries(MESSAGES)) {
  describe(type, () => {
    for (const member of Object.keys(required)) {
      test(`needs ${member}`, async (t) => {
        const client = await holder(t, server);
        const message = { type, ...right };
        delete message[member];
        const error = await client.refused(message, 'bad-message');
        naming(error, member);
      });
    }
    for (const [member, { type: types = [], range = [] }] of Object.entries({ ...required, ...optional })) {
      test(`${member} of a wrong type, or out of range`, async (t) => {
        const client = await holder(t, server);
        for (const value of types) naming(await client.refused(wrong(type, member, value), 'bad-message'), member);
        for (const value of range) naming(await client.refused(wrong(type, member, value), 'out-of-range'), member);
      });
    }
  });
}

/** The sentence of an error names the culprit. */
function naming(error, culprit) {
  if (!error.message.includes(culprit)) throw new Error(`does not name ${culprit}: ${error.message}`);
}

test('bounds themselves are in range', async (t) => {
  const client = await holder(t, server);
  for (const [width, height, pixelRatio] of [[1, 1, 0.25], [1, 1, 4], [8192, 1, 1], [1, 8192, 1], [400, 300, 1]]) {
    await client.ask({ type: 'resize', width, height, pixelRatio });
  }
  for (const zoom of [1e-6, 1e6]) await client.ask({ type: 'navigate', zoom });
});

test('shown: revision is needed, a whole number, and one that there has been', async (t) => {
  const host = await ContractClient.join(t, server, { role: 'host' });
  naming(await host.refused({ type: 'shown' }, 'bad-message'), 'revision');
  for (const value of NUMBER) naming(await host.refused({ type: 'shown', revision: value }, 'bad-message'), 'revision');
  for (const value of [1.5, -1]) naming(await host.refused({ type: 'shown', revision: value }, 'out-of-range'), 'revision');
  await host.refused({ type: 'shown', revision: host.revision + 1000 }, 'out-of-range');
});

test('an input event with an id that is right is not answered, one that is wrong is, with or without an id', async (t) => {
  const client = await holder(t, server);
  client.send({ type: 'pointermove', ...POINTER });
  client.send({ type: 'wheel', ...MESSAGES.wheel.right });
  client.send({ type: 'keyup', key: 'x', code: 'KeyX' });
  client.send({ type: 'frame' });
  await client.barrier();
  await client.refused({ type: 'pointermove', ...POINTER, x: 'left' }, 'bad-message');
  const count = client.texts.length;
  client.send({ type: 'wheel', x: 0, y: 0, deltaX: 0, deltaY: 0, deltaMode: 0 }, { id: null });
  client.socket.send('{"type":"wheel","x":0,"y":0}');
  const error = await client.until('an error', () => client.texts.slice(count).find((text) => text.type === 'error'));
  if (error.id !== undefined || error.code !== 'bad-message') throw new Error(JSON.stringify(error));
});

schemaTest(server);
