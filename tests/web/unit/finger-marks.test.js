import assert from 'node:assert/strict';
import { test } from 'node:test';
import { FingerMarks } from '../../../web-client/stage/finger-marks.js';

function setUp() {
  const elements = [];
  const createElement = () => {
    const classes = new Set();
    return {
      append() {},
      style: {},
      classList: { add: (name) => classes.add(name), remove: (name) => classes.delete(name) },
      get isPressed() {
        return classes.has('pressed');
      },
    };
  };
  globalThis.document = { createElement };
  const container = {
    appendChild(element) {
      elements.push(element);
      return element;
    },
    querySelector(selectors) {
      assert.equal(selectors, ':not(.pressed)');
      return elements.find(({ isPressed }) => !isPressed) ?? null;
    },
  };
  const marks = new FingerMarks(container);
  const shown = () => elements.filter(({ isPressed }) => isPressed).map(({ style }) => style.transform);
  return { marks, elements, shown };
}

test('each finger has its mark, which goes with it and away with it', () => {
  const { marks, shown } = setUp();
  marks.press(1, 10, 20);
  marks.press(2, 30.5, -40);
  assert.deepEqual(shown(), ['translate(10px, 20px)', 'translate(30.5px, -40px)']);
  marks.move(1, 11, 21);
  assert.deepEqual(shown(), ['translate(11px, 21px)', 'translate(30.5px, -40px)']);
  marks.release(2);
  assert.deepEqual(shown(), ['translate(11px, 21px)']);
  marks.press(3, 1, 1);
  marks.clear();
  assert.deepEqual(shown(), []);
});

test('a finger that is not pressed has none', () => {
  const { marks, shown } = setUp();
  marks.move(1, 5, 5);
  marks.release(1);
  assert.deepEqual(shown(), []);
});

test('a second press of a finger is the same mark', () => {
  const { marks, shown } = setUp();
  marks.press(1, 5, 5);
  marks.press(1, 6, 6);
  assert.deepEqual(shown(), ['translate(6px, 6px)']);
  marks.release(1);
  assert.deepEqual(shown(), []);
});

test('however often the view is touched, there are few elements', () => {
  const { marks, elements } = setUp();
  for (let id = 0; id < 100; id += 1) {
    marks.press(id, id, id);
    marks.release(id);
  }
  assert.equal(elements.length, 1);
});
