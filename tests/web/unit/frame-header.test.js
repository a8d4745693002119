import assert from 'node:assert/strict';
import { test } from 'node:test';
import { frameHeader } from '../../../web-client/connection/frame-header.js';
import { JFIF, comment, jpegWith, segments } from './fakes.js';

const header = { frame: 7, revision: 3, camera: { name: 'Škoda' } };
const text = [...new TextEncoder().encode(JSON.stringify(header))];

test('the header is the comment behind the JFIF segment', () => {
  assert.deepEqual(frameHeader(jpegWith(header)), header);
});

test('the first of several comments counts', () => {
  assert.deepEqual(frameHeader(segments(JFIF, comment(text), comment([0x7b, 0x7d]))), header);
});

test('a header may be as long as a segment can be', () => {
  const long = { text: 'x'.repeat(65533 - '{"text":""}'.length) };
  assert.deepEqual(frameHeader(jpegWith(long)), long);
});

test('what is no frame has no header', () => {
  assert.equal(frameHeader(new ArrayBuffer(0)), null);
  assert.equal(frameHeader(new ArrayBuffer(1)), null);
  assert.equal(frameHeader(Uint8Array.from([0x89, 0x50, 0x4e, 0x47]).buffer), null);
});

test('neither has a picture without a comment, nor one whose comment comes with the pixels', () => {
  assert.equal(frameHeader(segments(JFIF, [0xff, 0xd9])), null);
  assert.equal(frameHeader(segments(JFIF, [0xff, 0xda, 0, 2], comment(text))), null);
});

test('a comment that is no JSON object, or no UTF-8, is no header', () => {
  for (const other of ['', 'made by hand', '[1]', '"text"', 'null', '{"frame":']) {
    assert.equal(frameHeader(jpegWith(other)), null, other);
  }
  assert.equal(frameHeader(segments(JFIF, comment([0x7b, 0xff, 0x7d]))), null);
});

test('a file that is cut off anywhere is no worse than one without a header', () => {
  const whole = jpegWith(header);
  const headerEnd = 2 + JFIF.length + 4 + text.length;
  for (let length = 0; length < headerEnd; length += 1) {
    assert.equal(frameHeader(whole.slice(0, length)), null, `cut at ${length}`);
  }
});

test('segments of impossible length end the search', () => {
  assert.equal(frameHeader(segments([0xff, 0xe0, 0, 0], comment(text))), null);
  assert.equal(frameHeader(segments([0xff, 0xe0, 0xff, 0xff], comment(text))), null);
});
