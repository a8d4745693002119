/**
 * @import { StateDocument } from './protocol.js'
 * @typedef {StateDocument['markers']} Notes
 * @typedef {Notes[string]} Note
 */

/** Names of the notes by their time, the first one first; those without one are from before, by name. @param {Notes} notes */
export function noteNames(notes) {
  return Object.keys(notes).sort((a, b) => (notes[a].time ?? 0) - (notes[b].time ?? 0) || Number(a > b) - Number(a < b));
}

/** What a patch has for a note to come back as it was: nothing that it did not have is filled in. @param {Note} note */
export function asItWas(note) {
  return { author: null, view: null, ...note };
}

/**
 * Where a point of the world lies in a picture of a note, in parts of its width and height; the middle where that is
 * outside.
 *
 * @param {NonNullable<Note['view']>} view that it shows
 * @param {number[]} point
 * @param {number} aspect its width by its height
 */
export function placeInPicture({ eye, focus, up, fov }, point, aspect) {
  const dot = (a, b) => a.reduce((sum, x, i) => sum + x * b[i], 0);
  const minus = (a, b) => a.map((x, i) => x - b[i]);
  const ahead = minus(focus, eye);
  const across = [1, 2, 0].map((j, i) => ahead[j] * up[(i + 2) % 3] - ahead[(i + 2) % 3] * up[j]); // as long as `ahead`
  const to = minus(point, eye);
  const half = (Math.tan((fov * Math.PI) / 360) * dot(to, ahead)) / Math.hypot(...ahead); // of the height there
  const x = 0.5 + dot(to, across) / Math.hypot(...ahead) / (2 * half * aspect);
  const y = 0.5 - dot(to, up) / (2 * half);
  const isInside = half > 0 && x >= 0 && x <= 1 && y >= 0 && y <= 1;
  return isInside ? { x, y } : { x: 0.5, y: 0.5 };
}

/** What a picture of a note shows; undefined where it has no view. @param {Notes} notes @param {string} name */
export function pictureOfNote(notes, name) {
  const { view, point, node } = notes[name] ?? {};
  return view && { look: JSON.stringify([view, point, node]), request: { camera: view } };
}
