import assert from 'node:assert/strict';
import { afterEach, beforeEach, describe, test } from 'node:test';
import { Store, onChange } from '../../../web-client/base/store.js';
import { FakeWindow, replaceGlobals } from './fakes.js';

describe('onChange', () => {
  test('shows at first, and then when one of what is picked is another', () => {
    const shown = [];
    const show = onChange(({ a, b }) => [a, b?.c], (...picked) => shown.push(picked));
    const b = { c: 1 };
    show({});
    show({});
    show({ a: NaN, b });
    show({ a: NaN, b: { ...b }, other: 2 });
    show({ a: NaN, b: { c: 2 } });
    assert.deepEqual(shown, [[undefined, undefined], [NaN, 1], [NaN, 2]]);
  });
});

describe('the store', () => {
  let window;
  let restore;
  beforeEach(() => {
    window = new FakeWindow();
    restore = replaceGlobals({ requestAnimationFrame: (action) => window.requestAnimationFrame(action) });
  });
  afterEach(() => restore());

  test('tells what is set at once to who asks, and in the next display frame, once, to who has subscribed', () => {
    const store = new Store();
    const shown = [];
    store.subscribe(({ revision }) => [revision], (revision) => shown.push(revision));
    store.set({ revision: 1 });
    store.set({ revision: 2, steers: true });
    assert.equal(store.now.revision, 2);
    assert.equal(store.now.language, 'en');
    assert.deepEqual(shown, []);
    assert.equal(window.displayFrame(), 1);
    assert.deepEqual(shown, [2]);
    assert.equal(window.displayFrame(), 0);
  });

  test('promises the next value that is another', async () => {
    const store = new Store();
    const next = store.next(({ state }) => state?.scene, 'car');
    for (const state of [null, { scene: 'car' }, { scene: 'house' }, { scene: 'boat' }]) {
      store.set({ state });
      window.displayFrame();
    }
    assert.equal(await next, 'house');
  });

  test('is silent to who has subscribed to something else', () => {
    const store = new Store();
    const shown = [];
    store.subscribe(({ state }) => [state?.camera], () => shown.push('camera'));
    store.subscribe(({ state }) => [state?.views], () => shown.push('views'));
    const views = {};
    store.set({ state: { camera: { fov: 1 }, views } });
    window.displayFrame();
    store.set({ state: { camera: { fov: 2 }, views } });
    window.displayFrame();
    assert.deepEqual(shown, ['camera', 'views', 'camera']);
  });

  test('takes what a subscriber sets into the frame after', () => {
    const store = new Store();
    const shown = [];
    store.subscribe(({ revision }) => [revision], (revision) => {
      shown.push(revision);
      if (revision < 2) store.set({ revision: revision + 1 });
    });
    store.set({ revision: 1 });
    while (window.displayFrame() > 0);
    assert.deepEqual(shown, [1, 2]);
  });
});
