// Contract: who is here, and where others can watch.
import assert from 'node:assert/strict';
import { after, describe, test } from 'node:test';
import { ContractClient, ServerError } from './contract-client.js';
import { BY_EDGE, Server } from './server.js';

const CONTROL = 'control-token-16-b';
const VIEW = 'view-token-16-b+/';

const open = await Server.start();
const closed = await Server.start({
  env: { VRUT_PREVIEW_CONTROL_TOKEN: CONTROL, VRUT_PREVIEW_VIEW_TOKEN: VIEW }, bearer: CONTROL,
});
after(() => Promise.all([open.stop(), closed.stop()]));

test('the state names who is here, and follows them', async (t) => {
  const eva = await ContractClient.join(t, open, { name: 'Eva' });
  assert.deepEqual(eva.state.clients, { [eva.id]: { name: 'Eva', role: 'control' } });
  const wall = await ContractClient.join(t, open, { role: 'host' });
  const guest = await ContractClient.join(t, open, { role: 'view', name: 'Eva' });
  const all = {
    [eva.id]: { name: 'Eva', role: 'control' }, [wall.id]: { role: 'host' }, [guest.id]: { name: 'Eva 2', role: 'view' },
  };
  assert.deepEqual(guest.state.clients, all);
  await eva.until('all', () => eva.state.clients[guest.id]);
  assert.deepEqual(eva.state.clients, all);

  const { revision } = eva;
  const nameless = await ContractClient.join(t, open, { role: 'view' });
  assert.deepEqual(nameless.state.clients, all);
  await nameless.leave();
  await guest.leave();
  await eva.until('one less', () => !eva.state.clients[guest.id]);
  assert.equal(eva.revision, revision + 1);
  const patch = eva.texts.findLast(({ type }) => type === 'patch');
  assert.deepEqual([patch.patch, patch.by], [{ clients: { [guest.id]: null } }, undefined]);
});

describe('an address to watch at', () => {
  const ask = async (t, server, page) =>
    (await ContractClient.join(t, server, { token: CONTROL })).ask({ type: 'share', page });

  test('is that of the page, with the view token, and a QR code of it', async (t) => {
    const { address, qr, loopback } = await ask(t, closed, 'https://preview.example/car/');
    assert.equal(address, `https://preview.example/car/#watch&token=${encodeURIComponent(VIEW)}`);
    assert.equal(loopback, false);
    assert.ok(qr.length >= 21 && qr.every((row) => row.length === qr.length && /^[01]+$/.test(row)));
    assert.match(qr[0], /^11111110.*01111111$/);
    const { hash } = new URL(address);
    const watcher = await ContractClient.join(t, closed, { token: new URLSearchParams(hash.slice(1)).get('token') });
    assert.equal(watcher.welcome.role, 'view');
  });

  test('works on one machine only where the server listens for no other', async (t) => {
    assert.deepEqual(await ask(t, open, open.url).then(({ address, loopback }) => [address, loopback]), [`${open.url}#watch`, true]);
    // An edge leaves that to the room's server, which knows its own address.
    if (!BY_EDGE) assert.equal((await ask(t, open)).address, `${open.url}#watch`);
  });

  test('is told to control clients, whoever holds control, and for addresses of pages', async (t) => {
    await ContractClient.join(t, open);
    await ask(t, open, open.url);
    await assert.rejects(ask(t, open, 'javascript:alert(1)'), { code: 'out-of-range' });
    for (const role of ['view', 'host']) {
      const client = await ContractClient.join(t, open, { role });
      await assert.rejects(client.ask({ type: 'share' }), (error) => error instanceof ServerError && error.code === 'not-allowed');
    }
  });
});
