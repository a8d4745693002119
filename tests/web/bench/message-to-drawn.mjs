// How long the page takes from a picture's message to the picture drawn, against the least that any page could do:
// createImageBitmap and drawImage. Both take turns on the same pictures, in Chromium.
import { Server } from '../e2e/program.js';
import { Tablet, launchBrowser } from '../e2e/tablet.js';

const TABLET = { width: 1180, height: 820, pixelRatio: 2 };
const PICTURES = 6;
const ROUNDS = 240;
const WARM_UP = 20;

const server = await Server.start();
const browser = await launchBrowser();
try {
  const tablet = await Tablet.open(browser, 'about:blank', TABLET);
  await tablet.page.addInitScript(keepPictures);
  await tablet.page.goto(server.address);
  const stillFrames = () => tablet.wire.frames.filter(({ quality }) => quality.level === 'still' && quality.scale === 1);
  for (let have = 0; have < PICTURES; have += 1) {
    await tablet.wire.until('a still picture', () => stillFrames().length > have);
    await tablet.say({ type: 'navigate', rotate: [20, 3] });
  }
  await tablet.wire.until('the last picture', () => stillFrames().length >= PICTURES);
  await tablet.wire.quiet(1000);

  const { page, bare, bytes } = await tablet.page.evaluate(measure, { rounds: ROUNDS, warmUp: WARM_UP });
  const [ours, least] = [median(page), median(bare)];
  const width = Math.round(TABLET.width * TABLET.pixelRatio);
  const height = Math.round(TABLET.height * TABLET.pixelRatio);
  console.log(`${ROUNDS} pictures each, ${width} × ${height}, ${Math.round(bytes.reduce((a, b) => a + b, 0) / bytes.length / 1000)} kB on average`);
  console.log(`from the message to the picture drawn, median: ${ours.toFixed(2)} ms`);
  console.log(`createImageBitmap and drawImage alone, median: ${least.toFixed(2)} ms`);
  console.log(`ratio: ${(ours / least).toFixed(3)}`);
} finally {
  await browser.close();
  await server.stop();
}

/** Runs in the page, before it: keeps what its WebSocket receives. */
function keepPictures() {
  window.pictures = [];
  window.WebSocket = class extends WebSocket {
    constructor(...about) {
      super(...about);
      this.addEventListener('message', ({ data }) => {
        if (typeof data !== 'string') window.pictures.push(data);
      });
    }
  };
}

/** Runs in the page. @returns {Promise<{page: number[], bare: number[], bytes: number[]}>} milliseconds, and sizes */
async function measure({ rounds, warmUp }) {
  const [{ Connection }, { Picture }, { frameHeader }] = await Promise.all([
    import('/connection/connection.js'), import('/stage/picture.js'), import('/connection/frame-header.js'),
  ]);
  const stills = window.pictures.filter((data) => {
    const { quality } = frameHeader(data);
    return quality.level === 'still' && quality.scale === 1;
  });
  const [ours, bare] = [0, 1].map(() => {
    const canvas = document.createElement('canvas');
    canvas.style.cssText = 'position: absolute; inset: 0; width: 100%; height: 100%';
    document.querySelector('#stage').append(canvas);
    return canvas;
  });

  // The page's own path, from the message on, with a socket whose other end is here.
  const picture = new Picture(ours);
  let drawn;
  const socket = { send() {} };
  globalThis.WebSocket = function WebSocket() {
    return socket;
  };
  const connection = new Connection({
    url: '',
    hello: { role: 'view' },
    on: {
      phase() {},
      async frame(frame) {
        if (await picture.show(frame) !== 'drawn') throw new Error('A picture was not drawn.');
        drawn();
      },
      state() {},
      error() {},
      message() {},
    },
  });
  connection.start();
  socket.onopen();
  socket.onmessage({ data: '{"type":"welcome","role":"view"}' });
  socket.onmessage({ data: '{"type":"state","revision":1,"state":{}}' });
  const byPage = (data) => new Promise((resolve) => {
    drawn = resolve;
    socket.onmessage({ data });
  });

  const context = bare.getContext('2d', { alpha: false });
  const byItself = async (data) => {
    const bitmap = await createImageBitmap(new Blob([data], { type: 'image/jpeg' }));
    if (bare.width !== bitmap.width) Object.assign(bare, { width: bitmap.width, height: bitmap.height });
    context.drawImage(bitmap, 0, 0);
    bitmap.close();
  };

  const times = new Map([[byPage, []], [byItself, []]]);
  for (let round = -warmUp; round < rounds; round += 1) {
    const data = stills[(round + warmUp) % stills.length];
    const order = [byPage, byItself];
    if (round % 2) order.reverse();
    for (const draw of order) {
      const began = performance.now();
      await draw(data);
      if (round >= 0) times.get(draw).push(performance.now() - began);
      // To the display, so that neither pays for what the other has left to do.
      await new Promise((resolve) => requestAnimationFrame(resolve));
    }
  }
  return { page: times.get(byPage), bare: times.get(byItself), bytes: stills.map(({ byteLength }) => byteLength) };
}

function median(values) {
  const sorted = [...values].sort((a, b) => a - b);
  return (sorted[Math.floor((sorted.length - 1) / 2)] + sorted[Math.ceil((sorted.length - 1) / 2)]) / 2;
}
