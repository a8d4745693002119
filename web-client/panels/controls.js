import { element } from '../base/element.js';
import { language, written } from '../base/texts.js';
import { cutToBytes } from '../base/utf8.js';

/**
 * Shows a value; its `change` is told what the user does, and may give a promise of its end.
 *
 * @typedef {{element: HTMLElement, show: (...value: *) => void}} Control
 */

/** `tell` says what the user does; what is shown waits `during` that and for its news, or it would jump back. */
function patient(made, apply, tell) {
  let waiting = 0;
  let latest = [];
  const show = (...value) => {
    latest = value;
    if (waiting === 0 && value[0] !== undefined) apply(...value);
  };
  const during = async (end) => {
    waiting += 1;
    await end;
    await new Promise(requestAnimationFrame);
    waiting -= 1;
    show(...latest);
  };
  made.oninput = () => during(tell());
  return { element: made, show, during };
}

function labelled(label, kind, ...inputs) {
  return element('label', { className: `control ${kind}` }, element('span', {}, label), ...inputs);
}

function group(label, kind, ...inputs) {
  return element('fieldset', { className: `control ${kind}` }, element('legend', {}, label), ...inputs);
}

/** On or off. @returns {Control} shows a boolean */
export function toggle(label, change) {
  const input = element('input', { type: 'checkbox', role: 'switch' });
  const apply = (checked) => Object.assign(input, { checked });
  return patient(labelled(label, 'toggle', input), apply, () => change(input.checked));
}

let choices = 0;

/** One of a few options, [value, label] each. @returns {Control} shows a value */
export function choice(label, options, change) {
  choices += 1;
  const name = `choice-${choices}`;
  const inputs = options.map(([value]) => element('input', { type: 'radio', name, value }));
  const segments = options.map(([, text], i) => element('label', {}, inputs[i], text));
  const apply = (value) => {
    for (const input of inputs) input.checked = input.value === value;
  };
  return patient(group(label, 'choice', element('div', { className: 'segments' }, ...segments)), apply,
    () => change(inputs.find(({ checked }) => checked).value));
}

/** One of many. @returns {Control} shows a value and the options, [value, label] each */
export function selection(label, change) {
  let shown = '';
  const select = element('select');
  const apply = (value, options) => {
    const text = JSON.stringify(options);
    if (text !== shown) select.replaceChildren(...options.map(([key, name]) => new Option(name, key)));
    shown = text;
    select.value = value;
  };
  return patient(labelled(label, '', select), apply, () => change(select.value));
}

/**
 * A number, in words by `say`; `logarithmic`, with `step` of its decimal exponent.
 *
 * @returns {Control} shows a value; other limits are divided into a thousand steps
 */
export function range(label, { min, max, logarithmic = false, step = 1, say }, change) {
  const toScale = logarithmic ? Math.log10 : Number;
  const fromScale = logarithmic ? (exponent) => Number((10 ** exponent).toPrecision(3)) : Number;
  // Not an `output`: the label would be that one's, and not the slider's.
  const words = element('span', { className: 'value', 'aria-hidden': 'true' });
  const input = element('input', { type: 'range', min: toScale(min), max: toScale(max), step });
  const describe = (value) => {
    words.textContent = input.ariaValueText = say(value);
  };
  const apply = (value, limits) => {
    if (limits) Object.assign(input, { ...limits, step: (limits.max - limits.min) / 1000 });
    input.value = toScale(value);
    describe(value);
  };
  const control = patient(labelled(label, 'range', words, input), apply, () => {
    const value = fromScale(Number(input.value));
    describe(value);
    return change(value);
  });
  input.onpointerdown = () => {
    input.onpointerup?.();
    control.during(new Promise((resolve) => {
      input.onpointerup = input.onpointercancel = resolve;
    }));
  };
  return control;
}

/** Typed numbers from 0 on; `change` is given all. @returns {Control} shows an array of them */
export function numbers(label, labels, change) {
  let latest = [];
  const inputs = labels.map(() => element('input', { type: 'number', min: 0, step: 'any', inputMode: 'decimal' }));
  const labelledInputs = inputs.map((input, i) => element('label', {}, labels[i], input));
  const apply = (values) => {
    latest = values;
    for (const [i, input] of inputs.entries()) if (document.activeElement !== input) input.value = values[i];
  };
  const control = patient(group(label, 'numbers', ...labelledInputs), apply, () => {});
  for (const [i, input] of inputs.entries()) {
    input.onchange = () => {
      if (input.valueAsNumber >= 0) control.during(change(latest = latest.map((value, at) => at === i ? input.valueAsNumber : value)));
      else input.value = latest[i];
    };
    // A value that the server rejected is replaced by the present one when the field loses the focus.
    input.onblur = () => control.during();
  }
  return control;
}

/** A colour; its alpha stays as it is. @returns {Control} shows RGBA, 0 to 1 */
export function color(label, change) {
  let alpha = 1;
  const byte = (x) => Math.round(255 * Math.min(Math.max(x, 0), 1)).toString(16).padStart(2, '0');
  const input = element('input', { type: 'color' });
  const apply = (rgba) => {
    alpha = rgba[3];
    input.value = `#${rgba.slice(0, 3).map(byte).join('')}`;
  };
  return patient(labelled(label, '', input), apply, () =>
    change([...[1, 3, 5].map((at) => parseInt(input.value.slice(at, at + 2), 16) / 255), alpha]));
}

/**
 * A text of some lines, at most so many bytes, sent when it is left. What is typed and not sent yet is kept, whatever the
 * server has: also where a lost connection takes the focus from it.
 *
 * @returns {Control & {element: HTMLTextAreaElement}} shows what the server has
 */
export function words(properties, most, change) {
  const area = /** @type {HTMLTextAreaElement} */ (element('textarea', { rows: 3, ...properties }));
  let known = '';
  let sent = /** @type {?string} */ (null);
  const send = async () => {
    const text = area.value;
    if (text === known || text === sent) return;
    sent = text;
    await change(text);
    sent = null;
  };
  area.oninput = () => limit(area, most);
  area.onchange = area.onblur = send;
  return {
    element: area,
    show(text) {
      const isTyped = area.value !== known;
      known = text.replace(/\r\n?/g, '\n'); // as the browser gives it back
      if (!isTyped && area.value !== known) area.value = known;
    },
  };
}

/** Cuts what is typed to so many bytes. @param {HTMLInputElement|HTMLTextAreaElement} typed @param {number} most */
export function limit(typed, most) {
  const text = cutToBytes(typed.value, most);
  if (text !== typed.value) typed.value = text;
}

/** With labels by key. @returns {Control} shows texts or numbers by key, or dashes */
export function facts(labels) {
  const values = Object.keys(labels).map((key) => element('dd', { data: { fact: key } }));
  const lines = values.map((value) => fact(labels[value.dataset.fact], value));
  const show = (told) => {
    for (const value of values) {
      const known = told[value.dataset.fact] ?? '–';
      const text = typeof known === 'number' ? written(known, 3) : known;
      if (value.textContent !== text) value.textContent = text;
    }
  };
  return { element: element('dl', { className: 'facts' }, ...lines), show };
}

/** One line of such a list. */
export function fact(label, value) {
  return element('div', {}, element('dt', {}, label), value);
}

/** The order in which people look for names. */
export function byName(a, b) {
  return a.localeCompare(b, language(), { numeric: true });
}

/**
 * A Control of [key, item] for each row, or the words `none`. `make(key)` gives a row's {children, show(item)}; while
 * its key is there it stays the same element, for the focus.
 */
export function rows(label, none, make) {
  const list = element('ul', { className: 'rows', 'aria-label': label, tabIndex: -1 });
  const empty = element('p', { className: 'note' }, none);
  const made = new Map();
  return {
    element: element('div', {}, list, empty),
    show(entries) {
      const focused = /** @type {?HTMLElement} */ (document.activeElement);
      const keys = new Set(entries.map(([key]) => key));
      for (const [key, { row }] of made) {
        if (keys.has(key)) continue;
        const next = row.nextElementSibling ?? row.previousElementSibling ?? list;
        if (row.contains(document.activeElement)) (next.querySelector('button') ?? list).focus();
        row.remove();
        made.delete(key);
      }
      for (const [i, [key, item]] of entries.entries()) {
        if (!made.has(key)) {
          const { children, show } = make(key);
          made.set(key, { row: element('li', {}, ...children), show });
        }
        const { row, show } = made.get(key);
        if (list.children[i] !== row) list.insertBefore(row, list.children[i] ?? null);
        show(item);
      }
      // What is moved loses it.
      if (list.contains(focused)) focused?.focus();
      empty.hidden = entries.length > 0;
    },
  };
}
