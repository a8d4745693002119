/**
 * JSON Merge Patch (RFC 7396). Gives a new document and leaves both arguments as they are; parts that the
 * patch does not touch are shared with the old one.
 *
 * @param {*} target
 * @param {*} patch
 * @returns {*}
 */
export function mergePatch(target, patch) {
  if (!isObject(patch)) return patch;
  // A Map and fromEntries, because a member may be called "__proto__".
  const members = new Map(isObject(target) ? Object.entries(target) : []);
  for (const [name, value] of Object.entries(patch)) {
    if (value === null) members.delete(name);
    else members.set(name, mergePatch(members.get(name), value));
  }
  return Object.fromEntries(members);
}

function isObject(value) {
  return typeof value === 'object' && value !== null && !Array.isArray(value);
}
