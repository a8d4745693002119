const SMALLEST_RATIO = 0.25;
const LARGEST_RATIO = 4;
const LARGEST_SIDE = 8192;

/**
 * Tells an element's size and the display's pixel ratio at once and whenever one of them changes (the window,
 * the tablet's orientation, the page's zoom, another screen), at most once a display frame.
 *
 * @param {HTMLElement} element
 * @param {(size: {width: number, height: number, pixelRatio: number}) => void} tell
 * @param {Window} [window]
 */
export function watchViewSize(element, tell, window = globalThis.window) {
  let last = {};
  let measuring = false;

  const measure = () => {
    const size = viewSize(element.clientWidth, element.clientHeight, window.devicePixelRatio);
    if (!size || Object.keys(size).every((name) => size[name] === last[name])) return;
    last = size;
    tell(size);
  };
  const measureSoon = () => {
    if (measuring) return;
    measuring = true;
    window.requestAnimationFrame(() => {
      measuring = false;
      measure();
    });
  };
  // A query holds for one ratio only, so each change needs the next.
  const watchRatio = () => {
    const here = window.matchMedia(`(resolution: ${window.devicePixelRatio}dppx)`);
    here.addEventListener('change', () => {
      watchRatio();
      measureSoon();
    }, { once: true });
  };

  new window.ResizeObserver(measureSoon).observe(element);
  watchRatio();
  measure();
}

function viewSize(width, height, pixelRatio) {
  if (width < 1 || height < 1) return null;
  return {
    width: Math.min(width, LARGEST_SIDE),
    height: Math.min(height, LARGEST_SIDE),
    pixelRatio: Math.min(Math.max(pixelRatio, SMALLEST_RATIO), LARGEST_RATIO),
  };
}
