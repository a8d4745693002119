const MOST_SAMPLES = 100;
const WINDOW_MS = 2000;
/** A message without effect is covered by a later frame: that is no latency. */
const LONGEST_MS = 10_000;
/** Presses and releases only begin and end what moves the picture. */
const MOVING = new Set(['pointermove', 'wheel', 'keydown']);

/** What a user feels: ms from a hand's move to its picture, pictures a second. */
export class Meter {
  /** When what no frame covers yet was sent, by id. */
  #waiting = new Map();
  #latencies = [];
  #frames = [];

  sent(type, id, now) {
    if (MOVING.has(type)) this.#waiting.set(id, now);
  }

  /** A frame of so many bytes covers the messages up to `handled`. */
  drawn(handled, bytes, now) {
    for (const [id, at] of this.#waiting) {
      if (id > handled) continue;
      this.#waiting.delete(id);
      if (now - at <= LONGEST_MS) this.#latencies.push(now - at);
    }
    this.#latencies = this.#latencies.slice(-MOST_SAMPLES);
    this.#frames = [...this.#recentFrames(now), { at: now, bytes }];
  }

  /** How late pictures are; what was sent a second before the rest had no effect. */
  lateMs(now) {
    let since = now;
    for (const at of [...this.#waiting.values()].reverse()) if (since - at < 1000) since = at;
    return now - since;
  }

  forgetSent() {
    this.#waiting.clear();
  }

  /** No percentiles before the first latency. */
  read(now) {
    const perSecond = 1000 / WINDOW_MS;
    const frames = this.#recentFrames(now);
    const sorted = [...this.#latencies].sort((a, b) => a - b);
    // By nearest rank.
    const percentile = (percent) => sorted[Math.ceil((sorted.length * percent) / 100) - 1];
    return {
      p50: percentile(50),
      p95: percentile(95),
      framesPerSecond: frames.length * perSecond,
      bytesPerSecond: frames.reduce((sum, { bytes }) => sum + bytes, 0) * perSecond,
    };
  }

  #recentFrames(now) {
    return this.#frames.filter(({ at }) => now - at < WINDOW_MS);
  }
}
