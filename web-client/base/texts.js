import { en } from './texts/en.js';

/** @import { StateDocument } from './protocol.js' */

/** By language: English, and what was loaded. @type {Record<string, Record<string, string|Record<string, string>>>} */
const TABLES = { en };
/** By a browser's language; who reads Slovak reads Czech. */
const KNOWN = { cs: 'cs', sk: 'cs', en: 'en' };

let current = 'en';
/** The last that was chosen, whose texts may not be loaded yet. */
let wanted = current;
/** @type {Record<string, Intl.NumberFormat>} by language and digits */
const formats = {};

/** The language in force: 'en' or 'cs'. */
export function language() {
  return current;
}

/** Others than those known are English. Promises that its texts are loaded; where they are not, all stays as it is. */
export async function setLanguage(code) {
  const known = code === 'cs' ? 'cs' : 'en';
  wanted = known;
  if (known === 'cs') TABLES.cs ??= (await import('./texts/cs.js')).cs;
  if (wanted === known) current = known;
}

/** The first known of a browser's languages ('cs-CZ'), or else English. */
export function preferredLanguage(tags) {
  return tags.map((tag) => KNOWN[tag.split('-')[0]]).find(Boolean) ?? 'en';
}

/** The text of a key, with its values; numbers are written as the language does, `count` chooses the plural form. */
export function say(key, values = {}) {
  const entry = TABLES[current][key];
  const text = typeof entry === 'string' ? entry : entry[new Intl.PluralRules(current).select(values.count)];
  return text.replace(/\{(\w+)\}/g, (_, name) => {
    const value = values[name];
    return typeof value === 'number' ? written(value) : value;
  });
}

/**
 * The sentence for an error: by its code, or the server's own where the language has none for that.
 *
 * @param {{code?: string, message: string}} error
 */
export function errorSentence({ code, message }) {
  const key = `error.${code}`;
  return key in TABLES[current] ? say(key, { message }) : message;
}

/** The same for a notice. @param {StateDocument['notices'][number]} notice */
export function noticeSentence({ code, message }) {
  const key = `notice.${code}`;
  return key in TABLES[current] ? say(key, { message }) : message;
}

/** A number as the language writes it; `digits` behind the decimal sign, at most. No line ends before its unit. */
export function written(value, digits = 0, unit = '') {
  const key = `${current} ${digits}`;
  // Making one takes longer than all else that is done for a frame.
  formats[key] ??= new Intl.NumberFormat(current, { maximumFractionDigits: digits });
  const number = formats[key].format(value);
  return unit ? `${number}\u00a0${unit}` : number;
}

/** Words as a sentence lists them. @param {string[]} words */
export function listed(words) {
  // British English has no comma before "and", as the other texts.
  return new Intl.ListFormat(current === 'en' ? 'en-GB' : current).format(words);
}

/** A moment, in milliseconds since 1970, as the language and the user's clock write it. @param {number} ms */
export function writtenTime(ms) {
  return new Intl.DateTimeFormat(current, { dateStyle: 'medium', timeStyle: 'short' }).format(ms);
}

/**
 * How people call a client: by the name that it gave in `hello`, or else by its id.
 *
 * @param {{client?: string, name?: string}} who
 */
export function clientName({ client, name }) {
  return name || say('connection.client', { id: client });
}

/**
 * How people call the holder of `control` of the state.
 *
 * @param {Partial<StateDocument['control']>} control
 */
export function holderName({ holder, name }) {
  return clientName({ client: holder, name });
}
