import assert from 'node:assert/strict';
import { test } from 'node:test';
import { LOOKS, asShown, cueAfter, cueList, cueNames, exactly, lookOf, pictureOfCue } from '../../../web-client/base/cues.js';
import { mergePatch } from '../../../web-client/base/merge-patch.js';
import { freeName, moved, namesInOrder, unusedName } from '../../../web-client/base/order.js';
import { Pictures } from '../../../web-client/panels/pictures.js';

const cues = { Last: {}, First: { order: -1 }, Then: { order: 2 }, Early: {} };

test('names follow each other by their order, then by name', () => {
  assert.deepEqual(cueNames(cues), ['First', 'Then', 'Early', 'Last']);
  assert.deepEqual(cueNames(undefined), []);
  assert.deepEqual(namesInOrder({ b: {}, a: {}, B: {} }), ['B', 'a', 'b']);
});

test('one changes places with its neighbour, and those without an order get one', () => {
  assert.deepEqual(moved(cues, cueNames(cues), 'Then', -1),
    { Then: { order: 0 }, First: { order: 1 }, Early: { order: 2 }, Last: { order: 3 } });
  assert.equal(moved(cues, cueNames(cues), 'First', -1), null);
  assert.equal(moved(cues, cueNames(cues), 'Last', 1), null);
});

test('a name that is free has the first free number', () => {
  assert.equal(unusedName('View', []), 'View 1');
  assert.equal(unusedName('View', ['View 1', 'Door', 'View 3']), 'View 2');
});

test('what comes back has its name, or where that is taken meanwhile another', () => {
  assert.equal(freeName('Door', ['View 1']), 'Door');
  assert.equal(freeName('Door', ['Door', 'Door 1']), 'Door 2');
  assert.equal(freeName('note 2', ['note 1', 'note 2'], 'note'), 'note 3');
});

test('the cue so many steps from the shown one', () => {
  assert.equal(cueAfter({ cues, cue: undefined }, 1), 'First');
  assert.equal(cueAfter({ cues, cue: undefined }, -1), undefined);
  assert.equal(cueAfter({ cues, cue: { name: 'Then' } }, 1), 'Early');
  assert.equal(cueAfter({ cues, cue: { name: 'Then' } }, -1), 'First');
  assert.equal(cueAfter({ cues, cue: { name: 'Last' } }, 1), undefined);
  assert.equal(cueAfter({ cues, cue: { name: 'First' } }, -1), undefined);
});

test('what is written and when changes no picture, and all else does', () => {
  const cue = { text: 'a', ms: 1, order: 1, easing: 'smooth', camera: { fov: 40 }, nodes: {} };
  assert.equal(lookOf(cue), lookOf({ ...cue, text: 'b', ms: 2, order: 3, easing: 'linear' }));
  for (const member of LOOKS) assert.notEqual(lookOf(cue), lookOf({ ...cue, [member]: { other: 1 } }), member);
  assert.deepEqual(Object.keys(asShown()), LOOKS);
});

test('the file of a list names its scene', () => {
  assert.deepEqual(cueList({ cues, scene: { file: 'car.vrut', name: 'Car' } }),
    { format: 'vrut-preview-cues', version: 1, scene: 'car.vrut', cues });
});

test('a cue becomes exactly another one, of whose tables nothing of its own stays', () => {
  const wanted = {
    text: 'a', nodes: { 1: { active: false }, 2: { activeChild: 1 } }, sections: { x: { distance: 1 } }, selection: {},
  };
  const now = {
    text: 'b', order: 3, nodes: { 1: { active: true, material: 7 }, 5: { active: false } }, selection: { node: 4 },
    sections: { x: { distance: 2 }, y: { distance: 3 } },
  };
  assert.deepEqual(exactly(wanted, now), {
    text: 'a', order: null, nodes: { 1: { active: false, material: null }, 2: { activeChild: 1 }, 5: null },
    sections: { x: { distance: 1 }, y: null }, selection: { node: null },
  });
  assert.deepEqual(mergePatch(now, exactly(wanted, now)), wanted);
  assert.deepEqual(mergePatch(wanted, exactly(now, wanted)), now);
});

test('of a cue that says less, only what it says', () => {
  const now = { text: 'b', nodes: { 1: {} }, sections: { x: {} }, selection: { node: 1 } };
  assert.deepEqual(exactly({ text: 'a', nodes: null }, now), { text: 'a', order: null, nodes: null });
  assert.deepEqual(exactly({ nodes: { 1: null } }, now).nodes, { 1: null });
  assert.equal(exactly(undefined, now), null);
  const wanted = { text: 'a' };
  assert.equal(exactly(wanted, undefined), wanted);
});

/** An `img` without a page. */
function image() {
  const made = { isConnected: true, getAttribute: () => made.src, src: undefined };
  return made;
}

test('pictures are drawn one after the other, once for a look', async (t) => {
  const given = t.mock.method(URL, 'createObjectURL', () => `picture ${given.mock.callCount()}`);
  const revoked = t.mock.method(URL, 'revokeObjectURL', () => {});
  const now = {
    state: { scene: { file: 'a' }, renderer: { mode: 'realistic', wireframe: false }, cues: { A: { nodes: {} }, B: { nodes: { 1: {} } } } },
    header: { view: { width: 200, height: 100 } },
  };
  const asked = [];
  const commands = { picture: (wanted) => new Promise((resolve) => { asked.push({ wanted, resolve }); }) };
  const pictures = new Pictures({ store: { now }, commands, find: ({ cues: all }, name) => pictureOfCue(all, name) });
  const settled = () => new Promise(setImmediate);
  const [a, b, again] = [image(), image(), image()];
  pictures.show(a, 'A');
  pictures.show(b, 'B');
  pictures.show(again, 'A');
  assert.deepEqual(asked.map(({ wanted }) => wanted), [{ width: 240, height: 120, samples: 4, cue: 'A' }]);
  asked[0].resolve({ data: new Uint8Array(1) });
  await settled();
  assert.deepEqual([a.src, again.src, b.src], ['picture 0', 'picture 0', undefined]);
  asked[1].resolve(undefined); // refused
  await settled();
  assert.equal(asked.length, 2);
  pictures.show(b, 'B');
  asked[2].resolve({ data: new Uint8Array(1) });
  await settled();
  assert.equal(b.src, 'picture 1');
  // Another text is no other picture, another look is.
  now.state = { ...now.state, cues: { A: { nodes: {}, text: 'x' }, B: { nodes: { 2: {} } } } };
  pictures.show(a, 'A');
  pictures.show(b, 'B');
  assert.equal(asked.length, 4);
  assert.equal(asked[3].wanted.cue, 'B');
  assert.equal(revoked.mock.callCount(), 1);
});
