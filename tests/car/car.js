// The car's scene text as nodes with paths, and pictures of it as `vrut-preview render` draws them.
'use strict';
const assert = require('node:assert/strict');
const { spawnSync } = require('node:child_process');
const fs = require('node:fs');
const os = require('node:os');
const path = require('node:path');
const zlib = require('node:zlib');

const { VRUT_PREVIEW, VRUT_CAR_FOLDER } = process.env;
/** For what a coarse car shows as well, and for what has to look right. */
const [COARSE, FINE] = ['car-20k.vrut', 'car.vrut'].map((name) => path.join(VRUT_CAR_FOLDER, name));
const NOBODY = 0xffffff;
const IDENTITY = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1];

/** {id, name, type, path, matrix, hinge?: [x, y, z, degrees], material: name, children: [node]} of each node, by path. */
function readNodes(text) {
  const materials = new Map([...text.matchAll(/^material (\d+) "([^"]*)"/gm)].map(([, id, name]) => [id, name]));
  const nodes = [...text.matchAll(/^node (\d+) "([^"]*)" (\w+)\s+parent (\d+)([^]*?)\bend$/gm)].map(
    ([, id, name, type, parent, members]) => ({
      id: Number(id),
      name,
      type,
      parent: Number(parent),
      hinge: /hinge ((?:\S+\s+){4})/.exec(members)?.[1].trim().split(/\s+/).map(Number),
      matrix: /matrix ((?:\S+\s+){16})/.exec(members)?.[1].trim().split(/\s+/).map(Number) ?? IDENTITY,
      material: materials.get(/\bmaterial (\d+)/.exec(members)?.[1]),
      children: [],
    }),
  );
  const byId = new Map(nodes.map((node) => [node.id, node]));
  for (const node of nodes) byId.get(node.parent)?.children.push(node);
  const pathOf = (node) => (byId.has(node.parent) ? `${pathOf(byId.get(node.parent))}/` : '') + node.name;
  for (const node of nodes) node.path = pathOf(node);
  return new Map(nodes.map((node) => [node.path, node]));
}

const nodes = readNodes(fs.readFileSync(FINE, 'utf8'));
const names = new Map([...nodes.values()].map((node) => [node.id, node.path]));

function node(at) {
  assert.ok(nodes.has(at), `the car has no ${at}`);
  return nodes.get(at);
}

/** Ids of a node and all below it. */
function idsBelow(...paths) {
  const add = (ids, { id, children }) => children.reduce(add, ids.add(id));
  return paths.reduce((ids, at) => add(ids, node(at)), new Set());
}

/** The sheets of a window: outside, inside. */
const panes = (at) => [at, `${at} inside`].map(node);

const folder = fs.mkdtempSync(path.join(os.tmpdir(), 'vrut-preview-'));
process.on('exit', () => fs.rmSync(folder, { recursive: true }));

/** A car's text, changed, as a scene file beside the same textures. */
function changedCar(car, change) {
  const textures = path.join(folder, 'textures');
  if (!fs.existsSync(textures)) fs.symlinkSync(path.join(VRUT_CAR_FOLDER, 'textures'), textures);
  const file = path.join(folder, 'changed.vrut');
  fs.writeFileSync(file, change(fs.readFileSync(car, 'utf8')));
  return file;
}

/** Rows of an 8-bit RGB PNG, as {width, height, rgb}. */
function readPng(bytes) {
  const parts = [];
  for (let at = 8; at < bytes.length; at += 12 + bytes.readUInt32BE(at))
    if (bytes.toString('latin1', at + 4, at + 8) === 'IDAT') parts.push(bytes.subarray(at + 8, at + 8 + bytes.readUInt32BE(at)));
  const [width, height] = [bytes.readUInt32BE(16), bytes.readUInt32BE(20)];
  const data = zlib.inflateSync(Buffer.concat(parts));
  const stride = 3 * width;
  const rgb = Buffer.alloc(stride * height);
  for (let y = 0; y < height; y++) {
    const filter = data[y * (stride + 1)];
    for (let i = 0; i < stride; i++) {
      const here = y * stride + i;
      const a = i < 3 ? 0 : rgb[here - 3];
      const b = y === 0 ? 0 : rgb[here - stride];
      const c = i < 3 || y === 0 ? 0 : rgb[here - stride - 3];
      const p = a + b - c;
      const [da, db, dc] = [Math.abs(p - a), Math.abs(p - b), Math.abs(p - c)];
      const nearest = da <= db && da <= dc ? a : db <= dc ? b : c;
      rgb[here] = data[y * (stride + 1) + 1 + i] + [0, a, b, (a + b) >> 1, nearest][filter];
    }
  }
  return { width, height, rgb };
}

/**
 * A picture and the ids of the nodes in it.
 *
 * @param {{eye?, focus?, up?, fov?, width?, height?, set?: object[], samples?: number, scene?: string}} view
 */
function draw({ eye, focus, up, fov, width = 480, height = 320, set = [], samples = 1, scene = COARSE, options = [] }) {
  const [picture, ids] = [path.join(folder, 'picture.png'), path.join(folder, 'ids.png')];
  const pose = Object.entries({ eye, focus, up, fov }).filter(([, value]) => value !== undefined);
  const result = spawnSync(VRUT_PREVIEW, [
    'render', scene, '-o', picture, '--ids', ids, '--size', `${width}x${height}`, '--samples', String(samples),
    ...pose.flatMap(([name, value]) => [`--${name}`, String(value)]),
    '--set', JSON.stringify(merged(set)), ...options,
  ], { encoding: 'utf8' });
  assert.equal(result.status, 0, result.stderr);
  const file = fs.readFileSync(picture);
  const { rgb } = readPng(file);
  const idBytes = readPng(fs.readFileSync(ids)).rgb;
  const id = Uint32Array.from({ length: width * height }, (_, i) => idBytes.readUIntBE(3 * i, 3));
  return { width, height, file, rgb, id };
}

/** Merge patches as one. */
function merged(patches) {
  const merge = (into, from) => {
    for (const [name, value] of Object.entries(from))
      into[name] = value && typeof value === 'object' && !Array.isArray(value) ? merge({ ...into[name] }, value) : value;
    return into;
  };
  return patches.reduce(merge, {});
}

const setNode = (id, state) => ({ nodes: { [id]: state } });

/** How many pixels each node has, most first: "PATH: COUNT". */
function census(ids) {
  const counts = new Map();
  for (const id of ids) counts.set(id, (counts.get(id) ?? 0) + 1);
  return [...counts].sort((a, b) => b[1] - a[1]).map(([id, count]) => `${names.get(id) ?? id}: ${count}`);
}

module.exports = { COARSE, FINE, NOBODY, node, nodes, names, idsBelow, panes, changedCar, draw, setNode, census };
