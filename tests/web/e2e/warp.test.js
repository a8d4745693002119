import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import path from 'node:path';
import { after, afterEach, before, describe, test } from 'node:test';
import { fileURLToPath } from 'node:url';
import { browserIsMissing, launchBrowser } from './tablet.js';

const ROOT = fileURLToPath(new URL('../../../', import.meta.url));
const HOST = 'http://warp.test/';
// A frame, and what `warp::warped` makes of it (tests/warp/page_files_test.cpp).
const frame = JSON.parse(readFileSync(new URL('../../data/warps/frame.json', import.meta.url), 'utf8'));

const MOST_OFF = 24;

/** Runs in the page: makes there what the tests draw with. */
async function prepare({ file, host }) {
  const { decodeDepthMap } = await import(`${host}web-client/warp/depth-map.js`);
  const { Warp, warpMatrix } = await import(`${host}web-client/warp/warp.js`);
  const bitmapOf = async (name) => {
    const response = await fetch(`${host}tests/data/warps/${name}`);
    return createImageBitmap(await response.blob(), { colorSpaceConversion: 'none', premultiplyAlpha: 'none' });
  };
  const bytes = Uint8Array.from(file.bytes.match(/../g), (hex) => Number.parseInt(hex, 16));
  const bitmap = await bitmapOf('frame.png');
  const { width, height } = bitmap;
  const canvas = new OffscreenCanvas(width, height);
  const gl = canvas.getContext('webgl2', { alpha: false, antialias: false });
  const matrixTo = (camera) => warpMatrix(file.camera, camera, width / height);
  /** Red, green, blue and alpha, rows from the top down. */
  const drawn = () => {
    const upward = new Uint8Array(4 * gl.drawingBufferWidth * gl.drawingBufferHeight);
    gl.readPixels(0, 0, gl.drawingBufferWidth, gl.drawingBufferHeight, gl.RGBA, gl.UNSIGNED_BYTE, upward);
    const row = 4 * gl.drawingBufferWidth;
    return Array.from({ length: gl.drawingBufferHeight }, (_, y) =>
      [...upward.subarray(upward.length - row * (y + 1), upward.length - row * y)]).flat();
  };
  const pixelsOf = async (name) => {
    const image = await bitmapOf(name);
    const context = new OffscreenCanvas(image.width, image.height).getContext('2d', { willReadFrequently: true });
    context.drawImage(image, 0, 0);
    return [...context.getImageData(0, 0, image.width, image.height).data];
  };
  const map = await decodeDepthMap(bytes, file);
  Object.assign(globalThis, { Warp, bitmap, canvas, gl, map, matrixTo, drawn, pixelsOf, warp: new Warp(gl) });
}

/** Mean difference of a channel, and the part of the pixels that are off by more than MOST_OFF in one. */
function compare(a, b) {
  assert.equal(a.length, b.length);
  let sum = 0;
  let off = 0;
  for (let i = 0; i < a.length; i += 4) {
    const differences = [0, 1, 2].map((k) => Math.abs(a[i + k] - b[i + k]));
    sum += differences.reduce((one, other) => one + other);
    if (Math.max(...differences) > MOST_OFF) off += 1;
  }
  return { mean: sum / (0.75 * a.length), off: off / (a.length / 4) };
}

describe('a frame is warped', { skip: browserIsMissing }, () => {
  let browser;
  let page;
  const complaints = [];

  before(async () => {
    browser = await launchBrowser();
    page = await browser.newPage();
    page.on('pageerror', (error) => complaints.push(String(error)));
    page.on('console', (message) => complaints.push(message.text()));
    await page.route(`${HOST}**`, (route) => {
      const { pathname } = new URL(route.request().url());
      const blank = { contentType: 'text/html', body: '' };
      return route.fulfill(pathname === '/' ? blank : { path: path.join(ROOT, pathname) });
    });
    await page.goto(HOST);
    await page.evaluate(prepare, { file: frame, host: HOST });
  });

  after(async () => {
    await browser?.close();
  });

  afterEach(async () => {
    assert.equal(await page.evaluate(() => gl.getError()), 0);
    assert.deepEqual(complaints.filter((text) => !text.includes('GPU stall due to ReadPixels')), []);
  });

  const frameItself = () => page.evaluate(() => pixelsOf('frame.png'));

  test('not at all where it is drawn as it is', async () => {
    const seen = await page.evaluate(() => {
      warp.setFrame(bitmap, map);
      warp.drawPlain();
      return drawn();
    });
    assert.deepEqual(seen, await frameItself());
  });

  test('to nothing else for its own camera', async () => {
    for (const backgroundTurns of [true, false]) {
      const seen = await page.evaluate(({ camera, backgroundTurns }) => {
        warp.setFrame(bitmap, map);
        warp.draw({ matrix: matrixTo(camera), backgroundTurns });
        return drawn();
      }, { camera: frame.camera, backgroundTurns });
      const expected = await frameItself();
      assert.ok(Math.max(...seen.map((value, i) => Math.abs(value - expected[i]))) <= 2);
    }
  });

  for (const { image, camera, backgroundTurns } of frame.warps) {
    test(`as the server does: ${image}`, async (t) => {
      const [seen, expected] = await page.evaluate(async ({ image, camera, backgroundTurns }) => {
        warp.setFrame(bitmap, map);
        warp.draw({ matrix: matrixTo(camera), backgroundTurns });
        return [drawn(), await pixelsOf(image)];
      }, { image, camera, backgroundTurns });
      const { mean, off } = compare(seen, expected);
      t.diagnostic(`mean ${mean.toFixed(3)}, off ${(100 * off).toFixed(2)} %`);
      // Corners are rounded to single precision, pixels to parts of 256: what lies on an edge may go to its other side.
      assert.ok(mean < 0.5, `differs by ${mean}`);
      assert.ok(off < 0.01, `${off} of the pixels are off`);
      const before = compare(await frameItself(), expected);
      assert.ok(before.mean > 5, `the frame itself differs by ${before.mean} only`);
    });
  }

  test('with a part of the background that stays', async () => {
    const seen = await page.evaluate(({ camera }) => [true, false].map((backgroundTurns) => {
      warp.setFrame(bitmap, map);
      warp.draw({ matrix: matrixTo(camera), backgroundTurns });
      return drawn();
    }), frame.warps.find(({ image }) => image === 'around.png'));
    assert.ok(compare(...seen).off > 0.02);
  });

  test('without depth not at all', async () => {
    const seen = await page.evaluate(({ camera }) => {
      warp.setFrame(bitmap, map);
      warp.setFrame(bitmap, null);
      warp.draw({ matrix: matrixTo(camera), backgroundTurns: true });
      return drawn();
    }, frame.warps[0]);
    assert.deepEqual(seen, await frameItself());
  });

  test('on a larger canvas', async () => {
    const { camera, backgroundTurns } = frame.warps[0];
    const [large, small] = await page.evaluate(({ camera, backgroundTurns }) => {
      const { width, height } = canvas;
      warp.setFrame(bitmap, map);
      const draw = (factor) => {
        Object.assign(canvas, { width: factor * width, height: factor * height });
        warp.draw({ matrix: matrixTo(camera), backgroundTurns });
        return drawn();
      };
      return [draw(3), draw(1)];
    }, { camera, backgroundTurns });
    const middles = small.map((_, i) => {
      const [pixel, channel] = [i >> 2, i & 3];
      const [x, y] = [pixel % 96, Math.floor(pixel / 96)];
      return large[4 * ((3 * y + 1) * 3 * 96 + 3 * x + 1) + channel];
    });
    assert.ok(compare(middles, small).mean < 0.5);
  });

  test('up to a surface that the camera almost touches', async () => {
    // The square fills the view, 250 times as near as it was.
    const [seen, color] = await page.evaluate(({ camera }) => {
      warp.setFrame(bitmap, map);
      warp.drawPlain();
      const at = (x, y) => 4 * (y * canvas.width + x);
      const before = drawn();
      const focus = [camera.focus[0], camera.focus[1], camera.focus[2]];
      const eye = camera.eye.map((value, i) => focus[i] + (value - focus[i]) / 250);
      warp.draw({ matrix: matrixTo({ ...camera, eye, focus }), backgroundTurns: true });
      const [x, y] = [canvas.width / 2, canvas.height / 2];
      return [drawn(), [0, 1, 2].map((k) => (before[at(x, y) + k] + before[at(x - 1, y - 1) + k]) / 2)];
    }, { camera: frame.camera });
    for (let i = 0; i < seen.length; i += 4) {
      for (let k = 0; k < 3; k += 1) assert.ok(Math.abs(seen[i + k] - color[k]) < 12, `${i}: ${seen.slice(i, i + 3)}`);
    }
  });

  test('by maps of more corners than 16 bits count', async () => {
    const seen = await page.evaluate(({ camera }) => {
      const [columns, rows] = [320, 320];
      const steps = new Uint8Array(columns * rows).fill(200);
      const mask = new Uint16Array(columns * rows).fill(0xffff);
      warp.setFrame(bitmap, { columns, rows, scale: 0.2, near: steps, far: steps, mask });
      warp.draw({ matrix: matrixTo(camera), backgroundTurns: true });
      return drawn();
    }, { camera: frame.camera });
    assert.ok(compare(seen, await frameItself()).mean < 0.1);
  });

  test('by another Warp after the context was lost', async () => {
    const seen = await page.evaluate(async ({ camera }) => {
      const extension = gl.getExtension('WEBGL_lose_context');
      const happens = (type) => new Promise((resolve) => canvas.addEventListener(type, resolve, { once: true }));
      canvas.addEventListener('webglcontextlost', (event) => event.preventDefault(), { once: true });
      const use = (one) => {
        one.setFrame(bitmap, map);
        one.draw({ matrix: matrixTo(camera), backgroundTurns: true });
      };
      const lost = happens('webglcontextlost');
      extension.loseContext();
      use(warp);
      await lost;
      await new Promise((resolve) => setTimeout(resolve)); // the event is over, and whether it was prevented is known
      use(warp);
      const tooSoon = new Warp(gl);
      use(tooSoon);
      const restored = happens('webglcontextrestored');
      extension.restoreContext();
      await restored;
      for (const one of [warp, tooSoon]) one.delete();
      globalThis.warp = new Warp(gl);
      use(warp);
      return drawn();
    }, { camera: frame.camera });
    assert.ok(compare(seen, await frameItself()).mean < 0.1);
  });

});
