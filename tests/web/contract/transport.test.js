// Contract: "Connecting", "Messages", "Ids and answers" and "Ends of a connection" of PROTOCOL.md.
import assert from 'node:assert/strict';
import { after, describe, test } from 'node:test';
import { ContractClient, SUBPROTOCOL } from './contract-client.js';
import { schemaTest } from './schema.js';
import { Server } from './server.js';

const MAX_MESSAGE = 65536;
const server = await Server.start();
after(() => server.stop());
const join = (t, hello) => ContractClient.join(t, server, hello);

/** A message of exactly `bytes` bytes that is right otherwise: unknown members are ignored. */
function padded(bytes, id) {
  const empty = JSON.stringify({ type: 'pick', id, x: 0, y: 0, padding: '' });
  return JSON.stringify({ type: 'pick', id, x: 0, y: 0, padding: 'x'.repeat(bytes - empty.length) });
}

/** An `error` without an id has come since `count` messages. */
const errorAfter = (client, count) => client.until('an error', () => client.texts.slice(count).find((text) => text.type === 'error'), 2000);

describe('subprotocol', () => {
  test('vrut-preview.v1 is chosen, also among others', async () => {
    for (const offer of [[SUBPROTOCOL], ['other.v7', SUBPROTOCOL]]) {
      const client = await ContractClient.connect(server, offer);
      assert.equal(client.socket.protocol, SUBPROTOCOL);
      await client.leave();
    }
  });

  test('a client that offers none is served version 1 without that header', async () => {
    const client = await ContractClient.connect(server, []);
    assert.equal(client.socket.protocol, '');
    client.send({ type: 'hello', role: 'view' });
    await client.until('welcome', () => client.welcome);
    assert.equal(client.welcome.version, 1);
    await client.leave();
  });

  test('one that offers only others is refused with 400', async () => {
    await assert.rejects(ContractClient.connect(server, ['vrut-preview.v2']), { status: 400 });
  });

  test('the WebSocket is at /ws only', async () => {
    await assert.rejects(ContractClient.connect({ ...server, ws: server.ws + 'x' }), (error) => error.status >= 400);
  });
});

describe('limits of a message', () => {
  test('65,536 bytes pass, whole or in fragments', async (t) => {
    const client = await join(t);
    const whole = padded(MAX_MESSAGE, 1);
    assert.equal(Buffer.byteLength(whole), MAX_MESSAGE);
    await client.answer(client.sendRaw({ type: 'pick', id: 1 }, whole));
    const other = padded(MAX_MESSAGE, 2);
    await client.answer(client.sendRaw({ type: 'pick', id: 2 }, other.slice(0, 40000), other.slice(40000)));
  });

  for (const fragments of [1, 2]) {
    test(`65,537 bytes in ${fragments} fragment(s) end the connection with 1009`, async () => {
      const client = await ContractClient.connect(server);
      client.send({ type: 'hello', role: 'control' });
      const text = padded(MAX_MESSAGE + 1, 2);
      const size = Math.ceil(text.length / fragments);
      for (let at = 0; at < text.length; at += size) {
        client.socket.send(text.slice(at, at + size), { fin: at + size >= text.length });
      }
      assert.equal((await client.ended()).code, 1009);
    });
  }

  const nested = (levels, id) => `{"type":"pick","id":${id},"x":0,"y":0,"deep":${'['.repeat(levels - 1)}${']'.repeat(levels - 1)}}`;
  const REFUSED = [
    ['33 levels', nested(33, 1)],
    ['a duplicate member', '{"type":"pick","x":0,"y":0,"x":1}'],
    ['a duplicate in a member that is unknown', '{"type":"pick","x":0,"y":0,"more":{"a":1,"a":2}}'],
    ['a duplicate by an escape', '{"type":"pick","x":0,"y":0,"\\u0078":1}'],
    ['NaN', '{"type":"pick","x":NaN,"y":0}'],
    ['Infinity', '{"type":"pick","x":-Infinity,"y":0}'],
    ['a number beyond doubles', '{"type":"pick","x":1e999,"y":0}', ['bad-message', 'out-of-range']],
    ['a number beyond doubles in an unknown member', '{"type":"pick","x":0,"y":0,"z":-1e999}', ['bad-message', 'out-of-range']],
    ['nothing', ''],
    ['no JSON', '{"type":"pick"'],
    ['something behind the object', '{"type":"pick","x":0,"y":0} {}'],
    ['a comment', '{"type":"pick",/* here */"x":0,"y":0}'],
    ['an array', '[{"type":"pick","x":0,"y":0}]'],
    ['a string', '"pick"'],
    ['null', 'null'],
    ['no type', '{"x":0,"y":0}'],
    ['a type that is a number', '{"type":1}'],
    ['an unknown type', '{"type":"dance"}'],
    ['an unknown type of 1000 letters', `{"type":"${'dance'.repeat(200)}"}`],
    ['a type of the server', '{"type":"welcome"}'],
  ];
  for (const [what, text, codes = ['bad-message']] of REFUSED) {
    test(`${what} is answered by an error, and the connection goes on`, async (t) => {
      const client = await join(t);
      const count = client.texts.length;
      client.socket.send(text);
      const error = await errorAfter(client, count);
      assert.ok(codes.includes(error.code), `${error.code}: ${error.message}`);
      assert.ok(error.message.length > 0);
    });
  }

  test('32 levels pass', async (t) => {
    const client = await join(t);
    await client.answer(client.sendRaw({ type: 'pick', id: 1 }, nested(32, 1)));
  });

  test('unknown members are ignored', async (t) => {
    const client = await join(t);
    await client.ask({ type: 'pick', x: 0, y: 0, dance: { with: [1, 2, null] } });
  });
});

describe('ids', () => {
  for (const [id, code] of [[0, 'out-of-range'], [-1, 'out-of-range'], [1.5, 'out-of-range'], [2 ** 53, 'out-of-range'], ['1', 'bad-message'], [null, 'bad-message']]) {
    test(`${JSON.stringify(id)} is refused`, async (t) => {
      const client = await join(t);
      const count = client.texts.length;
      client.socket.send(JSON.stringify({ type: 'pick', x: 0, y: 0, id }));
      assert.equal((await errorAfter(client, count)).code, code);
    });
  }

  test('2^53 - 1 is an id, 1.0 is an integer, and an id that does not rise is refused', async (t) => {
    const client = await join(t);
    await client.answer(client.sendRaw({ type: 'pick', id: 7 }, '{"type":"pick","x":0,"y":0,"id":7.0}'));
    await client.answer(client.sendRaw({ type: 'pick', id: 2 ** 53 - 1 }, '{"type":"pick","x":0,"y":0,"id":9007199254740991}'));
    const count = client.texts.length;
    client.sendRaw({ type: 'pick', id: 8 }, '{"type":"pick","x":0,"y":0,"id":8}');
    assert.equal((await errorAfter(client, count)).code, 'out-of-range');
  });

  test('the messages of one client are handled in order', async (t) => {
    const client = await join(t);
    const fovs = Array.from({ length: 50 }, (_, i) => 30 + ((i * 7) % 50));
    const ids = fovs.map((fov) => client.send({ type: 'patch', patch: { camera: { fov } } }));
    const revisions = [];
    for (const id of ids) revisions.push((await client.answer(id)).revision);
    assert.ok(revisions.every((revision, i) => i === 0 || revision > revisions[i - 1]), `${revisions}`);
    assert.equal(client.state.camera.fov, fovs.at(-1));
    const answers = client.texts.filter((text) => text.type === 'ok').map((text) => text.id);
    assert.deepEqual(answers, ids);
  });

  test('many messages at once get one answer each', async (t) => {
    const client = await join(t);
    const ids = Array.from({ length: 200 }, (_, i) => client.send({ type: 'pick', x: i, y: i }));
    for (const id of ids) await client.answer(id);
  });
});

describe('welcome', () => {
  test('tells version, program, client, role and limits', async (t) => {
    const names = new Set();
    for (const role of ['control', 'view', 'host']) {
      const { welcome, texts } = await join(t, { role, name: 'Somebody' });
      assert.equal(texts[0].type, 'welcome');
      assert.equal(texts[1].type, 'state');
      assert.equal(welcome.version, 1);
      assert.match(welcome.server, /^\d+\.\d+\.\d+/);
      assert.equal(typeof welcome.client, 'string');
      assert.equal(welcome.role, role);
      assert.equal(welcome.limits.maxMessage, MAX_MESSAGE);
      assert.equal(welcome.limits.maxDepth, 32);
      assert.equal(welcome.limits.maxGrants, 2);
      assert.ok(welcome.limits.maxPixels >= 1280 * 720);
      assert.ok(welcome.limits.messagesPerSecond >= 10000);
      assert.ok(welcome.limits.maxServerMessage > 0);
      names.add(welcome.client);
    }
    assert.equal(names.size, 3, 'client ids differ');
  });

  test('a hello with an id is answered', async () => {
    const client = await ContractClient.connect(server);
    const id = client.send({ type: 'hello', role: 'control' });
    await client.until('state', () => client.state);
    await client.barrier();
    assert.ok(client.texts.some((text) => text.id === id), 'every message with `id` gets exactly one answer with that id');
    await client.leave();
  });

  test('9,000 input events in a second are not too many', async (t) => {
    const client = await join(t);
    const event = { type: 'pointermove', pointerId: 1, pointerType: 'mouse', x: 1, y: 1, button: -1, buttons: 0 };
    for (let i = 0; i < 9000; ++i) client.send(event);
    await client.barrier();
    assert.equal(client.texts.find((text) => text.type === 'error'), undefined);
  });
});

describe('ends of a connection', () => {
  const HELLO = '{"type":"hello","role":"control"}';
  const ENDS = [
    ['a binary message', 1003, [HELLO, Buffer.from('{"type":"frame"}')]],
    ['another first message', 1008, ['{"type":"frame"}'], true],
    ['a hello with a role that is none', 1008, ['{"type":"hello","role":"king"}'], true],
    ['a hello without a role', 1008, ['{"type":"hello"}'], true],
    ['a hello that is no JSON', 1008, ['hello'], true],
    ['a second hello', 1008, [HELLO, HELLO], true],
  ];
  for (const [what, code, messages, told] of ENDS) {
    test(`${what}: ${code}`, async () => {
      const client = await ContractClient.connect(server);
      for (const message of messages) client.socket.send(message);
      const end = await client.ended();
      assert.equal(end.code, code);
      if (told) assert.ok(end.error, 'an error goes before');
    });
  }

  for (const [what, bytes] of [['a stray continuation', [0x80]], ['an overlong slash', [0xc0, 0xaf]], ['a surrogate', [0xed, 0xa0, 0x80]], ['half a character', [0xe2, 0x82]]]) {
    test(`invalid UTF-8, ${what}: 1007`, async () => {
      const client = await ContractClient.connect(server);
      client.socket.send(HELLO);
      client.socket.send(Buffer.concat([Buffer.from('{"type":"frame","x":"'), Buffer.from(bytes), Buffer.from('"}')]), { binary: false });
      assert.equal((await client.ended()).code, 1007);
    });
  }

  test('a character may be split between fragments', async (t) => {
    const client = await join(t);
    const text = Buffer.from('{"type":"pick","id":1,"x":0,"y":0,"unit":"€"}');
    const cut = text.indexOf(0xe2) + 1;
    await client.answer(client.sendRaw({ type: 'pick', id: 1 }, text.subarray(0, cut), text.subarray(cut)));
  });

  test('the server shuts down: 1001; too many clients: 1013', async (t) => {
    const small = await Server.start({ options: ['--max-clients', '2'] });
    t.after(() => small.stop());
    const clients = [await ContractClient.connect(small), await ContractClient.connect(small)];
    for (const client of clients) {
      client.send({ type: 'hello', role: 'view' });
      await client.until('state', () => client.state);
    }
    const third = await ContractClient.connect(small);
    third.socket.send('{"type":"hello","role":"view"}');
    assert.equal((await third.ended()).code, 1013);
    assert.equal(clients[0].closed, null);
    const status = small.stop();
    for (const client of clients) assert.equal((await client.ended()).code, 1001);
    assert.equal(await status, 0);
  });

  test('hosts and who resumes control come in, though the server has its clients', async (t) => {
    const small = await Server.start({ options: ['--max-clients', '2'] });
    t.after(() => small.stop());
    const come = (hello) => ContractClient.join(t, small, hello);
    const presenter = await come({ resume: 'a secret' });
    const watcher = await come({ role: 'view' });
    presenter.socket.terminate();
    await watcher.until('absence', () => watcher.state.control.absent);
    await come({ role: 'view' });
    const third = await ContractClient.connect(small);
    third.socket.send('{"type":"hello","role":"view"}');
    assert.equal((await third.ended()).code, 1013);
    const back = await come({ resume: 'a secret' });
    await back.until('control', () => back.isHolder);
    await come({ role: 'host' });
  });
});

schemaTest(server);
