// Contract: all get what one points at, and nothing else happens.
import assert from 'node:assert/strict';
import { after, describe, test } from 'node:test';
import { ContractClient } from './contract-client.js';
import { Server } from './server.js';
import { SEEN, steering } from './stage.js';

const server = await Server.start();
after(() => server.stop());

const at = ([x, y], more = {}) => ({ type: 'point', x, y, ...more });
/** What was told of somebody since `seen` messages had come. */
const toldOf = (client, who, seen = 0) => client.texts.slice(seen).filter(({ type, client: id }) => type === 'pointed' && id === who.id);
const near = (a, b) => a.every((x, i) => Math.abs(x - b[i]) < 0.03);
const places = (told) => told.map(({ point }) => point ?? null);

/** Who presents, a wall and a watcher, who all get what a client points at. */
async function everybody(t) {
  const presenter = await steering(t, server, {});
  const wall = await ContractClient.join(t, server, { role: 'host', name: 'Wall' });
  const watcher = await ContractClient.join(t, server, { role: 'view', name: 'Guest' });
  return { presenter, wall, watcher, all: [presenter, wall, watcher] };
}

const told = (client, who, accept, seen = 0) => client.until('what it points at', () => toldOf(client, who, seen).find(accept));
const isDoor = ({ point }) => point && near(point, [1.1, 0, 0]);

describe('pointing', () => {
  test('is told to everybody, with the point, the normal and the name, and taken away', async (t) => {
    const { presenter, watcher, all } = await everybody(t);
    const { revision } = watcher;
    const { frame } = presenter.frames.at(-1).header;
    watcher.send(at(SEEN.door, { frame }));
    for (const client of all) {
      const { type, client: id, name, normal } = await told(client, watcher, isDoor);
      assert.deepEqual([type, id, name, normal.map(Math.round)], ['pointed', watcher.id, 'Guest', [0, 0, 1]]);
    }
    watcher.send({ type: 'point' });
    for (const client of all) await told(client, watcher, ({ point }) => !point);
    await watcher.barrier();
    for (const client of all) assert.deepEqual(places(toldOf(client, watcher)).map(Boolean), [true, false]);
    assert.equal(watcher.revision, revision);
  });

  test('of the moves of a finger at most 30 a second come, the last one of all', async (t) => {
    const { presenter, watcher } = await everybody(t);
    const begun = performance.now();
    const moves = 300;  // none of them near the last
    for (let i = 0; i < moves; ++i) {
      watcher.send(at([SEEN.door[0] - 50 + i / 10, SEEN.door[1]]), { id: null });
      if (i % 30 === 29) await watcher.barrier();
    }
    watcher.send(at(SEEN.door));
    const last = await told(presenter, watcher, isDoor);
    const seconds = (performance.now() - begun) / 1000;
    await presenter.barrier();
    const all = toldOf(presenter, watcher);
    assert.deepEqual(all.at(-1), last);
    assert.ok(all.length >= 2 && all.length <= 30 * seconds + 2, `${all.length} in ${seconds} s`);
  });

  test('in a frame that is forgotten is an error that says so, and all keep what they had', async (t) => {
    const { presenter, watcher, all } = await everybody(t);
    watcher.send(at(SEEN.door));
    await told(presenter, watcher, isDoor);
    const error = await watcher.refused(at(SEEN.pane, { frame: 123456 }), 'unknown-frame', { valid: true });
    assert.match(error.message, /frame 123456 is not among the last 64/);
    await Promise.all(all.map((client) => client.barrier()));
    for (const client of all) assert.equal(toldOf(client, watcher).length, 1);
    for (const wrong of [{ x: 1 }, { y: 1 }, { frame: 1 }, { x: '1', y: 1 }]) await watcher.refused({ type: 'point', ...wrong }, 'bad-message');
    await watcher.refused(at([2e6, 0]), 'out-of-range');
    await presenter.barrier();
    assert.equal(toldOf(presenter, watcher).length, 1);
  });

  test('of a watcher who leaves is taken away', async (t) => {
    const { presenter, watcher } = await everybody(t);
    watcher.send(at(SEEN.door));
    await told(presenter, watcher, isDoor);
    await watcher.leave();
    const { name } = await told(presenter, watcher, ({ point }) => !point);
    assert.equal(name, 'Guest');
  });

  test('who presents forbids it to watchers and walls, and allows it again', async (t) => {
    const { presenter, wall, watcher, all } = await everybody(t);
    for (const client of all) client.send(at(SEEN.door));
    for (const client of all) await told(presenter, client, isDoor);
    const seen = presenter.texts.length;
    await presenter.patch({ pointing: { watchers: false } });
    for (const client of [wall, watcher]) await told(presenter, client, ({ point }) => !point, seen);
    for (const client of [wall, watcher]) {
      const { message } = await client.refused(at(SEEN.door), 'not-allowed', { valid: true });
      assert.match(message, /pointing\.watchers/);
      assert.equal(client.state.pointing.watchers, false);
    }
    presenter.send(at(SEEN.pane));
    await told(watcher, presenter, ({ point }) => point && near(point, [-1.1, 0, 1]));
    assert.deepEqual(toldOf(presenter, watcher, seen).filter(({ point }) => point), []);
    await presenter.patch({ pointing: null });
    const later = presenter.texts.length;
    watcher.send(at(SEEN.door));
    await told(presenter, watcher, isDoor, later);
  });

  test('causes no frame, and takes no control', async (t) => {
    const { presenter, watcher } = await everybody(t);
    const rendered = async () => Number(/^vrut_preview_samples_drawn_total (\d+)$/m.exec(await (await server.get('metrics')).text())?.[1]);
    // From here on there is nothing better to send.
    await presenter.frame(({ quality }) => quality.level === 'still' && quality.samples === 16, 'the last refinement');
    for (let i = 0; i < 2; ++i) presenter.send({ type: 'frame' });
    const before = await rendered();
    const { length } = presenter.frames;
    for (let i = 0; i < 10; ++i) {
      const seen = presenter.texts.length;
      watcher.send(at([SEEN.door[0] + i, SEEN.door[1]]));
      await told(presenter, watcher, ({ point }) => point, seen);
    }
    assert.equal(await rendered(), before);
    assert.equal(presenter.frames.length, length);
    assert.ok(presenter.isHolder);
  });
});
