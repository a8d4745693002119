// Contract: hosts that follow the camera: `shown`, `stats`, and that a second client sees all that the first does.
import assert from 'node:assert/strict';
import { after, describe, test } from 'node:test';
import { setTimeout as sleep } from 'node:timers/promises';
import { ContractClient } from './contract-client.js';
import { schemaTest } from './schema.js';
import { Server } from './server.js';
import { pixelsNow, steering } from './stage.js';

const server = await Server.start();
after(() => server.stop());

const newestStats = (client) => client.texts.filter((text) => text.type === 'stats').at(-1);

describe('a host', () => {
  // Of one that does not acknowledge, the server cannot know that it keeps up.
  for (const frames of ['none', 'acknowledged', 'granted'])
    test(`sees the changes of the camera, in order, with frames beside: ${frames}`, async (t) => {
      const client = await steering(t, server);
      await client.patch({ comfort: { on: false } }); // else there are changes of the walls' camera between
      const host = await ContractClient.join(t, server, { role: 'host', name: 'Wall 1' });
      const grant = () => {
        if (frames === 'granted') host.send({ type: 'frame' });
        if (frames === 'acknowledged') host.send({ type: 'frame', shown: host.frames.at(-1).header.frame });
      };
      // From here on its link is known.
      if (frames === 'acknowledged') {
        await host.frame();
        grant();
        await host.ask({ type: 'shown', revision: host.revision });
      } else {
        // They wait until the server knows that it has taken the state, as changes do.
        await host.until('stats', () => newestStats(host));
      }
      const expected = [];
      for (let i = 1; i <= 100; ++i) {
        grant();
        expected.push((await client.ask({ type: 'navigate', rotate: [i, 0] })).revision);
      }
      await host.until('the last', () => host.revision === client.revision);
      const got = host.texts.filter((text) => text.type === 'patch' && text.by === client.id).map((text) => text.revision);
      const seen = got.filter((revision) => expected.includes(revision));
      if (frames === 'granted') {
        assert.deepEqual(seen, expected.filter((revision) => seen.includes(revision)));
        assert.equal(seen.at(-1), expected.at(-1));
      } else assert.deepEqual(seen, expected, 'a client that keeps up gets each');
      assert.deepEqual(host.state, client.state);
    });

  test('gets a camera that is limited in speed, and ends where the camera is', async (t) => {
    const client = await steering(t, server);
    await client.patch({ unit: { metres: 1 }, comfort: null });
    const host = await ContractClient.join(t, server, { role: 'host', name: 'Wall 4' });
    const before = host.state.camera;
    assert.deepEqual(before, client.state.camera);
    const { revision } = await client.ask({ type: 'navigate', rotate: [300, 0] });
    await host.until('the flick', () => host.revision >= revision);
    await client.until('the walls', () => client.state.walls);
    assert.notDeepEqual(client.state.camera, before);
    const { behindDegrees, behindMetres, ...walls } = host.state.walls;
    assert.deepEqual(host.state.camera, walls);
    assert.ok(behindDegrees > 10 && behindMetres > 0.5, `${behindDegrees} degrees, ${behindMetres} m`);
    await host.until('rest', () => !host.state.walls);
    assert.deepEqual(host.state.camera, client.state.camera);
    const speeds = host.texts.filter(({ type, patch }) => type === 'patch' && patch.walls?.behindDegrees !== undefined);
    assert.ok(speeds.length > 20, `${speeds.length} patches`);
  });

  test('has the camera at once where comfort is off, and a wrong limit is rejected', async (t) => {
    const client = await steering(t, server);
    const host = await ContractClient.join(t, server, { role: 'host' });
    for (const [comfort, code] of [[{ degreesPerSecond: 0 }, 'out-of-range'], [{ metresPerSecond: '2' }, 'bad-message']]) {
      const { message } = await client.refused({ type: 'patch', patch: { comfort } }, code);
      assert.match(message, new RegExp(`'comfort.${Object.keys(comfort)[0]}'`));
    }
    await client.patch({ comfort: { on: false } });
    const { revision } = await client.ask({ type: 'navigate', rotate: [300, 0] });
    await host.until('the flick', () => host.revision >= revision);
    assert.equal(host.state.walls, undefined);
    assert.deepEqual(host.state.camera, client.state.camera);
  });

  test('that tells what it shows is in stats, with its name, revision and lag', async (t) => {
    const client = await steering(t, server);
    const host = await ContractClient.join(t, server, { role: 'host', name: 'Wall 2' });
    const { revision } = await client.ask({ type: 'navigate', rotate: [10, 0] });
    await host.until('the patch', () => host.revision >= revision);
    await sleep(120);
    await host.ask({ type: 'shown', revision });
    const of = () => newestStats(client)?.hosts?.[host.id];
    await client.until('the host in stats', () => of()?.revision === revision);
    assert.equal(of().name, 'Wall 2');
    assert.ok(of().lagMs >= 115 && of().lagMs < 3000, `${of().lagMs} ms`);
  });

  test('leaves stats when it goes', async (t) => {
    const client = await steering(t, server);
    const host = await ContractClient.join(t, server, { role: 'host', name: 'Wall 3' });
    await host.ask({ type: 'shown', revision: host.revision });
    await client.until('the host in stats', () => newestStats(client)?.hosts?.[host.id]);
    await host.leave();
    await client.ask({ type: 'navigate', rotate: [10, 0] });
    await client.until('stats without it', () => newestStats(client).hosts[host.id] === undefined);
  });

  test('gets frames too, if it wants some', async (t) => {
    const host = await ContractClient.join(t, server, { role: 'host' });
    assert.equal((await host.frame()).format, 'jpeg');
  });
});

describe('stats', () => {
  test('tell what the server measures', async (t) => {
    const client = await steering(t, server);
    const watcher = await ContractClient.join(t, server, { role: 'view' });
    await client.ask({ type: 'navigate', rotate: [10, 0] });
    await client.frameOfNow();
    await client.until('stats', () => newestStats(client));
    const { renderer, quality, hosts, watchers, bytesPerSecond } = newestStats(client);
    for (const member of ['meanRenderMs', 'medianRenderMs', 'p95RenderMs']) assert.ok(renderer[member] > 0, member);
    assert.ok(renderer.medianRenderMs <= renderer.p95RenderMs);
    assert.equal(typeof quality, 'object');
    assert.equal(typeof hosts, 'object');
    assert.ok(Number.isInteger(watchers));
    assert.ok(bytesPerSecond >= 0);
    await watcher.until('stats at a watcher', () => newestStats(watcher));
  });

  test('come at most twice a second, and only after something happened; they cause no frame', async (t) => {
    const client = await steering(t, server);
    client.send({ type: 'frame' });
    client.send({ type: 'frame' });
    const start = Date.now();
    while (Date.now() - start < 1600) {
      await client.ask({ type: 'navigate', rotate: [1, 0] });
      await sleep(20);
    }
    const during = client.texts.filter((text) => text.type === 'stats').length;
    assert.ok(during >= 2 && during <= 5, `${during} in 1.6 s and what was before`);
    await sleep(1300); // what is still to be told
    const texts = client.texts.length;
    const frames = client.frames.length;
    await sleep(1200);
    assert.deepEqual(client.texts.slice(texts), [], 'silence');
    assert.equal(client.frames.length, frames);
  });
});

describe('markers and views, as all see them', () => {
  test('a marker is a change of the document', async (t) => {
    const client = await steering(t, server);
    await client.frame((header) => header.quality.level === 'still');
    await client.patch({ markers: { Bolt: { point: [0, 0, 1], text: 'Bolt' } } });
    assert.deepEqual([client.state.markers.Bolt.point, client.state.markers.Bolt.text], [[0, 0, 1], 'Bolt']);
    await client.patch({ markers: null });
    assert.deepEqual(client.state.markers, {});
  });

  test('views reach a client that joins later', async (t) => {
    const client = await steering(t, server);
    await client.patch({ views: { Dash: { eye: [0, 1, 2], focus: [0, 1, 0], up: [0, 1, 0], center: [0, 0, 0], fov: 60 } } });
    const late = await ContractClient.join(t, server, { role: 'view' });
    assert.deepEqual(late.state, client.state);
    assert.deepEqual(late.state.views.Dash.eye, [0, 1, 2]);
    await client.patch({ views: { Dash: null } });
  });
});

schemaTest(server);
