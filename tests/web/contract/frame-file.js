// Reads what the contract says about a frame as a file: JPEG with the header in a COM segment, PNG with it in iTXt.
import assert from 'node:assert/strict';

const PNG = Buffer.from([0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a]);

/** @returns {{format: 'jpeg' | 'png', header: object, width: number, height: number, subsampling?: string}} */
export function readFrame(bytes) {
  return bytes.subarray(0, 8).equals(PNG) ? readPng(bytes) : readJpeg(bytes);
}

function readJpeg(bytes) {
  assert.equal(bytes.readUInt16BE(0), 0xffd8, 'a JPEG file begins with SOI');
  const frame = { format: 'jpeg' };
  for (let at = 2, segment = 0; ; ++segment) {
    const marker = bytes.readUInt16BE(at);
    const size = bytes.readUInt16BE(at + 2);
    const body = bytes.subarray(at + 4, at + 2 + size);
    if (segment === 0) {
      assert.equal(marker, 0xffe0, 'the first segment is APP0');
      assert.equal(body.toString('latin1', 0, 5), 'JFIF\0');
    }
    if (segment === 1) {
      assert.equal(marker, 0xfffe, 'a COM segment follows JFIF');
      assert.ok(body.length <= 65533);
      frame.header = JSON.parse(new TextDecoder('utf-8', { fatal: true }).decode(body));
    }
    if (marker === 0xffc0 || marker === 0xffc1 || marker === 0xffc2) Object.assign(frame, readSize(body));
    if (marker === 0xffda) {
      const end = bytes.length - (frame.header.depth?.bytes ?? 0);
      assert.equal(bytes.readUInt16BE(end - 2), 0xffd9, 'a JPEG file ends with EOI');
      return { ...frame, map: bytes.subarray(end) };
    }
    at += 2 + size;
  }
}

function readSize(body) {
  const sampling = (component) => body[7 + 3 * component];
  assert.equal(body[5], 3, 'three components');
  assert.deepEqual([sampling(1), sampling(2)], [0x11, 0x11]);
  const subsampling = { 0x11: '4:4:4', 0x22: '4:2:0' }[sampling(0)];
  return { height: body.readUInt16BE(1), width: body.readUInt16BE(3), subsampling };
}

function readPng(bytes) {
  const frame = { format: 'png' };
  let last = '';
  for (let at = 8; at < bytes.length; ) {
    const size = bytes.readUInt32BE(at);
    last = bytes.toString('latin1', at + 4, at + 8);
    const body = bytes.subarray(at + 8, at + 8 + size);
    if (last === 'IHDR') Object.assign(frame, { width: body.readUInt32BE(0), height: body.readUInt32BE(4) });
    if (last === 'iTXt') {
      const keyword = body.toString('latin1', 0, body.indexOf(0));
      if (keyword === 'vrut-preview') frame.header = JSON.parse(internationalText(body.subarray(keyword.length + 1)));
    }
    at += 12 + size;
  }
  assert.equal(last, 'IEND', 'a PNG file ends with IEND');
  return frame;
}

/** Compression flag and method, language tag, translated keyword, text (PNG specification 11.3.3.4). */
function internationalText(body) {
  assert.equal(body[0], 0, 'the iTXt chunk is not compressed');
  const language = body.indexOf(0, 2);
  const translated = body.indexOf(0, language + 1);
  return body.toString('utf8', translated + 1);
}
