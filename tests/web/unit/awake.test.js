import assert from 'node:assert/strict';
import { afterEach, test } from 'node:test';
import { Awake } from '../../../web-client/stage/awake.js';
import { replaceGlobals } from './fakes.js';

const settled = () => new Promise((resolve) => setImmediate(resolve));

let restore;

afterEach(() => restore());

function setUp() {
  const page = { locks: [] };
  page.document = Object.assign(new EventTarget(), { hidden: false });
  page.turn = (visibilityState) => {
    page.document.hidden = visibilityState === 'hidden';
    if (page.document.hidden) for (const lock of page.held()) lock.release();
    page.document.dispatchEvent(new Event('visibilitychange'));
    return settled();
  };
  page.held = () => page.locks.filter(({ released }) => !released);
  const wakeLock = {
    async request(type) {
      assert.equal(type, 'screen');
      if (page.refuses) throw new Error('NotAllowedError');
      const lock = Object.assign(new EventTarget(), { released: false });
      lock.release = async () => {
        lock.released = true;
        lock.dispatchEvent(new Event('release'));
      };
      page.locks.push(lock);
      return lock;
    },
  };
  restore = replaceGlobals({ navigator: { wakeLock }, document: page.document });
  page.awake = new Awake();
  return page;
}

test('the screen stays on only while that is wanted', async () => {
  const { awake, held, locks } = setUp();
  await settled();
  assert.equal(held().length, 0);
  awake.wanted = true;
  awake.wanted = true;
  await settled();
  assert.equal(held().length, 1);
  awake.wanted = false;
  await settled();
  assert.equal(held().length, 0);
  assert.equal(locks.length, 1);
});

test('a page that was hidden asks again when it is seen', async () => {
  const { awake, held, locks, turn } = setUp();
  awake.wanted = true;
  await settled();
  await turn('hidden');
  assert.equal(held().length, 0);
  await turn('visible');
  assert.equal(held().length, 1);
  assert.equal(locks.length, 2);
});

test('a lock that comes too late is given back', async () => {
  const { awake, held, locks } = setUp();
  awake.wanted = true;
  awake.wanted = false;
  await settled();
  assert.equal(locks.length, 1);
  assert.equal(held().length, 0);
});

test('a browser without locks, or that refuses one, is left alone', async () => {
  const document = Object.assign(new EventTarget(), { hidden: false });
  const refusing = { wakeLock: { request: () => Promise.reject(new Error('the battery is low')) } };
  for (const navigator of [{}, refusing]) {
    restore = replaceGlobals({ navigator, document });
    const awake = new Awake();
    awake.wanted = true;
    await settled();
    awake.wanted = false;
    await settled();
    restore();
  }
});

test('a browser that wants a touch first is asked again after one', async () => {
  const page = setUp();
  page.refuses = true;
  page.awake.wanted = true;
  await settled();
  page.refuses = false;
  page.document.dispatchEvent(new Event('touchend'));
  await settled();
  assert.equal(page.held().length, 1);
  page.document.dispatchEvent(new Event('touchend'));
  await settled();
  assert.equal(page.locks.length, 1);
});
