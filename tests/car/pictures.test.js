// What a presenter does with the car, in pictures.
'use strict';
const assert = require('node:assert/strict');
const { test } = require('node:test');
const { COARSE, FINE, NOBODY, node, nodes, idsBelow, panes, changedCar, draw, setNode, census } = require('./car.js');

const FLOOR = node('Presentation/Floor shadow').id;
const isCar = (id) => id !== NOBODY && id !== FLOOR;
const CLOSE_BY = 40; // metres to where parallel lines look so; the car is within 5 m

/** Parallel views in which a pixel is a centimetre: `across` and `along` are axes of the world. */
const FLAT = {
  top: { eye: [0, CLOSE_BY, 0], up: [0, 0, 1], across: [0, -1], along: [2, 1] },
  left: { eye: [CLOSE_BY, 0, 0], up: [0, 1, 0], across: [2, -1], along: [1, 1] },
};
const SIZE = 720;
const METRES_PER_PIXEL = 0.01;

function drawFlat(view, set) {
  const { eye, up } = FLAT[view];
  const middle = 0.8;
  const from = eye.map((x, i) => x + (i === 1 ? middle : 0));
  const fov = (2 * Math.atan((SIZE * METRES_PER_PIXEL) / 2 / CLOSE_BY) * 180) / Math.PI;
  const picture = draw({ eye: from, focus: [0, middle, 0], up, fov, width: SIZE, height: SIZE, set });
  const { across, along } = FLAT[view];
  /** World coordinates [across's axis, along's axis] of the pixels that are wanted. */
  picture.points = (wanted) => {
    const points = [];
    picture.id.forEach((id, i) => {
      if (!wanted(id)) return;
      const x = ((i % SIZE) + 0.5 - SIZE / 2) * METRES_PER_PIXEL * across[1];
      const y = (SIZE / 2 - Math.floor(i / SIZE) - 0.5) * METRES_PER_PIXEL * along[1];
      points.push([x + (across[0] === 1 ? middle : 0), y + (along[0] === 1 ? middle : 0)]);
    });
    return points;
  };
  return picture;
}

/** Row by row: a rotation about an axis through the origin, right-handed. */
function rotation(axis, degrees) {
  const [c, s] = [Math.cos((degrees * Math.PI) / 180), Math.sin((degrees * Math.PI) / 180)];
  return axis === 'x' ? [1, 0, 0, 0, 0, c, -s, 0, 0, s, c, 0, 0, 0, 0, 1] : [c, 0, s, 0, 0, 1, 0, 0, -s, 0, c, 0, 0, 0, 0, 1];
}

function product(a, b) {
  return a.map((_, i) => [0, 1, 2, 3].reduce((sum, k) => sum + a[i - (i % 4) + k] * b[4 * k + (i % 4)], 0));
}

const opened = ({ at, axis, angle }) => setNode(node(at).id, { matrix: product(node(at).matrix, rotation(axis, angle)) });

const HINGED = [
  ...['Front', 'Rear'].flatMap((row) => ['left', 'right'].map((side) => {
    const sign = side === 'left' ? 1 : -1;
    const z = row === 'Front' ? 0.4 : -0.4;
    return {
      at: `Body/Doors/${row} ${side}`, flat: 'top',
      sticksOut: ([x]) => x * sign, behind: ['Interior'],
      eye: [5 * sign, 1.5, z - 2], focus: [0.5 * sign, 0.7, z],
    };
  })),
  {
    at: 'Body/Bonnet', flat: 'left', sticksOut: ([, y]) => y,
    behind: ['Drive train', 'Chassis'], eye: [1, 2, 5], focus: [0, 0.8, 1.4],
  },
  {
    at: 'Body/Boot lid', flat: 'left', sticksOut: ([z]) => -z,
    behind: ['Interior/Boot'], eye: [0.6, 1.4, -5.5], focus: [0, 0.8, -2],
  },
].map((part) => {
  const [x, y, z, angle] = node(part.at).hinge;
  const axis = { '1,0,0': 'x', '0,1,0': 'y' }[[x, y, z]];
  assert.ok(axis, `${part.at} turns about ${[x, y, z]}`);
  return { ...part, axis, angle };
});

for (const part of HINGED) {
  const ids = idsBelow(part.at);
  const [hingeX, hingeY, hingeZ] = [3, 7, 11].map((i) => node(part.at).matrix[i]);
  const hinge = part.flat === 'top' ? [hingeX, hingeZ] : [hingeZ, hingeY];

  test(`${part.at} opens about its hinge, outwards, as far as it is long`, () => {
    const shut = drawFlat(part.flat, []);
    const open = drawFlat(part.flat, [opened(part)]);
    const radians = (part.angle * Math.PI) / 180;
    // As the axis points at the viewer in neither view, the angle counts from the first axis to the second.
    const turned = ([x, y]) => {
      const [dx, dy] = [x - hinge[0], y - hinge[1]];
      const [c, s] = [Math.cos(radians), Math.sin(radians)];
      return part.axis === 'y'
        ? [hinge[0] + c * dx + s * dy, hinge[1] - s * dx + c * dy]
        : [hinge[0] + c * dx + s * dy, hinge[1] + c * dy - s * dx];
    };
    const most = (points) => points.map(part.sticksOut).reduce((a, b) => Math.max(a, b), -Infinity);
    const before = shut.points((id) => ids.has(id));
    assert.ok(before.length > 200, `${before.length} pixels of it are seen from ${part.flat}`);
    const expected = most(before.map(turned));
    const silhouette = most(shut.points(isCar));
    const reached = most(open.points((id) => ids.has(id)));
    assert.ok(reached > silhouette + 0.05, `it reaches ${reached}, the closed car ${silhouette}`);
    assert.ok(Math.abs(reached - expected) < 0.12, `it reaches ${reached} instead of ${expected}`);
  });

  test(`${part.at} stays at the body on its hinge's side`, () => {
    // Along the closed part from its hinge's side to its other end.
    const along = { 'Body/Bonnet': ([z]) => z - hinge[0], 'Body/Boot lid': ([, y]) => hinge[1] - y }[part.at] ?? (([, z]) => hinge[1] - z);
    const edge = drawFlat(part.flat, []).points((id) => ids.has(id)).map(along).reduce((a, b) => Math.min(a, b));
    const moves = 2 * Math.abs(edge * Math.sin((part.angle * Math.PI) / 360));
    assert.ok(moves < 0.05, `its edge, ${edge} m from the hinge, moves by ${moves} m`);
  });

  test(`${part.at} shows what is behind it when it opens, and closes again to the last bit`, () => {
    const view = { eye: part.eye, focus: part.focus, fov: 40 };
    const shut = draw({ ...view, scene: FINE });
    const open = draw({ ...view, scene: FINE, set: [opened(part)] });
    const again = draw({ ...view, scene: FINE, set: [opened(part), setNode(node(part.at).id, { matrix: null })] });
    assert.ok(again.file.equals(shut.file));
    assert.ok(Buffer.from(again.id.buffer).equals(Buffer.from(shut.id.buffer)));
    const behind = idsBelow(...part.behind);
    const uncovered = [...open.id].filter((id, i) => behind.has(id) && ids.has(shut.id[i])).length;
    const covered = [...shut.id].filter((id) => ids.has(id)).length;
    assert.ok(uncovered > 0.2 * covered, `${uncovered} of ${covered} pixels show it: ${census([...open.id].filter((_, i) => ids.has(shut.id[i]))).slice(0, 8)}`);
    const nothing = [...open.id].filter((id, i) => !isCar(id) && ids.has(shut.id[i])).length;
    assert.ok(nothing < 0.02 * covered, `${nothing} of ${covered} pixels show nothing`);
  });
}

const PAINTS = ['Red', 'Silver', 'Green'];
const painted = [...nodes.values()].filter(({ material }) => material?.startsWith('Paint'));
const paintSwitches = [...nodes.values()].filter(({ type, children }) => type === 'switch' && children.some(({ name }) => PAINTS.includes(name)));
const choose = (switches, child) => switches.map(({ id, children }) => setNode(id, { activeChild: children.findIndex(({ name }) => name === child) }));
const AROUND = [[4, 2, 5], [-4, 2, -5]];

test('whatever is painted can have every paint', () => {
  const offered = new Set(paintSwitches.flatMap(({ children }) => children));
  assert.deepEqual(painted.filter((part) => !offered.has(part)).map((part) => part.path), []);
  for (const { path, children } of paintSwitches)
    assert.deepEqual(children.map(({ name, material }) => `${name}: ${material}`), PAINTS.map((name) => `${name}: Paint ${name.toLowerCase()}`), path);
});

test('all painted panels change colour together', () => {
  const is = { Red: ([r, g, b]) => r > 2 * g && r > 2 * b, Silver: ([r, g, b]) => Math.max(r, g, b) < 1.25 * Math.min(r, g, b), Green: ([r, g, b]) => g > 1.3 * r && g > b };
  for (const paint of PAINTS)
    for (const eye of AROUND) {
      const { id, rgb } = draw({ eye, focus: [0, 0.7, 0], fov: 35, width: 640, height: 400, set: choose(paintSwitches, paint), options: ['--background', 'none', '--light', 'headlight'] });
      const sums = new Map();
      id.forEach((part, i) => {
        const sum = sums.get(part) ?? [0, 0, 0, 0];
        sums.set(part, [sum[0] + rgb[3 * i], sum[1] + rgb[3 * i + 1], sum[2] + rgb[3 * i + 2], sum[3] + 1]);
      });
      for (const part of painted) {
        const [r, g, b, count] = sums.get(part.id) ?? [0, 0, 0, 0];
        if (part.name !== paint) assert.equal(count, 0, `${part.path} shows beside ${paint}`);
        else if (count > 100) assert.ok(is[paint]([r, g, b].map((x) => x / count)), `${part.path} is ${[r, g, b].map((x) => Math.round(x / count))}`);
      }
      assert.ok(painted.filter((part) => (sums.get(part.id)?.[3] ?? 0) > 100).length >= 8);
    }
});

test('all wheels have the rims that are chosen', () => {
  const rims = [...nodes.values()].filter(({ path, type }) => /^Wheels\/[^/]*\/Turning\/Rim$/.test(path) && type === 'switch');
  assert.equal(rims.length, 4);
  for (const side of [1, -1]) {
    const views = rims[0].children.map(({ name }) => draw({ eye: [7 * side, 0.6, 0], focus: [0, 0.6, 0], fov: 40, set: choose(rims, name) }));
    rims[0].children.forEach(({ name }, k) => {
      const shown = new Set(views[k].id);
      const wheels = rims.filter(({ path }) => path.includes(side > 0 ? 'left' : 'right'));
      for (const { path, children } of wheels)
        for (const child of children)
          assert.equal([...idsBelow(child.path)].some((id) => shown.has(id)), child.name === name, `${path} with ${name}: ${child.name}`);
    });
  }
});

test('tyres have their tread near by, and none far away', () => {
  const tyres = [...nodes.values()].filter(({ type }) => type === 'lod');
  assert.equal(tyres.length, 4);
  const [near, far] = [3, 60].map((away) => new Set(draw({ eye: [away, 0.4, 1.3], focus: [0.7, 0.3, 1.3], fov: 40 * (3 / away), scene: FINE }).id));
  const { children } = node('Wheels/Front left/Turning/Tyre');
  const shown = (ids) => children.map(({ path }) => [...idsBelow(path)].some((id) => ids.has(id)));
  assert.deepEqual(shown(near), [true, false]);
  assert.deepEqual(shown(far), [false, true]);
});

const camera = (name) => ({ camera: { node: node(`Presentation/Cameras/${name}`).id } });

for (const [width, height] of [[480, 320], [640, 360], [400, 300]]) {
  test(`from outside the whole car is in a picture of ${width} x ${height}`, () => {
    const { id } = draw({ width, height, set: [camera('Outside')] });
    const car = [...id].map((part, i) => [part, i % width, Math.floor(i / width)]).filter(([part]) => isCar(part));
    assert.ok(car.length > 0.12 * width * height);
    assert.equal(car.filter(([, x, y]) => x === 0 || y === 0 || x === width - 1 || y === height - 1).length, 0);
  });
}

test("from the driver's seat the driver sees what to drive by", () => {
  const { id } = draw({ width: 960, height: 540, set: [camera("Driver's seat")] });
  const seen = new Map();
  for (const part of id) seen.set(part, (seen.get(part) ?? 0) + 1);
  const count = (at) => [...idsBelow(at)].reduce((sum, part) => sum + (seen.get(part) ?? 0), 0);
  for (const [at, least] of [
    ['Interior/Steering/Steering wheel', 5000], ['Interior/Dashboard/Instrument cluster/Dials', 2000], ['Body/Windows/Windscreen inside', 50_000],
    ['Interior/Interior mirror/Interior mirror glass', 2000], ['Interior/Dashboard/Centre stack/Screen', 1000], ['Body/Doors/Front left/Window inside', 2000],
  ])
    assert.ok(count(at) >= least, `${count(at)} pixels of ${at}`);
});

test("through the window beside the driver's seat its mirror is seen", () => {
  const glass = panes('Body/Doors/Front left/Window').map((pane) => setNode(pane.id, { active: false }));
  const { id } = draw({ width: 960, height: 540, set: [camera("Driver's seat"), ...glass] });
  const mirror = node('Body/Doors/Front left/Mirror/Glass').id;
  const pixels = [...id].filter((part) => part === mirror).length;
  assert.ok(pixels > 1000, `${pixels} pixels of its glass`);
});

const EYE = [0.36, 1.17, -0.2];
const LOOKS = { ahead: [0, 0, 1], back: [0, 0, -1], left: [1, 0, 0], right: [-1, 0, 0], up: [0, 1, 0], down: [0, -1, 0] };

const SIGHTS = {
  'as the camera stands': { set: [camera("Driver's seat")], width: 960, height: 540 },
  ...Object.fromEntries(Object.entries(LOOKS).map(([name, direction]) => [
    name, { eye: EYE, focus: EYE.map((x, i) => x + direction[i]), up: direction[1] ? [0, 0, 1] : [0, 1, 0], fov: 90, width: 480, height: 480 },
  ])),
};

for (const [name, view] of Object.entries(SIGHTS)) {
  test(`from the driver's eye no gap is seen: ${name}`, () => {
    const { width, id } = draw({ ...view, scene: FINE });
    const gaps = [...id.keys()].filter((i) => !isCar(id[i])).map((i) => [i % width, Math.floor(i / width)]);
    const beside = gaps.flatMap(([x, y]) => [-3, 3].flatMap((d) => [id[y * width + x + d], id[(y + d) * width + x]])).filter(isCar);
    assert.equal(gaps.length, 0, `${gaps.length} pixels, as ${gaps[0]} and ${gaps.at(-1)}, beside ${census(beside).slice(0, 6).join(', ')}`);
  });
}

/** Pixels of the car and their mean brightness. */
function brightness({ id, rgb }) {
  let [sum, count] = [0, 0];
  id.forEach((part, i) => {
    if (!isCar(part)) return;
    sum += (rgb[3 * i] + rgb[3 * i + 1] + rgb[3 * i + 2]) / 3;
    count++;
  });
  return sum / count;
}

test('each light lights the car, and each differently', () => {
  const lights = node('Presentation/Lights').children;
  assert.ok(lights.length >= 3);
  const pictures = lights.map(({ id }) => draw({ set: [camera('Outside')], options: ['--light', String(id)] }));
  const dark = changedCar(COARSE, (text) => text.replace(/(type \w+ {2}color) \S+ \S+ \S+ /g, '$1 0 0 0 '));
  const least = brightness(draw({ scene: dark, set: [camera('Outside')], options: ['--light', String(lights[0].id)] }));
  pictures.forEach((picture, k) => assert.ok(brightness(picture) > least + 5, `${lights[k].path}: ${brightness(picture)} instead of ${least}`));
  assert.equal(new Set(pictures.map(({ rgb }) => rgb.toString('latin1'))).size, lights.length);
});

test('each background stands behind the car', () => {
  const backgrounds = [...node('Presentation/Backgrounds').children.map(({ id }) => String(id)), 'none'];
  const views = backgrounds.map((id) => draw({ set: [camera('Outside')], options: ['--background', id] }));
  const corner = ({ rgb }) => rgb.subarray(0, 90).toString('hex');
  assert.equal(new Set(views.map(corner)).size, backgrounds.length);
  for (const view of views) assert.ok(view.id.every((id, i) => id === views[0].id[i]));
});

for (const wireframe of [false, true]) {
  test(`the drive train shows through the body when it is selected${wireframe ? ', in wireframe too' : ''}`, () => {
    const options = ['--background', 'none', ...(wireframe ? ['--wireframe'] : [])];
    const set = [camera('Outside')];
    const { id } = node('Drive train');
    const before = draw({ set, options });
    const after = draw({ set, options: [...options, '--select', String(id)] });
    const others = [...nodes.values()].filter((part) => part.parent === 0 && part.id !== id && part.name !== 'Presentation');
    const alone = draw({ set: [...set, ...others.map((part) => setNode(part.id, { active: false })), setNode(FLOOR, { active: false })] });
    const train = idsBelow('Drive train');
    const { width, height } = alone;
    const near = (i, reach) => {
      for (let dy = -reach; dy <= reach; dy++)
        for (let dx = -reach; dx <= reach; dx++) {
          const [x, y] = [(i % width) + dx, Math.floor(i / width) + dy];
          if (x >= 0 && y >= 0 && x < width && y < height && train.has(alone.id[y * width + x])) return true;
        }
      return false;
    };
    let [changed, astray, inside] = [0, 0, 0];
    alone.id.forEach((part, i) => {
      const differs = !after.rgb.subarray(3 * i, 3 * i + 3).equals(before.rgb.subarray(3 * i, 3 * i + 3));
      inside += train.has(part);
      changed += differs && train.has(part);
      astray += differs && !near(i, 4);
    });
    assert.ok(inside > 500, `${inside} pixels`);
    assert.equal(astray, 0, `${astray} pixels beside it changed`);
    assert.ok(changed > (wireframe ? 0.1 : 0.9) * inside, `${changed} of ${inside} pixels changed`);
  });
}

test('no opening of a part is seen: with all its sides shown the car looks the same', () => {
  const both = changedCar(FINE, (text) => text.replaceAll('two-sided 0', 'two-sided 1'));
  const views = { ...SIGHTS };
  for (let degrees = 0; degrees < 360; degrees += 45)
    for (const y of [0.3, 1.2, 3]) {
      const [s, c] = [Math.sin((degrees * Math.PI) / 180), Math.cos((degrees * Math.PI) / 180)];
      views[`from ${degrees} degrees, ${y} m up`] = { eye: [5 * s, y, 5 * c], focus: [0, 0.7, 0], fov: 45 };
    }
  const seen = Object.entries(views).flatMap(([name, view]) => {
    const [once, twice] = [FINE, both].map((scene) => draw({ ...view, scene }));
    const { width, id } = twice;
    const differs = (i) => id[i] !== once.id[i];
    // A seam lets a line of pixels through; an opening more.
    const backs = id.filter((_, i) => [0, 1, -1, width, -width].every((d) => differs(i + d)));
    return backs.length > 0 ? [`${name}: ${census(backs).slice(0, 6).join(', ')}`] : [];
  });
  assert.deepEqual(seen, []);
});
