import assert from 'node:assert/strict';
import { execFile } from 'node:child_process';
import { readFileSync } from 'node:fs';
import { test } from 'node:test';
import { fileURLToPath } from 'node:url';
import { promisify } from 'node:util';
import { TYPES, protocolTypes } from '../protocol-types.mjs';

const path = (relative) => fileURLToPath(new URL(relative, import.meta.url));

test('the types of the protocol are those of its schema', () => {
  const isStale = readFileSync(TYPES, 'utf8') !== protocolTypes();
  assert.ok(!isStale, 'web-client/base/protocol.d.ts is stale: run node tests/web/protocol-types.mjs');
});

test('the page keeps to its types', async () => {
  const tsc = path('../node_modules/typescript/bin/tsc');
  const { stdout } = await promisify(execFile)(process.execPath, [tsc, '--project', path('../../../web-client')])
    .catch((error) => error);
  assert.equal(stdout, '');
});
