// A proxy that says the server another Host than the browser has in its address, as nginx does by itself.
import assert from 'node:assert/strict';
import { once } from 'node:events';
import http from 'node:http';
import { connect } from 'node:net';
import { after, before, describe, test } from 'node:test';
import { Server } from './program.js';
import { Tablet, browserIsMissing, launchBrowser } from './tablet.js';

const TABLET = { width: 1180, height: 820, pixelRatio: 1 };

/** `passesUpgrades`: handshakes of WebSockets go on to the server, and do not become ordinary requests. */
async function startProxy(passesUpgrades) {
  const sockets = new Set();
  let port;
  const host = () => ({ host: `127.0.0.1:${port}` });
  const pass = (request, response) => http.get(
    { port, path: request.url, headers: { ...request.headers, ...host() }, agent: false },
    (answer) => answer.pipe(response.writeHead(answer.statusCode, answer.headers)),
  ).on('error', () => response.destroy());
  const proxy = http.createServer(pass);
  if (passesUpgrades) {
    proxy.on('upgrade', (request, socket) => {
      const server = connect(port, '127.0.0.1');
      sockets.add(socket.on('error', () => server.destroy())).add(server.on('error', () => socket.destroy()));
      const fields = Object.entries({ ...request.headers, ...host() }).map(([name, value]) => `${name}: ${value}\r\n`);
      server.write(`GET ${request.url} HTTP/1.1\r\n${fields.join('')}\r\n`);
      socket.pipe(server).pipe(socket);
    });
  }
  proxy.listen(0, '127.0.0.1');
  await once(proxy, 'listening');
  const origin = `http://127.0.0.1:${proxy.address().port}`;
  return {
    origin,
    leadTo: (other) => { port = other; },
    stop() {
      for (const socket of sockets) socket.destroy();
      proxy.closeAllConnections();
      proxy.close();
    },
  };
}

describe('behind a proxy that says another Host', { skip: browserIsMissing }, () => {
  let browser;
  const ends = [];

  before(async () => {
    browser = await launchBrowser();
  });

  after(async () => {
    await browser?.close();
    for (const end of ends.reverse()) await end();
  });

  const proxy = async (passesUpgrades) => {
    const started = await startProxy(passesUpgrades);
    ends.push(() => started.stop());
    return started;
  };
  const serve = async (...options) => {
    const server = await Server.start(0, options);
    ends.push(() => server.stop());
    return server;
  };

  test('the page comes, and says how it may connect', async () => {
    const through = await proxy(true);
    through.leadTo((await serve()).port);
    const page = await browser.newPage();
    await page.goto(`${through.origin}/`);
    await page.getByText(`Pages of this origin may not connect: start the server with --allow-origin ${through.origin}.`)
      .waitFor();
  });

  test('with its origin allowed all is as without a proxy', async () => {
    const through = await proxy(true);
    through.leadTo((await serve('--allow-origin', through.origin.toUpperCase())).port);
    const tablet = await Tablet.open(browser, `${through.origin}/`, TABLET);
    await tablet.shows((await tablet.wire.still()).frame);
    assert.deepEqual(tablet.complaints, []);
  });

  test('one that passes no WebSockets on is named', async () => {
    const through = await proxy(false);
    through.leadTo((await serve('--allow-origin', through.origin)).port);
    const page = await browser.newPage();
    await page.goto(`${through.origin}/`);
    await page.getByText('WebSockets do not get through to the server: let the proxy pass their handshake on.').waitFor();
  });
});
