// deploy/haproxy.cfg in front of the server, and deploy/haproxy-edges.cfg in front of two that stand in for edges: as they
// stand there but for ports, files and the user, and with their timeouts at a tenth, for a test cannot wait for an hour.
'use strict';
const assert = require('node:assert/strict');
const fs = require('node:fs');
const http = require('node:http');
const https = require('node:https');
const net = require('node:net');
const path = require('node:path');
const tls = require('node:tls');
const { once } = require('node:events');
const { after, before, describe, test } = require('node:test');
const { WebSocketServer } = require('../web/node_modules/ws');
const { Client, DEPLOY, Running, TOKENS, eventually, freePort, missing, output, temporaryFolder, tokenFile } = require('./helpers.js');
const { makeCertificate } = require('./certificate.js');

const { VRUT_PREVIEW, VRUT_CAR, VRUT_EXAMPLE_HOST } = process.env;
const folder = temporaryFolder();
const file = (name) => path.join(folder, name);

/** A configuration with each of these replaced, which must be there. */
function configuration(name, replacements) {
  let text = fs.readFileSync(path.join(DEPLOY, name), 'utf8');
  for (const [from, to] of replacements) {
    const replaced = text.replaceAll(from, to);
    assert.notEqual(replaced, text, `${from} is in ${name}`);
    text = replaced;
  }
  return text;
}

/** With a configuration of deploy/, and what else is replaced in it. */
async function startHaproxy(source, replacements) {
  const [port, plainPort] = [await freePort(), await freePort()];
  const name = file(`haproxy-${port}.cfg`);
  fs.writeFileSync(name, configuration(source, [
    ['bind :80\n', `bind 127.0.0.1:${plainPort}\n`],
    ['bind :443 ', `bind 127.0.0.1:${port} `],
    ['/etc/haproxy/vrut-preview.pem', file('both.pem')],
    ['log /dev/log local0 info', 'log stdout format raw local0 info'],
    ['    user haproxy\n    group haproxy\n    chroot /var/lib/haproxy\n', ''],
    [/^( +timeout [a-z-]+) (\d+)s$/gm, (_, timeout, seconds) => `${timeout} ${100 * seconds}ms`],
    ...replacements,
  ]));
  const haproxy = new Running('/usr/sbin/haproxy', ['-f', name], { env: { ...process.env, EDGE_TOKEN: TOKENS.view } });
  await eventually('the proxy', () => get(`https://localhost:${port}/healthz`).then(({ status }) => status === 200, () => false));
  return { haproxy, port, plainPort, name };
}

/** In front of a server on loopback. */
const startProxy = (serverPort) => startHaproxy('haproxy.cfg', [
  ['server local 127.0.0.1:8080 ', `server local 127.0.0.1:${serverPort} `],
  ['check inter 2s', 'check inter 200ms'],
]);

/** @returns {Promise<{status: number, headers: object, text: string}>} */
function get(url, { method = 'GET', headers = {} } = {}) {
  return new Promise((resolve, reject) => {
    const library = url.startsWith('https') ? https : http;
    const request = library.request(url, { method, headers, rejectUnauthorized: false, agent: false }, (response) => {
      const parts = [];
      response.on('data', (part) => parts.push(part));
      response.on('end', () => resolve({ status: response.statusCode, headers: response.headers, text: Buffer.concat(parts).toString('latin1') }));
    });
    request.on('error', reject);
    request.end();
  });
}

/** What HAProxy says to bytes that are sent over TLS, until it closes. */
function exchange(port, bytes) {
  return new Promise((resolve, reject) => {
    let text = '';
    const socket = tls.connect({ port, host: '127.0.0.1', rejectUnauthorized: false }, () => socket.write(bytes));
    socket.setEncoding('latin1').on('data', (data) => (text += data));
    socket.on('error', reject);
    socket.on('close', () => resolve(text));
  });
}

const refusedBecause = (options) => new Promise((resolve) => {
  const socket = tls.connect({ host: '127.0.0.1', rejectUnauthorized: false, ...options }, () => resolve(`spoke ${socket.getProtocol()}`));
  socket.on('error', (error) => resolve(error.code));
});

describe('HAProxy in front', { skip: missing('openssl', '/usr/sbin/haproxy') }, () => {
  let server;
  let haproxy;
  let name;
  let port;
  let plainPort;
  const place = () => `localhost:${port}`;
  const bearer = { authorization: `Bearer ${TOKENS.view}` };

  before(async () => {
    makeCertificate(folder);
    server = new Running(VRUT_PREVIEW, ['serve', VRUT_CAR, '--listen', '127.0.0.1:0', '--token-file', tokenFile(folder)]);
    const [, own] = await server.printed(/listening on http:\/\/127\.0\.0\.1:(\d+)\//);
    ({ haproxy, port, plainPort, name } = await startProxy(own));
  });

  after(() => {
    haproxy?.child.kill('SIGKILL');
    server?.child.kill('SIGKILL');
  });

  test('HAProxy has nothing to say against the configuration', () => {
    const said = output('/usr/sbin/haproxy', ['-c', '-f', name]);
    assert.doesNotMatch(said, /warning|alert/i);
  });

  test('the page, its headers, and what needs a token', async () => {
    const page = await get(`https://${place()}/`);
    assert.equal(page.status, 200);
    assert.match(page.text, /<title>/);
    assert.match(page.headers['strict-transport-security'], /max-age=31536000/);
    assert.match(page.headers['content-security-policy'], /default-src 'none'/);
    assert.equal((await get(`https://${place()}/readyz`)).status, 401);
    assert.equal((await get(`https://${place()}/readyz`, { headers: bearer })).status, 200);
    assert.match((await get(`https://${place()}/frame.jpg?width=64&height=48`, { headers: bearer })).text, /^\xff\xd8/);
  });

  test('who comes without TLS is sent on', async () => {
    const { status, headers } = await get(`http://127.0.0.1:${plainPort}/frame.jpg?width=8`, { headers: { host: 'cave.example' } });
    assert.deepEqual([status, headers.location], [308, 'https://cave.example/frame.jpg?width=8']);
  });

  test('a WebSocket brings frames, and stays when nothing is said for longer than other connections may', async () => {
    const client = await Client.join(`wss://${place()}/ws`, TOKENS.control, { origin: `https://${place()}` });
    assert.ok((await client.frame()).includes(Buffer.from([0xff, 0xd8, 0xff])));
    const timeouts = [...fs.readFileSync(name, 'utf8').matchAll(/timeout (?!tunnel)[a-z-]+ (\d+)ms/g)];
    const longest = Math.max(...timeouts.map(([, ms]) => Number(ms)));
    await new Promise((resolve) => setTimeout(resolve, longest + 500));
    await client.ask({ type: 'scenes' });
    client.socket.close();
  });

  test('a host follows the camera by TLS; one that does not trust the certificate says so', async () => {
    const host = (...options) => new Running(VRUT_EXAMPLE_HOST,
      ['--host', 'localhost', '--port', port, '--token', TOKENS.control, ...options]);
    const trusting = host('--ca-file', file('certificate.pem'));
    await trusting.printed(/^revision \d+ eye /m);
    assert.equal(await trusting.stop('SIGINT'), 0);
    const wary = host('--tls');
    await wary.printed(/its certificate is not signed by an authority that is trusted here/);
    await wary.stop('SIGINT');
  });

  test('pages of other origins may not connect', async () => {
    for (const origin of ['https://evil.example', 'null', `https://${place()}.evil.example`, `https://localhost:${port + 1}`])
      await assert.rejects(Client.connect(`wss://${place()}/ws`, { origin }), { status: 403 }, origin);
  });

  test('TLS below 1.2 is refused, 1.2 and 1.3 are spoken', async () => {
    const only = (version, more) => refusedBecause({ port, minVersion: version, maxVersion: version, ...more });
    assert.equal(await only('TLSv1.1', { ciphers: 'DEFAULT@SECLEVEL=0' }), 'ERR_SSL_TLSV1_ALERT_PROTOCOL_VERSION');
    assert.equal(await only('TLSv1.2'), 'spoke TLSv1.2');
    assert.equal(await only('TLSv1.3'), 'spoke TLSv1.3');
    assert.equal(await only('TLSv1.2', { ciphers: 'AES128-SHA' }), 'ERR_SSL_SSLV3_ALERT_HANDSHAKE_FAILURE');
  });

  test('a handshake that stands still is cut, and so is a request', async () => {
    const closes = async (socket) => {
      const limit = setTimeout(() => socket.destroy(new Error('it was not cut within 10 s')), 10_000);
      let complaint;
      socket.on('error', (error) => (complaint = error.message)).resume();
      await once(socket, 'close');
      clearTimeout(limit);
      assert.doesNotMatch(complaint ?? '', /not cut/);
    };
    await closes(net.connect(port, '127.0.0.1'));
    const hello = net.connect(port, '127.0.0.1', () => hello.write(Buffer.from('1603010200010001fc0303', 'hex')));
    await closes(hello);
    assert.match(await exchange(port, `GET / HTTP/1.1\r\nHost: ${place()}\r\n`), /^HTTP\/1\.1 408 /);
  });

  test('a handshake that comes byte by byte is cut, and so is a request', async () => {
    const dribble = async (socket, byte) => {
      const limit = Date.now() + 10_000;
      const drops = setInterval(() => Date.now() < limit ? socket.write(byte) : socket.destroy(), 100);
      let text = '';
      socket.setEncoding('latin1').on('data', (data) => (text += data)).on('error', () => {});
      await new Promise((resolve) => socket.on('close', resolve));  // also where it is reset
      clearInterval(drops);
      assert.ok(Date.now() < limit, 'it was not cut within 10 s');
      return text;
    };
    const hello = net.connect(port, '127.0.0.1', () => hello.write(Buffer.from('1603010200010001fc0303', 'hex')));
    await dribble(hello, 'x');
    const request = tls.connect({ port, host: '127.0.0.1', rejectUnauthorized: false }, () => request.write('GET / HTTP/1.1\r\nX: '));
    assert.match(await dribble(request, 'x'), /^HTTP\/1\.1 408 /);
  });

  test('requests that are no good do not reach the server', async () => {
    const host = `Host: ${place()}\r\n`;
    const status = async (bytes) => Number(/^HTTP\/1\.1 (\d+) /.exec(await exchange(port, bytes))?.[1]);
    assert.equal(await status(`GET / HTTP/1.1\r\n\r\n`), 400);
    assert.equal(await status(`GET / HTTP/1.1\r\n${host}${host.replace('localhost', 'other')}\r\n`), 400);
    assert.equal(await status(`GET / HTTP/1.1\r\n${host}Bad Name: x\r\n\r\n`), 400);
    assert.equal(await status(`GET / HTTP/1.1\r\n${host}x_y: underscored\r\n\r\n`), 403);
    assert.equal(await status(`GET / HTTP/1.1\r\n${host}Content-Length: 1\r\nContent-Length: 2\r\n\r\nab`), 400);
    assert.equal(await status(`GET / HTTP/1.1\r\n${host}Content-Length: 2\r\nConnection: close\r\n\r\nab`), 413);
    assert.equal(await status(`GET / HTTP/1.1\r\n${host}Big: ${'x'.repeat(20_000)}\r\n\r\n`), 400);
    assert.equal(await status(`POST / HTTP/1.1\r\n${host}Content-Length: 0\r\nConnection: close\r\n\r\n`), 405);
    assert.equal((await get(`https://${place()}/`)).status, 200);
  });

  test('what a client claims of where it comes from goes nowhere, its Host and Origin go on', async () => {
    const echo = http.createServer((request, response) => response.end(JSON.stringify(request.headers))).listen(0, '127.0.0.1');
    await once(echo, 'listening');
    const proxy = await startProxy(echo.address().port);
    const claims = { 'X-Forwarded-For': '10.0.0.1', 'X-Forwarded-Proto': 'http', 'X-Real-IP': '10.0.0.1', Forwarded: 'for=10.0.0.1', Via: 'me' };
    const own = { host: 'cave.example', origin: 'https://cave.example' };
    const { text } = await get(`https://localhost:${proxy.port}/`, { headers: { ...claims, ...own } });
    assert.deepEqual(JSON.parse(text), own);
    proxy.haproxy.child.kill('SIGKILL');
    echo.closeAllConnections();
    echo.close();
  });

  test('the page shows the scene in a browser', async (t) => {
    const { Tablet, browserIsMissing, launchBrowser } = await import('../web/e2e/tablet.js');
    if (browserIsMissing) return t.skip(browserIsMissing);
    const browser = await launchBrowser();
    try {
      const address = `https://${place()}/#token=${TOKENS.control}`;
      const tablet = await Tablet.open(browser, address, { width: 590, height: 410, pixelRatio: 1 }, { ignoreHTTPSErrors: true });
      const colours = await tablet.glance();
      assert.ok(Math.max(...colours) - Math.min(...colours.filter((_, i) => i % 4 < 3)) > 60);
      assert.deepEqual(tablet.complaints, []);
      await tablet.screenshot('behind-haproxy');
    } finally {
      await browser.close();
    }
  });

  test('what is logged holds no token', async () => {
    await get(`https://${place()}/frame.jpg?token=${TOKENS.view}`, { headers: bearer });
    await haproxy.printed(/GET "\/frame\.jpg" HTTP/);
    await haproxy.printed(/GET "\/ws" HTTP/);
    for (const token of Object.values(TOKENS)) assert.ok(!haproxy.text.includes(token), haproxy.text);
  });

  // From here on nobody else comes in.
  test('an address gets no more connections than it may have', async () => {
    const sockets = Array.from({ length: 60 }, () => tls.connect({ port, host: '127.0.0.1', rejectUnauthorized: false }));
    const outcomes = await Promise.all(sockets.map((socket) => new Promise((resolve) => {
      socket.once('secureConnect', () => resolve('in')).once('error', () => resolve('out'));
    })));
    for (const socket of sockets) socket.destroy();
    const entered = outcomes.filter((outcome) => outcome === 'in').length;
    assert.ok(entered > 20 && entered <= 40, `${entered}`);
  });

  test('while the server is away, it says so', async () => {
    await eventually('room', () => get(`https://${place()}/`).then(() => true, () => false));
    await server.stop();
    await eventually('503', async () => (await get(`https://${place()}/`)).status === 503);
  });

  test('an address gets no more requests than it may have, and is told so', async () => {
    const socket = tls.connect({ port, host: '127.0.0.1', rejectUnauthorized: false });
    await once(socket, 'secureConnect');
    let text = '';
    socket.setEncoding('latin1').on('data', (data) => (text += data));
    const heard = () => Array.from(text.matchAll(/^HTTP\/1\.1 (\d+)/gm), ([, status]) => status);
    let statuses = [];
    const began = Date.now();
    while (statuses.length < 4000 && !statuses.includes('429')) {
      const wanted = statuses.length + 100;
      socket.write(`GET /healthz HTTP/1.1\r\nHost: ${place()}\r\n\r\n`.repeat(100));
      statuses = await eventually('the answers', () => heard().length >= wanted && heard());
    }
    socket.destroy();
    const answered = statuses.indexOf('429');
    // The window slides: each second a tenth of what came before is forgotten.
    const most = 2000 * (1 + (Date.now() - began) / 10_000);
    assert.ok(answered > 1500 && answered <= most, `${answered} of at most ${most}`);
    assert.ok(statuses.slice(answered).every((status) => status === '429'));
  });
});

/** What stands in for an edge: it says its name, and is ready for who has the token while `isReady`. */
async function standIn(name) {
  const edge = { name, isReady: true, sockets: new Set() };
  const answer = (request, response) => {
    if (request.url === '/readyz') response.statusCode = request.headers.authorization !== `Bearer ${TOKENS.view}` ? 401 : edge.isReady ? 200 : 503;
    response.end(name);
  };
  edge.server = https.createServer({ cert: fs.readFileSync(file('certificate.pem')), key: fs.readFileSync(file('key.pem')) }, answer).listen(0, '127.0.0.1');
  edge.server.on('secureConnection', (socket) => edge.sockets.add(socket));
  new WebSocketServer({ server: edge.server });
  edge.stop = () => {
    edge.server.close();
    for (const socket of edge.sockets) socket.destroy();
  };
  await once(edge.server, 'listening');
  edge.port = edge.server.address().port;
  return edge;
}

describe('HAProxy in front of edges', { skip: missing('openssl', '/usr/sbin/haproxy') }, () => {
  let edges, proxy;
  const whose = async () => (await get(`https://localhost:${proxy.port}/rooms/car/`)).text;

  before(async () => {
    makeCertificate(folder);
    edges = [await standIn('a'), await standIn('b')];
    proxy = await startHaproxy('haproxy-edges.cfg', [
      ['server a 192.0.2.11:8090 verifyhost a.cave.example', `server a 127.0.0.1:${edges[0].port} verifyhost localhost`],
      ['server b 192.0.2.12:8090 verifyhost b.cave.example', `server b 127.0.0.1:${edges[1].port} verifyhost localhost`],
      ['@system-ca', file('certificate.pem')],
      ['check inter 1s', 'check inter 100ms'],
    ]);
  });
  after(() => {
    proxy?.haproxy.child.kill('SIGKILL');
    for (const edge of edges ?? []) edge.stop();
  });

  test('HAProxy has nothing to say against the configuration, as it stands there', () => {
    assert.doesNotMatch(output('/usr/sbin/haproxy', ['-c', '-f', proxy.name]), /warning|alert/i);
    assert.match(fs.readFileSync(path.join(DEPLOY, 'haproxy-edges.cfg'), 'utf8'), / ssl verify required ca-file @system-ca$/m);
  });

  test('all but the backend and the number of connections is as in front of one server', () => {
    const front = (name) => fs.readFileSync(path.join(DEPLOY, name), 'utf8').replace(/^(# .*\n)+/, '').split(/^backend /m)[0]
      .replace(/maxconn \d+/g, 'maxconn').replace(/default_backend \S+/, 'default_backend');
    assert.equal(front('haproxy-edges.cfg'), front('haproxy.cfg'));
  });

  test('clients stay at an edge; when it is not ready, they go to the other one, and stay there', async () => {
    const first = await whose();
    for (let i = 0; i < 6; ++i) assert.equal(await whose(), first);
    const [own, other] = first === 'a' ? edges : [...edges].reverse();
    const client = await Client.connect(`wss://localhost:${proxy.port}/rooms/car/ws`);
    own.isReady = false;
    await eventually('the end of the WebSocket', () => client.socket.readyState === client.socket.CLOSED);
    assert.equal(await whose(), other.name);
    own.isReady = true;
    await proxy.haproxy.printed(new RegExp(`Server edges/${own.name} is UP`));
    assert.equal(await whose(), other.name);
    other.stop();
    assert.equal(await whose(), own.name, 'a request that does not reach its edge is sent to the other one');
  });
});
