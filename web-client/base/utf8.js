/** How many bytes a text has in UTF-8. @param {string} text */
export function byteLength(text) {
  return new TextEncoder().encode(text).length;
}

/** As many whole characters of a text as so many bytes of UTF-8 hold. @param {string} text @param {number} most */
export function cutToBytes(text, most) {
  const { read } = new TextEncoder().encodeInto(text, new Uint8Array(most));
  return text.slice(0, read);
}
