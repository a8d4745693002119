import assert from 'node:assert/strict';
import { afterEach, describe, test } from 'node:test';
import { setLanguage } from '../../../web-client/base/texts.js';
import {
  bytesWords, hostLines, hostWords, pictureFacts, qualityWords,
} from '../../../web-client/panels/dialogs/connection-sections.js';
import {
  backgroundChoice, backgroundFacts, cameraFacts, lightChoice, lightFacts, rendererFacts,
} from '../../../web-client/panels/dialogs/scene-sections.js';
import { holderWords, snapshotName, snapshotSize } from '../../../web-client/panels/presentation-section.js';
import { section } from '../../../web-client/panels/section.js';
import {
  cameraEntries, lookingAt, middleOf, movedView, placeOf, viewNames,
} from '../../../web-client/panels/views-section.js';

afterEach(() => setLanguage('en'));

test('a section shows anew only the controls of which something is another', () => {
  const shown = [];
  const control = (name) => ({ element: name, show: (...values) => shown.push([name, ...values]) });
  const { content, show } = section('light', 'Light',
    [control('mode'), (state) => [state.mode]],
    [control('facts'), (state, { stats }) => [state.solid, stats?.ms], (solid, ms) => [{ solid, time: `${ms} ms` }]]);
  assert.deepEqual(content, ['mode', 'facts']);
  show({ state: { mode: 'a', solid: 1 }, stats: { ms: 2 } });
  assert.deepEqual(shown.splice(0), [['mode', 'a'], ['facts', { solid: 1, time: '2 ms' }]]);
  show({ state: { mode: 'a', solid: 1 }, stats: { ms: 3 } });
  assert.deepEqual(shown.splice(0), [['facts', { solid: 1, time: '3 ms' }]]);
  show({ state: { mode: 'b', solid: 1 }, stats: { ms: 3 } });
  assert.deepEqual(shown, [['mode', 'b']]);
});

describe('the scene', () => {
  test('the renderer\'s counts, and its time once it is measured', () => {
    assert.deepEqual(rendererFacts({ solid: 7 }, undefined), [{ solid: 7, time: undefined }]);
    assert.deepEqual(rendererFacts({ solid: 7 }, 4.26), [{ solid: 7, time: '4.3\u00a0ms' }]);
  });

  test('the camera: its name and the size of its near plane', () => {
    const [free] = cameraFacts(undefined, undefined, 0.5, 100, 90, 1000, 500);
    assert.deepEqual(free, { name: 'Free', id: undefined, near: 0.5, far: 100, plane: '2 × 1' });
    const [named] = cameraFacts('Driver', 0, 0.5, 100, 90);
    assert.deepEqual(named, { name: 'Driver', id: '0', near: 0.5, far: 100, plane: undefined });
  });

  test('lights: the headlight is the first and has no id', () => {
    const items = { 9: { name: 'Lamp 10', type: 'spot' }, 8: { name: 'Lamp 9', type: 'point' }, headlight: { name: '', type: 'headlight' } };
    assert.deepEqual(lightChoice({ active: '9', items }), ['9', [['headlight', 'Headlight'], ['8', 'Lamp 9'], ['9', 'Lamp 10']]]);
    assert.deepEqual(lightFacts({ active: '9', items }), [{ name: 'Lamp 10', id: '9', type: 'Spot' }]);
    assert.deepEqual(lightFacts({ active: 'headlight', items }), [{ name: 'Headlight', type: 'Headlight' }]);
  });

  test('backgrounds: the plain one is the first', () => {
    const items = { 4: { name: 'Studio', texture: 'studio.png', color: [1, 1, 1, 1] } };
    assert.deepEqual(backgroundChoice({ active: '4', items }), ['4', [['color', 'Plain color'], ['4', 'Studio']]]);
    assert.deepEqual(backgroundFacts({ active: '4', items }), [{ ...items[4], id: '4' }]);
    assert.deepEqual(backgroundFacts({ active: 'color', items }), [{ name: 'Plain color' }]);
  });
});

describe('views', () => {
  test('the camera in use is marked, and one without a name is called by its number', () => {
    const entries = cameraEntries({ 3: { name: 'Front' }, 5: { name: '' } }, 5);
    assert.deepEqual(entries, [['3', { text: 'Front', used: false }], ['5', { text: '#5', used: true }]]);
  });

  test('a look at a place keeps direction and distance', () => {
    const before = { eye: [1, 2, 3], focus: [1, 2, -7], up: [0, 1, 0], fov: 90 };
    const view = { width: 400, height: 200 };
    const camera = lookingAt(before, [5, 0, 0.1], { x: 200, y: 100 }, view);
    assert.deepEqual(camera.focus, [5, 0, 0.1]);
    assert.deepEqual(camera.center, [5, 0, 0.1]);
    assert.deepEqual(camera.eye, [5, 0, 3 + (0.1 - -7)]);
    // Right of the middle and above it: the camera goes left and down, by the height of 20 that it sees there.
    const aside = lookingAt(before, [5, 0, 0.1], { x: 250, y: 80 }, view);
    assert.deepEqual(aside.focus.map((x) => Math.round(x * 1e9) / 1e9), [0, -2, 0.1]);
    assert.deepEqual(aside.center, [5, 0, 0.1]);
  });

  test('the middle of a view is that of what is free of it', () => {
    const view = { width: 1000, height: 800 };
    assert.deepEqual(middleOf(view, { top: 0, right: 0, bottom: 0, left: 0 }), { x: 500, y: 400 });
    assert.deepEqual(middleOf(view, { top: 20, right: 400, bottom: 120, left: 0 }), { x: 300, y: 350 });
  });

  test('a note goes with its part where the server tells the place in the part\'s space', () => {
    const picked = { node: 7, name: 'Door', point: [1, 2, 3], normal: [0, 0, 1], distance: 4 };
    assert.deepEqual(placeOf(picked), { point: [1, 2, 3] });
    assert.deepEqual(placeOf({ ...picked, local: [0.5, 0, 0] }), { node: 7, point: [0.5, 0, 0] });
  });

  test('views stand by their order, those without one last and by name', () => {
    const views = { home: { order: 0 }, B: {}, A: {}, 'View 10': { order: 1 }, 'View 9': { order: 1 }, C: { order: -2.5 } };
    assert.deepEqual(viewNames(views), ['C', 'View 9', 'View 10', 'A', 'B']);
  });

  test('a view changes places with its neighbour, and no more changes than has to', () => {
    const views = { home: {}, A: {}, B: {}, C: {} };
    assert.deepEqual(movedView(views, 'B', -1), { B: { order: 0 }, A: { order: 1 }, C: { order: 2 } });
    const ordered = { home: {}, B: { order: 0 }, A: { order: 1 }, C: { order: 2 } };
    assert.deepEqual(movedView(ordered, 'A', 1), { C: { order: 1 }, A: { order: 2 } });
    assert.equal(movedView(ordered, 'B', -1), null);
    assert.equal(movedView(ordered, 'C', 1), null);
  });
});

describe('connection', () => {
  test('each wall with how far it is', () => {
    assert.deepEqual(hostLines(undefined, 9), []);
    assert.deepEqual(hostLines({ h1: { name: '', revision: 9 }, h2: { name: 'Wall', revision: 8 } }, 9),
      [{ name: 'Client h1', words: 'up to date' }, { name: 'Wall', words: '1 behind' }]);
  });

  test('how pictures come; no latency before the first', () => {
    assert.deepEqual(pictureFacts({ framesPerSecond: 12.34, bytesPerSecond: 1.5e6 }),
      { latency: undefined, frames: '12.3', data: '1.5\u00a0MB/s' });
    assert.equal(pictureFacts({ p50: 20.4, p95: 80, framesPerSecond: 0, bytesPerSecond: 0 }).latency, '20\u00a0ms, 80\u00a0ms');
  });

  test('who steers', async () => {
    assert.equal(holderWords(undefined, 'c1'), 'Nobody');
    assert.equal(holderWords({ kept: false }, 'c1'), 'Nobody');
    assert.equal(holderWords({ holder: 'c1', kept: true, name: 'Eva' }, 'c1'), 'You');
    assert.equal(holderWords({ holder: 'c2', name: 'Eva\'s tablet' }, 'c1'), 'Eva\'s tablet');
    assert.equal(holderWords({ holder: 'c2' }, 'c1'), 'Client c2');
    await setLanguage('cs');
    assert.equal(holderWords({ holder: 'c2' }, 'c1'), 'Klient c2');
    assert.equal(holderWords({ holder: 'c1', kept: false }, 'c1'), 'vy');
  });

  test('how far behind a wall is', async () => {
    assert.equal(hostWords({ revision: 9, lagMs: 12.4 }, 9), 'up to date · 12\u00a0ms');
    assert.equal(hostWords({ revision: 5 }, 9), '4 behind');
    assert.equal(hostWords({ revision: 10 }, 9), 'up to date');
    await setLanguage('cs');
    assert.equal(hostWords({ revision: 5 }, 9), 'pozadu o 4 změny');
  });

  test('which kind of picture it is', async () => {
    const still = { level: 'still', scale: 1, samples: 16, detail: 0, jpegQuality: 95 };
    assert.equal(qualityWords(still), 'Still · 16 samples · full size · JPEG 95');
    assert.equal(qualityWords({ ...still, error: 0 }), 'Still · 16 samples · full size · JPEG 95 · error 0');
    assert.match(qualityWords({ ...still, error: 0.0004 }), / · error < 0\.001$/);
    const moving = { level: 'moving', scale: 0.67, samples: 1, detail: 0.5, jpegQuality: 70, error: 0.0314 };
    assert.equal(qualityWords(moving), 'Moving · 67 % size · detail 0.5 px · JPEG 70 · error 0.031');
    await setLanguage('cs');
    assert.equal(qualityWords(still), 'V klidu · 16 vzorků · plná velikost · JPEG 95');
    assert.equal(qualityWords(moving), 'V pohybu · velikost 67 % · detaily od 0,5 px · JPEG 70 · chyba 0,031');
  });

  test('a picture to keep has all pixels of the view, as far as the server draws them', () => {
    assert.deepEqual(snapshotSize({ width: 1180, height: 820, pixelRatio: 2 }), { width: 2360, height: 1640 });
    assert.deepEqual(snapshotSize({ width: 390.4, height: 844, pixelRatio: 3 }), { width: 1171, height: 2532 });
    assert.deepEqual(snapshotSize({ width: 5000, height: 2500, pixelRatio: 4 }), { width: 8192, height: 4096 });
    assert.deepEqual(snapshotSize({ width: 1, height: 8192, pixelRatio: 0.25 }), { width: 1, height: 2048 });
  });

  test('its name is of the time', () => {
    assert.equal(snapshotName(new Date(2026, 2, 4, 5, 6, 7)), 'scene-20260304-050607.jpg');
  });

  test('bytes in words', async () => {
    assert.equal(bytesWords(0), '0\u00a0kB');
    assert.equal(bytesWords(148_200), '148\u00a0kB');
    assert.equal(bytesWords(2_340_000), '2.3\u00a0MB');
    await setLanguage('cs');
    assert.equal(bytesWords(2_340_000), '2,3\u00a0MB');
  });
});
