// What the project's documents refer to is there, and README is short.
import assert from 'node:assert/strict';
import { existsSync, readFileSync, readdirSync } from 'node:fs';
import path from 'node:path';
import { test } from 'node:test';
import { fileURLToPath } from 'node:url';

const ROOT = path.join(path.dirname(fileURLToPath(import.meta.url)), '../..');
const FOLDERS = ['protocol', 'render', 'scenes', 'server', 'web-client', 'tests/stability', 'deploy'];
const MOST_LINES = 120;

const documents = ['.', ...FOLDERS].flatMap((folder) =>
  readdirSync(path.join(ROOT, folder), { recursive: folder !== '.' })
    .filter((name) => name.endsWith('.md')).map((name) => path.join(folder, name)));
const textOf = (document) => readFileSync(path.join(ROOT, document), 'utf8').replace(/^```.*?^```/gms, '');

/** As GitHub names the headings of a document. */
function anchorsOf(document) {
  const headings = [...textOf(document).matchAll(/^#+ +(.+)$/gm)].map(([, heading]) => heading);
  return headings.map((heading) => heading.toLowerCase().replace(/\[(.*?)\]\(.*?\)/g, '$1')
    .replace(/[^\p{L}\p{N}\- _]/gu, '').replaceAll(' ', '-'));
}

test('each link between documents leads somewhere', () => {
  assert.ok(documents.length > 10);
  for (const document of documents) {
    for (const [, link] of textOf(document).matchAll(/\]\(([^)\s]+)\)/g)) {
      if (/^[a-z]+:/.test(link)) continue;
      const [file, anchor] = link.split('#');
      const target = file ? path.join(path.dirname(document), file) : document;
      assert.ok(existsSync(path.join(ROOT, target)), `${document}: there is no ${link}`);
      if (anchor) assert.ok(anchorsOf(target).includes(anchor), `${document}: ${target} has no heading #${anchor}`);
    }
  }
});

test('README is read in three minutes', () => {
  assert.ok(readFileSync(path.join(ROOT, 'README.md'), 'utf8').split('\n').length <= MOST_LINES + 1);
});

test('.ci/run begins with the commands that README starts with', () => {
  const start = /^## Start$.*?^```\n(.*?)^```$/ms.exec(readFileSync(path.join(ROOT, 'README.md'), 'utf8'))[1];
  const commands = start.trim().split('\n').map((line) => line.replace(/ +#.*/, ''));
  const script = readFileSync(path.join(ROOT, '.ci/run'), 'utf8');
  const named = (name) => new RegExp(`^${name}="(.*)"$`, 'm').exec(script)[1];
  assert.deepEqual(commands, [named('quickstart'), named('tests')]);
  // Each in a system of its own: the first until it shows a picture, the second to its end and before all others.
  const systems = [...script.matchAll(/^ *within (\w+) "(.*)"/gm)].map(([, system, line]) => [system, line]);
  assert.deepEqual(systems, [['first', '$quickstart'], ['second', '$tests && $rest']]);
  assert.match(script, /^first_picture$/m);
});
