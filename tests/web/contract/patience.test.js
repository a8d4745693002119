// Contract: what only time shows, side by side: 5 s for `hello`, 10 s for a connection that takes nothing.
import assert from 'node:assert/strict';
import { after, describe, test } from 'node:test';
import { setTimeout as sleep } from 'node:timers/promises';
import { ContractClient } from './contract-client.js';
import { Server } from './server.js';
import { holder } from './stage.js';

const CUT_AFTER_MS = 10_000;
const server = await Server.start();
after(() => server.stop());

describe('time', { concurrency: true }, () => {
  test('a connection that takes nothing for 10 s is cut; one that only has nothing to take is not', async (t) => {
    const client = await holder(t, server);
    await client.ask({ type: 'resize', width: 1280, height: 720, pixelRatio: 1 });
    // Pictures of many bytes, however slow the machine: a few are more than the kernel takes for a client.
    await client.patch({ quality: { preference: 1, latencyTargetMs: 1000 } });
    const idle = await ContractClient.join(t, server, { role: 'view' });
    const stuck = await ContractClient.join(t, server, { role: 'view' });
    stuck.socket.pause();
    const start = Date.now();
    let cutAt = null;
    stuck.socket._socket.on('error', () => (cutAt ??= Date.now() - start));
    stuck.socket._socket.on('close', () => (cutAt ??= Date.now() - start));
    while (Date.now() - start < CUT_AFTER_MS + 5000 && cutAt === null) {
      await client.ask({ type: 'navigate', rotate: [1, 0] });
      stuck.send({ type: 'frame' }); // once it has been cut, writing tells
      await client.frameOfNow();
      await sleep(30);
    }
    assert.notEqual(cutAt, null, 'it was cut');
    assert.ok(cutAt > CUT_AFTER_MS - 500, `after ${cutAt} ms`);
    assert.equal(idle.closed, null);
    await idle.barrier();
  });

  test('no hello within 5 s: 1008', async () => {
    const client = await ContractClient.connect(server);
    const start = Date.now();
    await sleep(4000);
    assert.equal(client.closed, null, 'not before 5 s');
    const end = await client.ended();
    assert.equal(end.code, 1008);
    assert.ok(Date.now() - start < 6500, `after ${Date.now() - start} ms`);
  });
});
