import assert from 'node:assert/strict';
import { describe, test } from 'node:test';
import { distance, length } from '../../../web-client/base/vectors.js';
import { withOrthogonalUp } from '../../../web-client/navigation/camera.js';
import { Prediction } from '../../../web-client/stage/prediction.js';
import { similarity } from '../../../web-client/stage/reach.js';
import { axes, distance as focusDistance, focalLength } from '../projection.js';
import { contextOf, gestures } from './gestures.js';

/** The server's arithmetic is the same but for rounding. */
const WITHIN = 1e-9;
/** What the page promises at the depth of what is touched is 2 pixels; as the server's arithmetic is known, it is exact. */
const WITHIN_PX = 0.01;
const VIEW = { width: 1180, height: 820, pixelRatio: 2 };
const CAMERA = { eye: [0, 0, 5], focus: [0, 0, 0], up: [0, 1, 0], center: [0, 0, 0], fov: 40 };
const HOME = { ...CAMERA, eye: [3, 0, 4] };
const NAVIGATION = {
  style: 'vrut', panSpeed: 1, zoomSpeed: 1, rotateSpeed: 1, keepUpright: true, turnAbout: 'center',
};
const STATE = {
  camera: CAMERA,
  scene: { bounds: { min: [-1, -1, -1], max: [1, 1, 1] }, seats: [] },
  navigation: NAVIGATION,
  views: { home: HOME },
};

function assertSamePose(actual, expected, what) {
  for (const member of ['eye', 'focus', 'up']) {
    const error = distance(actual[member], expected[member]);
    const said = `${what}: ${member} ${actual[member]} instead of ${expected[member]}`;
    assert.ok(error <= WITHIN * Math.max(1, length(expected[member])), said);
  }
}

// --- similarities of a picture, from its middle

const NONE = { scale: 1, x: 0, y: 0 };
const apply = ({ scale, x, y }, point) => [scale * point[0] + x, scale * point[1] + y];
const compose = (first, then) => {
  const [x, y] = apply(then, [first.x, first.y]);
  return { scale: first.scale * then.scale, x, y };
};
const apart = (a, b) => Math.hypot(a[0] - b[0], a[1] - b[1]);

function gridOf({ width, height }) {
  const places = [-0.5, -0.3, 0, 0.25, 0.5];
  return places.flatMap((x) => places.map((y) => [x * width, y * height]));
}

function looksTheSameWay(a, b) {
  const [before, after] = [axes(a), axes(b)];
  return Math.hypot(...['forward', 'up'].flatMap((axis) => before[axis].map((x, i) => x - after[axis][i]))) < 1e-9;
}

/**
 * What a message did to the picture, at the depth of what was touched; nothing where it turned the camera. A zoom tells
 * that depth: what was touched came nearer as the focus did. A pan does not, so that only its direction is checked here,
 * by the depth at which it is as long as `predicted`; the server's tests check the depth.
 */
function stepOf(before, after, view, predicted) {
  if (!looksTheSameWay(before, after)) return NONE;
  const { right, up, forward } = axes(before);
  const moved = after.eye.map((x, i) => x - before.eye[i]);
  const along = (axis) => axis.reduce((sum, x, i) => sum + x * moved[i], 0);
  const factor = focusDistance(before) / focusDistance(after);
  const pixels = focalLength(before, view);
  const aside = [-along(right) * pixels, along(up) * pixels];
  const isZoom = Math.abs(factor - 1) > 1e-9;
  const seen = Math.hypot(predicted.x, predicted.y);
  let depth = isZoom ? along(forward) / (1 - 1 / factor) : Math.hypot(...aside) / seen;
  if (!isZoom && seen < 1e-6) depth = focusDistance(before);
  const left = isZoom ? depth / factor : depth;
  return { scale: factor, x: aside[0] / left, y: aside[1] / left };
}

// --- the recorded gestures

/** A prediction that follows a gesture's messages, and frames after so many of them. */
class Follower {
  /** @param {boolean} knowsDepth whether it finds what is touched where the server does */
  constructor(gesture, knowsDepth) {
    const { view, messages, bounds, seat, navigation } = gesture;
    this.view = view;
    this.messages = messages;
    const camera = withOrthogonalUp(gesture.camera);
    this.cameras = [camera, ...gesture.cameras.map((pose) => ({ ...camera, ...pose }))];
    this.prediction = new Prediction(knowsDepth ? { surfaceAt: contextOf(gesture).surfaceAt } : {});
    const scene = { bounds, seats: seat ? [seat] : [] };
    this.prediction.follow({ ...STATE, camera, scene, navigation }, true);
    this.draw(0);
  }

  send(count) {
    this.prediction.sent({ ...this.messages[count - 1], id: count });
  }

  draw(count) {
    this.prediction.drawn({ handled: count, camera: this.cameras[count], view: this.view });
  }

  /** What a frame of so many messages is moved by. */
  moveOf(shown) {
    return similarity(this.cameras[shown], this.prediction.camera, this.view) ?? NONE;
  }
}

/** What each message does to the picture before it. */
function stepsOf(gesture) {
  const follower = new Follower(gesture, false);
  return gesture.messages.map((_, count) => {
    follower.send(count + 1);
    const predicted = follower.moveOf(count);
    follower.draw(count + 1);
    return stepOf(follower.cameras[count], follower.cameras[count + 1], gesture.view, predicted);
  });
}

for (const gesture of gestures) {
  const count = gesture.messages.length;
  describe(gesture.name, () => {
    test('the camera is the one that the server comes to, however late its frames are', () => {
      for (const late of [1, 2, 3, 5, 1000]) {
        const follower = new Follower(gesture, true);
        for (let now = 1; now <= count; now += 1) {
          follower.send(now);
          if (now > late) follower.draw(now - late);
          assertSamePose(follower.prediction.camera, follower.cameras[now], `message ${now}, frames ${late} late`);
        }
      }
    });

    test('without depth, what is touched lies where the fingers are', () => {
      const steps = stepsOf(gesture);
      for (let shown = 0; shown < count; shown += 1) {
        const follower = new Follower(gesture, false);
        for (let now = 1; now <= shown; now += 1) follower.send(now);
        follower.draw(shown);
        let expected = NONE;
        for (let now = shown + 1; now <= count; now += 1) {
          follower.send(now);
          if (!looksTheSameWay(follower.cameras[now - 1], follower.cameras[now])) break;
          expected = compose(expected, steps[now - 1]);
          for (const place of gridOf(gesture.view)) {
            const seen = [(place[0] - expected.x) / expected.scale, (place[1] - expected.y) / expected.scale];
            const error = apart(apply(follower.moveOf(shown), seen), place);
            assert.ok(error <= WITHIN_PX, `message ${now} after a frame of ${shown}: ${error} pixels beside ${place}`);
          }
        }
      }
    });
  });
}

test('the gestures are no empty test: pictures are moved far, and by turns not at all', () => {
  const farthest = (name) => {
    const gesture = gestures.find((candidate) => candidate.name === name);
    const follower = new Follower(gesture, false);
    return Math.max(...gesture.messages.map((_, i) => {
      follower.send(i + 1);
      return Math.max(...gridOf(gesture.view).map((place) => apart(apply(follower.moveOf(0), place), place)));
    }));
  };
  for (const name of ['pan-and-pinch.json', 'right-drag.json', 'wheel.json', 'middle-drag.json']) {
    assert.ok(farthest(name) > 50, name);
  }
  assert.equal(farthest('turn.json'), 0);
});

// --- corrections

const finger = (what, pointerId, x, y) => ({
  type: `pointer${what}`, pointerId, pointerType: 'touch', x, y, button: what === 'move' ? -1 : 0, buttons: what === 'up' ? 0 : 1,
});

function setUp({ surfaceAt } = {}) {
  const page = { id: 0, ms: 0 };
  const prediction = new Prediction({ surfaceAt, clock: () => page.ms });
  page.prediction = prediction;
  page.follow = (members = {}, steers = true) => prediction.follow({ ...STATE, ...members }, steers);
  page.draw = (handled, members) => prediction.drawn({ handled, camera: CAMERA, view: VIEW, ...members });
  page.send = (...messages) => {
    for (const message of messages) {
      page.id += 1;
      prediction.sent({ ...message, id: page.id });
    }
  };
  page.pan = () => page.send(finger('down', 1, 100, 100), finger('down', 2, 300, 100), finger('move', 1, 120, 110), finger('move', 2, 320, 110));
  page.follow();
  page.draw(0);
  return page;
}

function assertMoved(page, { scale, x, y }, camera = CAMERA) {
  const moved = similarity(camera, page.prediction.camera, VIEW);
  const error = Math.hypot(moved.scale - scale, moved.x - x, moved.y - y);
  assert.ok(error < 1e-6, JSON.stringify(moved));
}

const PANNED = { scale: 1, x: 20, y: 10 };

test('a pan moves the picture as far as the fingers went', () => {
  const page = setUp();
  page.pan();
  assertMoved(page, PANNED);
});

test('a move counts before it is sent', () => {
  const page = setUp();
  page.send(finger('down', 1, 100, 100), finger('down', 2, 300, 100));
  page.prediction.moved(finger('move', 1, 120, 110));
  page.prediction.moved(finger('move', 2, 320, 110));
  assertMoved(page, PANNED);
  page.send(finger('move', 1, 120, 110), finger('move', 2, 320, 110));
  assertMoved(page, PANNED);
});

test('before the first frame there is no camera, and what came before it is left to the next ones', () => {
  const page = setUp();
  page.prediction.forget();
  assert.equal(page.prediction.camera, null);
  page.pan();
  page.draw(1);
  assertMoved(page, NONE);
});

test('who does not steer sees what the state says', () => {
  const page = setUp();
  page.follow({ camera: HOME }, false);
  page.pan();
  assert.deepEqual(page.prediction.camera, HOME);
});

test('who loses control has nothing pressed any more', () => {
  const page = setUp();
  page.pan();
  page.follow({}, false);
  page.follow();
  page.draw(page.id);
  page.send(finger('move', 1, 200, 200));
  assertMoved(page, NONE);
});

test('so has a lost connection', () => {
  const page = setUp();
  page.pan();
  page.prediction.forget();
  page.send(finger('move', 1, 200, 200));
  page.draw(page.id);
  page.send(finger('move', 1, 300, 200));
  assertMoved(page, NONE);
});

test('from a camera that others have moved, the fingers go on', () => {
  const page = setUp();
  page.pan();
  const others = { ...CAMERA, eye: [0, 0, 8] };
  page.follow({ camera: others });
  page.draw(page.id, { camera: others });
  assertMoved(page, NONE, others);
  page.send(finger('move', 1, 130, 110), finger('move', 2, 330, 110));
  assertMoved(page, { scale: 1, x: 10, y: 0 }, others);
});

test('a view of another size begins anew', () => {
  const page = setUp();
  page.pan();
  page.draw(2, { view: { ...VIEW, width: 820, height: 1180 } });
  assertMoved(page, NONE);
});

test('where the server finds the touched surface deeper, later moves go as much farther', () => {
  // Here it lies at z = 1, four before the eye. For the server, which does not touch it, it is at the focus.
  const page = setUp({ surfaceAt: (_, { x, y }) => [(x / VIEW.width - 0.5) * 0.1, (0.5 - y / VIEW.height) * 0.1, 1] });
  page.send(finger('down', 1, 500, 400), finger('down', 2, 700, 400), finger('move', 1, 520, 400), finger('move', 2, 720, 400));
  const perPixel = 2 * 5 * Math.tan(Math.PI / 9) / VIEW.height;
  const panned = (pixels) => ({ ...CAMERA, eye: [-pixels * perPixel, 0, 5], focus: [-pixels * perPixel, 0, 0] });
  assert.ok(Math.abs(page.prediction.camera.eye[0] / panned(20).eye[0] - 0.8) < 1e-9);
  page.draw(page.id, { camera: panned(20) });
  page.send(finger('move', 1, 620, 400), finger('move', 2, 820, 400));
  assertSamePose(page.prediction.camera, panned(120), 'after 100 pixels more');
});

test('the server hears which point a drag, or the wheel, is about', () => {
  const touched = [0.1, 0.2, 1];
  const page = setUp({ surfaceAt: () => touched });
  const say = (message) => {
    const told = page.prediction.withTouched(message);
    page.send(told);
    return told.touched;
  };
  assert.equal(say(finger('down', 1, 500, 400)), undefined);
  assert.equal(say(finger('move', 1, 510, 400)), undefined, 'a turn about the centre');
  assert.equal(say(finger('down', 2, 700, 400)), undefined);
  assert.deepEqual(say(finger('move', 1, 520, 400)), touched);
  assert.equal(say(finger('move', 2, 720, 400)), undefined, 'it is known by now');
  assert.equal(say(finger('up', 1, 520, 400)), undefined);
  assert.equal(say(finger('up', 2, 720, 400)), undefined);
  const wheel = { type: 'wheel', x: 500, y: 400, deltaX: 0, deltaY: -100, deltaMode: 0 };
  assert.deepEqual(say(wheel), touched);
  assert.equal(wheel.touched, undefined, 'what was asked for stays as it is');
});

test('where nothing is touched, or it is not known, the server finds out', () => {
  for (const surfaceAt of [() => null, undefined]) {
    const page = setUp({ surfaceAt });
    page.send(finger('down', 1, 500, 400), finger('down', 2, 700, 400));
    assert.equal(page.prediction.withTouched(finger('move', 1, 520, 400)).touched, undefined);
  }
});

test('a patch of this page makes drags begin anew', () => {
  const page = setUp();
  page.send(finger('down', 1, 500, 400), finger('down', 2, 700, 400), finger('move', 2, 740, 400));
  page.send({ type: 'patch', patch: { camera: { node: 6 } } });
  page.draw(page.id);
  page.send(finger('move', 2, 860, 400));
  assert.ok(Math.abs(similarity(CAMERA, page.prediction.camera, VIEW).scale - 360 / 240) < 1e-9);
});

test('between frames it is where the state says, as in a flight of others', () => {
  const page = setUp();
  const flown = { ...CAMERA, eye: [1, 0, 5] };
  page.follow({ camera: flown });
  assert.equal(page.prediction.camera, flown);
});

test('Home is known', () => {
  const page = setUp();
  page.send({ type: 'keydown', key: 'Home', code: 'Home' });
  assertSamePose(page.prediction.camera, HOME, 'home');
});

test('messages that bring no frame do not grow it', () => {
  const page = setUp();
  page.send(finger('down', 1, 100, 100));
  for (let i = 0; i < 2000; i += 1) page.send(finger('move', 9, i, i));
  page.send(finger('down', 2, 300, 100), finger('move', 1, 120, 110), finger('move', 2, 320, 110));
  assertMoved(page, PANNED);
});

describe('a flight', () => {
  const fly = { type: 'fly', keyframes: [{ at: 600, camera: { eye: HOME.eye } }] };

  test('begins at once, and goes on while frames lag', () => {
    const page = setUp();
    page.send(fly);
    assert.ok(page.prediction.flies);
    page.ms = 300;
    const middle = page.prediction.camera;
    assert.ok(middle.eye[0] > 0.5 && middle.eye[0] < 2.5, `${middle.eye}`);
    page.draw(page.id, { camera: { ...CAMERA, eye: [0.1, 0, 5] } });
    page.follow({ camera: { ...CAMERA, eye: [0.2, 0, 5] } });
    assert.deepEqual(page.prediction.camera, middle);
    page.ms = 700;
    assertSamePose(page.prediction.camera, HOME, 'at its end');
    assert.ok(page.prediction.flies, 'until a frame is there, too');
    page.follow({ camera: HOME });
    page.draw(page.id, { camera: HOME });
    assert.ok(!page.prediction.flies);
    assert.equal(page.prediction.camera, HOME);
  });

  test('is ended by a finger, where it is', () => {
    const page = setUp();
    page.send(fly);
    page.ms = 300;
    const middle = page.prediction.camera;
    page.send(finger('down', 1, 500, 400));
    page.ms = 500;
    assertSamePose(page.prediction.camera, middle, 'stopped');
    // By a frame from before that, it does not go back.
    page.draw(1, { camera: { ...CAMERA, eye: [0.3, 0, 5] } });
    assertSamePose(page.prediction.camera, middle, 'stopped');
  });

  test('that something else has ended is given up', () => {
    const page = setUp();
    page.send(fly);
    page.ms = 3000;
    page.follow({ camera: CAMERA });
    page.draw(page.id);
    assert.ok(!page.prediction.flies);
    assert.deepEqual(page.prediction.camera, CAMERA);
  });
});
