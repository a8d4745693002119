import { asItWas } from './notes.js';
import { unusedName } from './order.js';

/**
 * @import { StateDocument, StatePatch } from './protocol.js'
 * @typedef {Pick<StateDocument, 'cues'|'markers'|'measures'|'views'>} Added
 */

/**
 * What people have added to a scene: cues, notes, measures and saved views. The view "home" belongs to the scene.
 *
 * @param {Added} state
 * @returns {Added}
 */
export function added({ cues, markers, measures, views }) {
  const { home, ...saved } = views;
  return { cues, markers, measures, views: saved };
}

/** Whether there is none of it. @param {Added} all */
export function isNone(all) {
  return Object.values(all).every((entries) => Object.keys(entries).length === 0);
}

/** The patch that deletes all of it. @param {Added} all @returns {StatePatch} */
export function deletionOf(all) {
  return mapped(all, (member, name) => [name, null]);
}

/**
 * The patch that brings all of it back to `now`: what has come since stays, and keeps its name.
 *
 * @param {Added} all
 * @param {Added} now
 * @returns {StatePatch}
 */
export function restorationOf(all, now) {
  return mapped(all, (member, name, entry) => {
    const isTaken = Object.hasOwn(now[member], name);
    const to = isTaken ? unusedName(name, [...Object.keys(now[member]), ...Object.keys(all[member])]) : name;
    return [to, member === 'markers' ? asItWas(entry) : entry];
  });
}

/** @param {Added} all @param {(member: keyof Added, name: string, entry: *) => [string, *]} change */
function mapped(all, change) {
  return Object.fromEntries(Object.entries(all).map(([member, entries]) =>
    [member, Object.fromEntries(Object.entries(entries).map(([name, entry]) => change(/** @type {keyof Added} */ (member), name, entry)))]));
}
