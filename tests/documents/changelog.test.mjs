// CHANGELOG.md is short, and has a section for each version, the newest first; what has changed since then has a file each.
import assert from 'node:assert/strict';
import { execFileSync, spawnSync } from 'node:child_process';
import { copyFileSync, mkdirSync, mkdtempSync, readFileSync, readdirSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import path from 'node:path';
import { after, test } from 'node:test';
import { fileURLToPath } from 'node:url';

const ROOT = path.join(path.dirname(fileURLToPath(import.meta.url)), '../..');
const SECTIONS = ['To do when you update', 'Added', 'Changed', 'Fixed'];
const MOST_CHARACTERS = 200;
const MOST_LINES = new Map([['0.2.0', 25]]);

const read = (name) => readFileSync(path.join(ROOT, name), 'utf8');
const folder = mkdtempSync(path.join(tmpdir(), 'vrut-changes-'));
after(() => rmSync(folder, { recursive: true }));

/** The versions of a changelog: their names and texts. */
const versionsOf = (text) => text.split(/^## /m).slice(1).map((part) => {
  const [name, ...lines] = part.trimEnd().split('\n');
  return { name, lines };
});

function checkChangelog(text, newest) {
  for (const line of text.replace(/^- /gm, '').split('\n')) assert.ok(line.length <= MOST_CHARACTERS, `${line.length} characters: ${line}`);
  const versions = versionsOf(text);
  const names = versions.map(({ name }) => name);
  assert.equal(names[0], newest);
  for (const name of names) assert.match(name, /^\d+\.\d+\.\d+$/);
  const order = names.map((name) => name.split('.').reduce((sum, part) => sum * 1000 + Number(part), 0));
  for (let i = 1; i < order.length; i++) assert.ok(order[i] < order[i - 1], `${names}`);
  for (const { name, lines } of versions) {
    assert.ok(lines.length + 1 <= (MOST_LINES.get(name) ?? Infinity), `${name} has ${lines.length + 1} lines`);
    const [lead, ...sections] = lines.join('\n').split(/^### /m);
    assert.doesNotMatch(lead, /^- /m);
    const titles = sections.map((section) => section.split('\n')[0]);
    assert.ok(titles.length > 0);
    assert.deepEqual(titles, SECTIONS.filter((title) => titles.includes(title)));
    for (const section of sections) assert.match(section, /^- /m);
  }
}

test('the changelog has the version that is built first, short lines, and sections for each kind of change', () => {
  checkChangelog(read('CHANGELOG.md'), /^project\(vrut-preview VERSION (\S+)/m.exec(read('CMakeLists.txt'))[1]);
});

test('each change since then is one short line in a file that is named after its section', () => {
  for (const name of readdirSync(path.join(ROOT, 'changes'))) {
    if (['README.md', 'join.sh'].includes(name)) continue;
    assert.match(name, /^[\w-]+\.(added|changed|fixed|update)\.md$/, 'SHORT-NAME.SECTION.md');
    const text = read(`changes/${name}`).replace(/\n$/, '');
    assert.ok(text.length <= MOST_CHARACTERS, `${name} has ${text.length} characters`);
    assert.match(text, /^[^\s*-].*\.$/, `${name}: one sentence in one line, without a bullet`);
    assert.doesNotMatch(text, /\n|\]\(/, `${name}: one line, without a link`);
  }
});

test('a new version takes the changes into the changelog', () => {
  const at = (name) => path.join(folder, name);
  mkdirSync(at('changes'));
  for (const name of ['CHANGELOG.md', 'changes/README.md', 'changes/join.sh']) copyFileSync(path.join(ROOT, name), at(name));
  writeFileSync(at('changes/lamps.fixed.md'), 'Lamps are lit.\n');
  writeFileSync(at('changes/doors.fixed.md'), 'Doors close.');
  writeFileSync(at('changes/wipers.added.md'), 'The car has wipers & "rain" \\1.\n');
  writeFileSync(at('changes/wipers.update.md'), 'Let wipers rest.\n');
  const join = (...words) => spawnSync('bash', [at('changes/join.sh'), ...words], { encoding: 'utf8' });
  for (const [words, sentence] of [[[], /Usage/], [['1'], /Usage/], [['0.2.0'], /has a section of 0\.2\.0 already/]]) {
    const { status, stderr } = join(...words);
    assert.equal(status, 1);
    assert.match(stderr, sentence);
  }

  execFileSync('bash', [at('changes/join.sh'), '1000.0.0']);
  const before = read('CHANGELOG.md');
  const text = readFileSync(at('CHANGELOG.md'), 'utf8');
  const section = ['## 1000.0.0', '',
    '### To do when you update', '- Let wipers rest.', '',
    '### Added', '- The car has wipers & "rain" \\1.', '',
    '### Fixed', '- Doors close.', '- Lamps are lit.', '', ''].join('\n');
  assert.equal(text, before.replace(/^## /m, () => `${section}## `));
  checkChangelog(text, '1000.0.0');
  assert.deepEqual(readdirSync(at('changes')).sort(), ['README.md', 'join.sh']);
  assert.match(join('1000.0.1').stderr, /there is no change/);
});
