// Contract: the state of any scene is valid by the JSON Schema, and may be patched back as it came.
import assert from 'node:assert/strict';
import { statSync } from 'node:fs';
import path from 'node:path';
import { test } from 'node:test';
import { fileURLToPath } from 'node:url';
import { Server } from './server.js';
import { holder } from './stage.js';

const OPENED_WITHIN_MS = 60_000;
/** Larger files take more than seconds to open. */
const MOST_BYTES = 30e6;
const { VRUT_CAR, VRUT_TEST_MODELS } = process.env;
const FOLDERS = {
  'the teaching scenes': { folder: fileURLToPath(new URL('../../../scenes/teaching', import.meta.url)) },
  'the car': { folder: VRUT_CAR && path.dirname(VRUT_CAR), without: 'VRUT_CAR names no file' },
  'the models': { folder: VRUT_TEST_MODELS, without: 'VRUT_TEST_MODELS names no folder' },
};

/** @returns {Promise<object>} the `state` message of the scene, or the `loading` that refuses it */
async function open(client, scene) {
  const before = client.texts.length;
  await client.ask({ type: 'open', scene });
  const isEnd = (text) => text.type === 'state' || text.refused !== undefined;
  return client.until(`the state of ${scene}`, () => client.texts.slice(before).find(isEnd), OPENED_WITHIN_MS);
}

async function checkSaidBack(client, { state, revision }) {
  const { schema } = client.server;
  assert.equal(schema.complaint('stateDocument', state), null);
  const ok = await client.patch(schema.patchOf(state));
  assert.equal(ok.revision, revision);
  assert.deepEqual(client.state, state);
}

for (const [what, { folder, without }] of Object.entries(FOLDERS))
  test(`the state of ${what} is valid, and a patch of it changes nothing`, { skip: folder ? false : without }, async (t) => {
    const server = await Server.start({ options: ['--scenes', folder] });
    t.after(() => server.stop());
    const client = await holder(t, server);
    const { file } = client.state.scene;
    const scenes = (await client.ask({ type: 'scenes' })).scenes.filter((scene) => scene !== file);
    assert.ok(scenes.length > 0);
    for (const scene of scenes)
      await t.test(scene, async (t) => {
        if (statSync(path.join(folder, scene)).size > MOST_BYTES) return t.skip('it is too large');
        const answer = await open(client, scene);
        assert.equal(answer.refused, undefined);
        return checkSaidBack(client, answer);
      });
  });
