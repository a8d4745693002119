const START = 0xffd8;
const SCAN = 0xffda;
const COMMENT = 0xfffe;

/** The JSON object in a JPEG's first comment segment, from an ArrayBuffer; null where there is no whole one. */
export function frameHeader(jpeg) {
  const data = new DataView(jpeg);
  try {
    if (data.getUint16(0) !== START) return null;
    let at = 2;
    // A segment's length counts its own two bytes.
    while (data.getUint16(at) !== COMMENT) {
      if (data.getUint16(at) < 0xff00 || data.getUint16(at) === SCAN) return null;
      at += 2 + data.getUint16(at + 2);
    }
    const text = new Uint8Array(jpeg, at + 4, data.getUint16(at + 2) - 2);
    const header = JSON.parse(new TextDecoder('utf-8', { fatal: true }).decode(text));
    return typeof header === 'object' && !Array.isArray(header) ? header : null;
  } catch {
    return null; // the file ends too soon, or it is no JSON
  }
}
