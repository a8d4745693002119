import assert from 'node:assert/strict';
import { afterEach, beforeEach, test } from 'node:test';
import { PointedMarks } from '../../../web-client/stage/pointed-marks.js';
import { FakeClock, FakeElement, replaceGlobals } from './fakes.js';

/** With what a mark is placed by. */
class Mark extends FakeElement {
  dataset = {};
  hidden = false;
  classes = new Set();
  style = { setProperty: (name, value) => (this.style[name] = value) };
  classList = { toggle: (name, isSet) => this.classes[isSet ? 'add' : 'delete'](name) };
}

let clock;
let container;
let asked;
let marks;
let restore;

/** Sees x as it is, and nothing left of the window. */
const picture = {
  paths(lines) {
    asked += 1;
    return lines.map(([[x], end]) => (x >= 0 && end[0] === x ? [[{ x, y: 5 }, { x, y: 5 }]] : []));
  },
};

beforeEach(() => {
  clock = new FakeClock();
  const { setTimeout, clearTimeout } = clock;
  restore = replaceGlobals({ document: { createElement: (tag) => new Mark(tag) }, setTimeout, clearTimeout });
  container = Object.assign(new Mark('div'), { clientWidth: 100 });
  asked = 0;
  marks = new PointedMarks(container);
});

afterEach(() => restore());

const received = (client, x, name) => {
  marks.receive({ type: 'pointed', client, ...(name ? { name } : {}), ...(x === undefined ? {} : { point: [x, 0, 0], normal: [0, 0, 1] }) });
  marks.show(picture);
};
const parts = (tag) => container.children.filter((part) => part.tag === tag);
const shown = () => parts('p').filter(({ hidden }) => !hidden).map(({ textContent, style }) => [textContent, style.transform]);

test('each who points has a dot with a name, which goes with the point', () => {
  received('c1', 10, 'iPad');
  received('c2', 70);
  assert.deepEqual(shown(), [['iPad', 'translate(10.0px, 5.0px)'], ['Client c2', 'translate(70.0px, 5.0px)']]);
  const [first, second] = parts('i').map(({ style }) => style['--color']);
  assert.notEqual(first, second);
  assert.deepEqual(parts('p').map(({ style }) => style['--color']), [first, second]);
  // The name is on the side that has more room.
  assert.deepEqual(parts('p').map(({ classes }) => classes.has('before')), [false, true]);
  const { children } = container;
  received('c1', 20, 'iPad');
  assert.deepEqual([container.children.length, container.children[0]], [4, children[0]]);
  assert.deepEqual(shown()[0], ['iPad', 'translate(20.0px, 5.0px)']);
  assert.equal(parts('i')[0].style.transform, 'translate(20.0px, 5.0px)');
});

test('it is taken away by who points, where it is out of sight, and after 2 s without news', () => {
  received('c1', 10);
  received('c2', 20);
  received('c3', 30);
  received('c1');
  assert.deepEqual(shown().map(([name]) => name), ['Client c2', 'Client c3']);
  received('c3', -1);
  assert.deepEqual(shown().map(([name]) => name), ['Client c2']);
  received('c3', 40);
  clock.advance(1500);
  received('c2', 50);
  clock.advance(1500);
  assert.deepEqual(shown().map(([name]) => name), ['Client c2']);
  clock.advance(500);
  assert.deepEqual([shown(), container.children.length], [[], 0]);
});

test('while nobody points, nothing is asked of the picture, and no timer is set', () => {
  marks.show(picture);
  received('c1');
  assert.deepEqual([asked, clock.next], [0, undefined]);
  received('c1', 10);
  received('c2', 10);
  marks.clear();
  marks.show(picture);
  assert.deepEqual([container.children.length, clock.next], [0, undefined]);
});
