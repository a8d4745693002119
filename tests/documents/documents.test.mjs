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
