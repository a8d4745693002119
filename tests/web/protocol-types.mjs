// Types of the protocol's messages and of the state document, of its schema. Run it after a change of the schema:
// node tests/web/protocol-types.mjs
import { readFileSync, writeFileSync } from 'node:fs';
import { fileURLToPath } from 'node:url';

const SCHEMA = new URL('../../protocol/protocol.schema.json', import.meta.url);
export const TYPES = new URL('../../web-client/base/protocol.d.ts', import.meta.url);

const HEAD = '// Written by tests/web/protocol-types.mjs from protocol/protocol.schema.json.\n';

/** @returns {string} TypeScript: an exported type for each definition of the schema */
export function protocolTypes() {
  const { $defs } = JSON.parse(readFileSync(SCHEMA, 'utf8'));
  const types = Object.entries($defs).map(([name, schema]) => `\nexport type ${typeName(name)} = ${typeOf(schema)};\n`);
  return HEAD + types.join('');
}

function typeName(name) {
  return name[0].toUpperCase() + name.slice(1);
}

function typeOf(schema, indent = '') {
  const { $ref, anyOf, oneOf, enum: values, type } = schema;
  if ($ref) return typeName($ref.split('/').at(-1));
  if ('const' in schema) return literal(schema.const);
  if (values) return values.map(literal).join(' | ');
  if (anyOf ?? oneOf) return (anyOf ?? oneOf).map((one) => typeOf(one, indent)).join(' | ');
  switch (type) {
    case 'integer':
      return 'number';
    case 'array':
      return `Array<${typeOf(schema.items, indent)}>`;
    case 'object':
      return objectType(schema, indent);
    case 'boolean':
    case 'null':
    case 'number':
    case 'string':
      return type;
    default:
      throw new Error(`No type is known for ${JSON.stringify(schema)}.`);
  }
}

function objectType({ properties, required = [], additionalProperties }, indent) {
  if (additionalProperties) return `Record<string, ${typeOf(additionalProperties, indent)}>`;
  if (!properties) return 'object';
  const inner = `${indent}  `;
  const members = Object.entries(properties).map(([name, schema]) =>
    `${comment(schema, inner)}${inner}${name}${required.includes(name) ? '' : '?'}: ${typeOf(schema, inner)};\n`);
  return `{\n${members.join('')}${indent}}`;
}

function comment({ description }, indent) {
  return description ? `${indent}/** ${description} */\n` : '';
}

function literal(value) {
  return typeof value === 'string' ? `'${value}'` : String(value);
}

if (process.argv[1] === fileURLToPath(import.meta.url)) writeFileSync(TYPES, protocolTypes());
