import assert from 'node:assert/strict';
import { readFileSync, readdirSync } from 'node:fs';
import { posix } from 'node:path';
import { test } from 'node:test';

const PAGE = new URL('../../../web-client/', import.meta.url);
/** The rooms that a room imports, besides itself; types count, too. What lies in no room builds the page of all. */
const MAY_IMPORT = {
  base: [],
  connection: ['base'],
  navigation: ['base'],
  warp: ['base', 'navigation'],
  stage: ['base', 'connection', 'navigation', 'warp'],
  panels: ['base', 'connection'],
  '.': ['base', 'connection', 'navigation', 'warp', 'stage', 'panels'],
};

const modules = readdirSync(PAGE, { recursive: true }).filter((name) => name.endsWith('.js'));
const roomOf = (module) => posix.dirname(module).split('/')[0];
const importsOf = new Map(modules.map((module) => {
  const source = readFileSync(new URL(module, PAGE), 'utf8');
  const paths = [...source.matchAll(/(?:from |import\()'(\..+?)'/g)].map(([, path]) => path);
  return [module, paths.map((path) => posix.join(posix.dirname(module), path))];
}));

test('a room imports only from those below it', () => {
  assert.ok(modules.length > 20);
  for (const [module, imported] of importsOf) {
    const room = roomOf(module);
    for (const other of imported) {
      assert.ok([room, ...MAY_IMPORT[room]].includes(roomOf(other)), `${module} imports ${other}`);
    }
  }
});

test('no module imports itself, however far around', () => {
  const done = new Set();
  const visit = (module, above) => {
    assert.ok(!above.includes(module), `in a circle: ${[...above, module].join(' → ')}`);
    if (done.has(module)) return;
    for (const other of importsOf.get(module) ?? []) visit(other, [...above, module]);
    done.add(module);
  };
  for (const module of modules) visit(module, []);
});
