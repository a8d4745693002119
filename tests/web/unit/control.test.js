import assert from 'node:assert/strict';
import { afterEach, beforeEach, describe, test } from 'node:test';
import { clientName } from '../../../web-client/base/texts.js';
import { ControlBar, controlBar } from '../../../web-client/stage/control.js';
import { FakeClock, FakeElement, fakeDocument, replaceGlobals } from './fakes.js';

const OTHER = { holder: 'b', name: 'Eva’s iPad', kept: true, absent: false, asking: [] };
const OWN = { holder: 'a', kept: true, absent: false, asking: [{ client: 'c', name: 'Phone' }, { client: 'd' }] };

const bar = (control, more = {}) => controlBar({ role: 'control', client: 'a', control, ...more });
const labels = (view) => view.actions.map(({ label }) => label);

test('a client is called by its name, or else by its id', () => {
  assert.equal(clientName({ client: 'c3', name: 'Phone' }), 'Phone');
  assert.equal(clientName({ client: 'c3' }), 'Client c3');
});

describe('the bar', () => {
  test('is empty while all is as it should be', () => {
    assert.equal(bar({ ...OWN, asking: [] }), null);
    assert.equal(bar(OTHER), null);
    assert.equal(bar(undefined), null);
  });

  test('offers to ask to who touches the picture and does not hold control', () => {
    const view = bar(OTHER, { offered: true });
    assert.equal(view.text, 'Eva’s iPad is in control.');
    assert.deepEqual(view.actions, [{ label: 'Ask for control', message: { action: 'ask' } }]);
    assert.equal(bar({ ...OTHER, absent: true }, { offered: true }).text, 'Eva’s iPad is in control, but has lost the connection.');
    assert.equal(bar(OTHER, { offered: true, role: 'view' }), null);
    assert.equal(bar({ ...OWN, asking: [] }, { offered: true }), null);
  });

  test('tells who has asked that it waits', () => {
    const view = bar({ ...OTHER, asking: [{ client: 'c' }, { client: 'a' }] });
    assert.equal(view.text, 'You have asked Eva’s iPad for control.');
    assert.deepEqual(view.actions.map(({ message }) => message), [{ action: 'cancel' }]);
  });

  test('tells the holder who asks first, and how to answer', () => {
    const view = bar(OWN);
    assert.equal(view.text, 'Phone asks for control.');
    assert.deepEqual(labels(view), ['Hand over', 'Not now']);
    assert.deepEqual(view.actions.map(({ message }) => message), [{ action: 'give', client: 'c' }, { action: 'decline', client: 'c' }]);
  });
});

describe('shown', () => {
  let clock;
  let restore;
  beforeEach(() => {
    clock = new FakeClock();
    restore = replaceGlobals({ document: fakeDocument, setTimeout: clock.setTimeout, clearTimeout: clock.clearTimeout });
  });
  afterEach(() => restore());

  const setUp = () => {
    const sent = [];
    const declined = [];
    const element = new FakeElement('div');
    const shown = new ControlBar(element, { send: (message) => sent.push(message), declined: (name) => declined.push(name) });
    const show = (control) => shown.show({ role: 'control', client: 'a', control });
    return { element, shown, show, sent, declined, press: (i) => element.children[1 + i].onclick() };
  };

  test('what is pressed is sent', () => {
    const { show, press, sent } = setUp();
    show(OWN);
    press(0);
    press(1);
    assert.deepEqual(sent, [{ type: 'control', action: 'give', client: 'c' }, { type: 'control', action: 'decline', client: 'c' }]);
  });

  test('only a change is written, so that a button under a finger stays', () => {
    const { element, show } = setUp();
    show(OWN);
    const { writes } = element;
    show(structuredClone(OWN));
    assert.equal(element.writes, writes);
  });

  test('an offer passes', () => {
    const { element, shown, show } = setUp();
    show(OTHER);
    shown.offer();
    assert.equal(element.children[0].textContent, 'Eva’s iPad is in control.');
    clock.advance(5000);
    shown.offer();
    clock.advance(5000);
    assert.equal(element.children.length, 2);
    clock.advance(3000);
    assert.equal(element.children.length, 0);
  });

  test('who is declined hears of it; who has control, or has taken it back, does not', () => {
    const asking = { ...OTHER, asking: [{ client: 'a' }] };
    const declined = setUp();
    for (const control of [OTHER, asking, OTHER, OTHER]) declined.show(control);
    assert.deepEqual(declined.declined, ['Eva’s iPad']);
    const given = setUp();
    for (const control of [asking, { ...OWN, asking: [] }]) given.show(control);
    assert.deepEqual(given.declined, []);
    const cancelled = setUp();
    cancelled.show(asking);
    cancelled.press(0);
    cancelled.show(asking); // the server has not answered yet
    cancelled.show(OTHER);
    assert.deepEqual([cancelled.sent, cancelled.declined], [[{ type: 'control', action: 'cancel' }], []]);
    const lost = setUp();
    lost.show(asking);
    lost.shown.show({ control: asking }); // without a connection the last state stays
    lost.shown.show({ role: 'control', client: 'z', control: OTHER });
    assert.deepEqual(lost.declined, []);
  });
});
