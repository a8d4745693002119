// Contract: "HTTP" of PROTOCOL.md: the routes, with and without tokens.
import assert from 'node:assert/strict';
import http from 'node:http';
import { after, describe, test } from 'node:test';
import { ContractClient } from './contract-client.js';
import { readFrame } from './frame-file.js';
import { schemaTest } from './schema.js';
import { BY_EDGE, sceneFile, Server } from './server.js';
import { POSE, steering } from './stage.js';

const server = await Server.start();
after(() => server.stop());
const tokens = { control: 'steer-0123456789abcdef', view: 'watch-0123456789abcdef' };
const env = { VRUT_PREVIEW_CONTROL_TOKEN: tokens.control, VRUT_PREVIEW_VIEW_TOKEN: tokens.view };
const guarded = await Server.start({ scene: sceneFile('second.vrut'), env, bearer: tokens.view });
after(() => guarded.stop());
const type = (answer) => answer.headers.get('content-type') ?? '';

describe('routes', () => {
  test('/ is the page', async () => {
    const answer = await server.get('');
    assert.equal(answer.status, 200);
    assert.match(type(answer), /^text\/html/);
    assert.match(await answer.text(), /<script|<canvas|<body/);
  });

  test('/healthz: the loops are alive; /readyz: a scene is drawn', async () => {
    for (const route of ['healthz', 'readyz']) assert.equal((await server.get(route)).status, 200, route);
  });

  test('/metrics is Prometheus text', async () => {
    const answer = await server.get('metrics');
    assert.equal(answer.status, 200);
    assert.match(type(answer), /^text\/plain/);
    const text = await answer.text();
    assert.match(text, /^# TYPE \w+ (counter|gauge|histogram|summary)$/m);
    for (const line of text.trim().split('\n')) {
      assert.match(line, /^(# (HELP|TYPE) \w+ .*|\w+(\{[^}]*\})? (-?[\d.]+(e[+-]?\d+)?|NaN|[+-]Inf))$/i);
    }
  });

  test('/protocol.schema.json is a JSON Schema, draft 2020-12, of all messages', async () => {
    const answer = await server.get('protocol.schema.json');
    assert.equal(answer.status, 200);
    assert.match(type(answer), /json/);
    const schema = await answer.json();
    assert.equal(schema.$schema, 'https://json-schema.org/draft/2020-12/schema');
    const text = JSON.stringify(schema);
    for (const name of ['hello', 'resize', 'frame', 'pointerdown', 'pointermove', 'pointerup', 'pointercancel', 'wheel', 'keydown', 'keyup', 'navigate', 'fit', 'swing', 'patch', 'pick', 'snapshot', 'fly', 'tree', 'open', 'record', 'control', 'shown', 'welcome', 'state', 'stats', 'loading', 'ok', 'picked', 'flown', 'error']) {
      assert.ok(text.includes(`"${name}"`), name);
    }
  });

  test('the schema refuses what the contract refuses', { skip: server.schema.document ? false : 'the server serves no schema' }, () => {
    const refuses = (root, value) => assert.ok(server.schema.complaint(root, value), JSON.stringify(value));
    refuses('clientMessage', { type: 'dance' });
    refuses('clientMessage', { x: 1 });
    refuses('clientMessage', { type: 'hello', role: 'king' });
    refuses('clientMessage', { type: 'resize', width: 0, height: 300, pixelRatio: 1 });
    refuses('clientMessage', { type: 'resize', width: 400, height: 300 });
    refuses('clientMessage', { type: 'pick', x: '1', y: 1 });
    refuses('clientMessage', { type: 'navigate', zoom: 0 });
    refuses('clientMessage', { type: 'frame', id: 0 });
    refuses('serverMessage', { type: 'welcome' });
    refuses('serverMessage', { type: 'error', code: 'oops', message: 'Oops.' });
    refuses('serverMessage', { type: 'patch', patch: {} });
    refuses('frameHeader', {});
    refuses('stateDocument', {});
  });

  test('unknown ones: 404; /ws without an upgrade is refused', async () => {
    for (const route of ['nothing', 'healthz/', '../etc/passwd', 'frame.png', ...(BY_EDGE ? [] : ['%2e%2e/x'])]) assert.equal((await server.get(route)).status, 404, route);
    const status = (await server.get('ws')).status;
    assert.ok(status >= 400 && status < 500, `${status}`);
  });

  test('HEAD answers without a body, other methods are refused', async () => {
    const head = await fetch(`${server.url}healthz`, { method: 'HEAD' });
    assert.equal(head.status, 200);
    assert.equal((await head.text()).length, 0);
    assert.equal((await fetch(`${server.url}healthz`, { method: 'POST', body: 'x' })).status, 405);
  });
});

describe('/frame.jpg', () => {
  const get = (query = '', headers = {}) => server.get(`frame.jpg${query}`, headers);

  test('is the present view at full accuracy, of the size asked for', async (t) => {
    const client = await steering(t, server);
    const answer = await get('?width=320&height=200');
    assert.equal(answer.status, 200);
    assert.match(type(answer), /^image\/jpeg/);
    const { header, width, height, subsampling } = readFrame(Buffer.from(await answer.arrayBuffer()));
    assert.deepEqual([width, height, subsampling], [320, 200, '4:4:4']);
    assert.deepEqual([header.camera.eye, header.camera.fov], [POSE.eye, POSE.fov]);
    assert.deepEqual([header.quality.level, header.quality.scale, header.quality.detail], ['still', 1, 0]);
    assert.equal(header.revision, client.revision);
  });

  test('without a size has one', async () => {
    const answer = await get();
    assert.equal(answer.status, 200);
    const frame = readFrame(Buffer.from(await answer.arrayBuffer()));
    assert.ok(frame.width > 0 && frame.height > 0);
  });

  test('has an ETag of its revision', async (t) => {
    const client = await steering(t, server);
    const size = '?width=64&height=48';
    const etag = (await get(size)).headers.get('etag');
    assert.match(etag, /^(W\/)?"[^"]+"$/);
    assert.equal((await get(size)).headers.get('etag'), etag);
    const same = await get(size, { 'if-none-match': etag });
    assert.equal(same.status, 304);
    assert.equal((await same.arrayBuffer()).byteLength, 0);
    await client.patch({ camera: { fov: 41 } });
    const changed = await get(size, { 'if-none-match': etag });
    assert.equal(changed.status, 200);
    assert.notEqual(changed.headers.get('etag'), etag);
  });

  test('sizes that are none: 400', async () => {
    for (const query of ['?width=0&height=10', '?width=x&height=10', '?width=-1&height=1', '?width=1e9&height=1', '?width=1000000&height=1000000', '?width=10.5&height=10']) {
      assert.equal((await get(query)).status, 400, query);
    }
  });

  test('takes nobody a grant, and changes nothing', async (t) => {
    const client = await steering(t, server);
    await client.frameOfNow();
    const { revision } = client;
    const count = client.frames.length;
    await get('?width=64&height=48');
    await client.barrier();
    assert.deepEqual([client.revision, client.frames.length], [revision, count]);
  });
});

describe('with tokens', () => {  test('/, its files and /healthz are open', async () => {
    const page = await guarded.get('', {});
    assert.equal(page.status, 200);
    const file = /(?:src|href)="([^"#:]+\.(?:js|css))"/.exec(await page.text())?.[1];
    if (file) assert.equal((await guarded.get(file.replace(/^\.?\//, ''), {})).status, 200, file);
    assert.equal((await guarded.get('healthz', {})).status, 200);
  });

  for (const route of ['frame.jpg?width=16&height=16', 'report.html', 'report.csv', 'readyz', 'metrics', 'protocol.schema.json']) {
    test(`/${route} takes Authorization: Bearer`, async () => {
      for (const headers of [{}, { authorization: 'Bearer wrong' }, { authorization: `Basic ${tokens.view}` }, { authorization: tokens.view }]) {
        assert.equal((await guarded.get(route, headers)).status, 401, JSON.stringify(headers));
      }
      for (const token of Object.values(tokens)) assert.equal((await guarded.get(route, { authorization: `Bearer ${token}` })).status, 200);
      assert.equal((await guarded.get(`${route}${route.includes('?') ? '&' : '?'}token=${tokens.view}`, {})).status, 401, 'a token in the address is none');
    });
  }
});

describe("a browser's Origin", () => {
  const upgrade = (origin) => ContractClient.connect(server, undefined, { headers: { origin } });

  test("the server's own is let in, another is not", async () => {
    const own = await upgrade(new URL(server.url).origin);
    await own.leave();
    for (const origin of ['http://evil.example', server.url.replace(/:\d+\/$/, ':1'), 'null']) {
      await assert.rejects(upgrade(origin), (error) => error.status >= 400 && error.status < 500);
    }
  });

  test('one that is allowed is let in', async (t) => {
    const open = await Server.start({ options: ['--allow-origin', 'http://desk.example'] });
    t.after(() => open.stop());
    const client = await ContractClient.connect(open, undefined, { headers: { origin: 'http://desk.example' } });
    await client.leave();
    await assert.rejects(ContractClient.connect(open, undefined, { headers: { origin: 'http://evil.example' } }), (error) => error.status >= 400);
  });
});

test('a request that is none is refused, and the server goes on', async () => {
  await new Promise((resolve) => {
    const { hostname, port } = new URL(server.url);
    const request = http.request({ hostname, port, method: 'GET', path: `/${'x'.repeat(100000)}` });
    request.on('response', (response) => {
      assert.ok(response.statusCode >= 400);
      response.destroy();
      resolve();
    });
    request.on('error', resolve);
    request.end();
  });
  assert.equal((await server.get('healthz')).status, 200);
});

schemaTest(server);
