// A picture of any size, at full accuracy, without changing what others see.
// Needs Node 18 or later, and `npm install ws`.
import { readFile, writeFile } from 'node:fs/promises';
import { parseArgs } from 'node:util';
import WebSocket from 'ws';

const USAGE = `Usage: node snapshot.mjs OUT.png|OUT.jpg [OPTIONS]

  --size     pixels, default 1920x1080
  --camera   a JSON file with members of the state's camera (eye, focus, ...), laid over the shared one
  --quality  of a JPEG file, default 90
  --url      as the server prints it; default VRUT_PREVIEW_URL or http://127.0.0.1:8080/
  --token    where the address has none; default VRUT_PREVIEW_TOKEN; that of a watcher will do`;

const text = (value) => ({ type: 'string', default: value });
const { values: options, positionals } = parseArgs({
  allowPositionals: true,
  options: {
    size: text('1920x1080'), quality: text('90'), camera: { type: 'string' }, help: { type: 'boolean' },
    url: text(process.env.VRUT_PREVIEW_URL ?? 'http://127.0.0.1:8080/'),
    token: text(process.env.VRUT_PREVIEW_TOKEN ?? ''),
  },
});
const [out] = positionals;
if (!out || options.help) {
  console.log(USAGE);
  process.exit(options.help ? 0 : 2);
}

const [width, height] = options.size.split('x').map(Number);
const snapshot = { type: 'snapshot', id: 1, width, height, format: out.endsWith('.png') ? 'png' : 'jpeg' };
if (snapshot.format === 'jpeg') snapshot.jpegQuality = Number(options.quality);
if (options.camera) snapshot.camera = JSON.parse(await readFile(options.camera, 'utf8'));

const page = new URL(options.url);
const token = page.hash.replace('#token=', '') || options.token;
const server = new WebSocket(`${page.protocol.replace('http', 'ws')}//${page.host}/ws`, 'vrut-preview.v1');
const picture = await new Promise((resolve, reject) => {
  server.on('open', () => {
    server.send(JSON.stringify({ type: 'hello', role: 'view', token }));
    server.send(JSON.stringify(snapshot));
  });
  server.on('message', (data, isBinary) => {
    if (isBinary) return resolve(data); // no frames were asked for, so this is the snapshot
    const message = JSON.parse(data);
    if (message.type === 'error') reject(new Error(message.message));
  });
  server.on('error', reject);
  server.on('close', () => reject(new Error('the server has closed the connection')));
}).catch((error) => {
  console.error(`snapshot.mjs: ${error.message}`);
  process.exit(1);
});
await writeFile(out, picture);
server.close();
