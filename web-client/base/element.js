/** With properties (`data` for its dataset, `role` and `aria-…` as attributes) and children. */
export function element(tag, properties = {}, ...children) {
  const made = document.createElement(tag);
  for (const [name, value] of Object.entries(properties)) {
    if (name === 'data') Object.assign(made.dataset, value);
    else if (name === 'role' || name.startsWith('aria-')) made.setAttribute(name, value);
    else made[name] = value;
  }
  made.append(...children);
  return made;
}

/**
 * Whether a key belongs to what has the focus: somebody types there, or it is a dialog, which has keys of its own.
 *
 * @param {?EventTarget} target of the key's event
 */
export function keepsKeys(target) {
  return target instanceof Element && target.closest('input, textarea, select, dialog') !== null;
}

/**
 * With an icon of index.html; `only` with that, or else the label is its `lastChild`.
 *
 * @param {string} label
 * @param {() => void} act
 * @param {{icon?: string, quiet?: boolean, only?: boolean}} [looks]
 */
export function button(label, act, looks = {}) {
  const { icon, quiet = false, only = false } = looks;
  const made = element('button', { type: 'button', onclick: act, className: quiet ? 'quiet' : '' });
  const use = `<use href="#icon-${icon}"/>`;
  if (icon) made.innerHTML = `<svg class="icon" viewBox="0 0 24 24" aria-hidden="true">${use}</svg>`;
  if (only) Object.assign(made, { title: label, ariaLabel: label });
  else made.append(label);
  return made;
}
