import assert from 'node:assert/strict';
import { readFileSync, readdirSync } from 'node:fs';
import { describe, test } from 'node:test';
import { deflateSync, inflateSync } from 'node:zlib';
import { decodeDepthMap, isStep, layersOf, reciprocalDistanceAt } from '../../../web-client/warp/depth-map.js';
import { PLACES, PLACE_BITS, Triangles, buildTriangles, packBlocks } from '../../../web-client/warp/grid.js';
import { surfaceSeen } from '../../../web-client/warp/surface.js';
import { warpMatrix } from '../../../web-client/warp/warp.js';

// Written by the tests of `warp::encode`, `warp::layers_of` and `warp::warp_matrix` (tests/warp/page_files_test.cpp).
const DATA = new URL('../../data/', import.meta.url);
const json = (path) => JSON.parse(readFileSync(new URL(path, DATA), 'utf8'));
const maps = readdirSync(new URL('depth-maps/', DATA)).map((name) => ({ name, ...json(`depth-maps/${name}`) }));
const named = (name) => maps.find((map) => map.name === `${name}.json`);

const bytesOf = (hex) => Uint8Array.from(Buffer.from(hex, 'hex'));
const decoded = (file, bytes = bytesOf(file.bytes)) => decodeDepthMap(bytes, file);
const deflated = (plain) => new Uint8Array(deflateSync(plain));

describe('depth maps', () => {
  for (const file of maps) {
    test(`${file.name} is decoded, and has the same layers`, async () => {
      const map = await decoded(file);
      assert.deepEqual([map.columns, map.rows, map.scale], [file.columns, file.rows, file.scale]);
      for (const member of ['near', 'far', 'mask']) assert.deepEqual([...map[member]], file[member], member);
      const layers = layersOf(map);
      for (const [member, expected] of Object.entries(file.layers)) {
        assert.deepEqual([...layers[member]], expected, member);
      }
    });
  }

  test('of another size are none', async () => {
    const { bytes, columns, rows, scale } = named('noise');
    const other = (size) => decodeDepthMap(bytesOf(bytes), { columns, rows, scale, ...size });
    assert.ok(await other({}));
    for (const size of [
      { columns: columns + 1 }, { rows: rows - 1 }, { columns: 0 }, { columns: -1 }, { rows: 0.5 }, { columns: 321 },
      { rows: 1e9 }, { columns: '13' }, { rows: undefined }, { scale: NaN },
    ]) {
      assert.equal(await other(size), null, JSON.stringify(size));
    }
  });

  test('that end too soon are none', async () => {
    const file = named('noise');
    const bytes = bytesOf(file.bytes);
    const plain = inflateSync(bytes);
    for (let length = 0; length < bytes.length; length += 5) {
      assert.equal(await decoded(file, bytes.subarray(0, length)), null, `${length}`);
    }
    for (const cut of [1, 2, 3, 6, 300, plain.length]) {
      assert.equal(await decoded(file, deflated(plain.subarray(0, -cut))), null, `${cut}`);
    }
  });

  test('that go on for too long are none', async () => {
    const file = named('surfaces');
    const plain = inflateSync(bytesOf(file.bytes));
    assert.ok(await decoded(file, deflated(plain)));
    for (const more of [1, 3, 3000]) {
      assert.equal(await decoded(file, deflated(Buffer.concat([plain, Buffer.alloc(more)]))), null, `${more}`);
    }
  });

  test('whose edges are no edges are none', async () => {
    const file = named('one-block');
    const [far, , near, ...mask] = inflateSync(bytesOf(file.bytes));
    assert.ok(await decoded(file, deflated(Buffer.from([far, 1, near, ...mask]))));
    assert.equal(await decoded(file, deflated(Buffer.from([far, 1, far, ...mask]))), null, 'equal');
    assert.equal(await decoded(file, deflated(Buffer.from([far, 1, 0, ...mask]))), null, 'farther');
  });

  test('that are damaged are none', async () => {
    const file = named('surfaces');
    const bytes = bytesOf(file.bytes);
    const map = await decoded(file);
    let survivors = 0;
    for (let bit = 0; bit < 8 * bytes.length; bit += 1) {
      const damaged = bytes.slice();
      damaged[bit >> 3] ^= 1 << (bit & 7);
      const other = await decoded(file, damaged);
      if (other === null) continue;
      assert.deepEqual(other, map); // some bits of the format say nothing
      survivors += 1;
    }
    assert.ok(survivors < bytes.length, `${survivors}`);
  });

  test('that inflate to very much are given up', async () => {
    const bomb = deflated(Buffer.alloc(300 * 2 ** 20));
    const before = process.memoryUsage().arrayBuffers;
    assert.equal(await decoded(named('surfaces'), bomb), null);
    assert.ok(process.memoryUsage().arrayBuffers - before < 16 * 2 ** 20);
  });
});

describe('the reciprocal distance at a place', () => {
  const map = {
    columns: 3,
    rows: 1,
    scale: 0.51,
    near: Uint8Array.of(100, 110, 250),
    far: Uint8Array.of(100, 110, 50),
    mask: Uint16Array.of(0xffff, 0xffff, 0x000c), // the upper right quarter of the last block, in part
  };
  const at = (x, y) => reciprocalDistanceAt(map, x, y) / 0.002;
  const near = (actual, expected) => assert.ok(Math.abs(actual - expected) < 1e-9, `${actual} instead of ${expected}`);

  test('lies between those of the blocks beside it', () => {
    near(at(1 / 6, 0.5), 100);
    near(at(2 / 6, 0.1), 105);
    near(at(2.5 / 6, 0.9), 107.5);
    near(at(-1, 3), 100);
  });

  test('is that of a block beside an edge, and of the side of it that is seen', () => {
    near(at(3.5 / 6, 0.5), 110);
    near(at(5 / 6 + 0.01, 0.1), 250);
    near(at(5 / 6 - 0.01, 0.1), 50);
    near(at(5 / 6 + 0.01, 0.9), 50);
    near(at(2, -1), 250);
  });

  test('is not between those of two surfaces', () => {
    const step = { ...map, near: Uint8Array.of(100, 120, 0), far: Uint8Array.of(100, 120, 0) };
    near(reciprocalDistanceAt(step, 0.32, 0.5) / 0.002, 100);
    near(reciprocalDistanceAt(step, 0.34, 0.5) / 0.002, 120);
    assert.equal(reciprocalDistanceAt(step, 0.68, 0.5), 0);
  });
});

describe('the grid', () => {
  const lists = () => ({ smooth: new Triangles(), near: new Triangles(), far: new Triangles(), hidden: new Triangles() });
  const trianglesOf = ({ indices, length }) =>
    Array.from({ length: length / 3 }, (_, i) => [...indices.subarray(3 * i, 3 * i + 3)]);

  test('of one surface has two triangles in each cell', async () => {
    const map = await decoded(named('infinity'));
    const triangles = lists();
    buildTriangles(map, layersOf(map), triangles);
    assert.equal(triangles.smooth.length, 3 * 2 * (map.columns + 1) * (map.rows + 1));
    assert.equal(Math.max(...triangles.smooth.indices), (map.columns + 2) * (map.rows + 2) - 1);
    assert.deepEqual([triangles.near.length, triangles.far.length, triangles.hidden.length], [0, 0, 0]);
  });

  test('has surfaces without steps, and what is hidden behind them ends in what is farthest', async () => {
    const map = await decoded(named('surfaces'));
    const layers = layersOf(map);
    const triangles = lists();
    buildTriangles(map, layers, triangles);
    const width = map.columns + 2;
    const clamped = (value, count) => Math.min(Math.max(value, 0), count - 1);
    const blockOf = (corner) =>
      clamped(Math.floor(corner / width) - 1, map.rows) * map.columns + clamped((corner % width) - 1, map.columns);
    const stepsOf = (steps) => (triangle) => triangle.map((corner) => steps[blockOf(corner)]);
    for (const [list, layer] of [['smooth', 'near'], ['near', 'near'], ['far', 'far']]) {
      assert.ok(triangles[list].length > 0, list);
      for (const triangle of trianglesOf(triangles[list])) {
        const steps = stepsOf(layers[layer])(triangle);
        const slope = Math.min(...stepsOf(layers[`${layer}Slope`])(triangle));
        assert.ok(!isStep(Math.min(...steps), Math.max(...steps), slope), `${list}: ${steps}`);
      }
    }
    for (const triangle of trianglesOf(triangles.smooth)) {
      assert.deepEqual(stepsOf(layers.near)(triangle), stepsOf(layers.far)(triangle));
    }
    const hidden = trianglesOf(triangles.hidden).map(stepsOf(map.far));
    assert.ok(hidden.length > 0);
    for (const steps of hidden) {
      assert.ok(isStep(steps[2], Math.max(...steps)), `${steps}`);
      assert.equal(steps[2], Math.min(...steps));
    }
  });

  test('of many blocks has corners that need more than 16 bits', () => {
    const [columns, rows] = [320, 320];
    const steps = new Uint8Array(columns * rows).fill(7);
    const map = { columns, rows, scale: 1, near: steps, far: steps, mask: new Uint16Array(columns * rows) };
    const triangles = lists();
    buildTriangles(map, layersOf(map), triangles);
    const last = (columns + 2) * (rows + 2) - 1;
    assert.equal(triangles.smooth.indices[triangles.smooth.length - 1], last);
    assert.ok(last > 0xffff);
  });

  test('is packed with its layers and with what lies behind', async () => {
    const map = await decoded(named('surfaces'));
    const layers = layersOf(map);
    const packed = new Uint32Array(2 * map.near.length);
    packBlocks(map, layers, packed);
    for (let i = 0; i < map.near.length; i += 1) {
      const [layer, behind] = packed.subarray(2 * i);
      const { near, far, mask } = layers;
      assert.deepEqual([layer & 0xff, (layer >>> 8) & 0xff, layer >>> 16], [near[i], far[i], mask[i]]);
      assert.equal(behind & 0xff, map.far[i]);
      const most = (1 << PLACE_BITS) - 1;
      const [x, y] = [(behind >>> 8) & most, (behind >>> (8 + PLACE_BITS)) & most].map((place) => place / PLACES);
      const block = Math.floor(y) * map.columns + Math.floor(x);
      assert.equal(block, layers.farthest[i]);
      if (map.near[block] === map.far[block]) {
        assert.deepEqual([x % 1, y % 1], [0.5, 0.5]);
      } else {
        assert.deepEqual([(4 * x) % 1, (4 * y) % 1], [0.5, 0.5]); // the middle of a part
        const bit = 4 * Math.floor(4 * (y % 1)) + Math.floor(4 * (x % 1));
        assert.equal((map.mask[block] >> bit) & 1, map.mask[block] === 0xffff ? 1 : 0);
      }
    }
  });
});

test('matrices are those of the server, far from the origin, too', () => {
  const pairs = json('warps/matrices.json');
  assert.ok(pairs.some(({ from }) => Math.hypot(...from.eye) > 1e7));
  for (const { from, to, aspect, matrix } of pairs) {
    for (const [i, value] of warpMatrix(from, to, aspect).entries()) {
      assert.ok(Math.abs(value - matrix[i]) < 1e-9, `${i}: ${value} instead of ${matrix[i]}`);
    }
  }
});

test('another camera sees the surface of a frame, as long as its eye has not passed it', () => {
  const wall = { columns: 1, rows: 1, scale: 1, near: [1], far: [1], mask: [0] };
  const from = { eye: [0, 0, 10], focus: [0, 0, 0], up: [0, 1, 0], center: [0, 0, 0], fov: 40 };
  const map = { ...wall, scale: 0.1 / reciprocalDistanceAt(wall, 0.5, 0.5) };
  const seenFrom = (z) => surfaceSeen(map, from, { ...from, eye: [0, 0, z], focus: [0, 0, z - 1] }, 1, { x: 0.2, y: 0.1 });
  for (const z of [12, 10, 5, 1]) assert.ok(Math.abs(seenFrom(z)[2]) < 1e-6, `from ${z}`);
  assert.equal(seenFrom(-1), null);
  assert.equal(surfaceSeen({ ...map, near: [0], far: [0] }, from, from, 1, { x: 0, y: 0 }), null);
});
