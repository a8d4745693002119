// Contract: cues, which a presentation shows one after the other.
import assert from 'node:assert/strict';
import { after, describe, test } from 'node:test';
import { ContractClient } from './contract-client.js';
import { Server } from './server.js';
import { steering } from './stage.js';

const server = await Server.start();
after(() => server.stop());

const CUES = {
  Arrival: { order: 1, ms: 0 },
  Door: { order: 2, ms: 50, camera: { eye: [3, 0, 8] }, selection: { node: 4 }, nodes: { 5: { active: false } } },
};

async function withCues(t) {
  const presenter = await steering(t, server, {});
  await presenter.patch({ cues: null, nodes: null });
  await presenter.patch({ cues: CUES });
  return presenter;
}

describe('cues', () => {
  test('are shown to everybody: host, watcher and presenter', async (t) => {
    const presenter = await withCues(t);
    const wall = await ContractClient.join(t, server, { role: 'host', name: 'Wall' });
    const watcher = await ContractClient.join(t, server, { role: 'view', name: 'Guest' });
    await presenter.ask({ type: 'cue', name: 'Arrival' });
    const id = presenter.send({ type: 'cue', step: 1 });
    const { completed } = await presenter.until('its end', () => presenter.texts.find((text) => text.type === 'flown' && text.id === id));
    assert.equal(completed, true);
    for (const client of [presenter, wall, watcher]) {
      await client.until('the cue', () => client.state.cue?.name === 'Door' && client.state.camera.eye[0] === 3);
      assert.deepEqual(client.state.nodes, { 5: { active: false } });
      assert.equal(client.state.selection.node, 4);
    }
  });

  test('are nothing that a watcher may change or show, but may have pictures of', async (t) => {
    const presenter = await withCues(t);
    const watcher = await ContractClient.join(t, server, { role: 'view', name: 'Guest' });
    const before = structuredClone(presenter.state);
    await watcher.refused({ type: 'cue', name: 'Door' }, 'not-allowed', { valid: true });
    const id = watcher.send({ type: 'snapshot', width: 64, height: 48, cue: 'Door' });
    const picture = await watcher.until('the picture', () => watcher.frames.find(({ header }) => header.snapshot === id));
    assert.equal(picture.header.camera.eye[0], 3);
    await watcher.refused({ type: 'snapshot', width: 64, height: 48, cue: 'None' }, 'unknown-cue', { valid: true });
    await presenter.barrier();
    assert.deepEqual(presenter.state.camera, before.camera);
    assert.deepEqual(presenter.state.nodes, before.nodes);
  });

  test('of another scene are refused with a sentence for each fault', async (t) => {
    const presenter = await withCues(t);
    const cues = { Good: { order: 1 }, Bad: { selection: { node: 999 }, lights: { active: 'none' } } };
    const list = { format: 'vrut-preview-cues', version: 1, scene: 'other.vrut', cues };
    const { problems, fitting } = await presenter.ask({ type: 'check', cues: list });
    assert.deepEqual(fitting, ['Good']);
    assert.deepEqual(problems.map(({ cue }) => cue), [undefined, 'Bad', 'Bad']);
    for (const [i, words] of [/other\.vrut/, /no light 'none'/, /no node 999/].entries()) assert.match(problems[i].message, words);
    const newer = await presenter.answer(presenter.sendBad({ type: 'check', cues: { ...list, version: 2 } }));
    assert.match(newer.problems[0].message, /version 2.*newer program/);
    assert.deepEqual(newer.fitting, []);
    await presenter.refused({ type: 'patch', patch: { cues } }, 'unknown-node', { valid: true });
    assert.deepEqual(Object.keys(presenter.state.cues), ['Arrival', 'Door']);
  });
});
