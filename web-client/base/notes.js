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

/** What a picture of a note shows; undefined where it has no view. @param {Notes} notes @param {string} name */
export function pictureOfNote(notes, name) {
  const { view, point, node } = notes[name] ?? {};
  return view && { look: JSON.stringify([view, point, node]), request: { camera: view } };
}
