import assert from 'node:assert/strict';
import { readFileSync, readdirSync } from 'node:fs';
import { afterEach, test } from 'node:test';
import { language, say, setLanguage, texts, written } from '../../../web-client/texts.js';

const FOLDER = new URL('../../../web-client/', import.meta.url);

afterEach(() => setLanguage('en'));

const modules = readdirSync(FOLDER).filter((name) => name.endsWith('.js') && name !== 'texts.js')
  .map((name) => ({ name, source: readFileSync(new URL(name, FOLDER), 'utf8') }));
const importing = (word) => modules.filter(({ source }) =>
  new RegExp(`import \\{[^}]*\\b${word}\\b[^}]*\\} from './texts\\.js'`).test(source));

/** The tables of words: each is one literal behind `texts(`. */
const tables = modules.flatMap(({ name, source }) =>
  [...source.matchAll(/\btexts\((\{.*?^\})\)/gms)].map(([, literal]) => [name, new Function(`return ${literal}`)()]));

const LITERAL = /('(?:[^'\\\n]|\\.)*'|`(?:[^`\\]|\\.)*`)/.source;
/** Words that are said where they stand, as pairs of literals. */
const PAIR = new RegExp(`\\bsay\\(\\s*${LITERAL},\\s*${LITERAL},?\\s*\\)`, 'g');

test('words are said in the language in force', () => {
  const word = texts({ hello: ['Hello', 'Ahoj'] });
  assert.equal(word('hello'), 'Hello');
  setLanguage('cs');
  assert.equal(language(), 'cs');
  assert.equal(word('hello'), 'Ahoj');
  setLanguage('de');
  assert.equal(language(), 'en');
});

test('words stand where they are said, too', () => {
  assert.equal(say('Hello', 'Ahoj'), 'Hello');
  setLanguage('cs');
  assert.equal(say('Hello', 'Ahoj'), 'Ahoj');
});

test('numbers are written as the language does', () => {
  assert.equal(written(1234.567, 1), '1,234.6');
  assert.equal(written(0.4), '0');
  setLanguage('cs');
  assert.equal(written(1234.567, 1), '1\u00a0234,6');
});

test('every module with words was found', () => {
  assert.deepEqual([...new Set(tables.map(([name]) => name))], importing('texts').map(({ name }) => name));
  assert.ok(importing('texts').length + importing('say').length >= 5);
});

const sorted = (parts) => [...new Set(parts)].sort();
const values = (literal) => sorted(literal.match(/\$\{[^}]*\}/g) ?? []);

for (const { name, source } of importing('say')) {
  test(`${name} says all in both languages`, () => {
    const pairs = [...source.matchAll(PAIR)];
    assert.ok(pairs.length > 0);
    assert.equal(pairs.length, source.match(/\bsay\(/g).length, 'each is a pair of literals');
    for (const [, ...literals] of pairs) {
      for (const literal of literals) assert.match(literal, /^.\S(.*\S)?.$/s);
      assert.deepEqual(values(literals[0]), values(literals[1]), literals[0]);
    }
  });
}

for (const [module, table] of tables) {
  test(`${module} has all its words in both languages`, () => {
    for (const [key, words] of Object.entries(table)) {
      assert.equal(words.length, 2, key);
      for (const text of words) assert.ok(typeof text === 'string' && text.trim() === text && text !== '', `${key}: '${text}'`);
    }
  });

  test(`${module} says only words that it has`, () => {
    const { source } = modules.find(({ name }) => name === module);
    for (const [, key] of source.matchAll(/\bword\('(\w+)'/g)) assert.ok(key in table, `word('${key}')`);
  });
}
