import assert from 'node:assert/strict';
import { afterEach, beforeEach, test } from 'node:test';
import { Snapper } from '../../../web-client/stage/snapper.js';
import { fakeEvent, replaceGlobals } from './fakes.js';

/** As much of an element as a snapper uses. */
class Part extends EventTarget {
  hidden = true;
  style = {};
  textContent = '';
  attributes = {};
  parts = {};

  querySelector(name) {
    this.parts[name] ??= new Part();
    return this.parts[name];
  }

  setAttribute(name, value) {
    this.attributes[name] = value;
  }

  toggleAttribute(name, isSet) {
    this[name] = isSet;
  }

  setPointerCapture() {}
}

const snapped = (name) => ({ feature: { node: 1, snap: 'vertex', points: [] }, point: [name, 0, 0], line: [] });

let elements;
let frame;
let asked;
let said;
let told;
let wheels;
let presses;
let snapper;
let restore;

beforeEach(() => {
  restore = replaceGlobals({ document: new EventTarget(), devicePixelRatio: 1 });
  elements = { layer: new Part(), mark: new Part(), loupe: new Part() };
  frame = 7;
  [asked, said, told, wheels, presses] = [[], [], [], [], []];
  snapper = new Snapper(elements, {
    pick: (question) => new Promise((answer) => asked.push({ question, answer })),
    mapping: () => (x, y) => ({ x: x / 2, y: y / 2 }),
    frame: () => frame,
    paths: (lines) => lines.map((line) => (line.length > 0 ? [line.map(([x]) => ({ x, y: 0 }))] : [])),
    free: () => ({ left: 0, top: 0, right: 1000, bottom: 800 }),
    magnify: () => {},
    say: (text) => said.push(text),
    wheel: (event) => wheels.push(event),
    press: ({ pointerId, clientX }) => presses.push([pointerId, clientX]),
  });
  snapper.begin({ take: (what) => told.push(what?.point[0] ?? null), ended: () => told.push('ended') });
  snapper.ask({ text: 'Touch it.', taken: [] });
});

afterEach(() => restore());

const pointer = (type, clientX, clientY = 300, members = {}) => elements.layer.dispatchEvent(
  fakeEvent(`pointer${type}`, { pointerId: 1, pointerType: 'touch', button: 0, clientX, clientY, ...members }));
const escape = () => document.dispatchEvent(fakeEvent('keydown', { key: 'Escape' }));
const settled = () => new Promise(setImmediate);
/** Answers the oldest question. */
const answer = async (what) => {
  asked.shift().answer(what);
  await settled();
};
const places = () => asked.map(({ question }) => question.x);

test('while a finger is down, the newest place alone is asked for, and the loupe is there', async () => {
  pointer('down', 100);
  assert.deepEqual(asked[0].question, { x: 50, y: 150, frame: 7, snap: { within: 16 } });
  assert.equal(elements.loupe.hidden, false);
  pointer('move', 110);
  pointer('move', 120);
  assert.deepEqual(places(), [50]);
  await answer({ snapped: snapped(5) });
  assert.deepEqual(places(), [60]);
  assert.equal(elements.loupe.parts.p.textContent, 'corner');
  assert.deepEqual(told, []);
});

test('when it leaves, what is at its last place is taken', async () => {
  pointer('down', 100);
  await answer({ snapped: snapped(5) });
  pointer('up', 100);
  await settled();
  assert.deepEqual([told, places()], [[5], []]);
  assert.equal(elements.loupe.hidden, true);
});

test('that is asked for once more where the last answer is of another place', async () => {
  pointer('down', 100);
  pointer('up', 130);
  await answer({ snapped: snapped(5) });
  assert.deepEqual([told, places()], [[], [65]]);
  await answer({ snapped: snapped(6) });
  assert.deepEqual(told, [6]);
});

test('nothing is told as nothing, and what was refused not at all', async () => {
  pointer('down', 100);
  pointer('up', 100);
  await answer({});
  pointer('down', 100);
  pointer('up', 100);
  await answer(undefined);
  assert.deepEqual(told, [null]);
});

test('a finger that comes before the answer to the last waits for its turn', async () => {
  pointer('down', 100);
  pointer('up', 100);
  pointer('down', 200);
  pointer('up', 200);
  assert.deepEqual(places(), [50]);
  await answer({ snapped: snapped(5) });
  assert.deepEqual([told, places()], [[5], [100]]);
  await answer({ snapped: snapped(6) });
  assert.deepEqual(told, [5, 6]);
});

test('two fingers and other buttons steer, and take nothing', async () => {
  pointer('down', 100);
  pointer('move', 120);
  pointer('down', 200, 300, { pointerId: 2 });
  assert.equal(elements.loupe.hidden, true);
  assert.deepEqual(presses, [[1, 100], [2, 200]]);
  pointer('up', 200, 300, { pointerId: 2 });
  pointer('up', 120);
  await answer({ snapped: snapped(5) });
  pointer('down', 100, 300, { pointerType: 'mouse', button: 2 });
  pointer('up', 100, 300, { pointerType: 'mouse', button: 2 });
  assert.deepEqual([told, presses.at(-1)], [[], [1, 100]]);
  pointer('down', 300);
  assert.equal(elements.loupe.hidden, false, 'and one finger picks again');
});

test('a cancelled finger takes nothing', async () => {
  pointer('down', 100);
  pointer('cancel', 100);
  await answer({ snapped: snapped(5) });
  assert.deepEqual([told, places(), elements.loupe.hidden], [[], [], true]);
});

test('a mouse sees what it would take without a button, and without the loupe', async () => {
  pointer('move', 100);
  assert.deepEqual(places(), []);
  pointer('move', 100, 300, { pointerType: 'mouse' });
  await answer({ snapped: snapped(5) });
  assert.deepEqual([elements.mark.hidden, elements.loupe.hidden], [false, true]);
  assert.equal(elements.mark.parts.p.textContent, 'corner');
  pointer('leave', 100, 300, { pointerType: 'mouse' });
  assert.equal(elements.mark.hidden, true);
});

test('a mouse takes what is under it in the picture that it sees', async () => {
  const mouse = { pointerType: 'mouse' };
  const click = async () => {
    pointer('down', 100, 300, mouse);
    pointer('up', 100, 300, mouse);
    await settled();
  };
  pointer('move', 100, 300, mouse);
  await answer({ snapped: snapped(5) });
  await click();
  assert.deepEqual([asked.length, told], [0, [5]]);
  pointer('move', 100, 300, mouse);
  await answer({ snapped: snapped(5) });
  frame = 8; // after a turn of the wheel
  await click();
  assert.deepEqual(asked.map(({ question }) => question.frame), [8]);
  await answer({ snapped: snapped(6) });
  assert.deepEqual(told, [5, 6]);
});

test('the wheel goes on to the picture, but not under a finger', () => {
  elements.layer.dispatchEvent(fakeEvent('wheel'));
  pointer('down', 100);
  elements.layer.dispatchEvent(fakeEvent('wheel'));
  assert.equal(wheels.length, 1);
});

test('Escape ends it, with what is still to be answered', async () => {
  pointer('down', 100);
  pointer('up', 100);
  escape();
  assert.deepEqual(told, ['ended']);
  await answer({ snapped: snapped(5) });
  pointer('down', 100);
  escape();
  assert.deepEqual([told, places(), elements.layer.hidden], [['ended'], [], true]);
  assert.deepEqual(said, ['Touch it.', '']);
});

test('another that begins ends the one before', async () => {
  const others = [];
  pointer('down', 100);
  pointer('up', 100);
  snapper.begin({ take: (what) => others.push(what.point[0]), ended: () => {} });
  snapper.ask({ text: 'Touch an edge.', to: ['edge'], taken: [snapped(1)] });
  pointer('down', 200);
  pointer('up', 200);
  await answer({ snapped: snapped(5) });
  assert.deepEqual(asked[0].question.snap, { within: 16, to: ['edge'] });
  await answer({ snapped: snapped(6) });
  assert.deepEqual([told, others], [['ended'], [6]]);
});
