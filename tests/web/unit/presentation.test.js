import assert from 'node:assert/strict';
import { after, before, beforeEach, test } from 'node:test';
import { Store, onChange } from '../../../web-client/base/store.js';
import { shownOf } from '../../../web-client/panels/cue-strip.js';
import { Presentation } from '../../../web-client/panels/presentation.js';
import { FakeWindow, replaceGlobals } from './fakes.js';

const CUES = { Arrival: { order: 0 }, Door: { order: 1 }, Wide: { order: 2 } };
const settled = () => new Promise(setImmediate);

let giveBack;
let window;
let page;

before(() => {
  giveBack = replaceGlobals({ requestAnimationFrame: (action) => window.requestAnimationFrame(action) });
});
after(() => giveBack());

beforeEach(() => {
  window = new FakeWindow();
  const store = new Store();
  page = { store, asked: [], reported: [], offered: [] };
  const ask = (name) => (asked) => new Promise((resolve) => { page.asked.push({ [name]: asked, resolve }); });
  page.presentation = new Presentation({
    store,
    commands: /** @type {*} */ ({ cue: ask('cue'), patch: ask('patch') }),
    report: (error) => page.reported.push(error.code ?? error.message),
    offer: (text) => page.offered.push(text),
  });
  page.set = (members) => {
    store.set(members);
    while (window.displayFrame() > 0);
  };
  page.prepares = () => page.store.now.prepares;
  page.set({ role: 'control', steers: true, hasPicture: true, state: { cues: CUES, cue: { name: 'Arrival' } } });
});

test('preparing begins with the next cue, and another is chosen for this page alone', () => {
  page.presentation.choose('Wide');
  assert.deepEqual(page.asked.map(({ cue }) => cue), [{ name: 'Wide' }]);
  page.presentation.turnPreparing();
  assert.equal(page.prepares(), 'Door');
  page.presentation.choose('Wide');
  assert.equal(page.prepares(), 'Wide');
  assert.equal(page.asked.length, 1);
  page.presentation.turnPreparing();
  assert.equal(page.prepares(), null);
});

test('a step back ends it, as it moves what all see; one that there is not does not', () => {
  page.presentation.turnPreparing();
  page.presentation.step(-1);
  assert.equal(page.prepares(), 'Door');
  assert.equal(page.asked.length, 0);
  page.set({ state: { cues: CUES, cue: { name: 'Door' } } });
  page.presentation.step(-1);
  assert.deepEqual(page.asked.map(({ cue }) => cue), [{ name: 'Arrival' }]);
  assert.equal(page.prepares(), null);
});

test('steps before the answer lead to one cue, those after it to the next', () => {
  page.presentation.step(1);
  page.presentation.step(1);
  page.set({ state: { cues: CUES, cue: { name: 'Door' } } });
  page.presentation.step(1);
  page.presentation.step(-1);
  page.presentation.step(-1);
  assert.deepEqual(page.asked.map(({ cue }) => cue.name), ['Door', 'Door', 'Wide', 'Arrival', 'Arrival']);
});

test('what is taken twice before the answer is one cue, and the next is prepared once', async () => {
  page.presentation.turnPreparing();
  page.presentation.take();
  page.presentation.step(1);
  assert.deepEqual(page.asked.map(({ cue }) => cue), [{ name: 'Door' }, { name: 'Door' }]);
  page.asked[0].resolve({});
  page.asked[1].resolve({});
  await settled();
  assert.equal(page.prepares(), 'Wide');
});

test('what is taken is followed by the next, unless that was ended or another chosen meanwhile', async () => {
  page.presentation.turnPreparing();
  page.presentation.take();
  page.asked[0].resolve({});
  await settled();
  assert.equal(page.prepares(), 'Wide');
  page.presentation.take();
  page.presentation.end();
  page.asked[1].resolve({});
  await settled();
  assert.equal(page.prepares(), null);
  page.presentation.turnPreparing();
  page.presentation.take();
  page.presentation.choose('Arrival');
  page.asked[2].resolve({});
  await settled();
  assert.equal(page.prepares(), 'Arrival');
});

test('without control nothing is prepared, and a line has the reason', () => {
  page.set({ steers: false });
  page.presentation.turnPreparing();
  page.set({ role: undefined });
  page.presentation.turnPreparing();
  assert.equal(page.prepares(), null);
  assert.deepEqual(page.reported, ['not-in-control', 'not-sent']);
});

test('it outlasts a lost connection', () => {
  page.presentation.turnPreparing();
  page.set({ role: undefined, steers: false, hasPicture: false });
  page.presentation.choose('Wide');
  page.presentation.turnPreparing();
  assert.equal(page.prepares(), 'Door');
  page.set({ role: 'control', state: { cues: structuredClone(CUES) } });
  assert.equal(page.prepares(), 'Door');
  page.set({ steers: true });
  page.set({ hasPicture: true });
  assert.equal(page.prepares(), 'Door');
});

test('it ends where another has control, or the cue is gone, also after a lost connection', () => {
  for (const lost of [false, true]) {
    for (const end of [{ steers: false }, { state: { cues: {} } }]) {
      page.set({ role: 'control', steers: true, hasPicture: true, state: { cues: CUES } });
      page.presentation.turnPreparing();
      if (lost) page.set({ role: undefined, steers: false, hasPicture: false });
      page.set({ role: 'control', steers: true, hasPicture: true, ...end });
      assert.equal(page.prepares(), null, JSON.stringify({ lost, end }));
    }
  }
});

test('the strip follows what it shows, and not each frame and each camera', () => {
  let count = 0;
  const show = onChange(shownOf, () => { count += 1; });
  const renderer = { mode: 'realistic', wireframe: false };
  const now = {
    ...page.store.now, state: { cues: CUES, cue: { name: 'Arrival' }, renderer, scene: { file: 'car' } },
    header: { view: { width: 20, height: 10 } },
  };
  show(now);
  show({ ...now, header: { view: { width: 20, height: 10 } }, state: { ...now.state, camera: {}, renderer: { ...renderer } } });
  show({ ...now, preparedCamera: undefined, points: true });
  assert.equal(count, 1);
  const others = [
    { header: { view: { width: 30, height: 10 } } }, { header: { view: { width: 20, height: 11 } } }, { prepares: 'Door' },
    { preparedCamera: {} }, { state: { ...now.state, cues: {} } }, { state: { ...now.state, cue: {} } },
    { state: { ...now.state, renderer: { ...renderer, wireframe: true } } },
    { state: { ...now.state, renderer: { ...renderer, mode: 'fast' } } }, { state: { ...now.state, scene: { file: 'b' } } },
  ];
  for (const [i, other] of others.entries()) {
    show({ ...now, ...other });
    assert.equal(count, 2 + i, JSON.stringify(other));
  }
});
