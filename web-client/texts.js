let current = 'en';

/** The language in force: 'en' or 'cs'. */
export function language() {
  return current;
}

/** Others than those known are English. */
export function setLanguage(code) {
  current = code === 'cs' ? 'cs' : 'en';
}

/** That of the two which is in the language in force. */
export function say(english, czech) {
  return current === 'cs' ? czech : english;
}

/** Says words by their key in a table of [English, Czech]. */
export function texts(table) {
  return (key) => say(...table[key]);
}

/** A number as the language writes it; `digits` behind the decimal sign, at most. */
export function written(value, digits = 0) {
  return new Intl.NumberFormat(current, { maximumFractionDigits: digits }).format(value);
}
