// HTTPS by the server itself: with an authority of its own, and with a company's certificate.
'use strict';
const assert = require('node:assert/strict');
const fs = require('node:fs');
const https = require('node:https');
const path = require('node:path');
const { X509Certificate } = require('node:crypto');
const { spawnSync } = require('node:child_process');
const { after, before, describe, test } = require('node:test');
const { Client, Running, TOKENS, eventually, missing, output, temporaryFolder, tokenFile } = require('./helpers.js');

const { VRUT_PREVIEW, VRUT_CAR, VRUT_EXAMPLE_HOST } = process.env;
const folder = temporaryFolder();
const file = (name) => path.join(folder, name);
const env = { ...process.env, XDG_STATE_HOME: folder };

/** @returns {Promise<{server: Running, port: string}>} */
async function start(...options) {
  const server = new Running(VRUT_PREVIEW, ['serve', VRUT_CAR, '--token-file', tokenFile(folder), ...options], { env });
  const [, port] = await server.printed(/(?:on|at) http:\/\/127\.0\.0\.1:(\d+)\//);
  return { server, port };
}

/** @returns {Promise<{status: number, text: string}>} rejects where the certificate is not good */
function get(url, ca) {
  return new Promise((resolve, reject) => {
    const request = https.request(url, { ca, agent: false }, (response) => {
      const parts = [];
      response.on('data', (part) => parts.push(part));
      response.on('end', () => resolve({ status: response.statusCode, text: Buffer.concat(parts).toString() }));
    });
    request.on('error', reject);
    request.end();
  });
}

const refusal = (...options) => {
  const { status, stderr } = spawnSync(VRUT_PREVIEW, ['serve', VRUT_CAR, ...options], { encoding: 'utf8', env, timeout: 30_000 });
  return { status, stderr };
};

describe('with an authority of its own (--lan)', () => {
  let server;
  let port;
  let authority;

  before(async () => {
    ({ server, port } = await start('--lan', '--listen', '0.0.0.0:0'));
    authority = await (await fetch(`http://127.0.0.1:${port}/authority.crt`)).text();
  });

  after(() => server?.child.kill('SIGKILL'));

  test('who trusts the authority gets the page, frames and the WebSocket, and who does not gets nothing', async () => {
    assert.equal((await get(`https://127.0.0.1:${port}/`, authority)).status, 200);
    assert.equal((await get(`https://localhost:${port}/`, authority)).status, 200);
    await assert.rejects(get(`https://127.0.0.1:${port}/`), { code: 'UNABLE_TO_VERIFY_LEAF_SIGNATURE' });
    const client = await Client.join(`wss://localhost:${port}/ws`, TOKENS.control, { ca: authority, rejectUnauthorized: true });
    assert.ok((await client.frame()).includes(Buffer.from([0xff, 0xd8, 0xff])));
    client.socket.close();
  });

  test('the fingerprint that it prints is that of the authority, and the first visit is told of', () => {
    const { fingerprint256 } = new X509Certificate(authority);
    const addresses = /listening on https:/.test(server.text);  // none where this machine has no network
    assert.equal(server.text.includes(fingerprint256), addresses);
    assert.equal(/open http:\/\/[\d.]+:\d+\/trust on it/.test(server.text), addresses);
  });

  test('the example host follows, with the authority; without it, a sentence names the remedy', async () => {
    fs.writeFileSync(file('authority.crt'), authority);
    const host = ['--host', '127.0.0.1', '--port', port, '--token', TOKENS.control];
    const follows = new Running(VRUT_EXAMPLE_HOST, [...host, '--ca-file', file('authority.crt')]);
    await follows.printed(/revision \d+ eye/);
    await follows.stop('SIGINT');
    const declines = new Running(VRUT_EXAMPLE_HOST, [...host, '--tls']);
    await declines.printed(/not signed by an authority that is trusted here: name the file of its authority/);
    await declines.stop('SIGINT');
    await eventually('two failed handshakes', async () => {
      const metrics = await (await fetch(`http://127.0.0.1:${port}/metrics`, { headers: { authorization: `Bearer ${TOKENS.view}` } })).text();
      return Number(/^vrut_preview_tls_handshakes_failed_total (\d+)/m.exec(metrics)[1]) >= 2;
    });
  });

  test('after a restart it is the same', async () => {
    await server.stop();
    ({ server, port } = await start('--lan', '--listen', '127.0.0.1:0'));
    assert.equal(await (await fetch(`http://127.0.0.1:${port}/authority.crt`)).text(), authority);
    assert.equal((await get(`https://127.0.0.1:${port}/`, authority)).status, 200);
  });

  test('an authority that others can read is refused with the remedy', () => {
    const kept = file('vrut-preview/authority.pem');
    fs.chmodSync(kept, 0o644);
    const { status, stderr } = refusal('--lan', '--listen', '127.0.0.1:0');
    assert.equal(status, 1);
    assert.match(stderr, /authority\.pem can be read by others: chmod 600 it/);
    fs.chmodSync(kept, 0o600);
  });
});

describe("with a company's certificate", { skip: missing('openssl') }, () => {
  before(() => output('openssl', [
    'req', '-x509', '-newkey', 'rsa:2048', '-nodes', '-days', '2', '-subj', '/CN=company', '-addext', 'subjectAltName=DNS:localhost',
    '-keyout', file('key.pem'), '-out', file('certificate.pem'),
  ]));

  test('it serves with that, and has no authority to trust', async () => {
    const { server, port } = await start('--listen', '127.0.0.1:0', '--tls-cert', file('certificate.pem'), '--tls-key', file('key.pem'));
    const certificate = fs.readFileSync(file('certificate.pem'), 'utf8');
    assert.equal((await get(`https://localhost:${port}/`, certificate)).status, 200);
    for (const route of ['trust', 'authority.crt']) assert.equal((await get(`https://localhost:${port}/${route}`, certificate)).status, 404);
    await server.stop();
  });

  test('what cannot be used is refused in a sentence', () => {
    assert.deepEqual([refusal('--tls-cert', file('certificate.pem')).status, refusal('--tls-key', file('key.pem')).status], [2, 2]);
    assert.equal(refusal('--lan', '--tls-cert', file('certificate.pem'), '--tls-key', file('key.pem')).status, 2);
    const { status, stderr } = refusal('--tls-cert', file('key.pem'), '--tls-key', file('key.pem'));
    assert.equal(status, 1);
    assert.match(stderr, /^vrut-preview: --tls-cert: .*key\.pem cannot be read as certificates in PEM$/m);
  });
});
