import assert from 'node:assert/strict';
import { readFileSync, readdirSync } from 'node:fs';
import { afterEach, test } from 'node:test';
import { errorSentence, language, noticeSentence, preferredLanguage, say, setLanguage, written } from '../../../web-client/base/texts.js';
import { cs } from '../../../web-client/base/texts/cs.js';
import { en } from '../../../web-client/base/texts/en.js';

const read = (path) => readFileSync(new URL(path, new URL('../../../', import.meta.url)), 'utf8');
const tables = Object.entries({ en, cs });
const modules = readdirSync(new URL('../../../web-client/', import.meta.url), { recursive: true })
  .filter((name) => name.endsWith('.js') && !name.includes('texts/'))
  .map((name) => ({ name, source: read(`web-client/${name}`) }));
const { notice, serverError } = JSON.parse(read('protocol/protocol.schema.json')).$defs;
const codes = [
  ...serverError.properties.code.enum.map((code) => `error.${code}`),
  ...notice.properties.code.enum.map((code) => `notice.${code}`),
].sort();

const isOfServer = (key) => /^(error|notice)\./.test(key);
const keysOf = (table) => Object.keys(table).filter((key) => !isOfServer(key)).sort();
const forms = (entry) => (typeof entry === 'string' ? [entry] : Object.values(entry));
const sorted = (words) => [...new Set(words)].sort();
const placeholders = (text) => sorted([...text.matchAll(/\{(\w+)\}/g)].map(([, name]) => name));

/** Each key stands in a module as a literal, in a call or in a table; nothing else there looks like one. */
const used = modules.flatMap(({ name, source }) =>
  [...source.matchAll(/'([a-z]+(?:\.[\w-]+)+)'/g)].map(([, key]) => ({ name, key })));
/** The calls with values, as {name, key, values: their names}. */
const calls = modules.flatMap(({ name, source }) =>
  [...source.matchAll(/\bsay\('([^']+)', \{([^}]*)\}\)/g)].map(([, key, literal]) =>
    ({ name, key, values: sorted([...literal.matchAll(/(?:^|,)\s*([a-z]\w*)/g)].map(([, value]) => value)) })));

afterEach(() => setLanguage('en'));

test('a text is in the language in force', async () => {
  assert.equal(say('parts.all'), 'All parts');
  await setLanguage('cs');
  assert.equal(language(), 'cs');
  assert.equal(say('parts.all'), 'Všechny díly');
  await setLanguage('de');
  assert.equal(language(), 'en');
});

test('the language chosen last counts, however long the texts of another take', async () => {
  const fresh = await import('../../../web-client/base/texts.js?fresh');
  const czech = fresh.setLanguage('cs');
  await fresh.setLanguage('en');
  await czech;
  assert.equal(fresh.language(), 'en');
});

test('a text holds its values: words as they are, numbers as the language writes them', () => {
  assert.equal(say('views.nameTaken', { name: '{name} $& 1000' }), 'There is a view “{name} $& 1000” already.');
  assert.equal(say('connection.behind', { count: 1234 }), '1,234 behind');
});

test('a count has the plural form of the language', async () => {
  const said = () => [0, 1, 2, 5].map((count) => say('parts.count', { count }));
  assert.deepEqual(said(), ['0 parts', '1 part', '2 parts', '5 parts']);
  await setLanguage('cs');
  assert.deepEqual(said(), ['0 dílů', '1 díl', '2 díly', '5 dílů']);
});

test('the language is the first known of the browser\'s', () => {
  assert.equal(preferredLanguage(['cs']), 'cs');
  assert.equal(preferredLanguage(['de-AT', 'cs-CZ', 'en']), 'cs');
  assert.equal(preferredLanguage(['en-US', 'cs']), 'en');
  assert.equal(preferredLanguage(['sk-SK', 'en']), 'cs');
  assert.equal(preferredLanguage(['de']), 'en');
  assert.equal(preferredLanguage([]), 'en');
});

test('an error is told by its code, in English by the server', async () => {
  const error = { code: 'failed', message: 'nothing is being recorded' };
  assert.equal(errorSentence(error), 'nothing is being recorded');
  await setLanguage('cs');
  assert.equal(errorSentence(error), 'Akce se nezdařila (nothing is being recorded).');
  assert.equal(errorSentence({ code: 'not-in-control', message: 'another client is in control' }), 'Scénu právě řídí někdo jiný.');
  assert.equal(errorSentence({ code: 'of-a-later-version', message: 'something new' }), 'something new');
  assert.equal(errorSentence(new Error('Pohled „A“ už existuje.')), 'Pohled „A“ už existuje.');
});

test('a notice is told by its code, in English by the server', async () => {
  const notice = { code: 'not-drawn', message: 'What is to be seen now cannot be drawn: no memory' };
  assert.equal(noticeSentence(notice), notice.message);
  await setLanguage('cs');
  assert.equal(noticeSentence(notice), `Tento pohled nelze vykreslit (${notice.message}).`);
  assert.equal(noticeSentence({ ...notice, code: 'software' }), 'Kreslí se bez grafické karty, obrázků za sekundu bude méně.');
});

test('numbers are written as the language does', async () => {
  assert.equal(written(1234.567, 1), '1,234.6');
  assert.equal(written(0.4), '0');
  await setLanguage('cs');
  assert.equal(written(1234.567, 1), '1\u00a0234,6');
});

test('each language has the keys of the others', () => {
  for (const [, table] of tables) assert.deepEqual(keysOf(table), keysOf(en));
});

test('each key that a module uses exists', () => {
  assert.ok(used.length > 100 && sorted(used.map(({ name }) => name)).length >= 8);
  for (const { name, key } of used) assert.ok(Object.hasOwn(en, key), `${name}: ${key}`);
});

test('each key is used', () => {
  const known = new Set(used.map(({ key }) => key));
  assert.deepEqual(keysOf(en).filter((key) => !known.has(key)), []);
});

test('each text has all its values, the same in each language', () => {
  const given = new Map(calls.map(({ key, values }) => [key, values]));
  for (const key of keysOf(en)) {
    for (const [name, table] of tables) {
      for (const text of forms(table[key])) assert.deepEqual(placeholders(text), given.get(key) ?? [], `${name}: ${key}`);
    }
  }
  for (const { name, key, values } of calls) assert.deepEqual(values, given.get(key), `${name}: ${key}`);
});

test('plural forms are those of the language', () => {
  for (const [name, table] of tables) {
    const categories = new Intl.PluralRules(name).resolvedOptions().pluralCategories;
    for (const [key, entry] of Object.entries(table)) {
      if (typeof entry === 'object') assert.deepEqual(Object.keys(entry).sort(), [...categories].sort(), `${name}: ${key}`);
    }
  }
});

test('each text is a text', () => {
  for (const [name, table] of tables) {
    for (const [key, entry] of Object.entries(table)) {
      for (const text of forms(entry)) assert.ok(text !== '' && text.trim() === text, `${name}: ${key}`);
    }
  }
});

test('each code of the server\'s has a sentence, but in English, which the server speaks', () => {
  assert.ok(codes.length > 10);
  for (const [name, table] of tables) {
    const sentences = Object.entries(table).filter(([key]) => isOfServer(key));
    assert.deepEqual(sentences.map(([key]) => key).sort(), name === 'en' ? [] : codes);
    for (const [key, text] of sentences) {
      assert.match(text, /^\p{Lu}.*\.$/u, `${name}: ${key}`);
      assert.ok(['', 'message'].includes(placeholders(text).join()), `${name}: ${key}`);
    }
  }
});

test('the modules hold no texts of their own', () => {
  for (const { name, source } of modules) {
    const code = source.replace(/\/\*[^]*?\*\/|(?<=^|\s)\/\/.*/gm, '');
    assert.doesNotMatch(code, /(['"`])\p{Lu}\p{Ll}+ \p{Ll}[^\n]*\1/u, name);
    assert.doesNotMatch(code, /(?=\P{ASCII})\p{L}/u, name);
  }
});
