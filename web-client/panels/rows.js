import { element } from '../base/element.js';

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
      empty.hidden = entries.length > 0;
    },
  };
}
