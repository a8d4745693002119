/** Keeps the screen on while that is wanted and the page is to be seen, where the browser can. */
export class Awake {
  #wanted = false;
  /** A promise of the lock, or of null where it is refused. */
  #lock = null;

  constructor() {
    // The browser takes a lock back from a page that is hidden.
    document.addEventListener('visibilitychange', () => this.#update());
  }

  set wanted(wanted) {
    this.#wanted = wanted;
    this.#update();
  }

  #update() {
    if (this.#wanted && !document.hidden) {
      this.#lock ??= navigator.wakeLock?.request('screen').catch(() => null);
    } else {
      this.#lock?.then((lock) => lock?.release());
      this.#lock = null;
    }
  }
}
