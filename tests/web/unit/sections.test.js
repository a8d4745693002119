import assert from 'node:assert/strict';
import { afterEach, describe, test } from 'node:test';
import {
  bytesWords, holderWords, hostWords, qualityWords, snapshotName, snapshotSize,
} from '../../../web-client/panels/connection-section.js';
import { setLanguage } from '../../../web-client/base/texts.js';
import { lookingAt, placeOf, unusedName } from '../../../web-client/panels/views-section.js';

afterEach(() => setLanguage('en'));

describe('views', () => {
  test('a look at a place keeps direction and distance', () => {
    const camera = lookingAt({ eye: [1, 2, 3], focus: [1, 2, -7] }, [5, 0, 0.1]);
    assert.deepEqual(camera.focus, [5, 0, 0.1]);
    assert.deepEqual(camera.center, [5, 0, 0.1]);
    assert.deepEqual(camera.eye, [5, 0, 3 + (0.1 - -7)]);
  });

  test('a marker goes with its part where the server tells the place in the part\'s space', () => {
    const picked = { node: 7, name: 'Door', point: [1, 2, 3], normal: [0, 0, 1], distance: 4 };
    assert.deepEqual(placeOf(picked), { point: [1, 2, 3] });
    assert.deepEqual(placeOf({ ...picked, local: [0.5, 0, 0] }), { node: 7, point: [0.5, 0, 0] });
  });

  test('a name that nothing has yet', () => {
    assert.equal(unusedName('View', []), 'View 1');
    assert.equal(unusedName('View', ['View 1', 'Door', 'View 3']), 'View 2');
    assert.equal(unusedName('View', ['View 1', 'View 2']), 'View 3');
  });
});

describe('connection', () => {
  test('who steers', () => {
    assert.equal(holderWords(undefined, 'c1'), 'Nobody');
    assert.equal(holderWords({ kept: false }, 'c1'), 'Nobody');
    assert.equal(holderWords({ holder: 'c1', kept: true, name: 'Eva' }, 'c1'), 'You');
    assert.equal(holderWords({ holder: 'c2', name: 'Eva\'s tablet' }, 'c1'), 'Eva\'s tablet');
    assert.equal(holderWords({ holder: 'c2' }, 'c1'), 'Client c2');
    setLanguage('cs');
    assert.equal(holderWords({ holder: 'c2' }, 'c1'), 'Klient c2');
    assert.equal(holderWords({ holder: 'c1', kept: false }, 'c1'), 'vy');
  });

  test('how far behind a wall is', () => {
    assert.equal(hostWords({ revision: 9, lagMs: 12.4 }, 9), 'up to date · 12 ms');
    assert.equal(hostWords({ revision: 5 }, 9), '4 behind');
    assert.equal(hostWords({ revision: 10 }, 9), 'up to date');
    setLanguage('cs');
    assert.equal(hostWords({ revision: 5 }, 9), 'pozadu o 4 změny');
  });

  test('which kind of picture it is', () => {
    const still = { level: 'still', scale: 1, samples: 16, detail: 0, jpegQuality: 95 };
    assert.equal(qualityWords(still), 'Still · 16 samples · full size · JPEG 95');
    assert.equal(qualityWords({ ...still, error: 0 }), 'Still · 16 samples · full size · JPEG 95 · error 0');
    assert.match(qualityWords({ ...still, error: 0.0004 }), / · error < 0\.001$/);
    const moving = { level: 'moving', scale: 0.67, samples: 1, detail: 0.5, jpegQuality: 70, error: 0.0314 };
    assert.equal(qualityWords(moving), 'Moving · 67 % size · detail 0.5 px · JPEG 70 · error 0.031');
    setLanguage('cs');
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

  test('bytes in words', () => {
    assert.equal(bytesWords(0), '0 kB');
    assert.equal(bytesWords(148_200), '148 kB');
    assert.equal(bytesWords(2_340_000), '2.3 MB');
    setLanguage('cs');
    assert.equal(bytesWords(2_340_000), '2,3 MB');
  });
});
