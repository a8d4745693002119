/**
 * Passes pointer, wheel and key events on to the server, which alone knows what they mean. Each pointer's moves are
 * thinned to the last when `soon` comes; everything else goes out at once and in order.
 */
export class Input {
  #page;
  #enabled = true;
  /** Each pressed pointer's latest message. */
  #pressed = new Map();
  /** Whose latest message waits for `soon`. */
  #moved = new Set();
  #keys = new Set();
  /** One mapping for a whole gesture, even if the view changes. */
  #toView;

  /**
   * The page's `send`, `soon`, `mapping` like Picture's, `frame`: the number drawn, `rules`: the welcome's `input`,
   * `moved` for each move before it is thinned, `marks`: FingerMarks, and `unheard` for what would be passed on were it
   * enabled.
   */
  constructor(element, page) {
    this.#page = { window: globalThis.window, ...page };
    const { window } = this.#page;
    const listen = (target, handlers) => {
      for (const [type, handler] of Object.entries(handlers)) {
        target.addEventListener(type, handler.bind(this), { passive: false });
      }
    };
    const prevent = (event) => event.preventDefault();
    listen(element, {
      pointerdown: this.#down,
      pointermove: this.#move,
      pointerup: this.#up,
      pointercancel: this.#up,
      // After its proper end a pointer is no longer pressed.
      lostpointercapture: this.#cancel,
      wheel: this.#wheel,
      contextmenu: prevent,
      // Or Chromium drops a tap soon after a flick.
      touchmove: prevent,
    });
    listen(window, {
      keydown: this.#keyDown,
      keyup: this.#keyUp,
      blur: this.#cancelAll,
      // Safari's own gestures zoom the page.
      gesturestart: prevent,
      gesturechange: prevent,
      gestureend: prevent,
    });
    listen(window.document, { visibilitychange: this.#cancelAll });
  }

  /** Whether input is passed on. A change forgets what is pressed, as the other side does. */
  set enabled(enabled) {
    if (enabled === this.#enabled) return;
    this.#enabled = enabled;
    this.#pressed.clear();
    this.#moved.clear();
    this.#keys.clear();
    this.#page.marks?.clear();
  }

  #isHeard() {
    if (!this.#enabled) this.#page.unheard?.();
    return this.#enabled;
  }

  #down(event) {
    event.preventDefault();
    if (!this.#isHeard()) return;
    const { currentTarget, pointerId, pointerType, clientX, clientY } = event;
    try {
      currentTarget.setPointerCapture(pointerId);
    } catch {
      // The pointer has gone already.
    }
    if (this.#pressed.size === 0) this.#toView = this.#page.mapping();
    if (['touch', 'pen'].includes(pointerType)) this.#page.marks?.press(pointerId, clientX, clientY);
    this.#sendPointer(event);
  }

  #move(event) {
    const { pointerId, clientX, clientY, button } = event;
    if (!this.#pressed.has(pointerId)) return;
    this.#page.marks?.move(pointerId, clientX, clientY);
    // A further mouse button comes as a move: none may get lost.
    if (button >= 0) {
      this.#sendPointer(event);
      return;
    }
    const message = this.#pointerMessage(event);
    this.#pressed.set(pointerId, message);
    this.#page.moved?.(message);
    if (this.#moved.size === 0) this.#page.soon(() => this.#flush());
    this.#moved.add(pointerId);
  }

  #up(event) {
    if (this.#pressed.has(event.pointerId)) this.#end(this.#pointerMessage(event));
  }

  #cancelAll({ timeStamp }) {
    for (const pointerId of this.#pressed.keys()) this.#cancel({ pointerId, timeStamp });
    this.#keys.clear();
  }

  #cancel({ pointerId, timeStamp }) {
    const last = this.#pressed.get(pointerId);
    if (last) this.#end({ ...last, type: 'pointercancel', button: 0, buttons: 0, timeStamp });
  }

  #end(message) {
    this.#send(message);
    this.#pressed.delete(message.pointerId);
    this.#page.marks?.release(message.pointerId);
  }

  #wheel(event) {
    event.preventDefault();
    if (!this.#isHeard()) return;
    const place = this.#page.mapping()(event.clientX, event.clientY);
    this.#send({ ...members(event, 'deltaX', 'deltaY', 'deltaMode'), ...place });
  }

  #keyDown(event) {
    const { key, ctrlKey, metaKey, altKey } = event;
    const { keys = [], repeatingKeys = [] } = this.#page.rules() ?? {};
    if (ctrlKey || metaKey || altKey || !keys.includes(key)) return;
    // The menu and what lies on the picture have keys of their own.
    if (event.defaultPrevented || event.target?.closest?.('#menu, button, #strip')) return;
    if (!this.#isHeard()) return;
    event.preventDefault();
    // A held `w` must not flicker.
    if (event.repeat && !repeatingKeys.includes(key)) return;
    this.#keys.add(event.code);
    this.#send(members(event, 'key', 'code'));
  }

  #keyUp(event) {
    if (this.#keys.delete(event.code)) this.#send(members(event, 'key', 'code'));
  }

  #pointerMessage(event) {
    return {
      ...members(event, 'pointerId', 'button', 'buttons'),
      pointerType: event.pointerType || 'mouse',
      ...this.#toView(event.clientX, event.clientY),
      frame: this.#page.frame(),
    };
  }

  #sendPointer(event) {
    const message = this.#pointerMessage(event);
    this.#send(message);
    this.#pressed.set(event.pointerId, message);
  }

  #send(message) {
    this.#flush();
    this.#page.send(message);
  }

  #flush() {
    for (const pointerId of this.#moved) this.#page.send(this.#pressed.get(pointerId));
    this.#moved.clear();
  }
}

function members(event, ...names) {
  const all = ['type', 'ctrlKey', 'shiftKey', 'altKey', 'metaKey', 'timeStamp', ...names];
  return Object.fromEntries(all.map((name) => [name, event[name]]));
}
