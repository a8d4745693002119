// The table of LIMITS.md says what the studies gave, and each of its rows has a study behind it.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import path from 'node:path';
import { test } from 'node:test';
import { PAGE, ROWS, held, read, root, table, withTable } from './limits.mjs';

const text = (file) => readFileSync(path.join(root, file), 'utf8');

test('the table is what the results give', () => {
  const page = readFileSync(PAGE, 'utf8');
  assert.ok(page === withTable(page, table(read())), 'the table in LIMITS.md is another: run tests/stability/limits.mjs');
});

for (const { what, studies = [], tests = [] } of ROWS)
  test(`a study is behind the row '${what}'`, () => {
    assert.ok(studies.length > 0);
    const results = read();
    for (const study of studies) held(results, study);
    // A source may break a long name into several literals.
    for (const [file, name] of tests)
      assert.ok(text(file).replace(/"\s*\n\s*"/g, '').includes(`TEST_CASE("${name}")`), `${file} has no test '${name}'`);
  });

test('a method holds up to its limit, or to the last point within its bound', () => {
  const points = [[1, 0], [2, 3], [4, 9], [8, 1]];
  const of = (study) => held(new Map([['a', { points, ...study }]]), 'a');
  assert.deepEqual(of({ bound: 10 }), { to: 8, worst: 9, bound: 10 });
  assert.deepEqual(of({ bound: 10, limit: 4 }), { to: 2, worst: 3, bound: 10 });
  assert.deepEqual(of({ bound: 5 }), { to: 2, worst: 3, bound: 5 });
  assert.throws(() => of({ bound: -1 }), /holds nowhere/);
  assert.throws(() => of({ bound: 10, failure: "'m' is 9 at 4" }), /failed: 'm' is 9 at 4/);
  assert.throws(() => held(new Map(), 'a'), /no results of a study 'a'/);
});
