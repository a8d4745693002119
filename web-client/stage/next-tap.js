/**
 * Promises the next tap on an element, which lies on the picture until then; null where Escape or the signal ends the
 * wait.
 *
 * @param {HTMLElement} layer
 * @param {AbortSignal} signal
 * @returns {Promise<?MouseEvent>}
 */
export function nextTap(layer, signal) {
  const ended = new AbortController();
  return new Promise((resolve) => {
    const end = (event) => {
      ended.abort();
      layer.hidden = true;
      resolve(event);
    };
    layer.hidden = false;
    layer.addEventListener('click', end, { signal: ended.signal });
    signal.addEventListener('abort', () => end(null), { signal: ended.signal });
    // Before the menu and the view, which have other uses for the key.
    document.addEventListener('keydown', (event) => {
      if (event.key !== 'Escape') return;
      event.preventDefault();
      event.stopPropagation();
      end(null);
    }, { capture: true, signal: ended.signal });
  });
}
