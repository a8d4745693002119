const PREFIX = 'vrut-preview.';

/** What this browser remembers of the page; null where it does not. */
export function recall(name) {
  try {
    return localStorage.getItem(PREFIX + name);
  } catch {
    return null;
  }
}

/** A secret of this tab, by which the server knows it again after a reload or a lost connection. */
export function resumeKey() {
  const fresh = [...crypto.getRandomValues(new Uint8Array(16))].map((byte) => byte.toString(16).padStart(2, '0')).join('');
  try {
    const key = sessionStorage.getItem(`${PREFIX}resume`) ?? fresh;
    sessionStorage.setItem(`${PREFIX}resume`, key);
    return key;
  } catch {
    return fresh;
  }
}

/** A value of null forgets. */
export function remember(name, value) {
  try {
    if (value === null) localStorage.removeItem(PREFIX + name);
    else localStorage.setItem(PREFIX + name, value);
  } catch {
    // Storage is switched off.
  }
}
