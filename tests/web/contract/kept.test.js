// What clients change of a scene survives a restart of the server, and another scene.
import assert from 'node:assert/strict';
import { readdirSync } from 'node:fs';
import path from 'node:path';
import { describe, test } from 'node:test';
import { SCENES, Server, temporaryFolder } from './server.js';
import { holder } from './stage.js';

const CHANGES = {
  views: { front: { eye: [0, 1, 9], focus: [0, 0, 0], fov: 25, order: 2 }, home: { fov: 33 } },
  markers: { bump: { point: [1, 2, 3], text: 'here' } },
  nodes: { 4: { active: false } },
};
const GIVE_BACK = { views: null, markers: null, nodes: null };

const kept = ({ views, markers, nodes }) => ({ views, markers, nodes });

describe('what is kept of a scene', () => {
  const start = async (t, state) => {
    const server = await Server.start({ options: ['--scenes', SCENES], env: { XDG_STATE_HOME: state } });
    t.after(() => server.stop());
    const client = await holder(t, server);
    return { server, client };
  };
  const files = (state) => readdirSync(path.join(state, 'vrut-preview/scenes'));
  const show = async (client, scene) => {
    await client.ask({ type: 'open', scene });
    await client.until(scene, () => client.state.scene.file === scene, 30000);
  };

  test('survives a restart; null gives back what the file says, and nothing is kept then', async (t) => {
    const state = temporaryFolder();
    const first = await start(t, state);
    const file = kept(first.client.state);
    await first.client.patch(CHANGES);
    const changed = kept(first.client.state);
    await first.server.stop();
    assert.deepEqual(files(state).map((name) => /^[0-9a-f]{64}\.json$/.test(name)), [true]);

    const second = await start(t, state);
    assert.deepEqual(kept(second.client.state), changed);
    assert.equal(second.client.state.camera.fov, 33);
    await second.client.patch(GIVE_BACK);
    assert.deepEqual(kept(second.client.state), file);
    await second.server.stop();
    assert.deepEqual(files(state), []);

    const third = await start(t, state);
    assert.deepEqual(kept(third.client.state), file);
  });

  test('survives another scene, and the first one can be opened again', async (t) => {
    const { client } = await start(t, temporaryFolder());
    await client.patch(CHANGES);
    const changed = kept(client.state);
    await show(client, 'second.vrut');
    assert.deepEqual(client.state.markers, {});
    await client.patch({ markers: { other: { point: [0, 0, 0] } } });
    await show(client, 'stage.vrut');
    assert.deepEqual(kept(client.state), changed);
    // At once after a change: the newest counts, whatever a disk has by then.
    await client.patch({ markers: { late: { point: [0, 0, 1] } } });
    await client.ask({ type: 'open', scene: 'stage.vrut' });
    await client.until('the scene again', () => client.state.nodes !== undefined && client.texts.filter(({ type, done }) => type === 'loading' && done).length === 3, 30000);
    assert.deepEqual(Object.keys(client.state.markers).sort(), ['bump', 'late']);
    await show(client, 'second.vrut');
    assert.deepEqual(Object.keys(client.state.markers), ['other']);
  });

  test('a folder that takes nothing is told in a notice, and all else goes on', async (t) => {
    const { client } = await start(t, '/dev/null/none');
    await client.patch(CHANGES);
    await client.until('the notice', () => client.state.notices.some(({ code, message }) => code === 'not-kept' && /cannot be kept/.test(message)), 10000);
    await client.patch({ markers: { second: { point: [0, 0, 0] } } });
  });
});
