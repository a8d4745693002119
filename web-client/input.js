const KEYS = new Set([
  'ArrowLeft', 'ArrowRight', 'ArrowUp', 'ArrowDown', '+', '-', 'f', 'Home', 'w', 's', 'Escape',
  '1', '2', '3', // held in a drag, in one of the navigation styles
]);
/** Those that may go on while they are held; a held `w` must not flicker. */
const REPEATING_KEYS = new Set(['ArrowLeft', 'ArrowRight', 'ArrowUp', 'ArrowDown', '+', '-']);

/**
 * Passes pointer, wheel and key events on to the server, which alone knows what they mean. Moves are thinned
 * to one a display frame for each pointer; everything else goes out at once and in order.
 */
export class Input {
  #element;
  #window;
  #send;
  #mapping;
  #frame;

  /** Nothing is passed on while this is false. */
  #enabled = true;
  /** Pressed pointers, each with its latest message. */
  #pressed = new Map();
  /** Moves that wait for the display frame. */
  #moves = new Map();
  #flushing = false;
  #keys = new Set();
  /** From the window's coordinates to the view's; one for a whole gesture, even if the view changes. */
  #toView = null;

  /**
   * @param {HTMLElement} element the view
   * @param {object} options
   * @param {(message: object) => void} options.send
   * @param {() => (clientX: number, clientY: number) => {x: number, y: number}} options.mapping
   * @param {() => number|undefined} options.frame number of the frame last drawn
   * @param {Window} [options.window]
   */
  constructor(element, { send, mapping, frame, window = globalThis.window }) {
    this.#element = element;
    this.#window = window;
    this.#send = send;
    this.#mapping = mapping;
    this.#frame = frame;

    const listen = (target, handler, ...types) => {
      for (const type of types) target.addEventListener(type, handler.bind(this), { passive: false });
    };
    listen(element, this.#down, 'pointerdown');
    listen(element, this.#move, 'pointermove');
    listen(element, this.#up, 'pointerup', 'pointercancel');
    listen(element, this.#lostCapture, 'lostpointercapture');
    listen(element, this.#wheel, 'wheel');
    listen(element, (event) => event.preventDefault(), 'contextmenu');
    listen(window, this.#keyDown, 'keydown');
    listen(window, this.#keyUp, 'keyup');
    listen(window, this.#cancelAll, 'blur');
    listen(window.document, (event) => {
      if (window.document.visibilityState === 'hidden') this.#cancelAll(event);
    }, 'visibilitychange');
  }

  /** Whether input is passed on. A change forgets what is pressed: the other side has, too. */
  set enabled(enabled) {
    if (enabled === this.#enabled) return;
    this.#enabled = enabled;
    this.#pressed.clear();
    this.#moves.clear();
    this.#keys.clear();
  }

  #down(event) {
    event.preventDefault();
    if (!this.#enabled) return;
    try {
      this.#element.setPointerCapture(event.pointerId);
    } catch {
      // The pointer has gone already; its end follows.
    }
    if (this.#pressed.size === 0) this.#toView = this.#mapping();
    this.#flush();
    this.#pass(event);
  }

  #move(event) {
    if (!this.#pressed.has(event.pointerId)) return;
    // A further button of a pressed mouse comes as a move, and none of those may get lost.
    if (event.button >= 0) {
      this.#flush();
      this.#pass(event);
      return;
    }
    const message = this.#pointerMessage(event);
    this.#pressed.set(event.pointerId, message);
    this.#moves.set(event.pointerId, message);
    if (this.#flushing) return;
    this.#flushing = true;
    this.#window.requestAnimationFrame(() => {
      this.#flushing = false;
      this.#flush();
    });
  }

  #up(event) {
    if (!this.#pressed.has(event.pointerId)) return;
    this.#flush();
    this.#pass(event);
    this.#pressed.delete(event.pointerId);
  }

  /** After a proper end the pointer is no longer pressed; any other loss ends it here. */
  #lostCapture(event) {
    this.#cancel(event.pointerId, event.timeStamp);
  }

  #cancelAll(event) {
    for (const pointerId of [...this.#pressed.keys()]) this.#cancel(pointerId, event.timeStamp);
    this.#keys.clear();
  }

  #cancel(pointerId, timeStamp) {
    const last = this.#pressed.get(pointerId);
    if (!last) return;
    this.#flush();
    this.#send({ ...last, type: 'pointercancel', button: 0, buttons: 0, timeStamp });
    this.#pressed.delete(pointerId);
  }

  #wheel(event) {
    event.preventDefault();
    if (!this.#enabled) return;
    this.#flush();
    const toView = this.#pressed.size > 0 ? this.#toView : this.#mapping();
    this.#send({
      type: 'wheel',
      ...toView(event.clientX, event.clientY),
      deltaX: event.deltaX,
      deltaY: event.deltaY,
      deltaMode: event.deltaMode,
      ...common(event),
    });
  }

  #keyDown(event) {
    // With these held, a key means something to the browser.
    if (event.ctrlKey || event.metaKey || event.altKey || !KEYS.has(event.key)) return;
    if (!this.#enabled || event.defaultPrevented) return;
    event.preventDefault();
    if (event.repeat && !REPEATING_KEYS.has(event.key)) return;
    this.#keys.add(event.code);
    this.#sendKey(event);
  }

  #keyUp(event) {
    if (this.#keys.delete(event.code)) this.#sendKey(event);
  }

  #sendKey(event) {
    this.#flush();
    this.#send({ type: event.type, key: event.key, code: event.code, ...common(event) });
  }

  #pass(event) {
    const message = this.#pointerMessage(event);
    this.#pressed.set(event.pointerId, message);
    this.#send(message);
  }

  #pointerMessage(event) {
    return {
      type: event.type,
      pointerId: event.pointerId,
      pointerType: event.pointerType || 'mouse',
      ...this.#toView(event.clientX, event.clientY),
      button: event.button,
      buttons: event.buttons,
      ...common(event),
      frame: this.#frame(),
    };
  }

  #flush() {
    for (const message of this.#moves.values()) this.#send(message);
    this.#moves.clear();
  }
}

function common({ ctrlKey, shiftKey, altKey, metaKey, timeStamp }) {
  return { ctrlKey, shiftKey, altKey, metaKey, timeStamp };
}
