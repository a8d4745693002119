import { element } from './element.js';

const KEEPS_FILE_MS = 60_000;

/** Gives the user a file. @param {BlobPart} data @param {string} type @param {string} name */
export function download(data, type, name) {
  const href = URL.createObjectURL(new Blob([data], { type }));
  element('a', { href, download: name }).click();
  setTimeout(() => URL.revokeObjectURL(href), KEEPS_FILE_MS);
}
