/** Puts others in the place of globals; what it returns undoes that. */
export function replaceGlobals(others) {
  const before = Object.keys(others).map((name) => [name, Object.getOwnPropertyDescriptor(globalThis, name)]);
  for (const [name, value] of Object.entries(others)) {
    Object.defineProperty(globalThis, name, { value, configurable: true, writable: true });
  }
  return () => {
    for (const [name, property] of before) {
      if (property) Object.defineProperty(globalThis, name, property);
      else delete globalThis[name];
    }
  };
}

/** Time that passes only when a test says so. */
export class FakeClock {
  #now = 0;
  #timers = new Map();
  #lastTimer = 0;

  setTimeout = (action, ms) => {
    this.#lastTimer += 1;
    this.#timers.set(this.#lastTimer, { at: this.#now + ms, action });
    return this.#lastTimer;
  };

  clearTimeout = (timer) => this.#timers.delete(timer);

  /** Milliseconds until the next timer; undefined where none is set. */
  get next() {
    const times = [...this.#timers.values()].map(({ at }) => at - this.#now);
    return times.length > 0 ? Math.min(...times) : undefined;
  }

  advance(ms) {
    this.#now += ms;
    for (const [timer, { at, action }] of [...this.#timers]) {
      if (at <= this.#now && this.#timers.delete(timer)) action();
    }
  }
}

/** A WebSocket whose other end is the test. */
export class FakeSocket {
  closed = false;
  #sent = [];

  constructor(url, protocol) {
    this.url = url;
    this.protocol = protocol;
  }

  send(text) {
    this.#sent.push(JSON.parse(text));
  }

  close() {
    this.closed = true;
    this.onclose?.({ code: 1006, reason: '' });
  }

  /** What the page has sent since the last call. */
  take() {
    return this.#sent.splice(0);
  }

  opens() {
    this.onopen();
  }

  says(message) {
    this.onmessage({ data: typeof message === 'string' ? message : JSON.stringify(message) });
  }

  sendsFrame(jpeg) {
    this.onmessage({ data: jpeg });
  }

  ends(code, reason = '') {
    this.onclose({ code, reason });
  }
}

/** An event as the browser would dispatch it, with any members. */
export function fakeEvent(type, members = {}) {
  return Object.assign(new Event(type, { cancelable: true }), members);
}

/** A window with its document, and display frames that come when a test says so. */
export class FakeWindow extends EventTarget {
  document = Object.assign(new EventTarget(), { visibilityState: 'visible' });
  devicePixelRatio = 1;
  #frames = [];
  #queries = [];
  #observers = [];

  requestAnimationFrame(action) {
    this.#frames.push(action);
  }

  displayFrame() {
    const frames = this.#frames.splice(0);
    for (const action of frames) action();
    return frames.length;
  }

  matchMedia(query) {
    const list = Object.assign(new EventTarget(), { query });
    this.#queries.push(list);
    return list;
  }

  setPixelRatio(ratio) {
    this.devicePixelRatio = ratio;
    this.#queries.at(-1).dispatchEvent(new Event('change'));
  }

  ResizeObserver = ((observers) =>
    class {
      #tell;

      constructor(tell) {
        this.#tell = tell;
      }

      observe() {
        observers.push(this.#tell);
      }
    })(this.#observers);

  elementResized() {
    for (const tell of this.#observers) tell();
  }
}

/** As much of an element as holds words and other elements. */
export class FakeElement {
  children = [];
  parent = null;
  /** How often its own words were written. */
  writes = 0;
  #text = '';

  constructor(tag) {
    this.tag = tag;
  }

  get firstChild() {
    return this.children[0];
  }

  get lastElementChild() {
    return this.children.at(-1);
  }

  get textContent() {
    return this.#text + this.children.map(({ textContent }) => textContent).join('');
  }

  set textContent(text) {
    this.writes += 1;
    this.#text = text;
    this.children = [];
  }

  append(...children) {
    for (const child of children) {
      if (typeof child === 'string') this.#text += child;
      else this.appendChild(child);
    }
  }

  appendChild(child) {
    child.parent = this;
    this.children.push(child);
    return child;
  }

  replaceChildren(...children) {
    this.textContent = '';
    this.append(...children);
  }

  remove() {
    this.parent.children = this.parent.children.filter((child) => child !== this);
  }

  /** @param {string} tag the first child of this tag */
  querySelector(tag) {
    return this.children.find((child) => child.tag === tag) ?? null;
  }
}

export const fakeDocument = { createElement: (tag) => new FakeElement(tag) };

/** The browser's storage; one that is switched off refuses everything. */
export class FakeStorage {
  items = new Map();
  isOff = false;

  getItem(name) {
    this.#refuse();
    return this.items.get(name) ?? null;
  }

  setItem(name, value) {
    this.#refuse();
    this.items.set(name, String(value));
  }

  removeItem(name) {
    this.#refuse();
    this.items.delete(name);
  }

  #refuse() {
    if (this.isOff) throw new Error('SecurityError');
  }
}

/** The smallest file that has the form of a frame: JFIF, the header as a comment, end of image. */
export function jpegWith(header) {
  const text = typeof header === 'string' ? header : JSON.stringify(header);
  return segments(JFIF, comment(new TextEncoder().encode(text)), [0xff, 0xd9]);
}

export const JFIF = [0xff, 0xe0, 0, 16, 0x4a, 0x46, 0x49, 0x46, 0, 1, 1, 0, 0, 1, 0, 1, 0, 0];

export function comment(bytes) {
  const length = bytes.length + 2;
  return [0xff, 0xfe, length >> 8, length & 0xff, ...bytes];
}

export function segments(...parts) {
  return Uint8Array.from([0xff, 0xd8, ...parts.flat()]).buffer;
}
