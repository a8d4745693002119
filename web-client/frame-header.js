const START = 0xd8;
const SCAN = 0xda;
const COMMENT = 0xfe;

/**
 * Reads what a frame says of itself: the JSON object in the JPEG's first comment segment.
 *
 * @param {ArrayBuffer} jpeg
 * @returns {?object} null where there is no such header, or no whole one
 */
export function frameHeader(jpeg) {
  const bytes = new DataView(jpeg);
  const isMarker = (at, code) => bytes.getUint8(at) === 0xff && bytes.getUint8(at + 1) === code;
  if (bytes.byteLength < 2 || !isMarker(0, START)) return null;

  // Each segment is 0xff, its code, and its length, which counts its own two bytes.
  for (let at = 2; at + 4 <= bytes.byteLength; ) {
    const length = bytes.getUint16(at + 2);
    if (bytes.getUint8(at) !== 0xff || isMarker(at, SCAN) || length < 2) return null;
    if (isMarker(at, COMMENT)) return parse(jpeg, at + 4, length - 2);
    at += 2 + length;
  }
  return null;
}

function parse(jpeg, offset, length) {
  if (offset + length > jpeg.byteLength) return null;
  try {
    const text = new TextDecoder('utf-8', { fatal: true }).decode(new Uint8Array(jpeg, offset, length));
    const header = JSON.parse(text);
    return typeof header === 'object' && header !== null && !Array.isArray(header) ? header : null;
  } catch {
    return null;
  }
}
