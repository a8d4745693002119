const LARGEST_SIDE = 8192;

/** @typedef {{top: number, right: number, bottom: number, left: number}} Sides in CSS pixels */

/**
 * Tells the view's {width, height, inset} in CSS pixels and pixelRatio, within the protocol's limits, and changes.
 *
 * @param {HTMLElement} view
 * @param {{over: Element, rows: Element[]}} covers `over` lies on the view, beside an open menu; `rows` are its parts at
 *   the view's lower end
 * @param {(size: {width: number, height: number, pixelRatio: number, inset: Sides}) => void} tell
 */
export function watchViewSize(view, { over, rows }, tell, window = globalThis.window) {
  let last = '';

  const measure = () => {
    const width = Math.min(view.clientWidth, LARGEST_SIDE);
    const height = Math.min(view.clientHeight, LARGEST_SIDE);
    const pixelRatio = Math.min(Math.max(window.devicePixelRatio, 0.25), 4);
    const shown = rows.filter(({ textContent }) => textContent !== '').map((row) => row.getBoundingClientRect());
    const inset = insetOf({ width, height }, over.getBoundingClientRect(), shown);
    const size = { width, height, pixelRatio, inset };
    const text = JSON.stringify(size);
    if (width === 0 || height === 0 || text === last) return;
    last = text;
    tell(size);
  };
  // A query holds for one ratio only.
  const watchRatio = () => {
    measure();
    const query = window.matchMedia(`(resolution: ${window.devicePixelRatio}dppx)`);
    query.addEventListener('change', watchRatio, { once: true });
  };

  watchRatio();
  const observer = new window.ResizeObserver(measure);
  for (const element of [view, over, ...rows]) observer.observe(element);
}

/**
 * How far a view is covered from each side.
 *
 * @param {{width: number, height: number}} view
 * @param {Sides} column from the view's left and top
 * @param {{top: number, height: number}[]} rows of no height where they are not shown
 * @returns {Sides}
 */
export function insetOf(view, column, rows) {
  const shown = rows.filter(({ height }) => height > 0);
  const bottom = Math.min(column.bottom, ...shown.map(({ top }) => top));
  const within = (side) => Math.round(Math.min(Math.max(side, 0), LARGEST_SIDE));
  return {
    top: within(column.top),
    right: within(view.width - column.right),
    bottom: within(view.height - bottom),
    left: within(column.left),
  };
}

/**
 * What is free of a view; the inset is from its sides.
 *
 * @param {{width: number, height: number}} view
 * @param {Sides} inset
 */
export function freeOf({ width, height }, { top, right, bottom, left }) {
  return { left, top, right: width - right, bottom: height - bottom };
}
