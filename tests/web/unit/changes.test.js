import assert from 'node:assert/strict';
import { test } from 'node:test';
import { Changes } from '../../../web-client/connection/commands.js';

/** Changes, and what became of them: each question waits for the test to settle it. */
function setUp() {
  const page = { asked: [], refused: [] };
  page.changes = new Changes({
    ask: (message) => new Promise((resolve, reject) => page.asked.push({ message, resolve, reject })),
    refused: (error) => page.refused.push(error.message),
  });
  page.patches = () => page.asked.map(({ message }) => message.patch);
  return page;
}

const settle = () => new Promise((done) => setImmediate(done));

test('a change is sent at once', () => {
  const page = setUp();
  page.changes.add({ camera: { fov: 50 } });
  assert.deepEqual(page.asked.map(({ message }) => message), [{ type: 'patch', patch: { camera: { fov: 50 } } }]);
});

test('those that come while one is on its way become one, the last of each member', async () => {
  const page = setUp();
  page.changes.add({ camera: { fov: 50 } });
  page.changes.add({ camera: { fov: 51 } });
  page.changes.add({ renderer: { mode: 'stylized' } });
  page.changes.add({ camera: { fov: 52 }, renderer: { wireframe: true } });
  assert.equal(page.asked.length, 1);
  page.asked[0].resolve({});
  await settle();
  assert.deepEqual(page.patches().slice(1), [{ camera: { fov: 52 }, renderer: { mode: 'stylized', wireframe: true } }]);
  page.asked[1].resolve({});
  await settle();
  assert.equal(page.asked.length, 2);
  page.changes.add({ camera: { fov: 53 } });
  assert.equal(page.asked.length, 3);
});

test('arrays and nulls are values; what was added is left as it was', async () => {
  const page = setUp();
  const first = { lights: { items: { headlight: { color: [1, 0, 0, 1] } } }, views: { side: {} } };
  const copy = structuredClone(first);
  page.changes.add({});
  page.changes.add(first);
  page.changes.add({ lights: { items: { headlight: { color: [0, 1, 0, 1] } } }, views: { side: null } });
  page.asked[0].resolve({});
  await settle();
  assert.deepEqual(page.patches()[1], {
    lights: { items: { headlight: { color: [0, 1, 0, 1] } } },
    views: { side: null },
  });
  assert.deepEqual(first, copy);
});

test('a refusal is told, and the next change goes out', async () => {
  const page = setUp();
  page.changes.add({ camera: { fov: 500 } });
  page.changes.add({ camera: { fov: 50 } });
  page.asked[0].reject(new Error('Too wide.'));
  await settle();
  assert.deepEqual(page.refused, ['Too wide.']);
  assert.deepEqual(page.patches().slice(1), [{ camera: { fov: 50 } }]);
});
