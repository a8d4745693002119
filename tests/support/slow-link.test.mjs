import assert from 'node:assert/strict';
import { once } from 'node:events';
import { connect, createServer } from 'node:net';
import { test } from 'node:test';
import { SlowLink } from './slow-link.mjs';

/** A server that sends back what it gets, and a link before it. */
async function echoOver(quality, use) {
  const server = createServer((socket) => socket.on('error', () => {}).pipe(socket)).listen(0, '127.0.0.1');
  await once(server, 'listening');
  const link = await SlowLink.open(server.address().port, quality);
  const client = connect(link.port, '127.0.0.1');
  try {
    await once(client, 'connect');
    await use(link, client);
  } finally {
    client.destroy();
    server.close();
  }
  return link;
}

async function echoed(client, bytes) {
  client.write(bytes);
  const parts = [];
  for (let count = 0; count < bytes.length; count += parts.at(-1).length) parts.push((await once(client, 'data'))[0]);
  return Buffer.concat(parts);
}

test('the program is a link that obeys its commands', async () => {
  const bytes = Buffer.from(Array.from({ length: 50_000 }, (_, i) => (i * i) % 251));
  const link = await echoOver({ bytesPerSecond: 1e6, delayMs: 10 }, async (link, client) => {
    let began = performance.now();
    assert.deepEqual(await echoed(client, bytes), bytes);
    assert.ok(performance.now() - began >= 68, 'the rate and the delay of both ways');

    link.delay(50);
    link.rate(1e8);
    link.stall(150);
    began = performance.now();
    await echoed(client, Buffer.from('x'));
    assert.ok(performance.now() - began >= 100, 'the delay of both ways');

    link.cut();
    const [error] = await once(client, 'error');
    assert.equal(error.code, 'ECONNRESET');
  });
  await link.close();
});

test('a command that there is not is told, and is a failure', async () => {
  const link = await echoOver({ bytesPerSecond: 1e6 }, (link) => link.rate('fast'));
  await assert.rejects(link.close(), /slow_link ended with 1/);
});
