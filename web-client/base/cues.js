import { namesInOrder } from './order.js';

/**
 * @import { StateDocument } from './protocol.js'
 * @typedef {StateDocument['cues']} Cues
 * @typedef {Cues[string]} Cue
 */

/** Names of the cues, as they follow each other. @param {Cues} [cues] */
export function cueNames(cues = {}) {
  return namesInOrder(cues);
}

/**
 * The name of the cue so many steps after the one that was shown last; undefined where there is none.
 *
 * @param {Pick<StateDocument, 'cues'|'cue'>} state
 * @param {number} steps
 */
export function cueAfter({ cues, cue }, steps) {
  const names = cueNames(cues);
  const at = names.indexOf(cue?.name ?? '') + steps;
  return at < 0 ? undefined : names[at];
}

/** The members of a cue that make its picture. */
export const LOOKS = ['camera', 'lights', 'backgrounds', 'selection', 'nodes', 'sections', 'sectionBox'];

/** What a patch has for a cue to become what is shown. */
export function asShown() {
  return Object.fromEntries(LOOKS.map((member) => [member, null]));
}

/**
 * What a patch has for the cue `now` to become exactly the one that is wanted: as tables merge, what that lacks of them
 * is removed.
 *
 * @param {Cue|undefined} wanted
 * @param {Cue|undefined} now
 */
export function exactly(wanted, now) {
  if (!wanted) return null;
  if (!now) return wanted;
  const { order = null, nodes, sections, selection } = wanted;
  return {
    ...wanted,
    order,
    ...(nodes ? { nodes: replacing(nodes, now.nodes, replacing) } : {}),
    ...(sections ? { sections: replacing(sections, now.sections) } : {}),
    ...(selection ? { selection: { node: selection.node ?? null } } : {}),
  };
}

/**
 * With null for what `now` has and `wanted` lacks.
 *
 * @param {*} wanted
 * @param {*} now
 * @param {(wanted: *, now: *) => *} [entry] the same for what both have
 */
function replacing(wanted, now, entry = (value) => value) {
  const removed = Object.keys(now).filter((name) => !Object.hasOwn(wanted, name)).map((name) => [name, null]);
  const kept = Object.entries(wanted).map(([name, value]) =>
    [name, value && Object.hasOwn(now, name) ? entry(value, now[name]) : value]);
  return Object.fromEntries([...removed, ...kept]);
}

/** A text that is the same for cues that look the same. @param {Cue} cue */
export function lookOf(cue) {
  return JSON.stringify(LOOKS.map((member) => cue[member]));
}

/** What a picture of a cue shows; undefined where there is none. @param {Cues} cues @param {string} name */
export function pictureOfCue(cues, name) {
  return cues[name] && { look: lookOf(cues[name]), request: { cue: name } };
}

/**
 * The file of a list of cues.
 *
 * @param {Pick<StateDocument, 'cues'|'scene'>} state
 */
export function cueList({ cues, scene }) {
  return { format: 'vrut-preview-cues', version: 1, scene: scene.file, cues };
}
