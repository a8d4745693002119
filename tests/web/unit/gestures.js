import { readFileSync, readdirSync } from 'node:fs';
import { add, cross, distance, dot, scale, subtract } from '../../../web-client/base/vectors.js';
import { directionThrough } from '../../../web-client/navigation/camera.js';
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

/** The triangle across the bounds in the scene of the server's test, seen from its front only. */
function hitOf({ min, max }, origin, direction) {
  const corners = [min, [max[0], min[1], max[2]], max];
  const edges = corners.map((corner, i) => subtract(corners[(i + 1) % 3], corner));
  const normal = cross(edges[0], edges[1]);
  if (dot(normal, direction) >= 0) return null;
  const away = dot(normal, subtract(min, origin)) / dot(normal, direction);
  const point = add(origin, scale(direction, away));
  const isInside = corners.every((corner, i) => dot(cross(edges[i], subtract(point, corner)), normal) >= 0);
  return away > 0 && isInside ? point : null;
}

/** What a gesture's moves depend on. */
export function contextOf({ view: { width, height }, bounds, navigation, seat }) {
  const { turnAbout, ...rest } = navigation;
  return {
    ...rest,
    width,
    height,
    radius: distance(bounds.min, bounds.max) / 2,
    turnAboutTouched: turnAbout === 'touched',
    surfaceAt: (camera, { x, y }) =>
      hitOf(bounds, camera.eye, directionThrough(camera, width / height, 2 * x / width - 1, 2 * y / height - 1)),
    looksAroundFrom: (eye) => seat !== undefined && distance(seat.eye, eye) <= seat.radius,
  };
}

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
