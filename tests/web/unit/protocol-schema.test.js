import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { test } from 'node:test';
import Ajv from 'ajv/dist/2020.js';
import { mergePatch } from '../../../web-client/base/merge-patch.js';

const read = (path) => JSON.parse(readFileSync(new URL(path, import.meta.url), 'utf8'));
const schema = read('../../../protocol/protocol.schema.json');
// The same examples on which the C++ side's decode() is tried; codec_test.cpp tells what the members mean.
const examples = read('../../protocol/data/messages.json');
const fromServer = read('../../protocol/data/server_messages.json');

const ajv = new Ajv({ strict: true, strictRequired: false, allErrors: false });
ajv.addSchema(schema);
const definition = (name) => ajv.compile({ $ref: `${schema.$id}#/$defs/${name}` });
const isClientMessage = definition('clientMessage');
const isServerMessage = definition('serverMessage');

const accept = (validate, value) =>
  assert.ok(validate(value), `${JSON.stringify(value).slice(0, 300)}: ${ajv.errorsText(validate.errors)}`);
const refuse = (validate, value) =>
  assert.ok(!validate(value), `is accepted: ${JSON.stringify(value).slice(0, 300)}`);

const at = (message, path) => path.split('/').slice(1).reduce((value, key) => value[key], message);
const copy = (value) => JSON.parse(JSON.stringify(value));

function withMember(message, path, value) {
  const result = copy(message);
  const parent = at(result, path.slice(0, path.lastIndexOf('/')));
  const key = path.slice(path.lastIndexOf('/') + 1);
  if (value === undefined) delete parent[key];
  else parent[key] = value;
  return result;
}

function ofWrongType({ kind, length }) {
  const values = [null];
  if (kind !== 'number' && kind !== 'integer') values.push(1);
  if (kind !== 'flag') values.push(true);
  if (kind !== 'text' && kind !== 'word') values.push('1');
  if (kind !== 'vector' && kind !== 'list') values.push([]);
  if (kind !== 'object') values.push({});
  if (kind === 'vector') for (const wrong of [null, '1', true, [1]]) values.push([...Array(length - 1).fill(1), wrong]);
  return values;
}

function bounds({ kind, min, max, words, length, of }) {
  if (kind === 'flag' || kind === 'object') return { inside: [], outside: [] };
  if (kind === 'text') return { inside: ['x'.repeat(max)], outside: ['x'.repeat(max + 1)] };
  if (kind === 'word') return { inside: words, outside: ['', 'nonsense', 'constructor'] };
  if (kind === 'list') return { inside: [], outside: [[], Array(max + 1).fill(of)] };
  if (kind === 'integer') return { inside: [min, max], outside: [min - 1, max + 1, 0.5, 1e300, -1e300] };
  const little = (bound) => Math.max(Math.abs(bound), 2 ** -20) * 2 ** -40;
  const inside = [min, max], outside = [min - little(min), max + little(max), -1e300, 1e300];
  if (kind === 'number') return { inside, outside };
  const vector = (value) => [...Array(length - 1).fill(1), value];
  return {
    inside: inside.map(vector),
    outside: [...outside.map(vector), ...[0, length - 1, length + 1, 16].map((n) => Array(n).fill(1))],
  };
}

test('the schema keeps to the metaschema of draft 2020-12', () => {
  assert.equal(schema.$schema, 'https://json-schema.org/draft/2020-12/schema');
  assert.ok(ajv.validateSchema(schema), ajv.errorsText());
});

test('every valid message is accepted, with unknown members and with an id', () => {
  for (const message of examples.valid) {
    accept(isClientMessage, message);
    accept(isClientMessage, { ...message, id: 9007199254740991, somethingNew: [{ a: null }] });
  }
});

test('every invalid message is refused that a schema can tell', () => {
  for (const { text, schema: verdict } of examples.invalid) {
    let value;
    try {
      value = JSON.parse(text);
    } catch {
      continue; // no JSON at all
    }
    if (verdict === 'accepts') accept(isClientMessage, value);
    else refuse(isClientMessage, value);
  }
});

test('each member of each message: types, ranges, and whether it must be there', () => {
  for (const { example, members } of examples.members) {
    accept(isClientMessage, example);
    for (const member of members) {
      const { inside, outside } = bounds(member);
      for (const value of [...ofWrongType(member), ...outside])
        refuse(isClientMessage, withMember(example, member.path, value));
      for (const value of inside) accept(isClientMessage, withMember(example, member.path, value));
      if (member.element) continue;
      (member.required ? refuse : accept)(isClientMessage, withMember(example, member.path, undefined));
    }
    for (const id of [0, -1, 1.5, 2 ** 53, '1', null]) refuse(isClientMessage, { ...example, id });
  }
});

test('what the server says is accepted as that, with members of later versions too', () => {
  for (const message of fromServer.serverMessage) {
    accept(isServerMessage, message);
    accept(isServerMessage, { ...message, somethingNew: 1 });
  }
  for (const name of ['frameHeader', 'stateDocument'])
    for (const value of fromServer[name]) {
      accept(definition(name), value);
      accept(definition(name), { ...value, somethingNew: 1 });
    }
});

test('a state with a null in it, or without a section, is none', () => {
  const isState = definition('stateDocument');
  const [state] = fromServer.stateDocument;
  for (const section of Object.keys(state)) {
    refuse(isState, { ...state, [section]: null });
    const { [section]: _, ...without } = state;
    refuse(isState, without);
  }
});

test('the patches that the server sends lead from one state to the next', () => {
  const messages = fromServer.serverMessage.filter(({ type }) => type === 'state' || type === 'patch');
  const [first, second, there, back] = messages;
  assert.deepEqual(mergePatch(first.state, there.patch), second.state);
  assert.deepEqual(mergePatch(second.state, back.patch), first.state);
});
