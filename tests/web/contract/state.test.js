// Contract: STATE.md, member by member, and what `patch` promises.
import assert from 'node:assert/strict';
import { after, describe, test } from 'node:test';
import { ContractClient } from './contract-client.js';
import { add, cross, dot, length, near, sub, unit } from './numbers.js';
import { schemaTest } from './schema.js';
import { Server } from './server.js';
import { holder, POSE, steering } from './stage.js';

const server = await Server.start();
after(() => server.stop());

const at = (object, path) => path.split('/').reduce((value, member) => value?.[member], object);
const within = (path, value) => path.split('/').reduceRight((inner, member) => ({ [member]: inner }), value);

const COLOR = {
  good: [[0, 0, 0, 0], [1, 1, 1, 1], [0.1, 0.2, 0.3, 1]],
  range: [[-0.001, 0, 0, 1], [0, 0, 0, 1.001], [0, 0, 0], [0, 0, 0, 1, 1], []],
  type: [1, 'red', {}, true, [0, 0, '0', 1]],
};
const VECTOR = { range: [[1, 2], [1, 2, 3, 4], []], type: [1, 'x', {}, true, [1, 2, '3'], [1, 2, null]] };
const FLAG = { good: [true, false], type: [0, 'true', [], {}] };
const LIGHT_COLOR = { ...COLOR, good: [...COLOR.good, [1.08, 40, 1e30, 1]], range: [[-0.1, 0, 0, 1], [2e30, 0, 0, 1], [1, 1, 1]] };
const ATTENUATION = { good: [[1, 0, 0], [0, 0, 0], [0.5, 0.25, 0.125]], range: [[-0.1, 0, 0], [1, 0, -0.1], [1, 0]], type: [1, 'x', {}, [1, 0, '0']] };
const SPEED = { good: [0.01, 100, 2.5], range: [0.0099, 100.1, 0, -1], type: ['1', [1], {}, true] };

/** Every member that clients write: values that are kept as they are, values refused. */
const WRITABLE = {
  'camera/eye': { good: [[3, 1, 7], [0.1 + 0.2, 1e-12, 7.000000000000001]], ...VECTOR },
  'camera/focus': { good: [[1, 0, 0], [1 / 3, 0.1, -2 / 3]], ...VECTOR },
  'camera/center': { good: [[5, 5, 5], [1e-300, -1 / 7, 1e9]], ...VECTOR },
  'camera/up': { range: [...VECTOR.range, [0, 0, 0], [0, 0, 1], [0, 0, -2]], type: VECTOR.type },
  'camera/fov': { good: [1, 170, 33.3333333333333357], range: [0.999, 170.001, 0, -40], type: ['40', [40], {}, true] },
  'navigation/style': { good: ['vrut', 'maya', 'catia', 'cinema4d'], range: ['blender', '', 'VRUT'], type: [1, [], {}, true] },
  'navigation/keepUpright': FLAG,
  'navigation/turnAbout': { good: ['touched', 'center'], range: ['finger', ''], type: [1, [], {}, true] },
  'navigation/rotateSpeed': SPEED,
  'navigation/panSpeed': SPEED,
  'navigation/zoomSpeed': SPEED,
  'renderer/mode': { good: ['stylized', 'realistic'], range: ['sketch', ''], type: [1, [], {}, true] },
  'renderer/wireframe': FLAG,
  'renderer/showSelection': FLAG,
  'lights/active': { good: ['9', '10', 'headlight'], unknown: ['2', '999', 'torch', ''], type: [9, {}, []] },
  'lights/items/headlight/color': LIGHT_COLOR,
  'lights/items/headlight/attenuation': ATTENUATION,
  'lights/items/9/color': LIGHT_COLOR,
  'lights/items/10/attenuation': ATTENUATION,
  'backgrounds/active': { good: ['13', '17', 'color'], unknown: ['2', '999', 'sky', ''], type: [13, {}, []] },
  'backgrounds/color': COLOR,
  'backgrounds/items/13/color': COLOR,
  'selection/node': { good: [4, 0, 11], unknown: [999], range: [1.5], type: ['4', [4], {}, true] },
  'sectionBox/min': { good: [[-9, -9, -9]], range: [...VECTOR.range, [1e6, 0, 0]], type: VECTOR.type },
  'sectionBox/max': { good: [[9, 9, 9]], range: [...VECTOR.range, [0, -1e6, 0]], type: VECTOR.type },
  'sectionBox/on': FLAG,
  'sectionBox/caps': FLAG,
  'sectionBox/hatched': FLAG,
  'unit/metres': { good: [0.001, 1e-12, 1e12, 0.0254], range: [0, -1, 1.1e12], type: ['1', [], {}, true] },
  'unit/shown': { good: ['mm', 'cm', 'm', 'in'], range: ['km', ''], type: [1, [], {}, true] },
  'quality/preference': { good: [0, 1, 0.25], range: [-0.01, 1.01], type: ['1', [], {}, true] },
  'comfort/on': FLAG,
  'comfort/degreesPerSecond': { good: [10, 720, 30], range: [0, -45, 721], type: ['45', [], {}, true] },
  'comfort/degreesPerSecondSquared': { good: [10, 10000], range: [0, -1, 10001], type: ['180', [], {}, true] },
  'comfort/metresPerSecond': { good: [0.1, 100], range: [0, -2, 101], type: ['2', [], {}, true] },
  'comfort/metresPerSecondSquared': { good: [0.1, 1000], range: [0, -1, 1001], type: ['8', [], {}, true] },
  'quality/latencyTargetMs': { good: [100], range: [-1], type: ['100', [], {}, true] },
};
const READ_ONLY = [
  'scene', 'scene/name', 'scene/nodes', 'scene/bounds', 'scene/notices', 'camera/name', 'camera/near', 'camera/far', 'cameras', 'cameras/11/name',
  'renderer/solid', 'renderer/transparent', 'renderer/reflective', 'lights/items/9/name', 'lights/items/9/type', 'materials', 'materials/1/name',
  'backgrounds/items/13/name', 'selection/name', 'selection/path', 'control', 'control/holder', 'control/kept', 'control/absent', 'control/asking', 'clients', 'recording', 'measured', 'walls',
];
const UNKNOWN = [
  'weather', 'camera/roll', 'navigation/speed', 'renderer/shadow', 'lights/ambient', 'lights/items/9/angle', 'backgrounds/image',
  'backgrounds/items/13/alpha', 'selection/nodes', 'nodes/4/name', 'quality/speed',
];

test('the document has every member that the contract names, and no null', async (t) => {
  const { state } = await ContractClient.join(t, server, { role: 'view' });
  assert.equal(JSON.stringify(state).includes('null'), false);
  const present = [
    ...Object.keys(WRITABLE).filter((path) => path !== 'selection/node'),
    ...READ_ONLY.filter((path) => !['selection/name', 'selection/path', 'control/holder', 'recording', 'walls'].includes(path)),
    'nodes', 'markers', 'views', 'sections', 'measures', 'selection', 'camera/node',
  ];
  assert.deepEqual(present.filter((path) => at(state, path) === undefined), []);
});

test('scene, cameras, materials, lights and backgrounds tell what the file holds', async (t) => {
  const { state } = await ContractClient.join(t, server, { role: 'view' });
  const { scene } = state;
  assert.equal(scene.name, 'stage');
  assert.deepEqual([scene.nodes, scene.materials, scene.geometries], [18, 4, 1]);
  near(scene.bounds.min, [-2, -2, -1], 'bounds.min');
  near(scene.bounds.max, [2, 2, 1], 'bounds.max');
  assert.ok(Array.isArray(scene.notices));
  assert.deepEqual(state.cameras, { 11: { name: 'Presenter' }, 12: { name: 'Passenger' } });
  assert.deepEqual(state.materials, { 1: { name: 'Wall paint' }, 2: { name: 'Door paint' }, 3: { name: 'Glass' }, 4: { name: 'Evening' } });
  assert.equal(state.lights.active, 'headlight');
  assert.deepEqual(Object.keys(state.lights.items).sort(), ['10', '9', 'headlight']);
  const { name, type, color, attenuation } = state.lights.items[9];
  assert.deepEqual([name, type, color, attenuation], ['Lamp', 'point', [1, 0.9, 0.8, 1], [1, 0, 0]]);
  assert.equal(state.lights.items[10].type, 'spot');
  assert.deepEqual(state.lights.items[10].attenuation, [0, 0.1, 0]);
  assert.deepEqual(state.lights.items.headlight.color.slice(0, 3), [1, 1, 1]);
  assert.deepEqual(state.lights.items.headlight.attenuation, [1, 0, 0]);
  assert.equal(state.backgrounds.active, '13', 'the first one by id in an active subtree');
  near(state.backgrounds.color.slice(0, 3), [230 / 255, 235 / 255, 242 / 255], 'the plain colour');
  assert.deepEqual(Object.keys(state.backgrounds.items), ['13', '17']);
  assert.equal(state.backgrounds.items[13].name, 'Studio');
  near(state.backgrounds.items[13].color.slice(0, 3), [0.1, 0.2, 0.3], 'the diffuse rgb of its material');
  assert.deepEqual(state.nodes, {});
  assert.deepEqual(state.markers, {});
  assert.deepEqual(Object.keys(state.views), ['home']);
  assert.equal(state.selection.node, undefined);
  assert.equal(state.recording, undefined);
  assert.equal(typeof state.control.kept, 'boolean');
});

test('renderer counts geometry nodes: 1 of 7 is transparent, none reflective', async (t) => {
  const { state } = await ContractClient.join(t, server, { role: 'view' });
  assert.equal(state.renderer.transparent, 1);
  assert.equal(state.renderer.reflective, 0);
  assert.equal(state.renderer.solid, 6);
});

test('the camera at the start is that of the first camera node', async (t) => {
  const fresh = await Server.start();
  t.after(() => fresh.stop());
  const { camera } = (await ContractClient.join(t, fresh, { role: 'view' })).state;
  assert.deepEqual([camera.node, camera.name, camera.eye, camera.focus, camera.up, camera.fov], [11, 'Presenter', [0, 0, 8], [0, 0, 0], [0, 1, 0], 40]);
  assert.ok(camera.near > 0 && camera.near < 7 && camera.far >= 9, `${camera.near} to ${camera.far}`);
});

describe('measures', () => {
  const point = (node, ...points) => ({ node, snap: 'point', points });
  const edge = (node, x) => ({ node, snap: 'edge', points: [[x, 0, 0], [x, -0.5, 0], [x, 0.5, 0]] });
  const cleared = async (t) => {
    const client = await steering(t, server);
    await client.patch({ measures: null, nodes: null, unit: null });
    return client;
  };

  test('a measure tells its value, components and line, and moves with its parts', async (t) => {
    const client = await cleared(t);
    const picks = [point(4, [-0.5, 0, 0]), point(2, [0, 0.5, 0])];  // the door and the wall, 4 times as large
    await client.patch({ measures: { Gap: { kind: 'distance', picks } } });
    assert.deepEqual(client.state.measures, { Gap: { kind: 'distance', picks } });
    const { value, components, line } = client.state.measured.Gap;
    near(value, Math.hypot(0.5, 2, 1), 'the distance');
    near(components, [-0.5, 2, -1], 'from the first to the second');
    near(line[0], [0.5, 0, 0], 'where it begins');
    const before = client.state.nodes;
    await client.patch({ nodes: { 4: { matrix: [1, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1, -1, 0, 0, 0, 1] } } });
    near(client.state.measured.Gap.components[2], 0, 'the door is in the wall\'s plane');
    await client.patch({ nodes: { 4: { active: false } } });
    assert.deepEqual([client.state.measured.Gap.line, typeof client.state.measured.Gap.value], [[], 'number'], 'a hidden part');
    await client.patch({ nodes: null });
    assert.deepEqual(client.state.nodes, before);
    assert.deepEqual(client.state.measured.Gap, { value, components, line });
    await client.patch({ measures: { Gap: null } });
    assert.deepEqual([client.state.measures, client.state.measured], [{}, {}]);
  });

  test('each kind, as closed forms have it', async (t) => {
    const client = await cleared(t);
    const loop = { node: 4, snap: 'loop', points: [[0.5, 0, 0], [0.5, -0.5, 0], [0.5, 0.5, 0]] };
    const [a, b, c] = [point(4, [1, 0, 0]), point(4, [0, 1, 0]), point(4, [-1, 0, 0])];
    for (const [kind, picks, value] of [
      ['parallel', [edge(4, 0.5), edge(4, -0.5)], 1],
      ['parallel', [edge(4, 0.5), c], 1.5],
      ['angle', [a, b, c], 90],
      ['angle', [edge(4, 0.5), edge(2, 0.5)], 0],
      ['radius', [a, b, c], 1],
      ['length', [edge(4, 0.5)], 1],
      ['length', [loop], 4],
    ]) {
      await client.patch({ measures: { One: { kind, picks } } });
      near(client.state.measured.One.value, value, `${kind}: ${JSON.stringify(client.state.measured.One)}`);
    }
    await client.patch({ measures: null });
  });

  test('what cannot be measured is refused and changes nothing; what no longer can tells why', async (t) => {
    const client = await cleared(t);
    await client.patch({ measures: { Gap: { kind: 'parallel', picks: [edge(4, 0.5), edge(4, -0.5)] } } });
    const before = JSON.stringify(client.state);
    const refused = (measure, code, valid = true) =>
      client.refused({ type: 'patch', patch: { measures: { New: measure } } }, code, { valid });
    assert.match((await refused({ picks: [point(4, [0, 0, 0])] }, 'out-of-range')).message, /2 picks, not 1/);
    assert.match((await refused({ picks: [point(999, [0, 0, 0]), point(4, [0, 0, 0])] }, 'unknown-node')).message, /'measures.New'.*999/);
    await refused({ kind: 'radius', picks: [edge(4, 0.5)] }, 'out-of-range');
    await refused({ kind: 'length', picks: [{ node: 4, snap: 'edge', points: [[0, 0, 0]] }] }, 'out-of-range');
    await refused({ kind: 'volume', picks: [point(4, [0, 0, 0])] }, 'out-of-range', false);
    await refused({ kind: 'angle' }, 'bad-message');
    assert.equal(JSON.stringify(client.state), before);
    await client.patch({ measures: { Gap: { picks: [edge(4, 0.5), { ...edge(4, -0.5), points: [[-0.5, 0, 0], [-0.5, 0, 0], [0.5, 0.1, 0]] }] } } });
    assert.equal(client.state.measured.Gap.value, undefined);
    assert.match(client.state.measured.Gap.problem, /not parallel.*degrees/);
    await client.patch({ measures: null });
  });
});

describe('sections', () => {
  const cleared = async (t) => {
    const client = await steering(t, server);
    await client.patch({ sections: null, sectionBox: null });
    return client;
  };

  test('a plane comes with what it needs, has a unit normal, and goes', async (t) => {
    const client = await cleared(t);
    await client.patch({ sections: { Cut: { normal: [3, 0, 4], distance: 0.5 } } });
    assert.deepEqual(client.state.sections, { Cut: { normal: [0.6, 0, 0.8], distance: 0.5, on: true, caps: true, hatched: false } });
    await client.patch({ sections: { Cut: { on: false, caps: false, hatched: true, distance: -1 / 3 } } });
    assert.deepEqual(client.state.sections.Cut, { normal: [0.6, 0, 0.8], distance: -1 / 3, on: false, caps: false, hatched: true });
    await client.patch({ sections: { Cut: null } });
    assert.deepEqual(client.state.sections, {});
  });

  test('what cannot be is refused, and changes nothing', async (t) => {
    const client = await cleared(t);
    const six = Object.fromEntries([1, 2, 3, 4, 5, 6].map((i) => [`Cut ${i}`, { normal: [i, 0, 0] }]));
    await client.patch({ sections: six });
    const before = JSON.stringify(client.state);
    for (const [section, code, valid] of [
      [{ normal: [0, 0, 0] }, 'out-of-range', true], [{ normal: [0, 1] }, 'out-of-range', false], [{ normal: 'up' }, 'bad-message', false],
      [{ distance: 2e30 }, 'out-of-range', false], [{ on: 1 }, 'bad-message', false], [{ colour: 'red' }, 'unknown-member', false],
    ])
      await client.refused({ type: 'patch', patch: { sections: { 'Cut 1': section } } }, code, { valid });
    await client.refused({ type: 'patch', patch: { sections: { 'Cut 7': { normal: [0, 0, 1] } } } }, 'too-many', { valid: true });
    await client.refused({ type: 'patch', patch: { sections: { 'Cut 1': null, New: { distance: 1 } } } }, 'bad-message', { valid: true });
    await client.refused({ type: 'patch', patch: { sectionBox: { min: [1e6, 0, 0] } } }, 'out-of-range', { valid: true });
    assert.equal(JSON.stringify(client.state), before);
    await client.patch({ sections: null });
  });

  test('picks meet what a section leaves', async (t) => {
    const client = await cleared(t);
    const pick = () => client.ask({ type: 'pick', x: 256, y: 150 });
    const whole = await pick();
    assert.ok(whole.point);
    await client.patch({ sections: { Cut: { normal: [0, 0, 1], distance: whole.point[2] - 1e-3 } } });
    const cut = await pick();
    assert.ok(!cut.point || cut.point[2] < whole.point[2] - 0.9e-3, `${cut.point}`);
    await client.patch({ sections: { Cut: { on: false } } });
    assert.deepEqual((await pick()).point, whole.point);
    await client.patch({ sections: null });
  });

  test('the box cuts as six planes do', async (t) => {
    const client = await cleared(t);
    const { point } = await client.ask({ type: 'pick', x: 256, y: 150 });
    const around = (size) => ({ min: point.map((x) => x - size), max: point.map((x) => x + size), on: true });
    await client.patch({ sectionBox: around(0.01) });
    assert.deepEqual((await client.ask({ type: 'pick', x: 256, y: 150 })).point, point);
    await client.patch({ sectionBox: { min: point.map((x) => x + 50), max: point.map((x) => x + 51) } });
    assert.equal((await client.ask({ type: 'pick', x: 256, y: 150 })).point, undefined);
    await client.patch({ sectionBox: null });
  });
});

describe('writable members', () => {
  for (const [path, { good = [], range = [], unknown = [], type = [] }] of Object.entries(WRITABLE)) {
    test(`${path}: kept as sent, read by everyone, null gives the start`, async (t) => {
      const client = await holder(t, server);
      const watcher = await ContractClient.join(t, server, { role: 'view' });
      if (path.startsWith('camera/')) await client.patch({ camera: POSE });
      const start = at(client.state, path);
      for (const value of good) {
        const { revision } = await client.patch(within(path, value));
        assert.deepEqual(at(client.state, path), value, 'kept to the bit');
        assert.equal(revision, client.revision);
        await watcher.until('the patch at a watcher', () => watcher.revision >= revision);
        assert.deepEqual(at(watcher.state, path), value);
      }
      if (path.startsWith('camera/')) return client.patch({ camera: POSE });
      await client.patch(within(path, null));
      assert.deepEqual(at(client.state, path), start);
      return undefined;
    });

    test(`${path}: what is refused, and changes nothing`, async (t) => {
      const client = await holder(t, server);
      await client.patch({ camera: POSE });
      const refuse = (values, code) => values.reduce((before, value) => before.then(() => client.refused({ type: 'patch', patch: within(path, value) }, code)), Promise.resolve());
      await refuse(range, 'out-of-range');
      await refuse(unknown, 'unknown-node');
      await refuse(type, 'bad-message');
    });
  }

  test('null for a whole part gives all of its members back', async (t) => {
    const client = await holder(t, server);
    const start = client.state;
    await client.patch({ navigation: { panSpeed: 3, zoomSpeed: 4, keepUpright: !start.navigation.keepUpright } });
    await client.patch({ navigation: null });
    assert.deepEqual(client.state.navigation, start.navigation);
    await client.patch({ lights: { active: '9', items: { 9: { color: [0, 0, 0, 1] } } } });
    await client.patch({ lights: { active: null, items: { 9: null } } });
    assert.deepEqual(client.state.lights, start.lights);
  });

  test('null for a camera member gives what it was at the start', async (t) => {
    const fresh = await Server.start();
    t.after(() => fresh.stop());
    const client = await ContractClient.join(t, fresh);
    const { camera } = client.state;
    await client.patch({ camera: { eye: [1, 2, 3], focus: [0, 1, 0], center: [1, 1, 1], fov: 77 } });
    await client.patch({ camera: { eye: null, focus: null, center: null, fov: null, up: null } });
    for (const member of ['eye', 'focus', 'center', 'fov', 'up']) assert.deepEqual(client.state.camera[member], camera[member], member);
  });
});

describe('what is not writable', () => {
  for (const path of READ_ONLY) {
    test(`${path} is read-only`, async (t) => {
      const client = await holder(t, server);
      for (const value of [null, 'x', 1]) await client.refused({ type: 'patch', patch: within(path, value) }, 'read-only');
    });
  }
  for (const path of UNKNOWN) {
    test(`${path} is unknown`, async (t) => {
      const client = await holder(t, server);
      const error = await client.refused({ type: 'patch', patch: within(path, 1) }, 'unknown-member');
      assert.ok(error.message.includes(path.split('/').at(-1)), error.message);
      await client.refused({ type: 'patch', patch: within(path, null) }, 'unknown-member');
    });
  }
  for (const path of ['lights/items/999/color', 'backgrounds/items/999/color', 'backgrounds/items/2/color', 'nodes/999/active', 'nodes/x/active']) {
    test(`${path} is an unknown node`, async (t) => {
      const client = await holder(t, server);
      await client.refused({ type: 'patch', patch: within(path, path.endsWith('color') ? [0, 0, 0, 1] : true) }, 'unknown-node');
    });
  }
  for (const part of ['camera', 'navigation', 'renderer', 'lights', 'lights/items/9', 'backgrounds', 'selection', 'nodes', 'nodes/4', 'markers', 'markers/A', 'views', 'views/A', 'quality']) {
    test(`${part} is an object`, async (t) => {
      const client = await holder(t, server);
      for (const value of [1, 'x', [], true]) await client.refused({ type: 'patch', patch: within(part, value) }, 'bad-message');
    });
  }
});

describe('camera', () => {
  test('up is made orthogonal to the view and unit', async (t) => {
    const client = await holder(t, server);
    await client.patch({ camera: { ...POSE, up: [3, 4, 5] } });
    near(client.state.camera.up, [0.6, 0.8, 0], 'up');
    await client.patch({ camera: { ...POSE, eye: [4, 3, 2], up: [0, 7, 0] } });
    const { eye, focus, up } = client.state.camera;
    const view = unit(sub(focus, eye));
    near(length(up), 1, 'its length');
    near(dot(up, view), 0, 'up along the view');
    near(dot(cross(view, [0, 1, 0]), up), 0, 'in the plane of what was asked for');
    assert.ok(up[1] > 0);
  });

  test('an eye nearer to the focus than 1e-9 of the radius is refused', async (t) => {
    const client = await holder(t, server);
    await client.patch({ camera: POSE });
    await client.refused({ type: 'patch', patch: { camera: { eye: [0, 0, 0] } } }, 'out-of-range');
    await client.refused({ type: 'patch', patch: { camera: { eye: [0, 0, 2e-9] } } }, 'out-of-range'); // radius 3, so 3e-9
    await client.patch({ camera: { eye: [0, 0, 1e-8] } });
    await client.patch({ camera: POSE });
  });

  test('node moves the view there, also under a moved part', async (t) => {
    const client = await holder(t, server);
    await client.patch({ camera: { node: 12 } });
    const { camera } = client.state;
    assert.deepEqual([camera.node, camera.name, camera.fov], [12, 'Passenger', 50]);
    near(camera.eye, [1, 0, 5], 'eye');
    near(camera.focus, [1, 0, 0], 'focus');
    for (const node of [999, 2]) await client.refused({ type: 'patch', patch: { camera: { node } } }, 'unknown-node');
    await client.refused({ type: 'patch', patch: { camera: { node: '12' } } }, 'bad-message');
    await client.refused({ type: 'patch', patch: { camera: { node: 1.5 } } }, 'out-of-range');
    await client.patch({ camera: { node: 11 } });
    assert.deepEqual(client.state.camera.eye, [0, 0, 8]);
  });
});

describe('selection', () => {
  test('node is there with its name and path, until null', async (t) => {
    const client = await holder(t, server);
    await client.patch({ selection: { node: 4 } });
    const { node, name, path } = client.state.selection;
    assert.deepEqual([node, name], [4, 'Door']);
    assert.deepEqual(path.slice(-3), ['House', 'Hinge', 'Door']);
    await client.patch({ selection: { node: null } });
    assert.deepEqual(client.state.selection, {});
  });
});

describe('nodes', () => {
  const MOVED = [1, 0, 0, 0.5, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1];

  test('only what differs from the file is there', async (t) => {
    const client = await holder(t, server);
    await client.patch({ nodes: { 3: { matrix: MOVED }, 4: { active: false, material: 1 }, 6: { activeChild: 1 } } });
    assert.deepEqual(client.state.nodes, { 3: { matrix: MOVED }, 4: { active: false, material: 1 }, 6: { activeChild: 1 } });
    await client.patch({ nodes: { 4: { active: true } } }); // the file's
    assert.deepEqual(client.state.nodes[4], { material: 1 });
    await client.patch({ nodes: { 4: { material: null }, 6: { activeChild: null } } });
    assert.deepEqual(client.state.nodes, { 3: { matrix: MOVED } });
    await client.patch({ nodes: { 3: null } });
    assert.deepEqual(client.state.nodes, {});
    const { revision } = client;
    await client.patch({ nodes: { 4: { active: true, material: 2 } } });
    assert.equal(client.revision, revision, 'nothing differs from the file, so nothing changed');
  });

  test('a switch takes each of its children, all (-2) and none (-1)', async (t) => {
    const client = await holder(t, server);
    for (const activeChild of [-2, -1, 1]) {
      await client.patch({ nodes: { 6: { activeChild } } });
      assert.equal(client.state.nodes[6].activeChild, activeChild);
    }
    for (const activeChild of [-3, 2, 0.5]) await client.refused({ type: 'patch', patch: { nodes: { 6: { activeChild } } } }, 'out-of-range');
    await client.patch({ nodes: null });
    assert.deepEqual(client.state.nodes, {});
  });

  test('refused: unknown materials, matrices of another length, wrong types', async (t) => {
    const client = await holder(t, server);
    const refused = (node, code) => client.refused({ type: 'patch', patch: { nodes: { 4: node } } }, code);
    await refused({ material: 999 }, 'unknown-node');
    await refused({ material: 1.5 }, 'out-of-range');
    await refused({ material: '1' }, 'bad-message');
    await refused({ active: 1 }, 'bad-message');
    await refused({ matrix: MOVED.slice(1) }, 'out-of-range');
    await refused({ matrix: [...MOVED.slice(1), '1'] }, 'bad-message');
    await refused({ matrix: 1 }, 'bad-message');
  });

  test('a moved part is where it is picked, an inactive one is not', async (t) => {
    const client = await steering(t, server);
    const door = { type: 'pick', x: 256, y: 150 };
    assert.equal((await client.ask(door)).node, 4);
    await client.patch({ nodes: { 4: { active: false } } });
    assert.equal((await client.ask(door)).node, 2, 'the wall behind it');
    const away = [...MOVED];
    away[3] = 30;
    await client.patch({ nodes: { 4: null, 3: { matrix: away } } });
    assert.equal((await client.ask(door)).node, 2);
    await client.patch({ nodes: null });
    assert.equal((await client.ask(door)).node, 4);
  });
});

describe('markers', () => {
  test('are made, moved, tied to a node, and removed by null', async (t) => {
    const client = await holder(t, server);
    const place = ({ point, node, text }) => (node === undefined ? { point, text } : { point, node, text });
    await client.patch({ markers: { Bolt: { point: [1, 2, 0.1 + 0.2], text: 'M6, 9 Nm' } } });
    assert.deepEqual(Object.keys(client.state.markers), ['Bolt']);
    assert.deepEqual(place(client.state.markers.Bolt), { point: [1, 2, 0.1 + 0.2], text: 'M6, 9 Nm' });
    await client.patch({ markers: { Bolt: { node: 4, point: [0, 0, 0] }, Nut: { point: [0, 1, 0], text: '' } } });
    assert.deepEqual(place(client.state.markers.Bolt), { point: [0, 0, 0], node: 4, text: 'M6, 9 Nm' });
    await client.patch({ markers: { Bolt: { node: null } } });
    assert.equal(client.state.markers.Bolt.node, undefined);
    await client.patch({ markers: { Bolt: null } });
    assert.deepEqual(Object.keys(client.state.markers), ['Nut']);
    await client.patch({ markers: null });
    assert.deepEqual(client.state.markers, {});
  });

  test('refused: no point, unknown nodes, wrong types', async (t) => {
    const client = await holder(t, server);
    const refused = (marker, code) => client.refused({ type: 'patch', patch: { markers: { M: marker } } }, code);
    await refused({ text: 'where?' }, 'bad-message'); // a missing member
    await refused({ point: [0, 0, 0], text: '', size: 3 }, 'unknown-member');
    await refused({ point: [1, 2], text: '' }, 'out-of-range');
    await refused({ point: '0 0 0', text: '' }, 'bad-message');
    await refused({ point: [0, 0, 0], text: 7 }, 'bad-message');
    await refused({ point: [0, 0, 0], text: '', node: 999 }, 'unknown-node');
    await refused({ point: [0, 0, 0], text: '', node: '4' }, 'bad-message');
    await refused({ point: [0, 0, 0], author: 7 }, 'bad-message');
    await refused({ point: [0, 0, 0], author: 'x'.repeat(101) }, 'out-of-range');
    await refused({ point: [0, 0, 0], time: -1 }, 'out-of-range');
    await refused({ point: [0, 0, 0], done: 1 }, 'bad-message');
    await refused({ point: [0, 0, 0], view: { fov: 40 } }, 'bad-message');
    await refused({ point: [0, 0, 0], view: { ...POSE, eye: POSE.focus } }, 'out-of-range');
  });
});

describe('views', () => {
  const VIEW = { eye: [0, 0, 5], focus: [0, 1, 0], up: [0, 1, 0], center: [0, 0, 1], fov: 30 };

  test('are kept, changed member by member, and removed by null', async (t) => {
    const client = await holder(t, server);
    await client.patch({ views: { Front: VIEW } });
    for (const member of ['eye', 'focus', 'center', 'fov']) assert.deepEqual(client.state.views.Front[member], VIEW[member]);
    await client.patch({ views: { Front: { fov: 31 } } });
    assert.equal(client.state.views.Front.fov, 31);
    assert.deepEqual(client.state.views.Front.eye, VIEW.eye);
    await client.patch({ views: { Front: { order: -1.5, eye: [1, 0, 5] } } });
    assert.equal(client.state.views.Front.order, -1.5);
    await client.patch({ views: { Front: { order: null } } });
    assert.equal(client.state.views.Front.order, undefined);
    assert.deepEqual(client.state.views.Front.eye, [1, 0, 5]);
    await client.patch({ views: { Front: null } });
    assert.equal(client.state.views.Front, undefined);
    assert.ok(client.state.views.home, 'home is still there');
  });

  test('one can be laid over the camera as it is', async (t) => {
    const client = await holder(t, server);
    await client.patch({ views: { Front: VIEW } });
    const { eye, focus, up, center, fov } = client.state.views.Front;
    await client.patch({ camera: { eye, focus, up, center, fov } });
    for (const member of ['eye', 'focus', 'center', 'fov']) assert.deepEqual(client.state.camera[member], VIEW[member]);
    await client.patch({ views: { Front: null }, camera: POSE });
  });

  test('refused: what a camera would refuse', async (t) => {
    const client = await holder(t, server);
    const refused = (view, code) => client.refused({ type: 'patch', patch: { views: { V: view } } }, code);
    await refused({ ...VIEW, fov: 171 }, 'out-of-range');
    await refused({ ...VIEW, size: 3 }, 'unknown-member');
    await refused({ ...VIEW, eye: VIEW.focus }, 'out-of-range');
    await refused({ ...VIEW, up: [0, 0, 0] }, 'out-of-range');
    await refused({ ...VIEW, eye: 'home' }, 'bad-message');
  });
});

describe('patch', () => {
  test('is all or nothing', async (t) => {
    const client = await holder(t, server);
    const error = await client.refused({ type: 'patch', patch: { camera: { fov: 55 }, navigation: { panSpeed: 1000 } } }, 'out-of-range');
    assert.match(error.message, /panSpeed/);
    await client.refused({ type: 'patch', patch: { navigation: { panSpeed: 2 }, weather: 'rain' } }, 'unknown-member');
    await client.refused({ type: 'patch', patch: { camera: { fov: 55 }, control: { kept: false } } }, 'read-only');
  });

  test('that changes nothing leaves the revision', async (t) => {
    const client = await holder(t, server);
    await client.patch({ navigation: { panSpeed: 2 } });
    const { revision } = client;
    assert.equal((await client.patch({ navigation: { panSpeed: 2 } })).revision, revision);
    assert.equal((await client.patch({})).revision, revision);
    assert.equal((await client.patch({ navigation: { panSpeed: null } })).revision > revision, true);
  });

  test('tells everyone whose doing it was', async (t) => {
    const client = await holder(t, server);
    const watcher = await ContractClient.join(t, server, { role: 'view' });
    const { revision } = await client.patch({ navigation: { panSpeed: 7 } });
    const patch = await watcher.texted('patch', (text) => text.revision === revision);
    assert.equal(patch.by, client.id);
    assert.deepEqual(patch.patch, { navigation: { panSpeed: 7 } });
    await client.patch({ navigation: null });
    await watcher.until('the second', () => watcher.revision === client.revision);
    assert.deepEqual(watcher.state, client.state);
  });

  test('ifRevision refuses when a touched member has changed since, and only then', async (t) => {
    const client = await holder(t, server);
    const { revision } = await client.patch({ navigation: { panSpeed: 2 } });
    const then = (patch, ifRevision = revision) => ({ type: 'patch', patch, ifRevision });
    await client.ask(then({ navigation: { rotateSpeed: 2 } }));
    await client.ask(then({ navigation: { panSpeed: 3 } })); // rotateSpeed is another member
    await client.refused(then({ navigation: { panSpeed: 4 } }), 'stale-revision', { valid: true });
    await client.refused(then({ navigation: { zoomSpeed: 4, rotateSpeed: 4 } }), 'stale-revision', { valid: true });
    await client.refused(then({ navigation: null }), 'stale-revision', { valid: true });
    await client.ask(then({ navigation: { panSpeed: 4 } }, client.revision));
    await client.ask(then({ navigation: { zoomSpeed: 4 } }));
    await client.patch({ navigation: null });
  });

  test('ifRevision sees what a drag has changed', async (t) => {
    const client = await steering(t, server);
    const { revision } = client;
    await client.input.drag([[200, 150], [220, 150], [260, 150]]);
    assert.ok(client.revision > revision);
    await client.refused({ type: 'patch', patch: { camera: { eye: [0, 0, 8] } }, ifRevision: revision }, 'stale-revision', { valid: true });
    await client.ask({ type: 'patch', patch: { camera: { fov: 41 } }, ifRevision: revision });
  });

  test('numbers read back the same', async (t) => {
    const client = await holder(t, server);
    const center = [Number.MIN_VALUE, 0.1, Number.MAX_SAFE_INTEGER];
    await client.patch({ camera: { center } });
    assert.deepEqual(client.state.camera.center, center);
    const sum = add([0.1, 0.2, 0.3], [0.7, 0.1, 0.6]);
    await client.patch({ camera: { center: sum } });
    assert.deepEqual(client.state.camera.center, sum);
  });
});

schemaTest(server);
