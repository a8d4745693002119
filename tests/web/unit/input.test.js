import assert from 'node:assert/strict';
import { describe, test } from 'node:test';
import { Input } from '../../../web-client/stage/input.js';
import { FakeWindow, fakeEvent } from './fakes.js';
import { gestures, messagesOf } from './gestures.js';
import { INPUT_RULES } from '../input-rules.js';

const NO_KEYS = { ctrlKey: false, shiftKey: false, altKey: false, metaKey: false };

function setUp() {
  const window = new FakeWindow();
  const captured = [];
  const element = Object.assign(new EventTarget(), { setPointerCapture: (id) => captured.push(id) });
  const page = { window, element, captured, sent: [], marked: [], unheard: 0, frame: 12, scale: 1 };
  const mark = (what) => (...told) => page.marked.push([what, ...told]);
  page.input = new Input(element, {
    rules: () => INPUT_RULES,
    window,
    send: (message) => page.sent.push(message),
    mapping: () => {
      const { scale } = page;
      return (x, y) => ({ x: x * scale, y: y * scale });
    },
    frame: () => page.frame,
    soon: (action) => window.requestAnimationFrame(action),
    unheard: () => (page.unheard += 1),
    marks: { press: mark('press'), move: mark('move'), release: mark('release'), clear: mark('clear') },
  });
  page.take = () => page.sent.splice(0);
  page.on = (type, members) => {
    const event = fakeEvent(type, { ...NO_KEYS, ...members });
    element.dispatchEvent(event);
    return event;
  };
  page.pointer = (type, members) =>
    page.on(type, { pointerId: 1, pointerType: 'touch', clientX: 0, clientY: 0, button: 0, buttons: 1, ...members });
  page.move = (clientX, clientY, members) => page.pointer('pointermove', { clientX, clientY, button: -1, ...members });
  page.key = (type, key, { target, ...members } = {}) => {
    const event = fakeEvent(type, { ...NO_KEYS, key, code: `code of ${key}`, ...members });
    if (target) Object.defineProperty(event, 'target', { value: target });
    window.dispatchEvent(event);
    return event;
  };
  return page;
}

const places = (messages) => messages.map(({ type, pointerId, x, y }) => [type, pointerId, x, y]);

describe('pointers', () => {
  test('are passed on as they are', () => {
    const page = setUp();
    const event = page.pointer('pointerdown', { clientX: 10.5, clientY: 20, shiftKey: true });
    const { timeStamp } = event;
    assert.deepEqual(page.take(), [
      {
        type: 'pointerdown', pointerId: 1, pointerType: 'touch', x: 10.5, y: 20, button: 0, buttons: 1,
        ...NO_KEYS, shiftKey: true, timeStamp, frame: 12,
      },
    ]);
    assert.deepEqual(page.captured, [1]);
    assert.ok(event.defaultPrevented);
  });

  test('a capture that fails is no hindrance', () => {
    const page = setUp();
    page.element.setPointerCapture = () => {
      throw new Error('no such pointer');
    };
    page.pointer('pointerdown');
    assert.equal(page.take().length, 1);
  });

  test('moves are thinned to the last of each pointer in a display frame', () => {
    const page = setUp();
    page.pointer('pointerdown');
    page.pointer('pointerdown', { pointerId: 2 });
    page.take();
    page.move(1, 1);
    page.move(5, 5, { pointerId: 2 });
    page.move(2, 2);
    page.move(3, 3);
    assert.deepEqual(page.take(), []);
    assert.equal(page.window.displayFrame(), 1);
    assert.deepEqual(places(page.take()), [['pointermove', 1, 3, 3], ['pointermove', 2, 5, 5]]);
    assert.equal(page.window.displayFrame(), 0);
    page.move(4, 4);
    page.window.displayFrame();
    assert.deepEqual(places(page.take()), [['pointermove', 1, 4, 4]]);
  });

  for (const end of ['pointerup', 'pointercancel']) {
    test(`the last move goes out before a ${end}`, () => {
      const page = setUp();
      page.pointer('pointerdown');
      page.take();
      page.move(1, 1);
      page.move(2, 2);
      page.pointer(end, { clientX: 2, clientY: 2, buttons: 0 });
      assert.deepEqual(places(page.take()), [['pointermove', 1, 2, 2], [end, 1, 2, 2]]);
      page.window.displayFrame();
      assert.deepEqual(page.take(), []);
    });
  }

  test('and before another pointer comes down', () => {
    const page = setUp();
    page.pointer('pointerdown');
    page.take();
    page.move(1, 1);
    page.pointer('pointerdown', { pointerId: 2 });
    assert.deepEqual(page.take().map(({ type }) => type), ['pointermove', 'pointerdown']);
  });

  test('a further mouse button is never thinned away', () => {
    const page = setUp();
    const mouse = { pointerType: 'mouse' };
    page.pointer('pointerdown', mouse);
    page.take();
    page.move(1, 1, { ...mouse, buttons: 1 });
    page.move(2, 2, { ...mouse, button: 2, buttons: 3 });
    page.move(3, 3, { ...mouse, button: 2, buttons: 1 });
    const buttons = page.take().map(({ type, button, buttons: held }) => [type, button, held]);
    assert.deepEqual(buttons, [['pointermove', -1, 1], ['pointermove', 2, 3], ['pointermove', 2, 1]]);
  });

  test('a mouse that only passes by is not told of', () => {
    const page = setUp();
    page.move(1, 1, { pointerType: 'mouse', buttons: 0 });
    page.pointer('pointerup', { pointerType: 'mouse' });
    page.window.displayFrame();
    assert.deepEqual(page.take(), []);
  });

  test('a kind of pointer that the browser does not know counts as a mouse', () => {
    const page = setUp();
    page.pointer('pointerdown', { pointerType: '' });
    assert.equal(page.take()[0].pointerType, 'mouse');
  });

  test('a lost capture cancels, where the last move was', () => {
    const page = setUp();
    page.pointer('pointerdown');
    page.move(7, 8);
    page.take();
    page.on('lostpointercapture', { pointerId: 1 });
    assert.deepEqual(places(page.take()), [['pointermove', 1, 7, 8], ['pointercancel', 1, 7, 8]]);
    page.move(9, 9);
    page.pointer('pointerup');
    page.window.displayFrame();
    assert.deepEqual(page.take(), []);
  });

  test('the loss of capture that follows every end does not', () => {
    const page = setUp();
    page.pointer('pointerdown');
    page.pointer('pointerup', { buttons: 0 });
    page.take();
    page.on('lostpointercapture', { pointerId: 1 });
    assert.deepEqual(page.take(), []);
  });

  test('a window that loses the focus, or is hidden, cancels every pressed pointer', () => {
    const page = setUp();
    const cancelled = () => page.take().map(({ type, pointerId, buttons }) => [type, pointerId, buttons]);
    page.pointer('pointerdown');
    page.pointer('pointerdown', { pointerId: 2 });
    page.take();
    page.window.dispatchEvent(fakeEvent('blur'));
    assert.deepEqual(cancelled(), [['pointercancel', 1, 0], ['pointercancel', 2, 0]]);

    page.pointer('pointerdown', { pointerId: 3 });
    page.take();
    page.window.document.dispatchEvent(fakeEvent('visibilitychange'));
    assert.deepEqual(cancelled(), [['pointercancel', 3, 0]]);
  });

  test('a gesture keeps the coordinates that it began with', () => {
    const page = setUp();
    page.pointer('pointerdown', { clientX: 10 });
    page.scale = 2;
    page.move(20, 0);
    page.pointer('pointerdown', { pointerId: 2, clientX: 30 });
    page.pointer('pointerup', { clientX: 20 });
    page.pointer('pointerup', { pointerId: 2, clientX: 30 });
    page.pointer('pointerdown', { clientX: 10 });
    assert.deepEqual(page.take().map(({ x }) => x), [10, 20, 30, 20, 30, 20]);
  });

  test('while input is off nothing is sent, and what was pressed is forgotten', () => {
    const page = setUp();
    page.pointer('pointerdown');
    page.key('keydown', 'ArrowUp');
    page.take();
    page.move(1, 1);
    page.input.enabled = false;
    page.window.displayFrame();
    page.move(2, 2);
    page.pointer('pointerdown', { pointerId: 2 });
    assert.equal(page.unheard, 1);
    page.on('wheel', { clientX: 0, clientY: 0, deltaX: 0, deltaY: 1, deltaMode: 0 });
    assert.equal(page.unheard, 2);
    page.key('keydown', 'w');
    page.key('keydown', 'x');
    page.key('keydown', 'w', { ctrlKey: true });
    assert.equal(page.unheard, 3);
    page.input.enabled = true;
    page.move(3, 3);
    page.pointer('pointerup');
    page.key('keyup', 'ArrowUp');
    page.window.displayFrame();
    assert.deepEqual(page.take(), []);
  });
});

test('the wheel is passed on behind the moves before it, and does not scroll', () => {
  const page = setUp();
  page.pointer('pointerdown');
  page.take();
  page.move(1, 1);
  const event = page.on('wheel', { clientX: 3, clientY: 4, deltaX: 0, deltaY: -3, deltaMode: 1, ctrlKey: true });
  assert.deepEqual(page.take().at(-1), {
    type: 'wheel', x: 3, y: 4, deltaX: 0, deltaY: -3, deltaMode: 1, ...NO_KEYS, ctrlKey: true, timeStamp: event.timeStamp,
  });
  assert.ok(event.defaultPrevented);
});

test('there is no context menu', () => {
  assert.ok(setUp().on('contextmenu').defaultPrevented);
});

test('no gesture of the browser zooms the page', () => {
  for (const type of ['gesturestart', 'gesturechange', 'gestureend']) {
    const event = fakeEvent(type);
    setUp().window.dispatchEvent(event);
    assert.ok(event.defaultPrevented, type);
  }
});

describe('a touched view', () => {
  const pressed = (pointerType) => {
    const page = setUp();
    page.pointer('pointerdown', { pointerType, clientX: 10, clientY: 20 });
    return page;
  };

  test('marks fingers and pens, not the mouse, in the same event as it hears of them', () => {
    for (const pointerType of ['touch', 'pen']) {
      const page = pressed(pointerType);
      page.scale = 2;
      page.move(11, 21, { pointerType });
      assert.deepEqual(page.marked, [['press', 1, 10, 20], ['move', 1, 11, 21]]);
    }
    assert.deepEqual(pressed('mouse').marked, []);
  });

  const ends = {
    'is lifted': (page) => page.pointer('pointerup', { buttons: 0 }),
    'is cancelled': (page) => page.pointer('pointercancel', { buttons: 0 }),
    'is lost': (page) => page.on('lostpointercapture', { pointerId: 1 }),
    'was on a window that lost the focus': (page) => page.window.dispatchEvent(fakeEvent('blur')),
  };
  for (const [what, end] of Object.entries(ends)) {
    test(`marks no finger that ${what}`, () => {
      const page = pressed('touch');
      end(page);
      page.move(50, 50);
      assert.deepEqual(page.marked.slice(1), [['release', 1]]);
    });
  }

  test('marks none while input is off', () => {
    const page = pressed('touch');
    page.input.enabled = false;
    page.pointer('pointerdown', { pointerId: 2 });
    assert.deepEqual(page.marked.slice(1), [['clear']]);
  });
});

for (const gesture of gestures) {
  test(`of the events of ${gesture.name} the messages are made that the server's tests read`, () => {
    assert.deepEqual(messagesOf(gesture), gesture.messages);
  });
}

describe('keys', () => {
  test('of the table are passed on and kept from the page', () => {
    const page = setUp();
    for (const key of ['ArrowLeft', '+', 'f', 'Home', 'w', 's', 'Escape', '1', '3']) {
      const down = page.key('keydown', key);
      assert.ok(down.defaultPrevented, key);
      page.key('keyup', key);
      assert.deepEqual(page.take().map((sent) => [sent.type, sent.key, sent.code]), [
        ['keydown', key, `code of ${key}`],
        ['keyup', key, `code of ${key}`],
      ]);
    }
  });

  test('others, and the shortcuts of the browser, are not', () => {
    const page = setUp();
    const events = [
      page.key('keydown', 'Tab'),
      page.key('keydown', 'F5'),
      page.key('keydown', 'w', { ctrlKey: true }),
      page.key('keydown', 's', { metaKey: true }),
      page.key('keydown', 'ArrowLeft', { altKey: true }),
      page.key('keyup', 'w'),
    ];
    assert.deepEqual(page.take(), []);
    assert.ok(events.every(({ defaultPrevented }) => !defaultPrevented));
  });

  test('of a button or the menu stay there', () => {
    const page = setUp();
    const inside = (what) => ({ closest: (selectors) => (selectors.split(', ').includes(what) ? {} : null) });
    for (const what of ['#menu', 'button']) {
      assert.equal(page.key('keydown', 'w', { target: inside(what) }).defaultPrevented, false, what);
      page.key('keyup', 'w', { target: inside(what) });
    }
    assert.deepEqual(page.take(), []);
    page.key('keydown', 'w', { target: inside('main') });
    assert.equal(page.take().length, 1);
  });

  test('that are held go on where that makes sense', () => {
    const page = setUp();
    page.key('keydown', 'ArrowLeft', { repeat: true });
    page.key('keydown', 'w', { repeat: true });
    assert.deepEqual(page.take().map(({ key }) => key), ['ArrowLeft']);
  });
});
