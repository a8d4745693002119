const LARGEST_SIDE = 8192;

/** Tells an element's {width, height} in CSS pixels and pixelRatio, within the protocol's limits, and changes. */
export function watchViewSize(element, tell, window = globalThis.window) {
  let last = '';

  const measure = () => {
    const width = Math.min(element.clientWidth, LARGEST_SIDE);
    const height = Math.min(element.clientHeight, LARGEST_SIDE);
    const pixelRatio = Math.min(Math.max(window.devicePixelRatio, 0.25), 4);
    const size = String([width, height, pixelRatio]);
    if (width === 0 || height === 0 || size === last) return;
    last = size;
    tell({ width, height, pixelRatio });
  };
  // A query holds for one ratio only.
  const watchRatio = () => {
    measure();
    const query = window.matchMedia(`(resolution: ${window.devicePixelRatio}dppx)`);
    query.addEventListener('change', watchRatio, { once: true });
  };

  watchRatio();
  new window.ResizeObserver(measure).observe(element);
}
