// Every example in the pages of protocol/ is what the schema says, and every client's message is sent to a server,
// which answers as the page tells.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import path from 'node:path';
import { after, before, describe, test } from 'node:test';
import Ajv from 'ajv/dist/2020.js';
import { ContractClient } from './contract-client.js';
import { examplesOf, PAGES } from './pages.js';
import { SCENES, Server, temporaryFolder } from './server.js';
import { POSE, VIEW } from './stage.js';

const logs = temporaryFolder();
const server = await Server.start({ options: ['--scenes', SCENES, '--record', logs] });
after(() => server.stop());

/** By the words behind ```json: the definition of the schema. */
const DEFINITIONS = {
  client: 'clientMessage',
  'client host': 'clientMessage',
  server: 'serverMessage',
  'server later': 'serverMessage',
  state: 'stateDocument',
  patch: 'statePatch',
  header: 'frameHeader',
  'log header': 'eventLogHeader',
  'log line': 'eventLogLine',
  levels: 'levelTable',
  cues: 'cueList',
};

/** The schema without room for members of later versions: an example has none that is misspelled. */
function closed(schema) {
  if (Array.isArray(schema)) return schema.map(closed);
  if (schema === null || typeof schema !== 'object') return schema;
  const inner = Object.fromEntries(Object.entries(schema).map(([name, value]) => [name, closed(value)]));
  return schema.type === 'object' && schema.properties ? { ...inner, additionalProperties: false } : inner;
}

const ajv = new Ajv({ strict: false, validateFormats: false }).addSchema(closed(server.schema.document), 'closed');
const validators = new Map();
function complaint(definition, value) {
  if (!validators.has(definition)) validators.set(definition, ajv.compile({ $ref: `closed#/$defs/${definition}` }));
  const validate = validators.get(definition);
  return validate(value) ? null : `not a ${definition}: ${ajv.errorsText(validate.errors)}: ${JSON.stringify(value).slice(0, 300)}`;
}

const examples = new Map(PAGES.map((page) => [page, examplesOf(page)]));
const [state] = examples.get('STATE').filter(({ what }) => what === 'state');

for (const [page, ofPage] of examples) {
  for (const { what, where, value } of ofPage)
    test(`${where} is valid`, () => {
      assert.ok(DEFINITIONS[what], `nobody knows what '${what}' is`);
      // The log's header stands there without the document, which has a page of its own.
      const whole = what === 'log header' ? { ...value, state: state.value } : value;
      assert.equal(complaint(DEFINITIONS[what], whole), null);
    });
  if (page !== 'PROTOCOL' && page !== 'NAVIGATION') test(`${page}.md has examples`, () => assert.ok(ofPage.length > 0));
}

test('each message of a client has an example that is sent', () => {
  const sent = new Set(examples.get('CLIENT_MESSAGES').filter(({ what }) => /^client/.test(what)).map(({ value }) => value.type));
  const all = server.schema.document.$defs.clientMessage.oneOf.map(({ $ref }) =>
    server.schema.document.$defs[$ref.split('/').at(-1)].properties.type.const);
  assert.deepEqual([...sent].sort(), all.sort());
});

/** Compares an answer with an example: numbers nearly; not what differs from one time to the next. */
function checkAnswer(answer, example, where) {
  const plain = ({ id, revision, qr, ...rest }) => ({ ...rest, qr: Array.isArray(qr) });
  const rounded = (value) => JSON.parse(JSON.stringify(value), (_, inner) =>
    typeof inner === 'number' ? Math.round(inner * 100) / 100 + 0 : inner);
  assert.deepEqual(rounded(plain(answer)), rounded(plain(example)), where);
}

describe('the messages of a client, one after the other', () => {
  let client;
  let host;
  const ends = [];
  const t = { after: (end) => ends.push(end) };

  before(async () => {
    client = await ContractClient.join(t, server, { name: 'iPad' });
    host = await ContractClient.join(t, server, { role: 'host', name: 'front wall' });
  });
  after(() => Promise.all(ends.map((end) => end())));

  /** The scene as it was loaded, seen so that the examples of `pick` hit what they say. */
  async function prepare() {
    await client.ask({ type: 'resize', ...VIEW });
    await client.patch({ camera: POSE, navigation: null, renderer: null, selection: { node: null }, nodes: null, markers: null, cues: { Arrival: { ms: 50 } } });
  }

  async function openedAgain(name) {
    await client.until(name, () => client.state.scene.file === name);
    await client.until('the loading is over', () => client.texts.some((text) => text.done && text.scene === name));
    await client.ask({ type: 'open', scene: 'stage.vrut' });
    await client.until('the stage', () => client.state.scene.file === 'stage.vrut');
  }

  /** Sends an example, and resolves with its answer; `error` as it came. */
  async function answerTo(sender, { id, ...message }) {
    if (id !== undefined && message.type !== 'frame') {
      const sent = sender.send(message);
      return sender.answer(sent).catch((error) => {
        const refusal = sender.texts.findLast((text) => text.id === sent);
        if (!refusal) throw error;
        return refusal;
      });
    }
    const before = sender.texts.length;
    sender.send(message, { id: null });
    await sender.barrier();
    return sender.texts.slice(before).find((text) => text.type === 'error') ?? null;
  }

  const ofClient = examples.get('CLIENT_MESSAGES');
  ofClient.forEach(({ what, where, value }, i) => {
    if (!what.startsWith('client')) return;
    const [expected, later] = [ofClient[i + 1], ofClient[i + 2]];
    test(`${where}: ${value.type}`, async (own) => {
      if (value.type === 'hello') {
        const { id, ...hello } = value;
        const other = await ContractClient.connect(server);
        own.after(() => other.leave());
        assert.equal((await other.ask(hello)).type, 'welcome');
        await other.until('state', () => other.state);
        return;
      }
      await prepare();
      const answer = await answerTo(what === 'client host' ? host : client, value);
      if (expected?.what === 'server') checkAnswer(answer, expected.value, where);
      else if (value.type === 'snapshot') assert.equal(answer.type, 'a frame');
      else assert.equal(answer?.type, value.id === undefined || value.type === 'frame' ? undefined : 'ok', JSON.stringify(answer));
      if (later?.what === 'server later' && expected?.what === 'server') {
        const { type } = later.value;
        const came = await client.texted(type, (text) => text.id === answer.id);
        checkAnswer(came, later.value, where);
      }
      if (value.type === 'open' && answer.type === 'ok') await openedAgain(value.scene);
      if (value.type === 'swing') await client.until('the door stands still', () => Object.keys(client.state.swings).length === 0);
    });
  });

  for (const [page, ofPage] of examples)
    for (const { what, where, value } of ofPage)
      if (what === 'patch')
        test(`${where}: a patch`, async () => {
          assert.ok(['STATE', 'CUES'].includes(page));
          await prepare();
          await client.patch(value);
        });

  test('the log that the examples wrote is as the schema says', () => {
    const [header, ...lines] = readFileSync(path.join(logs, 'demo.jsonl'), 'utf8').trim().split('\n').map((line) => JSON.parse(line));
    assert.equal(complaint('eventLogHeader', header), null);
    assert.ok(lines.length > 0);
    for (const line of lines) assert.equal(complaint('eventLogLine', line), null);
  });
});
