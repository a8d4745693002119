import { readFileSync, readdirSync } from 'node:fs';
import { Input } from '../../../web-client/stage/input.js';
import { viewMapping } from '../../../web-client/stage/picture.js';
import { FakeWindow, fakeEvent } from './fakes.js';
import { INPUT_RULES } from '../input-rules.js';

const FOLDER = new URL('../../data/gestures/', import.meta.url);
const ON_WINDOW = new Set(['keydown', 'keyup', 'blur']);
const NO_KEYS = { ctrlKey: false, shiftKey: false, altKey: false, metaKey: false };
const MS_BETWEEN_EVENTS = 4;

/**
 * The gestures of tests/data/gestures, which the server's tests read, too: in a `view` that is shown in a `box` of the
 * window, from `camera`, a browser dispatches `events`, of which `messages` are made, and after each of these the
 * camera is one of `cameras`. Within the radius of a `seat` from its eye drags look around.
 */
export const gestures = readdirSync(FOLDER).map((name) => ({ name, ...JSON.parse(readFileSync(new URL(name, FOLDER))) }));

/**
 * What the page sends of events; what a gesture's events leave out is as browsers have it.
 *
 * @param {{box: object, view: object, events: (object|string)[]}} gesture
 * @returns {object[]} messages
 */
export function messagesOf({ box, view, events }) {
  const window = new FakeWindow();
  const element = Object.assign(new EventTarget(), { setPointerCapture() {} });
  const sent = [];
  new Input(element, {
    rules: () => INPUT_RULES,
    window,
    send: (message) => sent.push(message),
    mapping: () => viewMapping(box, view),
    frame: () => undefined,
    soon: (action) => window.requestAnimationFrame(action),
  });
  let timeStamp = 0;
  for (const event of events) {
    timeStamp += MS_BETWEEN_EVENTS;
    if (event === 'display frame') window.displayFrame();
    else (ON_WINDOW.has(event.type) ? window : element).dispatchEvent(browserEvent({ timeStamp, ...event }));
  }
  return JSON.parse(JSON.stringify(sent));
}

function browserEvent({ type, timeStamp, ...members }) {
  const event = fakeEvent(type, { ...NO_KEYS, ...members });
  return Object.defineProperty(event, 'timeStamp', { value: timeStamp });
}
