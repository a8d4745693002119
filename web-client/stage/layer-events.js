/**
 * Listens to what happens on a layer over the picture while a tool is on. Nothing else gets it, and Escape ends the
 * tool.
 *
 * @template {*} Tool
 * @param {HTMLElement} layer
 * @param {Tool & {end: () => void}} tool
 * @param {Record<string, (this: Tool, event: *) => void>} handlers by the type of the event
 * @param {AbortSignal} signal ends the listening
 */
export function listenOnLayer(layer, tool, handlers, signal) {
  const prevent = (event) => event.preventDefault();
  // Without touchmove, Chromium drops a tap soon after a flick.
  for (const [type, handler] of Object.entries({ contextmenu: prevent, touchmove: prevent, ...handlers })) {
    layer.addEventListener(type, handler.bind(tool), { signal, passive: false });
  }
  // Before the menu and the view, which have other uses for the key.
  document.addEventListener('keydown', (event) => {
    if (event.key !== 'Escape') return;
    event.preventDefault();
    event.stopPropagation();
    tool.end();
  }, { capture: true, signal });
}
