import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { keepsKeys } from '../../../web-client/base/element.js';
import { replaceGlobals } from './fakes.js';

/** As much of an element as knows what it is in: itself first. */
class FakeNode {
  constructor(...tags) {
    this.tags = tags;
  }

  closest(selector) {
    return this.tags.find((tag) => selector.split(', ').includes(tag)) ?? null;
  }
}

let giveBack;

before(() => {
  giveBack = replaceGlobals({ Element: FakeNode });
});
after(() => giveBack());

test('keys belong to what is typed into and to dialogs, and to nothing else', () => {
  for (const tag of ['input', 'textarea', 'select', 'dialog']) assert.equal(keepsKeys(new FakeNode(tag)), true, tag);
  assert.equal(keepsKeys(new FakeNode('button', 'dialog')), true);
  for (const target of [new FakeNode('button', 'aside'), new FakeNode('canvas'), null, new EventTarget()]) {
    assert.equal(keepsKeys(target), false);
  }
});
