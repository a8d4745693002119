// What a browser is sent when it opens the page, and when it reloads it.
import assert from 'node:assert/strict';
import http from 'node:http';
import { after, test } from 'node:test';
import { gunzipSync } from 'node:zlib';
import { Server } from './server.js';

const MOST_BYTES = 64 * 1024;
const MOST_MODULES = 4;
const BROWSER = { 'accept-encoding': 'gzip, deflate, br, zstd' };

const server = await Server.start();
const connection = new http.Agent({ keepAlive: true, maxSockets: 1 });
after(async () => {
  connection.destroy();
  await server.stop();
});

/** @returns {Promise<{status: number, headers: object, body: Buffer, text: string, received: number}>} `received`: bytes */
function get(path, headers = {}) {
  return new Promise((resolve, reject) => {
    let socket;
    let before;
    const request = http.get(new URL(path, server.url), { agent: connection, headers }, (answer) => {
      const parts = [];
      answer.on('data', (part) => parts.push(part)).on('error', reject).on('end', () => {
        const body = Buffer.concat(parts);
        const text = () => (answer.headers['content-encoding'] === 'gzip' ? gunzipSync(body) : body).toString();
        resolve({
          status: answer.statusCode, headers: answer.headers, body, text: body.length ? text() : '',
          received: socket.bytesRead - before,
        });
      });
    });
    request.on('error', reject).on('socket', (used) => {
      socket = used;
      before = used.bytesRead;
    });
  });
}

/** @returns {Map<string, string>} the elements that make a browser ask for a file, by its path */
function referencesOf(index) {
  const references = new Map();
  for (const [element, path] of index.matchAll(/<(?:link|script)\b[^>]*\b(?:href|src)="([^"]+)"[^>]*>/g)) {
    references.set(path, element);
  }
  return references;
}

test('all of the page, heads and icons too, takes at most 64 KB over the wire', async () => {
  const index = await get('', BROWSER);
  let { received } = index;
  for (const path of referencesOf(index.text).keys()) {
    const answer = await get(path, BROWSER);
    assert.equal(answer.status, 200, path);
    if (!path.endsWith('.png')) assert.equal(answer.headers['content-encoding'], 'gzip', path);
    received += answer.received;
  }
  assert.ok(received > 10_000, `only ${received} bytes were counted`);
  assert.ok(received <= MOST_BYTES, `${received} bytes`);
});

/** @returns {Promise<Set<string>>} the paths of some modules and of all that they import, as `pattern` finds that */
async function importedFrom(paths, pattern) {
  const found = new Set(paths);
  for (const path of found) { // a Set goes on with what is added to it
    const { status, text } = await get(path, BROWSER);
    assert.equal(status, 200, path);
    for (const [, module] of text.matchAll(pattern)) {
      found.add(new URL(module, new URL(path, 'http://page/')).pathname.slice(1));
    }
  }
  return found;
}

const AT_ONCE = /\b(?:from|import)"(.+?)"/g;
const AT_ONCE_OR_LATER = /\b(?:from|import|import\()"(.+?)"/g;

function announcedIn(references) {
  return [...references].filter(([, element]) => /modulepreload|type="module"/.test(element)).map(([path]) => path);
}

test('each of the few modules that are imported at once is asked for at once, and no other', async () => {
  const references = referencesOf((await get('', BROWSER)).text);
  const [start] = [...references].find(([, element]) => element.includes('type="module"'));
  const imported = await importedFrom([start], AT_ONCE);
  assert.ok(imported.size > 1 && imported.size <= MOST_MODULES, `${imported.size} modules`);
  assert.deepEqual([...imported].sort(), announcedIn(references).sort());
});

test('modules that are imported later are there, and may be kept for good', async () => {
  const announced = announcedIn(referencesOf((await get('', BROWSER)).text));
  const later = [...await importedFrom(announced, AT_ONCE_OR_LATER)].filter((path) => !announced.includes(path));
  for (const name of ['cs', 'contents']) assert.ok(later.some((path) => path.includes(`/${name}-`)), later.join());
  for (const path of later) {
    const { headers } = await get(path, BROWSER);
    assert.equal(headers['content-encoding'], 'gzip', path);
    assert.equal(headers['cache-control'], 'public, max-age=31536000, immutable', path);
  }
});

test('a reload asks for the page alone, and is sent nothing', async () => {
  const index = await get('', BROWSER);
  assert.equal(index.headers['cache-control'], 'no-cache');
  const again = await get('', { ...BROWSER, 'if-none-match': index.headers.etag });
  assert.equal(again.status, 304);
  assert.equal(again.body.length, 0);
  for (const path of referencesOf(index.text).keys()) {
    const { headers } = await get(path, BROWSER);
    if (path.endsWith('.webmanifest')) {
      const known = await get(path, { ...BROWSER, 'if-none-match': headers.etag });
      assert.equal(known.status, 304);
    } else {
      assert.match(path, /^page-[0-9a-f]{16}\//);
      assert.equal(headers['cache-control'], 'public, max-age=31536000, immutable', path);
    }
  }
  assert.equal((await get('page-0123456789abcdef/app.js')).status, 404);
  const [folder] = /page-[0-9a-f]{16}\//.exec(index.text);
  assert.equal((await get(`${folder}index.html`)).status, 404, 'its references start from the root');
});

test('who does not accept gzip gets the same bytes as they are', async () => {
  const compressed = await get('app.js', BROWSER);
  assert.equal(compressed.headers.vary, 'Accept-Encoding');
  assert.ok(compressed.body.length < compressed.text.length / 2);
  for (const headers of [{}, { 'accept-encoding': 'identity' }, { 'accept-encoding': 'gzip;q=0, *;q=0.000' }, { 'accept-encoding': ';;,' }]) {
    const plain = await get('app.js', headers);
    assert.equal(plain.headers['content-encoding'], undefined, JSON.stringify(headers));
    assert.equal(plain.body.toString(), compressed.text);
    assert.notEqual(plain.headers.etag, compressed.headers.etag);
    assert.equal((await get('app.js', { ...headers, 'if-none-match': plain.headers.etag })).status, 304);
  }
  for (const headers of [{ 'accept-encoding': '*' }, { 'accept-encoding': 'br, GZIP;q=0.5' }]) {
    assert.equal((await get('app.js', headers)).headers['content-encoding'], 'gzip', JSON.stringify(headers));
  }
});
