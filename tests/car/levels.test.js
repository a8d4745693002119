// The program that makes the car's levels of detail from its control cages.
'use strict';
const assert = require('node:assert/strict');
const { execFileSync } = require('node:child_process');
const fs = require('node:fs');
const os = require('node:os');
const path = require('node:path');
const { after, test } = require('node:test');

const { VRUT_SUBDIVIDE, VRUT_CAGES } = process.env;
const folder = fs.mkdtempSync(path.join(os.tmpdir(), 'vrut-preview-'));
after(() => fs.rmSync(folder, { recursive: true }));

/** How many triangles show in the level that it makes. */
function subdivide(triangles, name) {
  const said = execFileSync(VRUT_SUBDIVIDE, [VRUT_CAGES, '--triangles', String(triangles), '-o', path.join(folder, name)]);
  return Number(/^(\d+) triangles shown/.exec(said)[1]);
}

for (const wanted of [200_000, 1_000_000]) {
  test(`the car of ${wanted} triangles has about as many`, () => {
    const shown = subdivide(wanted, `${wanted}.vrut`);
    assert.ok(Math.abs(shown / wanted - 1) < 0.1, `${shown} are shown`);
  });
}

test('what is made twice is the same', () => {
  subdivide(200_000, 'again.vrut');
  const [once, again] = ['200000.vrut', 'again.vrut'].map((name) => fs.readFileSync(path.join(folder, name)));
  assert.ok(once.equals(again));
});

for (const wanted of [60_000, 200_000]) {
  test(`in the car of ${wanted} triangles no part is lost`, () => {
    subdivide(wanted, `${wanted}.vrut`);
    const text = fs.readFileSync(path.join(folder, `${wanted}.vrut`), 'utf8');
    assert.deepEqual(text.match(/^geometry \d+\nend$/gm) ?? [], []);
  });
}
