import assert from 'node:assert/strict';
import { readdirSync, statSync } from 'node:fs';
import { test } from 'node:test';

const FOLDER = new URL('../../../web-client/', import.meta.url);
const LARGEST_BYTES = 100 * 1024;

const CODE = /\.(html|css|js|webmanifest|svg)$/;

test('the page is small: its own code as written, without the icons', () => {
  const written = readdirSync(FOLDER).filter((name) => CODE.test(name));
  assert.ok(written.includes('main.js') && written.includes('style.css'));
  const bytes = written.reduce((sum, name) => sum + statSync(new URL(name, FOLDER)).size, 0);
  assert.ok(bytes <= LARGEST_BYTES, `${bytes} bytes`);
});
