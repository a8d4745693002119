/** JSON Merge Patch (RFC 7396) as a new document; with `keepsNull` of two patches, one that does both. */
export function mergePatch(target, patch, keepsNull = false) {
  if (!isObject(patch)) return patch;
  // A Map and fromEntries, because a member may be called "__proto__".
  const members = new Map(isObject(target) ? Object.entries(target) : []);
  for (const [name, value] of Object.entries(patch)) {
    if (value === null && !keepsNull) members.delete(name);
    else members.set(name, mergePatch(members.get(name), value, keepsNull));
  }
  return Object.fromEntries(members);
}

export function isObject(value) {
  return typeof value === 'object' && value !== null && !Array.isArray(value);
}
