// Of three small files one is drawn, one is refused and one is blank, and the page tells which.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import path from 'node:path';
import { after, test } from 'node:test';
import { countSentences } from './try-files.mjs';

const SCRIPT = new URL('try-files.mjs', import.meta.url).pathname;
const folder = mkdtempSync(path.join(tmpdir(), 'try-files-test-'));
after(() => rmSync(folder, { recursive: true }));

test('files are drawn, refused and blank', () => {
  writeFileSync(path.join(folder, 'drawn.obj'), 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n');
  writeFileSync(path.join(folder, 'refused.obj'), 'v 0 0 0\nv 1 0 0\nv 0 1 0\n');
  writeFileSync(path.join(folder, 'blank.obj'), 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 2\n');
  writeFileSync(path.join(folder, 'notes.txt'), 'no scene');
  const out = path.join(folder, 'out');
  const said = execFileSync(process.execPath, [SCRIPT, folder, out], { encoding: 'utf8' });
  assert.match(said, /^3 files: 1 drawn, 1 refused, 1 blank, 0 hung, 0 crashed$/m);
  assert.match(said, /^refused 1: it has no triangles/m);
  const rows = JSON.parse(readFileSync(`${out}.json`, 'utf8'));
  assert.deepEqual(rows.map(({ name, outcome }) => [name, outcome]),
    [['blank.obj', 'blank'], ['drawn.obj', 'drawn'], ['refused.obj', 'refused']]);
  assert.ok(rows.every(({ ms }) => ms > 0));
  const page = readFileSync(`${out}.html`, 'utf8');
  const pictures = page.match(/<img src="data:image\/png/g).length;
  assert.ok(pictures === 2 || rows[0].f3d && pictures === 5); // F3D needs a display
  assert.match(page, /<b>refused\.obj<\/b><br>refused, .*<br>it has no triangles/);
});

test('sentences of one kind are counted together', () => {
  const rows = ["'a.mtl': no file", "'b.mtl': no file", 'line 3 is wrong'].map((sentence) => ({ outcome: 'refused', sentences: [sentence] }));
  assert.deepEqual(countSentences(rows, 'refused'), [["'…': no file", 2], ['line N is wrong', 1]]);
});
