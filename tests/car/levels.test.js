// The program that makes the car's levels of detail from its control cages.
'use strict';
const assert = require('node:assert/strict');
const { execFileSync } = require('node:child_process');
const fs = require('node:fs');
const os = require('node:os');
const path = require('node:path');
const { after, test } = require('node:test');

const { VRUT_SUBDIVIDE, VRUT_CAGES, VRUT_CAR_FOLDER } = process.env;
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

for (const [name, wanted] of [['car.vrut', 200_000], ['car-20k.vrut', 20_000]]) {
  test(`${name} of the archive is what is made, to the byte: else build the target car_archive`, () => {
    subdivide(wanted, name);
    assert.ok(fs.readFileSync(path.join(folder, name)).equals(fs.readFileSync(path.join(VRUT_CAR_FOLDER, name))));
  });
}

for (const wanted of [60_000, 200_000]) {
  test(`in the car of ${wanted} triangles no part is lost`, () => {
    subdivide(wanted, `${wanted}.vrut`);
    const text = fs.readFileSync(path.join(folder, `${wanted}.vrut`), 'utf8');
    assert.deepEqual(text.match(/^geometry \d+\nend$/gm) ?? [], []);
  });
}
