/** Keeps the screen on while that is wanted and the page is to be seen, where the browser can. */
export class Awake {
  #wanted = false;
  /** @type {?Promise<WakeLockSentinel|void>|undefined} of the lock */
  #lock = null;

  constructor() {
    // A hidden page loses its lock; Safari gives one to a touch only.
    for (const type of ['visibilitychange', 'touchend']) document.addEventListener(type, () => this.#update());
  }

  set wanted(wanted) {
    this.#wanted = wanted;
    this.#update();
  }

  #update() {
    if (this.#wanted && !document.hidden) {
      this.#lock ??= navigator.wakeLock?.request('screen').catch(() => {
        this.#lock = null;
      });
    } else {
      this.#lock?.then((lock) => lock?.release());
      this.#lock = null;
    }
  }
}
