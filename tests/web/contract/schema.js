// The JSON Schema that the server serves. Where it serves none, nothing is checked, and a skipped test says so.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import Ajv from 'ajv/dist/2020.js';

const ROOTS = ['clientMessage', 'serverMessage', 'frameHeader', 'stateDocument'];

/** Others may find more than is described; here all that the server says must be. */
function closed(document) {
  const $defs = structuredClone(document.$defs);
  for (const [name, schema] of Object.entries($defs))
    if (schema.type === 'object' && (name.startsWith('server') || ROOTS.includes(name))) schema.additionalProperties = false;
  return { ...document, $defs };
}

export class Schema {
  checked = Object.fromEntries(ROOTS.map((root) => [root, 0]));
  #validators = {};
  #keepWritable;

  static async fetch(server) {
    const answer = await server.get('protocol.schema.json');
    return new Schema(answer.status === 200 ? await answer.json() : null);
  }

  constructor(document) {
    this.document = document;
    if (!document) return;
    const ajv = new Ajv({ strict: false, validateFormats: false, allErrors: false });
    const name = document.$id ?? 'protocol';
    ajv.addSchema(closed(document), name);
    for (const root of ROOTS) this.#validators[root] = ajv.compile({ $ref: `${name}#/$defs/${root}` });
    const remover = new Ajv({ strict: false, validateFormats: false, removeAdditional: true }).addSchema(document, name);
    this.#keepWritable = remover.compile({ $ref: `${name}#/$defs/statePatch` });
  }

  /** @returns {object} a patch that says of a state document what clients may write, as it is there */
  patchOf(state) {
    const patch = structuredClone(state);
    assert.ok(this.#keepWritable(patch), `not a statePatch of the schema: ${JSON.stringify(this.#keepWritable.errors)}`);
    return patch;
  }

  /** @returns {string | null} what is wrong with `value` as a `root`; null where all is well or there is no schema */
  complaint(root, value) {
    const valid = this.#validators[root];
    if (!valid) return null;
    ++this.checked[root];
    if (valid(value)) return null;
    const where = valid.errors.map((e) => `${e.instancePath || '/'} ${e.message}`).join('; ');
    return `not a ${root} of the schema: ${where}: ${JSON.stringify(value).slice(0, 500)}`;
  }
}

/** To be called last in a file: tells whether its messages were checked against the schema, or that none was. */
export function schemaTest(server) {
  const skip = server.schema.document ? false : 'the server serves no /protocol.schema.json: nothing was validated';
  test('the messages of this file have been checked against the JSON Schema', { skip }, () => {
    for (const root of ['clientMessage', 'serverMessage', 'stateDocument']) assert.ok(server.schema.checked[root] > 0, root);
  });
}
