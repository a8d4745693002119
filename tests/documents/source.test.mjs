// Rules of the source that a compiler does not know.
import assert from 'node:assert/strict';
import { readFileSync, readdirSync } from 'node:fs';
import path from 'node:path';
import { test } from 'node:test';
import { fileURLToPath } from 'node:url';

const ROOT = path.join(path.dirname(fileURLToPath(import.meta.url)), '../..');

const sources = ['protocol', 'server'].flatMap((folder) =>
  readdirSync(path.join(ROOT, folder), { recursive: true })
    .filter((name) => /\.[ch]pp$/.test(name)).map((name) => path.join(folder, name)));
/** The lines of a file in which the expression is found. */
const linesWith = (file, expression) => readFileSync(path.join(ROOT, file), 'utf8').split('\n')
  .flatMap((line, i) => (expression.test(line) ? [`${file}:${i + 1}: ${line.trim()}`] : []));

test('rights stand in one table: nothing else compares roles', () => {
  const compared = /\brole_?(\(\))?\s*[=!]=|[=!]=\s*(\w+::)*Role::|case (\w+::)*Role::/;
  assert.ok(sources.length > 100);
  assert.ok(linesWith('protocol/rights.hpp', compared).length > 0, 'the expression finds the table');
  assert.deepEqual(sources.filter((file) => file !== 'protocol/rights.hpp')
    .flatMap((file) => linesWith(file, compared)), []);
});
